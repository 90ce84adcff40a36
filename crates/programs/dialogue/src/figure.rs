//! Drawings of cycles, in which the word that is asked for stands out: `data/figures.tsv`. Whoever shows the dialogue
//! draws them.

use std::sync::OnceLock;

use bahn_program::CycleFunction;

use crate::cycles::prompts_of;

/// Width and height of the sheet.
pub const FIGURE_SIZE: [f64; 2] = [100.0, 75.0];

/// A shape of a help figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// An edge of the part: points of a polyline.
    Outline(Vec<[f64; 2]>),
    /// The path of the tool: points of a dashed polyline.
    Path(Vec<[f64; 2]>),
    /// A circle of the part: centre and radius.
    Circle([f64; 2], f64),
    /// A dimension between two points.
    Dimension([f64; 2], [f64; 2]),
    /// A direction from one point to another.
    Arrow([f64; 2], [f64; 2]),
    /// A sense of rotation: centre and radius of a quarter circle from the right upwards.
    Turn([f64; 2], f64),
    /// Words alone, about a point.
    Text([f64; 2]),
}

/// A part of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct FigurePart {
    /// Edge, path, dimension, arrow or the like, with its points.
    pub shape: Shape,
    /// The prompts at which it stands out, by their ids; none for what every cycle of the drawing has.
    pub ids: Vec<&'static str>,
    /// What stands beside it.
    pub label: &'static str,
}

/// The drawing of a cycle definition: what it asks for, and the part around it; `None` where there is none.
///
/// ```
/// use bahn_dialogue::figure;
///
/// let parts = figure(2).unwrap();
/// assert!(parts.iter().any(|part| part.label == "DWELL TIME"));
/// assert!(!parts.iter().any(|part| part.label == "PECKG"), "tapping has no pecking depth");
/// assert!(figure(12).is_none());
/// ```
pub fn figure(cycle: u16) -> Option<Vec<&'static FigurePart>> {
    let figure = figures().iter().find(|figure| figure.cycles.contains(&cycle))?;
    let asked = prompts_of(CycleFunction::Definition, cycle);
    let shown = |part: &&FigurePart| part.ids.is_empty() || part.ids.iter().any(|id| asked.contains(id));
    Some(figure.parts.iter().filter(shown).collect())
}

#[derive(Debug)]
struct Figure {
    name: &'static str,
    cycles: Vec<u16>,
    parts: Vec<FigurePart>,
}

fn figures() -> &'static [Figure] {
    static TABLE: OnceLock<Vec<Figure>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut all: Vec<Figure> = Vec::new();
        let lines = include_str!("../data/figures.tsv").lines();
        for line in lines.filter(|line| !line.starts_with('#')) {
            let mut cells = line.split('\t');
            let (kind, what) = (cells.next().unwrap_or_default(), cells.next().unwrap_or_default());
            if kind == "figure" {
                let cycles = cells.next().unwrap_or_default().split(',');
                all.push(Figure {
                    name: what,
                    cycles: cycles.filter_map(|cycle| cycle.parse().ok()).collect(),
                    parts: Vec::new(),
                });
                continue;
            }
            let ids = cells
                .next()
                .unwrap_or_default()
                .split(';')
                .filter(|id| !id.is_empty());
            let parts = match kind {
                "use" => all
                    .iter()
                    .find(|figure| figure.name == what)
                    .map(|figure| figure.parts.clone()),
                _ => shape(kind, what).map(|shape| {
                    vec![FigurePart {
                        shape,
                        ids: ids.collect(),
                        label: cells.next().unwrap_or_default(),
                    }]
                }),
            };
            if let Some(figure) = all.last_mut() {
                figure.parts.extend(parts.into_iter().flatten());
            }
        }
        all
    })
}

fn shape(kind: &str, numbers: &str) -> Option<Shape> {
    let numbers: Vec<f64> = numbers
        .split(' ')
        .map(str::parse)
        .collect::<Result<_, _>>()
        .ok()?;
    let points = || numbers.chunks_exact(2).filter_map(|pair| pair.try_into().ok());
    Some(match (kind, numbers.as_slice()) {
        ("outline", _) => Shape::Outline(points().collect()),
        ("path", _) => Shape::Path(points().collect()),
        ("circle", [x, y, r]) => Shape::Circle([*x, *y], *r),
        ("dim", [x, y, u, v]) => Shape::Dimension([*x, *y], [*u, *v]),
        ("arrow", [x, y, u, v]) => Shape::Arrow([*x, *y], [*u, *v]),
        ("turn", [x, y, r]) => Shape::Turn([*x, *y], *r),
        ("text", [x, y]) => Shape::Text([*x, *y]),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prompt::prompt;

    /// The cycles that have a drawing.
    const DRAWN: [u16; 25] = [
        1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27,
    ];

    #[test]
    fn every_word_of_a_drawn_cycle_stands_out_in_it() {
        for cycle in DRAWN {
            let parts = figure(cycle).unwrap_or_else(|| panic!("cycle {cycle} has no drawing"));
            let asked = prompts_of(CycleFunction::Definition, cycle);
            assert!(!asked.is_empty());
            for id in asked {
                assert!(
                    parts.iter().any(|part| part.ids.contains(&id)),
                    "cycle {cycle} does not show {id}"
                );
            }
        }
    }

    #[test]
    fn every_line_of_the_table_is_read_and_lies_on_the_sheet() {
        let lines = include_str!("../data/figures.tsv").lines();
        let lines = lines.filter(|line| !line.starts_with('#') && !line.starts_with("figure"));
        let uses = lines.clone().filter(|line| line.starts_with("use")).count();
        let section = figures()
            .iter()
            .find(|figure| figure.name == "section")
            .unwrap()
            .parts
            .len();
        let parts: usize = figures().iter().map(|figure| figure.parts.len()).sum();
        assert_eq!(parts, lines.count() - uses + uses * section);
        for part in figures().iter().flat_map(|figure| &figure.parts) {
            let points = match &part.shape {
                Shape::Outline(points) | Shape::Path(points) => points.clone(),
                Shape::Circle([x, y], r) | Shape::Turn([x, y], r) => vec![[x - r, y - r], [x + r, y + r]],
                Shape::Dimension(from, to) | Shape::Arrow(from, to) => vec![*from, *to],
                Shape::Text(at) => vec![*at],
            };
            assert!(
                points.len() > 1 || matches!(part.shape, Shape::Text(_)),
                "{part:?}"
            );
            let turn = matches!(part.shape, Shape::Turn(..));
            let inside =
                |point: &[f64; 2]| (0..2).all(|axis| (0.0..=FIGURE_SIZE[axis]).contains(&point[axis]));
            assert!(turn || points.iter().all(inside), "{part:?}");
            assert!(part.ids.iter().all(|id| prompt(id).is_some()), "{part:?}");
            assert_eq!(part.ids.is_empty(), part.label.is_empty(), "{part:?}");
        }
    }
}
