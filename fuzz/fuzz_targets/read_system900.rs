//! Any bytes are a program of a System 900: reading it, with a cycle of the same text, and marking its words never panics
//! and comes to the same end each time; its listing is the same program, and its own listing.
//!
//! ```text
//! cargo +nightly fuzz run read_system900
//! ```

#![no_main]

use std::sync::Arc;

use bahn_din::system900::{Program, WordKind, examine, words};
use bahn_fuzz as _;
use bahn_text::{Files, NamedFile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let all = all_of(bytes);
    assert_eq!(all_of(bytes), all, "another end");
    let listing = listing(bytes);
    assert_eq!(self::listing(&listing), listing, "the listing is not stable");
    assert_eq!(all_of(&listing), all, "the listing is another program");
});

fn listing(bytes: &[u8]) -> Vec<u8> {
    let program = Program::from_bytes("P1.900", bytes);
    program.encoded(&program.listing())
}

/// What a text comes to: how many faults, and the words of its lines that could be read.
fn all_of(bytes: &[u8]) -> (usize, Vec<WordKind>) {
    let program = Arc::new(Program::from_bytes("P1.900", bytes));
    let mut kinds = Vec::new();
    for line in 1..=program.line_count() {
        let _ = words(program.line(line));
        kinds.extend(program.words_read(line).into_iter().map(|word| word.kind));
    }
    (examine(&program, &Itself(bytes.to_vec())).len(), kinds)
}

/// Every cycle up to Z81 is the program itself.
struct Itself(Vec<u8>);

impl Files for Itself {
    fn read(&self, name: &str) -> Option<NamedFile> {
        (name < "Z82").then(|| NamedFile {
            name: name.to_owned(),
            bytes: self.0.clone(),
        })
    }
}
