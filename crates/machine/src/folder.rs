//! The folder of a machine: which file is what.

use crate::reader::{PlantError, Reader, Section};

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
    /// Name for people.
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
    /// Description of the simulated machine.
    pub plant: String,
    /// Tool table.
    pub tools: Option<String>,
    /// Folder of the part programs, and of the tables that belong to them.
    pub programs: String,
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
}

/// The keys of the panel that an operator presses who stands by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OperatorKeys {
    /// NC start.
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
    /// The name of the file in the folder.
    pub const FILE: &str = "machine.toml";

    /// Reads the text of `machine.toml`.
    ///
    /// # Errors
    /// All faults of the text, in its order.
    pub fn from_toml(text: &str) -> Result<MachineFolder, Vec<PlantError>> {
        let (folder, faults) = MachineFolder::read(text);
        if faults.is_empty() {
            Ok(folder)
        } else {
            Err(faults)
        }
    }

    /// Reads the text of `machine.toml` as far as it can be understood, with all faults in its order. What
    /// is missing is empty.
    pub fn read(text: &str) -> (MachineFolder, Vec<PlantError>) {
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
            plant: needed("plant"),
            tools: optional("tools"),
            programs: optional("programs").unwrap_or_else(|| "programs".to_owned()),
            pallets: optional("pallets"),
            datum_table: optional("datum_table"),
            state: optional("state").unwrap_or_else(|| "state".to_owned()),
            datum: root.section("datum").map(read_datum).unwrap_or_default(),
            operator: root.section("operator").map(read_operator).unwrap_or_default(),
        };
        root.finish();
        (folder, reader.faults())
    }
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
