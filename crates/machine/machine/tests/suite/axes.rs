//! Feed axes: drives, mechanics, encoders, switches.

use crate::common::{BASE, IDEAL_X, input, milliseconds, running};
use bahn_servo::Encoder;

fn x(keys: &str) -> String {
    format!("{BASE}\n[axis.X]\noutput = \"1\"\nspeed = 15000\nvolts = 9\n{keys}\n")
}

#[test]
fn nine_volts_are_rapid_traverse() {
    let mut machine = running(&format!("{BASE}{IDEAL_X}"));
    machine.set_nominal(0, 9.0);
    milliseconds(&mut machine, 600);
    // 15000 mm/min = 250 mm/s; 0.6 s are 150 mm = 7500 periods of 20 µm.
    let state = machine.axis('X').unwrap();
    assert!((state.position - 150.0).abs() < 1e-9, "{state:?}");
    assert!((state.speed_per_min - 15000.0).abs() < 1e-6);
    let count = machine.encoder(0).count;
    assert!((count - 7500 * Encoder::STEPS).abs() <= 1, "{count}");
}

#[test]
fn a_drive_of_first_order_is_63_percent_there_after_its_time_constant() {
    let mut machine = running(&x("time_constant_ms = 20"));
    machine.set_nominal(0, 0.9);
    milliseconds(&mut machine, 20);
    // 1500 mm/min * (1 - 1/e) = 948.18 mm/min.
    let state = machine.axis('X').unwrap();
    assert!((state.speed_per_min - 948.18).abs() < 0.01, "{state:?}");
    // Travel v (t - T (1 - e^(-t/T))) = 25 mm/s * 20 ms / e = 0.18394 mm.
    assert!((state.position - 0.18394).abs() < 1e-5, "{state:?}");
}

#[test]
fn the_integral_part_takes_friction_and_weight_away() {
    let drive = "time_constant_ms = 5\nreset_ms = 20\nmass = 500\nfriction = 400\nweight = 1000";
    let mut machine = running(&x(drive));
    machine.set_nominal(0, 0.9);
    milliseconds(&mut machine, 1000);
    let state = machine.axis('X').unwrap();
    assert!((state.speed_per_min - 1500.0).abs() < 0.01, "{state:?}");
}

#[test]
fn without_integral_part_the_weight_costs_speed() {
    // 1000 N on 500 kg are 2 m/s²; times 5 ms: 10 mm/s = 600 mm/min less.
    let mut machine = running(&x("time_constant_ms = 5\nmass = 500\nweight = 1000"));
    machine.set_nominal(0, 0.9);
    milliseconds(&mut machine, 1000);
    let speed = machine.axis('X').unwrap().speed_per_min;
    // The step of 0.2 ms is 4 % of the time constant; the error stays below that.
    assert!((speed - 900.0).abs() < 0.04 * 600.0, "{speed}");
}

#[test]
fn force_limits_the_acceleration() {
    // 1000 N on 500 kg: 2 m/s². After 50 ms: 100 mm/s = 6000 mm/min.
    let mut machine = running(&x("time_constant_ms = 1\nmass = 500\nforce = 1000"));
    machine.set_nominal(0, 9.0);
    milliseconds(&mut machine, 50);
    let speed = machine.axis('X').unwrap().speed_per_min;
    assert!((speed - 6000.0).abs() < 1.0, "{speed}");
}

#[test]
fn what_stands_stays_until_stiction_is_overcome() {
    // Stiction 600 N on 500 kg = 1.2 m/s². A speed error of 5 mm/s over 5 ms asks for 1 m/s², 7 mm/s for 1.4.
    let drive = "time_constant_ms = 5\nmass = 500\nfriction = 300\nstiction = 600";
    let mut machine = running(&x(drive));
    machine.set_nominal(0, 9.0 * 5.0 / 250.0);
    milliseconds(&mut machine, 200);
    assert_eq!(machine.axis('X').unwrap().position, 0.0);
    machine.set_nominal(0, 9.0 * 7.0 / 250.0);
    milliseconds(&mut machine, 200);
    assert!(machine.axis('X').unwrap().position > 0.5);
}

#[test]
fn the_offset_of_the_amplifier_lets_the_axis_creep() {
    // 9 mV of 9 V are 1/1000 of rapid traverse: 15 mm/min.
    let mut machine = running(&x("offset_mv = 9"));
    milliseconds(&mut machine, 1000);
    assert!((machine.axis('X').unwrap().position - 0.25).abs() < 1e-9);
    machine.apply("fault offset X -0.009").unwrap();
    milliseconds(&mut machine, 1000);
    assert!(machine.axis('X').unwrap().position.abs() < 1e-9);
}

