//! Programs of DIN 66025 in `bahn test` and, on a machine, in `bahn run`.

use std::f64::consts::PI;
use std::fs;

use crate::support::{Folder, assert_near, machines, number};

/// The bead of `examples/bead.nc`: a frame of 110 mm by 60 mm with four corners of 10 mm.
const BEAD_MM: f64 = 40.0 + 90.0 + 40.0 + 90.0 + 4.0 * 10.0 * PI / 2.0;

fn example(name: &str) -> String {
    machines().join("../examples").join(name).display().to_string()
}

fn bead() -> String {
    example("bead.nc")
}

/// Path and place of the program, without a machine; the bead takes at least its way at 3000 mm/min.
#[test]
fn a_test_run() {
    let folder = Folder::new();
    let run = folder.bahn(&format!("test {} --start X0,Y0,Z0 --format json", bead()));
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    assert_near(number(&report, "/path_mm/feed"), BEAD_MM);
    let places = ["X", "Y", "Z"].map(|axis| number(&report, &format!("/final_position/{axis}")));
    assert_eq!(places, [0.0, 30.0, 20.0]);
    assert!(number(&report, "/machining_time_s") > BEAD_MM / 50.0);
    assert_eq!(
        report["q"],
        serde_json::json!({}),
        "these programs have no Q parameters"
    );
}

/// On the gantry M25 and M26 reach the PLC, which opens the nozzle (O14) where the bead begins and ends, at X20 Y30, and
/// acknowledges when the glue flows (I17): before that the path stands.
#[test]
fn glue_on_the_gantry() {
    let folder = Folder::new();
    let gantry = machines().join("gantry");
    let record = "--record bead.csv --signals X.nominal,Y.nominal,O14,I17";
    let run = folder.bahn(&format!(
        "run {} --machine {} --fresh --format json {record}",
        bead(),
        gantry.display()
    ));
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    assert_eq!(report["completed"], true);
    assert_near(number(&report, "/path_mm/feed"), BEAD_MM);
    let table = folder.read("bead.csv");
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let column = |name: &str| head.iter().position(|cell| cell.starts_with(name)).unwrap();
    let [x, y, nozzle, flows] = ["X.nominal", "Y.nominal", "O14", "I17"].map(column);
    let rows: Vec<Vec<f64>> = lines
        .map(|row| [x, y, nozzle, flows].map(|at| row[at].parse().unwrap()).to_vec())
        .collect();
    let changes: Vec<&Vec<f64>> = rows
        .windows(2)
        .filter(|pair| pair[0][2] != pair[1][2])
        .map(|pair| &pair[1])
        .collect();
    let places: Vec<_> = changes.iter().map(|row| (row[0], row[1], row[2])).collect();
    // The datum of the gantry lies at X800 Y400.
    assert_eq!(places, [(820.0, 430.0, 1.0), (820.0, 430.0, 0.0)]);
    let dry = rows.iter().filter(|row| row[2] == 1.0 && row[3] == 0.0);
    let apart = dry.map(|row| (row[0] - 820.0).hypot(row[1] - 430.0));
    assert_near(apart.fold(0.0, f64::max), 0.0);
}

/// What the control cannot do is refused at its block, with the control's message and the name of what can; on a machine
/// nothing of the block happens.
#[test]
fn h_functions_are_refused() {
    let folder = Folder::new();
    let glue = example("technology/glue.nc");
    let gantry = machines().join("gantry");
    for command in [
        format!("test {glue} --start X0,Y0,Z0"),
        format!("run {glue} --machine {} --fresh", gantry.display()),
    ] {
        let run = folder.bahn(&command);
        assert_eq!(run.code(), 1, "{command}: {}", run.err());
        let said = run.err();
        assert!(said.contains("FUNCTION NOT YET SUPPORTED"), "{said}");
        assert!(said.contains("N50 G01 X120 H5=4711"), "{said}");
        assert!(said.contains("`bahn technology` runs it"), "{said}");
    }
}

