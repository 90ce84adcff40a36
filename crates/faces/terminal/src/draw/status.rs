//! The status window: positions, T, S, F, M, flags and the bars.

use bahn_panel::{AxisLine, Star, Status};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use super::{Scene, block};
use crate::palette::Role;

/// A bar ends at so many per cent of what was programmed.
const BAR_MAX: f64 = 150.0;
/// Columns of a bar, without its mark.
const BAR: usize = 15;
/// Those below 100 %, where the mark stands.
const BELOW: usize = 10;

pub(super) fn draw(frame: &mut Frame, scene: &Scene, area: Rect) {
    let status = &scene.screen.status;
    let title = match (status.position_type.as_str(), status.inch) {
        ("", _) => String::new(),
        (kind, true) => format!("{kind} INCH"),
        (kind, false) => kind.to_owned(),
    };
    let frame_around = block(scene, &title);
    let inner = frame_around.inner(area);
    frame.render_widget(frame_around, area);
    if !scene.screen.machine.power {
        return;
    }
    let mut lines: Vec<Line> = status.axes.iter().map(|axis| position(scene, axis)).collect();
    lines.push(Line::styled(
        "─".repeat(inner.width.into()),
        scene.palette.style(Role::Frame),
    ));
    lines.push(tool(status));
    lines.push(feed(scene, status));
    lines.push(bar(
        scene,
        "F",
        part(status.feed_mm_min, status.programmed_feed_mm_min),
        status.overrides[0],
    ));
    lines.push(bar(
        scene,
        "S",
        part(status.spindle_rpm.abs(), status.s),
        status.overrides[1],
    ));
    if !status.flags.is_empty() {
        lines.push(Line::styled(
            format!(" {}", status.flags.join(" ")),
            Style::new().bold(),
        ));
    }
    if !status.waiting.is_empty() {
        lines.push(Line::styled(
            format!(" {}", status.waiting),
            scene.palette.style(Role::Prompt),
        ));
    }
    frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: false }), inner);
}

/// `⊙*X     +12.500`: the handwheel moves it, its loop is open; what has no reference mark yet is dim.
fn position(scene: &Scene, axis: &AxisLine) -> Line<'static> {
    let role = match axis.referenced {
        true => Role::Value,
        false => Role::Quiet,
    };
    let wheel = if axis.handwheel { '⊙' } else { ' ' };
    Line::from(vec![
        Span::raw(format!("{wheel}{}", axis.label)),
        Span::styled(format!("{:>14}", axis.value), scene.palette.style(role)),
    ])
}

fn tool(status: &Status) -> Line<'static> {
    let axis = status.tool_axis.as_deref().unwrap_or_default();
    let gear = match status.gear {
        0 => String::new(),
        gear => format!("/{gear}"),
    };
    Line::from(vec![
        Span::raw(" "),
        Span::styled("T", inverse(status.t_inverse)),
        Span::raw(format!(" {:<3}{axis:<3}S {:.0}{gear}", status.tool, status.s)),
    ])
}

/// F, inverse without feed enable, the M functions, those of spindle and coolant inverse when the PLC says so, and `*`.
fn feed(scene: &Scene, status: &Status) -> Line<'static> {
    let mut spans = vec![
        Span::raw(" "),
        Span::styled("F", inverse(status.f_inverse)),
        Span::raw(format!(" {:<8}", status.f)),
    ];
    let functions: Vec<&str> = status.m.split('/').collect();
    for (place, function) in functions.iter().enumerate() {
        if place > 0 {
            spans.push(Span::raw("/"));
        }
        let style = inverse(status.m_inverse.get(place).copied().unwrap_or(false));
        spans.push(Span::styled((*function).to_owned(), style));
    }
    let star = scene.palette.style(Role::Lit);
    match status.star {
        Star::Off => {}
        Star::Steady => spans.push(Span::styled("  *", star)),
        Star::Blinking => spans.push(Span::styled("  *", star.add_modifier(Modifier::SLOW_BLINK))),
    }
    Line::from(spans)
}

/// The style of a text, inverse or not.
fn inverse(inverse: bool) -> Style {
    match inverse {
        true => Style::new().add_modifier(Modifier::REVERSED),
        false => Style::new(),
    }
}

/// What is done of what was programmed, %.
fn part(value: f64, programmed: f64) -> f64 {
    match programmed > 0.0 {
        true => 100.0 * value / programmed,
        false => 0.0,
    }
}

fn bar(scene: &Scene, name: &str, percent: f64, over: f64) -> Line<'static> {
    let done = (percent.clamp(0.0, BAR_MAX) / BAR_MAX * BAR as f64).round() as usize;
    let piece = |done: usize, width: usize| {
        [
            Span::styled("█".repeat(done), scene.palette.style(Role::Bar)),
            Span::styled("░".repeat(width - done), scene.palette.style(Role::Quiet)),
        ]
    };
    let mut spans = vec![Span::raw(format!(" {name} "))];
    spans.extend(piece(done.min(BELOW), BELOW));
    spans.push(Span::raw("│"));
    spans.extend(piece(done.saturating_sub(BELOW), BAR - BELOW));
    spans.push(Span::raw(format!(" {over:>3.0} %")));
    Line::from(spans)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desk::Desk;
    use crate::palette::Palette;

    #[test]
    fn a_bar_has_its_mark_at_100_per_cent() {
        let (screen, desk) = (bahn_panel::Screen::default(), Desk::default());
        let scene = Scene {
            screen: &screen,
            desk: &desk,
            part: None,
            palette: Palette::Plain,
        };
        for (percent, expected) in [
            (0.0, " F ░░░░░░░░░░│░░░░░  80 %"),
            (50.0, " F █████░░░░░│░░░░░  80 %"),
            (100.0, " F ██████████│░░░░░  80 %"),
            (120.0, " F ██████████│██░░░  80 %"),
            (200.0, " F ██████████│█████  80 %"),
        ] {
            assert_eq!(bar(&scene, "F", percent, 80.0).to_string(), expected);
        }
    }
}
