//! `bahn machine new`: a machine to start from.

use std::fs;
use std::io::Write;
use std::path::Path;

use bahn_parameters::{ControlModel, ListText, ParameterError, ParameterList};

use super::options::NewOptions;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, diagnostics};

/// The files of a shipped machine.
macro_rules! machine {
    ($folder:literal: $($file:literal),* $(,)?) => {
        &[$(($file, include_str!(concat!("../../../../machines/", $folder, "/", $file)))),*]
    };
}

type Files = &'static [(&'static str, &'static str)];

const MILL: Files = machine!("mill":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "plc/MAIN.PLC", "plc/MAIN.ER1",
    "plc/functions.txt", "plc/gear.txt", "plc/start.txt", "plc/tool.txt", "programs/BRACKET.H",
    "programs/INDEX.H", "programs/SADDLE.H",
);
const SMALL_MILL: Files = machine!("mill-tnc360":
    "README.md", "machine.toml", "parameters.mp", "plant.toml", "tools.tsv", "plc/MAIN.PLC", "plc/MAIN.ER1",
    "plc/run.txt", "programs/COVER.H",
);

/// Writes the folder.
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
    let model = options.model;
    let files = match model {
        ControlModel::Tnc407 | ControlModel::Tnc415b | ControlModel::Tnc425 => MILL,
        ControlModel::Tnc151 | ControlModel::Tnc155 | ControlModel::Tnc360 => SMALL_MILL,
    };
    for (file, text) in files {
        let content = match *file {
            "machine.toml" => description(text, &name, model),
            "parameters.mp" => parameters(text, model),
            _ => (*text).to_owned(),
        };
        write(&folder.join(file), &content)?;
    }
    diagnostics::print_line(&format!(
        "{}: {name}, {model}, {} files; README.md explains them",
        folder.display(),
        files.len()
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
    file.finish()
}

/// `machine.toml` with another name and model.
fn description(text: &str, name: &str, model: ControlModel) -> String {
    let quoted = toml::Value::from(name).to_string();
    let lines = text
        .lines()
        .map(|line| match line.split('=').next().map(str::trim) {
            Some("name") => format!("name = {quoted}\n"),
            Some("model") => format!("model = \"{}\"\n", model.id()),
            _ => format!("{line}\n"),
        });
    lines.collect()
}

/// The list of the shipped machine without what the model does not have; where that is nearly all, the
/// reference list of the model.
fn parameters(text: &str, model: ControlModel) -> String {
    let list = ListText::from_bytes(model, text.as_bytes());
    if 2 * list.faults().len() > list.entries().len() {
        return ParameterList::reference_text(model).to_owned();
    }
    let unknown = |line: usize| {
        let mut faults = list.faults().iter();
        faults.any(|fault| fault.line == line && matches!(fault.error, ParameterError::UnknownNumber(_)))
    };
    (1..)
        .zip(text.lines())
        .filter(|(number, _)| !unknown(*number))
        .map(|(_, line)| format!("{line}\n"))
        .collect()
}
