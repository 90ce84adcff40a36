//! The fault campaign over the shipped machines: a fixed set of seeds, and that it would find something.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::path::{Path, PathBuf};

use bahn_host::LoadedMachine;
use bahn_host::torture::{Campaign, Happening, Kind, Rule};

fn folder(machine: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../machines")
        .join(machine)
}

fn campaign(machine: &str) -> Campaign {
    Campaign::load(&folder(machine), &[])
        .unwrap()
        .map_err(|faults| faults.len())
        .unwrap()
}

/// Tries seeds of a machine: every rule holds, and every kind of thing happens in them.
fn try_seeds(machine: &str, seeds: std::ops::Range<u64>) {
    try_campaign(machine, &campaign(machine), seeds);
}

fn try_campaign(machine: &str, campaign: &Campaign, seeds: std::ops::Range<u64>) {
    let mut worker = campaign.worker().unwrap();
    let (mut went_on, mut messages, mut kinds) = (0, 0, std::collections::BTreeSet::new());
    for seed in seeds.clone() {
        let plan = worker.plan(seed);
        let trial = worker.run(&plan);
        if let Some(violation) = &trial.violation {
            let few = worker.shrink(&plan, violation.rule);
            panic!("seed {seed} on {machine}: {violation:?}\n{:#?}", few.happenings);
        }
        went_on += usize::from(trial.went_on);
        messages += trial.messages.len();
        kinds.extend(plan.happenings.iter().map(|happening| happening.kind));
    }
    // Every tenth run at least is stopped and goes on again.
    let count = usize::try_from(seeds.end - seeds.start).unwrap();
    assert!(
        went_on > count / 10 && messages > count / 4,
        "{went_on} {messages}"
    );
    // What the operator moves by hand not every machine has.
    assert!(kinds.len() >= 6, "{kinds:?}");
}

#[test]
fn the_mill_keeps_every_rule() {
    try_seeds("mill", 0..800);
}

#[test]
fn the_mill_of_a_tnc_360_keeps_every_rule() {
    try_seeds("mill-tnc360", 0..700);
}

#[test]
fn the_twin_keeps_every_rule() {
    try_seeds("twin", 0..500);
}

/// Tools come from the magazine: MP4310.0 bit 1, any pocket.
#[test]
fn the_mill_with_its_magazine_keeps_every_rule() {
    let mut machine = LoadedMachine::load(&folder("mill")).unwrap().unwrap();
    for assignment in ["7480.0=3", "4310.0=3"] {
        machine.parameters.assign(assignment).unwrap();
    }
    let campaign = Campaign::new(machine, &["BRACKET.H".to_owned()]).unwrap();
    try_campaign("mill with its magazine", &campaign, 0..250);
}

#[test]
fn the_gantry_keeps_every_rule() {
    try_seeds("gantry", 0..250);
}

#[test]
fn the_mill_with_digital_drives_keeps_every_rule() {
    try_seeds("dig425", 0..350);
}

