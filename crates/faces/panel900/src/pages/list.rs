//! A table with a cursor: rows in sight around it, its cell stands out.

use bahn_screen::{Line, Mark, Window, WindowKind};

use super::{Arrow, LINES};

/// Where the cursor is: row and column, from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cursor {
    pub row: usize,
    pub column: usize,
}

impl Cursor {
    /// Goes on in a table of so many rows and columns.
    pub fn go(&mut self, arrow: Arrow, rows: usize, columns: usize) {
        match arrow {
            Arrow::Up => self.row = self.row.saturating_sub(1),
            Arrow::Down => self.row += 1,
            Arrow::Left => self.column = self.column.saturating_sub(1),
            Arrow::Right => self.column += 1,
        }
        self.keep_within(rows, columns);
    }

    pub fn keep_within(&mut self, rows: usize, columns: usize) {
        self.row = self.row.min(rows.saturating_sub(1));
        self.column = self.column.min(columns.saturating_sub(1));
    }
}

/// A table: the heads of its columns with their widths, and its rows. A head that is empty has no cell for the cursor: those
/// before the first with one name the row.
pub(crate) struct Table<'a> {
    pub title: String,
    pub heads: &'a [(&'a str, usize)],
    /// How many columns name a row.
    pub naming: usize,
    pub rows: Vec<Vec<String>>,
}

impl Table<'_> {
    pub fn window(self, cursor: Cursor) -> Window {
        let total = self.rows.len();
        let most = LINES - 1;
        let first = cursor
            .row
            .saturating_sub(most / 2)
            .min(total.saturating_sub(most));
        let padded = |text: &str, place: usize, width: usize| match place < self.naming {
            true => format!("{text:<width$}"),
            false => format!("{text:>width$}"),
        };
        let heads = self.heads.iter().enumerate();
        let head = heads
            .map(|(place, (head, width))| padded(head, place, *width))
            .collect::<Vec<_>>();
        let head = head.join(" ");
        let length = head.chars().count();
        let mut lines = vec![Line {
            text: head,
            current: false,
            marks: vec![(0, length, Mark::Quiet)],
        }];
        for (place, row) in self.rows.iter().enumerate().skip(first).take(most) {
            let mut text = String::new();
            let mut marks = Vec::new();
            for (column, (cell, (_, width))) in row.iter().zip(self.heads).enumerate() {
                if column > 0 {
                    text.push(' ');
                }
                let from = text.chars().count();
                text += &padded(cell, column, *width);
                if place == cursor.row && column == cursor.column + self.naming {
                    marks.push((from, text.chars().count(), Mark::Cursor));
                }
            }
            lines.push(Line {
                text,
                current: place == cursor.row,
                marks,
            });
        }
        Window {
            title: self.title,
            kind: WindowKind::Table,
            lines,
            first,
            total,
        }
    }
}
