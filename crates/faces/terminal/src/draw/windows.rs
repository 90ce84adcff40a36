//! The large window, what stands beside it, and what is written below.

use bahn_panel::{
    LessonLine, LessonState, Line as ScreenLine, Mark, PlcLine, Status, Window, WindowKind, filled,
};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use super::{Scene, block, rows};
use crate::palette::Role;

/// Two windows stand beside each other from so many columns on; below, one under the other.
const BESIDE: u16 = 90;
/// Rows of the program above the graphics.
const ABOVE: u16 = 6;

/// Draws the windows; where the part is to be drawn.
pub(super) fn draw(frame: &mut Frame, scene: &Scene, area: Rect) -> Option<Rect> {
    let screen = scene.screen;
    let wide = area.width >= BESIDE;
    let (texts, picture) = match &screen.graphics {
        None => (area, None),
        Some(_) if wide => {
            let [left, right] =
                Layout::horizontal([Constraint::Percentage(45), Constraint::Min(20)]).areas(area);
            (left, Some(right))
        }
        Some(_) => {
            let [upper, lower] =
                Layout::vertical([Constraint::Length(ABOVE), Constraint::Min(4)]).areas(area);
            (upper, Some(lower))
        }
    };
    match &screen.beside {
        None => window(frame, scene, &screen.program, texts),
        Some(beside) => {
            let halves = [Constraint::Fill(1), Constraint::Fill(1)];
            let [one, other] = match texts.width >= BESIDE || texts.height < 12 {
                true => Layout::horizontal(halves).areas(texts),
                false => Layout::vertical(halves).areas(texts),
            };
            // The machine stands on the left, as in the header.
            let machine_first = screen.headings.first().is_some_and(|heading| heading.active);
            let (left, right) = match machine_first {
                true => (&screen.program, beside),
                false => (beside, &screen.program),
            };
            window(frame, scene, left, one);
            window(frame, scene, right, other);
        }
    }
    picture.map(|picture| graphics(frame, scene, picture))
}

/// The frame of the graphics with what is known of them; the inner rectangle.
fn graphics(frame: &mut Frame, scene: &Scene, area: Rect) -> Rect {
    let mut title = Vec::new();
    if let Some(graphics) = &scene.screen.graphics {
        title.push(scene.words("GRAPHICS").to_owned());
        if graphics.magn > 1 {
            title.push(format!("MAGN {}", graphics.magn));
        }
        if let Some(time_s) = graphics.machining_time_s {
            let s = time_s.round() as u64;
            title.push(format!("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60));
        }
        if graphics.running {
            title.push(format!("{:.0} %", 100.0 * graphics.progress));
        }
    }
    let frame_around = block(scene, &title.join("  "));
    let inner = frame_around.inner(area);
    frame.render_widget(frame_around, area);
    if let Some(part) = scene.part {
        part.draw(frame.buffer_mut(), inner, scene.palette);
    }
    inner
}

/// A window of lines.
fn window(frame: &mut Frame, scene: &Scene, shown: &Window, area: Rect) {
    let frame_around = block(scene, &shown.title);
    let inner = frame_around.inner(area);
    frame.render_widget(frame_around, area);
    if inner.is_empty() {
        return;
    }
    let lines = match shown.kind {
        WindowKind::Positions => positions(scene, &scene.screen.status, inner),
        WindowKind::Program => program(scene, &shown.lines, inner),
        _ => listed(scene, &shown.lines, inner),
    };
    frame.render_widget(Paragraph::new(lines), inner);
    if let Some(words) = beyond(scene, shown) {
        let width = rows(words.chars().count());
        let corner = Rect {
            x: area.right().saturating_sub(width + 2).max(area.x),
            y: area.bottom() - 1,
            width: width.min(area.width),
            height: 1,
        };
        frame.render_widget(Span::styled(words, scene.palette.style(Role::Quiet)), corner);
    }
}

/// Which lines are in sight, when there are more.
fn beyond(scene: &Scene, shown: &Window) -> Option<String> {
    (shown.total > shown.lines.len()).then(|| {
        let last = (shown.first + shown.lines.len()).min(shown.total);
        let lines = [shown.first + 1, last, shown.total].map(|line| line.to_string());
        let lines = lines.each_ref().map(String::as_str);
        filled(scene.words(" {1}-{2} of {3} "), &lines)
    })
}

/// The blocks of a program: the current one between two lines.
fn program(scene: &Scene, lines: &[ScreenLine], area: Rect) -> Vec<Line<'static>> {
    let Some(current) = lines.iter().position(|line| line.current) else {
        return listed(scene, lines, area);
    };
    let height = usize::from(area.height).saturating_sub(2).max(1);
    let first = first(current, lines.len(), height);
    let rule = "─".repeat(area.width.into());
    let rule = || Line::from(Span::styled(rule.clone(), scene.palette.style(Role::Frame)));
    let mut drawn = Vec::new();
    for (place, line) in lines.iter().enumerate().skip(first).take(height) {
        let is_current = place == current && area.height > 2;
        drawn.extend(is_current.then(rule));
        drawn.push(shifted(scene, line, shift(line, area.width), Role::Current));
        drawn.extend(is_current.then(rule));
    }
    drawn
}

/// Lines as they are, the current one in sight.
fn listed(scene: &Scene, lines: &[ScreenLine], area: Rect) -> Vec<Line<'static>> {
    let height = usize::from(area.height);
    let current = lines.iter().position(|line| line.current).unwrap_or(0);
    let first = first(current, lines.len(), height);
    // A table is shifted as a whole, so that its columns stay below each other.
    let shift = lines
        .iter()
        .map(|line| shift(line, area.width))
        .max()
        .unwrap_or(0);
    let drawn = lines.iter().skip(first).take(height);
    drawn.map(|line| listed_line(scene, line, shift)).collect()
}

