//! The mill of `machines/mill`: three axes, the table and the spindle.
//!
//! ```text
//! cargo bench -p bahn-machine
//! ```

#![expect(clippy::unwrap_used, reason = "the description of the mill is right")]

use bahn_machine::Machine;
use bahn_servo::{INPUTS, OUTPUTS};
use divan::Bencher;

fn main() {
    divan::main();
}

/// The plant of the shipped mill.
fn mill() -> &'static str {
    bahn_machines::MILL.file("plant.toml").unwrap()
}

/// The mill with everything switched on; without the rotary table it has three axes.
fn running(text: &str) -> Machine {
    let mut machine = Machine::from_toml(text).unwrap();
    machine.set_control_ready(true);
    machine.set_outputs(&[true; OUTPUTS]);
    machine.advance(100_000);
    for output in 0..6 {
        machine.set_nominal(output, 0.5);
    }
    machine
}

/// One step of the fine interpolation, 0.6 ms; the machine comes back before it reaches a stop.
fn advance(bencher: Bencher, text: &str) {
    let mut machine = running(text);
    let mut step = 0u32;
    bencher.bench_local(|| {
        step += 1;
        if step.is_multiple_of(1000) {
            let volts = if step.is_multiple_of(2000) { 0.5 } else { -0.5 };
            for output in 0..6 {
                machine.set_nominal(output, volts);
            }
        }
        machine.advance(600);
    });
}

#[divan::bench]
fn advance_600_us_four_axes(bencher: Bencher) {
    advance(bencher, mill());
}

#[divan::bench]
fn advance_600_us_three_axes(bencher: Bencher) {
    let table = mill().find("[axis.C]").unwrap();
    let after = table + mill()[table..].find("[spindle]").unwrap();
    let text = format!("{}{}", &mill()[..table], &mill()[after..]).replace("clamps = \"C\"", "");
    advance(bencher, &text);
}

#[divan::bench]
fn read_inputs(bencher: Bencher) {
    let machine = running(mill());
    let mut inputs = [false; INPUTS];
    bencher.bench_local(|| machine.inputs(&mut inputs));
}

#[divan::bench]
fn read_encoder(bencher: Bencher) {
    let mut machine = running(mill());
    bencher.bench_local(|| machine.encoder(2));
}
