//! The trails of the shipped programs: what a run does to every axis, operand and message, cycle by cycle, as one
//! number for each run. A change that must not change behaviour leaves all of them as they were:
//! `make trails` writes them into a file, to be compared between two versions.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use support::*;

/// A generator of its own, so that every run is the same: xorshift.
struct Dice(u64);

impl Dice {
    fn new(seed: u64) -> Dice {
        Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % below
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.next(from.len())]
    }
}

/// What can happen to both shipped machines.
const HAPPENINGS: &[&str] = &[
    "key NC_STOP tap",
    "key NC_START tap",
    "key NC_START tap",
    "key X+ press",
    "key X+ release",
    "key Y- tap",
    "key SPINDLE_OFF tap",
    "override feed 0",
    "override feed 30",
    "override feed 100",
    "override feed 150",
    "override spindle 60",
    "mode manual",
    "mode single",
    "mode full",
    "ce",
    "stop",
    "mdi L X+50 Y+50 R0 F2000",
    "datum X 10",
    "jog 1",
    "handwheel X 3",
    "handwheel 400",
    "restore-position",
    "fault drive X dead",
    "fault encoder Y stuck",
    "repair all",
    "force X 600",
    "force X 0",
    "emergency press",
    "emergency release",
    "voltage on",
];

const SIGNALS: &str = "path.speed,path.block,S.rpm,S.volts,S.angle,X.actual,X.nominal,X.lag,X.speed,X.volts,Y.actual,Y.nominal,Y.volts,\
     Z.actual,Z.nominal,Z.volts,W256,W258,W260,W262,W264,W266,D356,D596,M2009,M2040,M2045,M2046,M2047,M2048,M2095,M2150,M2190,M2482,M2483,M2485,O8,O13";

/// Random things for the half minute after the start of a program.
fn script(seed: u64) -> String {
    let mut dice = Dice::new(seed);
    let mut text = String::from("start: override feed 100\n");
    for _ in 0..20 {
        let milliseconds = dice.next(3000);
        let what = dice.pick(HAPPENINGS);
        let _ = writeln!(text, "+{:.3}: {what}", milliseconds as f64 * 1e-3);
    }
    text + "+5: end\n"
}

/// FNV-1a.
fn hash(texts: &[&str]) -> u64 {
    texts
        .iter()
        .flat_map(|text| text.bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// The programs of a folder, by name.
fn programs(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".H"))
        .collect();
    names.sort();
    names
}

/// The trail of a program on a machine; with a seed, of what happens to it.
fn machine_trail(machine: &str, program: &str, seed: Option<u64>) -> String {
    let folder = Folder::new();
    let machine_folder = root().join("machines").join(machine);
    let mut command = folder.command();
    command
        .args([
            "run",
            program,
            "--fresh",
            "--format",
            "json",
            "--record",
            "trail.csv",
        ])
        .args(["--max-time", "900", "--max-wait", "20", "--signals", SIGNALS])
        .arg("--machine")
        .arg(machine_folder);
    if let Some(seed) = seed {
        folder.write("script.txt", script(seed));
        command.args(["--script", "script.txt"]);
    }
    let output = command.output().unwrap();
    assert!(
        output.status.code().is_some_and(|code| code != 2 && code != 101),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let report = String::from_utf8(output.stdout).unwrap();
    let what = seed.map_or_else(String::new, |seed| format!(" seed {seed}"));
    format!(
        "{:016x} {machine} {program}{what}",
        hash(&[&folder.read("trail.csv"), &report])
    )
}

/// The trail of a program without a machine: its report and the elements of its path.
fn test_trail(program: &str) -> String {
    let folder = Folder::new();
    let examples = root().join("examples");
    let output = folder
        .command()
        .args([
            "test",
            "--format",
            "json",
            "--no-graphics",
            "--path",
            "path.csv",
            "--tools",
        ])
        .arg(examples.join("tools.tsv"))
        .arg(examples.join(program))
        .output()
        .unwrap();
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    format!(
        "{:016x} examples {program}",
        hash(&[&folder.read("path.csv"), &report["machining_time_s"].to_string()])
    )
}

/// All trails go into the file of BAHN_TRAILS, line by line.
#[test]
#[ignore = "minutes long: make trails"]
fn the_trails_of_what_is_shipped() {
    let file = std::env::var_os("BAHN_TRAILS").unwrap();
    let mut lines: Vec<String> = programs(&root().join("examples"))
        .iter()
        .map(|program| test_trail(program))
        .collect();
    for machine in ["mill", "mill-tnc360"] {
        let names = programs(&root().join("machines").join(machine).join("programs"));
        lines.extend(names.iter().map(|name| machine_trail(machine, name, None)));
        for seed in 0..200 {
            let program = &names[seed as usize % names.len()];
            lines.push(machine_trail(machine, program, Some(seed)));
        }
    }
    std::fs::write(file, lines.join("\n") + "\n").unwrap();
}

#[test]
fn a_trail_repeats_and_tells_two_runs_apart() {
    let one = machine_trail("mill-tnc360", "COVER.H", Some(3));
    assert_eq!(one, machine_trail("mill-tnc360", "COVER.H", Some(3)));
    let other = machine_trail("mill-tnc360", "COVER.H", Some(4));
    assert_ne!(one[..16], other[..16]);
}