/// The first line of so many in sight.
fn first(current: usize, total: usize, height: usize) -> usize {
    current
        .saturating_sub(height / 2)
        .min(total.saturating_sub(height))
}

/// The chosen line is in reverse video, but where a word or a cell of it is chosen.
fn listed_line(scene: &Scene, line: &ScreenLine, shift: usize) -> Line<'static> {
    let role = match line.marks.is_empty() {
        true => Role::Chosen,
        false => Role::Current,
    };
    shifted(scene, line, shift, role)
}

/// By how many characters a line is moved to the left, so that the place of the cursor is in sight.
fn shift(line: &ScreenLine, width: u16) -> usize {
    let cursor = line
        .marks
        .iter()
        .find(|(_, _, mark)| matches!(mark, Mark::Cursor | Mark::Entry));
    match cursor {
        Some((from, to, _)) if line.current => {
            let width = usize::from(width);
            // One more, where the next character comes.
            (to + 1).saturating_sub(width).min(*from)
        }
        _ => 0,
    }
}

fn shifted(scene: &Scene, line: &ScreenLine, shift: usize, current: Role) -> Line<'static> {
    let base = match line.current {
        true => scene.palette.style(current),
        false => Style::new(),
    };
    let characters: Vec<char> = line.text.chars().collect();
    let mut spans = Vec::new();
    let part = |from: usize, to: usize| -> String {
        let [from, to] = [from.max(shift), to].map(|at| at.min(characters.len()));
        characters.get(from..to).unwrap_or_default().iter().collect()
    };
    let mut at = 0;
    for (from, to, mark) in &line.marks {
        spans.push(Span::styled(part(at, *from), base));
        let marked = part(*from, *to);
        // The place where something is to be typed has a cell of its own.
        let marked = match from == to {
            true => " ".to_owned(),
            false => marked,
        };
        spans.push(Span::styled(marked, base.patch(marked_style(scene, *mark))));
        at = *to;
    }
    spans.push(Span::styled(part(at, characters.len()), base));
    Line::from(spans)
}

fn marked_style(scene: &Scene, mark: Mark) -> Style {
    let palette = scene.palette;
    match mark {
        Mark::Cursor => Style::new().add_modifier(Modifier::REVERSED),
        Mark::Entry => palette.style(Role::Entry),
        Mark::Section => palette.style(Role::Section),
        Mark::Fault => palette.style(Role::Fault),
        Mark::Quiet => palette.style(Role::Quiet),
    }
}

/// The large position display: with air between the lines, where there is room.
fn positions(scene: &Scene, status: &Status, area: Rect) -> Vec<Line<'static>> {
    let airy = usize::from(area.height) > 2 * status.axes.len();
    let mut lines = Vec::new();
    for axis in &status.axes {
        if airy {
            lines.push(Line::default());
        }
        let role = match axis.referenced {
            true => Role::Value,
            false => Role::Quiet,
        };
        let letter = Span::styled(format!("    {}  ", axis.label), Style::new().bold());
        let value = Span::styled(format!("{:>14}", axis.value), scene.palette.style(role));
        lines.push(Line::from(vec![letter, value]));
    }
    lines
}

