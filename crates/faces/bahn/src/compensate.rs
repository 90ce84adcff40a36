//! `bahn compensate`: an interferometer run on the simulated machine, and the compensation of what it finds.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::LoadedMachine;
use bahn_machine::MachineFolder;
use bahn_parameters::{Adjustment, ListText, ParameterList};
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
      Measures X, Y and Z against where their tables stand in truth; proposes MP710, MP720 or a
      table; measures again.
  bahn compensate machines/mill-tnc155 --axes X
      The same with the numbers of a TNC 155: MP36 and MP40.
  bahn compensate mill --axes X --warm-up 10 --write
      X of a machine that was on for ten minutes; the entries go into the list, tables beside
      machine.toml.

Each axis goes through its travel upwards and downwards and rests at every point; what the first
point has moved by in the end is drift, and taken out of the readings in proportion to the time.
Half the difference of the directions to either side is backlash (MP710); a straight line is the
linear error (MP720); what that leaves, when it is more than 0.1 µm and a counting step of the
encoder, is a table (.COM, named LASER-X and so on, with MP730 and the assignment .CMA). A TNC
151/155 has MP36 to MP39 and MP40 to MP43, and no tables. When an axis gets no better, nothing is
written.

JSON: written, axes (axis, points, resolution_um, before_um, after_um: greatest error of both
directions; backlash_mm, linear_mm_m, by_table, drift_um; entries: parameter, from, to; errors:
at_mm, up_um, down_um, and residual_up_um, residual_down_um after it).
Exit codes: 0 fine, 1 the machine is wrong, a run was broken off or an axis gets no better, 2
wrong use.";

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
    /// Whether the control has tables.
    #[serde(skip)]
    has_tables: bool,
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
    entries: Vec<Entry>,
    errors: Vec<Point>,
    #[serde(skip)]
    gets_no_better: bool,
}

/// A machine parameter of the axis, as it was and as it is proposed.
#[derive(Serialize)]
struct Entry {
    parameter: String,
    from: f64,
    to: f64,
}

/// What an axis is compensated with.
const ENTRIES: [Adjustment; 3] = [Adjustment::Backlash, Adjustment::Linear, Adjustment::Nonlinear];

fn entries(index: u8, before: &ParameterList, after: &ParameterList) -> Vec<Entry> {
    let entry = |what: &Adjustment| {
        Some(Entry {
            parameter: after.adjustment_id(*what, index)?.to_string(),
            from: before.adjustment(*what, index)?,
            to: after.adjustment(*what, index)?,
        })
    };
    ENTRIES.iter().filter_map(entry).collect()
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
    fn of(result: &AxisResult, list: &ParameterList, proposed: &ParameterList) -> Row {
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
            entries: entries(before.index, list, proposed),
            gets_no_better: result.gets_no_better(),
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
    let helps = !found.axes.iter().any(AxisResult::gets_no_better);
    let named = machine.folder.compensation.is_some();
    let changes = named || !found.tables.is_empty() || found.list != machine.parameters;
    let written = options.write && helps && changes;
    if written {
        write(&machine, &found)?;
    }
    let row = |result| Row::of(result, &machine.parameters, &found.list);
    let report = Report {
        written,
        axes: found.axes.iter().map(row).collect(),
        has_tables: machine
            .parameters
            .adjustment_id(Adjustment::Nonlinear, 0)
            .is_some(),
    };
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => console::print(&text(&report))?,
    }
    Ok(match helps {
        true => Outcome::Fine,
        false => Outcome::ProgramError,
    })
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
        for what in ENTRIES {
            let index = result.before.index;
            let value = found.list.adjustment(what, index).unwrap_or_default();
            if let Some((id, _)) = list.adjust(what, index, value) {
                let entry = list.get(id.number, id.index.unwrap_or(0)).unwrap_or_default();
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
        "{:<6}{:>7}{:>12}{:>12}{:>12}{:>14}{:>14}  {}\n",
        "axis", "points", "before, µm", "after, µm", "drift, µm", "backlash, mm", "linear, mm/m", "by"
    );
    for row in &report.axes {
        let mut by: Vec<&str> = row
            .entries
            .iter()
            .map(|entry| entry.parameter.as_str())
            .take(2)
            .collect();
        if row.by_table {
            by.truncate(1);
            by.push("table");
        }
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<6}{:>7}{:>12.3}{:>12.3}{:>12.2}{:>14.4}{:>14.3}  {}",
            row.axis,
            row.points,
            row.before_um,
            row.after_um,
            row.drift_um,
            row.backlash_mm,
            row.linear_mm_m,
            by.join(", ")
        );
    }
    text.push('\n');
    let worse = || report.axes.iter().filter(|row| row.gets_no_better);
    for row in worse() {
        let _ = writeln!(text, "{} gets no better by that", row.axis);
    }
    let mut entries = report.axes.iter().flat_map(|row| &row.entries);
    let proposed = entries.any(|entry| entry.from != entry.to) || report.axes.iter().any(|row| row.by_table);
    let tables = match report.has_tables {
        true => " and the tables",
        false => "",
    };
    text + &match (report.written, proposed && worse().next().is_none()) {
        (true, _) => format!("written into the list of machine parameters{tables}\n"),
        (false, true) => format!("nothing is changed; --write puts it into the list{tables}\n"),
        (false, false) => "nothing is changed\n".to_owned(),
    }
}
