//! TCH PROBE 5 to 7 in a test run: a part is machined, digitized, and machined again from its points.

use std::collections::BTreeMap;

use crate::support::*;
use serde_json::json;

/// The ball of tool 1 is larger than the stylus and cutter 2: it leaves no corner that those do not reach.
const TOOLS: &str = "T L R R2 NAME\n1 100 4 4 BALL 8\n2 100 3 3 BALL 6\n";

const BLANK: &str = "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+40 Y+30 Z+0\n";

/// A groove that rises, one across it, and the stylus above.
const PART: &str = "TOOL CALL 1 Z S1000
L X+8 Y+15 Z+10 R0 FMAX M3
L Z-9 F200
L X+30 Z-3
L Z+10 FMAX
L X+20 Y+6 FMAX
L Z-5 F200
L Y+24
L Z+50 FMAX M5
TOOL CALL 2 Z S1000
";

const RANGE: &str = "TCH PROBE 5.0 RANGE
TCH PROBE 5.1 PGM NAME: 5007
TCH PROBE 5.2 Z X+0 Y+0 Z-20
TCH PROBE 5.3 X+40 Y+30 Z+1
TCH PROBE 5.4 HEIGHT: +20
";

const MEANDER: &str = "TCH PROBE 6.0 MEANDER
TCH PROBE 6.1 DIRECTN: X
TCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 0.5 P.P. INT: 0.5
";

fn folder(blocks: &str) -> Folder {
    let folder = Folder::new();
    folder.write("tools.txt", TOOLS);
    folder.write("main.H", program(blocks));
    folder
}

/// Heights of the upper side of a mesh on a grid of half a millimetre, by the number of the point.
fn heights(mesh: &[u8]) -> BTreeMap<(i32, i32), f64> {
    let float = |at: usize| f64::from(f32::from_le_bytes(mesh[at..at + 4].try_into().unwrap()));
    let mut heights = BTreeMap::new();
    for triangle in 0..(mesh.len() - 84) / 50 {
        let at = 84 + 50 * triangle + 12;
        let [a, b, c] = [0, 12, 24].map(|corner| [0, 4, 8].map(|k| float(at + corner + k)));
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let det = u[0] * v[1] - u[1] * v[0];
        if det.abs() < 1e-9 {
            continue;
        }
        let range = |k: usize| {
            let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
            ((low - 0.25) * 2.0).ceil() as i32..=((high - 0.25) * 2.0).floor() as i32
        };
        for i in range(0) {
            for j in range(1) {
                let p = [f64::from(i) / 2.0 + 0.25 - a[0], f64::from(j) / 2.0 + 0.25 - a[1]];
                let s = (p[0] * v[1] - p[1] * v[0]) / det;
                let t = (u[0] * p[1] - u[1] * p[0]) / det;
                if s >= -1e-6 && t >= -1e-6 && s + t <= 1.0 + 1e-6 {
                    let height = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]);
                    let slot = heights.entry((i, j)).or_insert(f64::NEG_INFINITY);
                    *slot = slot.max(height);
                }
            }
        }
    }
    heights
}

/// The digitized program, executed with a cutter like the stylus, makes the same surface: at each point within 0.06 mm of
/// what the model has within 0.5 mm around it (steep flanks stand within a column of the map).
#[test]
fn a_part_is_digitized_and_machined_again() {
    let folder = folder(&format!("{BLANK}{PART}{RANGE}{MEANDER}"));
    let options = "--tools tools.txt --resolution 0.2";
    let (code, report) = folder.test(&format!("{options} --mesh model.stl --digitized ."));
    assert_eq!(code, 0, "{report}");
    let text = folder.read("5007.H");
    assert!(
        text.starts_with("0 BEGIN PGM 5007 MM\n1 L Z+20 FMAX\n2 L X+0 Y+0 FMAX\n3 L "),
        "{text}"
    );
    assert!(text.ends_with(" L Z+20 FMAX\n") || text.trim_end().ends_with("END PGM 5007 MM"));
    // 61 lines of 40 mm with points that lie 0.5 mm apart at most.
    assert!(text.lines().count() > 61 * 80, "{}", text.lines().count());
    let again = format!("{BLANK}TOOL CALL 2 Z S1000\nL Z+50 R0 FMAX M3\nL X+0 Y+0 F500\nCALL PGM 5007\n");
    folder.write("main.H", program(&again));
    let (code, report) = folder.test(&format!("{options} --mesh copy.stl"));
    assert_eq!(code, 0, "{report}");
    let [model, copy] =
        ["model.stl", "copy.stl"].map(|name| heights(&std::fs::read(folder.path(name)).unwrap()));
    let mut deepest = 0.0_f64;
    let mut compared = 0;
    for i in 2..78 {
        for j in 2..58 {
            let around = (-1..=1).flat_map(|k| (-1..=1).map(move |l| (i + k, j + l)));
            let around: Vec<f64> = around.map(|at| model[&at]).collect();
            let low = around.iter().copied().fold(f64::INFINITY, f64::min);
            let high = around.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let height = copy[&(i, j)];
            assert!(
                low - 0.06 <= height && height <= high + 0.06,
                "at {i} {j}: {height} is not within {low} and {high}"
            );
            deepest = deepest.min(height);
            compared += 1;
        }
    }
    assert!(compared > 4000 && deepest < -8.5, "{compared} {deepest}");
}

