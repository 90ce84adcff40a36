//! POSITIONING WITH MANUAL DATA INPUT: one positioning block, entered and executed, not stored [003:3564-3617].

use bahn_control::Command;
use bahn_dialogue::Key;

use crate::page::{Page, Turn, View};
use crate::screen::{Line, Window, WindowKind};
use crate::site::Site;

/// The block that NC start executes.
#[derive(Default)]
pub(crate) struct Mdi {
    block: String,
}

impl Page for Mdi {
    fn key(&mut self, _key: Key, _site: &mut Site) -> Turn {
        Turn::Refused
    }

    fn text(&mut self, text: &str, site: &mut Site) -> Turn {
        match site.command(Command::Mdi(text.to_owned())) {
            true => {
                text.clone_into(&mut self.block);
                Turn::Done
            }
            false => Turn::Refused,
        }
    }

    fn show(&self, _site: &Site, _lines: usize) -> View {
        View::of(Window {
            title: "$MDI".to_owned(),
            kind: WindowKind::Program,
            lines: vec![Line {
                text: self.block.clone(),
                current: true,
                ..Line::default()
            }],
            first: 0,
            total: 1,
        })
    }
}
