//! From options to the settings of the other rooms.
//!
//! Decision: In `bahn test --machine` the workpiece lies at the datum of machine.toml; who is compared by `--against`
//! lies where this run lies
//!
//! Decision: A list with MP10 or MP410 (TNC 151/155: MP72, MP90) means its axes and no others in a test run, too;
//! without a machine and such a list there are all

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use bahn_host::{Machine900, tool_table};
use bahn_interpreter::{AbsentAxes, MachineTexts, Q_VALUE_MAX, Rules};
use bahn_motion::AuxiliaryTimes;
use bahn_parameters::own_functions::OwnFunctions;
use bahn_parameters::{ControlModel, ListText, ParameterId, ParameterList, conformance};
use bahn_path::{Axis, PerAxis, Position};
use bahn_plc::MemoryTable;
use bahn_tnc::{Tool, datum_shifts};

use crate::UsageError;
use crate::options::{MachineOptions, RunOptions};
use crate::{diagnostics, files, machine_folder};

/// What programs run on without a machine: its parameters, its tools, its texts.
pub(crate) struct Equipment {
    pub list: ParameterList,
    /// `None` when tools are those that the program defines.
    pub tools: Option<BTreeMap<u32, Tool>>,
    pub texts: MachineTexts,
    /// The M functions that are synchronised otherwise than the control model does.
    pub functions: OwnFunctions,
    /// The datum table of the machine with M status.
    pub datum_table: Result<MemoryTable, String>,
    /// The other channels of the machine, whose axes a program may get; `None` where nobody says which axes there are,
    /// neither a machine nor a list with MP10 or MP410.
    pub others: Option<Vec<ParameterList>>,
    /// Where the workpiece lies unless the options say it.
    pub datum: Position,
    /// The machine has a System 900: of all the others nothing counts.
    pub system900: Option<Machine900>,
}

impl Equipment {
    /// The machine's or the reference list of the model, then the list, then single parameters; the tool table.
    pub fn of(model: ControlModel, options: &MachineOptions) -> Result<Equipment, UsageError> {
        let mut equipment = match &options.folder {
            Some(folder) => Equipment::of_folder("--machine", folder)?,
            None => Equipment {
                list: ParameterList::reference(model),
                tools: None,
                texts: MachineTexts::default(),
                functions: OwnFunctions::default(),
                datum_table: Err(bahn_interpreter::NO_DATUM_TABLE.to_owned()),
                others: None,
                datum: Position::UNKNOWN,
                system900: None,
            },
        };
        let mut named = Vec::new();
        if let Some(path) = &options.parameters {
            let bytes = files::read_table(path)?;
            read_lines(&mut equipment.list, path, &bytes)?;
            let text = ListText::from_bytes(model, &bytes);
            named.extend(text.entries().iter().map(|entry| entry.id));
        }
        named.extend(assign(&mut equipment.list, &options.mp)?);
        // Who says which axes there are means these and no others.
        if named.iter().any(|id| id.says_axes(model)) {
            equipment.others.get_or_insert_default();
        }
        if let Some(path) = &options.tools {
            equipment.tools = Some(tool_table::load(path, model)?);
        }
        Ok(equipment)
    }

    /// The same, or the machine with a System 900 that a folder describes, of which the options of a TNC are refused.
    pub fn of_any_family(
        model: ControlModel,
        options: &MachineOptions,
        run: &RunOptions,
    ) -> Result<Equipment, UsageError> {
        let folder = options
            .folder
            .as_ref()
            .filter(|folder| Machine900::is_meant(folder));
        let Some(folder) = folder else {
            return Equipment::of(model, options);
        };
        if let Some(option) = of_a_tnc(options, run) {
            return Err(UsageError::new(format!(
                "{option} is for a TNC, and {} has a System 900",
                folder.display()
            )));
        }
        let loaded = Machine900::load(folder)?.map_err(|faults| {
            let first = faults.first().map(|fault| fault.message.clone());
            UsageError::new(format!(
                "--machine {}: {}; `bahn machine check` shows all",
                folder.display(),
                first.unwrap_or_default()
            ))
        })?;
        let none = MachineOptions {
            folder: None,
            ..options.clone()
        };
        Ok(Equipment {
            system900: Some(loaded),
            ..Equipment::of(model, &none)?
        })
    }

