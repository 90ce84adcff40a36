//! What is different from another run: with other parameters or tools, or of an earlier day.

use std::collections::HashMap;

use super::row::{Row, Verdict};
use super::{Shelf, csv};
use crate::text::clock;

/// The rows of an earlier report by path.
pub type Rows = HashMap<String, Row>;

/// Reads an earlier report; `None` when the text is none.
///
/// # Errors
/// When it is JSON, and no report of a shelf; why.
pub fn read(text: &str) -> Result<Option<Rows>, String> {
    let by_path = |rows: Vec<Row>| rows.into_iter().map(|row| (row.path.clone(), row)).collect();
    if text.trim_start().starts_with('{') {
        let shelf: Result<Shelf, _> = serde_json::from_str(text);
        return match shelf {
            Ok(shelf) => Ok(Some(by_path(shelf.programs))),
            Err(error) => Err(format!("this is no report of a shelf: {error}")),
        };
    }
    Ok(csv::read(text).map(by_path))
}

/// What changes from one run to the next, in words.
pub(super) fn changes(before: &Row, now: &Row) -> Vec<String> {
    let mut changes = Vec::new();
    let mut say = |what: &str, before: String, now: String| {
        if before != now {
            changes.push(format!("{what} {before} -> {now}"));
        }
    };
    let result = |row: &Row| match row.result {
        Verdict::Error | Verdict::Called => row.error_text(),
        other => other.text().to_owned(),
    };
    say("result", result(before), result(now));
    let time = |row: &Row| row.machining_time_s.map_or("without end".into(), clock);
    let percent = match (before.machining_time_s, now.machining_time_s) {
        (Some(a), Some(b)) if a > 0.0 && a != b => format!(" ({:+.1} %)", 100.0 * (b - a) / a),
        _ => String::new(),
    };
    // Times that read alike but differ tell so by the percentage.
    if !percent.is_empty() && percent != " (+0.0 %)" && percent != " (-0.0 %)" {
        say("time", time(before), time(now) + &percent);
    }
    let mm = |value: f64| format!("{value:.1} mm");
    say("feed path", mm(before.feed_mm), mm(now.feed_mm));
    say("rapid path", mm(before.rapid_mm), mm(now.rapid_mm));
    let volume = |row: &Row| {
        row.removed_mm3
            .map_or("no part".into(), |removed| format!("{:.2} cm³", removed / 1000.0))
    };
    say("removed", volume(before), volume(now));
    let tools = |row: &Row| {
        let named = |tool: Option<u32>| tool.map_or("-".to_owned(), |tool| tool.to_string());
        let all: Vec<String> = row.tools.iter().map(|used| named(used.tool)).collect();
        all.join(" ")
    };
    say("tools", tools(before), tools(now));
    say(
        "beyond the traverse range",
        named(before.beyond()),
        named(now.beyond()),
    );
    say("warnings", count(before), count(now));
    changes
}

fn named(axes: String) -> String {
    if axes.is_empty() { "none".into() } else { axes }
}

fn count(row: &Row) -> String {
    row.warnings.len().to_string()
}
