//! What a trial has changed in the list.

use std::fmt::Write as _;
use std::io::Write as _;

use bahn_parameters::{Definition, ListText, ParameterList};
use bahn_trials::tuning::Change;
use serde::Serialize;

use crate::files::NewFile;
use crate::{UsageError, files};

#[derive(Serialize)]
pub(super) struct ChangeRow {
    pub(super) parameter: String,
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Puts the proposals, and what `--mp` began with, into the list of the folder.
pub(super) fn write(
    machine: &bahn_host::LoadedMachine,
    changes: &[Change],
    begun_with: &[String],
) -> Result<(), UsageError> {
    let path = machine.root.join(&machine.folder.parameters);
    let bytes = files::read_table(&path)?;
    let model = machine.parameters.model();
    let mut text = ListText::from_bytes(model, &bytes);
    let wrong = |error: bahn_parameters::ParameterError| UsageError::new(error.to_string());
    let mut list = machine.parameters.clone();
    for assignment in begun_with {
        let id = list.assign(assignment).map_err(wrong)?;
        let value = list.get(id.number, id.index.unwrap_or(0)).unwrap_or_default();
        text.set(id, value).map_err(wrong)?;
    }
    for change in changes {
        text.set(change.id, change.to).map_err(wrong)?;
    }
    let mut file = NewFile::create(&path)?;
    file.write_all(&text.to_bytes())
        .map_err(|error| files::cannot("write", &path, &error))?;
    Ok(file.finish()?)
}

/// What is proposed, with the names of the parameters.
pub(super) fn change_rows(changes: &[Change], list: &ParameterList) -> Vec<ChangeRow> {
    let name = |id| Definition::named(list.model(), id).map_or("", |definition| definition.name);
    let rows = changes.iter().map(|change| ChangeRow {
        parameter: change.id.to_string(),
        name: name(change.id).to_owned(),
        from: change.from,
        to: change.to,
    });
    rows.collect()
}

/// The same for people, and whether it is in the list.
pub(super) fn change_text(changes: &[ChangeRow], written: bool) -> String {
    let mut text = "\n".to_owned();
    for change in changes {
        let ChangeRow {
            parameter,
            name,
            from,
            to,
        } = change;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{parameter:<10}{from:>12} -> {to:<12}{name}");
    }
    text + match (changes.is_empty(), written) {
        (true, _) => "nothing gets better than it is\n",
        (false, true) => "\nwritten into the list of machine parameters\n",
        (false, false) => "\nnothing is changed; --write puts it into the list\n",
    }
}
