//! A bench: ideal drives X, Y, Z of 6 m/min, a panel, and a PLC program that only hands keys on and
//! acknowledges everything. Each test adds the plant, the parameters and the instructions it is about.
//!
//! X, Y and Z travel 0 to 200 mm with one reference mark at 100 mm; each cam is closed from 180 mm on (I0,
//! I1, I2) and the axis stands at 50 mm. Free inputs are forced with `fault input I30 1`.

use bahn_parameters::ControlModel;
use bahn_tnc::Mode;

use super::{Build, Rig};

const PLANT: &str = r#"
name = "bench"
seed = 1
step_us = 200

[emergency_stop]
acknowledgement = "I3"
pull_in_ms = 10
drop_out_ms = 50

[keys]
"X-" = "I128"
"Y-" = "I129"
"Z-" = "I130"
"IV-" = "I131"
"V-" = "I132"
"X+" = "I133"
"Y+" = "I134"
"Z+" = "I135"
"IV+" = "I136"
"V+" = "I137"
NC_START = "I146"
NC_STOP = "not I147"
RAPID = "I148"
LATCH = "I150"
NO_FEED = "I151"
"#;

/// The axes X, Y and Z, whose cams are closed from a place to the end of the travel, and whose marks lie at a place, mm.
pub fn three_axes(cam: u32, mark: u32) -> String {
    let axis = |(number, letter)| {
        format!(
            r#"
[axis.{letter}]
output = "{}"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = {{ range = [{cam}, 200], input = "I{number}" }}
[axis.{letter}.encoder]
input = "X{}"
period_um = 20
mark = {mark}
"#,
            number + 1,
            number + 1
        )
    };
    (0..).zip("XYZ".chars()).map(axis).collect()
}

/// A fourth axis like the others: letter, output and encoder input X4.
pub fn fourth(letter: char, more: &str) -> String {
    format!(
        r#"
[axis.{letter}]
output = "4"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = {{ range = [180, 200], input = "I4" }}
{more}
[axis.{letter}.encoder]
input = "X4"
period_um = 20
mark = 100
"#
    )
}

/// A rotary table: 4th axis C on output 4 and encoder X4, its mark at 90 degrees each turn.
pub const TABLE: &str = r#"
[axis.C]
output = "4"
speed = 3600
volts = 9
time_constant_ms = 2
start = 10
[axis.C.encoder]
input = "X4"
period_um = 20
marks_every = 360
marks_from = 90
"#;

const PARAMETERS: &str = "
MP10     : %00111
MP30     : %00000
MP50     : %00111
MP960.0  : -100
MP960.1  : -100
MP960.2  : -100
MP910.0  : 170
MP910.1  : 170
MP910.2  : 170
MP920.0  : 10
MP920.1  : 10
MP920.2  : 10
MP1010.0 : 6000
MP1010.1 : 6000
MP1010.2 : 6000
MP1010.3 : 6000
MP1010.4 : 6000
MP1020.0 : 1200
MP1020.1 : 1200
MP1020.2 : 1200
MP1020.3 : 1200
MP1220   : 0
MP1330.0 : 3000
MP1330.1 : 3000
MP1330.2 : 3000
MP1330.3 : 3000
MP1350.0 : 1
MP1350.1 : 1
MP1350.2 : 1
MP1350.3 : 1
MP1510.0 : 2
MP1510.1 : 2
MP1510.2 : 2
MP1710.0 : 4
MP1710.1 : 4
MP1710.2 : 4
MP1710.3 : 4
MP1720.0 : 6
MP1720.1 : 6
MP1720.2 : 6
MP1720.3 : 6
MP1810.0 : 2
MP1810.1 : 2
MP1810.2 : 2
MP1810.3 : 2
MP7212   : 1
MP7620   : %0000
";

/// The PLC program: keys to markers, cams, acknowledgements.
const PLC: &str = "
       L     M2719
       SN    M2719
       L     I146
       = M2448
       =N M2464
       L     I147
       = M2488
       L     I148
       = M2449
       =N M2465
       L     I150
       = M2450
       =N M2466
       LN    I151
       = M2451
       =N M2467
";

/// Keys of the fifth axis, cams.
const FIFTH_AND_CAMS: &str = "
       L     I137
       = M2524
       =N M2540
       L     I132
       = M2525
       =N M2541
       L     I0
       = M2556
       L     I1
       = M2557
       L     I2
       = M2558
       L     I4
       = M2559
";

/// Everything is acknowledged; no spindle after an EMERGENCY STOP.
pub const ACKNOWLEDGE: &str = "
       L     M2045
       = M2482
       L     M2043
       = M2480
       L     M2044
       = M2481
       L     M2046
       = M2483
       L     M2047
       = M2484
       L     M2180
       S     M2487
