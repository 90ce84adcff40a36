//! Machines with a System 900: outputs and encoders are those of physical axes [002:7012-7022].

use bahn_machine::{Event, Machine};

const TEXT: &str = r#"
[emergency_stop]
acknowledgement = "I3"
[axis.X]
output = "6"
speed = 24000
volts = 9.5
encoder = { input = "X6", period_um = 4 }
[axis.S2]
[axis.Q]
output = "9"
turns = true
speed = 4320000
volts = 9.5
encoder = { input = "X9", period_um = 40 }
"#;

fn machine() -> Machine {
    let mut machine = Machine::with_numbered_axes(&TEXT.replace("[axis.S2]\n", "")).unwrap();
    machine.set_control_ready(true);
    machine.advance(20_000);
    machine
}

/// 24000 mm/min at 9.5 V for a second are 400 mm: of a scale of 4 µm 4 * 400 / 0.004 edges. The spindle, at 0.95 V, turns by a tenth of
/// 72000 degrees: 4 * 7200 / 0.04 edges.
#[test]
fn edges_are_counted() {
    let mut machine = machine();
    machine.set_nominal(5, 9.5);
    machine.set_nominal(8, 0.95);
    machine.advance(1_000_000);
    let counts = [machine.encoder(5).count, machine.encoder(8).count];
    assert!((counts[0] - 400_000).abs() <= 1, "{counts:?}");
    assert!((counts[1] - 720_000).abs() <= 1, "{counts:?}");
}

/// A drive fails by the number of its axis, and is repaired by it.
#[test]
fn a_drive_has_the_number_of_its_axis() {
    let mut machine = machine();
    let does = |machine: &mut Machine, event: &str| machine.act(&Event::parse(event).unwrap());
    does(&mut machine, "fault drive 6 dead").unwrap();
    machine.set_nominal(5, 9.5);
    machine.advance(100_000);
    assert_eq!(machine.encoder(5).count, 0);
    does(&mut machine, "repair 6").unwrap();
    machine.advance(100_000);
    assert!(machine.encoder(5).count > 30_000);
    let refused = does(&mut machine, "fault drive 1 dead").unwrap_err().to_string();
    assert!(refused.contains('1') && refused.contains("XQ"), "{refused}");
}

#[test]
fn what_is_no_axis_is_refused() {
    let faults = Machine::with_numbered_axes(&TEXT.replace("\"6\"", "\"S\"")).unwrap_err();
    let said: Vec<String> = faults.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "5:10: output is one of 1 to 40, as the physical axis",
            "9:1: `S2` is no axis: X Y Z A B C U V W D E F G H I J K L M N O P Q R T",
        ]
    );
}
