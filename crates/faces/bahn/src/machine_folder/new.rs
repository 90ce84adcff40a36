//! `bahn machine new`: a machine to start from.

use std::fs;
use std::io::Write;
use std::path::Path;

use bahn_parameters::{ControlModel, ListText, ParameterError};

use super::options::NewOptions;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, diagnostics};

pub(super) fn command(options: &NewOptions) -> Result<Outcome, UsageError> {
    let folder = &options.folder;
    if folder.exists() && !is_empty(folder) {
        return Err(UsageError::new(format!(
            "{} is there already and not empty: nothing is overwritten",
            folder.display()
        )));
    }
    let own_name = folder
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let name = options.name.clone().unwrap_or(own_name);
    let of_900 = bahn_machines::SYSTEM900.iter();
    let mut of_900 = of_900.filter(|shipped| options.from.as_deref() == Some(shipped.name));
    if let Some(shipped) = of_900.next() {
        return system900(shipped, folder, &name);
    }
    let model = options.model;
    let (shipped, shipped_model) = shipped_for(model, options.from.as_deref())?;
    let files = shipped
        .files
        .iter()
        .chain([&("FOLDER.md", bahn_machines::FOLDER)]);
    for (file, text) in files {
        let text = text
            .replace(shipped_model.name(), model.name())
            .replace("../FOLDER.md", "FOLDER.md");
        let content = match *file {
            "machine.toml" => description(&text, &name, Some(model)),
            "parameters.mp" => parameters(&text, model),
            "plant.toml" => plant(&text.replace(shipped_model.id(), model.id()), model),
            "README.md" => text.replace(shipped_model.id(), model.id()),
            _ => text,
        };
        write(&folder.join(file), &content)?;
    }
    diagnostics::print_text(&format!(
        "{}: {name}, {model}, {} files; README.md explains them",
        folder.display(),
        shipped.files.len() + 1
    ));
    Ok(Outcome::Fine)
}

/// A machine with a System 900 as it is shipped, with another name.
fn system900(
    shipped: &bahn_machines::ShippedMachine,
    folder: &Path,
    name: &str,
) -> Result<Outcome, UsageError> {
    let files = shipped
        .files
        .iter()
        .chain([&("FOLDER.md", bahn_machines::FOLDER)]);
    for (file, text) in files {
        let text = text.replace("../FOLDER.md", "FOLDER.md").replace(
            &format!("machines/{}", shipped.name),
            &folder.display().to_string(),
        );
        let content = match *file {
            "machine.toml" => description(&text, name, None),
            _ => text,
        };
        write(&folder.join(file), &content)?;
    }
    diagnostics::print_text(&format!(
        "{}: {name}, System 900, {} files; README.md explains them",
        folder.display(),
        shipped.files.len() + 1
    ));
    Ok(Outcome::Fine)
}

fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}

fn write(path: &Path, content: &str) -> Result<(), UsageError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
    }
    let mut file = NewFile::create(path)?;
    file.write_all(content.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}

/// `machine.toml` with another name, and another model where it has one.
fn description(text: &str, name: &str, model: Option<ControlModel>) -> String {
    let quoted = toml::Value::from(name).to_string();
    // Only the machine as a whole has a name and a model.
    let line = |line: &str| {
        let key = line.split('=').next().map_or("", str::trim);
        match (key, model) {
            ("name", _) => format!("name = {quoted}\n"),
            ("model", Some(model)) => format!("model = \"{}\"\n", model.id()),
            _ => format!("{line}\n"),
        }
    };
    text.lines().map(line).collect()
}

/// The list of the shipped machine without what the model does not have.
fn parameters(text: &str, model: ControlModel) -> String {
    let list = ListText::from_bytes(model, text.as_bytes());
    let unknown = |line: usize| {
        let mut faults = list.faults().iter();
        faults.any(|fault| {
            fault.span.line as usize == line && matches!(fault.error, ParameterError::UnknownNumber(_))
        })
    };
    (1..)
        .zip(text.lines())
        .filter(|(number, _)| !unknown(*number))
        .map(|(_, line)| format!("{line}\n"))
        .collect()
}

/// The plant of the shipped machine: the encoders of versions R of the TNC 151 and 155 are at an EXE, which makes five signal
/// periods of one [001:175-177].
fn plant(text: &str, model: ControlModel) -> String {
    match model.limits().square_wave_input {
        0 => text.replace("period_um = 20,", "period_um = 4,"),
        _ => text.to_owned(),
    }
}

/// The shipped machine that is a start for a model, and its own model.
fn shipped_for(
    model: ControlModel,
    name: Option<&str>,
) -> Result<(bahn_machines::ShippedMachine, ControlModel), UsageError> {
    let is_meant = |shipped: &&bahn_machines::ShippedMachine| {
        shipped.models.contains(&model.family().id()) && name.is_none_or(|name| shipped.name == name)
    };
    let all = || bahn_machines::ALL.iter().chain(&bahn_machines::MODULES);
    let listed = || all().chain(&bahn_machines::SYSTEM900);
    let shipped = all().find(is_meant);
    let own = shipped.and_then(|shipped| shipped.models.first()?.parse().ok());
    shipped.copied().zip(own).ok_or_else(|| {
        let named = name.map_or(String::new(), |name| format!(" `{name}`"));
        let names = listed().map(|shipped| format!("{} ({})", shipped.name, shipped.models.join(", ")));
        UsageError::new(format!(
            "no machine{named} to start from is shipped for the {model}; there are {}",
            names.collect::<Vec<_>>().join(", ")
        ))
    })
}
