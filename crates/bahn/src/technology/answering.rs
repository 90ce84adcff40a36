//! Who answers the functions: process times, a script, or the PLC of a machine folder.

use std::path::Path;

use bahn_technology::{EventKind, Report, Run, Script, WINDOW_BYTES};

use super::machine::MachinePlc;
use super::options::TechnologyOptions;
use crate::{UsageError, diagnostics, files};

/// What `--plc` names.
pub(super) struct Answering {
    script: Option<Script>,
    machine: Option<MachinePlc>,
}

impl Answering {
    /// Reads the script and switches on the machine. `None` when the files of the machine are faulty: that was said.
    ///
    /// # Errors
    /// When there are two of a kind, both say what becomes of the functions, or one is not there.
    pub fn new(options: &TechnologyOptions) -> Result<Option<Answering>, UsageError> {
        let (folders, scripts): (Vec<_>, Vec<_>) = options.plc.iter().partition(|path| path.is_dir());
        if folders.len() > 1 || scripts.len() > 1 {
            return Err(UsageError::new(
                "--plc names one script, or the folder of one machine, or one of each",
            ));
        }
        let script = scripts.first().map(|path| script(path)).transpose()?;
        let Some(folder) = folders.first() else {
            return Ok(Some(Answering {
                script,
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
            machine: Some(machine),
        }))
    }

    /// Executes a run.
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

fn script(path: &Path) -> Result<Script, UsageError> {
    let bytes = files::read_table(path)?;
    let text = String::from_utf8_lossy(&bytes);
    text.parse()
        .map_err(|error| UsageError::new(format!("{}:{error}", path.display())))
}
