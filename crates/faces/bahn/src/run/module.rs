//! The positioning module that goes along with a run.
//!
//! Decision: Nobody stands by a positioning module: it is switched on with its control, and what its PLC program does not do
//! by itself a script does

use std::sync::Arc;

use bahn_host::{Attendance, FolderPrograms, Host, LoadedMachine, Operator, PowerOn};
use bahn_link::PositioningModule;
use bahn_report::run::ModuleRun;
use bahn_text::Diagnostic;

use super::RunMachineOptions;
use crate::{UsageError, diagnostics, machine_folder};

/// Loads the module that is asked for; the inner `Err` holds every fault of its files.
pub(super) fn load(
    options: &RunMachineOptions,
    machine: &LoadedMachine,
) -> Result<Result<Option<LoadedMachine>, Vec<Diagnostic>>, UsageError> {
    let Some(folder) = &options.with else {
        return Ok(Ok(None));
    };
    let module = match machine_folder::load(folder)? {
        Ok(module) => module,
        Err(faults) => return Ok(Err(faults)),
    };
    let wrong = |what: String| UsageError::new(format!("--with {}: {what}", folder.display()));
    let Some(wiring) = &module.folder.module else {
        return Err(wrong(
            "it is no positioning module: [module] in its machine.toml makes it one".to_owned(),
        ));
    };
    // The logic unit of a module has RS-422 at X25, whatever the control has whose software runs on it [000:18023-18029].
    let model = machine.parameters.model();
    if !model.limits().rs_422 {
        return Err(wrong(format!("the control, {model}, has no RS-422")));
    }
    let simulated = machine.simulated()?;
    let operand = wiring.voltage.map(|input| format!("I{input}"));
    let wire = simulated
        .wires()
        .iter()
        .find(|wire| Some(&wire.operand) == operand.as_ref());
    match wire {
        Some(wire) => Err(wrong(format!(
            "its voltage comes to {}, where {} of {} is wired",
            wire.operand, wire.section, machine.folder.name
        ))),
        None => Ok(Ok(Some(module))),
    }
}

/// Switches it on with its control.
pub(super) fn switch_on(
    options: &RunMachineOptions,
    module: Option<&LoadedMachine>,
    control: &Host,
) -> Result<Option<ModuleRun>, UsageError> {
    let Some((module, wiring)) = module.and_then(|module| Some((module, module.folder.module.as_ref()?)))
    else {
        return Ok(None);
    };
    let power_on = match options.run.fresh {
        true => PowerOn::fresh(module),
        false => PowerOn::kept(module)?,
    };
    diagnostics::print_warnings(&power_on.warnings);
    let programs = Arc::new(FolderPrograms::of_folder(&module.programs(0)));
    let operator = Operator::new(Attendance::Absent, module.folder.operator.clone(), None);
    let host = Host::new(module, power_on, programs, operator)?;
    let beside = PositioningModule::new(host, control, wiring.clone());
    Ok(Some(ModuleRun::new(beside, &module.folder.name)))
}
