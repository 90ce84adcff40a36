//! `bahn compensate`: an interferometer run on the simulated machine, and the compensation of what it finds.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::LoadedMachine;
use bahn_machine::MachineFolder;
use bahn_parameters::{Adjustment, ListText};
use bahn_trials::interferometer::{AxisResult, Compensated, TABLE_NAME, compensate};
use clap::{Args, ValueHint};
use serde::Serialize;

use crate::files::{self, NewFile};
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, machine_folder};
use bahn_report::record::tidy;

/// The assignment where machine.toml names none.
const ASSIGNMENT: &str = "compensation.CMA";

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn compensate machines/mill-tnc360
      Measures X, Y and Z against where their tables stand in truth; proposes MP710, MP720 or a table; measures again.
  bahn compensate mill --axes X --warm-up 10 --write
      X of a machine that was on for ten minutes; the entries go into the list, tables beside machine.toml.

Each axis goes through its travel upwards and downwards and rests at every point; what the first point has moved by in the
end is drift, and taken out of the readings in proportion to the time. Half the difference of the directions to either side
is backlash (MP710); a straight line is the linear error (MP720); what that leaves, when it is more than 0.1 µm and a
counting step of the encoder, is a table (.COM, named LASER-X and so on, with MP730 and the assignment .CMA).

JSON: written, axes (axis, points, resolution_um, before_um, after_um: greatest error of both directions; backlash_mm,
linear_mm_m, by_table, drift_um; errors: at_mm, up_um, down_um, and residual_up_um, residual_down_um after it).
Exit codes: 0 fine, 1 the machine is wrong or a run was broken off, 2 wrong use.";

/// Options of `bahn compensate`.
#[derive(Args, Debug)]
pub(crate) struct CompensateOptions {
    /// Folder of the machine.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// The axes; all linear ones without it.
    #[arg(long, value_name = "AXIS,..", value_delimiter = ',')]
    pub axes: Vec<char>,
    /// Minutes that the machine warms up before each run.
    #[arg(long, value_name = "MIN", default_value_t = 0.0)]
    pub warm_up: f64,
    /// Put the entries into the list of machine parameters, and the tables beside it, crash-safe.
    #[arg(long)]
    pub write: bool,
    /// How the report is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: Format,
}

#[derive(Serialize)]
struct Report {
    written: bool,
    axes: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    axis: char,
    points: usize,
    resolution_um: f64,
    before_um: f64,
    after_um: f64,
    backlash_mm: f64,
    linear_mm_m: f64,
    by_table: bool,
    drift_um: f64,
    errors: Vec<Point>,
}

#[derive(Serialize)]
struct Point {
    at_mm: f64,
    up_um: f64,
    down_um: f64,
    residual_up_um: f64,
    residual_down_um: f64,
}

impl Row {
    fn of(result: &AxisResult) -> Row {
        let um = |mm: f64| tidy(mm * 1e3);
        let (before, after) = (&result.before, &result.after);
        let errors = before.errors_mm.iter().zip(&after.errors_mm);
        Row {
            axis: before.letter,
            points: before.at_mm.len(),
            resolution_um: um(result.resolution_mm),
            before_um: um(before.greatest_mm()),
            after_um: um(after.greatest_mm()),
            backlash_mm: result.backlash_mm,
            linear_mm_m: result.linear_mm_m,
            by_table: result.by_table,
            drift_um: um(before.drift_mm),
            errors: std::iter::zip(&before.at_mm, errors)
                .map(|(at, ([up, down], [left_up, left_down]))| Point {
                    at_mm: tidy(*at),
                    up_um: um(*up),
                    down_um: um(*down),
                    residual_up_um: um(*left_up),
                    residual_down_um: um(*left_down),
                })
                .collect(),
        }
    }
}

/// Measures, reports and writes.
pub(crate) fn command(options: &CompensateOptions) -> Result<Outcome, UsageError> {
    if !(0.0..=480.0).contains(&options.warm_up) {
        return Err(UsageError::new("--warm-up takes 0 to 480 minutes"));
    }
    let mut machine = match machine_folder::load(&options.folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    if options.write {
        refuse_other_tables(&machine)?;
    }
    let letters: Vec<char> = options.axes.iter().map(char::to_ascii_uppercase).collect();
    let found = match compensate(&mut machine, &letters, options.warm_up) {
        Ok(found) => found,
        Err(what) => {
            diagnostics::print_usage_error(&format!("the machine cannot be measured: {what}"));
            return Ok(Outcome::ProgramError);
        }
    };
    if options.write {
        write(&machine, &found)?;
    }
    let report = Report {
        written: options.write,
        axes: found.axes.iter().map(Row::of).collect(),
    };
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => console::print(&text(&report))?,
    }
    Ok(Outcome::Fine)
}

