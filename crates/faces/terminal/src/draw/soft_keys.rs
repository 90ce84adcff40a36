//! The soft-key row: a mark for each row above it, two lines of text.

use bahn_panel::Key;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use super::{Scene, rows};
use crate::desk::{Target, Targets};
use crate::palette::Role;

/// The soft keys from the left.
const KEYS: [Key; 8] = [
    Key::Sk1,
    Key::Sk2,
    Key::Sk3,
    Key::Sk4,
    Key::Sk5,
    Key::Sk6,
    Key::Sk7,
    Key::Sk8,
];
/// Columns in which the signs of the keys that change the row can be clicked.
const TURN: u16 = 3;

pub(super) fn draw(frame: &mut Frame, scene: &Scene, area: Rect, targets: &mut Targets) {
    marks(frame, scene, Rect { height: 1, ..area }, targets);
    let below = Rect {
        y: area.y + 1,
        height: area.height.saturating_sub(1),
        ..area
    };
    let width = area.width / rows(KEYS.len());
    for (place, key) in (0..).zip(KEYS) {
        let own = Rect {
            x: area.x + place * width,
            // A column between two keys.
            width: width - 1,
            ..below
        };
        let keys = &scene.screen.soft_keys.keys;
        let text = keys.get(usize::from(place)).map_or("", String::as_str);
        if text.is_empty() {
            continue;
        }
        let lines = folded(text, usize::from(own.width));
        let lines = lines.map(|line| Line::from(line).centered()).to_vec();
        let style = scene.palette.style(Role::Button).reversed();
        frame.render_widget(Paragraph::new(lines).style(style), own);
        targets.0.push((own, Target::Key(key)));
    }
}

/// Where there are more rows, a dash for each, and the keys that change the row.
fn marks(frame: &mut Frame, scene: &Scene, area: Rect, targets: &mut Targets) {
    let soft_keys = &scene.screen.soft_keys;
    if soft_keys.rows < 2 {
        return;
    }
    let palette = scene.palette;
    let dashes = (0..soft_keys.rows).map(|row| match row == soft_keys.row {
        true => Span::styled("━━━ ", palette.style(Role::Lit)),
        false => Span::styled("─── ", palette.style(Role::Frame)),
    });
    let line = Line::from(dashes.collect::<Vec<_>>());
    frame.render_widget(Paragraph::new(line.centered()), area);
    for (key, x, sign) in [
        (Key::SkLeft, area.x, " ◁ "),
        (Key::SkRight, area.right() - TURN, " ▷ "),
    ] {
        let own = Rect {
            x,
            width: TURN,
            ..area
        };
        frame.render_widget(Span::styled(sign, palette.style(Role::Button)), own);
        targets.0.push((own, Target::Key(key)));
    }
}

/// A text in two lines: broken between words where that fits, else wherever it must.
fn folded(text: &str, width: usize) -> [String; 2] {
    let length = |text: &str| text.chars().count();
    if length(text) <= width {
        return [text.to_owned(), String::new()];
    }
    let mut breaks = text
        .match_indices(' ')
        .filter(|(at, _)| length(&text[..*at]) <= width);
    let (upper, lower) = match breaks.next_back() {
        Some((at, _)) => (text[..at].to_owned(), text[at + 1..].to_owned()),
        None => text.chars().enumerate().fold(
            (String::new(), String::new()),
            |(mut upper, mut lower), (at, character)| {
                match at < width {
                    true => upper.push(character),
                    false => lower.push(character),
                }
                (upper, lower)
            },
        ),
    };
    [upper, lower.chars().take(width).collect()]
}

#[cfg(test)]
mod tests {
    use super::folded;

    #[test]
    fn texts_are_broken_between_words() {
        for (text, expected) in [
            ("INFO", ["INFO", ""]),
            ("RESTORE POSITION", ["RESTORE", "POSITION"]),
            ("POS DISP 1", ["POS DISP", "1"]),
            ("UNABBREVIATED", ["UNABBREV", "IATED"]),
            ("AN UNABBREVIATED", ["AN", "UNABBREV"]),
        ] {
            assert_eq!(folded(text, 8), expected.map(str::to_owned), "{text}");
        }
    }
}