    /// That of a machine.
    pub fn of_folder(option: &str, folder: &Path) -> Result<Equipment, UsageError> {
        let machine = machine_folder::load(folder)?.map_err(|faults| {
            let first = faults.first().map(|fault| fault.message.clone());
            UsageError::new(format!(
                "{option} {}: {}; `bahn machine check` shows all",
                folder.display(),
                first.unwrap_or_default()
            ))
        })?;
        Ok(Equipment {
            texts: MachineTexts {
                messages: machine.plc_messages.as_slice().into(),
                dialogues: machine.plc_dialogues.as_slice().into(),
            },
            datum: machine.datum(),
            functions: machine.functions.clone(),
            datum_table: machine.datum_table().cloned(),
            others: Some(
                machine
                    .channels
                    .iter()
                    .map(|channel| channel.parameters.clone())
                    .collect(),
            ),
            list: machine.parameters,
            tools: machine.tools,
            system900: None,
        })
    }
}

/// An option that is given and means something to a TNC alone.
fn of_a_tnc(options: &MachineOptions, run: &RunOptions) -> Option<&'static str> {
    let all = [
        ("--parameters", options.parameters.is_some()),
        ("--mp", !options.mp.is_empty()),
        ("--tools", options.tools.is_some()),
        ("--point-angle", !options.point_angle.is_empty()),
        ("--block-time", options.block_time),
        ("--set", !run.set.is_empty()),
        ("--start", !run.start.is_empty()),
        ("--tool-change", !run.tool_change.is_empty()),
        ("--datum", !run.datum.is_empty()),
        ("--skip-blocks", run.skip_blocks),
        ("--inch-feed", run.inch_feed.is_some()),
        ("--strict", run.strict),
        ("--skip-unknown", run.skip_unknown),
    ];
    all.into_iter()
        .find(|(_, given)| *given)
        .map(|(option, _)| option)
}

/// Sets the single parameters of the command line; which ones.
pub(crate) fn assign(
    list: &mut ParameterList,
    assignments: &[String],
) -> Result<Vec<ParameterId>, UsageError> {
    let model = list.model();
    let assigned = assignments.iter().map(|assignment| {
        list.assign(assignment)
            .map_err(|error| UsageError::new(format!("--mp {assignment}: {error} ({model})")))
    });
    assigned.collect()
}

/// Says which of the single parameters do nothing here, or only part of what they say.
pub(crate) fn say_without_effect(list: &ParameterList, assignments: &[String]) {
    let mut list = list.clone();
    for assignment in assignments {
        let Ok(id) = list.assign(assignment) else { continue };
        let row = conformance::find(list.model(), conformance::Kind::MachineParameter, &id.to_string());
        if let Some(remark) = row.and_then(conformance::Entry::remark) {
            diagnostics::print_text(&format!("warning: --mp {assignment}: {id} {remark}"));
        }
    }
}

/// The reference list of the model, with values of a list file in place of its own.
pub(crate) fn parameter_list(model: ControlModel, path: Option<&Path>) -> Result<ParameterList, UsageError> {
    let mut list = ParameterList::reference(model);
    if let Some(path) = path {
        read_list(&mut list, path)?;
    }
    Ok(list)
}

fn read_list(list: &mut ParameterList, path: &Path) -> Result<(), UsageError> {
    read_lines(list, path, &files::read_table(path)?)
}