/// A text fault is told at its block, and M0 is a stop that is listed.
#[test]
fn faults_and_stops() {
    let folder = Folder::new();
    folder.write("a.nc", "N10 G00 X10 M0\nN20 G01 X20 F500\nN30 G77\n");
    let run = folder.bahn("test a.nc --start X0,Y0,Z0 --format json");
    assert_eq!(run.code(), 1);
    let report = run.json();
    assert_eq!(report["error"]["line"], 3);
    assert_eq!(report["error"]["block"], 30, "its number, not its place");
    assert!(run.err().contains("help: Correct the block"), "{}", run.err());
    assert_eq!(report["stops"][0]["function"], "M0");
    let stopped = folder
        .bahn("test a.nc --start X0,Y0,Z0 --stop --format json")
        .json();
    assert_eq!(stopped["final_position"]["X"], 10.0);
}

/// Subroutines lie beside the program, wherever it is chosen.
#[test]
fn subroutines_beside_the_program() {
    let folder = Folder::new();
    fs::create_dir(folder.path("parts")).unwrap();
    folder.write("parts/main.nc", "N10 G00 X10\nN20 L side\nN30 M30\n");
    folder.write("parts/side.sub", "N10 G01 X40 F1000\nN20 M17\n");
    let report = folder
        .bahn("test parts/main.nc --start X0,Y0,Z0 --format json")
        .json();
    assert_near(number(&report, "/path_mm/feed"), 30.0);
}

/// `--start-block` takes the number of the file: only the 30 mm of N35 are driven.
#[test]
fn a_start_in_the_middle() {
    let folder = Folder::new();
    folder.write(
        "a.nc",
        "N10 G01 X10 F3000\n\nN20 X100\nN35 G91 G01 Y30 F3000\nN40 M30\n",
    );
    let gantry = machines().join("gantry");
    let run = |from: &str| {
        folder.bahn(&format!(
            "run a.nc --machine {} --fresh --format json --start-block {from}",
            gantry.display()
        ))
    };
    let report = run("35").json();
    assert_eq!(report["completed"], true, "{report}");
    assert_near(number(&report, "/path_mm/feed"), 30.0);
    let refused = run("36");
    assert_eq!(refused.code(), 2);
    assert!(
        refused.err().contains("no block of a.nc has this number"),
        "{}",
        refused.err()
    );
}

/// N10 of the subroutine that stands first is not that of the program; N20 stands in the subroutine alone, where no run begins.
#[test]
fn a_start_beside_a_subroutine() {
    let folder = Folder::new();
    folder.write(
        "a.nc",
        "%L SUB\nN10 G01 Y7 F3000\nN20 M17\n%A\nN5 G01 X10 F3000\nN10 G91 G01 Y30 F3000\nN40 M30\n",
    );
    let gantry = machines().join("gantry");
    let run = |from: &str| {
        folder.bahn(&format!(
            "run a.nc --machine {} --fresh --format json --start-block {from}",
            gantry.display()
        ))
    };
    assert_near(number(&run("10").json(), "/path_mm/feed"), 30.0);
    let refused = run("20");
    assert_eq!(refused.code(), 1);
    let said = format!("{}{}", refused.out(), refused.err());
    assert!(said.contains("WRONG PROGRAM DATA"), "{said}");
    assert!(said.contains("the block stands in a subroutine"), "{said}");
}

/// A program of the control calls none of these, whatever its blocks would mean in plain language: M30 alone is one there.
#[test]
fn called_from_plain_language() {
    let folder = Folder::new();
    folder.write("main.h", "BEGIN PGM main MM\nCALL PGM side.nc\nEND PGM main MM\n");
    folder.write("side.nc", "N10 M30\n");
    for command in ["test main.h", "check main.h"] {
        let run = folder.bahn(command);
        assert_eq!(run.code(), 1, "{command}");
        let said = format!("{}{}", run.out(), run.err());
        assert!(said.contains("FUNCTION NOT YET SUPPORTED"), "{command}: {said}");
        assert!(said.contains("a program of DIN 66025"), "{command}: {said}");
    }
}
