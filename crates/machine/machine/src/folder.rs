//! The folder of a machine: which file is what.

use std::collections::BTreeMap;

use bahn_servo::INPUTS;
use bahn_text::Diagnostic;

use crate::equipment::EquipmentFolder;
use crate::reader::{Reader, Section};

/// What `machine.toml` in the folder of a machine says. Paths count from the folder; no file is opened here.
///
/// ```
/// use bahn_machine::MachineFolder;
/// let faults = MachineFolder::from_toml("name = 'mill'\nmodel = 'tnc415b'\nparamters = 'p.mp'").err();
/// let faults: Vec<String> = faults.into_iter().flatten().map(|fault| fault.to_string()).collect();
/// assert!(faults.iter().any(|fault| fault.ends_with("the machine needs parameters")));
/// assert!(faults.iter().any(|fault| fault.starts_with("3:1: unknown key `paramters` here; there are")));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFolder {
    /// Name of the machine for people.
    pub name: String,
    /// Control model, as `tnc415b`.
    pub model: String,
    /// List of machine parameters.
    pub parameters: String,
    /// Main file of the PLC program; linked files lie beside it.
    pub plc: String,
    /// Texts of the PLC messages: line n belongs to marker M2924+n [000:6625-6633].
    pub plc_messages: Option<String>,
    /// Texts of the PLC dialogues.
    pub plc_dialogues: Option<String>,
    /// Assignment of the axis-error compensation (.CMA); its tables NAME.COM lie beside it
    /// [000:3770-3869].
    pub compensation: Option<String>,
    /// Correction tables of code number 105 296, for controls without an assignment [000:3875-3887].
    pub correction_tables: Option<String>,
    /// Description of the simulated machine; none where the plant is another one.
    pub plant: Option<String>,
    /// A solid on the table that the touch probe touches, a mesh (STL) in workpiece coordinates.
    pub solid: Option<String>,
    /// File of the tool table.
    pub tools: Option<String>,
    /// Pocket table: which tool is in which pocket of the magazine.
    pub pockets: Option<String>,
    /// Folder of the part programs, and of the tables that belong to them.
    pub programs: String,
    /// Files that the memory of the control holds, instead of as many as the control model has room for; 0 is any number.
    pub files_max: Option<usize>,
    /// The pallet file (.P) with M status, in the folder of the part programs [000:15332-15334].
    pub pallets: Option<String>,
    /// The datum table (.D) with M status until module 9090 selects another one, in the same folder.
    pub datum_table: Option<String>,
    /// Folder of what survives power-off.
    pub state: String,
    /// Workpiece datum in machine coordinates, mm or degrees, as long as the state holds no other.
    pub datum: Vec<(char, f64)>,
    /// What an operator does who stands by while programs run.
    pub operator: OperatorKeys,
    /// The program that runs when nobody names another one, with more than one channel.
    pub program: Option<String>,
    /// The channels beside the first one, which all the above is about.
    pub channels: Vec<ChannelFolder>,
    /// The axes that go from one channel to another while programs run.
    pub hand_overs: Vec<HandOverFolder>,
    /// The M functions that are synchronised otherwise than the control model does.
    pub functions: Vec<FunctionFolder>,
    /// Boards, options and software of the control.
    pub equipment: EquipmentFolder,
    /// How it is wired as positioning module of another control; none where it is no module.
    pub module: Option<ModuleFolder>,
}

/// How a positioning module is wired to the control that it belongs to: `[module]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModuleFolder {
    /// The input of that control's PLC that is 1 while the module has control voltage.
    pub voltage: Option<usize>,
    /// How long the control of one machine may be not ready until the EMERGENCY STOP chain of the other one opens, ms.
    pub ready_delay_ms: u32,
}

/// A channel beside the first one: `[[channel]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelFolder {
    /// List of machine parameters.
    pub parameters: String,
    /// The number on the machine of each of its axes, in the order of the indices of its list.
    pub axes: Vec<u8>,
    /// Output 1 and encoder input X1 of its list are those with this number on the machine.
    pub connectors: u8,
    /// Folder of its part programs.
    pub programs: Option<String>,
    /// The program that runs when nobody names another one.
    pub program: Option<String>,
    /// Where its markers and words stand in the memory of the PLC, `M2448-M2511 = M300`, with their lines.
    pub window: Vec<(usize, String)>,
    /// Workpiece datum in machine coordinates, mm or degrees, as long as the state holds no other.
    pub datum: Vec<(char, f64)>,
    /// What an operator does who stands by.
    pub operator: OperatorKeys,
    /// Its line in the file, from 1, and those of its keys.
    pub lines: (usize, BTreeMap<String, usize>),
}

