//! A shelf of programs: all of them run on all cores, one table of what came out.
//!
//! - `collect`: which programs; `against`: what they are compared with.

mod against;
mod collect;

use std::path::Path;
use std::time::Duration;

use bahn_report::shelf::{
    About, COLUMNS, ReportFile, Work, compare, json, mark_called, picture, run, text, write,
};

pub(crate) use collect::programs;

use crate::files::NewFile;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::settings::Equipment;
use crate::test_run::{TestOptions, bench};
use crate::{Outcome, UsageError, console, diagnostics, files, progress};
use against::Other;

/// Time of a program unless the options say otherwise.
const TIME_LIMIT: Duration = Duration::from_secs(300);
/// Runs all programs and writes the table.
pub(crate) fn command(options: &TestOptions, equipment: Equipment) -> Result<Outcome, UsageError> {
    refuse_single_outputs(options)?;
    let files = collect::programs(&options.files, &options.table.ext, "; --ext names others")?;
    let inputs: Vec<&Path> = files.iter().map(AsRef::as_ref).collect();
    files::keep_inputs(&inputs, &options.written())?;
    let datum = equipment.datum;
    let bench = bench(options, equipment, COLUMNS)?;
    let other = options.table.against.as_deref();
    let other = other
        .map(|path| against::load(path, options, &datum))
        .transpose()?;
    let (before, report) = match other {
        Some(Other::Bench(bench)) => (Some(*bench), None),
        Some(Other::Report(rows)) => (None, Some(rows)),
        None => (None, None),
    };
    // All files can be written before the long run begins.
    let outputs = options.table.report.iter();
    let outputs: Vec<(&ReportFile, NewFile)> = outputs
        .map(|file| Ok((file, NewFile::create(file.path())?)))
        .collect::<Result<_, UsageError>>()?;
    let has_page = outputs
        .iter()
        .any(|(file, _)| matches!(file, ReportFile::Html(_)));
    let limit = options.run.time_limit.map_or(TIME_LIMIT, Duration::from_secs_f64);
    let interrupt = Interrupt::on_ctrl_c();
    let bar = progress::of_programs(files.len());
    let mut done = run(
        Work {
            files,
            bench,
            before,
            density: options.table.density,
            draw: has_page.then_some(picture),
            time_limit: limit,
        },
        &|| interrupt.is_requested(),
        &mut || bar.inc(1),
    )?;
    bar.finish_and_clear();
    mark_called(&mut done);
    if let Some(earlier) = report {
        compare(&earlier, &mut done);
    }
    let about = About {
        model: options.model,
        density: options.table.density,
        compared: options.table.against.is_some(),
    };
    for (kind, file) in outputs {
        write(kind, file, &done, &about, options.table.comma)?;
    }
    if interrupt.is_requested() {
        diagnostics::print_line("interrupted: the table so far");
    }
    match options.format {
        Format::Text => console::print(&text(&done, &about))?,
        Format::Json => console::print_bytes(json(&done, &about)?.as_bytes())?,
    }
    Ok(if interrupt.is_requested() {
        Outcome::Interrupted
    } else if done.iter().any(|done| done.row.result.is_fault()) {
        Outcome::ProgramError
    } else {
        Outcome::Fine
    })
}

/// Paths, pictures and meshes belong to one program.
fn refuse_single_outputs(options: &TestOptions) -> Result<(), UsageError> {
    match options.output.written().next() {
        Some((option, _)) => Err(UsageError::new(format!(
            "{option} belongs to a single program; the pictures of many are in --report OUT.html"
        ))),
        None => Ok(()),
    }
}
