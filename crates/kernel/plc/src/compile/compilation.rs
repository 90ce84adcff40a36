//! What the compiler makes of a program.

use bahn_text::{Diagnostic, Severity};

use crate::Fault;
use crate::program::{PlcProgram, SourceText};

/// What the compiler makes of a program.
///
/// ```
/// use bahn_plc::{Compilation, MemoryFiles, Options};
/// let files = MemoryFiles::from([("MAIN.PLC", "L I4\nA I5\n= W8\nEM\n")]);
/// let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
/// assert!(compilation.program.is_none());
/// let error = &compilation.errors[0];
/// assert_eq!((error.error.number(), error.span.line), (21, 3), "the word accumulator is not loaded");
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Compilation {
    /// The program, when there is no error.
    pub program: Option<PlcProgram>,
    /// The errors of all files, by file in the order of linking, then by line; the first thousand of them.
    pub errors: Vec<Fault>,
    /// What is accepted although the printed rules refuse it, in the same order, the first thousand.
    pub warnings: Vec<Fault>,
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
    /// What keeps the program from running, then what is accepted although the printed rules refuse it.
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        let of = |severity, faults: &[Fault]| -> Vec<Diagnostic> {
            let faults = faults.iter().map(|fault| fault.diagnostic(severity, &self.files));
            faults.collect()
        };
        [
            of(Severity::Error, &self.errors),
            of(Severity::Warning, &self.warnings),
        ]
        .concat()
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

/// Load up to which the control keeps its block processing speed [000:12038], %.
const KEPT_PERCENT: f64 = 100.0;

/// Load up to which there is a reserve for data transfer and handwheel: more should not occur [000:12038], %.
const RESERVE_PERCENT: f64 = 150.0;

/// 10 ms, which stop the control [000:11245], %.
const TIME_OUT_PERCENT: f64 = 200.0;