#[test]
fn play_lies_between_motor_and_table() {
    let keys = "backlash = 0.05\nencoder = { input = \"X1\", period_um = 20, on = \"motor\" }";
    let mut machine = running(&x(keys));
    let mut drive = |volts: f64, time: u32| {
        machine.set_nominal(0, volts);
        milliseconds(&mut machine, time);
        (machine.axis('X').unwrap(), machine.encoder(0).count)
    };
    // 0.36 V = 10 mm/s. Forth 1 mm: the table follows half the play behind.
    let (there, count) = drive(0.36, 100);
    assert!((there.motor_position - 1.0).abs() < 1e-9);
    assert!((there.position - 0.975).abs() < 1e-9, "{there:?}");
    // The encoder on the motor sees 1 mm = 50 periods.
    assert!((count - 50 * Encoder::STEPS).abs() <= 1);
    // Back 0.05 mm: only the motor moves.
    let (back, _) = drive(-0.36, 5);
    assert!((back.motor_position - 0.95).abs() < 1e-9);
    assert!((back.position - 0.975).abs() < 1e-9, "{back:?}");
    let (further, _) = drive(-0.36, 5);
    assert!((further.position - 0.925).abs() < 1e-9, "{further:?}");
}

#[test]
fn the_axis_stops_hard_at_the_ends_of_its_travel() {
    let mut machine = running(&format!("{BASE}{IDEAL_X}"));
    machine.set_nominal(0, 10.0);
    milliseconds(&mut machine, 3000);
    let state = machine.axis('X').unwrap();
    assert_eq!((state.position, state.speed_per_min), (500.0, 0.0));
}

#[test]
fn a_mark_is_latched_where_it_is_not_where_a_step_ends() {
    let text = x("start = 3\nencoder = { input = \"X1\", period_um = 20, mark = 10.01 }");
    let mut machine = running(&text);
    machine.set_nominal(0, 9.0);
    assert_eq!(machine.encoder(0).mark, None);
    milliseconds(&mut machine, 40);
    // 7.01 mm from the start: 350.5 periods. From 3 mm/250 mm/s on it is latched, once.
    assert_eq!(machine.encoder(0).mark, Some(350 * 1024 + 512));
    assert_eq!(machine.encoder(0).mark, None);
    machine.set_nominal(0, -9.0);
    milliseconds(&mut machine, 40);
    assert_eq!(
        machine.encoder(0).mark,
        Some(350 * 1024 + 512),
        "the same mark from the other side"
    );
}

/// Marks of a scratched scale stand twice, 20 periods apart; a scale whose mark signal is lost has none, and still counts.
#[test]
fn marks_are_doubled_or_lost() {
    for (fault, periods) in [
        ("twice", &[350 * 1024 + 512, 370 * 1024 + 512][..]),
        ("no-marks", &[]),
    ] {
        let text = x("start = 3\nencoder = { input = \"X1\", period_um = 20, mark = 10.01 }");
        let mut machine = running(&text);
        machine.apply(&format!("fault encoder X {fault}")).unwrap();
        machine.set_nominal(0, 9.0);
        let mut marks = Vec::new();
        for _ in 0..60 {
            machine.advance(1000);
            marks.extend(machine.encoder(0).mark);
        }
        // 7.01 mm from the start are 350.5 periods.
        assert_eq!(marks, periods, "{fault}");
        assert!(machine.encoder(0).count > 400 * 1024, "{fault}");
    }
}

/// The brake of a hanging axis is lost, and found again.
#[test]
fn a_brake_that_does_not_hold() {
    let mut machine = running(&x("mass = 100\nweight = 1000\nenable = \"O8\"\nbrake = 1500"));
    machine.apply("fault brake X").unwrap();
    milliseconds(&mut machine, 100);
    // 10 m/s² for 0.1 s: 50 mm, and 1 m/s.
    let fallen = machine.axis('X').unwrap().position;
    assert!((fallen + 50.0).abs() < 0.5, "{fallen}");
    machine.apply("repair X").unwrap();
    // (1500 - 1000) N brake 100 kg by 5 m/s²: 1 m/s ends in 0.2 s.
    milliseconds(&mut machine, 210);
    assert_eq!(machine.axis('X').unwrap().speed_per_min, 0.0);
}

