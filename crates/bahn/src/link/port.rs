//! Ports of the commands: written as SPEC, opened, set up as machine parameters say.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use bahn_host::LoadedMachine;
use bahn_link::store::Store;
use bahn_link::{Channel, Line, Settings, Spec};
use bahn_parameters::{ControlModel, MessageId, ParameterList};

use crate::{UsageError, diagnostics, machine_folder};

/// Why a command ends before it begins: told, exit code 1.
pub(super) struct Refused;

impl Refused {
    /// Tells why.
    pub fn because(text: &str) -> Refused {
        diagnostics::print_line(&format!("error: {text}"));
        Refused
    }
}

/// Reads a port.
pub(super) fn spec(option: &str, text: &str) -> Result<Spec, Refused> {
    text.parse()
        .map_err(|error| Refused::because(&format!("{option} {text}: {error}")))
}

/// What a list says for a port.
pub(super) fn settings(list: &ParameterList, spec: &Spec) -> Settings {
    Settings::of(list, spec.mode).on(spec.baud, spec.timeout)
}

/// Opens a port and tells where the other side finds it, when that is not what was written.
pub(super) fn open(spec: &Spec, settings: &Settings) -> Result<Channel, Refused> {
    let channel = Channel::open(spec, settings.characters).map_err(|error| {
        let message = match &spec.line {
            _ if error.is_taken => Some(MessageId::InterfaceAlreadyAssigned),
            // A device that nobody has switched on.
            Line::Connect(_) | Line::Serial(_) => Some(MessageId::ExtInOutputNotReady),
            Line::Listen(_) | Line::Pty(_) => None,
        };
        if let Some(message) = message {
            // Whoever has closed the output knows.
            let _ = crate::console::print_line(message.text(settings.model));
        }
        Refused::because(&error.to_string())
    })?;
    let place = channel.place();
    if place != spec.line.to_string() && !spec.line.to_string().ends_with(&place) {
        diagnostics::print_line(&format!("{} is {place}", spec.line));
    }
    warn_of_others(&spec.line, &place);
    Ok(channel)
}

/// Whoever listens beyond this computer is told so: a data interface asks nobody for a password.
fn warn_of_others(line: &Line, place: &str) {
    let address = place.parse::<SocketAddr>();
    if matches!(line, Line::Listen(_))
        && !address.is_ok_and(|address| address.ip().to_canonical().is_loopback())
    {
        diagnostics::print_line(&format!(
            "warning: {line} can be reached by others: whoever connects reads and writes there without a password"
        ));
    }
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
    let store = Store::of_machine(&machine.programs(0), &plc_folder(&machine));
    let store = store.map_err(|error| UsageError::new(error.to_string()))?;
    Ok(Some(MachineFiles {
        list: machine.parameters,
        store,
    }))
}

/// The folder of the PLC program; a main file beside machine.toml does not open the whole folder.
pub(super) fn plc_folder(machine: &LoadedMachine) -> PathBuf {
    let main = machine.root.join(&machine.folder.plc);
    match main.parent().filter(|folder| **folder != machine.root) {
        Some(folder) => folder.to_owned(),
        None => machine.root.join("plc"),
    }
}

/// The folder of a host or disk.
pub(super) fn disk(folder: &Path) -> Result<Store, UsageError> {
    Store::of_disk(folder).map_err(|error| UsageError::new(error.to_string()))
}
