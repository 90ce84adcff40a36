//! Every program of the repository in plain language, to DIN/ISO and back, has the same path.

use crate::support::*;
use bahn_parameters::ControlModel;
use bahn_program::Program;

/// A circle without an end ends where it began: G03 with both axes of its plane, 0 farther on. In the plane of Y as the tool axis
/// these are Z and X.
#[test]
fn a_circle_without_an_end_is_a_full_one() {
    for (tool_axis, begin, centre, written) in [
        ("Z", "L X+10 Y+20", "CC X+0 Y+0", "G03 G91 X+0 Y+0"),
        ("Y", "L X+10 Z+20", "CC X+0 Z+0", "G03 G91 X+0 Z+0"),
        // The plane of a circle is that of its centre.
        ("Z", "L X+10 Z+20", "CC X+0 Z+0", "G03 G91 X+0 Z+0"),
        ("X", "L Y+10 Z+20", "CC Y+0 Z+0", "G03 G91 Y+0 Z+0"),
    ] {
        let source = program(
            &format!(
                "BEGIN PGM A MM\nTOOL CALL 1 {tool_axis} S500\n{begin} R0 F500\n{centre}\nC DR+\nC DR-\nEND PGM A MM\n"
            ),
            bahn_convert::Language::Plain,
        );
        let (made, _) = converted(&source, bahn_convert::Language::Iso);
        assert!(made.text.contains(written), "{}", made.text);
        let proof = there_and_back(&source, &settings(ControlModel::Tnc415b), &root());
        assert_eq!((proof.elements, &proof.message), (4, &None), "{}", made.text);
    }
}

/// What DIN/ISO has no function for, by the beginning of the block.
const WITHOUT_WORD: [&str; 9] = [
    "DLG-",
    "TCH PROBE 30.",
    "TCH PROBE 31.",
    "TCH PROBE 32.",
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
        // A model whose blocks are shorter would have refused them [001:1174-1183].
        let longest = made
            .text
            .lines()
            .map(|line| line.chars().count())
            .max()
            .unwrap_or(0);
        let fits = |model: &ControlModel| longest <= model.limits().iso_characters_max as usize;
        let proofs = ControlModel::ALL.into_iter().filter(fits);
        let proofs = proofs.map(|model| there_and_back(&program, &settings(model), folder));
        let most = proofs.max_by_key(|proof| proof.elements);
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
    let (mut elements, mut whole, mut with_user) = (0, 0, 0);
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
        elements += proof.elements;
        whole += u32::from(made.refused.is_empty());
    }
    println!("{whole} of {} programs, {elements} elements", files.len());
    assert!(whole >= 55 && with_user >= whole + 5 && elements > 10_000);
}
