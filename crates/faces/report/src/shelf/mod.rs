//! A shelf of programs: all of them run on all cores, one table of what came out.
//!
//! - `crew`: runs them side by side; `row`: what is said of one, `totals` of all;
//! - `table`, `csv`, `html`: how it is written; `against`: what changes from another run.
//!
//! Decision: A program of a shelf that fails alone, but is called by one that runs, is no error

mod against;
mod crew;
mod csv;
mod html;
mod row;
mod table;
mod totals;

use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use bahn_host::files::{self, NewFile};
use bahn_workpiece::{Page, View3d};

pub use against::{Rows, read};
pub use crew::{Done, Work, run};
pub use row::{Row, Verdict};
pub use totals::{About, COLUMNS, Shelf, Totals};

use crate::ReportError;
use crate::test_run::Tested;
use crate::text;

/// Pictures in the page, pixels.
const PICTURE: (u32, u32) = (480, 360);

/// A file for the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReportFile {
    /// A table for spreadsheets.
    Csv(PathBuf),
    /// JSON, which a later run can be compared with.
    Json(PathBuf),
    /// A page for a browser.
    Html(PathBuf),
}

impl ReportFile {
    /// Where it is written.
    pub fn path(&self) -> &Path {
        match self {
            ReportFile::Csv(path) | ReportFile::Json(path) | ReportFile::Html(path) => path,
        }
    }
}

/// Many subprograms cannot run alone: what another program of the shelf calls is judged there.
pub fn mark_called(done: &mut [Done]) {
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

/// Says of each program what changes from an earlier report to now.
pub fn compare(earlier: &Rows, done: &mut [Done]) {
    for Done { row, .. } in done {
        row.changes = match earlier.get(&row.path) {
            Some(before) => against::changes(before, row),
            None => vec!["new".into()],
        };
    }
}

/// The part of a run as PNG, for the page; `None` where there is none.
pub fn picture(tested: &Tested, path: &Path) -> Option<Vec<u8>> {
    let title = path.file_name().unwrap_or_default().to_string_lossy();
    let page = Page::new(PICTURE.0, PICTURE.1, &title, "").ok()?;
    let image = tested.part.as_ref()?.view_3d(&page, &View3d::default());
    let mut png = Vec::new();
    image.write_png(&mut png).ok()?;
    Some(png)
}

/// The table for people.
pub fn text(done: &[Done], about: &About) -> String {
    let rows = rows(done);
    table::render(&rows, &Totals::of(&rows), about)
}

/// The table as JSON.
///
/// # Errors
/// When it cannot be written so.
pub fn json(done: &[Done], about: &About) -> Result<String, ReportError> {
    let rows = rows(done);
    text::json(&Shelf {
        model: about.model.to_string(),
        totals: Totals::of(&rows),
        programs: rows.into_iter().cloned().collect(),
    })
}

/// Writes the table into a file that was begun; `comma` asks for decimal commas in a table for spreadsheets.
///
/// # Errors
/// When the file cannot be written.
pub fn write(
    kind: &ReportFile,
    mut file: NewFile,
    done: &[Done],
    about: &About,
    comma: bool,
) -> Result<(), ReportError> {
    let written = match kind {
        ReportFile::Csv(_) => {
            let text = csv::write(&rows(done), csv::Style::new(comma));
            file.write_all(text.as_bytes())
        }
        ReportFile::Json(_) => file.write_all(json(done, about)?.as_bytes()),
        ReportFile::Html(_) => html::write(&mut file, done, &Totals::of(&rows(done)), about),
    };
    written.map_err(|error| files::cannot("write", kind.path(), &error))?;
    Ok(file.finish()?)
}

fn rows(done: &[Done]) -> Vec<&Row> {
    done.iter().map(|done| &done.row).collect()
}
