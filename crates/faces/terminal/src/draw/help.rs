//! The list of all short cuts and commands, over the screen.

use bahn_panel::{EMERGENCY_STOP, Press, SHORTCUTS, Shortcut, filled};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph};

use super::{Scene, block, rows};
use crate::commands::COMMANDS;
use crate::palette::Role;

/// What the terminal has beside the table.
const OWN: &[(&str, &str)] = &[
    ("A-Z 0-9", "letters and digits"),
    ("? or F9", "this list"),
    ("Tab", "keys of the machine"),
    (":", "command line"),
    ("Ctrl+C", "ends"),
];
/// Columns of a short cut.
const COLUMN: u16 = 39;
/// Columns of what is pressed.
const REAL: usize = 14;

/// Draws the list; how far it can be scrolled.
pub(super) fn draw(frame: &mut Frame, scene: &Scene, scrolled: u16) -> u16 {
    let screen = frame.area();
    let area = Rect {
        y: screen.y + 1,
        height: screen.height - 2,
        ..screen
    };
    let frame_around = block(scene, scene.words("SHORT CUTS"))
        .title_bottom(scene.words(" arrows scroll, any other key closes "));
    let inner = frame_around.inner(area);
    let lines = lines(scene, inner.width);
    let most = rows(lines.len()).saturating_sub(inner.height);
    frame.render_widget(Clear, area);
    let text = Paragraph::new(lines).scroll((scrolled.min(most), 0));
    frame.render_widget(text.block(frame_around), area);
    most
}

fn lines(scene: &Scene, width: u16) -> Vec<Line<'static>> {
    let own = OWN
        .iter()
        .map(|(real, what)| (scene.words(real).to_owned(), scene.words(what).to_owned()));
    let table = SHORTCUTS.iter().filter(|shortcut| is_there(scene, shortcut));
    let table = table.map(|shortcut| (real(shortcut), what(scene, shortcut)));
    let entries: Vec<_> = own.chain(table).collect();
    // Read down the first column, then the next.
    let columns = usize::from(width / COLUMN).max(1);
    let height = entries.len().div_ceil(columns);
    let mut lines = Vec::new();
    for row in 0..height {
        let cells = entries.iter().skip(row).step_by(height);
        lines.push(Line::from(
            cells
                .flat_map(|(real, what)| entry(scene, real, what, COLUMN.into()))
                .collect::<Vec<_>>(),
        ));
    }
    lines.push(Line::default());
    for command in COMMANDS {
        let real = format!(":{} {}", command.word, scene.words(command.argument));
        lines.push(Line::from(vec![
            Span::styled(format!(" {real:<31}"), scene.palette.style(Role::Value)),
            Span::raw(scene.words(command.what)),
        ]));
    }
    lines
}

fn entry(scene: &Scene, real: &str, what: &str, width: usize) -> [Span<'static>; 2] {
    let room = width.saturating_sub(REAL + 1);
    let mut what = what.to_owned();
    if what.chars().count() > room {
        what = what.chars().take(room.saturating_sub(1)).chain(['…']).collect();
    }
    [
        Span::styled(format!(" {real:<REAL$}"), scene.palette.style(Role::Value)),
        Span::raw(format!("{what:<room$}")),
    ]
}

/// Keys that this machine or its control does not have are left out.
fn is_there(scene: &Scene, shortcut: &Shortcut) -> bool {
    match shortcut.press {
        Press::Machine(name) => scene.desk.machine.key(name).is_some(),
        Press::Key(key) => scene.desk.machine.has(key),
        _ => true,
    }
}

fn real(shortcut: &Shortcut) -> String {
    let name = shortcut.real.strip_prefix("Arrow").unwrap_or(shortcut.real);
    match shortcut.alt {
        true => format!("Alt+{}", name.to_uppercase()),
        false => name.to_owned(),
    }
}

fn what(scene: &Scene, shortcut: &Shortcut) -> String {
    let turned = |words, step: f64| filled(scene.words(words), &[&format!("{step:+}")]);
    match shortcut.press {
        Press::Key(key) => scene.words(key.label()).to_owned(),
        Press::Machine(EMERGENCY_STOP) => scene.words("EMERGENCY STOP").to_owned(),
        Press::Machine(name) => name.replace('_', " "),
        Press::Feed(step) => turned("feed override {1} %", step),
        Press::Spindle(step) => turned("spindle override {1} %", step),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_panel::{Language, texts_around};

    #[test]
    fn the_list_is_translated() {
        let table = texts_around(Language::German);
        let commands = COMMANDS
            .iter()
            .flat_map(|command| [command.argument, command.what]);
        let own = OWN.iter().flat_map(|(real, what)| [*real, *what]);
        // Names of keys are those of the machine or of the real keyboard.
        let names = ["", "Tab", ":", "Ctrl+C"];
        let texts = commands.chain(own).filter(|text| !names.contains(text));
        let missing: Vec<_> = texts.filter(|text| !table.contains_key(text)).collect();
        assert!(missing.is_empty(), "{missing:#?}");
    }
}
