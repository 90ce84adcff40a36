//! Who answers the functions: process times, a script, or the PLC of a machine folder.

use std::path::Path;

use bahn_technology::{Report, Run, Script};

use super::machine::MachinePlc;
use super::options::TechnologyOptions;
use crate::{UsageError, files};

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
        match &mut self.machine {
            Some(machine) => run.execute_beside(machine),
            None => run.execute(),
        }
    }
}

fn script(path: &Path) -> Result<Script, UsageError> {
    let bytes = files::read_table(path)?;
    let text = String::from_utf8_lossy(&bytes);
    text.parse()
        .map_err(|error| UsageError::new(format!("{}:{error}", path.display())))
}
