//! Why the axes left the contour: each cause is provoked on the simulated mill, and the report names it.

use crate::support::{Folder, number};
use serde_json::Value;

/// The reports of programs of the mill, whose plant is changed by replacing texts of its file.
struct Mill {
    folder: Folder,
}

impl Mill {
    fn new(blocks: &str, changes: &[(&str, &str)]) -> Mill {
        let folder = Folder::with_mill(blocks);
        let plant = folder.path("mill").join("plant.toml");
        let mut text = std::fs::read_to_string(&plant).unwrap();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        std::fs::write(plant, text).unwrap();
        Mill { folder }
    }

    fn report(&self, parameters: &str) -> Value {
        let run = self.folder.bahn(&format!(
            "run main.H --machine mill --fresh --no-graphics --format json {parameters}"
        ));
        run.json()
    }
}

fn cause(report: &Value) -> &str {
    report["contour_deviation_cause"]
        .as_str()
        .unwrap_or_else(|| panic!("{report}"))
}

const START: &str = "TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX M3\nL X+0 Y+0 FMAX\n";

/// Two legs at a right angle with servo lag: who follows with kv 2 at 1000 mm/min is 0.5 mm behind when the
/// path turns, and cuts the corner.
#[test]
fn a_corner_is_cut_by_the_lag() {
    let mill = Mill::new(&format!("{START}L X+40 F1000\nL Y+40\nL Z+60 FMAX M2"), &[]);
    let report = mill.report("--mp 1390=1");
    assert!(cause(&report).starts_with("corner of 90°"), "{}", cause(&report));
}

/// 45 degrees with kv 2 and 1.6: at 1000 mm/min along the path, 707 in each axis, the lags are 0.354 and
/// 0.442 mm, their difference seen across the path 0.0625 mm.
#[test]
fn unequal_kv_factors_shift_a_slope() {
    let mill = Mill::new(&format!("{START}L X+60 Y+60 F1000\nL Z+60 FMAX M2"), &[]);
    let report = mill.report("--mp 1390=1 --mp 1810.1=1.6");
    let text = cause(&report);
    assert!(text.starts_with("unequal kv: X follows with "), "{text}");
    let kv: Vec<f64> = text
        .split(&[' ', ','][..])
        .filter_map(|word| word.parse().ok())
        .collect();
    assert!(
        (kv[0] / 2.0 - 1.0).abs() < 0.02 && (kv[1] / 1.6 - 1.0).abs() < 0.02,
        "{text}"
    );
    let across = 1000.0 / 2_f64.sqrt() * (1.0 / 1600.0 - 1.0 / 2000.0) / 2_f64.sqrt();
    let deviation = number(&report, "/contour_deviation_mm");
    assert!(
        (deviation - across).abs() < 0.2 * across,
        "{deviation} of {across}"
    );
}

/// A tangential half circle of radius 10 with servo lag: 3000 mm/min make 1.5 mm of lag, and the axes run
/// 1.5 * 1.5 / (2 * 10) = 0.11 mm inside.
#[test]
fn a_fast_arc_runs_inside() {
    let blocks = format!("{START}L X+40 F3000\nCC X+40 Y+10\nC X+40 Y+20 DR+\nL X+0\nL Z+60 FMAX M2");
    let mill = Mill::new(&blocks, &[]);
    // The radial acceleration allows the feed: (3000 mm/min)² / 10 mm = 0.25 m/s².
    let report = mill.report("--mp 1390=1");
    let text = cause(&report);
    assert!(
        text.starts_with("acceleration across the path: radius "),
        "{text}"
    );
}

/// A slow circle with feed precontrol: nothing is left but the friction of an axis that turns round.
#[test]
fn friction_shows_at_the_reversal() {
    let blocks = format!("{START}CC X+20 Y+0\nC X+0 Y+0 DR+ F600\nC X+0 Y+0 DR+ F600\nL Z+60 FMAX M2");
    let mill = Mill::new(
        &blocks,
        &[
            ("friction = 250", "friction = 1500"),
            ("stiction = 290", "stiction = 2500"),
        ],
    );
    let report = mill.report("");
    assert_eq!(
        cause(&report),
        "friction or backlash at the reversal of X",
        "{report}"
    );
}

/// A slope with feed precontrol and a table X that carries three tons more than its drive was adjusted for:
/// it follows later as long as the speed changes.
#[test]
fn a_heavy_table_lags_while_it_accelerates() {
    let mill = Mill::new(
        &format!("{START}L X+5 Y+5 FMAX\nL X+60 Y+60 F6000\nL Z+60 FMAX M2"),
        &[("# load = 300 ", "load = 3000 ")],
    );
    let report = mill.report("");
    let text = cause(&report);
    let along = text.starts_with("acceleration along the path") || text.starts_with("braking along the path");
    assert!(along, "{text}");
}
