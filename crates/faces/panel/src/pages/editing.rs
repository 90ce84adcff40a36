//! What an editor of the dialogue shows, as a page's window.

use bahn_dialogue::{Editor, Key, Reaction, Row, ShownWord, Wanted};
use bahn_path::Axis;
use bahn_program::Program;
use bahn_screen::{Dialogue, Line, Mark, SoftKeys, Window, WindowKind};

use crate::page::{Turn, View};
use crate::pages::list;
use crate::site::Site;

/// Width of block numbers.
const NUMBER: usize = 5;
/// The same in DIN/ISO.
const ISO_NUMBER: usize = 7;
/// The axes of an L block with actual positions, where MOD chose none [003:2260-2321].
const CAPTURED: &str = "XYZ";

/// A key for the editor; `true` with it when the program has changed.
pub(crate) fn key(editor: &mut Editor, key: Key, site: &mut Site) -> (Turn, bool) {
    let reaction = editor.key(key);
    went(editor, reaction, site)
}

/// Text for the editor, as if it had been typed.
pub(crate) fn text(editor: &mut Editor, text: &str, site: &mut Site) -> (Turn, bool) {
    let reaction = editor.type_text(text);
    went(editor, reaction, site)
}

fn went(editor: &mut Editor, reaction: Reaction, site: &mut Site) -> (Turn, bool) {
    match reaction {
        Reaction::Shown => (Turn::Done, false),
        Reaction::Edited => (Turn::Done, true),
        Reaction::Refused(id) => (Turn::Say(site.message(id)), false),
        Reaction::Passed => (Turn::Refused, false),
        Reaction::Position(wanted) => match capture(editor, wanted, site) {
            Reaction::Position(_) => (Turn::Refused, false),
            reaction => went(editor, reaction, site),
        },
    }
}

/// Actual position capture [003:2260-2321]: workpiece coordinates as the display shows them, with the tool length in the
/// tool axis.
fn capture(editor: &mut Editor, wanted: Wanted, site: &Site) -> Reaction {
    let of = |axis: Axis| Some((axis, site.captured(axis.letter())?));
    match wanted {
        Wanted::Axis(axis) => of(axis).map(|(axis, value)| editor.capture(axis, value)),
        Wanted::ToolAxis => {
            let tool_axis = site.tool_axis().and_then(of);
            tool_axis.map(|(axis, value)| editor.capture(axis, value))
        }
        Wanted::Block => {
            let chosen = match site.settings.captured_axes.as_str() {
                "" => CAPTURED,
                chosen => chosen,
            };
            // In the order of the machine, in whatever order they were chosen.
            let letters = site.control().axis_letters();
            let axes = letters.filter(|letter| chosen.contains(*letter));
            let axes = axes.filter_map(|letter| Axis::from_letter(u8::try_from(letter).ok()?));
            let position: Vec<_> = axes.filter_map(of).collect();
            Some(editor.capture_block(&position))
        }
    }
    .unwrap_or(Reaction::Passed)
}

/// CAPTURE while another operating mode has the keys: a new block after the one that is selected. While a block is open
/// none is selected *(inferred)*.
pub(crate) fn capture_block(editor: &mut Editor, site: &mut Site) -> (Turn, bool) {
    match editor.is_open() {
        true => (Turn::Refused, false),
        false => {
            let reaction = capture(editor, Wanted::Block, site);
            went(editor, reaction, site)
        }
    }
}

/// What an editor shows in so many lines.
pub(crate) fn view(editor: &Editor, title: &str, lines: usize) -> View {
    let half = u32::try_from(lines / 2).unwrap_or_default();
    let view = editor.view(half, half);
    let total = editor.program().block_count() as usize;
    let window = match &view.list {
        Some(choice) => {
            let line = |place: usize| Line {
                text: choice.lines.get(place).cloned().unwrap_or_default(),
                current: place == choice.at,
                ..Line::default()
            };
            let cursor = (choice.at, choice.lines.len());
            list::window(title.to_owned(), WindowKind::List, cursor, lines, line)
        }
        None => Window {
            title: title.to_owned(),
            kind: WindowKind::Program,
            first: view.rows.first().and_then(|row| row.number).unwrap_or_default() as usize,
            total,
            lines: view
                .rows
                .iter()
                .map(|row| line(row, &view.words, editor.program()))
                .collect(),
        },
    };
    let question = view.question;
    View {
        window: Some(window),
        dialogue: Dialogue {
            open: question.is_some(),
            prompt: question
                .as_ref()
                .map_or_else(String::new, |question| question.prompt.clone()),
            entry: question.map(|question| question.entered).unwrap_or_default(),
        },
    }
}

/// The number of a block in its column, that of DIN/ISO with its `N` and five digits; a longer one has a blank after it.
pub(crate) fn numbered(label: &str, program: &Program) -> String {
    let width = if program.language().has_numbers() {
        ISO_NUMBER
    } else {
        NUMBER
    };
    match label.len() < width {
        true => format!("{label:<width$}"),
        false => format!("{label} "),
    }
}

fn line(row: &Row, words: &[ShownWord], program: &Program) -> Line {
    let mut text = numbered(&row.label, program);
    let mut marks = Vec::new();
    if row.current && !words.is_empty() {
        for word in words {
            // A word has with it what stands before it; what is highlighted is the word alone.
            let blanks = word.text.chars().take_while(|c| c.is_whitespace()).count();
            let from = text.chars().count() + blanks;
            text.push_str(&word.text);
            if word.highlighted {
                marks.push((from, text.chars().count(), Mark::Cursor));
            }
        }
    } else {
        text.push_str(&row.text);
    }
    if row.marked && marks.is_empty() {
        marks.push((0, text.chars().count(), Mark::Section));
    }
    Line {
        text,
        current: row.current,
        marks,
    }
}

/// The soft-key row of an editor.
pub(crate) fn soft_keys(editor: &Editor) -> SoftKeys {
    let view = editor.view(0, 0);
    let (row, rows) = view.soft_row;
    SoftKeys {
        keys: view.soft_keys.to_vec(),
        row,
        rows,
    }
}
