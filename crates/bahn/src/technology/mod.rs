//! `bahn technology`: programs with M, H and S functions on one channel, with what the PLC does.
//!
//! - `options`: options and help text;
//! - `dynamics`: from a list of machine parameters to the limits of motion;
//! - `answering`: who answers the functions; `machine`: the PLC of a machine folder that does;
//! - `programs`: programs and subroutines from files;
//! - `text`: the report for people; `picture`: velocity, outputs and waits as a drawing.

mod answering;
mod dynamics;
mod machine;
mod options;
mod picture;
mod programs;
mod text;

pub(crate) use options::{EXAMPLES, TechnologyOptions};

use std::path::{Path, PathBuf};

use bahn_motion::Limits;
use bahn_parameters::ControlModel;
use bahn_path::Position;
use bahn_technology::{ChannelList, Coordinates, Fault, NcPrograms, Report, Run};

use crate::options::Format;
use crate::{Outcome, UsageError, channel, console, diagnostics, files, scope, settings};
use answering::Answering;

/// Runs programs in turn on one channel and reports what was output and waited for.
pub(crate) fn command(options: &TechnologyOptions) -> Result<Outcome, UsageError> {
    if let Some(picture) = &options.image {
        let inputs: Vec<&Path> = inputs(options).map(PathBuf::as_path).collect();
        files::keep_inputs(&inputs, &[("--image", picture.path())])?;
    }
    let programs = programs::read(&options.programs)?;
    let Some(mut answering) = Answering::new(options)? else {
        return Ok(Outcome::ProgramError);
    };
    let limits = dynamics::limits(options.parameters.as_deref())?;
    let start = start(options, &programs)?;
    let list = ChannelList::from_bytes(&files::read_table(&options.channel)?);
    if options.format == Format::Text {
        let faults = channel::faults(&list, &options.channel);
        diagnostics::print_faults(&faults);
    }
    let report = match list.errors().first() {
        Some(_) => refused(&list, &options.channel, &limits, start),
        None => answering.execute(|script| Run {
            programs: &programs,
            settings: list.settings(),
            limits: &limits,
            start,
            from: options.from.as_deref(),
            script,
        }),
    };
    if let Some(picture) = &options.image {
        let title = programs::title(&options.programs);
        scope::write(&picture::sheet(&report, &title), picture)?;
    }
    match options.format {
        Format::Text => console::print(&text::text(&report))?,
        Format::Json => console::print_json(&report)?,
    }
    Ok(if report.completed {
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

/// A list with errors is used for nothing: its first error ends the run before it begins.
fn refused(list: &ChannelList, path: &Path, limits: &Limits, start: Position) -> Report {
    let error = list.errors().first().map(|fault| Fault {
        code: "channel-list".to_owned(),
        message: format!("line {}, column {}: {}", fault.line, fault.column, fault.message),
        program: programs::file_name(path),
        block: format!("#{}", fault.line),
    });
    Report {
        completed: false,
        error,
        time_s: 0.0,
        cycle_s: limits.cycle_s,
        events: Vec::new(),
        waits: Vec::new(),
        path_end: Coordinates(start),
        programs: Vec::new(),
        warnings: Vec::new(),
        samples: Vec::new(),
    }
}
