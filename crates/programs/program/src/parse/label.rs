//! Labels, calls of labels and programs.

use bahn_parameters::MessageId::{BlockNotKnown, EntryValueIncorrect};

use super::cursor::{Cursor, Parsed};
use crate::Operation;
use crate::check::ANY_LABEL_MAX;

/// Reads `LBL n` [003:3662-3670].
pub(super) fn label(c: &mut Cursor) -> Parsed<Option<Operation>> {
    if !c.keyword("LBL") {
        return Ok(None);
    }
    Ok(Some(Operation::Label(label_number(c)?)))
}

/// Reads the number of a label, 0 to 65534.
pub(super) fn label_number(c: &mut Cursor) -> Parsed<u16> {
    c.skip_blanks();
    if matches!(c.peek_upper(), b'"' | b'Q') {
        return c.fault_at_word(BlockNotKnown, "labels have numbers on the controls here");
    }
    let start = c.position();
    c.required_integer(start, ANY_LABEL_MAX, "a label number from 0 to 65534 is missing")
}

/// `CALL LBL n [REP r/r]` and `CALL PGM name`.
pub(super) fn call(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if c.keyword("CALL") {
        if c.keyword("LBL") {
            return call_label(c).map(Some);
        }
        if c.keyword("PGM") {
            return call_program(c).map(Some);
        }
    }
    c.go_to(start);
    Ok(None)
}

/// `PGM CALL name`: the name of the key in the text of the manual [003:3894-3898] [003:4288].
pub(super) fn program_call(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if c.keyword("PGM") && c.keyword("CALL") {
        return call_program(c).map(Some);
    }
    c.go_to(start);
    Ok(None)
}

/// The number after the slash counts the repeats that are left while the section runs [003:3782]; it does
/// not matter when a program is read. An empty REP is a plain call [003:4648].
fn call_label(c: &mut Cursor) -> Parsed<Operation> {
    let label = label_number(c)?;
    let mut repeats = None;
    if c.keyword("REP") {
        repeats = c.value()?;
        if c.accept(b'/') {
            c.value()?;
        }
    }
    Ok(Operation::CallLabel { label, repeats })
}

/// The name is the rest of the block, with directories and blanks if it has any.
fn call_program(c: &mut Cursor) -> Parsed<Operation> {
    let start = c.position();
    let name = c.name();
    if name.is_empty() {
        return c.fault_from(start, EntryValueIncorrect, "the name of the program is missing");
    }
    Ok(Operation::CallProgram(name))
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation, q};
    use super::*;
    use crate::Value::{self, Number};

    #[test]
    fn labels() {
        for text in ["LBL 5", "LBL5", "12 lbl 05", "LBL  5...start"] {
            assert_eq!(operation(text), Operation::Label(5), "{text}");
        }
        assert_eq!(fault("LBL"), (EntryValueIncorrect, 4, 1));
        assert_eq!(operation("LBL 0"), Operation::Label(0));
        assert_eq!(fault("LBL 65535"), (EntryValueIncorrect, 5, 5));
        assert_eq!(fault("LBL \"HOLES\""), (BlockNotKnown, 5, 7));
        assert_eq!(fault("LBL QS1"), (BlockNotKnown, 5, 3));
    }

    #[test]
    fn calls_of_labels() {
        let call = |label, repeats: Option<Value>| Operation::CallLabel { label, repeats };
        assert_eq!(operation("CALL LBL 5"), call(5, None));
        assert_eq!(operation("CALL LBL3"), call(3, None));
        assert_eq!(operation("CALLLBL 3 REP"), call(3, None));
        for text in [
            "CALL LBL 7 REP 10/10",
            "CALL LBL 7 REP10 / 10",
            "CALL LBL 7REP10/3",
            "CALL LBL7 REP 10",
        ] {
            assert_eq!(operation(text), call(7, Some(Number(10.0))), "{text}");
        }
        assert_eq!(operation("CALL LBL 2 REP6"), call(2, Some(Number(6.0))));
        assert_eq!(operation("CALL LBL 2 REP Q1"), call(2, Some(q(1))));
        assert_eq!(fault("CALL LBL \"A\""), (BlockNotKnown, 10, 3));
        assert_eq!(fault("CALL LBL"), (EntryValueIncorrect, 9, 1));
        assert_eq!(
            fault("CALL LBL 1 REP 5/5/5"),
            (bahn_parameters::MessageId::UnexpectedText, 19, 2)
        );
    }

    #[test]
    fn calls_of_programs() {
        let call = |name: &str| Operation::CallProgram(name.into());
        assert_eq!(operation("CALL PGM NAME"), call("NAME"));
        assert_eq!(operation("CALL PGM 50 ; part"), call("50"));
        assert_eq!(operation("CALL PGM12"), call("12"));
        assert_eq!(operation("PGM CALL NAME.H"), call("NAME.H"));
        assert_eq!(
            operation("CALL PGM TNC:\\PARTS\\Nut 8.H"),
            call("TNC:\\PARTS\\Nut 8.H")
        );
        assert_eq!(operation("CALL PGM H\u{f6}he.h"), call("Höhe.h"));
        assert_eq!(fault("CALL PGM"), (EntryValueIncorrect, 9, 1));
    }
}
