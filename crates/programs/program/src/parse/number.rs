//! Numbers and signed Q parameters.

use bahn_parameters::MessageId::EntryValueIncorrect;

use super::cursor::{Cursor, Parsed};
use crate::Value;
use crate::check::ANY_Q_MAX;

/// Most digits of a number; longer ones are an error.
const MAX_DIGITS: usize = 20;
/// Greatest absolute value of a number in a program.
const MAX_NUMBER: f64 = 1e15;
/// Integers up to 2^53 are exact in an `f64`.
const MAX_EXACT_INTEGER: u64 = 1 << 53;

/// Powers of ten that are exact in an `f64`, as far as needed for [`MAX_DIGITS`].
const POWERS_OF_TEN: [f64; MAX_DIGITS + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20,
];

impl Cursor<'_> {
    /// Reads a number or a Q parameter with an optional sign, or nothing if none begins here. Blanks
    /// before, and between sign and value, are passed over.
    #[inline]
    pub(crate) fn value(&mut self) -> Parsed<Option<Value>> {
        let start = self.position();
        let sign = self.peek();
        let signed = usize::from(sign == b'-' || sign == b'+');
        if !self.peek_at(signed).is_ascii_digit() {
            return self.uncommon_value();
        }
        self.advance(signed);
        let magnitude = self.magnitude(start)?;
        Ok(Some(Value::Number(with_sign(sign == b'-', magnitude))))
    }

    /// [`Cursor::value`] where no number with at most a sign begins.
    fn uncommon_value(&mut self) -> Parsed<Option<Value>> {
        let start = self.position();
        self.skip_blanks();
        let first = self.position();
        let sign = self.peek();
        let negative = sign == b'-';
        let signed = negative || sign == b'+';
        if signed {
            self.advance(1);
            self.skip_blanks();
        }
        let byte = self.peek();
        if byte.is_ascii_digit() || (matches!(byte, b'.' | b',') && self.peek_at(1).is_ascii_digit()) {
            let magnitude = self.magnitude(first)?;
            return Ok(Some(Value::Number(with_sign(negative, magnitude))));
        }
        if byte.eq_ignore_ascii_case(&b'Q') {
            let number = self.parameter(first)?;
            return Ok(Some(Value::Q { number, negative }));
        }
        if signed {
            self.go_to(first + 1);
            return self.number_missing(first, "a number or Q parameter is missing after the sign");
        }
        self.go_to(start);
        Ok(None)
    }

    /// Reads a value that has to stand here; `start` is where the word begins that it belongs to.
    #[inline]
    pub(crate) fn required_value(&mut self, start: usize) -> Parsed<Value> {
        match self.value()? {
            Some(value) => Ok(value),
            None => self.number_missing(start, "a number or Q parameter is missing"),
        }
    }

    /// Reads `Q` and a parameter number.
    pub(crate) fn parameter(&mut self, start: usize) -> Parsed<u16> {
        self.advance(1);
        if matches!(self.peek_upper(), b'S' | b'L' | b'R') && self.peek_at(1).is_ascii_digit() {
            self.go_to(start);
            return self.not_known();
        }
        match self.integer(start)? {
            Some(number) if number <= u32::from(ANY_Q_MAX) => Ok(number as u16),
            Some(_) => self.fault_from(start, EntryValueIncorrect, "no control has this Q parameter"),
            None => self.number_missing(start, "the number of the Q parameter is missing"),
        }
    }

    /// Reads an unsigned whole number after blanks, or nothing if none begins here. `start` is where the
    /// word begins.
    pub(crate) fn integer(&mut self, start: usize) -> Parsed<Option<u32>> {
        let before = self.position();
        self.skip_blanks();
        let mut number: u32 = 0;
        let mut digits = 0;
        while let byte @ b'0'..=b'9' = self.peek() {
            number = number.saturating_mul(10).saturating_add(u32::from(byte - b'0'));
            digits += 1;
            self.advance(1);
        }
        if digits > MAX_DIGITS {
            return self.fault_from(start, EntryValueIncorrect, "the number has too many digits");
        }
        if digits == 0 {
            self.go_to(before);
            return Ok(None);
        }
        Ok(Some(number))
    }

    /// Reads a whole number from `0` to `limit` that has to stand here.
    pub(crate) fn required_integer(&mut self, start: usize, limit: u16, what: &'static str) -> Parsed<u16> {
        match self.integer(start)? {
            Some(number) if number <= u32::from(limit) => Ok(number as u16),
            Some(_) => self.fault_from(start, EntryValueIncorrect, what),
            None => self.number_missing(start, what),
        }
    }

    /// Reads digits with a decimal point or comma; the nearest `f64`, exactly.
    #[inline]
    fn magnitude(&mut self, start: usize) -> Parsed<f64> {
        let digits_start = self.position();
        let text = self.rest();
        let mut index = 0;
        while text.get(index) == Some(&b'0') {
            index += 1;
        }
        let mut mantissa: u64 = 0;
        let mut digits = 0;
        let mut digit = |byte: u8| {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
            digits += 1;
        };
        while let Some(&byte @ b'0'..=b'9') = text.get(index) {
            digit(byte);
            index += 1;
        }
        let mut fraction = 0;
        if let Some(b'.' | b',') = text.get(index) {
            match text.get(index + 1) {
                Some(b'0'..=b'9') => {
                    index += 1;
                    let fraction_start = index;
                    while let Some(&byte @ b'0'..=b'9') = text.get(index) {
                        digit(byte);
                        index += 1;
                    }
                    fraction = index - fraction_start;
                }
                // `5......text`: the number ends before the annotation.
                Some(b'.') if text.get(index + 2) == Some(&b'.') => {}
                _ => index += 1,
            }
        }
        self.advance(index);
        if digits > MAX_DIGITS {
            return self.fault_from(start, EntryValueIncorrect, "the number has too many digits");
        }
        if matches!(self.peek(), b'.' | b',') && !self.at_annotation() {
            self.go_to(start);
            return self.fault_at_word(EntryValueIncorrect, "the number has two decimal signs");
        }
        // Both operands are exact, so the one division rounds to the nearest value.
        if mantissa <= MAX_EXACT_INTEGER
            && digits < MAX_DIGITS
            && let Some(&power) = POWERS_OF_TEN.get(fraction)
        {
            let number = mantissa as f64 / power;
            if number <= MAX_NUMBER {
                return Ok(number);
            }
        }
        self.long_magnitude(start, digits_start)
    }

    /// The value of many digits, read before the reading position.
    #[cold]
    fn long_magnitude(&mut self, start: usize, digits_start: usize) -> Parsed<f64> {
        let end = self.position();
        self.go_to(digits_start);
        let length = end.saturating_sub(digits_start);
        let text: String = self
            .rest()
            .iter()
            .take(length)
            .map(|&b| if b == b',' { '.' } else { char::from(b) })
            .collect();
        self.go_to(end);
        match text.parse::<f64>() {
            Ok(number) if number <= MAX_NUMBER => Ok(number),
            _ => self.fault_from(start, EntryValueIncorrect, "the number is too large"),
        }
    }
}

