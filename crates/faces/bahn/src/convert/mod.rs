//! `bahn convert`: programs in another language, with the proof that they do the same.
//!
//! - `options`: options and help; `set`: which programs, and where they go; here: one program after the other.

mod options;
mod set;

use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use bahn_report::convert::{self as reported, Converter, Job, Report, Reports};
use bahn_report::text;

pub(crate) use options::{ConvertOptions, EXAMPLES};

use crate::files::{self, NewFile};
use crate::interrupt::Interrupt;
use crate::options::{FmtOptions, Format};
use crate::settings::{self, Equipment};
use crate::{Outcome, UsageError, console, diagnostics, progress};

/// Converts, proves, writes and reports.
pub(crate) fn command(options: &ConvertOptions) -> Result<Outcome, UsageError> {
    let jobs = set::jobs(options)?;
    set::keep_inputs(&jobs, options.replace)?;
    let equipment = Equipment::of(options.model, &options.machine)?;
    let interrupt = Interrupt::on_ctrl_c();
    let converter = converter(options, equipment)?;
    let (made, library) = converter.in_blocks(&jobs);
    let many = jobs.len() > 1 || options.input.is_dir();
    let bar = many.then(|| progress::of_programs(jobs.len()));
    let limit = options.run.time_limit.map(Duration::from_secs_f64);
    let mut reports = Vec::new();
    for (job, made) in jobs.iter().zip(made) {
        if interrupt.is_requested() {
            break;
        }
        let stop = interrupt.stop_of_one(limit);
        let (report, text) = converter.finish(job, made, &library, &stop);
        if let Some(text) = text {
            write(job, &text)?;
        }
        stop.run_is_over();
        reports.push(report);
        if let Some(bar) = &bar {
            bar.inc(1);
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    let ok = reports.iter().all(|report| report.ok);
    say(reports, many, options)?;
    Ok(match (interrupt.is_requested(), ok) {
        (true, _) => Outcome::Interrupted,
        (false, true) => Outcome::Fine,
        (false, false) => Outcome::ProgramError,
    })
}

/// What the options say of how programs are written.
fn converter(options: &ConvertOptions, equipment: Equipment) -> Result<Converter, UsageError> {
    let machine = &options.machine;
    let given = machine.folder.is_some() || machine.parameters.is_some() || !machine.mp.is_empty();
    Ok(Converter {
        settings: settings::interpreter(&equipment, &options.run)?,
        to: options.to.into(),
        iso_step: options.iso_step.unwrap_or_else(|| match given {
            true => equipment.list.operation_parameters().iso_step,
            false => FmtOptions::ISO_STEP,
        }),
        unrolls: !options.no_unroll,
        proves: !options.no_prove,
        comments: !options.no_comments,
        user_functions: options.user_functions,
        list: equipment.list,
    })
}

fn say(mut reports: Vec<Report>, many: bool, options: &ConvertOptions) -> Result<(), UsageError> {
    let ok = reports.iter().all(|report| report.ok);
    let text = match (options.format, many) {
        (Format::Json, true) => text::json(&Reports {
            ok,
            programs: reports,
        })?,
        (Format::Json, false) => match reports.pop() {
            Some(report) => text::json(&report)?,
            None => String::new(),
        },
        (Format::Text, true) => {
            let mut text: String = reports
                .iter()
                .map(|report| reported::line(report) + "\n")
                .collect();
            let good = reports.iter().filter(|report| report.ok).count();
            text += &format!("{good} of {} programs are converted and proved\n", reports.len());
            text
        }
        (Format::Text, false) => reports.iter().map(reported::text).collect(),
    };
    // What is converted goes to standard output itself.
    if options.output.as_deref() == Some(Path::new("-")) {
        diagnostics::print_text(text.trim_end());
        return Ok(());
    }
    console::print(&text)
}

fn write(job: &Job, text: &str) -> Result<(), UsageError> {
    let Some(path) = &job.target else {
        return console::print_bytes(text.as_bytes());
    };
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|error| files::cannot("write", folder, &error))?;
    }
    let mut file = NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}
