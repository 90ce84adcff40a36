//! What the screen looks like: regions from top to bottom.

mod foot;
mod help;
mod machine;
mod scene;
mod soft_keys;
mod status;
mod windows;

use bahn_panel::{Key, filled};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use crate::desk::{Target, Targets};
use crate::palette::Role;

pub(crate) use scene::Scene;
use scene::{block, rows};

/// Fewer columns or rows are no screen.
const LEAST: (u16, u16) = (60, 18);
/// From so many rows on there is room for everything; below, what is less important is short.
const ROOMY: u16 = 32;
/// Columns of the status window.
const STATUS: u16 = 30;
/// Share of the rows beyond [`ROOMY`] that messages, reasons and lesson may take: a third.
const SHARE: u16 = 3;

/// Where something was drawn that others need.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Drawn {
    /// What can be clicked.
    pub targets: Targets,
    /// Where the part is drawn.
    pub graphics: Option<Rect>,
    /// How far the list of short cuts can be scrolled.
    pub help_end: u16,
}

/// Draws the whole screen of the terminal.
pub(crate) fn draw(frame: &mut Frame, scene: &Scene) -> Drawn {
    let area = frame.area();
    let mut drawn = Drawn::default();
    if area.width < LEAST.0 || area.height < LEAST.1 {
        let least = [LEAST.0, LEAST.1].map(|side| side.to_string());
        let words = scene.words("The window is too small: {1} x {2} at least");
        let words = filled(words, &[&least[0], &least[1]]);
        frame.render_widget(Paragraph::new(words), area);
        return drawn;
    }
    let screen = scene.screen;
    let spare = area.height.saturating_sub(24);
    // Never more than a third of what is to spare.
    let share = |count: usize, least: u16| rows(count).min(least + spare / SHARE);
    let messages = share(screen.messages.len(), 1).max(1);
    let why = share(windows::why_height(&screen.why, area.width), 2);
    let plc = screen.plc_window.as_ref().map_or(0, |lines| rows(lines.len()));
    let lesson = screen.lesson.as_ref().map_or(0, |lesson| {
        windows::lesson_height(lesson, area.width).min(6 + spare / SHARE)
    });
    let machine = machine::height(scene, area.width, area.height >= ROOMY);
    let soft = match screen.look.layout {
        bahn_panel::Layout::Monochrome => 0,
        _ => 3,
    };
    let parts = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(1),
        Constraint::Length(messages),
        Constraint::Min(6),
        Constraint::Length(plc),
        Constraint::Length(why),
        Constraint::Length(lesson),
        Constraint::Length(soft),
        Constraint::Length(machine),
        Constraint::Length(1),
    ]);
    let [head, dialogue, said, middle, plc, why, lesson, soft, keys, foot] = parts.areas(area);
    headings(frame, scene, head, &mut drawn.targets);
    prompt(frame, scene, dialogue);
    say(frame, scene, said);
    let [left, right] = Layout::horizontal([Constraint::Min(20), Constraint::Length(STATUS)]).areas(middle);
    drawn.graphics = windows::draw(frame, scene, left);
    status::draw(frame, scene, right);
    windows::plc(frame, scene, plc);
    windows::why(frame, scene, why);
    windows::lesson(frame, scene, lesson);
    if soft.height > 0 {
        soft_keys::draw(frame, scene, soft, &mut drawn.targets);
    }
    machine::draw(frame, scene, keys, area.height >= ROOMY, &mut drawn.targets);
    foot::draw(frame, scene, foot);
    if let Some(scrolled) = scene.desk.help {
        drawn.help_end = help::draw(frame, scene, scrolled);
    }
    drawn
}

/// The headings of both sides; that which has the keys is in reverse video.
fn headings(frame: &mut Frame, scene: &Scene, area: Rect, targets: &mut Targets) {
    let headings = &scene.screen.headings;
    let width = area.width / rows(headings.len().max(1));
    for (place, heading) in (0..).zip(headings) {
        let own = Rect {
            x: area.x + place * width,
            width,
            ..area
        };
        let role = if heading.active {
            Role::Active
        } else {
            Role::Beside
        };
        let style = scene.palette.style(role);
        let text = Span::styled(format!(" {} ", heading.title), style);
        let line = Line::from(text);
        frame.render_widget(Paragraph::new(line.centered()).style(style), own);
        if let Some(key) = Key::from_name(&heading.key) {
            targets.0.push((own, Target::Key(key)));
        }
    }
}

/// Draws the line of the dialogue.
fn prompt(frame: &mut Frame, scene: &Scene, area: Rect) {
    let dialogue = &scene.screen.dialogue;
    let mut spans = vec![Span::styled(
        format!(" {}", dialogue.prompt),
        scene.palette.style(Role::Prompt),
    )];
    if !dialogue.entry.is_empty() {
        let entry = Span::styled(dialogue.entry.clone(), scene.palette.style(Role::Entry));
        spans.extend([Span::raw(" "), entry]);
    }
    frame.render_widget(Line::from(spans), area);
}

/// The messages in reverse video, those that flash first, then the latest.
fn say(frame: &mut Frame, scene: &Scene, area: Rect) {
    let messages = &scene.screen.messages;
    let (flashing, others): (Vec<_>, Vec<_>) = messages.iter().partition(|message| message.flashing);
    let all = flashing.into_iter().chain(others.into_iter().rev());
    let room = usize::from(area.height);
    let more = messages.len().saturating_sub(room);
    for (row, (at, message)) in area.rows().zip(all.enumerate()) {
        let role = if message.flashing {
            Role::Flashing
        } else {
            Role::Message
        };
        let place = message
            .place
            .as_ref()
            .map_or(String::new(), |place| format!("{place}  "));
        let more = match more > 0 && at + 1 == room {
            true => format!("  (+{more})"),
            false => String::new(),
        };
        let text = format!(" {place}{}{more} ", message.text);
        frame.render_widget(Span::styled(text, scene.palette.style(role)), row);
    }
}