/// The window of the PLC.
pub(super) fn plc(frame: &mut Frame, scene: &Scene, area: Rect) {
    let lines = scene.screen.plc_window.iter().flatten();
    for (row, line) in area.rows().zip(lines) {
        frame.render_widget(plc_line(scene, line), row);
    }
}

/// Columns of a bar chart of the PLC.
const PLC_BAR: usize = 19;

fn plc_line(scene: &Scene, line: &PlcLine) -> Line<'static> {
    let mut spans = vec![Span::styled(" PLC │ ", scene.palette.style(Role::Frame))];
    if let Some([maximum, current, colour, scale]) = line.bar {
        let part = f64::from(current) / f64::from(maximum.max(1));
        let done = (part.clamp(0.0, 1.0) * PLC_BAR as f64).round() as usize;
        let style = |colour: u32| scene.palette.plc(u8::try_from(colour % 16).unwrap_or(0));
        spans.push(Span::styled("█".repeat(done), style(colour)));
        spans.push(Span::styled("░".repeat(PLC_BAR - done), style(scale)));
        spans.push(Span::raw(" "));
    }
    let colours = line.colours.iter().copied().chain(std::iter::repeat(0));
    let cells = line.text.chars().zip(colours);
    spans.extend(
        cells.map(|(character, colour)| Span::styled(character.to_string(), scene.palette.plc(colour))),
    );
    Line::from(spans)
}

/// Why the machine stands.
pub(super) fn why(frame: &mut Frame, scene: &Scene, area: Rect) {
    let reasons = scene.screen.why.iter().map(|reason| {
        let sign = Span::styled(" ▸ ", scene.palette.style(Role::Frame));
        Line::from(vec![sign, Span::raw(reason.clone())])
    });
    let text = Paragraph::new(reasons.collect::<Vec<_>>());
    frame.render_widget(text.wrap(Wrap { trim: false }), area);
}

/// Rows that the reasons need: words that are broken take a little more than their characters.
pub(super) fn why_height(reasons: &[String], width: u16) -> usize {
    let width = usize::from(width.saturating_sub(8)).max(1);
    let heights = reasons
        .iter()
        .map(|reason| (reason.chars().count() + 3).div_ceil(width));
    heights.sum()
}

/// Draws the task of a lesson.
pub(super) fn lesson(frame: &mut Frame, scene: &Scene, area: Rect) {
    let Some(lesson) = &scene.screen.lesson else {
        return;
    };
    let state = match lesson.state {
        LessonState::Running => "",
        LessonState::Passed => scene.words("PASSED"),
        LessonState::Failed => scene.words("FAILED"),
    };
    let title = format!("{}  {state}", lesson.title).trim_end().to_owned();
    let frame_around = block(scene, &title);
    let text = Paragraph::new(lesson_lines(scene, lesson)).wrap(Wrap { trim: false });
    frame.render_widget(text.block(frame_around), area);
}

fn lesson_lines(scene: &Scene, lesson: &LessonLine) -> Vec<Line<'static>> {
    let task = lesson.task.lines().map(|line| Line::from(line.to_owned()));
    let checks = lesson.checks.iter().map(|check| {
        let (sign, role) = match check.done {
            true => ("✓ ", Role::Value),
            false => ("· ", Role::Quiet),
        };
        Line::from(Span::styled(
            format!("{sign}{}", check.text),
            scene.palette.style(role),
        ))
    });
    let hints = lesson.hints.iter().map(|hint| Line::from(format!("? {hint}")));
    let reason = (!lesson.reason.is_empty()).then(|| {
        Line::from(Span::styled(
            lesson.reason.clone(),
            scene.palette.style(Role::Fault),
        ))
    });
    reason
        .into_iter()
        .chain(task)
        .chain(checks)
        .chain(hints)
        .collect()
}

/// Rows that a lesson needs.
pub(super) fn lesson_height(lesson: &LessonLine, width: u16) -> u16 {
    let width = usize::from(width.saturating_sub(2)).max(1);
    let texts = [lesson.reason.as_str()]
        .into_iter()
        .filter(|reason| !reason.is_empty());
    let texts = texts.chain(lesson.task.lines());
    let texts = texts.chain(lesson.hints.iter().map(String::as_str));
    let texts = texts.chain(lesson.checks.iter().map(|check| check.text.as_str()));
    let heights = texts.map(|text| (text.chars().count() + 2).div_ceil(width).max(1));
    rows(heights.sum::<usize>() + 2)
}