/// A stud of 14 mm radius, cut around with a ball of 4 mm.
const STUD: &str = "BLK FORM 0.1 Z X-20 Y-20 Z-10\nBLK FORM 0.2 X+20 Y+20 Z+0\nTOOL CALL 1 Z S1000
L X+18 Y+0 Z+10 R0 FMAX M3\nL Z-10 F200\nCC X+0 Y+0\nC X+18 Y+0 DR-\nL X+23\nL Y+23\nL X-23\nL Y-23\nL X+23\nL Y+19
L X-19\nL Y-19\nL X+19\nL Y+19\nL Z+50 FMAX M5\nTOOL CALL 2 Z S1000
";

const RING: &str = "TCH PROBE 5.0 RANGE\nTCH PROBE 5.1 PGM NAME: RING\nTCH PROBE 5.2 Z X-19 Y-19 Z-4\nTCH PROBE 5.3 X+19 Y+19 Z-2
TCH PROBE 5.4 HEIGHT: +10\nTCH PROBE 7.0 CONTOUR LINES\nTCH PROBE 7.1 TIME: 600 X+0 Y-18.5
TCH PROBE 7.2 ORDER Y+/X+\nTCH PROBE 7.3 TRAVEL: 0.5 L.SPAC: +1 P.P. INT: 1\n";

/// A stud is orbited level by level; each orbit ends within a quarter of the interval of where it began.
#[test]
fn a_stud_is_digitized_in_contour_lines() {
    let folder = folder(&format!("{STUD}{RING}"));
    let (code, report) = folder.test("--tools tools.txt --resolution 0.1 --digitized .");
    assert_eq!(code, 0, "{report}");
    let text = folder.read("RING.H");
    // Three levels at Z -4, -3 and -2; the ball of 3 mm orbits the stud of 14 mm radius at 17 mm.
    let mut at = [0.0_f64; 3];
    let mut levels: BTreeMap<i64, Vec<[f64; 3]>> = BTreeMap::new();
    for line in text
        .lines()
        .filter(|line| line.contains(" L ") && !line.contains("FMAX"))
    {
        for word in line.split_whitespace().skip(2) {
            let axis = ["X", "Y", "Z"]
                .iter()
                .position(|axis| word.starts_with(axis))
                .unwrap();
            at[axis] = word[1..].parse().unwrap();
        }
        levels
            .entry((at[2] * 1000.0).round() as i64)
            .or_default()
            .push(at);
    }
    assert_eq!(levels.keys().copied().collect::<Vec<_>>(), [-4000, -3000, -2000]);
    for (level, points) in &levels {
        // On the highest level the centre of the ball stands 1 mm above the face: it touches the edge.
        let expected = if *level == -2000 { 14.0 + 8f64.sqrt() } else { 17.0 };
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!(
            (first[0] - last[0]).hypot(first[1] - last[1]) <= 0.25,
            "{first:?} {last:?}"
        );
        for pair in points.windows(2) {
            let way = (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]);
            assert!(way <= 1.05, "{pair:?}");
        }
        for point in points {
            let radius = point[0].hypot(point[1]);
            assert!((radius - expected).abs() < 0.15, "{point:?}: {radius}");
        }
    }
}

/// An orbit of 107 mm at 5 mm/s takes more than 20 s.
#[test]
fn an_orbit_must_end_in_time() {
    let folder = folder(&format!("{STUD}{}", RING.replace("TIME: 600", "TIME: 15")));
    let (code, report) = folder.test("--tools tools.txt --digitized .");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("TIME LIMIT EXCEEDED"))
    );
}

