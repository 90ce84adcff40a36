//! The picture of a page without a program.

use bahn_screen::{Line, Window, WindowKind};

use crate::page::View;
use crate::site::Site;

/// Where no program is selected: which key does.
pub(super) fn no_program(site: &Site) -> View {
    let line = Line {
        text: site.words("SELECT A PROGRAM WITH PGM NR"),
        ..Line::default()
    };
    View::of(Window {
        kind: WindowKind::Text,
        lines: vec![line],
        total: 1,
        ..Window::default()
    })
}
