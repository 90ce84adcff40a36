//! Programs with the later functions in the product: cycles of the machine builder from files, thread cutting, contour
//! data, surface normals; read, checked, formatted and executed.

use crate::support::Folder;

/// A program with every one of them, and two cycles of the machine builder: 68 in the program memory, 69 in the EPROM.
fn folder() -> Folder {
    let folder = Folder::with_program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-40
BLK FORM 0.2 X+100 Y+100 Z+0
TOOL DEF 1 L+0 R+5
TOOL CALL 1 Z S1000
L X+0 Y+0 Z+50 R0 FMAX M3
CYCL DEF 69.0 SHIFT
CYCL DEF 69.1 Q1=+5
CYCL DEF 68.0 DRILL
CYCL DEF 68.1 Q1=-10 Q2=+100
L X+20 Y+20 FMAX M99
CYCL DEF 26.0 AXIS-SPEC. SCALING
CYCL DEF 26.1 X1.5 Y1.5 CCX+50 CCY+50
CYCL DEF 14.0 CONTOUR GEOMETRY
CYCL DEF 14.1 CONTOUR LABEL 1
CYCL DEF 20.0 CONTOUR DATA
CYCL DEF 20.1 Q1=-5 Q2=+1 Q3=+0
CYCL DEF 20.2 Q4=+0 Q5=+0 Q6=+2
CYCL DEF 20.3 Q7=+20 Q8=+0 Q9=+1
CYCL DEF 22.0 ROUGH-OUT
CYCL DEF 22.1 Q10=-5 Q11=+100 Q12=+350
CYCL CALL
LN X+50 Y+50 Z+20 NX+0 NY+0 NZ+1 F1000
CC X+50 Y+50
L X+60 Y+50 C+0 F500
C X+50 Y+60 C+90 DR+
CYCL DEF 18.0 THREAD CUTTING
CYCL DEF 18.1 DEPTH -10
CYCL DEF 18.2 PITCH +1.5
CYCL CALL
L Z+50 FMAX M2
LBL 1
L X+40 Y+40 RL
L X+60
L Y+60
L X+40
L Y+40
LBL 0",
    );
    folder.write(
        "99999968.H",
        "0 BEGIN PGM 99999968 MM\n1 DLG-CALL 0/1/2\n2 L Z+2 R0 FMAX\n3 L Z+Q1 FQ2\n4 L Z+50 FMAX\n5 END PGM 99999968 MM\n",
    );
    std::fs::create_dir(folder.path("eprom")).unwrap();
    folder.write(
        "eprom/99999969.H",
        "0 BEGIN PGM 99999969 MM\n1 DLG-DEF 0/1\n2 CYCL DEF 7.0 DATUM SHIFT\n3 CYCL DEF 7.1 X+Q1\n4 END PGM 99999969 MM\n",
    );
    folder
}

#[test]
fn later_functions_are_read_formatted_checked_and_executed() {
    let folder = folder();
    let fine = |command: &str| {
        let run = folder.bahn(command);
        assert_eq!(run.code(), 0, "{command}: {}{}", run.out(), run.err());
        run.out()
    };
    fine("check main.H --strict");
    let once = fine("fmt main.H");
    folder.write("again.H", &once);
    assert_eq!(fine("fmt again.H"), once);
    let report = fine("test main.H --path path.csv");
    assert!(!report.contains("warning"), "{report}");
    // Cycle 69 of the EPROM has shifted X by 5, cycle 68 drills there to Z-10.
    let path = folder.read("path.csv");
    let mut lines = path.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|title| *title == name);
    let columns = ["X", "Y", "Z"].map(|name| column(name).unwrap_or_else(|| panic!("{header:?}")));
    let drilled = lines.any(|line| {
        let fields: Vec<f64> = line
            .split(',')
            .map(|field| field.parse().unwrap_or(f64::NAN))
            .collect();
        let expected = [25.0, 20.0, -10.0];
        columns
            .iter()
            .zip(expected)
            .all(|(column, value)| (fields[*column] - value).abs() < 1e-6)
    });
    assert!(drilled, "{path}");
}

/// A cycle whose program is nowhere.
#[test]
fn a_missing_cycle_is_named() {
    let folder = folder();
    std::fs::remove_file(folder.path("eprom/99999969.H")).unwrap();
    let run = folder.bahn("check main.H");
    assert_ne!(run.code(), 0);
    let said = run.out() + &run.err();
    assert!(said.contains("there is no program 99999969"), "{said}");
}
