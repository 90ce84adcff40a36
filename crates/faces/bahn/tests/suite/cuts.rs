//! What is said of the spindle, the tool and the place of the cut, in `bahn test` and `bahn run`.

use crate::support::Folder;
use serde_json::Value;

const BLANK: &str =
    "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+100 Y+50 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL DEF 2 L+0 R+0\n";

/// Block and text of the warnings of a program whose first four blocks are blank and tools.
fn warnings(blocks: &str, arguments: &str) -> Vec<(u64, String)> {
    let folder = Folder::with_program(&format!("{BLANK}{blocks}"));
    folder.write("left.t", "T L R DIRECT\n1 0 5 +\n2 0 0 -\n");
    let (_, report) = folder.test(arguments);
    of(&report)
}

fn of(report: &Value) -> Vec<(u64, String)> {
    let warnings = report["warnings"].as_array().unwrap();
    warnings
        .iter()
        .map(|w| {
            (
                w["block"].as_u64().unwrap(),
                w["message"].as_str().unwrap().to_owned(),
            )
        })
        .collect()
}

#[test]
fn a_cut_with_the_spindle_stopped_is_said_once_for_each_tool() {
    let stopped = "cuts while the spindle stands still";
    let seen = warnings(
        "TOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX\nL Z-2 F100\nL X+30\nL X+40\nL Z+5 FMAX",
        "",
    );
    assert_eq!(seen, [(7, format!("tool 1 {stopped}"))]);
    // M5 at the end of a block stops after it; what follows cuts no more material.
    let seen = warnings(
        "TOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL X+40 M5\nL X+20\nL X+60 M3\nL Z+5 FMAX",
        "",
    );
    assert_eq!(seen, []);
    let seen = warnings(
        "TOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL X+40 M5\nL X+60\nL X+80",
        "",
    );
    assert_eq!(seen, [(9, format!("tool 1 {stopped}"))]);
}

#[test]
fn speed_zero_and_the_wrong_way_are_said() {
    let path = "L X+20 Y+25 Z+5 R0 FMAX\nL Z-2 F100\nL X+40\nL Z+5 FMAX";
    let seen = warnings(&format!("TOOL CALL 1 Z S0\nM3\n{path}"), "");
    assert_eq!(seen, [(8, "tool 1 cuts with spindle speed 0".to_owned())]);
    let wrong = "tool 1 cuts while the spindle turns the wrong way for it";
    let program = |m: &str| format!("TOOL CALL 1 Z S1000\n{m}\n{path}");
    assert_eq!(warnings(&program("M3"), ""), []);
    assert_eq!(warnings(&program("M4"), ""), [(8, wrong.to_owned())]);
    // A left-hand tool of the table, the definitions of which the program has not.
    let left = |m: &str| {
        let folder = Folder::with_program(&format!(
            "{}\n{}",
            BLANK.split("TOOL").next().unwrap().trim(),
            program(m)
        ));
        folder.write("left.t", "T L R DIRECT\n1 0 5 +\n");
        of(&folder.test("--tools left.t").1)
    };
    assert_eq!(left("M4"), []);
    assert_eq!(left("M3"), [(6, wrong.to_owned())]);
}

#[test]
fn a_tool_without_radius_is_said_once() {
    let seen = warnings(
        "TOOL CALL 2 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL X+30\nL Z+5 FMAX",
        "",
    );
    let expected = "tool 2 has no radius: it moves through the blank and removes nothing";
    assert_eq!(seen, [(7, expected.to_owned())]);
    // Beside the blank, or above it, nobody misses a radius.
    let seen = warnings(
        "TOOL CALL 2 Z S1000\nL X+120 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL Z+5\nL X+20",
        "",
    );
    assert_eq!(seen, []);
}

#[test]
fn below_the_blank_is_one_line_for_each_tool() {
    let folder = Folder::with_program(&format!(
        "{BLANK}TOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-12 F100\nL X+30\nL X+40\nL Z+5 FMAX"
    ));
    let (_, report) = folder.test("");
    let warnings = report["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{report}");
    assert_eq!(
        warnings[0]["message"],
        "tool 1 is below the blank, last in block 10"
    );
    assert_eq!(
        (&warnings[0]["block"], &warnings[0]["count"]),
        (&7.into(), &4.into())
    );
}

