//! A machine for the tests and the hands of its operator.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a helper that panics fails its test"
)]

use bahn_machine::Machine;
use bahn_servo::{INPUTS, OUTPUTS};

/// Chain, one ideal axis X, panel; more is appended by the tests.
pub const BASE: &str = r#"
name = "test"
[emergency_stop]
acknowledgement = "I3"
pull_in_ms = 10
drop_out_ms = 20
switched_outputs = ["O0-O23"]
[keys]
NC_START = ["I146", "not I149"]
"X+" = "I133"
[lamps]
NC_START = "O0"
"#;

pub const IDEAL_X: &str = r#"
[axis.X]
output = "1"
speed = 15000
volts = 9
travel = [-100, 500]
encoder = { input = "X1", period_um = 20 }
"#;

/// A machine from its description.
pub fn machine(text: &str) -> Machine {
    Machine::from_toml(text).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// The same with the control voltage on.
pub fn running(text: &str) -> Machine {
    let mut machine = machine(text);
    machine.set_control_ready(true);
    machine.advance(10_000);
    assert!(machine.control_ready());
    machine
}

pub fn input(machine: &mut Machine, number: usize) -> bool {
    let mut inputs = [false; INPUTS];
    machine.inputs(&mut inputs);
    inputs[number]
}

/// Sets these outputs, and no others.
pub fn outputs(machine: &mut Machine, numbers: &[usize]) {
    let mut outputs = [false; OUTPUTS];
    for number in numbers {
        outputs[*number] = true;
    }
    machine.set_outputs(&outputs);
}

pub fn milliseconds(machine: &mut Machine, milliseconds: u32) {
    for _ in 0..milliseconds {
        machine.advance(1000);
    }
}
