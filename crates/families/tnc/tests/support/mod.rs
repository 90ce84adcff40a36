//! A control with a simulated machine to test it on.
#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "each test file uses a part of it; a helper that panics fails its test"
)]

pub mod bench;
pub mod knee;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_exchange::{Bit, Exchange, Number};
use bahn_machine::Machine;
use bahn_parameters::own_functions::{Lead, OwnFunction, OwnFunctions};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::ToolShape;
use bahn_plc::{Compilation, MemoryFiles, Options};
use bahn_program::Program;
use bahn_tnc::{Command, Control, Mode, NcFiles, Programs, Remembered, RunState, Setup, Tool};

/// A shelf of programs in memory.
#[derive(Default)]
pub struct Shelf(pub BTreeMap<String, String>);

impl Programs for Shelf {
    fn open(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(self
            .0
            .get(name)
            .map(|text| Arc::new(Program::from_bytes(name, text.clone().into_bytes()))))
    }

    fn open_in_eprom(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.open(&format!("eprom/{name}"), caller)
    }
}

/// Control and machine, and what goes by in the meantime.
#[derive(Clone)]
pub struct Rig {
    pub control: Control,
    pub machine: Machine,
}

/// What a rig is built from.
pub struct Build {
    pub model: ControlModel,
    pub plant: String,
    pub parameters: Vec<String>,
    pub plc: String,
    pub list: Option<String>,
    pub programs: Shelf,
    pub tools: Option<BTreeMap<u32, Tool>>,
    pub remembered: Remembered,
    pub files: NcFiles,
    pub functions: OwnFunctions,
}

/// Machine positions of X, Y and Z, mm.
pub fn machine(rig: &Rig) -> [f64; 3] {
    let axes = rig.control.snapshot().axes;
    ['X', 'Y', 'Z'].map(|letter| axes.iter().find(|axis| axis.letter == letter).unwrap().machine)
}

pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../machines")
        .join(name)
}

