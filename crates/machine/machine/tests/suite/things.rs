//! Panel, EMERGENCY STOP chain, things with two states, probe, analogue inputs, events.

use crate::common::{BASE, IDEAL_X, input, machine, milliseconds, outputs, running};
use bahn_machine::{Event, EventError, Machine};
use bahn_servo::{Commands, Measured, Plant, Step};

fn with(more: &str) -> String {
    format!("{BASE}{IDEAL_X}{more}")
}

#[test]
fn the_start_key_has_two_contacts() {
    let mut machine = running(&with(""));
    assert_eq!(
        (input(&mut machine, 146), input(&mut machine, 149)),
        (false, true)
    );
    machine.press("NC_START").unwrap();
    assert_eq!(
        (input(&mut machine, 146), input(&mut machine, 149)),
        (true, false)
    );
    machine.release("NC_START").unwrap();
    machine.apply("key X+ tap").unwrap();
    milliseconds(&mut machine, 199);
    assert!(input(&mut machine, 133));
    milliseconds(&mut machine, 1);
    assert!(!input(&mut machine, 133));
}

#[test]
fn a_lamp_shows_its_output() {
    let mut machine = running(&with(""));
    outputs(&mut machine, &[0]);
    milliseconds(&mut machine, 1);
    assert_eq!(machine.lamp("NC_START"), Some(true));
    assert_eq!(machine.lamp("X+"), None);
}

#[test]
fn the_relay_follows_control_is_ready_after_its_delay() {
    let mut machine = machine(&with(""));
    milliseconds(&mut machine, 100);
    assert!(!machine.control_ready(), "the control has not switched it on");
    machine.set_control_ready(true);
    milliseconds(&mut machine, 9);
    assert!(!machine.control_ready());
    milliseconds(&mut machine, 1);
    assert!(machine.control_ready() && input(&mut machine, 3));
    machine.set_control_ready(false);
    milliseconds(&mut machine, 19);
    assert!(machine.control_ready());
    milliseconds(&mut machine, 1);
    assert!(!machine.control_ready() && !input(&mut machine, 3));
}

#[test]
fn a_slow_relay_answers_too_late_for_the_power_up_test() {
    // 114 ms are permitted on the TNC 415 [000:6177].
    let mut machine = running(&with(""));
    machine.apply("fault relay slow 115").unwrap();
    machine.set_control_ready(false);
    milliseconds(&mut machine, 114);
    assert!(machine.control_ready());
    milliseconds(&mut machine, 1);
    assert!(!machine.control_ready());
    machine.apply("fault relay welded").unwrap();
    machine.set_control_ready(true);
    milliseconds(&mut machine, 20);
    machine.set_control_ready(false);
    milliseconds(&mut machine, 1000);
    assert!(machine.control_ready());
}

#[test]
fn button_and_supply_take_the_voltage_away() {
    for (away, back) in [
        ("emergency press", "emergency release"),
        ("voltage off", "voltage on"),
    ] {
        let mut machine = running(&with(""));
        machine.apply(away).unwrap();
        milliseconds(&mut machine, 20);
        assert!(!machine.control_ready(), "{away}");
        machine.apply(back).unwrap();
        milliseconds(&mut machine, 10);
        assert!(machine.control_ready(), "{back}");
    }
}

#[test]
fn with_a_key_the_voltage_waits_for_it() {
    let text = with("").replace("pull_in_ms", "control_voltage_key = \"NC_START\"\npull_in_ms");
    let mut machine = machine(&text);
    machine.set_control_ready(true);
    milliseconds(&mut machine, 100);
    assert!(!machine.control_ready());
    machine.apply("key NC_START tap").unwrap();
    milliseconds(&mut machine, 300);
    assert!(machine.control_ready(), "it holds itself");
    machine.apply("emergency press").unwrap();
    milliseconds(&mut machine, 20);
    machine.apply("emergency release").unwrap();
    milliseconds(&mut machine, 100);
    assert!(!machine.control_ready());
}

