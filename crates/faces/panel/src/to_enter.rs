//! What is needed before a machine is switched on: its files, or the list of machine parameters that is to be entered.

use std::path::Path;

use bahn_host::{Attendance, LoadedMachine, Operator, PowerOn, State};

/// The list is entered: the control is off, and what it kept stays as it is.
pub(crate) struct Commissioning {
    /// Held, so that nobody else switches the machine on.
    pub state: Option<State>,
    /// The editor was presented: the control goes on when it is left.
    pub is_presented: bool,
}

impl Commissioning {
    /// Takes what the control kept out of its hands, when the list of a machine is to be entered.
    pub fn of(machine: &LoadedMachine, power_on: &mut PowerOn) -> Option<Commissioning> {
        machine.to_be_entered.as_ref().map(|_| Commissioning {
            state: power_on.state.take(),
            is_presented: false,
        })
    }
}

/// Nobody acts at the machine but who has the panel.
pub(crate) fn operator_of(machine: &LoadedMachine) -> Operator {
    Operator::new(Attendance::Absent, machine.folder.operator.clone(), None)
}

/// Loads the machine of a folder, with its faults in words. A list of machine parameters that is empty or has faults is
/// none: it is entered.
///
/// # Errors
/// All faults of all files, one a line.
pub fn load(folder: &Path) -> Result<LoadedMachine, String> {
    let loaded = LoadedMachine::load_to_enter(folder).map_err(|error| error.to_string())?;
    loaded.map_err(|faults| {
        let lines = faults.iter().map(bahn_text::Diagnostic::words);
        lines.collect::<Vec<_>>().join("\n")
    })
}
