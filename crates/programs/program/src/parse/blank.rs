//! BLK FORM.

use bahn_parameters::MessageId::{BlkFormDefinitionIncorrect, BlockNotKnown, EntryValueIncorrect};
use bahn_path::Axis;

use super::cursor::{Cursor, Parsed};
use super::path::coordinates;
use crate::Operation;

/// `BLK FORM 0.1 Z X+0 Y+0 Z-20` and `BLK FORM 0.2 X+100 Y+100 Z+0` [003:2638-2639].
pub(super) fn blank_form(c: &mut Cursor) -> Parsed<Option<Operation>> {
    let start = c.position();
    if !(c.keyword("BLK") && c.keyword("FORM")) {
        c.go_to(start);
        return Ok(None);
    }
    c.skip_blanks();
    let corner_start = c.position();
    if c.peek().is_ascii_alphabetic()
        && Axis::from_letter(c.peek()).is_none_or(|_| c.peek_at(1).is_ascii_alphabetic())
    {
        return c.fault_at_word(BlockNotKnown, "no control here knows this form of blank");
    }
    let corner = if c.accept(b'0') && (c.accept(b'.') || c.accept(b',')) {
        c.peek()
    } else {
        b' '
    };
    match corner {
        b'1' => {
            c.advance(1);
            // `BLK FORM 0.1.Z` is printed too [003:4120].
            if !c.at_annotation() {
                c.accept(b'.');
            }
            let axis = tool_axis(c);
            let minimum = coordinates(c)?;
            if !minimum.incremental().is_empty() {
                return c.fault_from(
                    corner_start,
                    BlkFormDefinitionIncorrect,
                    "the MIN point has absolute coordinates only",
                );
            }
            Ok(Some(Operation::BlankMin(minimum, axis)))
        }
        b'2' => {
            c.advance(1);
            Ok(Some(Operation::BlankMax(coordinates(c)?)))
        }
        _ => c.fault_at_word(EntryValueIncorrect, "0.1 or 0.2 is missing"),
    }
}

/// An axis letter without a value.
fn tool_axis(c: &mut Cursor) -> Option<Axis> {
    c.skip_blanks();
    let letter = c.position();
    let axis = Axis::from_letter(c.peek())?;
    c.advance(1);
    if matches!(c.value(), Ok(None)) {
        return Some(axis);
    }
    c.go_to(letter);
    None
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation, words};
    use super::*;

    #[test]
    fn both_corners() {
        let min = Operation::BlankMin(words("X0 Y0 Z-20"), Some(Axis::Z));
        for text in [
            "BLK FORM 0.1 Z X+0 Y+0 Z-20",
            "1 BLK FORM 0.1.Z X+0 Y+0 Z-20",
            "blk form 0,1 ZX0Y0Z-20",
            "BLKFORM 0.1 Z  X+0 Y+0 Z-20....blank",
        ] {
            assert_eq!(operation(text), min, "{text}");
        }
        assert_eq!(
            operation("BLK FORM 0.1 X+0 Y+0 Z-20"),
            Operation::BlankMin(words("X0 Y0 Z-20"), None)
        );
        assert_eq!(
            operation("BLK FORM 0.2 IX+100 IY+100 Z+Q1"),
            Operation::BlankMax(words("IX100 IY100 ZQ1"))
        );
    }

    #[test]
    fn faulty_blanks() {
        assert_eq!(fault("BLK FORM 0.3 X+1"), (EntryValueIncorrect, 12, 1));
        assert_eq!(fault("BLK FORM X+100 Y+100 Z+0"), (EntryValueIncorrect, 10, 5));
        assert_eq!(fault("BLK FORM CYLINDER Z R50"), (BlockNotKnown, 10, 8));
        assert_eq!(
            fault("BLK FORM 0.1 Z IX+0 Y+0 Z-20").0,
            BlkFormDefinitionIncorrect
        );
    }
}
