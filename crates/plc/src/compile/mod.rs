//! From source files to a program.

mod chain;
mod cost;
mod emit;
mod file;
mod labels;
mod link;
mod structure;
mod time;

use bahn_parameters::ControlModel;

use crate::program::{PlcProgram, SourceText};
use crate::source::{ProgramMemory, SourceFiles};
use crate::{Diagnostic, PlcError};

/// How a program is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Options {
    /// The control: it limits the length of the code.
    pub model: ControlModel,
    /// Whether lines that only the manual's own listings spell like that are errors.
    pub strict: bool,
    /// Where the files come from (MP4010).
    pub memory: ProgramMemory,
}

impl Default for Options {
    /// A TNC 415B, tolerant, from the RAM.
    fn default() -> Options {
        Options {
            model: ControlModel::Tnc415b,
            strict: false,
            memory: ProgramMemory::Ram,
        }
    }
}

impl Options {
    /// For a control model, tolerant, from the RAM.
    pub fn for_model(model: ControlModel) -> Options {
        Options {
            model,
            ..Options::default()
        }
    }

    /// Refuses loose spelling.
    pub fn strict(self) -> Options {
        Options { strict: true, ..self }
    }

    /// With files of a memory.
    pub fn stored_in(self, memory: ProgramMemory) -> Options {
        Options { memory, ..self }
    }

    /// Bytes of code of all files together.
    fn code_bytes_max(self) -> u32 {
        self.model.limits().plc_code_max_bytes
    }
}

/// What the compiler makes of a program.
///
/// ```
/// use bahn_plc::{Compilation, MemoryFiles, Options};
/// let files = MemoryFiles::from([("MAIN.PLC", "L I4\nA I5\n= W8\nEM\n")]);
/// let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
/// assert!(compilation.program.is_none());
/// let error = &compilation.errors[0];
/// assert_eq!((error.error.number(), error.line), (21, 3), "the word accumulator is not loaded");
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Compilation {
    /// The program, when there is no error.
    pub program: Option<PlcProgram>,
    /// The errors of all files, by file in the order of linking, then by line; the first thousand of them.
    pub errors: Vec<Diagnostic>,
    /// What is accepted although the printed rules refuse it, in the same order, the first thousand.
    pub warnings: Vec<Diagnostic>,
    /// Errors and warnings beyond those.
    pub not_listed: usize,
    /// The files that were read, main file first, also when there are errors.
    pub files: Vec<SourceText>,
    /// Length of the code in bytes, as far as it was read.
    pub size_bytes: u32,
    /// Nominal time of the longest way through the main program in ns: no jump backward, every module call
    /// that lies on the way counted. Zero when there are errors.
    pub nominal_time: u64,
}

impl Compilation {
    /// Compiles a main file and all that it links. Never fails: errors are in the result.
    pub fn compile(files: &dyn SourceFiles, main: &str, options: Options) -> Compilation {
        link::compile(files, main, options)
    }

    /// The nominal time in percent, as the PLC menu shows it: 100 % are 5 ms [000:12038].
    pub fn nominal_percent(&self) -> f64 {
        crate::run::percent(self.nominal_time)
    }

    /// What is too much for the control, though it can be compiled, in words: the number of commands and the nominal time.
    pub fn load(&self) -> Vec<String> {
        let mut found = Vec::new();
        let commands = self.program.as_ref().map_or(0, |program| program.code.len());
        if commands > COMMANDS_MAX {
            found.push(format!(
                "{commands} commands: a PLC run has time for {COMMANDS_MAX} of them"
            ));
        }
        let percent = self.nominal_percent();
        let means = match percent {
            _ if percent > TIME_OUT_PERCENT => "more than 10 ms: PLC-program error 53 stops the control",
            _ if percent > RESERVE_PERCENT => {
                "above 150 % no reserve is left for data transfer and handwheel: error 53 may come"
            }
            _ if percent > KEPT_PERCENT => "above 100 % the control does not keep its block processing speed",
            _ => return found,
        };
        found.push(format!("nominal cycle time {percent:.2} %: {means}"));
        found
    }
}

/// Logic commands for which a PLC run has time [000:11185].
const COMMANDS_MAX: usize = 8000;
/// Load up to which the control keeps its block processing speed, and that which should not occur [000:12038], %.
const KEPT_PERCENT: f64 = 100.0;
const RESERVE_PERCENT: f64 = 150.0;
/// 10 ms, which stop the control [000:11245], %.
const TIME_OUT_PERCENT: f64 = 200.0;

/// Errors that are listed at most, and warnings: a file that is no PLC program has one in each of a million
/// lines.
const LISTED_MAX: usize = 1000;

/// Errors and warnings while they are collected.
#[derive(Debug, Default)]
struct Reports {
    errors: Vec<(usize, Diagnostic)>,
    warnings: Vec<(usize, Diagnostic)>,
    /// Those beyond [`LISTED_MAX`].
    not_listed: usize,
    /// The error that came last is listed.
    last_is_listed: bool,
}

/// Where a report belongs.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    line: u32,
    column: u32,
}

impl Reports {
    fn error(&mut self, file: (usize, &str), place: Place, error: PlcError, detail: &str) {
        self.last_is_listed = self.errors.len() < LISTED_MAX;
        if self.last_is_listed {
            self.errors
                .push((file.0, diagnostic(file.1, place, error, detail)));
        } else {
            self.not_listed += 1;
        }
    }

    /// The last error comes from what was opened at a place.
    fn opened_at(&mut self, place: Place) {
        if let Some((_, error)) = self.errors.last_mut().filter(|_| self.last_is_listed) {
            error.opened = Some((place.line, place.column));
        }
    }

    fn warning(&mut self, file: (usize, &str), place: Place, error: PlcError, detail: &str) {
        if self.warnings.len() < LISTED_MAX {
            self.warnings
                .push((file.0, diagnostic(file.1, place, error, detail)));
        } else {
            self.not_listed += 1;
        }
    }

    /// By file in the order of linking, then by line and column.
    fn sorted(mut reports: Vec<(usize, Diagnostic)>) -> Vec<Diagnostic> {
        reports.sort_by_key(|(file, report)| (*file, report.line, report.column));
        reports.into_iter().map(|(_, report)| report).collect()
    }
}

fn diagnostic(file: &str, place: Place, error: PlcError, detail: &str) -> Diagnostic {
    let message = if detail.is_empty() {
        error.text().to_owned()
    } else {
        format!("{}: {detail}", error.text())
    };
    Diagnostic {
        error,
        file: file.to_owned(),
        line: place.line,
        column: place.column,
        message,
        opened: None,
    }
}
