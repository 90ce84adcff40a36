//! The pages of the panel.

mod list;
mod messages;
mod parameters;
mod positions;
mod programs;
mod tools;
mod zero;

use bahn_live::Refusal;
use bahn_screen::{Window, WindowKind};

pub(crate) use messages::Messages;
pub(crate) use parameters::Parameters;
pub(crate) use positions::PositionsPage;
pub(crate) use programs::ProgramsPage;
pub(crate) use tools::ToolsPage;
pub(crate) use zero::ZeroPage;

use crate::sight::{Desk, Sight};

/// Lines of a window.
pub(crate) const LINES: usize = 16;

/// Where the cursor goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arrow {
    Up,
    Down,
    Left,
    Right,
}

/// A page: what it shows, and what it does with what the operator enters.
pub(crate) trait Page {
    /// Its window.
    fn window(&self, sight: &Sight<'_>) -> Window;

    /// The program stands beside it.
    fn has_program(&self) -> bool {
        false
    }

    /// What it asks for; empty when it takes nothing.
    fn prompt(&self, sight: &Sight<'_>) -> String;

    /// The texts of its own two soft keys; empty ones do nothing.
    fn soft_keys(&self, _sight: &Sight<'_>) -> [&'static str; 2] {
        [""; 2]
    }

    /// One of them is pressed, 0 or 1.
    ///
    /// # Errors
    /// What holds the operator back.
    fn soft_key(&mut self, _which: usize, _desk: &mut Desk<'_>) -> Result<(), Refusal> {
        Ok(())
    }

    /// The cursor goes on.
    fn go(&mut self, _arrow: Arrow, _sight: &Sight<'_>) {}

    /// Takes what was entered; nothing was when it is empty.
    ///
    /// # Errors
    /// Why it is not taken: then it stays in the line.
    fn enter(&mut self, entry: &str, desk: &mut Desk<'_>) -> Result<(), Refusal>;
}

/// A window of text.
pub(crate) fn text_window(title: String, lines: Vec<String>) -> Window {
    let total = lines.len();
    let lines = lines.into_iter().map(|text| bahn_screen::Line {
        text,
        ..bahn_screen::Line::default()
    });
    Window {
        title,
        kind: WindowKind::Text,
        lines: lines.collect(),
        first: 0,
        total,
    }
}
