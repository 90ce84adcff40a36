//! What is different from another run: with other parameters or tools, or of an earlier day.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use bahn_host::tool_table;
use bahn_path::Position;

use super::row::{Row, Verdict};
use super::{COLUMNS, Shelf, csv};
use crate::report_text::clock;
use crate::settings::Equipment;
use crate::test_run::{Bench, TestOptions};
use crate::{UsageError, files};

/// What the programs are compared with.
pub(super) enum Other {
    /// Another run of each.
    Bench(Box<Bench>),
    /// The rows of an earlier report by path.
    Report(HashMap<String, Row>),
}

/// Reads what `--against` names.
///
/// The workpiece lies where it lies in the run that is compared.
pub(super) fn load(path: &Path, options: &TestOptions, datum: &Position) -> Result<Other, UsageError> {
    let bench = |equipment: Equipment| {
        let equipment = Equipment {
            datum: *datum,
            ..equipment
        };
        let bench = Bench::new(options, equipment, COLUMNS)?;
        Ok(Other::Bench(Box::new(bench)))
    };
    if path.is_dir() {
        return bench(Equipment::of_folder("--against", path)?);
    }
    if let Err(error) = fs::metadata(path) {
        return Err(files::cannot("read", path, &error).into());
    }
    let bytes = files::read_program(path)?
        .ok_or_else(|| UsageError::new(format!("{}: {}", path.display(), files::TOO_LARGE)))?;
    let text = String::from_utf8_lossy(&bytes);
    let by_path = |rows: Vec<Row>| rows.into_iter().map(|row| (row.path.clone(), row)).collect();
    if text.trim_start().starts_with('{') {
        let shelf: Shelf = serde_json::from_str(&text).map_err(|error| {
            UsageError::new(format!(
                "{}: this is no report of a shelf: {error}",
                path.display()
            ))
        })?;
        return Ok(Other::Report(by_path(shelf.programs)));
    }
    if let Some(rows) = csv::read(&text) {
        return Ok(Other::Report(by_path(rows)));
    }
    let mut machine = options.machine.clone();
    if tool_table::parse(&text).is_ok() {
        machine.tools = Some(path.to_owned());
    } else {
        machine.parameters = Some(path.to_owned());
    }
    let equipment = Equipment::of(options.model, &machine).map_err(|error| {
        UsageError::new(format!(
            "--against takes a parameter list, a tool table, a folder of a machine or an earlier report; {error}"
        ))
    })?;
    bench(equipment)
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
