//! Lists from files, and for which control they are.

use std::path::Path;

use bahn_machine::MachineFolder;
use bahn_parameters::equipment::{Equipment, HardwareOption, Release};
use bahn_parameters::{ControlModel, ListText, ParameterList};

use super::options::ValueOptions;
use crate::{UsageError, files};
use bahn_report::count;

/// Reads a list for the given control, otherwise for that of the machine in whose folder it lies, otherwise for
/// the one that it names.
pub(super) fn read(path: &Path, model: Option<ControlModel>) -> Result<ListText, UsageError> {
    let bytes = files::read_table(path)?;
    let model = model
        .or_else(|| model_of_folder(path))
        .or_else(|| ControlModel::named_in(&bytes))
        .unwrap_or_default();
    Ok(ListText::from_bytes(model, &bytes))
}

/// The control of the machine whose list this is: `machine.toml` beside it names both.
fn model_of_folder(list: &Path) -> Option<ControlModel> {
    folder_of(list)?.model.parse().ok()
}

/// The machine whose list this is, or one of whose channels.
fn folder_of(list: &Path) -> Option<MachineFolder> {
    let text = std::fs::read_to_string(list.with_file_name(MachineFolder::FILE)).ok()?;
    let folder = MachineFolder::from_toml(&text).ok()?;
    let name = list.file_name()?.to_str()?;
    let mut channels = folder.channels.iter();
    let is_own = folder.parameters == name || channels.any(|channel| channel.parameters == name);
    is_own.then_some(folder)
}

/// The list as the machine has it in whose folder it lies: over the values of the reference list, in a control with its
/// options and its software. What of those is wrong there, `bahn machine check` says.
pub(super) fn of_machine(path: &Path, text: &ListText) -> Option<ParameterList> {
    let folder = folder_of(path)?;
    let model = folder.model.parse().ok().filter(|model| *model == text.model())?;
    let options = folder.equipment.options.as_ref().map(|options| {
        let named = options.iter().map(|option| HardwareOption::named(&option.text));
        named.flatten().collect::<Vec<_>>()
    });
    let mut equipment = options.map_or_else(Equipment::default, |named| Equipment::with_options(&named));
    if let Some(software) = &folder.equipment.software {
        equipment.release = Release::read(model, &software.text).ok();
    }
    let mut list = ParameterList::reference(model).with_equipment(equipment);
    list.take(text);
    Some(list)
}

/// The values of a list over those of the list that the control makes by itself, or as the machine has them whose list it is.
///
/// # Errors
/// When the list has faults; `bahn mp check` names them.
pub(super) fn values(path: &Path, text: &ListText) -> Result<ParameterList, UsageError> {
    let faults = text.faults();
    if let Some(first) = faults.first() {
        return Err(UsageError::new(format!(
            "{}: {first}\nthe list has {}; `bahn mp check` shows all",
            path.display(),
            count(faults.len(), "fault"),
        )));
    }
    Ok(of_machine(path, text).unwrap_or_else(|| {
        let mut list = ParameterList::smallest(text.model());
        list.take(text);
        list
    }))
}

/// The list whose values are shown, and its name.
pub(super) fn shown(options: &ValueOptions) -> Result<(ParameterList, String), UsageError> {
    match &options.list {
        Some(path) => {
            let text = read(path, options.model)?;
            Ok((values(path, &text)?, path.display().to_string()))
        }
        None => {
            let model = options.model.unwrap_or_default();
            Ok((ParameterList::reference(model), format!("reference list {model}")))
        }
    }
}
