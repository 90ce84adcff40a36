//! The drawing of a cycle beside its dialogue, in which the word that is asked for stands out.

use bahn_dialogue::{FIGURE_SIZE, FigurePart, Shape};
use bahn_picture::{Anchor, Colour, Image, text_width};

const BACKGROUND: Colour = [0, 0, 0];
const PART: Colour = [200, 205, 215];
const PATH: Colour = [90, 140, 110];
const DIMENSION: Colour = [110, 150, 200];
const ASKED: Colour = [255, 200, 0];
/// Room around the sheet, pixels.
const MARGIN: f64 = 20.0;
const TITLE: f64 = 20.0;
/// Height of words in units of the sheet, and how few and how many pixels that is; those of what is asked for.
const TEXT: (f64, [f64; 2]) = (2.6, [9.0, 24.0]);
const ASKED_TEXT: (f64, [f64; 2]) = (3.2, [11.0, 30.0]);
/// Length of an arrow head and lines of a circle.
const HEAD: f64 = 2.2;
const LINES: u32 = 48;

/// Where the sheet lies in a picture.
#[derive(Clone, Copy)]
struct Sheet {
    corner: [f64; 2],
    scale: f64,
}

impl Sheet {
    fn of(size: [f64; 2]) -> Sheet {
        let room = [size[0] - 2.0 * MARGIN, size[1] - 2.0 * MARGIN - TITLE];
        let scale = (room[0] / FIGURE_SIZE[0]).min(room[1] / FIGURE_SIZE[1]).max(0.1);
        let rest = |axis: usize| room[axis] - scale * FIGURE_SIZE[axis];
        Sheet {
            corner: [MARGIN + 0.5 * rest(0), size[1] - MARGIN - 0.5 * rest(1)],
            scale,
        }
    }

    fn at(&self, point: [f64; 2]) -> [f64; 2] {
        [
            self.corner[0] + point[0] * self.scale,
            self.corner[1] - point[1] * self.scale,
        ]
    }
}

/// Draws a cycle; what belongs to the prompt stands out.
pub(crate) fn draw(parts: &[&FigurePart], asked: &str, size: [u32; 2], title: &str) -> Image {
    let mut image = Image::new(size[0], size[1], BACKGROUND);
    let sheet = Sheet::of(size.map(f64::from));
    // What is asked for lies above the rest.
    for above in [false, true] {
        for part in parts.iter().filter(|part| part.ids.contains(&asked) == above) {
            self::part(&mut image, &sheet, part, above);
        }
    }
    image.text([MARGIN, TITLE], Anchor::Left, 14.0, PART, title);
    image
}

fn part(image: &mut Image, sheet: &Sheet, part: &FigurePart, asked: bool) {
    let colour = |own: Colour| if asked { ASKED } else { own };
    let width = if asked { 3.0 } else { 1.4 };
    match &part.shape {
        Shape::Outline(points) => {
            let points: Vec<_> = points.iter().map(|point| sheet.at(*point)).collect();
            image.outline(&points, 2.0, colour(PART));
        }
        Shape::Path(points) => {
            for pair in points.windows(2) {
                if let [from, to] = pair {
                    image.dashed(sheet.at(*from), sheet.at(*to), &[7.0, 5.0], 1.2, colour(PATH));
                }
            }
        }
        Shape::Circle(centre, radius) => arc(image, sheet, *centre, *radius, 1.0, 2.0, colour(PART)),
        Shape::Dimension(from, to) => {
            arrow(image, sheet, *from, *to, width, colour(DIMENSION));
            arrow(image, sheet, *to, *from, width, colour(DIMENSION));
        }
        Shape::Arrow(from, to) => arrow(image, sheet, *from, *to, width, colour(DIMENSION)),
        Shape::Turn(centre, radius) => {
            arc(image, sheet, *centre, *radius, 0.25, width, colour(DIMENSION));
            let end = [centre[0], centre[1] + radius];
            let before = [end[0] + HEAD, end[1]];
            arrow(image, sheet, before, end, width, colour(DIMENSION));
        }
        Shape::Text(_) => {}
    }
    if let Some(words) = Words::of(sheet, part, asked) {
        // Nothing runs through words.
        let [min, max] = words.room();
        image.rectangle(min, max, BACKGROUND);
        image.text(words.at, Anchor::Left, words.size, colour(DIMENSION), part.label);
    }
}

/// Where the words of a part stand in the picture.
struct Words {
    /// The middle of their left side, pixels.
    at: [f64; 2],
    size: f64,
    width: f64,
}

