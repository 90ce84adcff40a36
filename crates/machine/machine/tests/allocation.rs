//! A machine does not allocate while it runs.
#![allow(clippy::unwrap_used, reason = "a test that panics fails")]

use bahn_machine::Machine;
use bahn_servo::{Commands, Measured, Plant, Step};

#[test]
fn a_second_of_the_mill_allocates_nothing() {
    let mut machine = Machine::from_toml(bahn_machines::MILL.file("plant.toml").unwrap()).unwrap();
    machine.set_control_ready(true);
    let (mut commands, mut measured) = (Commands::default(), Measured::default());
    commands.outputs.fill(true);
    commands.control_ready = true;
    machine.advance(100_000);
    let counts = allocation_counter::measure(|| drop(std::hint::black_box(Box::new(1))));
    assert_eq!(counts.count_total, 1, "the allocator counts");
    let allocated = allocation_counter::measure(|| {
        for cycle in 0..1000u32 {
            for axis in &mut commands.axes {
                axis.volts = f64::from(cycle % 19) - 9.0;
            }
            let step = Step {
                from_us: 1000 * u64::from(cycle),
                length_us: 1000,
            };
            machine.exchange(step, &commands, &mut measured);
        }
    });
    assert_eq!(allocated.count_total, 0);
}
