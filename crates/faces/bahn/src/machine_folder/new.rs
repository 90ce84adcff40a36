//! `bahn machine new`: a machine to start from.

use std::fs;
use std::io::Write;
use std::path::Path;

use bahn_parameters::terminals::Board;
use bahn_parameters::{ControlModel, ListText, Numbering, ParameterError, ParameterId, ParameterList};

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
        let text = inputs_of_panel(&text, model);
        let content = match *file {
            "machine.toml" => description(&text, &name, model),
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

/// Workpiece datum of the small mill where positions count from the reference marks, mm.
const OLD_DATUM: &[(&str, &str)] = &[("X", "-274"), ("Y", "-147"), ("Z", "-221.5")];

/// `machine.toml` with another name and model.
fn description(text: &str, name: &str, model: ControlModel) -> String {
    let quoted = toml::Value::from(name).to_string();
    let datum = |key: &str| OLD_DATUM.iter().find(|(axis, _)| is_old(model) && *axis == key);
    // Only the machine as a whole has a name and a model.
    let line = |line: &str| {
        let key = line.split('=').next().map_or("", str::trim);
        match (key, datum(key)) {
            ("name", _) => format!("name = {quoted}\n"),
            ("model", _) => format!("model = \"{}\"\n", model.id()),
            (_, Some((axis, value))) => format!("{axis} = {value}\n"),
            _ => format!("{line}\n"),
        }
    };
    text.lines().map(line).collect()
}

/// What the small mill has other than the reference list of the TNC 151 and 155: no rotary table, marks
/// every turn of the ballscrew after a cam, its travel from there, play, spindle and headstock.
const SMALL_MILL_OLD: &[(u16, f64)] = &[
    (72, 8.0),
    (242, 0.0),
    (243, 0.0),
    (244, 0.0),
    (44, 26.0),
    (45, -374.0),
    (46, 23.0),
    (47, -227.0),
    (48, 18.5),
    (49, -281.5),
    (36, 0.02),
    (37, 0.02),
    (38, 0.01),
    (78, 4000.0),
    (79, 0.0),
    (169, 0.4),
    // Timers T2, T3 and T8 of the PLC program.
    (112, 200.0),
    (113, 120.0),
    (118, 3.0),
    // Central tool memory.
    (225, 99.0),
];

/// The list of the shipped machine without what the model does not have. The TNC 151 and 155 number theirs
/// in another way: their reference list, fitted to the machine.
fn parameters(text: &str, model: ControlModel) -> String {
    if is_old(model) {
        let mut list = ListText::from_bytes(model, ParameterList::reference_text(model).as_bytes());
        for (number, value) in SMALL_MILL_OLD {
            let id = ParameterId {
                number: *number,
                index: None,
            };
            // The test of new machines would show a number that the model does not have.
            let _ = list.set(id, *value);
        }
        return String::from_utf8_lossy(&list.to_bytes()).into_owned();
    }
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

/// The shipped machine that is a start for a model, and its own model.
fn shipped_for(
    model: ControlModel,
    name: Option<&str>,
) -> Result<(bahn_machines::ShippedMachine, ControlModel), UsageError> {
    let is_meant = |shipped: &&bahn_machines::ShippedMachine| {
        shipped.models.contains(&model.family().id()) && name.is_none_or(|name| shipped.name == name)
    };
    let shipped = bahn_machines::ALL.iter().find(is_meant);
    let own = shipped.and_then(|shipped| shipped.models.first()?.parse().ok());
    shipped.copied().zip(own).ok_or_else(|| {
        let named = name.map_or(String::new(), |name| format!(" `{name}`"));
        let names =
            bahn_machines::ALL.map(|shipped| format!("{} ({})", shipped.name, shipped.models.join(", ")));
        UsageError::new(format!(
            "no machine{named} to start from is shipped for the {model}; there are {}",
            names.join(", ")
        ))
    })
}

fn is_old(model: ControlModel) -> bool {
    model.limits().numbering == Numbering::Old
}

/// The operating panel is wired to I128 ff. where the control has inputs of its own for it, otherwise to I32 ff.
/// of the first board, or without boards to what is left of the standard interface.
fn inputs_of_panel(text: &str, model: ControlModel) -> String {
    if !is_old(model) {
        return text.to_owned();
    }
    if Board::of(model).next().is_none() {
        let moved = STANDARD_INTERFACE.iter();
        return moved.fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    }
    (PANEL_INPUTS..PANEL_INPUTS + 25).fold(text.to_owned(), |text, input| {
        text.replace(
            &format!("I{input}"),
            &format!("I{}", input - PANEL_INPUTS + OLD_PANEL_INPUTS),
        )
    })
}

/// Where the panel and the last output of the small mill are wired to in version B, which has E0-E23 and A0-A22.
const STANDARD_INTERFACE: [(&str, &str); 14] = [
    ("I128", "I4"),
    ("I129", "I5"),
    ("I130", "I6"),
    ("I133", "I7"),
    ("I134", "I8"),
    ("I135", "I9"),
    ("I138", "I12"),
    ("I143", "I13"),
    ("I144", "I14"),
    ("I145", "I15"),
    ("I146", "I17"),
    ("I147", "I19"),
    ("I148", "I20"),
    ("O24", "O22"),
];

/// First input of the operating panel [000:11556-11567].
const PANEL_INPUTS: u16 = 128;
/// First input of the TNC 151 and 155 for the panel, on the first board [001:297].
const OLD_PANEL_INPUTS: u16 = 32;

/// The TNC 151 and 155 count 20 steps to a signal period: 1 µm with one of 20 µm [001:1616-1625]; they take
/// the first reference mark of each axis, so there is one.
fn plant(text: &str, model: ControlModel) -> String {
    if !is_old(model) {
        return text.to_owned();
    }
    // Versions R count the signals of an EXE, which makes five periods of one.
    let period = match model.limits().square_wave_input {
        0 => "period_um = 4,",
        _ => "period_um = 20,",
    };
    text.replace("period_um = 4,", period)
        .replace("marks_every = 10, marks_from = 4 ", "mark = 374 ")
        .replace("marks_every = 10, marks_from = 7 ", "mark = 227 ")
        .replace("marks_every = 10, marks_from = 1.5 ", "mark = 281.5 ")
        .replace(
            "10 mm pitch, 2500 lines, one mark a turn",
            "10 mm pitch, 500 lines, one mark",
        )
}
