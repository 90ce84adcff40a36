//! The workpieces of the shipped machines that have threads, a touch probe, a tool probe or a cycle of the machine builder:
//! each runs on its machine to the end, and is what its drawing says.

use crate::support::{Folder, copy, machines, number, rows};
use serde_json::Value;

/// A spindle overshoots where it is to stand, and with it the tap, mm: the lists leave less than a fifth of a pitch of 1.25.
const OVERSHOOT_MM: f64 = 0.02;

/// What a workpiece did.
struct Done {
    folder: Folder,
    report: Value,
    record: String,
}

/// Runs a program on its machine, in a copy of it, and records signals; nothing is said but what every run says.
fn run(machine: &str, program: &str, signals: &str) -> Done {
    let folder = Folder::new();
    copy(&machines().join(machine), &folder.path("machine"));
    let run = folder.bahn(&format!(
        "run {program} --machine machine --digitized . --format json --record record.csv --signals {signals}"
    ));
    assert_eq!(run.code(), 0, "{program}: {} {}", run.out(), run.err());
    let report = run.json();
    assert_eq!(report["completed"], true, "{report}");
    let usual = [
        "POWER INTERRUPTED",
        "CHANGE TOOL, THEN CONFIRM",
        "CHANGE TOOL LEFT, THEN CONFIRM",
        "CHANGE TOOL RIGHT, THEN CONFIRM2",
    ];
    let messages = report["messages"].as_array().unwrap();
    for message in messages {
        let text = message["text"].as_str().unwrap();
        assert!(usual.contains(&text), "{program}: {message}");
    }
    let record = folder.read("record.csv");
    Done {
        folder,
        report,
        record,
    }
}

impl Done {
    fn q(&self, parameter: u16) -> f64 {
        number(&self.report, &format!("/q/{parameter}"))
    }

    /// Columns of the record while a block is executed.
    fn in_block<const N: usize>(&self, block: u32, columns: [&str; N]) -> Vec<[f64; N]> {
        self.after(0, block, columns)
    }

    /// The same after the first time that another block was.
    fn after<const N: usize>(&self, before: u32, block: u32, columns: [&str; N]) -> Vec<[f64; N]> {
        let (head, rows) = (self.record.lines().next().unwrap(), rows(&self.record));
        let place = |name: &str| {
            let is = |head: &&str| head.split_whitespace().next() == Some(name);
            head.split(',').position(|head| is(&head)).unwrap()
        };
        let (at, places) = (place("path.block"), columns.map(place));
        let after = rows.iter().skip_while(|row| row[at].parse() != Ok(before));
        let own = after.filter(|row| row[at].parse() == Ok(block));
        own.map(|row| places.map(|place| row[place].parse().unwrap()))
            .collect()
    }
}

