//! Logic diagrams as text and as SVG.

use super::diagram::Diagram;
use super::operand::{Content, Operand};

/// Cycles in a line of text.
const COLUMNS: usize = 64;
/// Width of a cycle and height of a row in the drawing, in pixels.
const CYCLE: usize = 12;
const ROW: usize = 28;
/// Width of the names in the drawing.
const NAMES: usize = 70;

/// For the terminal: a high line for 1, a low one for 0, numbers where they change.
pub(super) fn text(diagram: &Diagram) -> String {
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
            let mut row = vec![' '; end - start];
            for (first, length, content) in diagram.stretches(index) {
                draw(&mut row, first, length, start, *operand, content);
            }
            text += &format!(
                "{:>8} {}\n",
                operand.to_string(),
                row.iter().collect::<String>().trim_end()
            );
        }
    }
    text
}

fn draw(row: &mut [char], first: usize, length: usize, start: usize, operand: Operand, content: &Content) {
    let label: Vec<char> = match (operand, content) {
        (Operand::Bit(_), _) => Vec::new(),
        (_, content) => format!("|{content}").chars().collect(),
    };
    let filler = match (operand, content) {
        (Operand::Bit(_), Content::Number(0)) => '_',
        (Operand::Bit(_), _) => '\u{2580}',
        _ => ' ',
    };
    // A stretch that began before this line shows its content again.
    let begin = first.max(start);
    for at in begin..first + length {
        let character = label.get(at - begin).copied().unwrap_or(filler);
        if let Some(cell) = at.checked_sub(start).and_then(|at| row.get_mut(at)) {
            *cell = character;
        }
    }
}

/// The drawing.
pub(super) fn svg(diagram: &Diagram) -> String {
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
                    let (top, height, text_x) = (bottom - 16, 16, x + 3);
                    svg += &format!(
                        "<rect x=\"{x}\" y=\"{top}\" width=\"{}\" height=\"{height}\" fill=\"none\" stroke=\"#888\"/>\
                         <text x=\"{text_x}\" y=\"{}\">{}</text>\n",
                        end - x,
                        bottom - 4,
                        escaped(&content.to_string())
                    );
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
