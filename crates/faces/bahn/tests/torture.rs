//! `bahn torture` and `bahn faults`: a campaign, a seed as a script, the table of faults.
#![allow(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

mod support;

use support::{Folder, holds_document, machines};

#[test]
fn the_document_is_the_table_of_faults() {
    holds_document("docs/faults.md", "faults --format markdown", "make faults");
}

/// POSITIONING ERROR ramps and is cleared with CE; a gross one flashes [000:5192-5224].
#[test]
fn the_table_says_what_is_done() {
    let run = Folder::new().bahn("faults --format json");
    let table = run.json();
    let row = |id: &str| {
        table
            .as_array()
            .unwrap()
            .iter()
            .find(|row| row["id"] == id)
            .unwrap()
            .clone()
    };
    let lag = row("Positioning");
    assert_eq!(
        (lag["message"].as_str(), lag["flashes"].as_bool()),
        (Some("POSITIONING ERROR <AXIS>"), Some(false))
    );
    assert_eq!(
        (lag["reaction"].as_str(), lag["clearing"].as_str()),
        (Some("ramp (MP1060)"), Some("CE"))
    );
    let gross = row("GrossDeviation");
    assert_eq!(
        (gross["flashes"].as_bool(), gross["clearing"].as_str()),
        (Some(true), Some("power off"))
    );
    let text = Folder::new().bahn("faults --model tnc360").out();
    assert!(
        text.contains("EmergencyStopDefective") && text.contains("cleared by power off"),
        "{text}"
    );
}

/// One seed is recorded, and `bahn run` does the same at the same times: the messages of the campaign come again.
#[test]
fn a_seed_is_a_script() {
    let folder = Folder::new();
    let mill = machines().join("mill-tnc360");
    let mill = mill.display();
    let run = folder.bahn(&format!(
        "torture --machine {mill} --program COVER.H --seeds 31..32 --jobs 1 --format json --record seed.txt"
    ));
    assert_eq!(run.code(), 0, "{} {}", run.out(), run.err());
    let report = run.json();
    assert_eq!(report["machines"][0]["seeds"], 1);
    assert_eq!(report["violations"].as_array().unwrap().len(), 0);
    let script = folder.read("seed.txt");
    assert!(script.starts_with("; seed 31 on "), "{script}");
    let again = folder.bahn(&format!(
        "run COVER.H --machine {mill} --fresh --operator full --script seed.txt --format json --no-graphics"
    ));
    // The undisturbed run has messages of its own besides.
    let messages = again.json()["messages"].as_array().map_or(0, Vec::len);
    let seen = report["machines"][0]["messages"].as_u64().unwrap();
    assert!(messages as u64 >= seen, "{messages} {seen}");
    let same = folder.bahn(&format!(
        "torture --machine {mill} --program COVER.H --seeds 31..32 --jobs 1 --format json --record seed.txt"
    ));
    assert_eq!((same.out(), folder.read("seed.txt")), (run.out(), script));
}

#[test]
fn wrong_seeds_and_machines_are_refused() {
    let folder = Folder::new();
    for arguments in [
        "torture --seeds 5",
        "torture --seeds 9..3",
        "torture --machine nowhere",
        "torture --jobs 0",
    ] {
        let run = folder.bahn(arguments);
        assert_eq!(run.code(), 2, "{arguments}: {}", run.err());
    }
    assert!(folder.bahn("torture --seeds 5").err().contains("0..1000"));
}
