//! Power-on, EMERGENCY STOP, reference run.

use crate::support::*;
use bahn_tnc::Mode;

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

/// EMERGENCY STOP on the mill while the program runs and the spindle turns: the spindle gets no voltage any
/// more; after CE the program goes on to its end.
#[test]
fn emergency_stop_on_the_mill() {
    let mut rig = Build::mill()
        .program(
            "1.H",
            "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nL X+400 F2000\nL X+200\nL Z+250 FMAX M5",
        )
        .rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(60.0, "X is on its way", |rig| {
        rig.machine_position('X') > 250.0 && rig.bit("M2128")
    });
    rig.event("emergency press");
    rig.seconds(5.0);
    assert!(rig.messages().contains(&"EXTERNAL EMERGENCY STOP".to_owned()));
    assert_eq!(rig.control.snapshot().spindle.volts, 0.0);
    rig.event("emergency release");
    rig.seconds(0.5);
    while !rig.messages().is_empty() {
        rig.command("ce");
        rig.seconds(0.1);
    }
    rig.start();
    rig.until(120.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(0.5);
    assert!((rig.machine_position('X') - 200.0).abs() < 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// By hand on the mill: the axis keys move, LATCH lets an axis run on, the software limit stops it before
/// the limit switch.
#[test]
fn by_hand_on_the_mill() {
    let mut rig = Build::mill().rig();
    rig.power_on();
    rig.event("key RAPID press");
    rig.event("key LATCH press");
    rig.event("key Y+ tap");
    rig.seconds(0.5);
    rig.event("key LATCH release");
    rig.seconds(4.0);
    let table = rig.machine.axis('Y').unwrap().position;
    assert!((table - 410.0).abs() < 0.02, "{table}");
    assert_eq!(rig.messages(), ["LIMIT SWITCH Y+"]);
    assert!(rig.machine.control_voltage());
}

/// M1500 to M1999 lie among the markers that power-off keeps, but input edges and decoded M functions are
/// the NC's: they begin at 0, so that the first M13 after power-on is an edge again.
#[test]
fn markers_of_the_nc_are_not_kept() {
    let (mut setup, mut machine) = Build::mill().setup();
    for marker in ["M1503", "M1703", "M1913", "M1100"] {
        setup.exchange.nc_set(marker.parse().unwrap(), true);
    }
    let mut control = bahn_tnc::Control::new(setup);
    control.command("ce".parse().unwrap());
    for _ in 0..30 {
        control.prepare();
        control.cycle(&mut machine);
    }
    let plc = control.exchange().plc();
    let bits = ["M1503", "M1703", "M1913", "M1100"].map(|marker| plc.bit(marker.parse().unwrap()));
    assert_eq!(bits, [false, false, false, true]);
}

/// A low battery is said at once, and the run of the machine goes on; CE clears the message until the next power-on. It can
/// be exchanged with the supply off: what is remembered is kept, and nothing is said any more.
#[test]
fn a_low_buffer_battery_is_said_until_it_is_exchanged() {
    const LOW: &str = "EXCHANGE BUFFER BATTERY";
    let mut rig = Build::mill().rig();
    rig.power_on();
    rig.command("B126=7");
    rig.event("fault battery");
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [LOW]);
    assert!(
        rig.bit("M2190") && rig.bit("M2000"),
        "it is said, and the loops stay closed"
    );
    rig.command("ce");
    rig.seconds(0.5);
    assert_eq!(rig.messages(), [""; 0], "it is said once");

    rig.command("power off");
    rig.seconds(1.0);
    assert_eq!(rig.messages(), [""; 0]);
    rig.command("power on");
    rig.seconds(0.1);
    assert!(rig.messages().contains(&LOW.to_owned()));
    rig.command("power off");
    rig.event("repair battery");
    rig.seconds(1.0);
    rig.command("power on");
    rig.seconds(0.1);
    assert!(!rig.messages().contains(&LOW.to_owned()));
    assert_eq!(rig.number("B126"), 7);
    // The next one may be low, too.
    rig.event("fault battery");
    rig.seconds(0.1);
    assert!(rig.messages().contains(&LOW.to_owned()));
}
