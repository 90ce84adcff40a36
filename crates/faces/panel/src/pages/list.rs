//! A list of lines, one of which has the cursor: what moves it, and the window around it.

use bahn_dialogue::Key;
use bahn_screen::{Line, Mark, Window, WindowKind};

use crate::page::first_in_sight;
use crate::site::Site;

/// Soft keys that move the cursor, by the names they have in every list, with the lines they go.
const WAYS: [(&str, isize); 4] = [
    ("BEGIN", isize::MIN),
    ("LAST LINE", isize::MAX),
    ("PAGE UP", -PAGE),
    ("PAGE DOWN", PAGE),
];
/// Lines of a page (inferred).
const PAGE: isize = 12;

/// So many lines a key moves the cursor.
pub(crate) fn way_of_key(key: Key) -> Option<isize> {
    match key {
        Key::Up => Some(-1),
        Key::Down => Some(1),
        _ => None,
    }
}

/// So many lines a soft key moves the cursor.
pub(crate) fn way_of(soft_key: &str) -> Option<isize> {
    let mut ways = WAYS.iter();
    ways.find(|(name, _)| *name == soft_key).map(|(_, lines)| *lines)
}

/// Where the cursor stands that was moved by so many lines: it stays in the list.
pub(crate) fn moved(from: usize, lines: isize, total: usize) -> usize {
    from.saturating_add_signed(lines).min(total.saturating_sub(1))
}

/// A row of soft keys with these names; what has none is not there.
pub(crate) fn soft_keys(names: &[&'static str], site: &Site) -> Vec<String> {
    names.iter().map(|name| site.words(name)).collect()
}

/// The name of the soft key at a place of its row.
pub(crate) fn name_at(names: &[&'static str], place: usize) -> &'static str {
    names.get(place).copied().unwrap_or_default()
}

/// A line of a table: what it begins with, and its cells of one width. The current line has the cursor on one of them.
pub(crate) fn cells<'a>(
    head: String,
    cells: impl Iterator<Item = &'a str>,
    width: usize,
    cursor: Option<usize>,
) -> Line {
    let mut text = head;
    let mut marks = Vec::new();
    for (column, cell) in cells.enumerate() {
        let from = text.chars().count();
        if cursor == Some(column) {
            marks.push((from, from + width - 1, Mark::Cursor));
        }
        text += &format!("{cell:<width$}");
    }
    Line {
        text: text.trim_end().to_owned(),
        current: cursor.is_some(),
        marks,
    }
}

/// A window of so many lines, with the current one of all in sight.
pub(crate) fn window(
    title: String,
    kind: WindowKind,
    (current, total): (usize, usize),
    lines: usize,
    line: impl FnMut(usize) -> Line,
) -> Window {
    let first = first_in_sight(current, total, lines);
    Window {
        title,
        kind,
        lines: (first..total).take(lines).map(line).collect(),
        first,
        total,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cursor_stays_in_the_list() {
        assert_eq!(moved(5, 1, 10), 6);
        assert_eq!(moved(5, PAGE, 10), 9);
        assert_eq!(moved(5, -PAGE, 10), 0);
        assert_eq!(moved(5, isize::MAX, 10), 9);
        assert_eq!(moved(5, isize::MIN, 10), 0);
        // An empty list has no line to stand on.
        assert_eq!(moved(0, 1, 0), 0);
    }

    #[test]
    fn a_window_shows_the_lines_around_the_cursor() {
        let line = |place: usize| Line {
            text: place.to_string(),
            ..Line::default()
        };
        let window = window(String::new(), WindowKind::List, (50, 100), 4, line);
        let shown: Vec<&str> = window.lines.iter().map(|line| line.text.as_str()).collect();
        assert_eq!(shown, ["48", "49", "50", "51"]);
        assert_eq!((window.first, window.total), (48, 100));
    }
}
