//! Non-linear axis errors: the manual's tables on the bench [000:3785-3865].
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod support;

use bahn_control::{CompensationAssignment, CompensationTable, Control};
use support::bench::*;
use support::*;

/// Pitch error of Y, and Z over Y (the sag) and over itself; the points stand 6.5536 mm apart.
const Y: &str = "ACHSE-Y MM DATUM 0 DIST 16 Y Z\n0 Y=0 Z=-0.01\n2 Y=0.005 Z=-0.02\n9 Y=0.01 Z=-0.02\n";
const Z: &str = "ACHSE-Z MM DATUM 0 DIST 16 Z\n0 Z=0\n5 Z=0.005\n20 Z=0.005\n";

fn rig(mp730: u8, assignment: &str) -> Rig {
    let (mut setup, machine) = bench(
        "       L I28\n       AN M80\n       CMT 50\n       L I28\n       = M80\nLBL 50\n       SUBM 60\n       = B200\n       EM\nLBL 60\n       PS K+1\n       CM 9095\n       PL B201\n       EM\n",
    )
    .mp(&format!("730={mp730}"))
    .setup();
    setup.files.compensation = Some(CompensationAssignment::read(assignment).unwrap());
    for text in [Y, Z] {
        let name = text.split(' ').next().unwrap().to_owned();
        setup
            .files
            .compensation_tables
            .insert(name, CompensationTable::read(text).unwrap());
    }
    let mut rig = Rig {
        control: Control::new(setup),
        machine,
    };
    rig.power_on();
    rig
}

/// Brings Y to 13.1072 mm (point 2) and Z to 32.768 mm (point 5) as they are shown; how far the tables are
/// from there.
fn errors(rig: &mut Rig) -> [f64; 2] {
    rig.command("mode mdi");
    rig.command("mdi L Y+13.1072 Z+32.768 R0 F3000");
    rig.start();
    rig.seconds(5.0);
    close(rig.axis('Y').machine, 13.1072, 0.0005);
    assert_eq!(rig.messages(), [""; 0]);
    [rig.table('Y') - 13.1072, rig.table('Z') - 32.768]
}

/// The error is positive where the axis travels too far: what the scale counts is less than the way of the
/// table, and the control takes it off. Y: 0.005; Z: -0.02 of Y and 0.005 of itself.
#[test]
fn tables_of_the_active_line_are_added() {
    let [y, z] = errors(&mut rig(0b110, "0 Y=ACHSE-Y Z=ACHSE-Z\n1 Z=ACHSE-Z\nACTIVE 0\n"));
    // The scales of the bench are right: the table stands where the correction sends it.
    close(y, -0.005, 0.001);
    close(z, 0.015, 0.001);
}

/// Only axes with MP730 = 1 are corrected; without an active line none is.
#[test]
fn mp730_and_the_active_line_are_needed() {
    let [y, z] = errors(&mut rig(0b100, "0 Y=ACHSE-Y Z=ACHSE-Z\nACTIVE 0\n"));
    close(y, 0.0, 0.001);
    close(z, 0.015, 0.001);
    let [y, z] = errors(&mut rig(0b110, "0 Y=ACHSE-Y Z=ACHSE-Z\n"));
    close(y, 0.0, 0.001);
    close(z, 0.0, 0.001);
}

/// Module 9095 makes another line active: only Z over itself [000:15547-15580].
#[test]
fn module_9095_selects_a_line() {
    let mut rig = rig(0b110, "0 Y=ACHSE-Y Z=ACHSE-Z\n1 Z=ACHSE-Z\nACTIVE 0\n");
    rig.input("I28", true);
    rig.seconds(0.2);
    assert_eq!(rig.number("B201"), 0);
    assert_eq!(rig.control.compensation_line(), Some(1));
    let [y, z] = errors(&mut rig);
    close(y, 0.0, 0.001);
    close(z, -0.005, 0.001);
}
