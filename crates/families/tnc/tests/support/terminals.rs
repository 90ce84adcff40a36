//! A TNC 155 with its standard PLC program on a bench: what hangs at the terminals of the interface is moved by hand.

#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test file uses a part of it; a helper that panics fails its test"
)]

use std::collections::BTreeMap;

use bahn_parameters::ControlModel;
use bahn_tnc::Tool;

use crate::support::{Build, Rig};

/// Drives of 10 m/min, scales with distance-coded marks; a spindle of 6000 rpm without gears of its own.
const PLANT: &str = r#"
name = "terminals"
seed = 155
step_us = 200

[emergency_stop]
acknowledgement = "I8"
pull_in_ms = 10
drop_out_ms = 50

[axis.X]
output = "1"
speed = 10000
volts = 9
time_constant_ms = 2
travel = [0, 400]
start = 100
enable = "O0"
encoder = { input = "X1", period_um = 20, marks_coded = 20 }

[axis.Y]
output = "2"
speed = 10000
volts = 9
time_constant_ms = 2
travel = [0, 400]
start = 100
enable = "O1"
encoder = { input = "X2", period_um = 20, marks_coded = 20 }

[axis.Z]
output = "3"
speed = 8000
volts = 9
time_constant_ms = 2
travel = [0, 400]
start = 100
enable = "O2"
encoder = { input = "X3", period_um = 20, marks_coded = 20 }

[spindle]
output = "S"
rpm = 6000
volts = 9
encoder = { input = "X5", lines = 1024, mark_deg = 90 }

[device.completed]
start = "on"
input_second = "I17"
[device.release]
start = "on"
input_second = "I18"
[device.manual]
input_second = "I19"

[keys]
"X+" = "I9"
"X-" = "I10"
"Y+" = "I11"
"Y-" = "I12"
"Z+" = "I13"
"Z-" = "I14"
RAPID = "I21"
NC_START = "I22"
NC_STOP = "not I23"
"#;

/// Three axes in lag operation, wide windows, a spindle of two gears whose speed goes out as voltage.
const CHANGES: [&str; 9] = [
    "72=8", "60=1", "58=0.05", "192=0.05", "252=0", "62=3", "120=2", "121=7", "122=9",
];

/// The bench with the standard PLC program.
pub fn terminals() -> Build {
    let plc = bahn_plc::standard_program(ControlModel::Tnc155).unwrap();
    Build {
        parameters: CHANGES.map(str::to_owned).to_vec(),
        ..Build::new(ControlModel::Tnc155, PLANT, plc)
    }
}

impl Build {
    /// Tools of the central tool file.
    pub fn tools<const N: usize>(mut self, numbers: [u32; N]) -> Build {
        let tool = |number| (number, Tool::default());
        self.tools = Some(numbers.map(tool).into_iter().collect::<BTreeMap<_, _>>());
        self
    }
}

impl Rig {
    /// Closes or opens the contact of a thing that is moved by hand.
    pub fn contact(&mut self, name: &str, closed: bool) {
        let state = if closed { "on" } else { "off" };
        self.event(&format!("switch {name} {state}"));
    }

    /// The outputs from a first one on, `1` for a closed contact.
    pub fn contacts(&self, first: u16, count: u16) -> String {
        let contact = |number| match self.bit(&format!("A{number}")) {
            true => '1',
            false => '0',
        };
        (first..first + count).map(contact).collect()
    }
}