#[test]
fn two_coded_marks_tell_the_place() {
    // Marks at -100, -89.98, -80, -69.96: 501 and 499 periods apart, then 502.
    let encoder = "travel = [-100, 500]\nstart = -95\n\
                   encoder = { input = \"X1\", period_um = 20, marks_coded = 20 }";
    let mut machine = running(&x(encoder));
    machine.set_nominal(0, 0.9);
    let mut marks = Vec::new();
    for _ in 0..1200 {
        machine.advance(1000);
        marks.extend(machine.encoder(0).mark);
    }
    let periods: Vec<i64> = marks
        .windows(2)
        .map(|pair| (pair[1] - pair[0] + 512) / 1024)
        .collect();
    assert_eq!(periods, [499, 502]);
    machine.apply("fault encoder X marks").unwrap();
    let mut marks = Vec::new();
    for _ in 0..1200 {
        machine.advance(1000);
        marks.extend(machine.encoder(0).mark);
    }
    let periods = (marks[1] - marks[0] + 512) / 1024;
    assert!(
        periods == 503 + 3 || periods == 497 - 3 || periods == 497 + 3,
        "a dirty scale counts a wrong distance: {periods}"
    );
}

#[test]
fn a_ballscrew_encoder_has_a_mark_each_turn() {
    let encoder =
        "encoder = { input = \"X1\", period_um = 4, on = \"motor\", marks_every = 10, marks_from = 2.5 }";
    let mut machine = running(&x(encoder));
    machine.set_nominal(0, 0.9);
    let mut marks = Vec::new();
    for _ in 0..1000 {
        machine.advance(1000);
        marks.extend(machine.encoder(0).mark);
    }
    // At 2.5, 12.5 and 22.5 mm.
    assert_eq!(
        marks,
        [2500, 12500, 22500].map(|micrometres| micrometres / 4 * 1024)
    );
}

#[test]
fn failing_encoders_tell_or_do_not_tell() {
    let mut machine = running(&format!("{BASE}{IDEAL_X}"));
    machine.set_nominal(0, 0.9);
    for (fault, amplitude, edges) in [
        ("amplitude", true, false),
        ("edges", false, true),
        ("stuck", false, false),
    ] {
        milliseconds(&mut machine, 10);
        let before = machine.encoder(0);
        machine.apply(&format!("fault encoder X {fault}")).unwrap();
        milliseconds(&mut machine, 10);
        let after = machine.encoder(0);
        assert_eq!(after.count, before.count, "{fault}");
        assert_eq!(
            (after.amplitude_low, after.edges_too_close),
            (amplitude, edges),
            "{fault}"
        );
        machine.apply("repair X").unwrap();
        let repaired = machine.encoder(0);
        assert_eq!(repaired.count, before.count, "what was not counted stays lost");
        assert!(!repaired.amplitude_low && !repaired.edges_too_close);
    }
}

#[test]
fn edges_follow_too_closely_beyond_the_limiting_frequency() {
    // 50 kHz of 2 µm are 100 mm/s = 3.6 V.
    let mut machine = running(&x(
        "encoder = { input = \"X1\", period_um = 2, frequency_max_khz = 50 }",
    ));
    for (volts, too_close) in [(3.5, false), (3.7, true)] {
        machine.set_nominal(0, volts);
        milliseconds(&mut machine, 5);
        assert_eq!(machine.encoder(0).edges_too_close, too_close, "{volts}");
    }
}

#[test]
fn drives_fail_in_three_ways() {
    let mut machine = running(&x("time_constant_ms = 5"));
    let mut speed_with = |fault: &str| {
        machine.apply(fault).unwrap();
        machine.set_nominal(0, 0.9);
        milliseconds(&mut machine, 200);
        let speed = machine.axis('X').unwrap().speed_per_min;
        machine.apply("repair X").unwrap();
        speed
    };
    assert!((speed_with("fault drive X runaway") - 15000.0 * 10.0 / 9.0).abs() < 0.01);
    assert!((speed_with("fault drive X reversed") + 1500.0).abs() < 0.01);
    // Dead and without friction it rolls on.
    assert!((speed_with("fault drive X dead") + 1500.0).abs() < 0.01);
}

