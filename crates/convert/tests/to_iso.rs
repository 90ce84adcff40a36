//! What DIN/ISO says in another way than plain language.

mod support;

use bahn_convert::{Converted, Language, Options, convert};
use bahn_parameters::ControlModel;
use support::*;

fn iso(blocks: &str) -> Converted {
    let source = program(
        &format!("BEGIN PGM A MM\n{blocks}\nEND PGM A MM\n"),
        Language::Plain,
    );
    convert(&source, Language::Iso, &options())
}

/// A circle without an end point goes all the way round: in DIN/ISO it has no way in either axis of the plane.
#[test]
fn a_circle_without_end_point_has_no_way_in_its_plane() {
    for (tool, begin, centre, words) in [
        ("Z", "X+10 Y+0", "X+0 Y+0", "X+0 Y+0"),
        ("Y", "X+10 Z+0", "X+0 Z+0", "X+0 Z+0"),
        ("X", "Y+10 Z+0", "Y+0 Z+0", "Y+0 Z+0"),
    ] {
        for (sense, function) in [("DR+", "G03"), ("DR-", "G02")] {
            let text = format!(
                "TOOL CALL 1 {tool} S500\nL {begin} R0 FMAX\nCC {centre}\nC {sense} RL F200 M8\nL {begin} R0"
            );
            let made = iso(&text);
            assert!(made.refused.is_empty(), "{:?}", made.refused);
            assert!(
                made.text
                    .contains(&format!(" {function} G41 G91 {words} G90 F200 M8 *")),
                "{}",
                made.text
            );
            let source = program(
                &format!("BEGIN PGM A MM\n{text}\nEND PGM A MM\n"),
                Language::Plain,
            );
            let proof = there_and_back(&source, &settings(ControlModel::Tnc415b), &root());
            assert!(proof.elements >= 2);
        }
    }
    // Tools along different axes: nobody knows the plane of a block, so it is refused.
    let made = iso("TOOL CALL 1 Z\nL X+10 Y+0 Z+0 R0 FMAX\nCC X+0 Y+0\nC DR+\nTOOL CALL 1 Y\nL X+0 R0 FMAX");
    assert_eq!(made.refused.len(), 1);
    assert_eq!(made.refused[0].text, "C DR+");
}

/// A block of the TNC 151/155 has 64 characters: a longer comment goes on in the next block, word by word, and nothing of
/// it is lost. How many went on is said.
#[test]
fn long_comments_go_on_in_the_next_block() {
    let words = "A plate is milled round its outside with radius compensation, then drilled and countersunk.";
    let long = "x".repeat(100);
    let text = format!(
        "BEGIN PGM A MM\n; {words}\n; short\nTOOL CALL 1 Z S500 ; {words}\n; {long}\nL X+1 R0 FMAX\nEND PGM A MM\n"
    );
    let source = program(&text, Language::Plain);
    let made = convert(
        &source,
        Language::Iso,
        &Options {
            characters_max: Some(64),
            ..options()
        },
    );
    assert!(made.refused.is_empty(), "{:?}", made.refused);
    assert_eq!(made.wrapped, 3);
    assert!(
        made.text.lines().all(|line| line.chars().count() <= 64),
        "{}",
        made.text
    );
    assert!(!made.text.contains("ERROR"));
    let comments: Vec<&str> = made
        .text
        .lines()
        .filter_map(|line| Some(line.split_once(';')?.1.trim_end_matches(['*', ' ']).trim()))
        .collect();
    let count = |word: &str| comments.join(" ").matches(word).count();
    for word in words.split(' ').filter(|word| word.len() > 4) {
        let times = text.matches(word).count();
        assert_eq!(count(word), times, "{word} in {comments:?}");
    }
    assert_eq!(
        comments.concat().matches('x').count(),
        100 + words.matches('x').count() * 2
    );
    // Without a limit each stays one block.
    assert_eq!(convert(&source, Language::Iso, &options()).wrapped, 0);
}
