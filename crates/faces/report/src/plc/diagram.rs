//! Logic diagrams as text, as SVG and as data.

use bahn_host::logic_diagram::Diagram;
use bahn_host::{Content, Operand};

/// Cycles in a line of text.
const COLUMNS: usize = 64;
/// Width of a cycle and height of a row in the drawing, in pixels.
const CYCLE: usize = 12;
const ROW: usize = 28;
/// Width of a character in the drawing.
const CHARACTER: usize = 8;
/// Width of the names in the drawing.
const NAMES: usize = 70;

/// For the terminal: a high line for 1, a low one for 0. Numbers and texts stand where they change; where
/// there is no room for one, least, greatest and last number are given at the end of the row.
pub fn text(diagram: &Diagram) -> String {
    let mut text = String::new();
    let count = diagram.samples.len();
    for start in (0..count).step_by(COLUMNS) {
        let end = (start + COLUMNS).min(count);
        let from = diagram.first + start as u64;
        text += &format!("cycles {from} to {}\n", from + (end - start) as u64 - 1);
        if let Some(at) = diagram.trigger.and_then(|cycle| cycle.checked_sub(from))
            && at < (end - start) as u64
        {
            let at = usize::try_from(at).unwrap_or(0);
            text += &format!("{:>8} {:at$}v trigger\n", "", "");
        }
        for (index, operand) in diagram.operands.iter().enumerate() {
            let row = match operand {
                Operand::Bit(_) => diagram.levels(index, start, end),
                _ => contents(diagram, index, start, end),
            };
            text += &format!("{:>8} {}\n", operand.to_string(), row.trim_end());
        }
    }
    text
}

fn contents(diagram: &Diagram, index: usize, start: usize, end: usize) -> String {
    let mut row = String::new();
    let mut complete = true;
    for (first, length, content) in diagram.stretches(index) {
        // A stretch that began before this row shows its content again.
        let cells = (first + length).min(end).saturating_sub(first.max(start));
        if first >= end || cells == 0 {
            continue;
        }
        let label = format!("|{content}");
        if label.chars().count() <= cells {
            row += &format!("{label:<cells$}");
        } else {
            complete = false;
            row += &format!("{:~<cells$}", "|");
        }
    }
    if complete {
        return row;
    }
    let numbers = || {
        diagram
            .row(index, start, end)
            .filter_map(|content| match content {
                Content::Number(value) => Some(value),
                Content::Text(_) => None,
            })
    };
    let extremes = match (numbers().min(), numbers().max()) {
        (Some(least), Some(greatest)) => format!("{least}..{greatest}, "),
        _ => String::new(),
    };
    let last = diagram.row(index, start, end).last();
    row + &last.map_or(String::new(), |last| format!("| {extremes}last {last}"))
}

/// The diagram as SVG.
pub fn svg(diagram: &Diagram) -> String {
    let width = NAMES + diagram.samples.len() * CYCLE + 10;
    let height = (diagram.operands.len() + 1) * ROW + 10;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         font-family=\"monospace\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for at in (0..=diagram.samples.len()).step_by(10) {
        let x = NAMES + at * CYCLE;
        let cycle = diagram.first + at as u64;
        svg += &format!(
            "<line x1=\"{x}\" y1=\"20\" x2=\"{x}\" y2=\"{height}\" stroke=\"#ddd\"/><text x=\"{x}\" y=\"14\">{cycle}</text>\n"
        );
    }
    if let Some(at) = diagram.trigger.and_then(|cycle| cycle.checked_sub(diagram.first)) {
        let x = NAMES + usize::try_from(at).unwrap_or(0) * CYCLE;
        svg += &format!(
            "<line class=\"trigger\" x1=\"{x}\" y1=\"18\" x2=\"{x}\" y2=\"{height}\" stroke=\"red\"/>\n"
        );
    }
    for (index, operand) in diagram.operands.iter().enumerate() {
        let bottom = (index + 2) * ROW - 6;
        svg += &format!("<text x=\"4\" y=\"{bottom}\">{operand}</text>\n");
        let mut points = String::new();
        for (first, length, content) in diagram.stretches(index) {
            let (x, end) = (NAMES + first * CYCLE, NAMES + (first + length) * CYCLE);
            match (operand, content) {
                (Operand::Bit(_), content) => {
                    let y = if *content == Content::Number(0) {
                        bottom
                    } else {
                        bottom - 16
                    };
                    points += &format!("{x},{y} {end},{y} ");
                }
                (_, content) => {
                    let (top, width) = (bottom - 16, end - x);
                    let content = content.to_string();
                    svg += &format!(
                        "<rect x=\"{x}\" y=\"{top}\" width=\"{width}\" height=\"16\" fill=\"white\" stroke=\"#888\">\
                         <title>{}</title></rect>",
                        escaped(&content)
                    );
                    if content.chars().count() * CHARACTER + 4 <= width {
                        svg += &format!(
                            "<text x=\"{}\" y=\"{}\">{}</text>",
                            x + 3,
                            bottom - 4,
                            escaped(&content)
                        );
                    }
                    svg.push('\n');
                }
            }
        }
        if !points.is_empty() {
            svg += &format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"#036\" stroke-width=\"2\"/>\n",
                points.trim_end()
            );
        }
    }
    svg + "</svg>\n"
}

fn escaped(text: &str) -> String {
    text.chars()
        .map(|character| match character {
            '<' => "&lt;".to_owned(),
            '>' => "&gt;".to_owned(),
            '&' => "&amp;".to_owned(),
            '"' => "&quot;".to_owned(),
            c if c.is_control() => " ".to_owned(),
            c => c.to_string(),
        })
        .collect()
}

/// The diagram as data.
#[derive(Debug, serde::Serialize)]
pub struct Courses<'a> {
    first_cycle: u64,
    trigger_cycle: Option<u64>,
    operands: Vec<Course<'a>>,
}

/// An operand after every cycle.
#[derive(Debug, serde::Serialize)]
struct Course<'a> {
    operand: String,
    values: Vec<&'a Content>,
}

impl Courses<'_> {
    /// Those of a diagram.
    pub fn new(diagram: &Diagram) -> Courses<'_> {
        let course = |(index, operand): (usize, &Operand)| Course {
            operand: operand.to_string(),
            values: diagram
                .samples
                .iter()
                .filter_map(|sample| sample.get(index))
                .collect(),
        };
        Courses {
            first_cycle: diagram.first,
            trigger_cycle: diagram.trigger,
            operands: diagram.operands.iter().enumerate().map(course).collect(),
        }
    }
}
