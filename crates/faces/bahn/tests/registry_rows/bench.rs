//! The bench of the rows: a small mill with a TNC 155 whose four axes stand 1 mm before their reference marks, and how what two
//! runs show is compared.

use std::fmt::Debug;
use std::ops::RangeInclusive;

use bahn_tnc::RunState;

use crate::support::knee::{asked, knee, reference};
use crate::support::{Build, Rig};

/// What is wrong with a row, where something is.
pub type Verdict = Result<(), String>;

/// How a row shows what its parameter does.
pub enum Probe {
    /// The machine with the changed parameter differs from the unchanged one as the manual says; the argument is its number.
    Acts(fn(u16) -> Verdict),
    /// No run differs.
    Nothing,
}

/// Parameters of the same kind, by their numbers, and what shows them.
pub struct Row(pub RangeInclusive<u16>, pub Probe);

/// The axes of the bench.
pub const AXES: [char; 4] = ['X', 'Y', 'Z', 'U'];

/// Axis IV as U, like the others.
const FOURTH: &str = r#"
[axis.U]
output = "4"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = { range = [140, 200], input = "I3" }
[axis.U.encoder]
input = "X4"
period_um = 20
mark = 150
"#;

/// Four linear axes, which find their marks within a tenth of a second.
const LIST: &str = "72=0 90=3 3=6000 54=2 55=1 58=0.05 192=0.05 234=10";

/// The bench with changes of its list, separated by blanks, and further instructions of its PLC program.
pub fn bench(mps: &str) -> Build {
    bench_with("", mps)
}

/// The same with instructions that its PLC program goes on with.
pub fn bench_with(instructions: &str, mps: &str) -> Build {
    knee(instructions)
        .with(FOURTH)
        .plant("start = 50", "start = 149")
        .mps(LIST)
        .mps(mps)
}

/// The bench with a PLC program in the form of these controls, M2719 = 0: numbers stand in markers.
pub fn bench_of_markers(instructions: &str, mps: &str) -> Build {
    let mut build = bench_with("", mps);
    let words = "       L     M2719\n       SN    M2719\n";
    assert!(build.plc.contains(words), "{}", build.plc);
    build.plc = build
        .plc
        .replacen(words, "       L     M2719\n       R     M2719\n", 1);
    build.plc = build.plc.replace("LN    M2719", "L     M2719");
    build.plc = build
        .plc
        .replacen("\n       EM", &format!("\n{instructions}       EM"), 1);
    build
}

/// Switched on, its marks passed.
pub fn ready(build: Build) -> Rig {
    let mut rig = asked(build);
    reference(&mut rig);
    rig
}

/// The list with and without the change of a row.
pub fn both<T>(number: u16, value: &str, run: impl Fn(&str) -> T) -> [T; 2] {
    [run(""), run(&format!("{number}={value}"))]
}

/// Runs a program that is on the shelf as `1`, and looks at each cycle.
pub fn watch(rig: &mut Rig, mut look: impl FnMut(&Rig)) {
    begin(rig);
    let end_us = rig.control.time_us() + 60_000_000;
    while !rig.control.has_ended() {
        assert!(rig.control.time_us() < end_us, "{:?}", rig.messages());
        rig.cycle();
        look(rig);
    }
}

/// Starts the program `1` in full sequence.
pub fn begin(rig: &mut Rig) {
    rig.command("mode full");
    rig.command("select 1");
    rig.start();
    rig.until(1.0, "the run begins", |rig| {
        rig.control.snapshot().run == RunState::Running || rig.control.has_ended()
    });
}

/// Seconds of a run of the program `1`, from its start to its end.
pub fn duration(rig: &mut Rig) -> f64 {
    begin(rig);
    let from = rig.control.time_us();
    rig.until(60.0, "the end", |rig| rig.control.has_ended());
    (rig.control.time_us() - from) as f64 * 1e-6
}

/// The greatest magnitude of a signal of each axis while a program runs: `nominal-speed`.
pub fn greatest(rig: &mut Rig, name: &str) -> [f64; 4] {
    let mut most = [0.0_f64; 4];
    watch(rig, |rig| {
        for (most, now) in most.iter_mut().zip(of_axes(rig, name)) {
            *most = most.max(now.abs());
        }
    });
    most
}