/// A longer tool used to jump into the part with the first movement after its call.
#[test]
fn another_tool_does_not_jump_into_the_part() {
    let seen = warnings(
        "TOOL DEF 3 L+100 R+3\nTOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL Z+5 FMAX\n\
         TOOL CALL 3 Z S1000\nL X+80 FMAX\nL Z+2 FMAX\nL Z-2 F100",
        "",
    );
    assert_eq!(seen, []);
}

/// M91 used to lead through the part when nobody had said where that lies.
#[test]
fn machine_positions_cut_nothing_unless_the_datum_is_known() {
    let blocks = "TOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL X+0 Y+0 Z-5 FMAX M91\nL X+10 Y+10 FMAX\nL Z+5 FMAX";
    let seen = warnings(blocks, "");
    assert_eq!(seen.len(), 1, "{seen:?}");
    assert_eq!(seen[0].0, 8);
    assert!(seen[0].1.starts_with("M91 and M92 lead away"), "{seen:?}");
    // With the datum at X-70 Y-10 Z-1 the same block leads to X+70 Y+10 Z-4, through the part.
    let seen = warnings(blocks, "--datum X-70,Y-10,Z-1");
    assert_eq!(seen[0], (8, "material is removed in rapid traverse".to_owned()));
}

#[test]
fn a_run_broken_off_keeps_the_last_element() {
    let folder = Folder::with_program("L X+100 Y+100 Z+200 R0 F3000\nL X+110\nL X+120\nL X+130\nCALL LBL 9");
    let ends = |command: &str| {
        let run = folder.bahn(&format!("{command} --path path.csv"));
        assert_eq!(run.code(), 1, "{}", run.err());
        let table = folder.read("path.csv");
        let blocks = table.lines().skip(1).map(|line| line.split(',').nth(1).unwrap());
        blocks.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(ends("test main.H"), ["1", "2", "3", "4"]);
    let machine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill");
    assert_eq!(
        ends(&format!("run main.H --machine {machine} --fresh")),
        ["1", "2", "3", "4"]
    );
}

/// M112 between skew lines: the table has the arc with its centre in X, Y and Z, the machine drives the same one, the drawing
/// follows it with lines. T is 0.1 mm; directions u = (12, 0, 5) / 13 and v = (0, 8, 6) / 10 enclose acos(3/13)
/// [000:5140-5152].
#[test]
fn an_arc_in_space_in_the_table() {
    let folder = Folder::with_program(&format!(
        "{BLANK}TOOL CALL 1 Z S1000\nL X+10 Y+10 Z-8 R0 F3000 M3\nL X+22 Z-3 M112 T0.1 A10\nL Y+18 Z+3\nL M113"
    ));
    let machine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill");
    let cosine = 3.0f64 / 13.0;
    let sine = (0.5 * (1.0 + cosine)).sqrt();
    let radius = 0.1 * sine / (1.0 - sine);
    let from_corner = radius / sine / (2.0 - 2.0 * cosine).sqrt();
    let centre = [(22.0, -12.0 / 13.0), (10.0, 0.8), (-3.0, 0.6 - 5.0 / 13.0)];
    for command in [
        "test main.H".to_owned(),
        format!("run main.H --machine {machine} --fresh"),
    ] {
        let run = folder.bahn(&format!("{command} --path path.csv"));
        assert_eq!(run.code(), 0, "{}", run.err());
        let table = folder.read("path.csv");
        let rows = crate::support::rows(&table);
        let arcs: Vec<_> = rows.iter().filter(|row| row[2] == "arc").collect();
        assert_eq!(arcs.len(), 1, "{table}");
        let number = |column: usize| arcs[0][column].parse::<f64>().unwrap();
        for (column, (corner, inward)) in (13..).zip(centre) {
            let expected = corner + inward * from_corner;
            assert!((number(column) - expected).abs() < 1e-6, "{table}");
        }
        assert!((number(16) - cosine.acos().to_degrees()).abs() < 1e-6, "{table}");
    }
    let run = folder.bahn("test main.H --path path.svg");
    assert_eq!(run.code(), 0, "{}", run.err());
    let drawing = folder.read("path.svg");
    assert!(
        drawing.contains("M10 10L2") && !drawing.contains("A0"),
        "{drawing}"
    );
}

/// In the drawing the way to a place that nobody knows leads out of the blank, at its nearest side.
#[test]
fn the_drawing_shows_a_path_that_leaves() {
    let folder = Folder::with_program(&format!(
        "{BLANK}TOOL CALL 1 Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL X+90 FMAX\nL X+0 R0 FMAX M91"
    ));
    let run = folder.bahn("test main.H --path path.svg");
    assert_eq!(run.code(), 0, "{}", run.err());
    // From X+20 to X+90, then from there to 5 % of 100 mm beyond the side at X+100.
    let drawing = folder.read("path.svg");
    assert!(drawing.contains("M20 25L90 25L105 25"), "{drawing}");
}

#[test]
fn the_machine_says_so_too() {
    let machine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill");
    let folder = Folder::with_program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+100 Y+50 Z+0\nTOOL CALL 1 Z S1000\n\
         L X+20 Y+25 Z+50 R0 FMAX\nL Z-2 F1000\nL X+40\nL Z+50 FMAX",
    );
    let run = folder.bahn(&format!("run main.H --machine {machine} --fresh --format json"));
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        of(&run.json()),
        [(5, "tool 1 cuts while the spindle stands still".to_owned())]
    );
}

