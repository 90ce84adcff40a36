//! Lists from files, and for which control they are.

use std::path::Path;

use bahn_machine::MachineFolder;
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
    let text = std::fs::read_to_string(list.with_file_name(MachineFolder::FILE)).ok()?;
    let folder = MachineFolder::from_toml(&text).ok()?;
    (list.file_name()? == folder.parameters.as_str())
        .then(|| folder.model.parse().ok())
        .flatten()
}

/// The values of a list over those of the list that the control makes by itself.
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
    let mut list = ParameterList::smallest(text.model());
    list.take(text);
    Ok(list)
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