/// Cycles that are wrong, or do not fit the surface, and the message of the manual.
fn faulty() -> Vec<(String, &'static str)> {
    let meander = |range: &str| format!("{BLANK}TOOL CALL 2 Z S1000\n{range}{MEANDER}");
    let lines = |blocks: &str| {
        let spaced = "TCH PROBE 7.3 TRAVEL: 0.5 L.SPAC: 1 P.P. INT: 1\n";
        format!("{BLANK}TOOL CALL 2 Z S1000\n{RANGE}TCH PROBE 7.0 CONTOUR LINES\n{blocks}{spaced}")
    };
    let order = "TCH PROBE 7.2 ORDER Y+/X+\n";
    vec![
        (meander(""), "FAULTY RANGE DATA"),
        (meander(&RANGE.replace("X+40", "X+0")), "FAULTY RANGE DATA"),
        (
            meander(&RANGE.replace("HEIGHT: +20", "HEIGHT: +0")),
            "FAULTY RANGE DATA",
        ),
        (meander(&RANGE.replace("5.2 Z", "5.2 Y")), "WRONG AXIS PROGRAMMED"),
        (
            meander(RANGE).replace("DIRECTN: X", "DIRECTN: Z"),
            "WRONG AXIS PROGRAMMED",
        ),
        (
            meander(RANGE).replace("L.SPAC: 0.5", "L.SPAC: 6"),
            "ENTRY VALUE INCORRECT",
        ),
        (
            meander(RANGE).replace("TRAVEL: 0.5", "TRAVEL: 0.05"),
            "ENTRY VALUE INCORRECT",
        ),
        (
            meander(&RANGE.replace("5007", "../5007")),
            "ENTRY VALUE INCORRECT",
        ),
        // Nothing of the surface lies below Z -1; all of it above; the surface leaves the range.
        (
            meander(&RANGE.replace("Z-20", "Z+0.5")),
            "TOUCH POINT INACCESSIBLE",
        ),
        (meander(&RANGE.replace("Z+1", "Z-1")), "TOUCH POINT INACCESSIBLE"),
        (meander(&RANGE.replace("X+40", "X+60")), "RANGE EXCEEDED"),
        (
            format!(
                "{BLANK}CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +5\nTOOL CALL 2 Z S1000\n{RANGE}{MEANDER}"
            ),
            "ROTATION NOT PERMITTED",
        ),
        (
            meander(RANGE).replace(
                "TCH PROBE 5.0",
                "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nTCH PROBE 5.0",
            ),
            "MIRRORING NOT PERMITTED",
        ),
        (
            meander(RANGE).replace(
                "TCH PROBE 5.0",
                "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2\nTCH PROBE 5.0",
            ),
            "SCALING FACTOR NOT ALLOWED",
        ),
        (
            lines(&format!("TCH PROBE 7.1 TIME: 0 X+50 Y+0\n{order}")),
            "START POSITION INCORRECT",
        ),
        (
            lines(&format!("TCH PROBE 7.1 TIME: 0 X+5 X+0\n{order}")),
            "AXIS DOUBLE PROGRAMMED",
        ),
        (
            lines(&format!("TCH PROBE 7.1 TIME: 0 X+5 Z+0\n{order}")),
            "PLANE WRONGLY DEFINED",
        ),
        (
            lines("TCH PROBE 7.1 TIME: 0 X+5 Y+5\nTCH PROBE 7.2 ORDER Y+/Y-\n"),
            "WRONG AXIS PROGRAMMED",
        ),
    ]
}

/// What is wrong with the cycles is said at their block: FAULTY RANGE DATA, RANGE EXCEEDED, START POSITION INCORRECT,
/// ROTATION NOT PERMITTED, MIRRORING NOT PERMITTED, SCALING FACTOR NOT ALLOWED and others.
#[test]
fn faulty_cycles_are_refused() {
    for (blocks, message) in faulty() {
        let folder = folder(&blocks);
        let (code, report) = folder.test("--tools tools.txt --digitized .");
        assert_eq!(
            (code, &report["error"]["message"]),
            (1, &json!(message)),
            "{blocks}"
        );
        // What was not digitized to its end leaves no program.
        assert_eq!(folder.names(), ["main.H", "tools.txt"], "{blocks}");
    }
}

