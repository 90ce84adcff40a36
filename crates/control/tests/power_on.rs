//! Power-on, EMERGENCY STOP, reference run.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

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

/// M1500 to M1999 lie among the markers that power-off keeps, but input edges and decoded M functions are
/// the NC's: they begin at 0, so that the first M13 after power-on is an edge again.
#[test]
fn markers_of_the_nc_are_not_kept() {
    let (mut setup, mut machine) = Build::mill().setup();
    for marker in ["M1503", "M1703", "M1913", "M1100"] {
        setup.exchange.nc_set(marker.parse().unwrap(), true);
    }
    let mut control = bahn_control::Control::new(setup);
    control.command("ce".parse().unwrap());
    for _ in 0..30 {
        control.prepare();
        control.cycle(&mut machine);
    }
    let plc = control.exchange().plc();
    let bits = ["M1503", "M1703", "M1913", "M1100"].map(|marker| plc.bit(marker.parse().unwrap()));
    assert_eq!(bits, [false, false, false, true]);
}