#[test]
fn a_hanging_axis_falls_unless_its_brake_holds() {
    for (brake, falls) in [(500, true), (1500, false)] {
        let text = format!("mass = 100\nweight = 1000\nenable = \"O8\"\nbrake = {brake}");
        let mut machine = running(&x(&text));
        milliseconds(&mut machine, 100);
        assert_eq!(machine.axis('X').unwrap().position < -1.0, falls, "{brake} N");
    }
}

#[test]
fn an_axis_in_emergency_stop_is_braked() {
    // 2000 N on 500 kg: 4 m/s². From 100 mm/s to rest in 25 ms, 1.25 mm, after 20 ms of relay.
    let mut machine = running(&x("mass = 500\ntime_constant_ms = 1\nbrake = 2000"));
    machine.set_nominal(0, 3.6);
    milliseconds(&mut machine, 100);
    machine.apply("emergency press").unwrap();
    milliseconds(&mut machine, 20);
    let start = machine.axis('X').unwrap().position;
    assert!(!machine.control_ready());
    milliseconds(&mut machine, 30);
    let state = machine.axis('X').unwrap();
    assert_eq!(state.speed_per_min, 0.0);
    assert!(
        (state.position - start - 1.25).abs() < 0.02,
        "{}",
        state.position - start
    );
}

#[test]
fn cams_and_limit_switches_are_plc_inputs() {
    let keys = "travel = [-100, 500]\nreference_cam = { range = [400, 500], input = \"I20\" }\n\
                limit_minus = { at = -95, input = \"I21\" }\nlimit_plus = { at = 495, input = \"I22\" }\n\
                pulse_inhibit = { open = [420, 430], input = \"I23\" }";
    let mut machine = running(&x(keys));
    let mut go = |volts: f64, time: u32| {
        machine.set_nominal(0, volts);
        milliseconds(&mut machine, time);
        [20, 21, 22, 23].map(|number| input(&mut machine, number))
    };
    assert_eq!(go(0.0, 1), [false, true, true, true]);
    assert_eq!(
        go(9.0, 1700),
        [true, true, true, false],
        "425 mm: on the cam, around the pulse"
    );
    assert_eq!(
        go(9.0, 300),
        [true, true, false, true],
        "500 mm: limit switch open"
    );
    assert_eq!(go(-9.0, 2400), [false, false, true, true], "-100 mm");
}

#[test]
fn limit_switches_in_the_chain_take_the_voltage_away() {
    let text = x("travel = [-100, 500]\nlimit_plus = { at = 495 }")
        .replace("pull_in_ms", "limit_switches = true\npull_in_ms");
    let mut machine = running(&text);
    machine.set_nominal(0, 9.0);
    milliseconds(&mut machine, 2100);
    assert!(!machine.control_ready());
}

#[test]
fn a_clamp_holds_the_axis() {
    let text = x("") + "[device.clamp]\noutput = \"O9\"\nclamps = \"X\"\nforth_ms = 50\nback_ms = 50\n";
    let mut machine = running(&text);
    machine.set_nominal(0, 0.9);
    crate::common::outputs(&mut machine, &[9]);
    milliseconds(&mut machine, 60);
    let held = machine.axis('X').unwrap();
    milliseconds(&mut machine, 100);
    assert!(held.clamped);
    assert_eq!(machine.axis('X').unwrap().position, held.position);
    crate::common::outputs(&mut machine, &[]);
    milliseconds(&mut machine, 100);
    assert!(machine.axis('X').unwrap().position > held.position + 1.0);
}

#[test]
fn a_force_from_outside_pushes() {
    let mut machine = running(&x("mass = 100\nenable = \"O8\""));
    machine.apply("force X 50").unwrap();
    milliseconds(&mut machine, 1000);
    // 0.5 m/s² for a second: 250 mm.
    assert!((machine.axis('X').unwrap().position - 250.0).abs() < 1.0);
}

#[test]
fn a_rotary_table_counts_degrees() {
    // 90 degrees/s from 36 Nm on 20 kg m²: 1.8 rad/s² = 103.13 degrees/s².
    let text = format!(
        "{BASE}\n[axis.C]\noutput = \"4\"\nspeed = 7200\nvolts = 9\nmass = 20\nforce = 36\ntime_constant_ms = 1\n"
    );
    let mut machine = running(&text);
    machine.set_nominal(3, 9.0);
    milliseconds(&mut machine, 500);
    let speed = machine.axis('C').unwrap().speed_per_min / 60.0;
    assert!((speed - 51.57).abs() < 0.1, "{speed}");
}
