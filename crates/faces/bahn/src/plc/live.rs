//! A PLC program in the control of a machine: its files, and what is asked of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_host::{Attendance, FolderPrograms, LoadedMachine, Machine900, Script, Stage};
use bahn_parameters::ControlModel;
use bahn_report::plc::Live;

use super::bench::set_operands;
use super::options::{BenchOptions, MachineOptions, ProgramOptions};
use crate::{UsageError, diagnostics, files, machine_folder};

/// Switches on the machine of a folder, without what survived and keeping nothing. `None` when its files are faulty:
/// that was said.
pub(super) fn live(
    program: &ProgramOptions,
    bench: &BenchOptions,
    options: &MachineOptions,
) -> Result<Option<Live>, UsageError> {
    let folder = &program.file;
    if program.parameters.is_some() || program.strict {
        return Err(UsageError::new(
            "--parameters and --strict are of the bench: a folder says what its machine has",
        ));
    }
    if Machine900::is_meant(folder) {
        return Err(UsageError::new(format!(
            "{} has a System 900: `bahn run` shows its PLC with --signals, and check, list and xref take the folder",
            folder.display()
        )));
    }
    let machine = match machine_folder::load(folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(None);
        }
    };
    let model = machine.parameters.model();
    if program.model != ControlModel::default() && program.model != model {
        return Err(UsageError::new(format!(
            "--model {}: this machine has a {model}",
            program.model
        )));
    }
    let Some(script) = load_script(bench, &machine)? else {
        return Ok(None);
    };
    let programs = load_programs(options, &machine)?;
    let attendance = match bench.script {
        Some(_) => Attendance::Start,
        None => Attendance::Full,
    };
    let live = Live::new(&machine, attendance, script, programs, &set_operands(bench)?);
    live.map_err(|error| UsageError::new(format!("--set {error}")))
}

/// The script, for a machine; `None` when it is faulty: that was said.
fn load_script(options: &BenchOptions, machine: &LoadedMachine) -> Result<Option<Script>, UsageError> {
    let Some(path) = &options.script else {
        return Ok(Some(Script::default()));
    };
    let bytes = files::read_table(path)?;
    let stage = Stage::machine(machine.simulated()?, &machine.parameters);
    match stage.script(path, &bytes) {
        Ok(script) => Ok(Some(script)),
        Err(faults) => {
            diagnostics::print_faults(&faults);
            Ok(None)
        }
    }
}

/// The programs of each channel, with the one that the operator starts; the first channel comes first.
fn load_programs(
    options: &MachineOptions,
    machine: &LoadedMachine,
) -> Result<Vec<Arc<FolderPrograms>>, UsageError> {
    let channels = 1 + machine.channels.len();
    if options.part.len() > channels {
        return Err(UsageError::new(format!(
            "--part: the machine has channels for {channels}"
        )));
    }
    let programs = (0..channels).map(|channel| {
        let main = match options.part.is_empty() {
            true => machine.usual_program(channel).map(Path::new),
            false => options.part.get(channel).map(PathBuf::as_path),
        };
        Ok(Arc::new(FolderPrograms::new(&machine.programs(channel), main)?))
    });
    programs.collect()
}

/// Whether a path is the folder of a machine.
pub(super) fn is_machine(path: &Path) -> bool {
    path.is_dir()
}
