//! What takes the keys and shows itself: an operating mode, a menu, a table, an editor.

use bahn_dialogue::Key;
use bahn_graphics::Subject;
use bahn_screen::{Dialogue, SoftKeys, Window};

use crate::site::Site;

/// The two sides of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// The machine operating mode.
    Machine,
    /// PROGRAMMING AND EDITING or TEST RUN.
    Programming,
}

impl Side {
    /// The one beside it.
    pub fn other(self) -> Side {
        match self {
            Side::Machine => Side::Programming,
            Side::Programming => Side::Machine,
        }
    }
}

/// What came of a key.
pub(crate) enum Turn {
    /// The page has taken the key, and stays.
    Done,
    /// The page is through: what stood below it has the keys again.
    Close,
    /// Another page stands on this one.
    Open(Box<dyn Page>),
    /// Another page takes the place of this one.
    Replace(Box<dyn Page>),
    /// It does not belong here: KEY NON-FUNCTIONAL [003:7950].
    Refused,
    /// A message, in words of the control.
    Say(String),
    /// The page is through, with a message.
    CloseSaying(String),
}

/// Something that takes the keys. Pages stand on each other: the topmost one has the keys.
pub(crate) trait Page: Send {
    /// A key of the keyboard that chooses no operating mode; a soft key only with [`Page::own_soft_keys`].
    fn key(&mut self, key: Key, site: &mut Site) -> Turn;

    /// The texts of the soft keys, row by row, at most eight in each.
    fn soft_keys(&self, _site: &Site) -> Vec<Vec<String>> {
        Vec::new()
    }

    /// A soft key, by its row and its place there, from 0, that has a text.
    fn soft_key(&mut self, _row: usize, _place: usize, _site: &mut Site) -> Turn {
        Turn::Refused
    }

    /// The soft-key row of a page that takes soft keys as keys, with those that change the row.
    fn own_soft_keys(&self) -> Option<SoftKeys> {
        None
    }

    /// What it shows, in a window of so many lines.
    fn show(&self, site: &Site, lines: usize) -> View;

    /// The part that the graphics show beside it.
    fn subject(&self) -> Option<Subject> {
        None
    }

    /// Once in every contour cycle: what goes on without a key.
    fn tick(&mut self, _site: &mut Site) -> Turn {
        Turn::Done
    }

    /// What it is to module 9035, where it lies over an operating mode.
    fn overlay(&self) -> Overlay {
        Overlay::None
    }

    /// The file that it edits or tests.
    fn file(&self) -> Option<&str> {
        None
    }

    /// CAPTURE in MANUAL OPERATION or ELECTRONIC HANDWHEEL, for what is programmed beside it [003:2287-2316].
    fn capture(&mut self, _site: &mut Site) -> Turn {
        Turn::Refused
    }

    /// Something that was pasted or typed as a whole line; most pages take none.
    fn text(&mut self, _text: &str, _site: &mut Site) -> Turn {
        Turn::Refused
    }
}

/// What lies over an operating mode, for module 9035 [000:14899-14900].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Overlay {
    /// Nothing, or what belongs to the mode.
    #[default]
    None,
    /// The MOD function.
    Mode,
    /// A directory, or EXT.
    Directory,
    /// The editor of machine parameters.
    Parameters,
    /// A table: that of the tools on the machine screen, a file of the mode on the editing screen.
    Table,
    /// A page of the PLC mode.
    Plc,
}

impl Overlay {
    /// Its code in item 2 for the editing screen, or in item 3 for the machine screen; `None` where what lies below says it:
    /// the machine screen has codes for MOD alone, not for what its code numbers open.
    pub fn code(self, side: Side) -> Option<u8> {
        match (self, side) {
            (Overlay::None, _) | (Overlay::Parameters | Overlay::Plc, Side::Machine) => None,
            (Overlay::Table, Side::Programming) => Some(0),
            (Overlay::Mode, _) => Some(1),
            (Overlay::Directory, _) => Some(2),
            (Overlay::Parameters, Side::Programming) | (Overlay::Table, Side::Machine) => Some(3),
            (Overlay::Plc, Side::Programming) => Some(4),
        }
    }
}

/// What a page shows.
#[derive(Default)]
pub(crate) struct View {
    /// Its window; `None` leaves that of the page below.
    pub window: Option<Window>,
    /// What the dialogue line asks or says.
    pub dialogue: Dialogue,
}

impl View {
    /// A window without a question.
    pub fn of(window: Window) -> View {
        View {
            window: Some(window),
            dialogue: Dialogue::default(),
        }
    }
}

/// Lines of which a window shows a part, so that the current one is in sight and does not move more than it must:
/// the place of the first.
pub(crate) fn first_in_sight(current: usize, total: usize, lines: usize) -> usize {
    current.saturating_sub(lines / 2).min(total.saturating_sub(lines))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_current_line_is_in_sight() {
        // 100 lines in a window of 10: the current one stands in the middle, but at both ends.
        assert_eq!(first_in_sight(0, 100, 10), 0);
        assert_eq!(first_in_sight(4, 100, 10), 0);
        assert_eq!(first_in_sight(50, 100, 10), 45);
        assert_eq!(first_in_sight(99, 100, 10), 90);
        assert_eq!(first_in_sight(3, 5, 10), 0);
    }
}
