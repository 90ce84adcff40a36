//! Any bytes are a program in DIN 66025: reading it, marking its words and executing it never panics and comes to the
//! same end each time; its listing is the same program, and its own listing.
//!
//! ```text
//! cargo +nightly fuzz run read_din
//! ```

#![no_main]

use std::sync::Arc;

use bahn_din::{Decoder, FunctionLetter, Program, Step, Variable, Variables, words};
use bahn_fuzz as _;
use bahn_path::Position;
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
    let program = Program::from_bytes("FUZZ.NC", bytes);
    program.encoded(&program.listing())
}

/// What a text comes to: faults, landmarks, and the first steps of its programs.
fn all_of(bytes: &[u8]) -> (usize, usize, Vec<Step>) {
    let program = Arc::new(Program::from_bytes("FUZZ.NC", bytes));
    for line in 1..=program.line_count() {
        let _ = words(program.line(line));
    }
    let files: Arc<dyn Files> = Arc::new(Itself(bytes.to_vec()));
    let mut steps = Vec::new();
    for main in program.mains().take(8) {
        let mut decoder = Decoder::new(Arc::clone(&program), main, Position::ZERO, Arc::clone(&files));
        for _ in 0..500 {
            let mut step = decoder.next(&mut Numbers);
            // Words have other columns in the listing.
            match &mut step {
                Step::Unit(unit) => unit.functions.iter_mut().for_each(|function| function.column = 0),
                Step::Fault(fault) => (fault.column, fault.length) = (0, 0),
                Step::End => {}
            }
            let is_over = !matches!(step, Step::Unit(_));
            steps.push(step);
            if is_over {
                break;
            }
        }
    }
    (program.faults().len(), program.landmarks().len(), steps)
}

/// Every file is the program itself.
struct Itself(Vec<u8>);

impl Files for Itself {
    fn read(&self, name: &str) -> Option<NamedFile> {
        (name.len() < 4).then(|| NamedFile {
            name: name.to_owned(),
            bytes: self.0.clone(),
        })
    }
}

/// A channel whose variables are their index.
struct Numbers;

impl Variables for Numbers {
    fn read(&mut self, variable: &Variable) -> Result<f64, String> {
        Ok(f64::from(variable.index.unwrap_or(1)))
    }

    fn write(&mut self, _variable: &Variable, value: f64) -> Result<(), String> {
        if value < -1e6 { Err("too small".into()) } else { Ok(()) }
    }

    fn exists(&self, letter: FunctionLetter, number: u16) -> bool {
        (letter == FunctionLetter::M) == (number % 2 == 0)
    }
}
