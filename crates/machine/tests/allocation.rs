//! A machine does not allocate while it runs.
#![allow(clippy::unwrap_used, reason = "a test that panics fails")]

use bahn_machine::Machine;
use bahn_servo::{INPUTS, OUTPUTS, Plant};

#[test]
fn a_second_of_the_mill_allocates_nothing() {
    let mut machine = Machine::from_toml(bahn_machines::MILL.file("plant.toml").unwrap()).unwrap();
    machine.set_control_ready(true);
    let mut inputs = [false; INPUTS];
    let mut outputs = [false; OUTPUTS];
    outputs.fill(true);
    machine.advance(100_000);
    let counts = allocation_counter::measure(|| drop(std::hint::black_box(Box::new(1))));
    assert_eq!(counts.count_total, 1, "the allocator counts");
    let allocated = allocation_counter::measure(|| {
        for cycle in 0..1000u32 {
            for output in 0..6 {
                machine.set_nominal(output, f64::from(cycle % 19) - 9.0);
            }
            machine.advance(1000);
            for input in 0..6 {
                machine.encoder(input);
            }
            machine.inputs(&mut inputs);
            machine.set_outputs(&outputs);
            machine.probe_deflected();
            machine.operator();
        }
    });
    assert_eq!(allocated.count_total, 0);
}
