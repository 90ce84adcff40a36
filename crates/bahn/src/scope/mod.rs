//! `bahn scope`: draws recorded signals as the control's oscilloscope does.
//!
//! - `options`: options and help text; `table`: the recording;
//! - `drawing`: the picture as SVG, `png` as PNG; `summary`: what the signals did, in numbers.

mod drawing;
mod options;
mod png;
mod summary;
mod table;

pub(crate) use options::{EXAMPLES, ScopeOptions};

use std::io::Write;

use crate::cli::Format;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, console, diagnostics};
use drawing::Drawing;
use options::Picture;
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
    let table = Table::load(&options.file)?
        .choose(&options.signals)?
        .between(options.from, options.to)?;
    if let Some(picture) = &options.output {
        draw(&table, picture, options)?;
    }
    let summary = Summary::new(&table, &options.cursor);
    match options.format {
        Format::Text => console::print(&summary.text())?,
        Format::Json => {
            let json = serde_json::to_string_pretty(&summary)
                .map_err(|error| UsageError::new(format!("cannot write the summary: {error}")))?;
            console::print(&(json + "\n"))?;
        }
    }
    Ok(Outcome::Fine)
}

fn draw(table: &Table, picture: &Picture, options: &ScopeOptions) -> Result<(), UsageError> {
    let name = options.file.file_name().unwrap_or_default().to_string_lossy();
    let drawing = Drawing {
        table,
        title: options.title.as_deref().unwrap_or(&name),
        cursors: &options.cursor,
        size: options.size,
    };
    let hidden = table.traces.len() - drawing.shown();
    if hidden > 0 {
        diagnostics::print_line(&format!(
            "{hidden} signals have no place in the drawing ({} analogue ones and {} logic ones have): choose with \
             --signals",
            drawing::ANALOGUE,
            drawing::LOGIC
        ));
    }
    let svg = drawing.svg();
    let (path, bytes) = match picture {
        Picture::Svg(path) => (path, svg.into_bytes()),
        Picture::Png(path) => {
            let png = png::png(&svg);
            (
                path,
                png.map_err(|error| UsageError::new(format!("{}: {error}", path.display())))?,
            )
        }
    };
    let mut file = NewFile::create(path)?;
    file.write_all(&bytes)
        .map_err(|error| files::cannot("write", path, &error))?;
    file.finish()
}
