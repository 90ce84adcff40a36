//! Laws that hold for any bytes in any language.

use bahn_parameters::ControlModel;
use bahn_program::{Block, FormatOptions, Operation, Program, format_program};

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

/// The listing of a program is the program again and the same listing; chunks are all of it; what is wrong for a control
/// lies inside of its line. The program is handed back.
pub fn check_listings(file: &str, bytes: &[u8], written: [FormatOptions; 2], model: ControlModel) -> Program {
    let read = |bytes: &[u8]| Program::from_bytes(file, bytes.to_vec());
    let program = read(bytes);
    let all = blocks(&program);
    assert_eq!(all.len(), program.block_count() as usize);
    for options in written {
        let listing = format_program(&program, options).to_string();
        let again = read(listing.as_bytes());
        assert_eq!(
            blocks(&again),
            all,
            "{:?}\n{listing}",
            String::from_utf8_lossy(bytes)
        );
        assert_eq!(
            format_program(&again, options).to_string(),
            listing,
            "{listing:?}"
        );
    }
    let joined: usize = (0..program.chunk_count())
        .map(|chunk| program.decode(chunk).blocks.len())
        .sum();
    assert_eq!(joined, all.len());
    for diagnostic in program.diagnostics(Some(model.limits().into())) {
        let line = program.text_of_line(diagnostic.span.line);
        let end = diagnostic.span.column + diagnostic.span.length - 1;
        let inside = diagnostic.span.column >= 1 && end as usize <= line.chars().count() + 1;
        assert!(
            inside,
            "{diagnostic:?} lies outside of {line:?} {:?}",
            String::from_utf8_lossy(bytes)
        );
    }
    program
}
