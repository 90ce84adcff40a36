//! Reads the M functions of `machine.toml` that the machine builder synchronises otherwise than the control model.

use bahn_machine::MachineFolder;
use bahn_parameters::ControlModel;
use bahn_parameters::own_functions::{Lead, OwnFunction, OwnFunctions};

use super::load::Loader;

impl Loader<'_> {
    /// Reads them; faults stand at their lines.
    pub(super) fn functions(&mut self, folder: &MachineFolder, model: ControlModel) -> OwnFunctions {
        let mut functions = OwnFunctions::default();
        for own in &folder.functions {
            let line = |key: &str| own.lines.1.get(key).copied().unwrap_or(own.lines.0);
            let lead = Lead {
                distance_mm: own.lead_mm,
                time_s: own.lead_ms.map(|ms| ms / 1000.0),
            };
            let function = match OwnFunction::of(&own.synchronisation, lead) {
                Ok(function) => function,
                // That there is none is said already.
                Err(_) if own.synchronisation.is_empty() => continue,
                Err(error) => {
                    self.fault_at_line(line("synchronisation"), error.to_string());
                    continue;
                }
            };
            for code in &own.m {
                if let Err(error) = functions.add(model, (*code).into(), function) {
                    self.fault_at_line(line("m"), error.to_string());
                }
            }
        }
        functions
    }
}
