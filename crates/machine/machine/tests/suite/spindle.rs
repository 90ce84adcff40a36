//! The main spindle.

use crate::common::{BASE, IDEAL_X, input, milliseconds, outputs, running};
use bahn_machine::Machine;

const SPINDLE: &str = r#"
[spindle]
output = "S"
rpm = 6000
volts = 9
time_constant_ms = 50
acceleration_rpm_per_s = 6000
coasting_rpm_per_s = 500
enable = "O10"
at_speed = "I34"
stopped = "I35"
standstill_rpm = 5
shift_ms = 300
shift_rpm = [10, 100]
encoder = { input = "X6", lines = 1024, mark_deg = 90 }
[[spindle.gear]]
ratio = 4
output = "O15"
input = "I36"
[[spindle.gear]]
ratio = 1
output = "O16"
input = "I37"
"#;

fn spindle() -> Machine {
    let mut machine = running(&format!("{BASE}{IDEAL_X}{SPINDLE}"));
    outputs(&mut machine, &[10]);
    milliseconds(&mut machine, 1);
    machine
}

#[test]
fn the_gear_divides_the_speed_of_the_motor() {
    let mut machine = spindle();
    machine.set_nominal(5, 4.5);
    milliseconds(&mut machine, 200);
    // 6000 rpm/s: still on the way up.
    assert!((machine.spindle().unwrap().motor_rpm - 1200.0).abs() < 10.0);
    assert!(!input(&mut machine, 34) && !input(&mut machine, 35));
    milliseconds(&mut machine, 1800);
    let state = machine.spindle().unwrap();
    assert!((state.motor_rpm - 3000.0).abs() < 0.1, "{state:?}");
    assert!((state.rpm - 750.0).abs() < 0.1);
    assert_eq!(state.gear, Some(1));
    assert!(input(&mut machine, 34) && !input(&mut machine, 35));
}

#[test]
fn without_enable_it_coasts() {
    let mut machine = spindle();
    machine.set_nominal(5, 4.5);
    milliseconds(&mut machine, 2000);
    outputs(&mut machine, &[]);
    milliseconds(&mut machine, 1000);
    // 500 rpm/s of the motor.
    assert!((machine.spindle().unwrap().motor_rpm - 2500.0).abs() < 1.0);
    milliseconds(&mut machine, 6000);
    assert_eq!(machine.spindle().unwrap().rpm, 0.0);
    assert!(input(&mut machine, 35));
}

#[test]
fn the_gear_engages_only_while_the_motor_turns_slowly() {
    let mut machine = spindle();
    outputs(&mut machine, &[10, 16]);
    milliseconds(&mut machine, 1000);
    assert_eq!(
        machine.spindle().unwrap().gear,
        None,
        "tooth on tooth at standstill"
    );
    assert!(!input(&mut machine, 36) && !input(&mut machine, 37));
    // 0.05 V: 33 rpm.
    machine.set_nominal(5, 0.05);
    milliseconds(&mut machine, 500);
    assert_eq!(machine.spindle().unwrap().gear, Some(2));
    assert!(!input(&mut machine, 36) && input(&mut machine, 37));
    outputs(&mut machine, &[10]);
    milliseconds(&mut machine, 500);
    assert_eq!(
        machine.spindle().unwrap().gear,
        Some(2),
        "it stays when the valve closes"
    );
}

#[test]
fn a_gear_can_jam_or_be_silent() {
    for (fault, gear) in [("jammed", Some(1)), ("no-feedback", Some(2))] {
        let mut machine = spindle();
        machine.apply(&format!("fault device gear {fault}")).unwrap();
        machine.set_nominal(5, 0.05);
        outputs(&mut machine, &[10, 16]);
        milliseconds(&mut machine, 1000);
        assert_eq!(machine.spindle().unwrap().gear, gear);
        assert!(!input(&mut machine, 37));
        machine.apply("repair gear").unwrap();
        milliseconds(&mut machine, 500);
        assert!(input(&mut machine, 37));
    }
}

#[test]
fn the_encoder_counts_lines_and_passes_its_mark_each_turn() {
    let mut machine = spindle();
    machine.set_nominal(5, 0.9);
    milliseconds(&mut machine, 1000);
    machine.encoder(5);
    let before = machine.spindle().unwrap().angle_deg;
    // 600 rpm motor, 150 rpm spindle: 2.5 turns in a second.
    let mut marks = Vec::new();
    for _ in 0..1000 {
        machine.advance(1000);
        marks.extend(machine.encoder(5).mark);
    }
    let state = machine.spindle().unwrap();
    assert!((state.angle_deg - before - 900.0).abs() < 0.1);
    let count = machine.encoder(5).count as f64;
    assert!((count - state.angle_deg / 360.0 * 1024.0 * 1024.0).abs() <= 1.0);
    for mark in &marks {
        assert_eq!(mark % (1024 * 1024), 256 * 1024, "a quarter of a turn");
    }
    assert!(marks.len() == 2 || marks.len() == 3);
}

#[test]
fn a_dead_drive_never_reaches_its_speed() {
    let mut machine = spindle();
    machine.apply("fault drive S dead").unwrap();
    machine.set_nominal(5, 4.5);
    milliseconds(&mut machine, 3000);
    assert_eq!(machine.spindle().unwrap().rpm, 0.0);
    assert!(!input(&mut machine, 34));
}
