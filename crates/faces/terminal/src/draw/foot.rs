//! The last line: the command that is typed, what is to be said, or which keys there are; and how time passes.

use bahn_panel::filled;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};

use super::{Scene, rows};
use crate::palette::Role;

const HINT: &str = " ? keys  Tab machine  : command  Ctrl+C ends";
const HINT_AT_THE_MACHINE: &str = " + - F  * / S  < > wheel  A-Z stay down  Tab back";

pub(super) fn draw(frame: &mut Frame, scene: &Scene, area: Rect) {
    let time = time(scene);
    let width = rows(time.chars().count());
    let [left, right] = Layout::horizontal([Constraint::Min(10), Constraint::Length(width)]).areas(area);
    frame.render_widget(Span::styled(time, scene.palette.style(Role::Value)), right);
    let desk = scene.desk;
    let line = match &desk.line {
        Some(line) => {
            // The end of a long line is in sight.
            let room = usize::from(left.width).saturating_sub(2);
            let skip = line.chars().count().saturating_sub(room);
            let shown: String = line.chars().skip(skip).collect();
            let cursor = Span::styled(" ", scene.palette.style(Role::Held));
            match desk.notice.is_empty() {
                true => Line::from(vec![Span::raw(":"), Span::raw(shown), cursor]),
                false => Line::from(format!(":{shown}   {}", desk.notice)),
            }
        }
        None if !desk.notice.is_empty() => {
            Line::styled(format!(" {}", desk.notice), scene.palette.style(Role::Prompt))
        }
        None => {
            let hint = if desk.at_the_machine {
                HINT_AT_THE_MACHINE
            } else {
                HINT
            };
            Line::styled(scene.words(hint), scene.palette.style(Role::Quiet))
        }
    };
    frame.render_widget(line, left);
}

/// What is not as usual: the supply, how fast time passes, where it stands; and the knobs.
fn time(scene: &Scene) -> String {
    let (machine, line) = (&scene.screen.machine, &scene.screen.timeline);
    let mut parts = Vec::new();
    if !machine.power {
        parts.push(scene.words("OFF").to_owned());
    }
    if machine.paused {
        let words = scene.words("time stands at {1} s");
        parts.push(filled(words, &[&format!("{:.1}", line.now_s)]));
    } else if machine.speed != 1.0 {
        parts.push(filled(scene.words("time x{1}"), &[&machine.speed.to_string()]));
    }
    let (axis, factor) = machine.handwheel;
    let [feed, spindle] = machine.knobs;
    parts.push(format!("F {feed:.0} % S {spindle:.0} % {axis}/{factor} "));
    parts.join("  ")
}
