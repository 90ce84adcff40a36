//! Laws that hold for every machine and every course of events.

use crate::common::{BASE, milliseconds, running};
use bahn_machine::{Event, Machine, MachineFolder};
use bahn_servo::Encoder;
use proptest::prelude::*;

/// An axis with everything that can be wrong with it.
fn rough(mass: f64, friction: f64, weight: f64, play: f64, noise: f64) -> String {
    format!(
        "seed = 7\n{BASE}\n[axis.X]\noutput = \"1\"\nspeed = 15000\nvolts = 9\ntime_constant_ms = 8\n\
         reset_ms = 30\nmass = {mass}\nforce = 3000\nfriction = {friction}\nstiction = {friction}\n\
         weight = {weight}\nbacklash = {play}\nnoise_mv = {noise}\noffset_mv = 5\ntravel = [-20, 30]\n\
         encoder = {{ input = \"X1\", period_um = 20, marks_coded = 20 }}\n"
    )
}

fn rough_axis() -> impl Strategy<Value = String> {
    (10.0..1000.0, 0.0..800.0, -900.0..900.0, 0.0..0.1, 0.0..50.0)
        .prop_map(|(mass, friction, weight, play, noise)| rough(mass, friction, weight, play, noise))
}

/// The same with limit switches before its ends, which open the chain.
fn limited(text: &str) -> String {
    let ends = "travel = [-20, 30]";
    let switches = format!("{ends}\nlimit_minus = {{ at = -15 }}\nlimit_plus = {{ at = 25 }}");
    text.replace("pull_in_ms", "limit_switches = true\npull_in_ms")
        .replace(ends, &switches)
}

fn course() -> impl Strategy<Value = Vec<(f64, u32)>> {
    prop::collection::vec((-12.0..12.0, 1u32..20_000), 1..20)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn never_beyond_the_hard_stops_and_counts_tell_the_position(text in rough_axis(), course in course()) {
        let mut machine = running(&text);
        let start = machine.axis('X').unwrap().position;
        machine.encoder(0);
        for (volts, micros) in course {
            machine.set_nominal(0, volts);
            machine.advance(micros);
            let state = machine.axis('X').unwrap();
            prop_assert!((-20.0..=30.0).contains(&state.position));
            prop_assert!((-20.0..=30.0).contains(&state.motor_position));
            // The encoder counts from power-on, where the axis stood at 0.
            let expected = state.position / 0.02 * Encoder::STEPS as f64;
            let count = machine.encoder(0).count;
            prop_assert!((count as f64 - expected).abs() <= 1.0, "{count} {expected} {start}");
        }
    }

    #[test]
    fn friction_never_drives(mass in 10.0..1000.0, friction in 1.0..800.0, volts in -9.0..9.0) {
        // Without power the speed only falls.
        let mut machine = running(&rough(mass, friction, 0.0, 0.0, 0.0));
        machine.set_nominal(0, volts);
        milliseconds(&mut machine, 30);
        machine.apply("fault drive X dead").unwrap();
        let mut speed = machine.axis('X').unwrap().speed_per_min.abs();
        for _ in 0..50 {
            machine.advance(1000);
            let now = machine.axis('X').unwrap().speed_per_min.abs();
            prop_assert!(now <= speed);
            speed = now;
        }
    }

    #[test]
    fn the_same_however_time_is_divided(
        text in rough_axis(),
        course in course(),
        part in 1u32..3000,
        limits in any::<bool>(),
    ) {
        let text = if limits { limited(&text) } else { text };
        let mut whole = running(&text);
        let mut divided = running(&text);
        for (volts, micros) in course {
            whole.set_nominal(0, volts);
            divided.set_nominal(0, volts);
            whole.advance(micros);
            let mut left = micros;
            while left > 0 {
                let now = left.min(part);
                divided.advance(now);
                left -= now;
            }
            let bits = |machine: &Machine| {
                let state = machine.axis('X').unwrap();
                (state.position.to_bits(), state.speed_per_min.to_bits())
            };
            prop_assert_eq!(bits(&whole), bits(&divided));
            prop_assert_eq!(whole.encoder(0), divided.encoder(0));
            prop_assert_eq!(whole.control_voltage(), divided.control_voltage());
        }
    }

    #[test]
    fn any_text_is_a_machine_or_faults(text in ".{0,300}") {
        let _ = Machine::from_toml(&text);
    }

    #[test]
    fn any_change_of_a_description_is_read_or_refused(at in 0usize..700, cut in 0usize..40, put in "[\\[\\]={}\"a-zI0-9.\n -]{0,12}") {
        let text = rough(500.0, 100.0, 100.0, 0.01, 1.0);
        let at = at.min(text.len());
        let end = (at + cut).min(text.len());
        let changed = format!("{}{put}{}", &text[..at], &text[end..]);
        match Machine::from_toml(&changed) {
            Ok(mut machine) => machine.advance(10_000),
            Err(faults) => prop_assert!(faults.iter().all(|fault| fault.span.line > 0 && fault.span.column > 0)),
        }
    }

    #[test]
    fn any_event_is_done_or_refused(word in prop::sample::select(Event::WORDS), rest in "[a-zA-Z0-9+_. -]{0,30}") {
        let mut machine = running(&rough(500.0, 100.0, 100.0, 0.01, 1.0));
        let _ = machine.apply(&format!("{word} {rest}"));
        machine.advance(10_000);
        let position = machine.axis('X').unwrap().position;
        prop_assert!((-20.0..=30.0).contains(&position));
    }
}

#[test]
fn the_seed_is_the_noise() {
    let position = |text: &str| {
        let mut machine = running(text);
        machine.set_nominal(0, 0.5);
        milliseconds(&mut machine, 100);
        machine.axis('X').unwrap().position
    };
    let text = rough(500.0, 100.0, 0.0, 0.0, 50.0);
    assert_eq!(position(&text), position(&text));
    assert_ne!(position(&text), position(&text.replace("seed = 7", "seed = 8")));
}

/// A file that describes no machine has a fault in each of its lines: a thousand are named, in no time.
#[test]
fn a_thousand_faults_are_named() {
    let started = std::time::Instant::now();
    let keys: String = (0..90_000).map(|key| format!("key{key} = 1\n")).collect();
    let (_, faults) = MachineFolder::read(&keys);
    assert_eq!(faults.len(), 1001);
    assert!(faults.iter().any(|fault| fault.message.starts_with("too many")));
    let faults = Machine::from_toml(&keys).unwrap_err();
    assert_eq!(faults.len(), 1001);
    assert!(started.elapsed().as_secs() < 20, "{:?}", started.elapsed());
}
