//! `bahn scope`: draws recorded signals as the control's oscilloscope does.

mod options;

use std::path::{Path, PathBuf};

use bahn_report::scope::{ANALOGUE, Answer, LOGIC, Look, Picture, Question, write};

pub(crate) use options::{EXAMPLES, ScopeOptions, picture};

use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, files};

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
    let answer = Answer::to(&Question {
        file: &options.file,
        against: options.against.as_deref(),
        signals: &options.signals,
        from: options.from,
        to: options.to,
        all: options.all,
        cursors: &options.cursor,
        circle: options.circle.as_ref(),
        step: options.step,
    })?;
    if let Some(picture) = &options.output {
        draw(&answer, options, picture)?;
    }
    match options.format {
        Format::Text => console::print(&answer.summary.text())?,
        Format::Json => console::print_json(&answer.summary)?,
    }
    Ok(Outcome::Fine)
}

fn draw(answer: &Answer<'_>, options: &ScopeOptions, picture: &Picture) -> Result<(), UsageError> {
    let name = options.file.file_name().unwrap_or_default().to_string_lossy();
    let look = Look {
        xy: options.xy.as_ref(),
        division_mm: options.division,
        title: options.title.as_deref().unwrap_or(&name),
        size: options.size,
    };
    let hidden = answer.hidden(&look);
    if hidden > 0 {
        diagnostics::print_line(&format!(
            "{hidden} signals have no place in the drawing ({ANALOGUE} lanes and {LOGIC} logic signals have): choose with \
             --signals"
        ));
    }
    Ok(write(&answer.sheet(&look)?, picture)?)
}
