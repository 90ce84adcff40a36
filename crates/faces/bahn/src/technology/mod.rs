//! `bahn technology`: programs with M, H and S functions on one channel, with what the PLC does.
//!
//! - `options`: options and help text;
//! - `dynamics`: from a list of machine parameters to the limits of motion;
//! - `answering`: who answers the functions; `machine`: the PLC of a machine folder that does;
//! - `faults`: what is wrong in the files, with its place;
//! - `programs`: programs and subroutines from files.

mod answering;
mod dynamics;
mod faults;
mod machine;
mod options;
mod programs;

pub(crate) use options::{EXAMPLES, TechnologyOptions};

use std::path::{Path, PathBuf};

use bahn_motion::Limits;
use bahn_parameters::ControlModel;
use bahn_path::Position;
use bahn_report::scope::write;
use bahn_report::technology::{sheet, text};
use bahn_technology::{Bounds, ChannelList, Coordinates, Fault, NcPrograms, Report, Run};
use bahn_text::Diagnostic;

use crate::diagnostics::{self, Item};
use crate::options::Format;
use crate::{Outcome, UsageError, console, files, settings};
use answering::Answering;

/// Runs programs in turn on one channel and reports what was output and waited for.
pub(crate) fn command(options: &TechnologyOptions) -> Result<Outcome, UsageError> {
    if let Some(picture) = &options.image {
        let inputs: Vec<&Path> = inputs(options).map(PathBuf::as_path).collect();
        files::keep_inputs(&inputs, &[("--image", picture.path())])?;
    }
    let sources = programs::read(&options.programs)?;
    let limits = dynamics::limits(options.parameters.as_deref())?;
    let Some(mut answering) = Answering::new(options, limits.cycle_s)? else {
        return Ok(Outcome::ProgramError);
    };
    let start = start(options, &sources.programs)?;
    let list = ChannelList::for_cycle(&files::read_table(&options.channel)?, limits.cycle_s);
    let mut faults = faults::of_texts(&list, &options.channel, &sources);
    if list.errors().is_empty() {
        answering.check(list.settings(), &sources);
    }
    let is_scripted = answering.faults.is_empty();
    faults.append(&mut answering.faults);
    if options.format == Format::Text {
        diagnostics::print_faults(&faults);
    }
    if !is_scripted && options.format == Format::Text {
        return Ok(Outcome::WrongUse);
    }
    let report = match list.errors().first() {
        Some(error) => refused(list_fault(error, &options.channel), &limits, start),
        None if !is_scripted => refused(script_fault(&faults), &limits, start),
        None => answering.execute(|script| Run {
            programs: &sources.programs,
            settings: list.settings(),
            limits: &limits,
            start,
            from: options.from.as_deref(),
            bounds: Bounds {
                time_s: options.max_time,
                blocks: options.max_blocks,
            },
            script,
        }),
    };
    let ended = report.error.as_ref();
    if let Some(fault) = ended.and_then(|error| faults::of_run(error, &sources, &faults)) {
        if options.format == Format::Text {
            diagnostics::print_fault(&fault);
        }
        faults.push(fault);
    }
    if let Some(picture) = &options.image {
        let title = programs::title(&options.programs);
        write(&sheet(&report, &title), picture)?;
    }
    match options.format {
        Format::Text => console::print(&text(&report))?,
        Format::Json => console::print_json(&WithFaults {
            report: &report,
            diagnostics: faults.iter().map(Item::from).collect(),
        })?,
    }
    Ok(if !is_scripted {
        Outcome::WrongUse
    } else if report.completed {
        Outcome::Fine
    } else {
        Outcome::ProgramError
    })
}

/// Where the path starts: the axes that the programs name are at 0 but for what is said otherwise.
fn start(options: &TechnologyOptions, programs: &NcPrograms) -> Result<Position, UsageError> {
    let mut start = settings::position("--start", &options.start, ControlModel::default())?;
    for axis in programs.axes().iter() {
        start[axis] = start.get(axis).unwrap_or(0.0);
    }
    Ok(start)
}

/// All files that are read.
fn inputs(options: &TechnologyOptions) -> impl Iterator<Item = &PathBuf> {
    let others = options.plc.iter().chain(&options.parameters);
    options
        .programs
        .iter()
        .chain(std::iter::once(&options.channel))
        .chain(others)
}

/// The report with what is wrong in the files.
#[derive(serde::Serialize)]
struct WithFaults<'a> {
    #[serde(flatten)]
    report: &'a Report,
    diagnostics: Vec<Item>,
}

/// The first error of a list.
fn list_fault(fault: &Diagnostic, path: &Path) -> Fault {
    Fault {
        code: "channel-list".to_owned(),
        message: format!(
            "line {}, column {}: {}",
            fault.span.line, fault.span.column, fault.message
        ),
        program: programs::file_name(path),
        block: format!("#{}", fault.span.line),
        line: fault.span.line,
    }
}

/// The first error of a script, which stands after those of all others.
fn script_fault(faults: &[Diagnostic]) -> Fault {
    let last = faults.last();
    let line = last.map_or(0, |fault| fault.span.line);
    Fault {
        code: "script".to_owned(),
        message: last.map_or_else(String::new, |fault| fault.message.clone()),
        program: last.map_or_else(String::new, |fault| programs::file_name(&fault.file)),
        block: format!("#{line}"),
        line,
    }
}

/// A list or script with errors is used for nothing: an error ends the run before it begins.
fn refused(error: Fault, limits: &Limits, start: Position) -> Report {
    Report {
        completed: false,
        error: Some(error),
        time_s: 0.0,
        cycle_s: limits.cycle_s,
        events: Vec::new(),
        waits: Vec::new(),
        skipped: None,
        path_end: Coordinates(start),
        programs: Vec::new(),
        warnings: Vec::new(),
        samples: Vec::new(),
    }
}