";

/// A bench whose PLC program goes on with these instructions.
pub fn bench(instructions: &str) -> Build {
    let plant = format!("{PLANT}{}", three_axes(180, 100));
    let keys = axis_keys([133, 128, 134, 129, 135, 130, 136, 131]);
    let plc = format!(
        "{PLC}{keys}{FIFTH_AND_CAMS}{ACKNOWLEDGE}{}",
        after_panel(instructions)
    );
    Build {
        list: Some(PARAMETERS.to_owned()),
        ..Build::new(ControlModel::Tnc415b, plant, plc)
    }
}

/// Inputs to the markers of the axis keys X+ X- Y+ Y- Z+ Z- IV+ IV-, M2456 ff., with their complements.
pub fn axis_keys(inputs: [u16; 8]) -> String {
    let key = |(marker, input)| {
        format!(
            "       L     I{input}\n       = M{marker}\n       =N M{}\n",
            marker + 16
        )
    };
    (2456..).zip(inputs).map(key).collect()
}

/// Instructions of a test; what follows its first label stands after the end of the main program.
fn after_panel(instructions: &str) -> String {
    match instructions.find("LBL") {
        Some(at) => {
            let (main, modules) = instructions.split_at(at);
            format!("{main}\n       EM\n{modules}\n")
        }
        None => format!("{instructions}\n       EM\n"),
    }
}

impl Build {
    /// Adds to the description of the machine.
    pub fn with(mut self, plant: &str) -> Build {
        // Tables of a TOML file may come in any order.
        self.plant.push_str(plant);
        self
    }

    /// Changes several machine parameters, separated by blanks: `10=7 50=7`.
    pub fn mps(mut self, assignments: &str) -> Build {
        self.parameters
            .extend(assignments.split_whitespace().map(str::to_owned));
        self
    }

    /// The rig after power-on and reference run.
    pub fn ready(self) -> Rig {
        let mut rig = self.rig();
        rig.power_on();
        rig
    }
}

impl Rig {
    /// NC start of the reference run: least and greatest place of the table of X until it ends, mm.
    pub fn way_to_mark(&mut self) -> [f64; 2] {
        self.start();
        let mut way = [f64::INFINITY, f64::NEG_INFINITY];
        let end = self.control.time_us() + 60_000_000;
        while self.control.snapshot().mode == Mode::Reference {
            assert!(self.control.time_us() < end, "{:?}", self.control.snapshot());
            self.cycle();
            way = [way[0].min(self.table('X')), way[1].max(self.table('X'))];
        }
        self.settle();
        assert_eq!(self.messages(), [""; 0]);
        way
    }

    /// Forces a PLC input.
    pub fn input(&mut self, name: &str, on: bool) {
        self.event(&format!("fault input {name} {}", u8::from(on)));
    }

    /// One PLC cycle of 20 ms and a little more: what the PLC sets now has reached the NC.
    pub fn scan(&mut self) {
        self.seconds(0.024);
    }

    /// Runs for a time and writes every change of these bits down, as the PLC sees them: `M2045=1`.
    pub fn edges(&mut self, seconds: f64, bits: &[&str]) -> Vec<String> {
        let mut edges = Vec::new();
        let mut before: Vec<bool> = bits.iter().map(|bit| self.bit(bit)).collect();
        let end = self.control.time_us() + (seconds * 1e6) as u64;
        while self.control.time_us() < end {
            self.cycle();
            for (bit, before) in bits.iter().zip(&mut before) {
                let now = self.bit(bit);
                if now != *before {
                    edges.push(format!("{bit}={}", u8::from(now)));
                    *before = now;
                }
            }
        }
        edges
    }

    /// The state of an axis.
    pub fn axis(&self, letter: char) -> bahn_tnc::AxisState {
        let axes = self.control.snapshot().axes;
        axes.into_iter().find(|axis| axis.letter == letter).unwrap()
    }

    /// Actual speed of the table of an axis, mm/min.
    pub fn speed(&self, letter: char) -> f64 {
        self.machine.axis(letter).unwrap().speed_per_min
    }

    /// True position of the table.
    pub fn table(&self, letter: char) -> f64 {
        self.machine.axis(letter).unwrap().position
    }

    /// All stand for a while.
    pub fn settle(&mut self) {
        self.seconds(0.5);
    }
}

/// Asserts that two values are within a tolerance.
#[track_caller]
pub fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!(
        (actual - expected).abs() <= tolerance,
        "{actual} is not {expected}"
    );
}
