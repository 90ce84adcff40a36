//! Every program of the repository in plain language, to DIN/ISO and back, has the same path.

mod support;

use std::collections::BTreeSet;

use bahn_parameters::ControlModel;
use bahn_program::Program;
use support::*;

/// What DIN/ISO has no function for, by the beginning of the block.
const WITHOUT_WORD: [&str; 5] = [
    "TCH PROBE 5.",
    "TCH PROBE 6.",
    "TCH PROBE 7.",
    "CYCL DEF 26.",
    "LN ",
];

#[test]
fn every_program_of_the_repository_goes_there_and_back() {
    let files = programs("H");
    let (mut elements, mut whole) = (0, 0);
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        let program = Program::from_bytes(file.to_string_lossy(), bytes);
        let (made, _) = converted(&program, bahn_convert::Language::Iso);
        if let Some(first) = made.refused.first() {
            let known = |text: &str| WITHOUT_WORD.iter().any(|begin| text.starts_with(begin));
            assert!(
                made.refused.iter().all(|listed| known(&listed.text)),
                "{}: {:?}",
                file.display(),
                made.refused
            );
            println!("{}: {}", file.display(), first.reason);
            continue;
        }
        let folder = file.parent().unwrap();
        let proofs = ControlModel::ALL.map(|model| there_and_back(&program, &settings(model), folder));
        let most = proofs.into_iter().max_by_key(|proof| proof.elements);
        let Some(proof) = most else { continue };
        println!(
            "{}: {} elements, {:?}",
            file.display(),
            proof.elements,
            proof.message
        );
        elements += proof.elements;
        whole += 1;
    }
    println!("{whole} of {} programs, {elements} elements", files.len());
    assert!(whole >= 60 && elements > 10_000);
}

#[test]
fn every_program_of_the_repository_becomes_gcode_with_the_same_path() {
    let files = programs("H");
    let (mut elements, mut whole, mut with_user, mut changes) = (0, 0, 0, 0);
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        let program = Program::from_bytes(file.to_string_lossy(), bytes);
        let folder = file.parent().unwrap();
        let (made, proof) = gcode_with(&program, &settings(ControlModel::Tnc415b), folder, true);
        assert!(proof.holds(), "{}: {proof:?}\n{}", file.display(), made.text);
        with_user += u32::from(made.refused.is_empty());
        let (made, proof) = gcode(&program, &settings(ControlModel::Tnc415b), folder);
        assert!(proof.holds(), "{}: {proof:?}\n{}", file.display(), made.text);
        println!(
            "{}: {} elements, {} µm, {:?} {:?}",
            file.display(),
            proof.elements,
            proof.max_deviation_um,
            made.message,
            made.refused
        );
        changes += all_axes_behind_changes(&made.text);
        elements += proof.elements;
        whole += u32::from(made.refused.is_empty());
    }
    println!(
        "{whole} of {} programs, {elements} elements, {changes} changes",
        files.len()
    );
    assert!(changes >= 20, "{changes}");
    assert!(whole >= 55 && with_user >= whole + 5 && elements > 10_000);
}

/// Behind every tool change each axis that lines have moved before is in a line of rapid traverse before anything cuts. How
/// many changes were looked at.
fn all_axes_behind_changes(text: &str) -> u32 {
    let (mut known, mut missing) = (BTreeSet::new(), BTreeSet::new());
    let (mut changes, mut motion) = (0, "");
    for line in text.lines() {
        let words = line.split(';').next().unwrap_or_default().split_whitespace();
        for word in words.clone() {
            match word {
                "M6" => {
                    missing.clone_from(&known);
                    changes += u32::from(!known.is_empty());
                }
                "G0" | "G1" | "G2" | "G3" | "G33" | "G33.1" => motion = word,
                _ => {}
            }
        }
        let axes: Vec<char> = words
            .filter_map(|word| word.chars().next().filter(|letter| "XYZABCUVW".contains(*letter)))
            .collect();
        if axes.is_empty() {
            continue;
        }
        if motion == "G0" {
            missing.retain(|axis| !axes.contains(axis));
        }
        assert!(
            motion == "G0" || missing.is_empty(),
            "{line}: {missing:?} stay behind\n{text}"
        );
        known.extend(axes);
    }
    changes
}
