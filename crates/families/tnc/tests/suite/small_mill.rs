//! The small mill with a TNC 360: power-on, reference run, by hand, EMERGENCY STOP, a program.

use crate::support::bench::*;
use crate::support::*;
use bahn_parameters::ControlModel;
use bahn_servo::Rotation;

fn small_mill() -> Build {
    let folder = folder("mill-tnc360");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap_or_default();
    Build {
        model: ControlModel::Tnc360,
        plant: read("plant.toml"),
        plc: read("plc/MAIN.PLC"),
        list: Some(read("parameters.mp")),
        ..Build::mill()
    }
}

#[test]
fn the_small_mill_works() {
    let mut rig = small_mill()
        .program(
            "1.H",
            "TOOL CALL 1 Z S800\nL X+60 Y+60 R0 FMAX M3\nL X+90 F500\nL M5",
        )
        .rig();
    rig.power_on();
    assert_eq!(rig.messages(), [""; 0]);
    // Positions count from the scale datum: X 374, Y 227, the first pulses outside the cams at 380 and 235.
    for (letter, mark) in [('X', 374.0), ('Y', 227.0)] {
        close(rig.machine_position(letter), rig.table(letter) - mark, 0.03);
    }
    for axis in ["X", "Y", "Z"] {
        rig.command(&format!("datum {axis} 100"));
    }
    let from = rig.table('X');
    rig.event("key X- press");
    rig.seconds(0.5);
    rig.event("key X- release");
    rig.seconds(0.5);
    assert!(rig.table('X') < from - 1.0);
    rig.event("emergency press");
    rig.seconds(0.3);
    assert!(rig.bit("M2190") && !rig.bit("M2000"));
    rig.event("emergency release");
    rig.seconds(0.3);
    rig.command("ce");
    rig.seconds(0.3);
    assert_eq!(rig.messages(), [""; 0]);
    rig.run("1.H", 120.0);
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
    close(rig.axis('X').actual, 90.0, 0.02);
}

/// MP7270 + 2: an NC stop ends S and M where it is pressed by hand. One that is held from another mode or from the TOUCH
/// PROBE menu ends nothing, and one whose M5 still waits for the run-up of M3 is over when the operator has left.
#[test]
fn nc_stop_of_another_mode_ends_nothing() {
    let turns = |rig: &Rig| rig.control.snapshot().spindle.rotation == Rotation::M3;
    let on = |starts: &dyn Fn(&Rig) -> bool| {
        let mut rig = small_mill().mp("7270=2").rig();
        rig.power_on();
        rig.command("s 500");
        rig.command("m 3");
        rig.start();
        rig.until(20.0, "M3", starts);
        rig
    };
    for [enter, leave] in [["mode mdi", "mode manual"], ["probe surface", "probe end"]] {
        let mut rig = on(&turns);
        rig.seconds(0.5);
        rig.command(enter);
        rig.event("key NC_STOP press");
        rig.seconds(0.5);
        rig.command(leave);
        rig.seconds(0.5);
        assert!(turns(&rig), "{leave}");
        // Pressed once more it is one of manual operation.
        rig.event("key NC_STOP release");
        rig.seconds(0.2);
        rig.event("key NC_STOP tap");
        rig.seconds(1.0);
        assert!(!turns(&rig), "{leave}");
    }
    let mut rig = on(&|rig| rig.bit("M2045"));
    rig.event("key NC_STOP press");
    rig.seconds(0.05);
    assert!(rig.bit("M2045"), "M3 waits for the spindle");
    rig.command("mode mdi");
    rig.event("key NC_STOP release");
    rig.seconds(3.0);
    rig.command("mode manual");
    rig.seconds(1.0);
    assert!(turns(&rig));
}

/// MP7270 + 2: after NC stop in manual operation S and M are no longer active [003:7307-7315]: the spindle that M3 has switched
/// on by hand stops; without it turns on. What was entered and not yet output is forgotten, too.
#[test]
fn nc_stop_ends_s_and_m_by_hand() {
    for (mp7270, ends) in [
        ("7270=0", false),
        ("7270=1", false),
        ("7270=2", true),
        ("7270=3", true),
    ] {
        let mut rig = small_mill().mp(mp7270).rig();
        rig.power_on();
        rig.command("s 500");
        rig.command("m 3");
        rig.start();
        let turns = |rig: &Rig| rig.control.snapshot().spindle.rotation == Rotation::M3;
        rig.until(20.0, "the spindle turns", turns);
        rig.seconds(0.5);
        rig.command("m 8");
        rig.event("key NC_STOP tap");
        rig.seconds(3.0);
        assert_eq!(turns(&rig), !ends, "{mp7270}");
        assert_eq!(rig.number("W260"), if ends { 9 } else { 3 }, "{mp7270}");
        rig.start();
        rig.seconds(1.0);
        assert_eq!(rig.number("W260"), if ends { 9 } else { 8 }, "{mp7270}");
    }
}