/// An axis that goes to another channel when the PLC orders it: `[[hand_over]]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HandOverFolder {
    /// The number of the axis on the machine.
    pub axis: u8,
    /// The channel that gets it, from 1.
    pub to: u8,
    /// The letter of the axis in that channel.
    pub letter: String,
    /// Its index of markers there.
    pub index: u8,
    /// The marker by which the PLC orders it.
    pub order: String,
    /// The marker by which the control says that it is done, while the order stands.
    pub done: String,
    /// Its line in the file, from 1, and those of its keys.
    pub lines: (usize, BTreeMap<String, usize>),
}

/// M functions that are synchronised otherwise than the control model does: `[[function]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionFolder {
    /// The codes of these M functions.
    pub m: Vec<u8>,
    /// The type of their synchronisation, as `MVS_SNS`.
    pub synchronisation: String,
    /// How far ahead they go out, mm.
    pub lead_mm: Option<f64>,
    /// How far ahead they go out, ms.
    pub lead_ms: Option<f64>,
    /// Its line in the file, from 1, and those of its keys.
    pub lines: (usize, BTreeMap<String, usize>),
}

/// The keys of the panel that an operator presses who stands by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OperatorKeys {
    /// Key of the operating panel for NC start.
    pub start: String,
    /// The control voltage, where it waits for a key.
    pub control_voltage: Option<String>,
    /// One after the other, when a tool change waits for the operator.
    pub tool_change: Vec<String>,
}

impl Default for OperatorKeys {
    fn default() -> OperatorKeys {
        OperatorKeys {
            start: "NC_START".to_owned(),
            control_voltage: None,
            tool_change: vec!["CONFIRM".to_owned()],
        }
    }
}

impl MachineFolder {
    /// What `plc` says for the program that the control is delivered with.
    pub const STANDARD_PLC: &str = "standard";

    /// The main file of the PLC program; `None` for the standard program of the control.
    pub fn plc_file(&self) -> Option<&str> {
        Some(self.plc.as_str()).filter(|name| *name != MachineFolder::STANDARD_PLC)
    }

    /// The name of the file in the folder.
    pub const FILE: &str = "machine.toml";

    /// Reads the text of `machine.toml`.
    ///
    /// # Errors
    /// All faults of the text, in its order.
    pub fn from_toml(text: &str) -> Result<MachineFolder, Vec<Diagnostic>> {
        let (folder, faults) = MachineFolder::read(text);
        if faults.is_empty() {
            Ok(folder)
        } else {
            Err(faults)
        }
    }

    /// Reads the text of `machine.toml` as far as it can be understood, with all faults in its order. What
    /// is missing is empty.
    pub fn read(text: &str) -> (MachineFolder, Vec<Diagnostic>) {
        let reader = Reader::new(text);
        let table = reader.parse();
        let root = Section::root(&reader, &table);
        let optional = |key| root.text(key).map(str::to_owned);
        let needed = |key| {
            optional(key).unwrap_or_else(|| {
                if !root.has(key) {
                    root.fault(format!("the machine needs {key}"));
                }
                String::new()
            })
        };
        let folder = MachineFolder {
            name: needed("name"),
            model: needed("model"),
            parameters: needed("parameters"),
            plc: needed("plc"),
            plc_messages: optional("plc_messages"),
            plc_dialogues: optional("plc_dialogues"),
            compensation: optional("compensation"),
            correction_tables: optional("correction_tables"),
            plant: optional("plant"),
            solid: optional("solid"),
            tools: optional("tools"),
            pockets: optional("pockets"),
            programs: optional("programs").unwrap_or_else(|| "programs".to_owned()),
            files_max: root
                .number("files_max", 0.0..=100_000.0)
                .map(|number| number as usize),
            pallets: optional("pallets"),
            datum_table: optional("datum_table"),
            state: optional("state").unwrap_or_else(|| "state".to_owned()),
            datum: root.section("datum").map(read_datum).unwrap_or_default(),
            operator: root.section("operator").map(read_operator).unwrap_or_default(),
            program: optional("program"),
            channels: root.list("channel").into_iter().map(read_channel).collect(),
            hand_overs: root.list("hand_over").into_iter().map(read_hand_over).collect(),
            functions: root.list("function").into_iter().map(read_function).collect(),
            equipment: EquipmentFolder::read(&root),
            module: root.section("module").map(read_module),
        };
        root.finish();
        (folder, reader.faults())
    }
}