/// A PLC program that hangs in a loop (M198) or calls itself (M199): time-out and nesting too deep stop PLC and machine with
/// a flashing message, and behind power-off, which resets the markers, the run goes on.
#[test]
fn a_plc_program_that_fails_breaks_no_rule() {
    let copy = std::env::temp_dir().join(format!("bahn-torture-plc-{}", std::process::id()));
    copy_all(&folder("mill-tnc360"), &copy);
    let program = copy.join("plc/MAIN.PLC");
    let text = std::fs::read_to_string(&program).unwrap();
    let begin = "       L     M198\n       CMT   HANGS\n       L     M199\n       CMT   DEEPER\n";
    let end = "LBL HANGS\n       JP    HANGS\nLBL DEEPER\n       CM    DEEPER\n       EM\n";
    std::fs::write(&program, format!("{begin}{text}\n{end}")).unwrap();
    let mut campaign = Campaign::load(&copy, &[])
        .unwrap()
        .map_err(|faults| faults.len())
        .unwrap();
    assert!(campaign.also("M198").is_err(), "no event");
    campaign.also("M198=1").unwrap();
    campaign.also("M199=1").unwrap();
    let mut worker = campaign.worker().unwrap();
    let mut stopped = std::collections::BTreeSet::new();
    for seed in 0..300 {
        let plan = worker.plan(seed);
        let fails = |what: &Happening| ["M198=1", "M199=1"].contains(&what.what.as_str());
        if !plan.happenings.iter().any(fails) {
            continue;
        }
        let trial = worker.run(&plan);
        assert_eq!(trial.violation, None, "seed {seed}");
        let said = trial
            .messages
            .iter()
            .filter(|text| text.starts_with("ERROR IN PLC-PROGRAM 5"));
        stopped.extend(said.cloned());
    }
    let _ = std::fs::remove_dir_all(&copy);
    assert!(!stopped.is_empty(), "no program failed");
}

/// A seed is the same run every time, and whatever came before it.
#[test]
fn a_seed_says_everything() {
    let campaign = campaign("mill-tnc360");
    let (mut one, mut other) = (campaign.worker().unwrap(), campaign.worker().unwrap());
    for seed in 5000..5010 {
        let plan = other.plan(seed);
        drop(other.run(&plan));
    }
    for seed in [5007, 5003] {
        let plan = one.plan(seed);
        let (a, b) = (one.run(&plan), other.run(&plan));
        assert_eq!(
            (a.done, a.machine_us, a.messages),
            (b.done, b.machine_us, b.messages),
            "{seed}"
        );
    }
}

/// A PLC program that withholds the feed enable for good once an EMERGENCY STOP was shown (M2191): the run hangs without
/// a word. The campaign finds it, and of all that happened in the seed the EMERGENCY STOP is left.
#[test]
fn a_plc_program_that_lets_a_run_hang_is_found_out() {
    let copy = std::env::temp_dir().join(format!("bahn-torture-test-{}", std::process::id()));
    copy_all(&folder("mill-tnc360"), &copy);
    let program = copy.join("plc/MAIN.PLC");
    let text = std::fs::read_to_string(&program).unwrap();
    let enable = "       L     I3\n       = M2451\n";
    let hangs = "       L     M2191\n       S     M199\n       L     I3\n       AN    M199\n       = M2451\n";
    assert!(text.contains(enable));
    std::fs::write(&program, text.replacen(enable, hangs, 1)).unwrap();
    let campaign = Campaign::load(&copy, &[])
        .unwrap()
        .map_err(|faults| faults.len())
        .unwrap();
    let mut worker = campaign.worker().unwrap();
    let broken = (0..300).find_map(|seed| {
        let plan = worker.plan(seed);
        let trial = worker.run(&plan);
        let is_stop = |kind| kind == Kind::Emergency;
        let stopped = plan.happenings.iter().any(|happening| is_stop(happening.kind));
        let violation = trial.violation.clone().filter(|_| stopped)?;
        Some((plan, trial, violation))
    });
    let _ = std::fs::remove_dir_all(&copy);
    let (plan, trial, violation) = broken.unwrap();
    assert_eq!(violation.rule, Rule::Recovery, "{violation:?}");
    let few = worker.shrink(&plan, violation.rule);
    assert_eq!(few.happenings.len(), 1, "{:#?}", few.happenings);
    assert_eq!(worker.run(&few).violation.unwrap().rule, Rule::Recovery);
    let script = campaign.script(&plan, &trial, "machines/broken");
    assert!(
        script.contains("--machine machines/broken") && script.contains("NC_START tap"),
        "{script}"
    );
}

/// A copy of a machine.
fn copy_all(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true if entry.file_name() == "state" => {}
            true => copy_all(&entry.path(), &target),
            false => drop(std::fs::copy(entry.path(), &target).unwrap()),
        }
    }
}
