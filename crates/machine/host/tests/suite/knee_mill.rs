//! The reference run of the knee mill with a TNC 155, by its cams [001:951-995].

use crate::support::*;
use bahn_host::{Host, LoadedMachine, PowerOn};
use bahn_tnc::Mode;

/// The axes with their reference marks as they stand in plant.toml: X and Y have one, Z that of its screw which the open cam E6
/// chooses.
const MARKS: [(char, f64); 3] = [('X', 590.0), ('Y', 290.0), ('Z', 395.0)];

fn edited(edits: &[(&str, &str)], what: &str) -> (Copy, LoadedMachine) {
    let copy = Copy::of("mill-tnc155", what);
    let path = copy.path().join("plant.toml");
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (from, to) in edits {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    std::fs::write(path, text).unwrap();
    let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
    (copy, machine)
}

fn closed(host: &Host, input: &str) -> bool {
    host.control().exchange().plc().bit(input.parse().unwrap())
}

/// Power-on until the reference run is over, and where its axes stood at the least. Fails when it does not end.
fn reference_run(machine: &LoadedMachine) -> (Host, [f64; 3]) {
    let mut host = host(machine, PowerOn::fresh(machine), "L X+10 R0 F9999\nL M30");
    let table = |host: &Host| MARKS.map(|(axis, _)| host.plant().axis(axis).unwrap().position);
    let mut least = table(&host);
    while host.control().snapshot().axes.iter().any(|axis| !axis.referenced)
        || host.control().snapshot().mode == Mode::Reference
    {
        assert!(
            host.control().time_us() < 90_000_000,
            "{:?}",
            host.control().snapshot()
        );
        host.step().unwrap();
        for (least, now) in least.iter_mut().zip(table(&host)) {
            *least = least.min(now);
        }
    }
    (host, least)
}

/// Positions count from the marks: the place on the table less that of the mark, but for the play of the screw of Z and the way
/// of some milliseconds between the two looks.
fn counts_from_the_marks(host: &Host) {
    for (axis, mark) in MARKS {
        let place = host.plant().axis(axis).unwrap().position;
        let shown = host.control().snapshot();
        let shown = shown.axes.iter().find(|shown| shown.letter == axis).unwrap();
        assert!(
            (shown.machine - (place - mark)).abs() < 0.05,
            "{axis}: {shown:?} at {place}"
        );
    }
}

/// From within the travel: Z, X, Y (MP59 = 12) each to the mark under its cam. Afterwards each stands on its cam, which is closed from
/// there to past the limit switch [001:957].
#[test]
fn each_axis_finds_the_mark_under_its_cam() {
    let machine = machine("mill-tnc155");
    let (mut host, least) = reference_run(&machine);
    assert_eq!(
        least.map(f64::round),
        [180.0, 110.0, 250.0],
        "none was backed off"
    );
    counts_from_the_marks(&host);
    seconds(&mut host, 0.5);
    assert_eq!(["E0", "E1", "E2"].map(|cam| closed(&host, cam)), [true; 3]);
}

/// Switched off on the cams, behind the marks: MP69 = 1 backs the axes off before they look for the mark [001:989-995]. The cams
/// begin at 585, 285 and 385 mm.
#[test]
fn axes_on_their_cams_are_backed_off_first() {
    let (_copy, machine) = edited(
        &[
            ("start = 180", "start = 596"),
            ("start = 110", "start = 297"),
            ("start = 250", "start = 401"),
        ],
        "knee-mill-on-its-cams",
    );
    let (host, least) = reference_run(&machine);
    for ((place, cam), (axis, _)) in least.into_iter().zip([585.0, 285.0, 385.0]).zip(MARKS) {
        assert!((cam - 10.0..cam).contains(&place), "{axis} went back to {place}");
    }
    counts_from_the_marks(&host);
}

/// With the end cam 3 mm early the pulse at 385 mm lies under it, too, 10 mm before the one that is wanted: E6 is closed there, so
/// that it does not count [001:967-969].
#[test]
fn the_inhibit_cam_chooses_the_pulse_of_the_screw() {
    let (_copy, machine) = edited(
        &[("range = [385, 410]", "range = [382, 410]")],
        "knee-mill-early-cam",
    );
    let (host, _) = reference_run(&machine);
    counts_from_the_marks(&host);
}
