//! The machine operating panel: keys, lamps, EMERGENCY STOP, knobs.

use bahn_panel::EMERGENCY_STOP;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};

use super::{Scene, rows};
use crate::desk::{Target, Targets};
use crate::machine::{Machine, STOP_LETTER};
use crate::palette::Role;

/// A key or a lamp as it is drawn.
struct Button {
    spans: Vec<Span<'static>>,
    target: Option<Target>,
}

impl Button {
    fn width(&self) -> u16 {
        rows(self.spans.iter().map(Span::width).sum())
    }
}

/// Rows that the panel needs: all keys where there is room or the keys are those of the machine, else the lamps.
pub(super) fn height(scene: &Scene, width: u16, roomy: bool) -> u16 {
    match roomy || scene.desk.at_the_machine {
        false => 1,
        true => placed(&buttons(scene), width)
            .last()
            .map_or(1, |(_, row)| row + 1),
    }
}

pub(super) fn draw(frame: &mut Frame, scene: &Scene, area: Rect, roomy: bool, targets: &mut Targets) {
    let shown = match roomy || scene.desk.at_the_machine {
        true => buttons(scene),
        false => std::iter::once(stop(scene)).chain(lamps(scene)).collect(),
    };
    let places = placed(&shown, area.width);
    for (button, (column, row)) in shown.into_iter().zip(places) {
        let own = Rect::new(area.x + column, area.y + row, button.width(), 1).intersection(area);
        frame.render_widget(Line::from(button.spans), own);
        if let Some(target) = button.target {
            targets.0.push((own, target));
        }
    }
}

/// Column and row of each, one after the other.
fn placed(buttons: &[Button], width: u16) -> Vec<(u16, u16)> {
    let (mut column, mut row) = (0, 0);
    let place = |button: &Button| {
        if column > 0 && column + button.width() > width {
            (column, row) = (0, row + 1);
        }
        let place = (column, row);
        column += button.width() + 1;
        place
    };
    buttons.iter().map(place).collect()
}

/// EMERGENCY STOP, the keys, the lamps that are no key.
fn buttons(scene: &Scene) -> Vec<Button> {
    let machine = &scene.desk.machine;
    let keys = machine.keys.iter().enumerate();
    let keys = keys.map(|(place, name)| key(scene, place, name));
    let others = scene
        .screen
        .lamps
        .iter()
        .filter(|(name, _)| !machine.keys.contains(name));
    let others = others.map(|(name, lit)| lamp(scene, name, *lit));
    std::iter::once(stop(scene)).chain(keys).chain(others).collect()
}

/// All lamps, the lit ones first: where there is no room for all, those that are lit are seen.
fn lamps(scene: &Scene) -> impl Iterator<Item = Button> {
    let lamps = &scene.screen.lamps;
    let lit = lamps.iter().filter(|(_, lit)| **lit);
    let dark = lamps.iter().filter(|(_, lit)| !**lit);
    lit.chain(dark).map(|(name, lit)| lamp(scene, name, *lit))
}

fn lamp(scene: &Scene, name: &str, lit: bool) -> Button {
    let (sign, role) = match lit {
        true => ("●", Role::Lit),
        false => ("○", Role::Quiet),
    };
    Button {
        spans: vec![Span::styled(format!("{sign} {name}"), scene.palette.style(role))],
        target: None,
    }
}

fn key(scene: &Scene, place: usize, name: &str) -> Button {
    let held = scene.screen.machine.held.iter().any(|held| held == name);
    let lamp = scene.screen.lamps.get(name);
    let mut style = match lamp {
        Some(true) => scene.palette.style(Role::Lit),
        _ => scene.palette.style(Role::Button),
    };
    if held {
        style = style.patch(scene.palette.style(Role::Held));
    }
    let sign = match lamp {
        Some(true) => "●",
        Some(false) => "○",
        None => "",
    };
    let mut spans = letter(scene, Machine::letter(place));
    spans.push(Span::styled(format!("[{sign}{name}]"), style));
    Button {
        spans,
        target: Some(Target::Machine(name.to_owned())),
    }
}

fn stop(scene: &Scene) -> Button {
    let style = match scene.screen.machine.emergency_stop {
        true => scene.palette.style(Role::Flashing),
        false => scene
            .palette
            .style(Role::Fault)
            .remove_modifier(Modifier::UNDERLINED),
    };
    let mut spans = letter(scene, Some(STOP_LETTER));
    spans.push(Span::styled(
        format!("[{}]", scene.words("EMERGENCY STOP")),
        style,
    ));
    Button {
        spans,
        target: Some(Target::Machine(EMERGENCY_STOP.to_owned())),
    }
}

/// What presses a key, while the keys are those of the machine.
fn letter(scene: &Scene, letter: Option<char>) -> Vec<Span<'static>> {
    match letter {
        Some(letter) if scene.desk.at_the_machine => {
            vec![Span::styled(
                letter.to_string(),
                scene.palette.style(Role::Letter),
            )]
        }
        _ => vec![Span::styled(String::new(), Style::new())],
    }
}
