//! Programs of DIN 66025 as text: their blocks and numbers, and why the control's own languages do not execute them.

use bahn_parameters::MessageId;
use bahn_program::{DinLanguage, Operation, Program};

/// Lines 1 to 7 with an empty one; `N 30` may have blanks, a number may stand in a subroutine, too, numbers have no order.
const TEXT: &str = "%L SUB\nn20 X1\n\n%MAIN\n  N0030 G01 X5\nG00 X0\nN 20 M30\n";

fn part() -> Program {
    Program::from_bytes("PARTS/FRAME.NC", TEXT.into())
}

/// A block is called by its N; one without number by its place among the lines that are not empty, from 1. Of two with one
/// number the first is found; one in a subroutine of the file only where no program has the number, since no run begins there.
#[test]
fn numbers() {
    let program = part();
    // BEGIN and END are implied, as in each program that does not write them.
    assert_eq!(program.block_count(), 1 + 6 + 1);
    let called: Vec<u32> = (1..=6).map(|block| program.number_of(block)).collect();
    assert_eq!(called, [1, 20, 3, 30, 5, 20]);
    let found = [20, 30, 5, 3].map(|number| program.block_of(number));
    assert_eq!(found, [Some(6), Some(4), Some(5), Some(3)]);
    // Block 4 has a number of its own, and none has 40.
    assert_eq!([4, 40].map(|number| program.block_of(number)), [None, None]);
    let shown: Vec<String> = (1..=6).map(|block| program.shown_number(block)).collect();
    assert_eq!(shown, ["", "N20", "", "N30", "", "N20"]);
    assert_eq!(program.line_of(4), 5);
    // N7 stands in the subroutine alone, whose head may have blanks and a comment; N8 in the program after it.
    let text = "N5 X1\n  %l  SUB ;N8\nN5 X2\nN7 X3\nN8 X4\n%LINE\nN8 X5\n";
    let several = Program::from_bytes("1.nc", text.into());
    let found = [5, 7, 8].map(|number| several.block_of(number));
    assert_eq!(found, [Some(1), Some(4), Some(7)]);
    // In a long file, too, which is read in pieces of 256 blocks.
    let long = Program::from_bytes(
        "1.nc",
        ["%L S\n", &"N1 X1\n".repeat(1000), "%M\nN1 X2\n"].concat().into(),
    );
    assert_eq!(long.block_of(1), Some(1003));
    // A number that no counter holds is none.
    let long = Program::from_bytes("1.nc", "N99999999999 X1\n".into());
    assert_eq!(long.number_of(1), 1);
}

/// Whoever executes it as a part of a program of the control gets its message at each block, never another meaning.
#[test]
fn no_block_has_a_meaning_of_plain_language() {
    // Both lines are blocks of plain language, too.
    let program = Program::from_bytes("SUB.nc", b"M30\n;L X+5\n".to_vec());
    assert_eq!(program.dialect(), Some(DinLanguage::Tf5200));
    assert!(program.refused().unwrap().contains("DIN 66025"));
    for block in &program.decode(0).blocks[1..3] {
        let Operation::Invalid(invalid) = &block.operation else {
            panic!("{block:?}")
        };
        assert_eq!(invalid.error.message, MessageId::BlockNotSupported);
    }
    let found = program.diagnostics(None);
    assert_eq!(found.len(), 1, "one line says all: {found:?}");
}

/// Shops name programs in plain language `.nc`, too: those begin with BEGIN PGM, after comments or not.
#[test]
fn plain_language_with_this_ending() {
    for text in [
        "BEGIN PGM 1 MM\nEND PGM 1 MM\n",
        "; of 1987\n0 BEGIN PGM 1 MM\n1 END PGM 1 MM\n",
    ] {
        let program = Program::from_bytes("1.NC", text.into());
        assert!(
            program.dialect().is_none() && program.begins_with_header(),
            "{text}"
        );
    }
    assert!(
        Program::of_din("side.sub", b"N10 M17".to_vec())
            .dialect()
            .is_some()
    );
}

/// While it is transferred its first block says what it is; a comment and half a block do not yet.
#[test]
fn transferred() {
    let begun = Program::growing("1.NC").more(b"; part\nN10 G0");
    assert!(begun.refused().is_none());
    let din = begun.more(b"1 X5 F500\nN20 M30\n");
    assert!(din.dialect().is_some() && din.refused().is_some() && din.is_growing());
    assert_eq!(din.number_of(2), 10);
    assert!(din.completed().dialect().is_some());
    assert!(
        Program::growing("1.NC")
            .more(b"N10 M30")
            .completed()
            .dialect()
            .is_some()
    );
    let plain = Program::growing("1.NC")
        .more(b"; part\n")
        .more(b"BEGIN PGM 1 MM\nL X+5\nEND PGM 1 MM\n");
    assert!(plain.dialect().is_none() && plain.block_count() == 3);
}

/// A program of a System 900 is called by its numbers, too, which `/` may stand before; `{` opens a comment. It has no heads,
/// and is never plain language.
#[test]
fn of_a_system_900() {
    let text = "{ part }\n/ N0020 X1\n%L SUB\nN30 M30\n";
    let program = Program::from_bytes("P1000.900", text.into());
    assert_eq!(program.dialect(), Some(DinLanguage::System900));
    assert!(program.refused().unwrap().contains("System 900"));
    let called: Vec<u32> = (1..=4).map(|block| program.number_of(block)).collect();
    assert_eq!(called, [1, 20, 3, 30]);
    assert_eq!(program.block_of(30), Some(4));
    let found = program.diagnostics(None);
    assert_eq!(found.len(), 1, "one line says all: {found:?}");
    assert_eq!(found[0].span.line, 1);
    let growing = Program::growing("P1.900").more(b"{ part\nBEGIN PGM 1 MM\nL X+5\n");
    assert_eq!(growing.dialect(), Some(DinLanguage::System900));
}
