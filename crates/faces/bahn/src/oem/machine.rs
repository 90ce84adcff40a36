//! The machine whose cycles are meant.

use bahn_host::LoadedMachine;

use crate::{UsageError, diagnostics};

/// The machine of a folder; `None` when it has faults, which are printed.
pub(super) fn machine(folder: &std::path::Path) -> Result<Option<LoadedMachine>, UsageError> {
    match LoadedMachine::load(folder)? {
        Ok(machine) => Ok(Some(machine)),
        Err(faults) => {
            diagnostics::print_faults(&faults);
            Ok(None)
        }
    }
}