#[test]
fn outputs_o0_to_o23_lose_their_voltage_in_emergency_stop() {
    let things = "[device.switched]\noutput = \"O23\"\n[device.unswitched]\noutput = \"O24\"\n";
    let mut machine = running(&with(things));
    outputs(&mut machine, &[23, 24]);
    milliseconds(&mut machine, 2);
    machine.apply("emergency press").unwrap();
    milliseconds(&mut machine, 25);
    assert_eq!(machine.device("switched").unwrap().state, Some("off"));
    assert_eq!(machine.device("unswitched").unwrap().state, Some("on"));
}

#[test]
fn a_clamp_takes_its_time_and_reports() {
    let clamp = "[device.clamp]\noutput = \"O9\"\nstates = [\"open\", \"clamped\"]\nforth_ms = 300\n\
                 back_ms = 100\ninput_first = \"I40\"\ninput_second = \"I41\"\n";
    let mut machine = running(&with(clamp));
    let mut see = |numbers: &[usize], time: u32| {
        outputs(&mut machine, numbers);
        milliseconds(&mut machine, time);
        let state = machine.device("clamp").unwrap().state.map(str::to_owned);
        (state, input(&mut machine, 40), input(&mut machine, 41))
    };
    assert_eq!(see(&[], 1), (Some("open".to_owned()), true, false));
    assert_eq!(see(&[9], 299), (None, false, false));
    assert_eq!(see(&[9], 1), (Some("clamped".to_owned()), false, true));
    assert_eq!(see(&[], 99), (None, false, false));
    assert_eq!(see(&[], 1), (Some("open".to_owned()), true, false));
}

/// The second switch stays closed all the time, whatever the thing does.
#[test]
fn a_switch_stays_closed() {
    let clamp = "[device.clamp]\noutput = \"O9\"\nstates = [\"open\", \"clamped\"]\nforth_ms = 30\n\
                 back_ms = 10\ninput_first = \"I40\"\ninput_second = \"I41\"\n";
    let mut machine = running(&with(clamp));
    let inputs = |machine: &mut bahn_machine::Machine| (input(machine, 40), input(machine, 41));
    assert_eq!(inputs(&mut machine), (true, false));
    machine.apply("fault device clamp permanent").unwrap();
    assert_eq!(inputs(&mut machine), (true, true));
    outputs(&mut machine, &[9]);
    milliseconds(&mut machine, 15);
    assert_eq!(inputs(&mut machine), (false, true), "on its way");
    machine.apply("repair clamp").unwrap();
    assert_eq!(inputs(&mut machine), (false, false));
}

#[test]
fn a_valve_with_two_coils_stays_where_it_is() {
    let valve = "[device.valve]\noutput = \"O9\"\noutput_back = \"O10\"\n";
    let mut machine = running(&with(valve));
    for (coils, state) in [
        (&[9][..], "on"),
        (&[], "on"),
        (&[9, 10], "on"),
        (&[10], "off"),
        (&[], "off"),
    ] {
        outputs(&mut machine, coils);
        milliseconds(&mut machine, 5);
        assert_eq!(machine.device("valve").unwrap().state, Some(state), "{coils:?}");
    }
}

#[test]
fn a_pump_can_give_no_pressure() {
    let pump = "[device.lubrication]\noutput = \"O9\"\nforth_ms = 50\ninput_second = \"I41\"\n";
    for (fault, pressure) in [("", true), ("jammed", false), ("no-feedback", false)] {
        let mut machine = running(&with(pump));
        if !fault.is_empty() {
            machine
                .apply(&format!("fault device lubrication {fault}"))
                .unwrap();
        }
        outputs(&mut machine, &[9]);
        milliseconds(&mut machine, 100);
        assert_eq!(input(&mut machine, 41), pressure, "{fault}");
        machine.apply("repair lubrication").unwrap();
        milliseconds(&mut machine, 100);
        assert!(input(&mut machine, 41));
    }
}

