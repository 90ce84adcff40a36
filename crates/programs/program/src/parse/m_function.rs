//! M functions, alone and in other blocks.

use bahn_parameters::MessageId::{BlockNotKnown, UnexpectedText};

use super::cursor::{Cursor, Parsed};
use crate::{MArgument, MFunctions, Operation};

/// Greatest M function that a control here knows or passes to its PLC; more digits belong to later ones.
const MAX_M: u32 = 999;

/// M functions that take words, and their address letters: M103 F [000:7280], M112 T A [000:5134],
/// M118 handwheel ranges [000:742], M200 to M204 voltages, characteristic and time of a laser [000:9848-9909],
/// and look-ahead LA, filter T and tilting feed F of later software.
const ARGUMENTS: &[(u16, &[u8])] = &[
    (103, b"F"),
    (112, b"TA"),
    (118, b"XYZABCUVW"),
    (120, b"L"),
    (124, b"T"),
    (128, b"F"),
    (200, b"V"),
    (201, b"V"),
    (202, b"F"),
    (203, b"VT"),
    (204, b"VT"),
];

/// Words that are written with more than their letter: look-ahead LA, characteristic FNR, ramp TIME.
pub(crate) fn rest_of_word(code: u16, letter: char) -> &'static str {
    match (code, letter) {
        (120, 'L') => "A",
        (202, 'F') => "NR",
        (203 | 204, 'T') => "IME",
        _ => "",
    }
}

/// Address letters of the words that an M function takes, and what each is written with after its letter.
///
/// ```
/// use bahn_program::m_words;
///
/// let words: Vec<_> = m_words(203).collect();
/// assert_eq!(words, [('V', ""), ('T', "IME")]);
/// ```
pub fn m_words(code: u16) -> impl Iterator<Item = (char, &'static str)> {
    let row = ARGUMENTS.iter().find(|(with_words, _)| *with_words == code);
    let letters = row.map_or(&[][..], |(_, letters)| letters).iter();
    letters.map(move |letter| (char::from(*letter), rest_of_word(code, char::from(*letter))))
}

/// A block of M functions only: `M8`, `M3 M8`.
pub(super) fn block(c: &mut Cursor) -> Parsed<Option<Operation>> {
    if c.peek_at(1).is_ascii_alphabetic() {
        return Ok(None);
    }
    Ok(Some(Operation::Miscellaneous(m_functions(c)?)))
}

/// M functions up to the end of the block.
pub(super) fn m_functions(c: &mut Cursor) -> Parsed<MFunctions> {
    let mut m = MFunctions::default();
    while !c.at_end() {
        if c.peek_upper() != b'M' {
            return c.unexpected();
        }
        m_function(c, &mut m)?;
    }
    Ok(m)
}

/// One M function with its words, or an empty `M` of the screen, which is passed over [003:303].
#[inline]
pub(crate) fn m_function(c: &mut Cursor, m: &mut MFunctions) -> Parsed<()> {
    let start = c.position();
    c.advance(1);
    let touches = c.peek();
    let Some(number) = c.integer(start)? else {
        if touches.is_ascii_alphanumeric() {
            c.go_to(start);
            return c.not_known();
        }
        return Ok(());
    };
    if number > MAX_M {
        return c.fault_from(start, BlockNotKnown, "no control here knows this M function");
    }
    let code = number as u16;
    if m.contains(code) {
        return c.fault_from(start, UnexpectedText, "the M function stands twice in the block");
    }
    if !m.push(code) {
        return c.fault_from(start, UnexpectedText, "too many M functions in the block");
    }
    if let Some((_, letters)) = ARGUMENTS
        .iter()
        .find(|(with_arguments, _)| *with_arguments == code)
    {
        arguments(c, code, letters, m)?;
    }
    Ok(())
}

/// The words that follow an M function as long as their letters belong to it.
#[cold]
fn arguments(c: &mut Cursor, code: u16, letters: &[u8], m: &mut MFunctions) -> Parsed<()> {
    let mut found: Vec<MArgument> = m.arguments.take().map(Vec::from).unwrap_or_default();
    let first = found.len();
    while !c.at_end() {
        let start = c.position();
        let letter = c.peek_upper();
        let known = letters.contains(&letter);
        let twice = found.iter().skip(first).any(|a| a.letter == char::from(letter));
        if !known || twice {
            break;
        }
        c.advance(1);
        let mut rest = rest_of_word(code, char::from(letter)).bytes();
        if !rest.all(|byte| c.accept(byte)) {
            c.go_to(start);
            break;
        }
        if code == 202 {
            // The number of the characteristic, M202 FNR.5, has a point before it.
            c.accept(b'.');
        }
        match c.value()? {
            Some(value) => found.push(MArgument {
                code,
                letter: char::from(letter),
                value,
            }),
            None => {
                c.go_to(start);
                break;
            }
        }
    }
    m.arguments = (!found.is_empty()).then(|| found.into());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, m, operation};
    use super::*;
    use crate::{Feed, Value};

    #[test]
    fn blocks_of_m_functions() {
        assert_eq!(operation("M8"), Operation::Miscellaneous(m(&[8])));
        assert_eq!(operation("M3 M8"), Operation::Miscellaneous(m(&[3, 8])));
        assert_eq!(operation("M 03M08"), Operation::Miscellaneous(m(&[3, 8])));
        assert_eq!(operation("17 M"), Operation::Miscellaneous(m(&[])));
        assert_eq!(fault("M1000"), (BlockNotKnown, 1, 5));
        assert_eq!(fault("M3 M4 M5 M8"), (UnexpectedText, 10, 2));
        assert_eq!(fault("M3 X+5"), (UnexpectedText, 4, 3));
        assert_eq!(fault("MX"), (BlockNotKnown, 1, 2));
    }

    #[test]
    fn arguments_of_m_functions() {
        let Operation::Motion(motion) = operation("L Z-5 F500 M103 F25") else {
            panic!("a motion")
        };
        assert_eq!(motion.feed, Some(Feed::Value(Value::Number(500.0))));
        assert_eq!(motion.m.argument(103, 'F'), Some(Value::Number(25.0)));
        let Operation::Miscellaneous(m) = operation("M112 T0.01 A10") else {
            panic!("an M block")
        };
        assert_eq!(m.argument(112, 'T'), Some(Value::Number(0.01)));
        assert_eq!(m.argument(112, 'A'), Some(Value::Number(10.0)));
        let Operation::Motion(motion) = operation("L X+1 R0 F1 M120 LA5 M8") else {
            panic!("a motion")
        };
        assert_eq!(motion.m.argument(120, 'L'), Some(Value::Number(5.0)));
        assert_eq!(motion.m.codes(), [120, 8]);
        let Operation::Motion(cancel) = operation("L Z-5 M103 FMAX") else {
            panic!("a motion")
        };
        assert_eq!((cancel.feed, cancel.m.arguments), (Some(Feed::Max), None));
    }
}