/// Puts the lines of a list over the values of another.
pub(crate) fn read_lines(list: &mut ParameterList, path: &Path, bytes: &[u8]) -> Result<(), UsageError> {
    let errors = list.read(bytes);
    if !errors.is_empty() {
        return Err(UsageError::new(list_errors(path, &errors)));
    }
    let lacking = ListText::from_bytes(list.model(), bytes).lacking(list, path);
    let lacking: Vec<String> = lacking
        .iter()
        .map(|fault| format!("line {}: {}", fault.span.line, fault.message))
        .collect();
    match lacking.is_empty() {
        true => Ok(()),
        false => Err(UsageError::new(list_errors(path, &lacking))),
    }
}

fn list_errors(path: &Path, errors: &[impl std::fmt::Display]) -> String {
    const SHOWN: usize = 20;
    let mut lines: Vec<String> = errors
        .iter()
        .take(SHOWN)
        .map(|error| format!("{}: {error}", path.display()))
        .collect();
    if errors.len() > SHOWN {
        lines.push(format!("and {} more", errors.len() - SHOWN));
    }
    lines.join("\n")
}

/// The tools that cut with M4.
pub(crate) fn left_hand(tools: Option<&BTreeMap<u32, Tool>>) -> BTreeSet<u32> {
    let tools = tools.into_iter().flatten();
    tools
        .filter(|(_, tool)| tool.left_hand)
        .map(|(number, _)| *number)
        .collect()
}

/// The settings of the interpreter.
pub(crate) fn interpreter(
    equipment: &Equipment,
    run: &RunOptions,
) -> Result<bahn_interpreter::Settings, UsageError> {
    let (list, tools) = (&equipment.list, equipment.tools.as_ref());
    let model = list.model();
    let mut rules = Rules::of(list);
    let datum = match run.datum.is_empty() {
        true => equipment.datum,
        false => position("--datum", &run.datum, model)?,
    };
    rules.machine_zero = machine_zero(list, &datum);
    Ok(bahn_interpreter::Settings {
        basic_rotation: Default::default(),
        model,
        rules,
        functions: equipment.functions.clone(),
        datum_table: equipment
            .datum_table
            .as_ref()
            .map(|table| datum_shifts(table, list).into())
            .map_err(String::clone),
        texts: equipment.texts.clone(),
        barred_tools: tool_table::barred(tools.into_iter().flatten()),
        tools: tools.map(|tools| tools.iter().map(|(number, tool)| (*number, tool.shape)).collect()),
        q_values: q_values(&run.set, model)?,
        start: position("--start", &run.start, model)?,
        tool_length_mm: None,
        inhibited_oem_cycles: 0,
        point_angles_deg: BTreeMap::new(),
        status: bahn_interpreter::Status::default(),
        tool_change: position("--tool-change", &run.tool_change, model)?,
        absent: equipment
            .others
            .as_ref()
            .map_or_else(AbsentAxes::default, |others| {
                AbsentAxes::of(std::iter::once(list).chain(others))
            }),
        machine: false,
        transferred: false,
        skip_blocks: run.skip_blocks,
        inch_feed: run.inch_feed.map(Into::into),
        strict: run.strict,
        skip_unknown: run.skip_unknown,
        as_programmed: false,
        max_blocks_without_motion: run.max_blocks,
    })
}

/// Machine zero from the workpiece datum. Without `--datum` the workpiece datum is that of the scales, and
/// MP960 says where machine zero lies; where both are silent nobody knows it (inferred) [000:6244].
fn machine_zero(list: &ParameterList, datum: &Position) -> Position {
    let zero = |axis: Axis| match (datum.get(axis), list.machine_datum(axis)) {
        (Some(datum), _) => -datum,
        (None, 0.0) => f64::NAN,
        (None, machine_datum) => machine_datum,
    };
    PerAxis::from_fn(zero).into()
}

/// Times of what is no movement.
pub(crate) fn times(machine: &MachineOptions) -> AuxiliaryTimes {
    AuxiliaryTimes {
        tool_change_s: machine.tool_change_time,
        spindle_start_s: machine.spindle_time,
        spindle_stop_s: machine.spindle_time,
        spindle_speed_change_s: 0.5 * machine.spindle_time,
        spindle_orientation_s: machine.spindle_time,
        m_function_s: machine.m_time,
    }
}