fn near(value: f64, expected: f64, within: f64) {
    assert!(
        (value - expected).abs() <= within,
        "{value} instead of {expected}"
    );
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// While axis and spindle turn a thread, below the place that it begins at, how far Z is from its pitch: the spread of `Z - pitch · turns`, mm.
fn out_of_step(samples: &[[f64; 3]], above: f64, pitch: f64) -> f64 {
    let turning = samples
        .iter()
        .filter(|[z, rpm, _]| rpm.abs() > 20.0 && *z < above - 0.1);
    let off: Vec<f64> = turning.map(|[z, _, angle]| z + pitch * angle / 360.0).collect();
    assert!(off.len() > 500, "{}", off.len());
    off.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least(off.iter().copied())
}

/// The flange of the mill: its datum is at Z 120 of the machine, the tap 115 mm and the threading bar 90 mm long.
/// M8 ends 15 mm below the face, the thread of the bore 17 mm: 4 mm above the face less 21. The spindle overshoots by a
/// little, and the tap with it. Z is in step within the standstill of an encoder step of the spindle and its own lag.
#[test]
fn the_threads_of_the_flange_have_their_depths() {
    let flange = run(
        "mill",
        "FLANGE.H",
        "Z.actual,S.rpm,S.angle,path.block,X.actual,Y.actual",
    );
    for block in [50, 52] {
        let samples = flange.in_block(block, ["Z.actual", "S.rpm", "S.angle"]);
        let bottom = least(samples.iter().map(|sample| sample[0]));
        let depth = bottom - (120.0 + 115.0);
        assert!(
            (-15.0 - OVERSHOOT_MM..=-14.98).contains(&depth),
            "block {block}: {depth}"
        );
    }
    let first = flange.in_block(50, ["Z.actual", "S.rpm", "S.angle"]);
    let spread = out_of_step(&first, 120.0 + 115.0 + 3.0, 1.25);
    assert!(spread < 0.05, "{spread}");
    // The holes of cycle 68: six on a radius of 40 mm from 30 degrees on, each where Z is deepest.
    let drilled = flange.in_block(16, ["Z.actual", "X.actual", "Y.actual"]);
    let bottoms = drilled
        .iter()
        .filter(|[z, _, _]| (z - (120.0 + 110.0 - 22.0)).abs() < 0.02);
    let mut angles: Vec<i64> = bottoms
        .map(|[_, x, y]| {
            near((x - 200.0).hypot(y - 120.0), 40.0, 0.01);
            (y - 120.0)
                .atan2(x - 200.0)
                .to_degrees()
                .rem_euclid(360.0)
                .round() as i64
        })
        .collect();
    angles.dedup();
    assert_eq!(angles, [30, 90, 150, 210, 270, 330]);
    let bore = flange.in_block(63, ["Z.actual", "S.rpm", "S.angle"]);
    near(
        least(bore.iter().map(|sample| sample[0])) - (120.0 + 90.0),
        4.0 - 21.0,
        OVERSHOOT_MM,
    );
}

/// The block of `plant.toml`, X 200 to 300, Y 100 to 180, its face at 40, from the datum 200, 120, 120. The feed of
/// 250 mm/min covers 2.5 µm in a servo step.
#[test]
fn the_block_in_the_vice_is_found() {
    let datum = run("mill", "DATUM.H", "Z.actual,path.block");
    for (parameter, place) in [
        (1, 0.0),
        (2, 100.0),
        (3, -20.0),
        (4, 60.0),
        (5, -80.0),
        (6, 50.0),
        (7, 20.0),
    ] {
        near(datum.q(parameter), place, 0.0035);
    }
    // The recess is 4 mm deep below the face that was found: tool 3 is 85 mm long, MP1030 is 0.01 mm.
    let recess = datum.in_block(49, ["Z.actual"]);
    near(
        least(recess.iter().map(|sample| sample[0])),
        120.0 + 85.0 - 80.0 - 4.0,
        0.01,
    );
}

/// Tool 2 is 95 mm long with a radius of 10 mm in the table, and 94.96 and 9.985 mm in the plant. Measured, it mills the
/// step where the drawing has it: RR along Y, X 30 of the datum 200, Z -5 of the datum 120. The tool probe was calibrated
/// before, with a tool that is what the table says.
#[test]
fn the_worn_tool_mills_with_what_was_measured() {
    let step = run("mill", "MEASURE.H", "Z.actual,X.actual,path.block");
    let cut = step.in_block(24, ["X.actual", "Z.actual"]);
    let last = cut.last().unwrap();
    near(last[1], 120.0 + 94.96 - 5.0, 0.004);
    near(last[0], 200.0 + 30.0 + 9.985, 0.004);
    let table = step.folder.bahn("table show machine --kind tool");
    let row = table
        .out()
        .lines()
        .find(|line| line.contains("END MILL D20"))
        .unwrap()
        .to_owned();
    assert!(row.contains("94.9") && row.contains("9.98"), "{row}");
}

/// The face of the plate lies 1.35 mm below the drawing. A TNC 360 asks the probe in each of its servo steps of 6 ms:
/// 250 mm/min are 0.025 mm in it. Z follows with a lag of v / kv, 300 / 1500 = 0.2 mm, and turns at the depth.
#[test]
fn the_plate_is_tapped_as_deep_as_its_face_lies() {
    let plate = run("mill-tnc360", "PLATE.H", "Z.actual,S.rpm,path.block");
    near(plate.q(1), -1.35 - 0.0125, 0.0135);
    near(plate.q(2), -1.35 - 0.0125, 0.0135);
    for block in [43, 44, 45] {
        let tapped = plate.after(28, block, ["Z.actual"]);
        let depth = least(tapped.iter().map(|sample| sample[0])) - (65.0 - 221.5 + plate.q(3));
        near(depth, -12.0, 0.21);
    }
}

/// The face of the plate on the left table of the twin lies 1.2 mm below the drawing, that is at 118.8 of the machine, and is found
/// within the 2.5 µm of a servo step. The tap is 100 mm long; Z turns 12 mm below the face within its window (MP1030), twice.
#[test]
fn the_plate_of_the_twin_is_tapped_as_deep_as_its_face_lies() {
    let plate = run("twin", "TAPS.H RIGHT.H", "Z.actual,path.block");
    near(plate.q(1), -1.2, 0.0035);
    for block in [41, 42, 43, 44] {
        let tapped = plate.after(25, block, ["Z.actual"]);
        let depth = least(tapped.iter().map(|sample| sample[0])) - (100.0 + 118.8);
        near(depth, -12.0, 0.02);
    }
}

/// Cycle 17 in a plane of 30 degrees: from 3 mm above it to 14 mm below, X and Z together, the slave beside X.
#[test]
fn the_threads_of_the_roof_stand_upright_in_it() {
    let roof = run("gantry", "THREADS.H", "X.actual,Z.actual,S.rpm,path.block");
    for block in [30, 31, 32] {
        let samples = roof.after(17, block, ["X.actual", "Z.actual"]);
        let (sin, cos) = 30.0_f64.to_radians().sin_cos();
        // The way to the hole is before that.
        let half = &samples[samples.len() / 2..];
        let heights: Vec<f64> = half.iter().map(|[x, z]| x * sin + z * cos).collect();
        let across: Vec<f64> = half.iter().map(|[x, z]| x * cos - z * sin).collect();
        let most = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let stroke = heights.last().unwrap() - least(heights.iter().copied());
        near(stroke, 17.0, OVERSHOOT_MM);
        assert!(
            most(&across) - least(across.iter().copied()) < 0.02,
            "block {block}"
        );
    }
}

/// The model of `plant.toml`: a board at Z -5, on it a boss of 5 mm radius about X 32, Y 28 with its face at Z -1, felt by a
/// ball of 2 mm radius.
#[test]
fn the_boss_is_digitized() {
    let model = run("dig425", "MODEL.H", "Z.actual,path.block");
    let text = model.folder.read("BOSS.H");
    let mut at = [f64::NAN; 3];
    let (mut on_boss, mut on_board) = (0, 0);
    for line in text.lines().skip(3) {
        for word in line.split_whitespace() {
            let axis = "XYZ".find(word.chars().next().unwrap());
            if let (Some(axis), Ok(value)) = (axis, word[1..].parse()) {
                at[axis] = value;
            }
        }
        let from_middle = (at[0] - 32.0).hypot(at[1] - 28.0);
        if from_middle < 5.0 {
            near(at[2], -1.0, 0.03);
            on_boss += 1;
        } else if from_middle > 7.05 && at[2] < 9.0 {
            near(at[2], -5.0, 0.03);
            on_board += 1;
        }
    }
    assert!(on_boss > 20 && on_board > 20, "{on_boss} {on_board}");
}
