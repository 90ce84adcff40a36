//! What is drawn, and the frame round a part of it.

use bahn_panel::{Screen, around};

use ratatui::style::Style;
use ratatui::text::Span;
use ratatui::widgets::{Block, BorderType};

use crate::desk::Desk;
use crate::graphics::Mosaic;
use crate::palette::{Palette, Role};

/// What the screen of the terminal is drawn from.
pub(crate) struct Scene<'a> {
    /// The screen of the control.
    pub screen: &'a Screen,
    /// The desk in front of it.
    pub desk: &'a Desk,
    /// The part as the graphics show it, when it was drawn.
    pub part: Option<&'a Mosaic>,
    /// The colours of the terminal.
    pub palette: Palette,
}

impl Scene<'_> {
    /// A text around the screen in the language of the control.
    pub fn words(&self, english: &'static str) -> &'static str {
        around(self.screen.look.language, english)
    }
}

pub(super) fn rows(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

/// A frame with a title.
pub(super) fn block(scene: &Scene, title: &str) -> Block<'static> {
    let title = match title.is_empty() {
        true => String::new(),
        false => format!(" {title} "),
    };
    Block::bordered()
        .border_type(BorderType::Plain)
        .border_style(scene.palette.style(Role::Frame))
        .title(Span::styled(title, Style::new().bold()))
}
