//! The report for people: a table of events, a table of waits, how it ended.

use bahn_path::Position;
use bahn_technology::{Event, EventKind, Report, Skipped, Value, Wait};

use crate::count;

/// Events that are printed; the others are counted.
const PRINTED_MAX: usize = 400;

/// Events, waits and what else was noted, as lines for people.
pub fn text(report: &Report) -> String {
    let mut text = String::new();
    if !report.events.is_empty() {
        let events = report.events.iter().take(PRINTED_MAX).map(event);
        text += &table(
            &["time", "v", "", "function", "range", "block", "position", ""],
            events,
        );
        let rest = report.events.len().saturating_sub(PRINTED_MAX);
        if rest > 0 {
            text += &format!("{rest} more not shown; --format json has all\n");
        }
        text.push('\n');
    }
    if !report.waits.is_empty() {
        text += "The path stood for\n";
        text += &table(
            &["function", "block", "from", "to", "s", "position"],
            report.waits.iter().map(wait),
        );
        text.push('\n');
    }
    if let Some(skipped) = report.skipped.as_ref().filter(|skipped| !skipped.is_empty()) {
        text += "Not output before the block with which the run began, the last of each\n";
        text += &table(
            &["function", "range", "program", "block"],
            skipped.iter().map(skipped_one),
        );
        text.push('\n');
    }
    for warning in &report.warnings {
        text += &format!(
            "warning: {} {}: {}\n",
            warning.program, warning.block, warning.message
        );
    }
    if let Some(error) = &report.error {
        text += &format!("error: {error}\n");
    }
    text + &end(report)
}

fn event(event: &Event) -> Vec<String> {
    let kind = match event.kind {
        EventKind::Output => "output",
        EventKind::Fetch => "fetch",
        EventKind::Acknowledge => "acknowledge",
        EventKind::Stop => "stop",
        EventKind::Go => "go",
        EventKind::Active => "active",
    };
    let function = with_value(event.function.as_deref().unwrap_or_default(), &event.value);
    let mut remarks = Vec::new();
    if let Some(offset) = event.offset_us {
        remarks.push(format!("{offset:.0} us after its place"));
    }
    if let Some(to_go) = event.to_go {
        let way = to_go.path as f64 / 10_000.0;
        let time = to_go.time as f64 / 1_000_000.0;
        remarks.push(format!("{way:.3} mm, {time:.3} s to go"));
    }
    vec![
        format!("{:.3}", event.t),
        format!("{:.0}", event.v),
        kind.to_owned(),
        function,
        event.target.clone().unwrap_or_default(),
        event.block.clone().unwrap_or_default(),
        position(&event.position.0),
        remarks.join(", "),
    ]
}

fn skipped_one(skipped: &Skipped) -> Vec<String> {
    vec![
        with_value(&skipped.function, &skipped.value),
        skipped.target.clone(),
        skipped.program.clone(),
        skipped.block.clone(),
    ]
}

/// `H5=4711`, `M25 M26` of numbers.
fn with_value(function: &str, value: &Value) -> String {
    match value {
        Value::None => function.to_owned(),
        Value::Integer(value) => format!("{function}={value}"),
        Value::Number(value) => format!("{function}={value}"),
        Value::Numbers(numbers) => {
            let names = numbers.iter().map(|number| format!("{function}{number}"));
            match names.collect::<Vec<_>>().join(" ") {
                none if none.is_empty() => format!("no {function}"),
                names => names,
            }
        }
    }
}

fn wait(wait: &Wait) -> Vec<String> {
    let (to, length) = match wait.to_s {
        Some(to) => (format!("{to:.3}"), format!("{:.3}", to - wait.from_s)),
        None => ("never".to_owned(), String::new()),
    };
    vec![
        wait.function.clone(),
        wait.block.clone(),
        format!("{:.3}", wait.from_s),
        to,
        length,
        position(&wait.position.0),
    ]
}

