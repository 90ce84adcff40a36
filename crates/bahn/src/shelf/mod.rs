//! A shelf of programs: all of them run on all cores, one table of what came out.
//!
//! - `collect`: which programs; `crew`: runs them side by side; `row`: what is said of one;
//! - `table`, `csv`, `html`: how it is written; `against`: what changes from another run.

mod against;
mod collect;
mod crew;
mod csv;
mod html;
mod row;
mod table;
mod totals;

use std::collections::HashSet;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

use bahn_workpiece::{Page, View3d};

pub(crate) use collect::programs;
pub(crate) use crew::bar;
pub(crate) use row::Row;

use crate::files::NewFile;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::settings::Equipment;
use crate::test_run::{Bench, ReportFile, TestOptions, Tested};
use crate::{Outcome, UsageError, console, diagnostics, files};
use against::Other;
use crew::{Done, Work};
use row::Verdict;

use totals::COLUMNS;
pub(crate) use totals::{Shelf, Totals};

/// Time of a program unless the options say otherwise.
const TIME_LIMIT: Duration = Duration::from_secs(300);
/// Pictures in the page, pixels.
const PICTURE: (u32, u32) = (480, 360);

/// Runs all programs and writes the table.
pub(crate) fn command(options: &TestOptions, equipment: Equipment) -> Result<Outcome, UsageError> {
    refuse_single_outputs(options)?;
    let files = collect::programs(&options.files, &options.table.ext, "; --ext names others")?;
    let inputs: Vec<&Path> = files.iter().map(AsRef::as_ref).collect();
    files::keep_inputs(&inputs, &options.written())?;
    let datum = equipment.datum;
    let bench = Bench::new(options, equipment, COLUMNS)?;
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
    let mut done = crew::run(
        Work {
            files,
            bench,
            before,
            density: options.table.density,
            draw: has_page.then_some(picture),
            time_limit: limit,
        },
        &interrupt,
    )?;
    mark_called(&mut done);
    if let Some(earlier) = report {
        for Done { row, .. } in &mut done {
            row.changes = match earlier.get(&row.path) {
                Some(before) => against::changes(before, row),
                None => vec!["new".into()],
            };
        }
    }
    for (kind, file) in outputs {
        write(kind, file, &done, options)?;
    }
    if interrupt.is_requested() {
        diagnostics::print_line("interrupted: the table so far");
    }
    let rows: Vec<&Row> = done.iter().map(|done| &done.row).collect();
    match options.format {
        Format::Text => console::print(&table::render(&rows, &Totals::of(&rows), options))?,
        Format::Json => console::print_bytes(json(&rows, options)?.as_bytes())?,
    }
    Ok(if interrupt.is_requested() {
        Outcome::Interrupted
    } else if rows.iter().any(|row| row.result.is_fault()) {
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

/// Many subprograms cannot run alone: what another program of the shelf calls is judged there.
fn mark_called(done: &mut [Done]) {
    let absolute = |path: &str| std::path::absolute(path).unwrap_or_default();
    let called: HashSet<_> = done
        .iter()
        .filter(|done| done.row.result == Verdict::Ok)
        .flat_map(|done| done.row.calls.iter().map(|path| absolute(path)))
        .collect();
    for Done { row, .. } in done {
        if row.result == Verdict::Error && called.contains(&absolute(&row.path)) {
            row.result = Verdict::Called;
        }
    }
}

fn picture(tested: &Tested, path: &Path) -> Option<Vec<u8>> {
    let title = path.file_name().unwrap_or_default().to_string_lossy();
    let page = Page::new(PICTURE.0, PICTURE.1, &title, "").ok()?;
    let image = tested.part.as_ref()?.view_3d(&page, &View3d::default());
    let mut png = Vec::new();
    image.write_png(&mut png).ok()?;
    Some(png)
}

fn json(rows: &[&Row], options: &TestOptions) -> Result<String, UsageError> {
    let shelf = Shelf {
        model: options.model.to_string(),
        totals: Totals::of(rows),
        programs: rows.iter().map(|row| (*row).clone()).collect(),
    };
    console::json(&shelf)
}

fn write(
    kind: &ReportFile,
    mut file: NewFile,
    done: &[Done],
    options: &TestOptions,
) -> Result<(), UsageError> {
    let rows: Vec<&Row> = done.iter().map(|done| &done.row).collect();
    let written = match kind {
        ReportFile::Csv(_) => {
            let text = csv::write(&rows, csv::Style::new(options.table.comma));
            file.write_all(text.as_bytes())
        }
        ReportFile::Json(_) => file.write_all(json(&rows, options)?.as_bytes()),
        ReportFile::Html(_) => html::write(&mut file, done, &Totals::of(&rows), options),
    };
    written.map_err(|error| files::cannot("write", kind.path(), &error))?;
    Ok(file.finish()?)
}
