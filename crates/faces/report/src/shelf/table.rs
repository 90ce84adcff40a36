//! The table for people.

use std::fmt::Write;

use super::row::{Row, Verdict};
use super::{About, Totals};
use crate::text::clock;
use bahn_text::printable;

/// Widest column of names; longer ones push the rest of their line.
const NAME_MAX: usize = 48;

/// A line for each program, what is wrong or different below it, and the totals.
pub fn render(rows: &[&Row], totals: &Totals, about: &About) -> String {
    let width = rows
        .iter()
        .map(|row| row.path.chars().count())
        .max()
        .unwrap_or_default()
        .clamp(7, NAME_MAX);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:width$}  {:<11} {:>10} {:>10} {:>10} {:>11}  {:<10} Warnings",
        "Program", "Result", "Time", "Feed m", "Rapid m", "Removed cm³", "Tools"
    );
    for row in rows {
        let _ = writeln!(
            text,
            "{:width$}  {:<11} {:>10} {:>10.3} {:>10.3} {:>11}  {:<10} {}",
            printable(&row.path),
            row.result.text(),
            row.machining_time_s.map_or("no feed".into(), clock),
            row.feed_mm / 1000.0,
            row.rapid_mm / 1000.0,
            row.removed_mm3
                .map_or("-".into(), |removed| format!("{:.2}", removed / 1000.0)),
            tools(row),
            row.warnings.len(),
        );
        let beyond = row.beyond();
        let beyond =
            (!beyond.is_empty()).then(|| format!("beyond the traverse range of the machine: {beyond}"));
        let error = (!row.error_text().is_empty()).then(|| row.error_text());
        for line in error.into_iter().chain(beyond).chain(row.changes.iter().cloned()) {
            let _ = writeln!(text, "    {}", printable(&line));
        }
    }
    text += &sum(totals, about);
    text
}

fn tools(row: &Row) -> String {
    let numbers: Vec<String> = row
        .tools
        .iter()
        .filter_map(|used| used.tool.map(|tool| tool.to_string()))
        .collect();
    if numbers.is_empty() {
        "-".into()
    } else {
        numbers.join(" ")
    }
}

fn sum(totals: &Totals, about: &About) -> String {
    let mut parts = vec![format!("{} OK", totals.ok)];
    for (count, what) in [
        (totals.errors, "with errors"),
        (totals.called, "called by others"),
        (totals.not_run, "not run"),
    ] {
        if count > 0 {
            parts.push(format!("{count} {what}"));
        }
    }
    if about.compared {
        parts.push(format!("{} changed", totals.changed));
    }
    let mut text = format!(
        "{} programs: {}\nMachining time {}, {:.3} m feed, {:.3} m rapid, {:.2} cm³ removed",
        totals.programs,
        parts.join(", "),
        clock(totals.machining_time_s),
        totals.feed_mm / 1000.0,
        totals.rapid_mm / 1000.0,
        totals.removed_mm3 / 1000.0,
    );
    if let Some(density) = about.density {
        let _ = write!(text, " ({:.3} kg)", totals.removed_mm3 * density * 1e-6);
    }
    text + "\n"
}

/// The rows that somebody has to look at, for the page.
pub fn class(row: &Row) -> &'static str {
    match row.result {
        Verdict::Ok | Verdict::Stopped if row.warnings.is_empty() => "ok",
        Verdict::Ok | Verdict::Stopped => "warned",
        Verdict::Called | Verdict::Interrupted | Verdict::NotRun => "open",
        Verdict::Error | Verdict::Unreadable | Verdict::TimeLimit => "bad",
    }
}