/// A signal of the control: `X.lag`, `output.S`, `M2045`.
pub fn signal(rig: &Rig, name: &str) -> f64 {
    rig.control.observe(&name.parse().unwrap())
}

/// A signal of all axes.
pub fn of_axes(rig: &Rig, name: &str) -> [f64; 4] {
    AXES.map(|axis| signal(rig, &format!("{axis}.{name}")))
}

/// Where the tables stand, mm.
pub fn tables(rig: &Rig) -> [f64; 4] {
    AXES.map(|axis| rig.table(axis))
}

/// The same block for each axis: `L I@+5 R0 F1000`.
pub fn each_axis(block: &str) -> String {
    let blocks = AXES.map(|axis| block.replace('@', &axis.to_string()));
    blocks.join("\n")
}

/// Differences of what was measured of each axis.
pub fn less(after: [f64; 4], before: [f64; 4]) -> [f64; 4] {
    [0, 1, 2, 3].map(|index: usize| after[index] - before[index])
}

/// Of what was measured of each axis only that of one axis changes, from a value to another.
pub fn only(index: u16, seen: [[f64; 4]; 2], [from, to]: [f64; 2], tolerance: f64) -> Verdict {
    let changes = (0..4).map(|axis| if axis == index { to } else { from });
    let wanted: Vec<f64> = changes.collect();
    let [before, after] = seen;
    all("unchanged", &before, &[from; 4], tolerance)?;
    all("changed", &after, &wanted, tolerance)
}

/// Measured values are the expected ones.
pub fn all(what: &str, found: &[f64], wanted: &[f64], tolerance: f64) -> Verdict {
    let near = |(found, wanted): (&f64, &f64)| (found - wanted).abs() <= tolerance;
    match found.len() == wanted.len() && found.iter().zip(wanted).all(near) {
        true => Ok(()),
        false => Err(format!("{what}: {found:?}, not {wanted:?} within {tolerance}")),
    }
}

/// Two values, without and with the change, are the expected ones.
pub fn pair(found: [f64; 2], wanted: [f64; 2], tolerance: f64) -> Verdict {
    all("without and with the change", &found, &wanted, tolerance)
}

/// What is seen without and with the change is the expected.
pub fn same<T: PartialEq + Debug>(found: T, wanted: T) -> Verdict {
    match found == wanted {
        true => Ok(()),
        false => Err(format!("{found:?}, not {wanted:?}")),
    }
}

/// Something holds.
pub fn holds(so: bool, what: impl FnOnce() -> String) -> Verdict {
    if so { Ok(()) } else { Err(what()) }
}

/// What the reference run, a direction button and a program with M functions show in each cycle: places of the tables and
/// voltages, and the markers of the PLC in the end.
fn shown(mps: &str) -> (Vec<u64>, Vec<bool>) {
    let blocks = "TOOL CALL 1 Z S1000\nL IX-3 IY-2 R0 F1000 M3\nL IZ-2 M8\nL IU-1 M30";
    let build = bench("62=2 61=1").mps(mps).program("1", blocks);
    let tools = [(1, bahn_tnc::Tool::default())];
    let mut rig = asked(Build {
        tools: Some(tools.into()),
        ..build
    });
    rig.start();
    let mut seen = Vec::new();
    let look = |rig: &Rig, seen: &mut Vec<u64>| {
        let volts = [1, 2, 3, 4].map(|output: u8| signal(rig, &format!("output.{output}")));
        seen.extend(tables(rig).into_iter().chain(volts).map(f64::to_bits));
    };
    for action in ["", "key X- press", "key X- release"] {
        if !action.is_empty() {
            rig.event(action);
        }
        for _ in 0..150 {
            rig.cycle();
            look(&rig, &mut seen);
        }
    }
    rig.seconds(0.5);
    watch(&mut rig, |rig| look(rig, &mut seen));
    let markers = (0..3264).map(|marker| rig.bit(&format!("M{marker}")));
    let markers = markers.collect();
    (seen, markers)
}

/// A run with another value is the same.
pub fn unmoved(number: u16) -> Verdict {
    let [before, after] = both(number, "1", shown);
    holds(before.0.len() > 1000, || "nothing is seen".to_owned())?;
    holds(before == after, || "a run differs".to_owned())
}
