//! Blocks as most of a long program are, read at once: a number, G0 to G3, axes, F, centre words. Whatever else stands in a
//! line is left to the reader of all blocks, which says the same of these.

use bahn_text::Span;

use super::block::{AxisName, Block, Word, WordKind};
use super::value::{Number, Value};

/// Most digits that are read here; more may not go into four bytes.
const DIGITS_MAX: usize = 9;

/// The bytes of a line.
struct Bytes<'a> {
    text: &'a [u8],
    at: usize,
}

impl Bytes<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn skip_blanks(&mut self) {
        while self.peek() == Some(b' ') {
            self.at += 1;
        }
    }

    /// Digits onto a number; how many there were.
    fn digits(&mut self, number: &mut i64) -> usize {
        let start = self.at;
        while let Some(digit @ b'0'..=b'9') = self.peek() {
            *number = number.saturating_mul(10).saturating_add(i64::from(digit - b'0'));
            self.at += 1;
        }
        self.at - start
    }

    /// A whole number that a blank, a letter or the end follows.
    fn whole(&mut self) -> Option<i64> {
        let mut number = 0;
        let count = self.digits(&mut number);
        ((1..=DIGITS_MAX).contains(&count) && self.ends()).then_some(number)
    }

    fn ends(&self) -> bool {
        matches!(self.peek(), None | Some(b' ' | b'A'..=b'Z'))
    }

    /// A number with or without a point, no zeros at its end.
    fn decimal(&mut self) -> Option<Number> {
        let is_negative = self.peek() == Some(b'-');
        self.at += usize::from(is_negative);
        let mut mantissa = 0;
        let whole = self.digits(&mut mantissa);
        let mut decimals = 0;
        if self.peek() == Some(b'.') {
            self.at += 1;
            decimals = self.digits(&mut mantissa);
            if decimals == 0 {
                return None;
            }
        }
        if whole == 0 || whole + decimals > DIGITS_MAX || !self.ends() {
            return None;
        }
        while decimals > 0 && mantissa % 10 == 0 {
            mantissa /= 10;
            decimals -= 1;
        }
        Some(Number {
            mantissa: i32::try_from(if is_negative { -mantissa } else { mantissa }).ok()?,
            decimals: u8::try_from(decimals).ok()?,
        })
    }
}

/// The number of a line that begins plainly.
pub(super) fn number(line: &str) -> Option<u32> {
    let mut bytes = Bytes {
        text: line.as_bytes(),
        at: 0,
    };
    own_number(&mut bytes)
}

fn own_number(bytes: &mut Bytes) -> Option<u32> {
    if bytes.peek() != Some(b'N') {
        return None;
    }
    bytes.at += 1;
    let number = bytes.whole()?;
    bytes.skip_blanks();
    let is_plain = matches!(bytes.peek(), Some(b'A'..=b'Z'));
    is_plain.then(|| u32::try_from(number).ok()).flatten()
}

/// Reads a line that is plain into a block, whose room is used again; `None` leaves the line to the reader of all blocks.
pub(super) fn read(line: u32, text: &str, block: &mut Block) -> Option<()> {
    let mut bytes = Bytes {
        text: text.as_bytes(),
        at: 0,
    };
    block.clear();
    if bytes.peek() == Some(b'N') {
        block.number = Some(own_number(&mut bytes)?);
    }
    let mut seen = 0u32;
    loop {
        bytes.skip_blanks();
        let Some(letter) = bytes.peek() else { break };
        let start = bytes.at;
        bytes.at += 1;
        let bit = 1 << letter.checked_sub(b'A').filter(|index| *index < 26)?;
        if seen & bit != 0 {
            return None;
        }
        seen |= bit;
        let kind = match letter {
            b'G' => WordKind::G(u16::try_from(bytes.whole()?).ok().filter(|number| *number <= 3)?),
            b'F' => WordKind::Feed(Value::Number(
                bytes.decimal().filter(|number| number.mantissa >= 0)?,
            )),
            b'I'..=b'K' => WordKind::Centre(letter - b'I', Value::Number(bytes.decimal()?)),
            b'A'..=b'C' | b'U'..=b'Z' => {
                let axis = AxisName {
                    letter: char::from(letter),
                    extension: 0,
                };
                WordKind::Axis(axis, Value::Number(bytes.decimal()?))
            }
            _ => return None,
        };
        let span = Span::new(line as usize, start + 1, bytes.at - start);
        block.words.push(Word { span, kind });
    }
    (!block.words.is_empty()).then_some(())
}

#[cfg(test)]
mod tests {
    use super::super::{block, line, rules};
    use super::*;

    /// Of a plain block the reader of all blocks says the same, and finds no fault.
    #[test]
    fn plain_blocks_are_read_as_all_are() {
        let parts = [
            "N10 ",
            "N007",
            "G1",
            "G02 ",
            "X1.50",
            "Y-0.0",
            " Z12345.6789",
            "F100",
            "I5",
            "K-.5",
            "X2",
            "G4",
            "M3",
            "Y3:5",
            "N5",
            " ",
            "-",
            "C0",
            "{x}",
            "F-1",
            "A99999999",
            "X1.",
            "1",
        ];
        let mut plain = 0;
        let mut own = Block::default();
        for first in parts {
            for second in parts {
                for third in parts {
                    let text = format!("{first}{second}{third}");
                    if read(1, &text, &mut own).is_none() {
                        continue;
                    }
                    plain += 1;
                    let reading = block::read(1, &line::glyphs(&text));
                    assert!(reading.faults.is_empty(), "{text}: {:?}", reading.faults.len());
                    assert!(rules::faults(&reading.block).is_empty(), "{text}");
                    assert_eq!(reading.block, own, "{text}");
                }
            }
        }
        assert!(plain > 500, "{plain}");
    }
}
