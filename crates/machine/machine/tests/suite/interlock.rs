//! Two machines in each other's EMERGENCY STOP chain [000:18093-18099].

use bahn_machine::Machine;
use bahn_servo::INPUTS;

const TEXT: &str = "name = 'one'\n[emergency_stop]\nacknowledgement = 'I3'\npull_in_ms = 15\ndrop_out_ms = 20\n\
                    [axis.X]\noutput = '1'\nspeed = 15000\nvolts = 9\nencoder = { input = 'X1', period_um = 20 }";

/// Lets milliseconds pass for two machines that are coupled with a delay of 250 ms.
fn pass(pair: &mut [Machine; 2], milliseconds: u32) -> [bool; 2] {
    for _ in 0..milliseconds {
        let [first, second] = [pair[0].interlock(), pair[1].interlock()];
        pair[0].couple(second, 250, Some(26));
        pair[1].couple(first, 250, None);
        for machine in pair.iter_mut() {
            machine.advance(1000);
        }
    }
    [pair[0].control_voltage(), pair[1].control_voltage()]
}

fn on() -> [Machine; 2] {
    let machine = || Machine::from_toml(TEXT).unwrap();
    let mut pair = [machine(), machine()];
    for machine in &mut pair {
        machine.set_control_ready(true);
    }
    // The relays pull in after 15 ms.
    assert_eq!(pass(&mut pair, 20), [true, true]);
    pair
}

#[test]
fn button_and_supply_of_one_open_both() {
    for (stop, go_on) in [
        ("emergency press", "emergency release"),
        ("voltage off", "voltage on"),
    ] {
        for one in 0..2 {
            let mut pair = on();
            pair[one].apply(stop).unwrap();
            // 20 ms until they drop, a millisecond until the other one knows of it.
            assert_eq!(pass(&mut pair, 22), [false, false], "{stop} at {one}");
            pair[one].apply(go_on).unwrap();
            assert_eq!(pass(&mut pair, 20), [true, true], "{go_on} at {one}");
        }
    }
}

/// 40 ms off, as in a test at power-on, reach the own relay alone; what stays off stops the other one after 250 + 20 ms.
#[test]
fn a_control_that_is_not_ready_stops_the_other_one_later() {
    let mut pair = on();
    pair[0].set_control_ready(false);
    assert_eq!(pass(&mut pair, 40), [false, true]);
    pair[0].set_control_ready(true);
    assert_eq!(pass(&mut pair, 20), [true, true]);
    pair[0].set_control_ready(false);
    assert_eq!(pass(&mut pair, 245), [false, true]);
    assert_eq!(pass(&mut pair, 40), [false, false]);
}

#[test]
fn an_input_tells_of_the_voltage_of_the_other_one() {
    let mut pair = on();
    let input = |pair: &mut [Machine; 2]| {
        pass(pair, 2);
        let mut inputs = [false; INPUTS];
        pair[0].inputs(&mut inputs);
        inputs[26]
    };
    assert!(input(&mut pair));
    pair[1].apply("emergency press").unwrap();
    pass(&mut pair, 22);
    assert!(!input(&mut pair));
}