fn read(path: PathBuf) -> String {
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

impl Build {
    /// A plant with a PLC program, the reference list and a tool file without tools.
    pub fn new(model: ControlModel, plant: impl Into<String>, plc: impl Into<String>) -> Build {
        Build {
            model,
            plant: plant.into(),
            parameters: Vec::new(),
            plc: plc.into(),
            list: None,
            programs: Shelf::default(),
            tools: Some(BTreeMap::new()),
            remembered: Remembered::default(),
            files: NcFiles::default(),
            functions: OwnFunctions::default(),
        }
    }

    /// The mill of `machines/mill`.
    pub fn mill() -> Build {
        let folder = folder("mill");
        let tool = |length, radius| Tool {
            shape: ToolShape {
                length,
                radius,
                corner_radius: 0.0,
                ..ToolShape::default()
            },
            ..Tool::default()
        };
        let (plant, plc) = (read(folder.join("plant.toml")), read(folder.join("plc/MAIN.PLC")));
        Build {
            list: Some(read(folder.join("parameters.mp"))),
            tools: Some([(1, tool(70.0, 31.5)), (2, tool(95.0, 10.0)), (3, tool(85.0, 5.0))].into()),
            ..Build::new(ControlModel::Tnc415b, plant, plc)
        }
    }

    /// The mill with a swivel head in place of its table: B turns 150 mm above the tool datum.
    pub fn swivelling_mill() -> Build {
        let head = ["410.3=1", "7500=1", "7510=%000100", "7512=150", "7520=%010000"];
        let mill = Build::mill()
            .plant("[axis.C]", "[axis.B]")
            .plant("[axis.C.encoder]", "[axis.B.encoder]")
            .plant("clamps = \"C\"", "clamps = \"B\"");
        head.into_iter().fold(mill, Build::mp)
    }

    /// Another of `machines`, with the tools of the mill.
    pub fn of(name: &str, model: ControlModel) -> Build {
        let folder = folder(name);
        Build {
            model,
            plant: read(folder.join("plant.toml")),
            plc: read(folder.join("plc/MAIN.PLC")),
            list: Some(read(folder.join("parameters.mp"))),
            ..Build::mill()
        }
    }

    /// An M function is synchronised otherwise than the model does, so far ahead in mm.
    pub fn function(mut self, code: u16, synchronisation: &str, distance_mm: Option<f64>) -> Build {
        let lead = Lead {
            distance_mm,
            time_s: None,
        };
        let function = OwnFunction::of(synchronisation, lead);
        let added = function.and_then(|function| self.functions.add(self.model, code, function));
        added.unwrap_or_else(|error| panic!("M{code}: {error}"));
        self
    }

    /// Changes a machine parameter.
    pub fn mp(mut self, assignment: &str) -> Build {
        self.parameters.push(assignment.to_owned());
        self
    }

    /// Puts a program on the shelf, without its first and last block.
    pub fn program(mut self, name: &str, blocks: &str) -> Build {
        let stem = name.trim_end_matches(".H");
        let text = format!("BEGIN PGM {stem} MM\n{blocks}\nEND PGM {stem} MM\n");
        self.programs.0.insert(name.to_owned(), text);
        self
    }

    /// Replaces a text in the description of the machine.
    pub fn plant(mut self, from: &str, to: &str) -> Build {
        assert!(self.plant.contains(from), "the plant has no `{from}`");
        self.plant = self.plant.replace(from, to);
        self
    }

    pub fn setup(self) -> (Setup, Machine) {
        let mut parameters = ParameterList::reference(self.model);
        if let Some(list) = &self.list {
            let errors = parameters.read(list.as_bytes());
            assert!(errors.is_empty(), "{errors:?}");
        }
        for assignment in &self.parameters {
            parameters
                .assign(assignment)
                .unwrap_or_else(|error| panic!("{assignment}: {error}"));
        }
        let files = MemoryFiles::from([("MAIN.PLC", self.plc.as_str())]);
        let compilation = Compilation::compile(&files, "MAIN.PLC", Options::for_model(self.model));
        let plc = compilation
            .program
            .unwrap_or_else(|| panic!("the PLC program has errors: {:?}", compilation.errors));
        let machine = Machine::from_toml(&self.plant).unwrap_or_else(|errors| panic!("{errors:?}"));
        let setup = Setup {
            parameters,
            plc: Arc::new(plc),
            plc_messages: Vec::new(),
            plc_dialogues: Vec::new(),
            tools: self.tools,
            checking: Default::default(),
            inch_feed: None,
            functions: self.functions,
            programs: Arc::new(self.programs),
            files: self.files,
            remembered: self.remembered,
            exchange: Exchange::default(),
        };
        (setup, machine)
    }

    pub fn rig(self) -> Rig {
        let (setup, machine) = self.setup();
        Rig {
            control: Control::new(setup),
            machine,
        }
    }
}

impl Rig {
    /// One contour cycle.
    pub fn cycle(&mut self) {
        self.control.prepare();
        self.control.cycle(&mut self.machine);
    }

    pub fn seconds(&mut self, seconds: f64) {
        let end = self.control.time_us() + (seconds * 1e6) as u64;
        while self.control.time_us() < end {
            self.cycle();
        }
    }

    /// Runs until something is so; panics after a time.
    pub fn until(&mut self, seconds: f64, what: &str, so: impl Fn(&Rig) -> bool) {
        let end = self.control.time_us() + (seconds * 1e6) as u64;
        while !so(self) {
            assert!(
                self.control.time_us() < end,
                "not within {seconds} s: {what}; {:?} {:?}",
                self.messages(),
                self.control.snapshot()
            );
            self.cycle();
        }
    }

    pub fn event(&mut self, text: &str) {
        self.machine
            .apply(text)
            .unwrap_or_else(|error| panic!("{text}: {error}"));
    }

    pub fn command(&mut self, text: &str) {
        let command: Command = text.parse().unwrap();
        assert!(
            self.control.command(command),
            "{text} is refused: {:?}",
            self.messages()
        );
    }

    pub fn start(&mut self) {
        self.event("key NC_START tap");
    }

    /// A marker, input or output as the PLC sees it.
    pub fn bit(&self, name: &str) -> bool {
        let bit: Bit = name.parse().unwrap();
        self.control.exchange().plc().bit(bit)
    }

    /// A byte, word or doubleword as the PLC sees it.
    pub fn number(&self, name: &str) -> i32 {
        let number: Number = name.parse().unwrap();
        self.control.exchange().plc().number(number)
    }

    pub fn messages(&self) -> Vec<String> {
        let shown = self.control.snapshot().messages;
        shown
            .iter()
            .map(|shown| {
                let place = shown.message.place().unwrap_or_default();
                format!("{} {place}", self.control.message_text(&shown.message))
                    .trim()
                    .to_owned()
            })
            .collect()
    }

    /// Actual position from the machine datum.
    pub fn machine_position(&self, letter: char) -> f64 {
        let axes = self.control.snapshot().axes;
        axes.iter().find(|axis| axis.letter == letter).unwrap().machine
    }

    /// The datum of the machine becomes that of the workpiece, for a probe whose end is so far below the spindle, mm.
    pub fn datum_at_machine(&mut self, probe_mm: f64) {
        for (axis, below) in [('X', 0.0), ('Y', 0.0), ('Z', probe_mm)] {
            let at = self.machine_position(axis) - below;
            self.command(&format!("datum {axis} {at}"));
        }
    }

    /// Control voltage, EMERGENCY STOP test, reference run.
    pub fn power_on(&mut self) {
        if self.messages() == ["POWER INTERRUPTED"] {
            self.command("ce");
        }
        self.until(10.0, "the reference run is asked for", |rig| {
            rig.control.snapshot().mode == Mode::Reference
        });
        self.start();
        self.until(120.0, "all marks are passed", |rig| {
            rig.control.snapshot().mode == Mode::Manual
        });
    }

    /// Selects a program and runs it to its end.
    pub fn run(&mut self, name: &str, seconds: f64) {
        self.command("mode full");
        self.command(&format!("select {name}"));
        self.start();
        self.until(1.0, "the run begins", |rig| {
            rig.control.snapshot().run == RunState::Running
        });
        self.until(seconds, "the run ends", |rig| rig.control.snapshot().ended);
    }
}
