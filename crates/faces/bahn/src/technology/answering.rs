//! Who answers the functions: process times, a script, or the PLC of a machine folder.

use std::cell::LazyCell;
use std::path::PathBuf;

use bahn_technology::{ChannelSettings, EventKind, Report, Run, Script, WINDOW_BYTES};
use bahn_text::{Diagnostic, decode};

use super::machine::MachinePlc;
use super::options::TechnologyOptions;
use super::programs::Sources;
use crate::diagnostics;
use crate::{UsageError, files};

/// Script or machine that answers functions: what `--plc` names.
pub(super) struct Answering {
    script: Option<Script>,
    /// What is wrong in the text of the script.
    pub faults: Vec<Diagnostic>,
    source: Option<(PathBuf, String)>,
    machine: Option<MachinePlc>,
}

impl Answering {
    /// Reads the script for contour cycles that take so long, s, and switches on the machine. `None` when the files of the machine are faulty: that was said.
    ///
    /// # Errors
    /// When there are two of a kind, both say what becomes of the functions, or one is not there.
    pub fn new(options: &TechnologyOptions, cycle_s: f64) -> Result<Option<Answering>, UsageError> {
        let (folders, scripts): (Vec<_>, Vec<_>) = options.plc.iter().partition(|path| path.is_dir());
        if folders.len() > 1 || scripts.len() > 1 {
            return Err(UsageError::new(
                "--plc names one script, or the folder of one machine, or one of each",
            ));
        }
        let source = match scripts.first() {
            Some(path) => {
                let text = decode(&files::read_table(path)?);
                Some((PathBuf::from(path), text))
            }
            None => None,
        };
        let read = source.as_ref().map(|(_, text)| Script::for_cycle(text, cycle_s));
        let (script, errors) = match read {
            Some((script, errors)) => (Some(script), errors),
            None => (None, Vec::new()),
        };
        let faults = located(&source, errors);
        let Some(folder) = folders.first() else {
            return Ok(Some(Answering {
                script,
                faults,
                source,
                machine: None,
            }));
        };
        if script.as_ref().is_some_and(Script::answers_functions) {
            return Err(UsageError::new(
                "beside a machine, whose PLC answers the functions, a script says only what happens to path and spindles",
            ));
        }
        let machine = MachinePlc::new(folder, options.window)?;
        Ok(machine.map(|machine| Answering {
            script,
            faults,
            source,
            machine: Some(machine),
        }))
    }

    /// Adds what the script names that the channel does not have.
    pub fn check(&mut self, settings: &ChannelSettings, sources: &Sources) {
        let Some(script) = &self.script else { return };
        // Programs give types, too; only where one seems to lack they are examined.
        let typed = LazyCell::new(|| sources.typed());
        let unknown = script.unknown(settings, |function| typed.contains(function));
        let unknown = located(&self.source, unknown);
        self.faults.extend(unknown);
        self.faults.sort_by_key(|fault| fault.span.line);
    }

    /// Executes a run on the machine, or with the answers of the script.
    pub fn execute<'a>(&'a mut self, run: impl FnOnce(Option<&'a Script>) -> Run<'a>) -> Report {
        let run = run(self.script.as_ref());
        let Some(machine) = &mut self.machine else {
            return run.execute();
        };
        let report = run.execute_beside(machine);
        let any = |kind: EventKind| report.events.iter().any(|event| event.kind == kind);
        if any(EventKind::Output) && !any(EventKind::Fetch) {
            let first = machine.window();
            let last = first + WINDOW_BYTES - 1;
            diagnostics::print_line(&format!(
                "warning: the PLC program answered nothing; does it look at B{first} to B{last}?"
            ));
        }
        report
    }
}

/// Errors of a script in its file.
fn located(source: &Option<(PathBuf, String)>, errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let Some((path, text)) = source else {
        return Vec::new();
    };
    let errors = errors.into_iter();
    errors.map(|error| error.in_text(path.as_path(), text)).collect()
}