/// The coordinates that are known: `X12.5 Y0`.
fn position(position: &Position) -> String {
    let known = position.known();
    let words = known
        .iter()
        .map(|axis| format!("{}{}", axis.letter(), rounded(position[axis])));
    words.collect::<Vec<_>>().join(" ")
}

/// To 1 µm, without zeros after.
fn rounded(value: f64) -> f64 {
    // Adding 0 makes -0 a 0.
    (value * 1e3).round() / 1e3 + 0.0
}

fn end(report: &Report) -> String {
    let stands = position(&report.path_end.0);
    let events = |kind: EventKind| report.events.iter().filter(|event| event.kind == kind).count();
    let waited: f64 = stood(&report.waits, report.time_s);
    let what = if report.completed {
        "completed"
    } else if report.error.is_some() {
        "ended by an error"
    } else {
        "not completed"
    };
    format!(
        "{what} in {:.3} s (cycle {} ms), {}, {}, path stood {waited:.3} s for functions{}\n",
        report.time_s,
        rounded(report.cycle_s * 1e3),
        count(events(EventKind::Output), "output"),
        count(events(EventKind::Acknowledge), "acknowledgement"),
        if stands.is_empty() {
            String::new()
        } else {
            format!(", path ends at {stands}")
        },
    )
}

/// How long the path stood for any function up to the end of the run: waits for several at a time count once.
fn stood(waits: &[Wait], end_s: f64) -> f64 {
    let mut spans: Vec<(f64, f64)> = waits
        .iter()
        .map(|wait| (wait.from_s, wait.to_s.unwrap_or(end_s)))
        .collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sum = 0.0;
    let mut until = f64::NEG_INFINITY;
    for (from, to) in spans {
        sum += (to - from.max(until)).max(0.0);
        until = until.max(to);
    }
    sum
}

/// Columns as wide as what stands in them; numbers to the right.
fn table(heads: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let rows: Vec<Vec<String>> = rows.collect();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        let widest = cells.map(|cell| cell.chars().count()).max().unwrap_or_default();
        widest.max(heads.get(column).map_or(0, |head| head.chars().count()))
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let is_number = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.clone().count() > 0
            && cells
                .clone()
                .all(|cell| cell.parse::<f64>().is_ok() || cell == "never")
    };
    let right: Vec<bool> = (0..heads.len()).map(is_number).collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let columns = cells
            .zip(widths.iter().zip(&right))
            .map(|(cell, (width, right))| match right {
                true => format!("{cell:>width$}"),
                false => format!("{cell:<width$}"),
            });
        let joined = columns.collect::<Vec<_>>().join("  ");
        joined.trim_end().to_owned() + "\n"
    };
    let mut text = line(&mut heads.iter().copied());
    for row in &rows {
        text += &line(&mut row.iter().map(String::as_str));
    }
    text
}

#[cfg(test)]
mod tests {
    use bahn_technology::Coordinates;

    use super::*;

    #[test]
    fn waits_at_the_same_time_count_once() {
        let wait = |from_s: f64, to_s| Wait {
            function: "M1".to_owned(),
            block: "N1".to_owned(),
            from_s,
            to_s,
            position: Coordinates(Position::UNKNOWN),
            order: 0,
        };
        let waits = [
            wait(1.0, Some(3.0)),
            wait(2.0, Some(2.5)),
            wait(2.0, Some(4.0)),
            wait(6.0, Some(7.0)),
            wait(8.0, None),
        ];
        assert!((stood(&waits, 8.5) - 4.5).abs() < 1e-12);
    }

    #[test]
    fn columns_fit_what_stands_in_them() {
        let rows = [["1.5", "M25"], ["10.25", "H5=7"]].map(|row| row.map(str::to_owned).to_vec());
        let text = table(&["t", "function"], rows.into_iter());
        assert_eq!(text, "    t  function\n  1.5  M25\n10.25  H5=7\n");
    }
}
