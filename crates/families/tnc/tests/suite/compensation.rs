//! Non-linear axis errors: the manual's tables on the bench [000:3785-3865].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::{
    CompensationAssignment, CompensationFiles, CompensationTable, Control, CorrectionTables, Remembered,
    Renewed,
};

/// Pitch error of Y, and Z over Y (the sag) and over itself; the points stand 6.5536 mm apart.
const Y: &str = "ACHSE-Y MM DATUM 0 DIST 16 Y Z\n0 Y=0 Z=-0.01\n2 Y=0.005 Z=-0.02\n9 Y=0.01 Z=-0.02\n";
const Z: &str = "ACHSE-Z MM DATUM 0 DIST 16 Z\n0 Z=0\n5 Z=0.005\n20 Z=0.005\n";

fn rig(mp730: u8, assignment: &str) -> Rig {
    let read = CompensationAssignment::read(assignment).unwrap();
    rig_with(mp730, Some(read), None)
}

fn rig_with(mp730: u8, assignment: Option<CompensationAssignment>, old: Option<CorrectionTables>) -> Rig {
    kept_rig(mp730, assignment, old, Remembered::default())
}

fn kept_rig(
    mp730: u8,
    assignment: Option<CompensationAssignment>,
    old: Option<CorrectionTables>,
    remembered: Remembered,
) -> Rig {
    let (mut setup, machine) = bench(
        "       L I28\n       AN M80\n       CMT 50\n       L I28\n       = M80\nLBL 50\n       SUBM 60\n       = B200\n       EM\nLBL 60\n       PS K+1\n       CM 9095\n       PL B201\n       EM\n",
    )
    .mp(&format!("730={mp730}"))
    .setup();
    setup.remembered = remembered;
    setup.files.compensation = assignment;
    setup.files.correction_tables = old;
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

/// CLEAR ACTIV LINE, and files that go: what is compensated no more is corrected no more, at once, where the axis stands.
#[test]
fn without_an_active_line_the_correction_ends() {
    let mut rig = rig(0b110, "0 Y=ACHSE-Y Z=ACHSE-Z\nACTIVE 0\n");
    let [y, z] = errors(&mut rig);
    close(y, -0.005, 0.001);
    close(z, 0.015, 0.001);
    let assignment = CompensationAssignment::read("0 Y=ACHSE-Y Z=ACHSE-Z\n").unwrap();
    let files = CompensationFiles {
        assignment: Some(assignment),
        ..CompensationFiles::default()
    };
    assert!(rig.control.renew(Renewed::Compensation(Box::new(files))));
    rig.seconds(1.0);
    close(rig.axis('Y').machine, 13.1072, 0.0005);
    close(rig.table('Y'), 13.1072, 0.001);
    close(rig.table('Z'), 32.768, 0.001);
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

/// The line of module 9095 is the active one after a control reset, too [000:15555]; when the file names another one than
/// it did, or lacks the line, the file counts.
#[test]
fn the_line_of_module_9095_survives_power_off() {
    let lines = "0 Y=ACHSE-Y Z=ACHSE-Z\n1 Z=ACHSE-Z\n";
    let mut rig = rig(0b110, &format!("{lines}ACTIVE 0\n"));
    rig.control.stored();
    rig.input("I28", true);
    rig.seconds(0.2);
    let kept = rig.control.unsaved().expect("a selected line is stored");
    for (file, line) in [
        (format!("{lines}ACTIVE 0\n"), Some(1)),
        (lines.to_owned(), None),
        (format!("{lines}2 Y=ACHSE-Y\nACTIVE 2\n"), Some(2)),
        ("0 Y=ACHSE-Y Z=ACHSE-Z\nACTIVE 0\n".to_owned(), Some(0)),
    ] {
        let read = CompensationAssignment::read(&file).unwrap();
        let rig = kept_rig(0b110, Some(read), None, kept.clone());
        assert_eq!(rig.control.compensation_line(), line, "{file}");
    }
    let read = CompensationAssignment::read(&format!("{lines}ACTIVE 0\n")).unwrap();
    let [y, z] = errors(&mut kept_rig(0b110, Some(read), None, kept));
    close(y, 0.0, 0.001);
    close(z, -0.005, 0.001);
}

/// Correction tables of code number 105 296 with spacing 6.5536 mm: Y over itself 0.002 mm at point 2 (13.1072 mm), Z over
/// Y -0.001 mm for each point up to 10.
fn old_tables() -> CorrectionTables {
    let mut text = String::new();
    for (head, slope) in [("Y OVER Y", 0.001), ("Z OVER Y", -0.001)] {
        text += &format!("{head} MM DATUM 0 DIST 16\n");
        for point in 0..64 {
            text += &format!("{point} {}\n", slope * f64::from(point.min(10)));
        }
    }
    CorrectionTables::read(&text).unwrap()
}

/// They apply where MP730 selects them and there is no assignment; with one, even one without an active line, they do
/// not [000:3887].
#[test]
fn correction_tables_apply_without_an_assignment() {
    let [y, z] = errors(&mut rig_with(0b110, None, Some(old_tables())));
    close(y, -0.002, 0.0008);
    close(z, 0.002, 0.0008);
    let [y, z] = errors(&mut rig_with(0b100, None, Some(old_tables())));
    close(y, 0.0, 0.0008);
    close(z, 0.002, 0.0008);
    let none_active = CompensationAssignment::read("0 Y=ACHSE-Y\n").unwrap();
    let [y, z] = errors(&mut rig_with(0b110, Some(none_active), Some(old_tables())));
    close(y, 0.0, 0.0008);
    close(z, 0.0, 0.0008);
}

/// Module 9095 finds no assignment, so no line: the tables stay (error 2, no .CMA file [000:15547-15580]).
#[test]
fn module_9095_has_no_say_in_correction_tables() {
    let mut rig = rig_with(0b110, None, Some(old_tables()));
    rig.input("I28", true);
    rig.seconds(0.2);
    assert_ne!(rig.number("B201"), 0);
    let [y, _] = errors(&mut rig);
    close(y, -0.002, 0.0008);
}

#[test]
fn faulty_correction_tables_are_refused_at_their_line() {
    let points = |count: usize| (0..count).map(|point| format!("{point} 0\n")).collect::<String>();
    let head = "X OVER X MM DATUM 0 DIST 16\n";
    for (text, line, what) in [
        ("0 0\n".to_owned(), 1, "a table begins with AXIS OVER AXIS"),
        (
            "\nX OVER W MM DATUM 0 DIST 16\n".to_owned(),
            2,
            "a table begins with AXIS OVER AXIS",
        ),
        (head.replace("16", "24") + &points(64), 1, "DIST is 0 to 23"),
        (
            head.replace("16", "4000000000") + &points(64),
            1,
            "DIST is 0 to 23",
        ),
        (head.to_owned() + &points(63), 1, "a table has 64 points"),
        (head.to_owned() + &points(65), 66, "the points are 0 to 63"),
        (head.to_owned() + "1 0\n", 2, "the points are 0 to 63"),
        (head.to_owned() + "0 nan\n", 2, "the value is no number"),
        (head.to_owned() + "0 0 0\n", 2, "a point is its number"),
        // A 64th of 6.5536 mm is 0.1024 mm.
        (
            head.to_owned() + "0 0\n1 0.1024\n2 -0.0001\n",
            4,
            "a 64th of the spacing",
        ),
        (
            (head.to_owned() + &points(64)).repeat(2),
            66,
            "an axis has one table only",
        ),
    ] {
        let fault = CorrectionTables::read(&text).unwrap_err();
        assert_eq!(fault.line, line, "{text}: {fault}");
        assert!(fault.what.contains(what), "{fault}");
    }
    assert_eq!(CorrectionTables::read("").unwrap(), CorrectionTables::default());
}