/// MP6210 feed, MP6220 and MP6221 lubrication, MP6230 feed across, MP6240 greatest deflection, MP6260 M90, MP6270 decimals.
#[test]
fn the_parameters_of_digitizing_act() {
    let folder = folder(&format!("{BLANK}{PART}{RANGE}{MEANDER}").replace("L.SPAC: 0.5", "L.SPAC: 5"));
    let digitized = |parameters: &str| {
        let (code, report) = folder.test(&format!("--tools tools.txt --digitized . {parameters}"));
        assert_eq!(code, 0, "{parameters}: {report}");
        (number(&report, "/machining_time_s"), folder.read("5007.H"))
    };
    let (time, text) = digitized("");
    let blocks = |text: &str| text.lines().filter(|line| !line.contains("FMAX")).count() - 2;
    // Five points a second.
    let points = blocks(&text) as f64;
    assert!(
        points / 6.0 < time && time < points / 2.0,
        "{points} points in {time} s"
    );
    // Ten a second: about half the time.
    let (faster, _) = digitized("--mp 6210=10");
    assert!(faster < 0.7 * time, "{faster} {time}");
    // At the end of each of 7 lines 10 mm up at 2000 mm/min and down at 200 mm/min: 0.3 and 3 s, and the ramps to 33.3 and
    // 3.3 mm/s and back at 1 m/s²: 0.033 and 0.003 s.
    let (time_200, _) = digitized("--mp 6120=200,6150=2000");
    let (lubricated, _) = digitized("--mp 6120=200,6150=2000,6220=10,6221=0");
    let expected = 7.0 * (3.3 + 0.0367);
    assert!(
        (lubricated - time_200 - expected).abs() < 0.5,
        "{lubricated} {time_200}"
    );
    // Later than the scan takes it is not lubricated.
    assert_eq!(digitized("--mp 6220=10,6221=60000").0, time);
    let (_, m90) = digitized("--mp 6260=1");
    assert_eq!(
        m90.lines().filter(|line| line.ends_with(" M90")).count(),
        blocks(&text)
    );
    let (_, coarse) = digitized("--mp 6270=1");
    let decimals = |text: &str| {
        let words = text
            .lines()
            .filter(|line| line.contains(" L "))
            .flat_map(str::split_whitespace);
        let decimals = words
            .filter_map(|word| word.split_once('.'))
            .map(|(_, decimals)| decimals.len());
        decimals.max().unwrap()
    };
    assert_eq!(
        (
            decimals(&text),
            decimals(&coarse),
            decimals(&digitized("--mp 6270=2").1)
        ),
        (3, 2, 4)
    );
    // A slower way across needs farther corners; a stylus that may be deflected less retracts along its axis.
    assert_ne!(digitized("--mp 6230=10").1, text);
    assert_ne!(digitized("--mp 6240=0.2").1, text);
}

/// A roof as a mesh: X 0 to 20, Y 0 to 10, its ridge at X 10 and Z -1, its eaves at Z -5.
const ROOF: &str = "solid roof\nvertex 0 0 -5\nvertex 10 0 -1\nvertex 10 10 -1\nvertex 0 0 -5\nvertex 10 10 -1\n\
    vertex 0 10 -5\nvertex 10 0 -1\nvertex 20 0 -5\nvertex 10 10 -1\nvertex 10 10 -1\nvertex 20 0 -5\nvertex 20 10 -5\n\
    endsolid\n";

const ROOF_RANGE: &str = "TCH PROBE 5.0 RANGE\nTCH PROBE 5.1 PGM NAME: ROOF\nTCH PROBE 5.2 Z X+4 Y+3 Z-6
TCH PROBE 5.3 X+16 Y+5 Z+1\nTCH PROBE 5.4 HEIGHT: +5\nTCH PROBE 6.0 MEANDER\nTCH PROBE 6.1 DIRECTN: X
TCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 1 P.P. INT: 0.5\n";

/// The points of a digitized program lie where a ball of this radius touches the roof.
fn assert_roof(text: &str, radius: f64) {
    let mut at = [0.0_f64; 3];
    let mut points = 0;
    let cos = 1.0 / (1.0_f64 + 0.4 * 0.4).sqrt();
    for line in text.lines().filter(|line| line.contains(" L ")) {
        for word in line.split_whitespace().skip(2) {
            if let Some(axis) = ["X", "Y", "Z"].iter().position(|axis| word.starts_with(axis)) {
                at[axis] = word[1..].parse().unwrap();
            }
        }
        let from_ridge = (at[0] - 10.0).abs();
        // Near the ridge the ball touches its edge.
        if line.contains("FMAX") || from_ridge < radius {
            continue;
        }
        let tip = -1.0 - 0.4 * from_ridge + radius * (1.0 / cos - 1.0);
        assert!((at[2] - tip).abs() < 0.06, "{line}: {tip}");
        points += 1;
    }
    assert!(points > 3 * 16, "{points} points: {text}");
}