/// Tables that somebody else made, of sag for instance, are not replaced.
fn refuse_other_tables(machine: &LoadedMachine) -> Result<(), UsageError> {
    let Some(assignment) = &machine.files.compensation else {
        return Ok(());
    };
    let mut names = assignment.lines.iter().flatten().flatten();
    match names.find(|name| !name.starts_with(TABLE_NAME)) {
        Some(name) => Err(UsageError::new(format!(
            "--write: the machine has the table {name}, which was not measured here; take `compensation` out of \
             machine.toml to begin anew"
        ))),
        None => Ok(()),
    }
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), UsageError> {
    let mut file = NewFile::create(path)?;
    file.write_all(bytes)
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}

/// Tables first, then what names them, so that the machine can be loaded whenever the power fails.
fn write(machine: &LoadedMachine, found: &Compensated) -> Result<(), UsageError> {
    let named = machine.folder.compensation.as_deref();
    let assignment = machine.root.join(named.unwrap_or(ASSIGNMENT));
    let beside = assignment.parent().unwrap_or(&machine.root);
    for (name, text) in &found.tables {
        put(&beside.join(format!("{name}.COM")), text.as_bytes())?;
    }
    match (&found.assignment, named) {
        (Some(text), _) => put(&assignment, text.as_bytes())?,
        // No table acts any more.
        (None, Some(_)) => put(&assignment, b"")?,
        (None, None) => {}
    }
    if found.assignment.is_some() && named.is_none() {
        let path = machine.root.join(MachineFolder::FILE);
        let bytes = files::read_description(&path)?;
        put(
            &path,
            name_assignment(&String::from_utf8_lossy(&bytes)).as_bytes(),
        )?;
    }
    let path = machine.root.join(&machine.folder.parameters);
    let mut text = ListText::from_bytes(machine.parameters.model(), &files::read_table(&path)?);
    let mut list = found.list.clone();
    for result in &found.axes {
        for what in [Adjustment::Backlash, Adjustment::Linear, Adjustment::Nonlinear] {
            let index = result.before.index;
            let value = found.list.adjustment(what, index).unwrap_or_default();
            if let Some((id, entry)) = list.adjust(what, index, value) {
                text.set(id, entry)
                    .map_err(|error| UsageError::new(error.to_string()))?;
            }
        }
    }
    put(&path, &text.to_bytes())
}

/// The description with the assignment, before its first table.
fn name_assignment(text: &str) -> String {
    let line = format!("compensation = \"{ASSIGNMENT}\"      # measured by `bahn compensate`\n");
    let mut new = String::new();
    let mut named = false;
    for own in text.split_inclusive('\n') {
        if !named && own.trim_start().starts_with('[') {
            new += &line;
            new.push('\n');
            named = true;
        }
        new += own;
    }
    if !named {
        if !new.is_empty() && !new.ends_with('\n') {
            new.push('\n');
        }
        new += &line;
    }
    new
}

fn text(report: &Report) -> String {
    let mut text = format!(
        "{:<6}{:>7}{:>12}{:>12}{:>12}{:>12}{:>12}  {}\n",
        "axis", "points", "before, µm", "after, µm", "drift, µm", "MP710, mm", "MP720, mm/m", "by"
    );
    for row in &report.axes {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<6}{:>7}{:>12.3}{:>12.3}{:>12.2}{:>12.4}{:>12.3}  {}",
            row.axis,
            row.points,
            row.before_um,
            row.after_um,
            row.drift_um,
            row.backlash_mm,
            row.linear_mm_m,
            if row.by_table { "table" } else { "MP720" }
        );
    }
    text.push_str(match report.written {
        true => "\nwritten into the list of machine parameters and the tables\n",
        false => "\nnothing is changed; --write puts it into the list and the tables\n",
    });
    text
}
