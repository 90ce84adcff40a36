//! Lists from files, and for which control they are.

use std::path::Path;

use bahn_machine::MachineFolder;
use bahn_parameters::{ControlModel, ListText, ParameterList};

use super::count;
use super::options::ValueOptions;
use crate::{UsageError, files};

/// Reads a list for the given control, otherwise for that of the machine in whose folder it lies, otherwise for
/// the one that it names.
pub(super) fn read(path: &Path, model: Option<ControlModel>) -> Result<ListText, UsageError> {
    let bytes = files::read_table(path)?;
    let model = model
        .or_else(|| model_of_folder(path))
        .or_else(|| named_model(&bytes))
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

/// The control that the comments at the beginning of a list name, as `TNC 415 B` or `tnc415b`.
pub(crate) fn named_model(bytes: &[u8]) -> Option<ControlModel> {
    let text = String::from_utf8_lossy(bytes);
    let comments = text
        .trim_start_matches('\u{feff}')
        .lines()
        .take_while(|line| line.trim().is_empty() || line.trim_start().starts_with([';', '*']));
    let letters: String = comments
        .flat_map(|line| line.chars().chain(['\n']))
        .filter(|c| *c != ' ' && *c != '\t' && *c != '-')
        .flat_map(char::to_lowercase)
        .collect();
    let place = |model: &ControlModel| letters.find(model.id());
    ControlModel::ALL
        .into_iter()
        .filter(|model| place(model).is_some())
        .min_by_key(place)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_comments_at_the_beginning_name_the_control() {
        assert_eq!(
            named_model(b"; my mill, TNC 415 B\nMP10 : 1\n"),
            Some(ControlModel::Tnc415b)
        );
        assert_eq!(
            named_model(b"\xEF\xBB\xBF\n* tnc-360\n"),
            Some(ControlModel::Tnc360)
        );
        assert_eq!(
            named_model(b"; TNC 155, before that a TNC 151\n"),
            Some(ControlModel::Tnc155)
        );
        assert_eq!(named_model(b"MP10 : 1 ;TNC 360\n"), None);
        assert_eq!(named_model(b""), None);
    }
}
