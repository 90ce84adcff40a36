//! `bahn scope`: draws recorded signals as the control's oscilloscope does.
//!
//! - `options`: options and help text; `table`: the recording;
//! - `lanes`: signals over time, `plane`: the way of two axes and the circle test, both on a `sheet` that is
//!   written as SVG or PNG;
//! - `summary`: what the signals did, in numbers; `circle` and `step` what a circle and a start tell of the axes.

mod circle;
mod lanes;
mod options;
mod plane;
pub(crate) mod sheet;
mod step;
mod summary;
mod table;

pub(crate) use options::{EXAMPLES, Picture, ScopeOptions, picture};

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::files::{self, NewFile};
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};
use lanes::Drawing;
use sheet::Sheet;
use summary::Summary;
use table::Table;

/// Reads a recording, for fuzzing; an error begins with its line.
#[doc(hidden)]
pub fn check_recording(text: &str) -> Result<(), String> {
    table::Table::read(text).map(drop)
}

/// Draws a recording and sums it up.
pub(crate) fn command(options: &ScopeOptions) -> Result<Outcome, UsageError> {
    if options.cursor.len() > 2 {
        return Err(UsageError::new("--cursor: there are two cursors at most"));
    }
    if let Some(Picture::Svg(path) | Picture::Png(path)) = &options.output {
        let inputs: Vec<&Path> = std::iter::once(&options.file)
            .chain(&options.against)
            .map(PathBuf::as_path)
            .collect();
        files::keep_inputs(&inputs, &[("--output", path.as_path())])?;
    }
    let recording = Recordings::load(options)?;
    let in_file = |error: String| UsageError::new(format!("{}: {error}", options.file.display()));
    let circle = options
        .circle
        .as_ref()
        .map(|axes| circle::test(&recording.table, axes.each_ref().map(String::as_str)))
        .transpose()
        .map_err(in_file)?;
    let step = options
        .step
        .map(|axis| step::response(&recording.table, &axis.to_ascii_uppercase().to_string()))
        .transpose()
        .map_err(in_file)?;
    let against = recording.other.as_ref();
    let against = against.map(|other| summary::differences(&recording.table, other));
    let summary = Summary::new(&recording.chosen, &options.cursor).with(circle, step, against);
    if let Some(picture) = &options.output {
        write(&recording.sheet(&summary, options)?, picture)?;
    }
    match options.format {
        Format::Text => console::print(&summary.text())?,
        Format::Json => console::print_json(&summary)?,
    }
    Ok(Outcome::Fine)
}

/// The recording, what is asked of it, and the one that it is compared with.
struct Recordings {
    /// All signals in the time shown.
    table: Table,
    /// The signals that were asked for.
    chosen: Table,
    /// Names of the signals that share lanes.
    shared: Vec<Vec<String>>,
    other: Option<Table>,
}

impl Recordings {
    fn load(options: &ScopeOptions) -> Result<Recordings, UsageError> {
        let whole = Table::load(&options.file)?;
        let start = whole.start();
        let other = match &options.against {
            None => None,
            Some(path) => {
                let mut other = Table::load(path)?;
                let shift = start.zip(other.start()).map_or(0.0, |(own, its)| own - its);
                other.shift(shift);
                Some(other)
            }
        };
        let from = options.from.or(start.filter(|_| !options.all));
        let table = whole.between(from, options.to)?;
        let lanes = options.signals.iter().map(|lane| lane.split('+').map(str::trim));
        let chosen = table.clone().choose(lanes.clone().flatten())?;
        Ok(Recordings {
            shared: lanes.map(|lane| lane.map(str::to_owned).collect()).collect(),
            table,
            chosen,
            other,
        })
    }

    fn sheet(&self, summary: &Summary, options: &ScopeOptions) -> Result<Sheet, UsageError> {
        let name = options.file.file_name().unwrap_or_default().to_string_lossy();
        let title = options.title.as_deref().unwrap_or(&name);
        if let Some(test) = summary.circle() {
            return Ok(plane::circle(test, options.division, title, options.size));
        }
        if let Some([x, y]) = &options.xy {
            let sheet = plane::way(&self.table, self.other.as_ref(), [x, y], title, options.size);
            return sheet.ok_or_else(|| {
                UsageError::new(format!("--xy: the recording has no {x}.actual and {y}.actual"))
            });
        }
        let drawing = Drawing {
            table: &self.chosen,
            other: self.other.as_ref(),
            shared: &self.shared,
            title,
            cursors: &options.cursor,
            size: options.size,
        };
        let hidden = self.chosen.traces.len() - drawing.shown();
        if hidden > 0 {
            diagnostics::print_line(&format!(
                "{hidden} signals have no place in the drawing ({} lanes and {} logic signals have): choose with \
                 --signals",
                lanes::ANALOGUE,
                lanes::LOGIC
            ));
        }
        Ok(drawing.sheet())
    }
}

/// Writes a sheet as its name says.
pub(crate) fn write(sheet: &Sheet, picture: &Picture) -> Result<(), UsageError> {
    let (Picture::Svg(path) | Picture::Png(path)) = picture;
    let mut bytes = Vec::new();
    match picture {
        Picture::Svg(_) => bytes = sheet.svg().into_bytes(),
        Picture::Png(_) => sheet
            .image()
            .write_png(&mut bytes)
            .map_err(|error| UsageError::new(format!("{}: {error}", path.display())))?,
    }
    let mut file = NewFile::create(path)?;
    file.write_all(&bytes)
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}