/// A text that must be there.
fn needed_text(section: &Section, key: &'static str) -> String {
    if !section.has(key) {
        section.fault(format!("[[{}]] needs {key}", section.name));
    }
    section.text(key).unwrap_or_default().to_owned()
}

/// Longer than "control is ready" is off in a test of the EMERGENCY STOP circuit: a relay with 114 ms and 18 ms.
const READY_DELAY_MS: u32 = 250;

fn read_module(section: Section) -> ModuleFolder {
    let voltage = section.text("voltage").and_then(|text| {
        let number = text.strip_prefix('I').and_then(|number| number.parse().ok());
        let input = number.filter(|input: &usize| *input < INPUTS);
        if input.is_none() {
            section.fault_at("voltage", format!("`{text}` is no input of a PLC, as \"I26\""));
        }
        input
    });
    let delay = section.number("ready_delay_ms", 0.0..=10_000.0);
    let module = ModuleFolder {
        voltage,
        ready_delay_ms: delay.map_or(READY_DELAY_MS, |delay| delay as u32),
    };
    section.finish();
    module
}

fn read_channel(section: Section) -> ChannelFolder {
    let window = section.texts("window").into_iter();
    let window = window.map(|(at, text)| (section.reader.place(at).line as usize, text.to_owned()));
    if !section.has("operator") {
        section.fault("[[channel]] needs operator, with its start".to_owned());
    }
    let channel = ChannelFolder {
        parameters: needed_text(&section, "parameters"),
        axes: section.whole_numbers("axes", 0..=u8::MAX),
        connectors: section.number("connectors", 1.0..=35.0).unwrap_or(1.0) as u8,
        programs: section.text("programs").map(str::to_owned),
        program: section.text("program").map(str::to_owned),
        window: window.collect(),
        datum: section.section("datum").map(read_datum).unwrap_or_default(),
        operator: section.section("operator").map(read_station).unwrap_or_default(),
        lines: section.lines(),
    };
    if !section.has("axes") {
        section.fault("[[channel]] needs axes".to_owned());
    }
    section.finish();
    channel
}

/// The keys of a channel beside the first one: the control voltage is not among them.
fn read_station(section: Section) -> OperatorKeys {
    let keys = OperatorKeys {
        start: needed_text(&section, "start"),
        control_voltage: None,
        tool_change: section
            .texts("tool_change")
            .into_iter()
            .map(|(_, key)| key.to_owned())
            .collect(),
    };
    section.finish();
    keys
}

fn read_hand_over(section: Section) -> HandOverFolder {
    let hand_over = HandOverFolder {
        axis: section.needed_number("axis", 0.0..=255.0) as u8,
        to: section.needed_number("to", 1.0..=255.0) as u8,
        letter: needed_text(&section, "letter"),
        index: section.needed_number("index", 0.0..=4.0) as u8,
        order: needed_text(&section, "order"),
        done: needed_text(&section, "done"),
        lines: section.lines(),
    };
    section.finish();
    hand_over
}

fn read_function(section: Section) -> FunctionFolder {
    if !section.has("m") {
        section.fault("[[function]] needs m, a list of codes".to_owned());
    }
    let function = FunctionFolder {
        m: section.whole_numbers("m", 0..=99),
        synchronisation: needed_text(&section, "synchronisation"),
        lead_mm: section.number("lead", 0.0..=100_000.0),
        lead_ms: section.number("lead_ms", 0.0..=100_000.0),
        lines: section.lines(),
    };
    section.finish();
    function
}

fn read_datum(section: Section) -> Vec<(char, f64)> {
    let axes = ["X", "Y", "Z", "A", "B", "C", "U", "V", "W"];
    let datum = axes
        .into_iter()
        .filter_map(|axis| {
            Some((
                axis.chars().next()?,
                section.number(axis, -100_000.0..=100_000.0)?,
            ))
        })
        .collect();
    section.finish();
    datum
}

fn read_operator(section: Section) -> OperatorKeys {
    let usual = OperatorKeys::default();
    let tool_change = section.texts("tool_change");
    let keys = OperatorKeys {
        start: section.text("start").map_or(usual.start, str::to_owned),
        control_voltage: section.text("control_voltage").map(str::to_owned),
        tool_change: if section.has("tool_change") {
            tool_change.into_iter().map(|(_, key)| key.to_owned()).collect()
        } else {
            usual.tool_change
        },
    };
    section.finish();
    keys
}
