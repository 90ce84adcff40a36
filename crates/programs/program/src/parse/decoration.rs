//! Where the words of a cycle begin and end: its names vary with the language of the control and touch their values.

use bahn_path::Axis;

use super::cursor::Cursor;
use crate::text::is_blank;

/// Whether a number or Q parameter begins `offset` after the position, blanks apart.
pub(super) fn begins_value(c: &Cursor, offset: usize) -> bool {
    let mut after = c.clone();
    after.advance(offset);
    after.skip_blanks();
    number_begins(after.rest()) || parameter_begins(after.rest())
}

/// Whether a signed or unsigned number, or a signed Q parameter, begins here.
pub(super) fn number_begins(text: &[u8]) -> bool {
    match text {
        [b'0'..=b'9', ..] | [b'.' | b',', b'0'..=b'9', ..] => true,
        [b'+' | b'-', rest @ ..] => {
            let blanks = rest.iter().take_while(|&&b| is_blank(b)).count();
            let rest = rest.get(blanks..).unwrap_or_default();
            matches!(rest, [b'0'..=b'9', ..] | [b'.' | b',', b'0'..=b'9', ..]) || parameter_begins(rest)
        }
        _ => false,
    }
}

fn parameter_begins(text: &[u8]) -> bool {
    matches!(text, [b'Q' | b'q', b'0'..=b'9', ..])
}

/// What separates words like a blank: `HEIGHT: +100`, `ORDER Y-/X+`. A `~` would join lines in a listing.
pub(super) fn is_separator(byte: u8) -> bool {
    matches!(byte, b':' | b'=' | b'/' | b'~')
}

/// Whether the word ends `offset` after the position.
pub(super) fn ends_word(c: &Cursor, offset: usize) -> bool {
    let rest = c.rest().get(offset..).unwrap_or_default();
    match rest.first() {
        None => true,
        Some(&byte) => is_blank(byte) || byte == b';' || is_separator(byte) || rest.starts_with(b"..."),
    }
}

/// Whether the word that begins here can only be meant as a number: the letter O of `1O`, which touches a
/// number, or `Xnan`.
pub(super) fn is_broken_number(c: &Cursor) -> bool {
    /// Letters that touch a number and are more than this begin the next word: `F100RADIUS0`.
    const STRAY_LETTERS_MAX: usize = 2;
    let rest = c.rest();
    let letters = rest.iter().take_while(|b| b.is_ascii_alphabetic()).count();
    if c.touches_digit() && letters <= STRAY_LETTERS_MAX {
        return true;
    }
    let word = rest.get(..letters).unwrap_or_default();
    let value = match word {
        [b'I' | b'i', axis, value @ ..] | [axis, value @ ..] if Axis::from_letter(*axis).is_some() => value,
        _ => return false,
    };
    value.eq_ignore_ascii_case(b"NAN") || value.eq_ignore_ascii_case(b"INF")
}

/// Reads one word of decoration and appends it to the text. It ends before a number that touches it:
/// `TIEFE-15`.
pub(super) fn decoration(c: &mut Cursor, text: &mut Vec<u8>) {
    c.skip_blanks();
    let rest = c.rest();
    let length = (1..rest.len())
        .find(|&i| {
            let after = rest.get(i..).unwrap_or_default();
            let touches_dot = rest.get(i) == Some(&b'.') && !after.starts_with(b"...");
            let byte = after.first().copied().unwrap_or(b' ');
            is_blank(byte)
                || byte == b';'
                || is_separator(byte)
                || after.starts_with(b"...")
                || (number_begins(after) && !touches_dot)
        })
        .unwrap_or(rest.len());
    if !text.is_empty() {
        text.push(b' ');
    }
    text.extend_from_slice(rest.get(..length).unwrap_or_default());
    c.advance(length);
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation, q};
    use crate::CycleWord::{self, Number};
    use crate::Operation;
    use crate::Value::Number as N;
    use bahn_parameters::MessageId::EntryValueIncorrect;

    fn words_of(text: &str) -> Vec<CycleWord> {
        match operation(text) {
            Operation::Cycle(block) => block.words,
            other => panic!("{text}: {other:?}"),
        }
    }

    fn text(text: &str) -> CycleWord {
        CycleWord::Text(text.into())
    }

    #[test]
    fn what_is_meant_as_a_number_is_one() {
        for (text, column) in [
            ("CYCL DEF 7.1 Xnan", 14),
            ("CYCL DEF 7.1 X+1O", 17),
            ("CYCL DEF 7.1 X+O5", 14),
            ("CYCL DEF 7.1 IXinf", 14),
            ("CYCL DEF 7.1 X+5 DATUM", 18),
            ("CYCL DEF 3.4 X+1O", 17),
            ("CYCL DEF 3.4 Xnan F100", 14),
            ("CYCL DEF 1.2 DEPTH -1O", 22),
            ("CYCL DEF 1.5 F1e3", 16),
            ("CYCL DEF 10.1 ROT+3O", 20),
            ("CYCL DEF 11.1 SCL 0.8l", 22),
            ("CYCL DEF 26.1 X1O", 17),
            ("CYCL DEF 200 Q200=1O", 20),
        ] {
            let (message, found, _) = fault(text);
            assert_eq!((message, found), (EntryValueIncorrect, column), "{text}");
        }
        assert_eq!(words_of("CYCL DEF 7.1 #3"), [text("#"), Number(N(3.0))]);
        assert_eq!(words_of("CYCL DEF 7.1 #Q5"), [text("#"), Number(q(5))]);
        assert_eq!(words_of("CYCL DEF 4.6 F100RADIUS0").len(), 3);
    }
}