#[test]
fn the_operator_opens_the_door() {
    let door = "[device.door]\nstates = [\"closed\", \"open\"]\nforth_ms = 500\nback_ms = 500\n\
                input_first = \"I50\"\n";
    let mut machine = running(&with(&format!("{door}[device.pump]\noutput = \"O9\"\n")));
    milliseconds(&mut machine, 1);
    assert!(input(&mut machine, 50));
    machine.apply("switch door open").unwrap();
    milliseconds(&mut machine, 501);
    assert!(!input(&mut machine, 50));
    assert_eq!(machine.device("door").unwrap().state, Some("open"));
    assert_eq!(
        machine.apply("switch pump on"),
        Err(EventError::NotByHand("pump".to_owned()))
    );
}

#[test]
fn contacts_stick() {
    let mut machine = running(&with(""));
    machine.apply("fault input I133 1").unwrap();
    assert!(input(&mut machine, 133));
    machine.apply("fault input I133 0").unwrap();
    machine.press("X+").unwrap();
    assert!(!input(&mut machine, 133));
    machine.apply("repair I133").unwrap();
    assert!(input(&mut machine, 133));
}

#[test]
fn potentiometers_handwheel_and_analogue_inputs() {
    let mut machine = running(&with(""));
    for event in [
        "override feed 80",
        "override spindle 120.5",
        "handwheel 250",
        "handwheel -50",
        "analogue 1 5.0",
        "temperature 6 23.4",
    ] {
        machine.apply(event).unwrap();
    }
    let mut measured = Measured::default();
    machine.exchange(Step::default(), &Commands::default(), &mut measured);
    let operator = measured.operator;
    assert_eq!(operator.feed_override_percent, 80.0);
    assert_eq!(operator.spindle_override_percent, 120.5);
    assert_eq!(operator.handwheel.counts[0], 200);
    assert_eq!(measured.volts[1], 5.0);
    assert_eq!(measured.temperatures[6], 23.4);
}

#[test]
fn the_probe_touches_a_block_beside_and_from_above() {
    // Ball of 2 mm radius, centre 98 mm below the spindle reference.
    let probe = "[axis.Y]\noutput = \"2\"\nspeed = 15000\nvolts = 9\n\
                 [axis.Z]\noutput = \"3\"\nspeed = 15000\nvolts = 9\nstart = 120\n\
                 [probe]\nlength = 100\nradius = 2\n\
                 [[probe.solid]]\nmin = [10, -20, -50]\nmax = [60, 20, 0]\n";
    let mut machine = running(&with(probe));
    machine.apply("probe insert").unwrap();
    assert!(machine.touch_probe().ready);
    machine.set_nominal(2, -0.9);
    milliseconds(&mut machine, 1000);
    // Z 95: the centre at -3, beside the block at X 0.
    assert!(!machine.touch_probe().deflected);
    machine.set_nominal(2, 0.0);
    machine.set_nominal(0, 0.09);
    let mut touched = None;
    for _ in 0..4000 {
        machine.advance(1000);
        if touched.is_none() && machine.touch_probe().deflected {
            touched = machine.axis('X').map(|axis| axis.position);
        }
    }
    // The face at 10 less the radius; 2.5 mm/s are 0.0025 mm in a millisecond.
    let touched = touched.unwrap();
    assert!((touched - 8.0).abs() < 0.0026, "{touched}");
    machine.set_nominal(0, -0.9);
    milliseconds(&mut machine, 500);
    assert!(!machine.touch_probe().deflected, "it is free again");
    machine.apply("fault probe early").unwrap();
    assert!(machine.touch_probe().deflected, "whatever it touches");
    machine.apply("repair probe").unwrap();
    assert!(!machine.touch_probe().deflected);
    machine.apply("fault probe not-ready").unwrap();
    machine.apply("fault probe battery").unwrap();
    assert!(!machine.touch_probe().ready && machine.touch_probe().battery_low);
    machine.apply("probe remove").unwrap();
    assert!(!machine.touch_probe().deflected);
}

