//! A row of soft keys after those of an editor, while it has no block open (inferred).

use bahn_dialogue::{Editor, Key};
use bahn_screen::SoftKeys;

use crate::page::Turn;
use crate::pages::editing;

/// Whether the row is shown.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowAfter {
    shown: bool,
}

impl RowAfter {
    /// A key that changes the row; `None` leaves it to the editor.
    pub fn turn(&mut self, key: Key, editor: &Editor) -> Option<Turn> {
        if editor.is_open() {
            return None;
        }
        let (row, rows) = editor.view(0, 0).soft_row;
        let (first, last) = (row == 0, row + 1 >= rows);
        let (leaves, arrived) = match key {
            Key::SkRight => (last, first),
            Key::SkLeft => (first, last),
            _ => return None,
        };
        // After the last row comes the first one, where the editor may stand already.
        if std::mem::take(&mut self.shown) {
            return arrived.then_some(Turn::Done);
        }
        self.shown = leaves;
        leaves.then_some(Turn::Done)
    }

    /// The place of a soft key in it, from 0; `None` for any other key, and while it is not shown.
    pub fn place(&self, key: Key, editor: &Editor) -> Option<usize> {
        key.soft_key().filter(|_| self.shown && !editor.is_open())
    }

    /// The row that is shown, with the texts of this one.
    pub fn show(&self, editor: &Editor, texts: impl FnOnce() -> Vec<String>) -> SoftKeys {
        let mut keys = editing::soft_keys(editor);
        if !editor.is_open() {
            if self.shown {
                keys.keys = texts();
                keys.row = keys.rows;
            }
            keys.rows += 1;
        }
        keys
    }
}