/// Reads `X10`, `Y-3.5`: axes with their positions, mm or degrees.
pub(crate) fn position(option: &str, words: &[String], model: ControlModel) -> Result<Position, UsageError> {
    let mut position = Position::UNKNOWN;
    for word in words {
        let wrong = |what: String| UsageError::new(format!("{option} {word}: {what}"));
        let mut characters = word.trim().chars();
        let axis = characters
            .next()
            .filter(char::is_ascii)
            .and_then(|letter| Axis::from_letter(letter as u8));
        let Some(axis) = axis else {
            return Err(wrong("it takes axes with positions, as X10,Y-5.5".into()));
        };
        let text = characters.as_str().trim().trim_start_matches('=');
        let value = text
            .parse::<f64>()
            .map_err(|_| wrong(format!("`{text}` is no number")))?;
        let max = model.limits().coordinate_max;
        if !(-max..=max).contains(&value) {
            return Err(wrong(format!(
                "positions reach from -{max} to {max} on this control"
            )));
        }
        if position.get(axis).is_some() {
            return Err(wrong(format!("{axis} is given twice")));
        }
        position[axis] = value;
    }
    Ok(position)
}

/// Values of Q parameters as options give them: `Q1=5`.
fn q_values(assignments: &[String], model: ControlModel) -> Result<Vec<(u16, f64)>, UsageError> {
    assignments.iter().map(|text| q_value(text, model)).collect()
}

fn q_value(text: &str, model: ControlModel) -> Result<(u16, f64), UsageError> {
    let wrong = |what: String| UsageError::new(format!("--set {text}: {what}"));
    let parts = text
        .trim()
        .strip_prefix(['Q', 'q'])
        .and_then(|rest| rest.split_once('='));
    let Some((number, value)) = parts else {
        return Err(wrong(
            "it takes assignments with a decimal point, as Q1=5.5".into(),
        ));
    };
    let max = model.limits().q_max;
    let number = number.trim().parse::<u16>().ok().filter(|number| *number <= max);
    let Some(number) = number else {
        return Err(wrong(format!("Q parameters are Q0 to Q{max} on this control")));
    };
    let value = value.trim();
    match value.parse::<f64>() {
        Ok(value) if value.abs() <= Q_VALUE_MAX => Ok((number, value)),
        _ => Err(wrong(format!("`{value}` is no number"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: ControlModel = ControlModel::Tnc360;

    #[test]
    fn q_parameters_are_assigned() {
        assert_eq!(q_value("Q1=-5.25", MODEL), Ok((1, -5.25)));
        assert_eq!(q_value(" q99 = +3", MODEL), Ok((99, 3.0)));
        for wrong in [
            "1=5", "Q1", "Q1=", "Q1=x", "Q1=inf", "Q1=1e308", "Q-1=5", "Q99999=1", "Q124=1",
        ] {
            assert!(q_value(wrong, MODEL).is_err(), "{wrong}");
        }
    }

    #[test]
    fn positions_are_read() {
        let read = |words: &[&str]| {
            position(
                "--start",
                &words.iter().map(|w| w.to_string()).collect::<Vec<_>>(),
                MODEL,
            )
        };
        let p = read(&["X10", "y-2.5", " Z +50"]).unwrap();
        assert_eq!(
            (p.get(Axis::X), p.get(Axis::Y), p.get(Axis::Z)),
            (Some(10.0), Some(-2.5), Some(50.0))
        );
        assert_eq!(p.get(Axis::C), None);
        for wrong in [
            &["Q1"][..],
            &["X"],
            &["X1", "X2"],
            &["X1e9"],
            &["Xnan"],
            &[""],
            &["é1"],
        ] {
            assert!(read(wrong).is_err(), "{wrong:?}");
        }
    }
}
