//! The report for people.

use std::fmt::Write;

use crate::ReportError;
use crate::record::Report;
use bahn_text::printable;

/// Entries of a list that are shown; the JSON report has more.
const SHOWN: usize = 20;
/// Width of the left column.
pub const LABEL: usize = 18;

/// The report with its lines.
pub fn render(report: &Report, control: &str, written: &[String]) -> String {
    let mut text = String::new();
    let mut row = |label: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{label:<LABEL$}{}", printable(value));
    };
    head(&mut row, report, control);
    body(&mut row, report);
    list(&mut row, "Written", written, Clone::clone);
    text
}

/// Program, result, time, path.
pub fn head(row: &mut impl FnMut(&str, &str), report: &Report, control: &str) {
    row(
        "Program",
        &format!("{} ({}), {control}", report.program, report.unit),
    );
    row("Result", &result(report));
    row(
        "Machining time",
        &match report.machining_time_s {
            Some(time) => format!("{} ({time:.1} s)", clock(time)),
            None => "without end: the feed is 0".to_owned(),
        },
    );
    row(
        "Path",
        &format!(
            "{:.3} mm feed, {:.3} mm rapid",
            report.path_mm.feed, report.path_mm.rapid
        ),
    );
}

/// Blocks, tools, Q parameters, stops, warnings.
pub fn body(row: &mut impl FnMut(&str, &str), report: &Report) {
    row("Blocks executed", &report.blocks_executed.to_string());
    row("Final position", &report.final_position.to_string());
    if let Some(removed) = report.removed_mm3 {
        row(
            "Material removed",
            &format!("{:.1} mm³ ({:.2} cm³)", removed, removed / 1000.0),
        );
    }
    list(row, "Tool calls", &report.tool_calls, |call| {
        let tool = call
            .tool
            .map_or("no tool".to_owned(), |tool| format!("tool {tool}"));
        format!("block {}: {tool}, {} rpm", call.block, call.speed_rpm)
    });
    let q: Vec<_> = report
        .q
        .0
        .iter()
        .enumerate()
        .take(100)
        .filter(|(_, value)| **value != 0.0)
        .collect();
    list(row, "Q parameters", &q, |(number, value)| {
        format!("Q{number} = {value}")
    });
    list(row, "Stops", &report.stops, |stop| {
        format!(
            "{} at {}",
            stop.function,
            place(&stop.program, stop.block, stop.line, report)
        )
    });
    list(row, "Printed", &report.printed, |printed| {
        let place = place(&printed.program, printed.block, printed.line, report);
        format!("{} at {place}", printed.text)
    });
    list(row, "Warnings", &report.warnings, |warning| {
        let times = if warning.count > 1 {
            format!(" ({} times)", warning.count)
        } else {
            String::new()
        };
        if warning.line == 0 {
            return format!("{}{times}", warning.message);
        }
        format!(
            "{}: {}{times}",
            place(&warning.program, warning.block, warning.line, report),
            warning.message
        )
    });
    if report.not_listed > 0 {
        row(
            "",
            &format!(
                "{} more tool calls, stops and printed lines are not listed",
                report.not_listed
            ),
        );
    }
}

/// Program, result, time and blocks in one line.
pub fn in_a_line(report: &Report) -> String {
    let time = report
        .machining_time_s
        .map_or_else(String::new, |time| format!(", {time:.1} s"));
    format!(
        "{}: {}{time}, {} blocks",
        report.program,
        result(report),
        report.blocks_executed
    )
}

fn result(report: &Report) -> String {
    match &report.error {
        Some(error) => {
            let detail = if error.detail.is_empty() {
                String::new()
            } else {
                format!(" ({})", error.detail)
            };
            // Nobody knows the line of what no block is to blame for.
            match error.line {
                0 => format!("{}{detail}", error.message),
                line => format!(
                    "{} at {}{detail}",
                    error.message,
                    place(&error.program, error.block, line, report)
                ),
            }
        }
        None if report.completed => "completed".to_owned(),
        None => "not completed".to_owned(),
    }
}

/// `block 12 (line 14)`, with the program when it is not the main one.
fn place(program: &str, block: u32, line: u32, report: &Report) -> String {
    if program == report.program {
        format!("block {block} (line {line})")
    } else {
        format!("{program} block {block} (line {line})")
    }
}

/// Rows of a list, its name before the first.
pub fn list<T>(row: &mut impl FnMut(&str, &str), name: &str, items: &[T], text: impl Fn(&T) -> String) {
    let mut label = name;
    for item in items.iter().take(SHOWN) {
        row(label, &text(item));
        label = "";
    }
    if items.len() > SHOWN {
        row(
            "",
            &format!("and {} more, see --format json", items.len() - SHOWN),
        );
    }
}

/// A report as JSON, with a line end.
///
/// # Errors
/// When it cannot be written so.
pub fn json(report: &impl serde::Serialize) -> Result<String, ReportError> {
    serde_json::to_string_pretty(report)
        .map(|text| text + "\n")
        .map_err(|error| ReportError::new(format!("cannot write the report: {error}")))
}

/// A time as h:mm:ss.
pub fn clock(time_s: f64) -> String {
    if !time_s.is_finite() {
        return "-:--:--".to_owned();
    }
    let seconds = time_s.round() as u64;
    format!("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_show_hours() {
        assert_eq!(clock(0.4), "0:00:00");
        assert_eq!(clock(59.6), "0:01:00");
        assert_eq!(clock(3.0 * 3600.0 + 25.0 * 60.0 + 7.0), "3:25:07");
        assert_eq!(clock(f64::INFINITY), "-:--:--");
    }
}
