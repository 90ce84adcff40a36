//! What `bahn run` says of threads: how deep they are, and how far the tool was from its spindle.

use crate::support::{Folder, copy, machines, number, program, rows};

const PITCH: f64 = 1.25;
const SET_UP: f64 = 3.0;
const DEPTH: f64 = 15.0;

/// Cycles 17, 18 and 2 in block 9, 13 and 20, each from 3 mm above the workpiece.
const THREADS: &str = "TOOL CALL 6 Z S<rpm>
L X+20 Y+20 R0 FMAX
L Z+50 FMAX
CYCL DEF 17.0 RIGID TAPPING
CYCL DEF 17.1 SET UP -3
CYCL DEF 17.2 DEPTH -15
CYCL DEF 17.3 PITCH +1.25
L Z+3 FMAX M99
CYCL DEF 18.0 THREAD CUTTING
CYCL DEF 18.1 DEPTH -15
CYCL DEF 18.2 PITCH +1.25
L Z+3 FMAX M99
L X+30 FMAX M3
CYCL DEF 2.0 TAPPING
CYCL DEF 2.1 SET UP -3
CYCL DEF 2.2 DEPTH -15
CYCL DEF 2.3 DWELL 0.1
CYCL DEF 2.4 F<feed>
L Z+3 FMAX M99
L Z+50 FMAX M5";

/// The deepest place of the table in a block from where it is highest after the way to the hole, and how far it leaves the pitch on
/// its way down.
fn recorded(table: &str, block: u32) -> [f64; 2] {
    let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|cell| cell.starts_with(name)).unwrap();
    let places = ["Z.table", "S.angle", "path.block", "path.speed", "M2048", "M2095"].map(column);
    let samples: Vec<[f64; 6]> = rows(table)
        .iter()
        .map(|row| places.map(|place| row[place].parse().unwrap()))
        .filter(|row: &[f64; 6]| row[2] == f64::from(block))
        .collect();
    let taps = |row: &&[f64; 6]| row[4] + row[5] > 0.0;
    // The last row before the path of the thread moves.
    let first = samples
        .iter()
        .position(|row| taps(&row) && row[3] != 0.0)
        .unwrap();
    let begin = samples[first - 1];
    let thread = samples[first..].iter().filter(taps);
    let down = |row: &[f64; 6]| begin[0] - row[0];
    let lowest = thread.clone().map(|row| row[0]).fold(f64::INFINITY, f64::min);
    // In cycle 2 Z is still on its way when the path begins; it comes back to there and stands.
    let depth = match begin[5] {
        0.0 => samples.last().unwrap()[0] - lowest,
        _ => begin[0] - lowest,
    };
    let off = thread.map(|row| (down(row) - PITCH * (row[1] - begin[1]) / 360.0).abs());
    [depth, off.fold(0.0, f64::max)]
}

/// For each thread the report has the depth that is commanded and the one that the plant reaches, and what is recorded of the
/// table and of the spindle says the same. In cycle 2 nothing couples them: while the spindle brakes on MP3410.2 from S320,
/// 1.92 V, in 0.192 s, Z goes 1.28 mm and the spindle half of it; what it lags behind comes to it.
///
/// A ramp MP3410.3 of 1.9 V/ms without a run-in is more than the drive can do, 9000 rpm/s of the motor: from 1400 rpm, 5600 of the
/// motor, it brakes for 0.62 s, in which Z goes 9 mm. The spindle runs on, and the thread is too deep.
#[test]
fn the_report_has_the_depth_that_is_reached() {
    let spoilt = "3410.3=1.9,7140=1,7130=10";
    for (rpm, assignments, beyond) in [(320.0, "7620=5", 0.0..0.01), (1400.0, spoilt, 0.1..9.0)] {
        let folder = Folder::new();
        copy(&machines().join("mill"), &folder.path("m"));
        let blocks = THREADS
            .replace("<rpm>", &rpm.to_string())
            .replace("<feed>", &(rpm * PITCH).to_string());
        folder.write("T.H", program(&blocks));
        let run = folder.bahn(&format!(
            "run T.H --machine m --fresh --no-graphics --format json --mp {assignments} --record t.csv \
             --signals Z.table,S.angle,path.block,path.speed,M2048,M2095"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
        let report = run.json();
        let threads = report["threads"].as_array().unwrap();
        let table = folder.read("t.csv");
        let blocks: Vec<u64> = threads
            .iter()
            .map(|thread| thread["block"].as_u64().unwrap())
            .collect();
        assert_eq!(blocks, [8, 12, 19]);
        for (thread, (cycle, commanded)) in
            threads
                .iter()
                .zip([(17, SET_UP + DEPTH), (18, DEPTH), (2, SET_UP + DEPTH)])
        {
            assert_eq!(
                (&thread["cycle"], &thread["program"]),
                (&cycle.into(), &"T.H".into())
            );
            let block = thread["block"].as_u64().unwrap();
            let [depth, off] = recorded(&table, u32::try_from(block).unwrap());
            let (reached, reported) = (number(thread, "/reached_mm"), number(thread, "/off_mm"));
            assert_eq!(number(thread, "/depth_mm"), commanded, "{thread}");
            assert!((reached - depth).abs() < 0.006, "{thread}: recorded {depth}");
            if cycle == 2 {
                let range = if rpm == 320.0 { 0.3..1.28 } else { 1.28..17.5 };
                assert!(range.contains(&reported), "{thread}");
            } else {
                // What is recorded of the spindle is a servo step older: 0.6 ms at 1400 rpm are 5 degrees, 0.018 mm, and Z is as much older.
                assert!((reported - off).abs() < 0.006, "{thread}: recorded {off}");
                assert!(reported > 0.0 && reported < 0.05, "{thread}");
                assert!(beyond.contains(&(reached - commanded).abs()), "{thread}");
            }
        }
        let text = folder.bahn(&format!(
            "run T.H --machine m --fresh --no-graphics --mp {assignments}"
        ));
        let reached = number(&threads[0], "/reached_mm");
        let line = format!("T.H block 8, cycle 17: {reached:.3} mm deep for 18.000 (");
        assert!(text.out().contains(&line), "{line}\n{}", text.out());
    }
}
