//! The description of a machine is read or refused, fault by fault.

use crate::common::{BASE, IDEAL_X};
use bahn_machine::Machine;

fn faults(text: &str) -> Vec<String> {
    Machine::from_toml(text)
        .err()
        .unwrap_or_default()
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[test]
fn all_faults_come_with_their_place() {
    let text = "\
name = \"mill\"
seed = -1
[emergency_stop]
acknowledgement = \"I3\"
pull_im_ms = 10
[axis.X]
output = \"6\"
speed = 15000
volts = 20
travel = [100, -100]
reference_cam = { range = [0, 10], input = \"Q20\" }
[axis.Q]
[lamps]
START = \"O192\"
";
    assert_eq!(
        faults(text),
        [
            "2:8: seed is a number from 0 to 1000000000000000",
            "5:1: unknown key `pull_im_ms` in [emergency_stop]; there are acknowledgement, control_voltage_key, \
             drop_out_ms, limit_switches, pull_in_ms, switched_outputs",
            "7:10: output is one of 1, 2, 3, 4, 5, S, and 7 to 40 of further channels",
            "9:9: volts is a number from 0.1 to 10",
            "10:10: travel runs from a lower to a higher value",
            "11:44: input is an input \"I0\" to \"I383\", or \"not I0\"",
            "12:1: `Q` is no axis: X Y Z A B C U V W",
            "14:9: START is an output \"O0\" to \"O191\", or \"not O0\"",
        ]
        .map(str::to_owned)
        .to_vec()
        .into_iter()
        .map(|fault| fault.replace("             ", ""))
        .collect::<Vec<_>>()
    );
}

#[test]
fn faults_of_form_are_found_too() {
    let text = format!("{BASE}{IDEAL_X}\nseed = = 3\n[device.door\nstart = \"open\"\n");
    let faults = faults(&text);
    assert!(faults.len() >= 2, "{faults:?}");
    assert!(faults[0].starts_with("21:"), "{faults:?}");
}

#[test]
fn an_input_belongs_to_one_thing() {
    let text = format!("{BASE}{IDEAL_X}[device.door]\ninput_first = \"I133\"\n");
    assert_eq!(faults(&text), ["21:15: I133 belongs to keys.X+ already"]);
}

#[test]
fn axes_do_not_share_outputs_or_encoders() {
    let text = format!("{BASE}{IDEAL_X}{}", IDEAL_X.replace("axis.X", "axis.Y"));
    let faults = faults(&text);
    assert_eq!(faults.len(), 2, "{faults:?}");
    assert!(
        faults
            .iter()
            .any(|fault| fault.ends_with("X and Y share an output"))
    );
    assert!(
        faults
            .iter()
            .any(|fault| fault.ends_with("X and Y share an encoder input"))
    );
}

#[test]
fn what_is_missing_is_named() {
    let faults = faults("[axis.X]\nspeed = 1000\n[spindle]\nrpm = 100\n[[spindle.gear]]\n");
    for missing in [
        "the machine needs [emergency_stop] with its acknowledgement, usually I3",
        "[axis.X] needs volts",
        "[axis.X] needs output",
        "[spindle] needs volts",
        "[spindle.gear] needs ratio",
    ] {
        assert!(
            faults.iter().any(|fault| fault.ends_with(missing)),
            "{missing}: {faults:?}"
        );
    }
}

/// Connectors of further channels: an axis at output 7 and X7, a second spindle at output 12.
#[test]
fn further_channels_have_connectors_of_their_own() {
    let text = r#"
        name = "two"
        [emergency_stop]
        acknowledgement = "I3"
        [axis.X]
        output = "1"
        speed = 6000
        volts = 10
        encoder = { input = "X1", period_um = 20 }
        [axis.U]
        output = "7"
        speed = 3000
        volts = 10
        encoder = { input = "X7", period_um = 20 }
        [[spindle]]
        output = "S"
        rpm = 6000
        volts = 10
        [[spindle]]
        output = "12"
        rpm = 3000
        volts = 10
        [[spindle.gear]]
        ratio = 2
    "#;
    let mut machine = Machine::from_toml(text).unwrap();
    machine.set_control_ready(true);
    machine.advance(100_000);
    machine.set_nominal(6, 5.0);
    machine.set_nominal(11, -10.0);
    machine.advance(2_000_000);
    // 1500 mm/min for 2 s are 50 mm: 2500 signal periods.
    assert!(
        (machine.encoder(6).count - 2500 * 1024).abs() <= 2,
        "{}",
        machine.encoder(6).count
    );
    assert_eq!(machine.encoder(0).count, 0);
    let turning: Vec<f64> = machine.spindles().map(|spindle| spindle.rpm).collect();
    assert!(
        turning[0] == 0.0 && (turning[1] + 1500.0).abs() < 1.0,
        "{turning:?}"
    );
    for (wrong, right) in [("\"7\"", "\"6\""), ("\"X7\"", "\"X41\"")] {
        assert!(
            Machine::from_toml(&text.replace(wrong, right)).is_err(),
            "{right}"
        );
    }
}
