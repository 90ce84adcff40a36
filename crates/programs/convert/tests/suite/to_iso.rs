//! What DIN/ISO says in another way than plain language.

use crate::support::*;
use bahn_convert::{Language, Options, convert};

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