/// Zero has no sign: -0 and +0 are the same block.
#[inline]
fn with_sign(negative: bool, magnitude: f64) -> f64 {
    if negative && magnitude != 0.0 {
        -magnitude
    } else {
        magnitude
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> Result<Option<Value>, String> {
        let mut c = Cursor::new(text.as_bytes());
        c.value().map_err(|fault| fault.detail.to_string())
    }

    fn number(text: &str) -> f64 {
        match value(text) {
            Ok(Some(Value::Number(number))) => number,
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn numbers_in_every_spelling() {
        assert_eq!(number("5"), 5.0);
        assert_eq!(number("+ 25"), 25.0);
        assert_eq!(number("-10,5"), -10.5);
        assert_eq!(number(".5"), 0.5);
        assert_eq!(number("5."), 5.0);
        assert_eq!(number("5......Tool"), 5.0);
        assert_eq!(number("5.25......Tool"), 5.25);
        assert!(number("-0.000").is_sign_positive());
        assert_eq!(number("00000000000000000000000000012"), 12.0);
    }

    #[test]
    fn q_parameters_with_sign() {
        assert_eq!(
            value("-Q8"),
            Ok(Some(Value::Q {
                number: 8,
                negative: true
            }))
        );
        assert_eq!(
            value("+ q 12"),
            Ok(Some(Value::Q {
                number: 12,
                negative: false
            }))
        );
        assert_eq!(
            value("Q1999"),
            Ok(Some(Value::Q {
                number: 1999,
                negative: false
            }))
        );
        assert!(value("Q2000").is_err() && value("Q").is_err() && value("QS1").is_err());
    }

    #[test]
    fn faulty_numbers() {
        for text in [
            "+",
            "--5",
            "+-5",
            "-nan",
            "1.2.3",
            "1.2,3",
            "1..2",
            "123456789012345678901",
            "1e",
        ] {
            let result = value(text);
            if text == "1e" {
                assert_eq!(result, Ok(Some(Value::Number(1.0))), "the e is the next word");
            } else {
                assert!(result.is_err(), "{text}: {result:?}");
            }
        }
        assert_eq!(value("nan"), Ok(None));
        assert_eq!(value("9999999999999999").map_err(|_| ()), Err(()));
    }

    proptest! {
        #[test]
        fn every_number_is_the_nearest_f64(text in "[0-9]{1,15}(\\.[0-9]{1,5})?") {
            prop_assert_eq!(number(&text), text.parse::<f64>().unwrap());
        }

        #[test]
        fn shortest_form_reads_back(v in -1e9..1e9f64) {
            let text = format!("{v}");
            if text.len() <= MAX_DIGITS {
                prop_assert_eq!(number(&text).to_bits(), v.to_bits());
            }
        }
    }
}