impl Words {
    /// None of what is a part of the workpiece or of the path.
    fn of(sheet: &Sheet, part: &FigurePart, asked: bool) -> Option<Words> {
        let at = match &part.shape {
            Shape::Outline(_) | Shape::Path(_) | Shape::Circle(..) => return None,
            Shape::Dimension(from, to) | Shape::Arrow(from, to) => beside(*from, *to),
            Shape::Turn(centre, radius) => {
                let middle = radius * std::f64::consts::FRAC_1_SQRT_2 + 2.0;
                [centre[0] + middle, centre[1] + middle]
            }
            Shape::Text(at) => [at[0] - 4.0, at[1]],
        };
        let (units, [least, most]) = if asked { ASKED_TEXT } else { TEXT };
        let size = (units * sheet.scale).clamp(least, most);
        Some(Words {
            at: sheet.at(at),
            size,
            width: text_width(part.label, size),
        })
    }

    /// Least and greatest corner of what they take.
    fn room(&self) -> [[f64; 2]; 2] {
        let [x, y] = self.at;
        [
            [x - 1.0, y - 0.5 * self.size],
            [x + self.width + 1.0, y + 0.5 * self.size],
        ]
    }
}

/// Where the label of a line stands: to the right of its middle, above a level one, and below one that rises.
fn beside(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
    let [across, up] = [to[0] - from[0], to[1] - from[1]];
    match (across == 0.0, up == 0.0) {
        (true, _) => [middle[0] + 1.2, middle[1]],
        (_, true) => [middle[0] - 2.0, middle[1] + 2.5],
        _ => [middle[0] + 2.0, middle[1] - 2.0 * (across * up).signum()],
    }
}

fn arc(
    image: &mut Image,
    sheet: &Sheet,
    centre: [f64; 2],
    radius: f64,
    turn: f64,
    width: f64,
    colour: Colour,
) {
    let at = |line: u32| {
        let angle = std::f64::consts::TAU * turn * f64::from(line) / f64::from(LINES);
        sheet.at([centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()])
    };
    for line in 0..LINES {
        image.line(at(line), at(line + 1), width, colour);
    }
}

fn arrow(image: &mut Image, sheet: &Sheet, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
    image.line(sheet.at(from), sheet.at(to), width, colour);
    let length = (to[0] - from[0]).hypot(to[1] - from[1]).max(1e-9);
    let along = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    for side in [-0.4, 0.4] {
        let back = [along[0] + side * along[1], along[1] - side * along[0]];
        let barb = [to[0] - HEAD * back[0], to[1] - HEAD * back[1]];
        image.line(sheet.at(to), sheet.at(barb), width, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_that_is_asked_for_stands_out() {
        // 500 x 405 pixels: 4.6 pixels for each unit of the sheet. The depth is at x = 70, y = 13 to 40.
        let parts = bahn_dialogue::figure(1).unwrap();
        let size = [500, 405];
        let sheet = Sheet::of(size.map(f64::from));
        let near = |is: f64, wanted: f64| assert!((is - wanted).abs() < 1e-9, "{is}");
        near(sheet.scale, 4.6);
        near(sheet.corner[0], 20.0);
        near(sheet.corner[1], 385.0);
        let [x, y] = [20 + (70.0 * 4.6) as usize, 385 - (30.0 * 4.6) as usize];
        let pixel = |asked: &str| draw(&parts, asked, size, "").pixels()[y * 500 + x];
        assert_eq!(pixel("cycle 1 DEPTH"), ASKED);
        assert_ne!(pixel("cycle SET UP"), ASKED);
        assert_ne!(pixel("cycle SET UP"), BACKGROUND);
    }

    /// Whatever is asked for, no words lie over others or leave the picture, down to the size of a phone.
    #[test]
    fn words_have_room() {
        for size in [[280, 210], [500, 405], [1200, 800]] {
            let sheet = Sheet::of(size.map(f64::from));
            for cycle in 1..=31 {
                let parts = bahn_dialogue::figure(cycle).unwrap_or_default();
                for asked in parts.iter().flat_map(|part| &part.ids) {
                    let rooms: Vec<_> = parts
                        .iter()
                        .filter_map(|part| {
                            let words = Words::of(&sheet, part, part.ids.contains(asked))?;
                            Some((part.label, words.room()))
                        })
                        .collect();
                    for (at, (label, [min, max])) in rooms.iter().enumerate() {
                        let inside = min[0] >= 0.0
                            && min[1] >= TITLE
                            && max[0] <= f64::from(size[0])
                            && max[1] <= f64::from(size[1]);
                        assert!(
                            inside,
                            "cycle {cycle} at {asked}, {size:?}: {label} leaves the picture"
                        );
                        for (other, [low, high]) in &rooms[at + 1..] {
                            let apart = (0..2).any(|axis| max[axis] <= low[axis] || high[axis] <= min[axis]);
                            assert!(apart, "cycle {cycle} at {asked}, {size:?}: {label} and {other}");
                        }
                    }
                }
            }
        }
    }
}