/// `--solid`: a mesh is digitized instead of the part, in a test run without a blank, too.
#[test]
fn a_mesh_is_digitized() {
    let folder = folder(&format!("TOOL CALL 2 Z S1000\n{ROOF_RANGE}"));
    folder.write("roof.stl", ROOF);
    let (code, report) = folder.test("--tools tools.txt --digitized . --solid roof.stl --resolution 0.05");
    assert_eq!(code, 0, "{report}");
    assert_roof(&folder.read("ROOF.H"), 3.0);
    let run = folder.bahn("test main.H --tools tools.txt --solid main.H");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("main.H: the file is no STL mesh"),
        "{}",
        run.err()
    );
}

/// MP6200 = 1: the same with a TM 110, which stays deflected by MP6310 and is much faster.
#[test]
fn a_mesh_is_digitized_with_a_measuring_probe() {
    let folder = folder(&format!("TOOL CALL 2 Z S1000\n{ROOF_RANGE}"));
    folder.write("roof.stl", ROOF);
    let options =
        "--tools tools.txt --digitized . --solid roof.stl --resolution 0.05 --mp 6120=200,6150=2000";
    let (code, tapping) = folder.test(options);
    assert_eq!(code, 0, "{tapping}");
    let (code, report) = folder.test(&format!(
        "{options},6200=1,6310=0.5,6330=2,6350=200,6360=1000,6361=2000"
    ));
    assert_eq!(code, 0, "{report}");
    assert_roof(&folder.read("ROOF.H"), 3.0);
    let time = |report: &serde_json::Value| number(report, "/machining_time_s");
    assert!(time(&report) < 0.5 * time(&tapping), "{report} {tapping}");
}

/// The mill digitizes with its axes what lies on its table, and writes the program into its folder of programs; a second
/// time it refuses, since a program is not overwritten.
#[test]
fn the_machine_digitizes_into_its_program_memory() {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("mill"));
    let plant = folder.read("mill/plant.toml");
    // The end of the ball is the reference point of the spindle, so that no tool has a length.
    let probe = plant.replace("length = 120 ", "inserted = true\nlength = 0 ");
    assert_ne!(plant, probe);
    folder.write("mill/plant.toml", probe);
    folder.write("roof.stl", ROOF);
    folder.write(
        "main.H",
        program(&format!(
            "TOOL CALL 0 Z S0\nL Z+20 R0 FMAX\n{ROOF_RANGE}L Z+50 R0 FMAX"
        )),
    );
    let command = "run main.H --machine mill --fresh --solid roof.stl --resolution 0.05";
    let run = folder.bahn(command);
    assert_eq!(run.code(), 0, "{} {}", run.out(), run.err());
    assert!(
        run.err().contains("points are digitized: PGM ROOF"),
        "{}",
        run.err()
    );
    let text = folder.read("mill/programs/ROOF.H");
    assert!(
        text.starts_with("0 BEGIN PGM ROOF MM\n1 L Z+5 FMAX\n2 L X+4 Y+3 FMAX\n"),
        "{text}"
    );
    assert_roof(&text, 2.0);
    let again = folder.bahn(command);
    assert_eq!(again.code(), 1, "{} {}", again.out(), again.err());
    assert!(again.err().contains("ENTRY VALUE INCORRECT"), "{}", again.err());
    assert_eq!(folder.read("mill/programs/ROOF.H"), text);
}

