//! How deep a thread is, and how well the tool axis follows the spindle: what the plant does, not what the encoders say
//! [000:6047-6145].

use crate::support::*;
use bahn_exchange::Bit;
use bahn_parameters::{ControlModel, ParameterList};

const PITCH: f64 = 1.5;
const DEPTH: f64 = 20.0;
const SET_UP: f64 = 3.0;

/// Cycle 17, cycle 18 and cycle 2, each from 3 mm above the workpiece, where Z stands for 0.2 s.
fn threads(rpm: f64) -> String {
    let feed = rpm * PITCH;
    let call = format!(
        "L Z+5 FMAX\nL Z+{SET_UP} FMAX\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.2\nCYCL CALL\n"
    );
    format!(
        "TOOL CALL 3 Z S{rpm}
L X+20 Y+20 R0 FMAX M3
CYCL DEF 17.0 RIGID TAPPING
CYCL DEF 17.1 SET UP -{SET_UP}
CYCL DEF 17.2 DEPTH -{DEPTH}
CYCL DEF 17.3 PITCH +{PITCH}
{call}CYCL DEF 18.0 THREAD CUTTING
CYCL DEF 18.1 DEPTH -{DEPTH}
CYCL DEF 18.2 PITCH +{PITCH}
{call}L X+30 FMAX M3
CYCL DEF 2.0 TAPPING
CYCL DEF 2.1 SET UP -{SET_UP}
CYCL DEF 2.2 DEPTH -{DEPTH}
CYCL DEF 2.3 DWELL 0.1
CYCL DEF 2.4 F{feed}
{call}L Z+50 FMAX M5"
    )
}

/// The mill with the control of another model: its list without the parameters that the model does not have.
fn mill(model: ControlModel) -> Build {
    let mut build = Build::mill();
    build.model = model;
    let list = build.list.take().unwrap();
    let errors = ParameterList::reference(model).read(list.as_bytes());
    let known = |line: &(usize, &str)| errors.iter().all(|error| error.span.line as usize != line.0 + 1);
    let lines = list.lines().enumerate().filter(known);
    build.list = Some(lines.map(|(_, text)| format!("{text}\n")).collect());
    build
}

/// What the plant does in a cycle: Z, mm, the turns of the spindle.
#[derive(Clone, Copy)]
struct Seen {
    z: f64,
    turns: f64,
}

fn look(rig: &Rig) -> Seen {
    Seen {
        z: rig.machine.axis('Z').unwrap().position,
        turns: rig.machine.spindle().unwrap().angle_deg / 360.0,
    }
}

/// Runs through the next thread: from the last cycle before it to that in which the marker falls.
fn record(rig: &mut Rig, marker: &str) -> Vec<Seen> {
    let marker: Bit = marker.parse().unwrap();
    let end = rig.control.time_us() + 120_000_000;
    let (mut seen, mut begun) = (Vec::new(), false);
    loop {
        let (now, before) = (rig.control.exchange().nc().bit(marker), look(rig));
        if begun && !now {
            return seen;
        }
        // Spindle and axis stand after the marker until the spindle is oriented.
        begun |= now;
        let path = rig.control.observe(&"path.speed".parse().unwrap());
        if !begun || seen.len() < 3 && path == 0.0 {
            seen.clear();
        }
        seen.push(before);
        assert!(
            rig.control.time_us() < end,
            "{:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
        rig.cycle();
    }
}

/// The deepest place below that of the beginning, mm.
fn depth(seen: &[Seen]) -> f64 {
    seen[0].z - seen.iter().map(|seen| seen.z).fold(f64::INFINITY, f64::min)
}

/// The greatest distance of Z from the line through a right-hand thread that begins with the first look, mm.
fn off_the_thread(seen: &[Seen]) -> f64 {
    let line = |seen: &Seen| seen.z + seen.turns * PITCH;
    let off = seen.iter().map(|each| (line(each) - line(&seen[0])).abs());
    off.fold(0.0, f64::max)
}

/// A thread ends where it is programmed, at each speed: spindle overshoot is to be avoided [000:6128]. On the TNC 407 with its
/// servo step of 6 ms, too, where cycle 18 follows cycle 17. The tool axis follows the spindle the whole way, in and out:
/// 0.03 mm are a fiftieth of the pitch. In cycle 2 nothing couples them: feed and speed agree as long as the spindle is at
/// speed, from 2 mm to 12 mm below the beginning; S600 brakes for 0.36 s, 5.4 mm, and S1500 is never at speed. There Z has its
/// own overshoot of a stop, that of pre-control at 1.5 m/s²: 0.03 mm.
#[test]
fn threads_are_as_deep_as_programmed_and_follow_the_spindle() {
    for (model, rpm) in [ControlModel::Tnc415b, ControlModel::Tnc407]
        .into_iter()
        .flat_map(|model| [300.0, 600.0, 1500.0].map(|rpm| (model, rpm)))
    {
        let mut rig = mill(model).program("1.H", &threads(rpm)).rig();
        rig.power_on();
        rig.seconds(0.5);
        for (axis, value) in [("X", 0.0), ("Y", 0.0), ("Z", 100.0)] {
            rig.command(&format!("datum {axis} {value}"));
        }
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        for (cycle, marker, way) in [
            (17, "M2095", SET_UP + DEPTH),
            (18, "M2095", DEPTH),
            (2, "M2048", SET_UP + DEPTH),
        ] {
            let seen = record(&mut rig, marker);
            let beyond = depth(&seen) - way;
            let steady: Vec<Seen> = match cycle {
                2 => {
                    let begin = seen[0].z;
                    let on_the_way = |each: &&Seen| (2.0..12.0).contains(&(begin - each.z));
                    let deepest = seen.iter().position(|each| begin - each.z > 12.0).unwrap();
                    seen[..deepest].iter().filter(on_the_way).copied().collect()
                }
                _ => seen.clone(),
            };
            let off = off_the_thread(&steady);
            let figures = format!("{model:?} S{rpm} cycle {cycle}: {beyond} mm beyond, {off} mm off");
            let (depth_within, within) = match cycle {
                2 if rpm < 1500.0 => (0.03, 0.005),
                2 => (0.03, f64::INFINITY),
                _ => (0.01, 0.03),
            };
            assert!(beyond.abs() < depth_within && off < within, "{figures}");
            assert!(steady.len() > 40, "{figures}");
        }
        assert_eq!(rig.messages(), [""; 0], "{model:?} S{rpm}");
    }
}
