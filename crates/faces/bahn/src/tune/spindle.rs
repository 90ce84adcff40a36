//! `bahn tune DIR S`: the spindle.

use std::fmt::Write as _;

use bahn_host::LoadedMachine;
use bahn_parameters::ParameterList;
use bahn_trials::tuning::{ThreadTest, TunedSpindle, tune_spindle};
use serde::Serialize;

use super::{ChangeRow, TuneOptions, change_rows, change_text, write};
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};
use bahn_report::record::tidy;

#[derive(Serialize)]
struct Report {
    spindle: &'static str,
    trials: usize,
    written: bool,
    before: Figures,
    after: Figures,
    changes: Vec<ChangeRow>,
}

#[derive(Serialize)]
struct Figures {
    beyond_mm: f64,
    off_mm: f64,
    threads_s: f64,
    orientation_s: Vec<f64>,
}

impl Figures {
    fn of(test: &ThreadTest) -> Figures {
        Figures {
            beyond_mm: tidy(test.beyond_mm),
            off_mm: tidy(test.off_mm),
            threads_s: tidy(test.threads_s),
            orientation_s: test
                .orientation_s
                .iter()
                .map(|(_, seconds)| tidy(*seconds))
                .collect(),
        }
    }
}

/// Tunes, reports and writes.
pub(super) fn command(
    machine: &LoadedMachine,
    list: &ParameterList,
    options: &TuneOptions,
) -> Result<Outcome, UsageError> {
    if options.picture.is_some() {
        return Err(UsageError::new("--picture: the spindle describes no circle"));
    }
    let tuned = match tune_spindle(machine, list) {
        Ok(tuned) => tuned,
        Err(what) => {
            diagnostics::print_usage_error(&format!("the trial cannot be run: {what}"));
            return Ok(Outcome::ProgramError);
        }
    };
    if options.write {
        write(machine, &tuned.changes, &options.mp)?;
    }
    let report = report(&tuned, list, options.write);
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => console::print(&text(&report))?,
    }
    Ok(Outcome::Fine)
}

fn report(tuned: &TunedSpindle, list: &ParameterList, written: bool) -> Report {
    Report {
        spindle: "S",
        trials: tuned.trials,
        written,
        before: Figures::of(&tuned.before),
        after: Figures::of(&tuned.after),
        changes: change_rows(&tuned.changes, list),
    }
}

fn text(report: &Report) -> String {
    let mut text = format!(
        "threads in all gear ranges, {} trials\n\n{:<34}{:>10}{:>10}\n",
        report.trials, "", "before", "after"
    );
    let (before, after) = (&report.before, &report.after);
    let mut rows = vec![
        (
            "beyond the depth, µm".to_owned(),
            before.beyond_mm * 1e3,
            after.beyond_mm * 1e3,
        ),
        (
            "off the spindle, µm".to_owned(),
            before.off_mm * 1e3,
            after.off_mm * 1e3,
        ),
        (
            "time of the threads, s".to_owned(),
            before.threads_s,
            after.threads_s,
        ),
    ];
    let orientations = before.orientation_s.iter().zip(&after.orientation_s);
    for (gear, (before, after)) in (1..).zip(orientations) {
        rows.push((format!("orientation, gear {gear}, s"), *before, *after));
    }
    for (name, before, after) in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name:<34}{before:>10.2}{after:>10.2}");
    }
    text + &change_text(&report.changes, report.written)
}