/// A hand pushes the stylus: 4 N deflect that of a TM 110 by 1 mm [000:7919], along its own axes as it is mounted; that of a
/// triggering probe is deflected. In no spindle it says nothing.
#[test]
fn a_hand_pushes_the_stylus() {
    let with_probe = |more: &str| {
        running(&with(&format!(
            "[axis.Y]\noutput = \"2\"\nspeed = 15000\nvolts = 9\n\
             [axis.Z]\noutput = \"3\"\nspeed = 15000\nvolts = 9\nstart = 120\n\
             [probe]\nlength = 100\nradius = 2\n{more}\n"
        )))
    };
    // Its X lies along Y of the machine, its Y against X.
    let mut machine = with_probe("measuring = true\nmounting = [2, -1, 3]");
    machine.apply("probe push X 2").unwrap();
    assert_eq!(
        machine.touch_probe().deflection_mm,
        [0.0; 3],
        "it is in no spindle"
    );
    machine.apply("probe insert").unwrap();
    machine.apply("probe push Z -4").unwrap();
    let touch = machine.touch_probe();
    assert!(touch.deflected);
    assert_eq!(touch.deflection_mm, [0.0, -0.5, -1.0]);
    machine.apply("probe push X 0").unwrap();
    assert_eq!(machine.touch_probe().deflection_mm, [0.0, 0.0, -1.0]);
    machine.apply("repair probe").unwrap();
    assert!(!machine.touch_probe().deflected);
    let mut machine = with_probe("");
    machine.apply("probe insert").unwrap();
    machine.apply("probe push Y 1").unwrap();
    let touch = machine.touch_probe();
    assert!(touch.deflected);
    assert_eq!(touch.deflection_mm, [0.0; 3]);
    for wrong in ["probe push", "probe push C 1", "probe push X 21"] {
        assert!(machine.apply(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn wrong_events_say_what_is_right() {
    let mut machine = running(&with(""));
    let mut error = |event: &str| machine.apply(event).unwrap_err().to_string();
    assert!(error("dance").starts_with("`dance` is no event; there are key, override"));
    assert_eq!(
        error("override feed"),
        "this event is written `override feed|spindle PERCENT`"
    );
    assert_eq!(error("override feed 151"), "`151` is no number from 0 to 150");
    assert_eq!(error("override feed NaN"), "`NaN` is no number from 0 to 150");
    assert_eq!(
        error("key NC_STOP press"),
        "the machine has no key `NC_STOP`; there are NC_START, X+"
    );
    assert_eq!(
        error("fault drive Y dead"),
        "the machine has no axis `Y`; there are X"
    );
    assert_eq!(
        error("fault drive S dead"),
        "the machine has no part `spindle`; there are none"
    );
    assert_eq!(
        error("fault input I999 1"),
        "this event is written `fault input I12 0|1|bouncing`"
    );
    assert_eq!(error("analogue 8 1"), "`8` is no number from 0 to 7");
    for word in Event::WORDS {
        assert!(Event::HELP.contains(&format!("{word} ")), "{word} is explained");
    }
}

/// A contact that chatters reads the other way every 17 ms: ten times in 170 ms.
#[test]
fn a_chattering_contact_changes_all_the_time() {
    let mut machine = running(&with(""));
    machine.apply("fault input I146 bouncing").unwrap();
    let mut changes = 0;
    let mut before = input(&mut machine, 146);
    for _ in 0..170 {
        milliseconds(&mut machine, 1);
        let now = input(&mut machine, 146);
        changes += u32::from(now != before);
        before = now;
    }
    assert_eq!(changes, 10);
    machine.apply("repair I146").unwrap();
    assert!(!input(&mut machine, 146));
}

/// Held, X stands at full voltage; slow, it does 30 % of the speed; repaired, all of it.
#[test]
fn an_axis_is_held_or_slow() {
    let mut machine = running(&with(""));
    let mut travel = |fault: &str| {
        machine.apply("repair X").unwrap();
        if !fault.is_empty() {
            machine.apply(fault).unwrap();
        }
        machine.set_nominal(0, 0.9);
        milliseconds(&mut machine, 50);
        let from = machine.axis('X').unwrap().position;
        milliseconds(&mut machine, 100);
        machine.axis('X').unwrap().position - from
    };
    let whole = travel("");
    assert!(whole > 0.1, "{whole}");
    assert_eq!(travel("fault clamp X"), 0.0);
    assert!((travel("fault drive X slow") - 0.3 * whole).abs() < 1e-6 * whole);
    assert!((travel("") - whole).abs() < 1e-6 * whole);
}

/// A contactor that pulls in with any branch of `on`, each a series of contacts, and holds itself until one of `hold` opens. Its
/// contact stands where an output does; E and A are letters of inputs and outputs, too.
#[test]
fn contactors_hold_themselves() {
    let text = r#"
name = "cabinet"
[emergency_stop]
acknowledgement = "E8"
[axis.X]
output = "1"
speed = 1000
volts = 9
encoder = { input = "X1", period_um = 20 }
[device.k1]
on = ["A7 and A20", "RESET"]
hold = ["voltage", "not A17"]
forth_ms = 30
back_ms = 10
[device.pump]
output = "k1"
forth_ms = 100
back_ms = 100
input_second = "E40"
[keys]
RESET = "E30"
"#;
    let mut machine = Machine::from_toml(text).unwrap_or_else(|faults| panic!("{faults:?}"));
    machine.set_control_ready(true);
    machine.advance(100_000);
    let state =
        |machine: &Machine, name: &str| machine.device(name).unwrap().state.unwrap_or("moves").to_owned();
    let outputs = |on: &[usize]| {
        let mut outputs = [false; bahn_servo::OUTPUTS];
        on.iter().for_each(|output| outputs[*output] = true);
        outputs
    };
    // One contact of the series is not enough.
    machine.set_outputs(&outputs(&[7]));
    machine.advance(200_000);
    assert_eq!(state(&machine, "k1"), "off");
    machine.set_outputs(&outputs(&[7, 20]));
    machine.advance(29_000);
    assert_eq!(state(&machine, "k1"), "moves");
    machine.advance(3_000);
    machine.set_outputs(&outputs(&[]));
    machine.advance(200_000);
    assert_eq!(
        [state(&machine, "k1"), state(&machine, "pump")],
        ["on", "on"],
        "it holds itself"
    );
    machine.set_outputs(&outputs(&[17]));
    machine.advance(15_000);
    machine.set_outputs(&outputs(&[]));
    machine.advance(200_000);
    assert_eq!([state(&machine, "k1"), state(&machine, "pump")], ["off", "off"]);
    // By the key; without control voltage it drops out.
    machine.apply("key RESET tap").unwrap();
    machine.advance(400_000);
    assert_eq!(state(&machine, "k1"), "on");
    machine.apply("emergency press").unwrap();
    machine.advance(200_000);
    assert_eq!(state(&machine, "k1"), "off");
    machine.apply("emergency release").unwrap();
    machine.advance(200_000);
    assert_eq!(state(&machine, "k1"), "off", "it does not come by itself");
    // What is no contact is said with those that are.
    let faults = Machine::from_toml(&text.replace("A7 and A20", "A7 and k2")).unwrap_err();
    assert!(
        faults[0]
            .to_string()
            .contains("`k2` is neither an output nor a contact; there are k1, pump, RESET, gear1"),
        "{}",
        faults[0]
    );
}
