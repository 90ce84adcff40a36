//! How fast a part is digitized in a test run: from the program that machines it to the program of its points.
#![allow(
    clippy::panic,
    clippy::expect_used,
    reason = "a wrong program would measure nothing"
)]

use std::path::PathBuf;
use std::process::{Command, Stdio};

use divan::Bencher;
use divan::counter::ItemsCount;

fn main() {
    divan::main();
}

/// Points that are wanted at least: 501 lines of 100 mm, 0.2 mm apart, with a point every half millimetre.
const POINTS: usize = 100_000;

/// Two grooves that cross, and the surface of 100 by 100 mm around them.
const PROGRAM: &str = "BEGIN PGM MODEL MM
BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+100 Y+100 Z+0
TOOL CALL 1 Z S1000
L X+20 Y+30 Z+10 R0 FMAX M3
L Z-5 F500
L X+80 Y+70 Z-2
L Z+10 FMAX
L X+20 Y+70 FMAX
L Z-2 F500
L X+80 Y+30 Z-5
L Z+50 FMAX M5
TOOL CALL 2 Z S1000
TCH PROBE 5.0 RANGE
TCH PROBE 5.1 PGM NAME: POINTS
TCH PROBE 5.2 Z X+0 Y+0 Z-10
TCH PROBE 5.3 X+100 Y+100 Z+1
TCH PROBE 5.4 HEIGHT: +10
TCH PROBE 6.0 MEANDER
TCH PROBE 6.1 DIRECTN: X
TCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 0.2 P.P. INT: 0.5
END PGM MODEL MM
";

const TOOLS: &str = "T L R R2 NAME\n1 100 4 4 BALL 8\n2 100 3 3 BALL 6\n";

/// A folder that is removed in the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn folder() -> Folder {
    let folder = std::env::temp_dir().join(format!("bahn-bench-digitizing-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("MODEL.H"), PROGRAM).expect("a program");
    std::fs::write(folder.join("tools.txt"), TOOLS).expect("a tool table");
    Folder(folder)
}

fn digitize(folder: &Folder, parameters: &str) -> usize {
    let arguments = "test MODEL.H --tools tools.txt --digitized .";
    let status = Command::new(env!("CARGO_BIN_EXE_bahn"))
        .args(arguments.split(' '))
        .args(parameters.split_whitespace())
        .current_dir(&folder.0)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("bahn runs");
    assert!(status.success(), "{status}");
    let text = std::fs::read_to_string(folder.0.join("POINTS.H")).expect("the points");
    text.lines().count()
}

fn points(bencher: Bencher, parameters: &str) {
    let folder = folder();
    let lines = digitize(&folder, parameters);
    assert!(lines >= POINTS, "{lines} points");
    bencher
        .counter(ItemsCount::new(lines))
        .bench_local(|| digitize(&folder, parameters));
}

/// 100,000 points with a triggering probe. Target: below 5 s.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn triggering_probe(bencher: Bencher) {
    points(bencher, "");
}

/// 100,000 points with a measuring probe. Target: below 5 s.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn measuring_probe(bencher: Bencher) {
    points(
        bencher,
        "--mp 6200=1,6310=0.5,6330=2,6350=200,6360=1000,6361=2000",
    );
}
