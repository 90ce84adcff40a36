//! Recorded signals, drawn as the control's oscilloscope does, and summed up.
//!
//! - `table`: the recording;
//! - `lanes`: signals over time, `plane`: the way of two axes and the circle test, both on a [`Sheet`] that is
//!   written as SVG or PNG;
//! - `summary`: what the signals did, in numbers; `circle` and `step` what a circle and a start tell of the axes.

mod circle;
mod lanes;
mod plane;
mod sheet;
mod step;
mod summary;
mod table;

pub use lanes::{ANALOGUE, LOGIC};
pub(crate) use sheet::ticks;
pub use sheet::{Picture, Sheet, write};
pub use summary::Summary;

use std::path::Path;

use crate::ReportError;
use lanes::Drawing;
use table::Table;

/// Reads a recording, for fuzzing; an error begins with its line.
#[doc(hidden)]
pub fn check_recording(text: &str) -> Result<(), String> {
    Table::read(text).map(drop)
}

/// What is asked of a recording. Times are those of the machine, s.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// Path of the recording.
    pub file: &'a Path,
    /// Another one that it is compared with, its start of the program at the same place.
    pub against: Option<&'a Path>,
    /// The signals by their names, `+` between those that share a lane; all without any.
    pub signals: &'a [String],
    /// Begin of the time shown; the start of the program without it.
    pub from: Option<f64>,
    /// End of the time shown.
    pub to: Option<f64>,
    /// From the first sample on, not from the start of the program.
    pub all: bool,
    /// Times at which values are read.
    pub cursors: &'a [f64],
    /// Test the roundness of a circle in the plane of two axes.
    pub circle: Option<&'a [String; 2]>,
    /// Measure the step response of an axis.
    pub step: Option<char>,
}

/// How an answer is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// The way of two axes instead of signals over time.
    pub xy: Option<&'a [String; 2]>,
    /// Deviation of one ring of the circle test, mm; chosen to fit without it.
    pub division_mm: Option<f64>,
    /// What stands above it.
    pub title: &'a str,
    /// Width and height, pixels.
    pub size: (u32, u32),
}

/// A recording with what was found in it.
pub struct Answer<'a> {
    /// All signals in the time shown.
    table: Table,
    /// The signals that were asked for.
    chosen: Table,
    /// Names of the signals that share lanes.
    shared: Vec<Vec<String>>,
    other: Option<Table>,
    cursors: &'a [f64],
    /// What the signals did, in numbers.
    pub summary: Summary,
}

impl<'a> Answer<'a> {
    /// Reads a recording and answers.
    ///
    /// # Errors
    /// When a file is no recording, or does not hold what is asked for.
    pub fn to(question: &Question<'a>) -> Result<Answer<'a>, ReportError> {
        let whole = Table::load(question.file)?;
        let start = whole.start();
        let other = match question.against {
            None => None,
            Some(path) => {
                let mut other = Table::load(path)?;
                let shift = start.zip(other.start()).map_or(0.0, |(own, its)| own - its);
                other.shift(shift);
                Some(other)
            }
        };
        let from = question.from.or(start.filter(|_| !question.all));
        let table = whole.between(from, question.to)?;
        let lanes = question.signals.iter().map(|lane| lane.split('+').map(str::trim));
        let chosen = table.clone().choose(lanes.clone().flatten())?;
        let in_file = |error: String| ReportError::new(format!("{}: {error}", question.file.display()));
        let circle = question
            .circle
            .map(|axes| circle::test(&table, axes.each_ref().map(String::as_str)))
            .transpose()
            .map_err(in_file)?;
        let step = question
            .step
            .map(|axis| step::response(&table, &axis.to_ascii_uppercase().to_string()))
            .transpose()
            .map_err(in_file)?;
        let against = other.as_ref().map(|other| summary::differences(&table, other));
        Ok(Answer {
            summary: Summary::new(&chosen, question.cursors).with(circle, step, against),
            shared: lanes.map(|lane| lane.map(str::to_owned).collect()).collect(),
            table,
            chosen,
            other,
            cursors: question.cursors,
        })
    }

    /// The circle test, the way of two axes, or the signals over time.
    ///
    /// # Errors
    /// When the recording does not have the way that is wanted.
    pub fn sheet(&self, look: &Look<'_>) -> Result<Sheet, ReportError> {
        if let Some(test) = self.summary.circle() {
            return Ok(plane::circle(test, look.division_mm, look.title, look.size));
        }
        if let Some([x, y]) = look.xy {
            let sheet = plane::way(&self.table, self.other.as_ref(), [x, y], look.title, look.size);
            return sheet.ok_or_else(|| ReportError::NoWay(x.clone(), y.clone()));
        }
        Ok(self.lanes(look).sheet())
    }

    /// How many signals have no place in a drawing over time.
    pub fn hidden(&self, look: &Look<'_>) -> usize {
        match self.summary.circle().is_some() || look.xy.is_some() {
            true => 0,
            false => self.chosen.traces.len() - self.lanes(look).shown(),
        }
    }

    fn lanes<'b>(&'b self, look: &Look<'b>) -> Drawing<'b> {
        Drawing {
            table: &self.chosen,
            other: self.other.as_ref(),
            shared: &self.shared,
            title: look.title,
            cursors: self.cursors,
            size: look.size,
        }
    }
}