/// Without a solid the machine digitizes the part as it has machined it so far.
#[test]
fn the_machine_digitizes_what_it_has_machined() {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("mill"));
    let plant = folder.read("mill/plant.toml");
    folder.write(
        "mill/plant.toml",
        plant.replace("length = 120 ", "inserted = true\nlength = 0 "),
    );
    // A blank of which nothing is removed: its upper face is at Z 0.
    let blank = "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+40 Y+30 Z+0\nTOOL CALL 0 Z S0\nL Z+20 R0 FMAX\n";
    folder.write("main.H", program(&format!("{blank}{ROOF_RANGE}")));
    let run = folder.bahn("run main.H --machine mill --fresh --digitized .");
    assert_eq!(run.code(), 0, "{} {}", run.out(), run.err());
    let text = folder.read("ROOF.H");
    let heights: Vec<f64> = text
        .lines()
        .filter(|line| !line.contains("FMAX"))
        .filter_map(|line| line.split_whitespace().find(|word| word.starts_with('Z')))
        .map(|word| word[1..].parse().unwrap())
        .collect();
    assert!(
        !heights.is_empty() && heights.iter().all(|height| height.abs() < 0.02),
        "{heights:?}"
    );
    assert!(!folder.path("mill/programs/ROOF.H").exists());
}

/// On the machine TCH PROBE 0 touches the part as it was machined: the bottom of a slot at Z -5; beside the part it touches
/// the block of the plant, whose face is at Z 40 of the machine, 80 below the datum. By hand it touches the same, and a datum
/// that is set on the bottom moves no part.
#[test]
fn the_machine_probes_what_it_has_machined() {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("mill"));
    let plant = folder.read("mill/plant.toml");
    folder.write(
        "mill/plant.toml",
        plant.replace("length = 120 ", "inserted = true\nlength = 0 "),
    );
    let blocks = "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+40 Y+30 Z+0\nTOOL CALL 3 Z S1000
L X+20 Y+15 Z+20 R0 FMAX M3\nL Z-5 F500\nL Y+16\nL Z+20 FMAX M5\nTOOL CALL 0 Z S0\nL Z+20 R0 FMAX
TCH PROBE 0.0 REF. PLANE Q11 Z-\nTCH PROBE 0.1 X+60 Y+15 Z-78\nL Z+20 R0 FMAX
TCH PROBE 0.0 REF. PLANE Q10 Z-\nTCH PROBE 0.1 X+20 Y+15 Z-4\nL X+20 Y+15 Z+3 R0 FMAX";
    folder.write("main.H", program(blocks));
    folder.write(
        "s.txt",
        "when run ended: mode manual\n+0.2: probe surface\n+0: probe direction Z-\n+0.1: key NC_START tap\n\
         when probe.touches=1: expect Z.probed=-5±0.01\n+1: probe datum Z 0\n+0.1: expect Z.displayed=8±0.01\n\
         +0.1: probe surface\n+0: probe direction Z-\n+0.1: key NC_START tap\n\
         when probe.touches=1: expect Z.probed=0±0.01\n+1: end\n",
    );
    let run = folder.bahn("run main.H --machine mill --fresh --operator full --script s.txt --format json");
    let report = run.json();
    assert_eq!(run.code(), 0, "{report} {}", run.err());
    assert!((number(&report, "/q/10") + 5.0).abs() < 0.02, "{report}");
    assert!((number(&report, "/q/11") + 80.0).abs() < 0.02, "{report}");
}

/// `--compare`: a part that is its own model is off by nothing; one whose face is 0.1 mm higher has 0.1 mm left.
#[test]
fn a_part_is_compared_with_a_mesh() {
    let blank = |blank: &str| format!("{blank}TOOL CALL 2 Z S1000\nL X+5 Y+15 Z+50 R0 F500 M3\n");
    let folder = folder(&blank(BLANK));
    let options = "--tools tools.txt --resolution 0.2";
    let (code, report) = folder.test(&format!("{options} --mesh model.stl"));
    assert_eq!(code, 0, "{report}");
    let said = |options: &str| {
        let run = folder.bahn(&format!("test main.H {options}"));
        assert_eq!(run.code(), 0, "{}", run.err());
        run.err()
    };
    let same = said(&format!(
        "{options} --compare model.stl --image off.png --color deviation"
    ));
    assert!(same.contains("0.000 mm left and 0.000 mm missing"), "{same}");
    assert!(folder.path("off.png").exists());
    folder.write("main.H", program(&blank(&BLANK.replace("Z+0", "Z+0.1"))));
    let left = said(&format!("{options} --compare model.stl"));
    assert!(left.contains("0.100 mm left and 0.000 mm missing"), "{left}");
    let run = folder.bahn(&format!(
        "test main.H {options} --image off.png --color deviation"
    ));
    assert!(
        run.code() == 2 && run.err().contains("--color deviation needs --compare"),
        "{}",
        run.err()
    );
}
