//! Any bytes are a program: reading, checking and formatting them never panics, and the listing gives the
//! same blocks again.
//!
//! ```text
//! cargo +nightly fuzz run parse_program
//! ```

#![no_main]

use bahn_fuzz as _;
use bahn_parameters::ControlModel;
use bahn_program::{Block, FormatOptions, Operation, Program, format_program};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let program = Program::from_bytes("FUZZ.H", bytes.to_vec());
    let _ = program.diagnostics(Some(ControlModel::Tnc360.limits().into()));
    let options = FormatOptions {
        decimal_comma: bytes.len() % 2 == 1,
        ..FormatOptions::default()
    };
    let listing = format_program(&program, options).to_string();
    let again = Program::from_bytes("FUZZ.H", listing.clone().into_bytes());
    assert_eq!(blocks(&again), blocks(&program), "the listing gives other blocks");
    assert_eq!(
        format_program(&again, options).to_string(),
        listing,
        "the listing is not stable"
    );
});

/// The blocks without the places of faults, which move with the text before them.
fn blocks(program: &Program) -> Vec<Block> {
    let without_place = |mut block: Block| {
        if let Operation::Invalid(invalid) = &mut block.operation {
            (invalid.error.line, invalid.error.column, invalid.error.length) = (0, 0, 0);
        }
        block
    };
    program
        .blocks()
        .map(|numbered| without_place(numbered.block))
        .collect()
}
