//! A script that was read.

use std::path::{Path, PathBuf};

use bahn_text::{Diagnostic, Span};

use crate::times::Base;

/// What happens at a time; a span of time has two of them, one at each end.
#[derive(Clone, Debug, PartialEq)]
pub struct Line<A, C> {
    /// In the file, from 1.
    pub number: u32,
    /// What its time counts from.
    pub base: Base,
    /// Time of the line after its base, µs.
    pub offset_us: u64,
    /// It comes before everything else of this time: it looks at the cycle that has ended then.
    pub after: bool,
    /// It waits from then on until all of this is so.
    pub condition: Vec<C>,
    /// What happens at that time.
    pub action: A,
}

/// A script: its lines in the order of the file.
#[derive(Clone, Debug)]
pub struct Script<A, C> {
    path: PathBuf,
    text: Vec<String>,
    /// What it does, in the order of the file.
    pub lines: Vec<Line<A, C>>,
}

impl<A, C> Default for Script<A, C> {
    fn default() -> Script<A, C> {
        Script::of_text(Path::new(""), "")
    }
}

impl<A, C> Script<A, C> {
    /// A text of which no line is read yet.
    pub(crate) fn of_text(path: &Path, text: &str) -> Script<A, C> {
        Script {
            path: path.to_owned(),
            text: text.lines().map(str::to_owned).collect(),
            lines: Vec::new(),
        }
    }

    /// In the file of the script, with the text of the line.
    pub(crate) fn located(&self, fault: Diagnostic) -> Diagnostic {
        let line = self.line_text(fault.span.line);
        fault.at(self.path.clone(), line)
    }

    /// A line of the file that was not as expected when its time came.
    pub fn failure(&self, number: u32, title: &str, label: String) -> Diagnostic {
        self.located(Diagnostic::error(Span::line(number as usize), title).with_detail(label))
    }

    /// As [`Script::failure`], at the place of an operand in the line.
    pub fn failure_of(&self, number: u32, operand: &str, title: &str, label: String) -> Diagnostic {
        let text = self.line_text(number);
        // The name as it is written, in a script of the same letters mostly.
        let at = text.to_ascii_uppercase().rfind(operand);
        let span = at.map_or(Span::line(number as usize), |at| {
            let before = text.get(..at).unwrap_or_default().chars().count();
            let item = text.get(at..).unwrap_or_default();
            let item = item.split([',', ';', '#']).next().unwrap_or_default().trim_end();
            Span::new(number as usize, before + 1, item.chars().count())
        });
        self.located(Diagnostic::error(span, title).with_detail(label))
    }

    /// Where a line stands, as `mill.txt:3`.
    pub fn place(&self, number: u32) -> String {
        format!("{}:{number}", self.path.display())
    }

    /// The text of a line, from 1.
    pub fn line_text(&self, number: u32) -> String {
        let index = (number as usize).saturating_sub(1);
        self.text.get(index).cloned().unwrap_or_default()
    }
}
