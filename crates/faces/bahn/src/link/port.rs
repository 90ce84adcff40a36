//! Ports of the commands: written as SPEC, opened, set up as machine parameters say.

use std::path::Path;
use std::sync::Arc;

use bahn_link::{Channel, Settings, Spec};
use bahn_parameters::{ControlModel, ParameterList};
pub(super) use bahn_ports::open::settings;
use bahn_ports::{Tell, open};
use bahn_store::Store;

use crate::{UsageError, diagnostics, machine_folder};

/// Why a command ends before it begins: told, exit code 1.
pub(super) struct Refused;

impl Refused {
    /// Prints the reason, which is told with this.
    pub fn because(text: &str) -> Refused {
        diagnostics::print_line(&format!("error: {text}"));
        Refused
    }
}

/// Tells it: what the control says as it says messages, the rest as an error.
impl From<open::Refused> for Refused {
    fn from(refused: open::Refused) -> Refused {
        if let Some(message) = refused.message {
            // Whoever has closed the output knows.
            let _ = crate::console::print_line(message);
        }
        refused.why.map_or(Refused, |why| Refused::because(&why))
    }
}

/// Lines of the interfaces for people.
pub(super) fn tell() -> Tell {
    Arc::new(diagnostics::print_line)
}

/// The port that an option names; `option` stands in the message.
pub(super) fn spec(option: &str, text: &str) -> Result<Spec, Refused> {
    open::spec(option, text).map_err(Refused::from)
}

/// Opens a port and tells where the other side finds it, when that is not what was written.
pub(super) fn open(spec: &Spec, settings: &Settings) -> Result<Channel, Refused> {
    open::open(spec, settings, &tell()).map_err(Refused::from)
}

/// The list of a file, or that of the usual control: for hosts and disks, which have no machine.
pub(super) fn list(file: Option<&Path>) -> Result<ParameterList, Refused> {
    let model = ControlModel::default();
    let Some(file) = file else {
        return Ok(ParameterList::reference(model));
    };
    let wrong = |what: &dyn std::fmt::Display| Refused::because(&format!("{}: {what}", file.display()));
    let bytes = std::fs::read(file).map_err(|error| wrong(&error))?;
    ParameterList::load(model, &bytes).map_err(|errors| match errors.first() {
        Some(error) => wrong(error),
        None => wrong(&"no list of machine parameters"),
    })
}

/// A machine whose files are transferred.
pub(super) struct MachineFiles {
    pub list: ParameterList,
    pub store: Store,
}

/// Loads a machine; `None` when it has faults, which are printed.
pub(super) fn machine(folder: &Path) -> Result<Option<MachineFiles>, UsageError> {
    let machine = match machine_folder::load(folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(None);
        }
    };
    let store = Store::of_machine(&machine.programs(0), &bahn_service::plc_folder(&machine));
    let store = store.map_err(|error| UsageError::new(error.to_string()))?;
    Ok(Some(MachineFiles {
        store: store.ruled_by(&machine.parameters),
        list: machine.parameters,
    }))
}

/// The folder of a host or disk.
pub(super) fn disk(folder: &Path) -> Result<Store, UsageError> {
    Store::of_disk(folder).map_err(|error| UsageError::new(error.to_string()))
}