/// On the machine the spindle itself counts, not M3: with its drive wired the wrong way it turns as with M4, and when
/// the override is turned down to 0 (MP3310.1 = 0) during the dwell it stands.
#[test]
fn the_spindle_of_the_machine_counts() {
    let machine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill");
    let blocks = "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+100 Y+50 Z+0\nTOOL CALL 1 Z S1000\n\
         L X+20 Y+25 Z+50 R0 FMAX M3\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 30\nL Z-2 F1000\nL X+60\n\
         L Z+50 FMAX";
    let seen = |script: &str| {
        let folder = Folder::with_program(blocks);
        folder.write("s.txt", script);
        let run = folder.bahn(&format!(
            "run main.H --machine {machine} --fresh --format json --script s.txt --mp 3310.1=0"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
        of(&run.json())
    };
    let said = |what: &str| [(7, format!("tool 1 cuts while the spindle {what}"))];
    assert_eq!(seen(""), []);
    assert_eq!(
        seen("0: fault drive S reversed\n"),
        said("turns the wrong way for it")
    );
    assert_eq!(seen("start+20: override spindle 0\n"), said("stands still"));
}

/// A drill of the program gets its point by an option: a cylinder, and the cone under it with its tip at Z-8.
#[test]
fn a_defined_drill_has_the_point_of_an_option() {
    let blocks =
        format!("{BLANK}TOOL CALL 1 Z S1000\nL Z+5 R0 FMAX M3\nL X+50 Y+25 FMAX\nL Z-8 F100\nL Z+5 FMAX");
    let folder = Folder::with_program(&blocks);
    let (radius, depth) = (5.0f64, 8.0);
    let tip = radius / 59.0f64.to_radians().tan();
    let area = std::f64::consts::PI * radius * radius;
    for (option, expected) in [
        ("", area * depth),
        (
            "--point-angle 1=118,2=90",
            area * (depth - tip) + area * tip / 3.0,
        ),
    ] {
        let (code, report) = folder.test(&format!("--resolution 0.05 {option}"));
        let removed = report["removed_mm3"].as_f64().unwrap();
        assert_eq!(code, 0, "{report}");
        assert!(
            (removed / expected - 1.0).abs() < 2e-3,
            "{removed} is not {expected}"
        );
    }
    for wrong in ["1", "1=4", "1=180", "x=90"] {
        assert_eq!(
            folder.bahn(&format!("test main.H --point-angle {wrong}")).code(),
            2
        );
    }
}
