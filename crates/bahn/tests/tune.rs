//! `bahn tune`: the commissioning assistant on three plants.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod support;

use bahn_parameters::{Adjustment, ControlModel, ParameterList};
use support::*;

/// What the assistant adjusts, as the reference list of a model has it, for X and Y.
fn reference(model: ControlModel) -> String {
    use Adjustment::*;
    let list = ParameterList::reference(model);
    let adjusted = [
        ServoLag,
        Transient,
        KvPrecontrol,
        KvLag,
        LagMonitor,
        LagEmergency,
        Proportional,
        Integral,
        SpeedMonitor,
        AccelerationPrecontrol,
        DigitalReversal,
        ReversalHeight,
        ReversalStep,
        StictionFactor,
        Backlash,
    ];
    let mut entries = Vec::new();
    for what in adjusted {
        for axis in [0, 1] {
            if let Some(value) = list.adjustment(what, axis) {
                let mut copy = list.clone();
                let (id, value) = copy.adjust(what, axis, value).unwrap();
                entries.push(format!("{}={value}", id.to_string().trim_start_matches("MP")));
            }
        }
    }
    // With the kv of the reference list the lag at rapid traverse is greater than its monitoring permits.
    let monitors = [
        "1710.0=300",
        "1710.1=300",
        "1710.2=300",
        "1720.0=300",
        "1720.1=300",
        "1720.2=300",
    ];
    entries.retain(|entry| !entry.starts_with("17"));
    entries.extend(monitors.map(str::to_owned));
    entries.join(",")
}

/// The contour error of the circle test is at least halved against the reference list.
#[test]
fn the_contour_error_is_halved_on_three_plants() {
    for (machine, model) in [
        ("mill", ControlModel::Tnc415b),
        ("mill-tnc360", ControlModel::Tnc360),
        ("dig425", ControlModel::Tnc425),
    ] {
        let folder = Folder::new();
        copy(&machines().join(machine), &folder.path("m"));
        let run = folder.bahn(&format!("tune m X,Y --format json --mp {}", reference(model)));
        assert_eq!(run.code(), 0, "{machine}: {}", run.err());
        let report = run.json();
        let (before, after) = (
            number(&report, "/before/contour_mm"),
            number(&report, "/after/contour_mm"),
        );
        assert!(
            after > 0.0 && after <= 0.5 * before,
            "{machine}: {before} {after}"
        );
        let overshoot = number(&report, "/after/overshoot_mm");
        assert!(
            overshoot <= number(&report, "/before/overshoot_mm").max(0.005),
            "{machine}: {overshoot}"
        );
        assert!(report["trials"].as_u64().unwrap() < 150);
    }
}

/// --write changes the entries that are reported and nothing else of the list; the tuned machine has nothing left that gets
/// twice as good, and its picture shows both.
#[test]
fn what_is_written_is_what_was_proposed() {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc360"), &folder.path("m"));
    let list = folder.read("m/parameters.mp");
    let asked = folder.bahn("tune m X --picture tuned.png --format json");
    assert_eq!(asked.code(), 0, "{}", asked.err());
    assert_eq!(
        folder.read("m/parameters.mp"),
        list,
        "without --write nothing is changed"
    );
    assert!(folder.path("tuned.png").metadata().unwrap().len() > 5000);
    let written = folder.bahn("tune m X --write --format json");
    let (asked, written) = (asked.json(), written.json());
    assert_eq!(
        asked["changes"], written["changes"],
        "the same trials give the same bits"
    );
    let changes = written["changes"].as_array().unwrap();
    assert!(!changes.is_empty());
    let new = folder.read("m/parameters.mp");
    let differing = list
        .lines()
        .zip(new.lines())
        .filter(|(old, new)| old != new)
        .count();
    assert_eq!(
        (list.lines().count(), differing),
        (new.lines().count(), changes.len())
    );
    let again = folder.bahn("tune m X --format json").json();
    let (after, before) = (
        number(&written, "/after/contour_mm"),
        number(&again, "/before/contour_mm"),
    );
    assert!((after - before).abs() < 1e-9, "{after} {before}");
    assert_eq!(folder.bahn("machine check m").code(), 0);
}

#[test]
fn wrong_use_says_what_is_right() {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc360"), &folder.path("m"));
    for (arguments, code, expected) in [
        ("m Z", 2, "in the plane of X and Y"),
        ("m X --radius 0", 2, "greater than 0"),
        ("m X --radius 500", 1, "has no place in the travel of X"),
        ("m X --picture a.gif", 2, ".svg or .png"),
        ("nowhere X", 2, "nowhere"),
        ("m X --mp 9999=1", 2, "9999"),
        // A machine that does not get through its circle.
        ("m X --mp 1710.0=0.001", 1, "POSITIONING ERROR"),
    ] {
        let run = folder.bahn(&format!("tune {arguments}"));
        assert_eq!(run.code(), code, "{arguments}: {}", run.err());
        assert!(run.err().contains(expected), "{arguments}: {}", run.err());
    }
}
