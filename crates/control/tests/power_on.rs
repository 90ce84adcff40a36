//! Power-on, EMERGENCY STOP, reference run.

mod support;

use bahn_control::Mode;
use support::*;

/// POWER INTERRUPTED waits for CE and the PLC with it; then voltage, test of the output, reference run of
/// all axes; the position of each axis is that of the machine.
#[test]
fn from_power_on_to_manual() {
    let mut rig = Build::mill().mp("7212=0").rig();
    rig.seconds(1.0);
    assert_eq!(rig.messages(), ["POWER INTERRUPTED"]);
    assert!(!rig.bit("M2487"), "the PLC does not run");
    rig.command("ce");
    rig.power_on();
    assert_eq!(rig.messages(), [""; 0]);
    let axes = rig.control.snapshot().axes;
    for axis in &axes {
        assert!(axis.referenced && axis.closed, "{axis:?}");
        let table = rig.machine.axis(axis.letter).unwrap();
        assert!(
            (axis.machine - table.position).abs() < 0.02,
            "{} {}",
            axis.machine,
            table.position
        );
    }
    assert_eq!(rig.control.snapshot().mode, Mode::Manual);
}
