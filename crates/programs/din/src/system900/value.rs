//! Values: numbers as they are written, numbers of parameters.
//!
//! Decision: A number of a `.900` program fits the four bytes of a parameter and has nine decimals at most, whatever word
//! it belongs to

use std::fmt;

use crate::cursor::Cursor;
use crate::line::LineFault;

/// A number as it is written: no decimal is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Number {
    /// Its digits without the point.
    pub mantissa: i32,
    /// How many of the digits stand after the point.
    pub decimals: u8,
}

impl Number {
    /// The nearest number to calculate with.
    pub fn value(self) -> f64 {
        f64::from(self.mantissa) / 10f64.powi(i32::from(self.decimals))
    }

    /// The number where it has no decimals.
    pub(super) fn whole(self) -> Option<i32> {
        (self.decimals == 0).then_some(self.mantissa)
    }
}

/// A channel parameter that exists, P0 to P39999.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Parameter(u16);

impl Parameter {
    /// The parameter of a number; `None` where no parameter is assigned.
    pub fn new(number: u16) -> Option<Parameter> {
        let is_assigned = matches!(number, 0..=9999 | 11000..=18399 | 20000..=39999);
        is_assigned.then_some(Parameter(number))
    }

    /// Its number.
    pub fn number(self) -> u16 {
        self.0
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{}", self.0)
    }
}

/// What a word or a parameter gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// A decimal number, also one that was written in hexadecimal digits.
    Number(Number),
    /// The content of a parameter.
    Content(Parameter),
}

/// Most digits after the point.
const MAX_DECIMALS: usize = 9;

/// Most hexadecimal digits.
const MAX_HEX: usize = 8;

/// Reads a number of a word that begins at a mark.
pub(super) fn number(cursor: &mut Cursor, word: usize, of: &str) -> Result<Number, LineFault> {
    let after = cursor.mark();
    cursor.skip_blanks();
    let mark = cursor.mark();
    let is_negative = cursor.peek() == Some('-');
    if matches!(cursor.peek(), Some('-' | '+')) {
        cursor.advance(1);
    }
    let digits = cursor.take_while(|c| c.is_ascii_digit());
    let mut decimals = String::new();
    let mut has_point = false;
    if cursor.peek() == Some('.') {
        has_point = true;
        cursor.advance(1);
        decimals = cursor.take_while(|c| c.is_ascii_digit());
    }
    if digits.is_empty() && decimals.is_empty() {
        if !has_point {
            cursor.go_to(mark);
        }
        // Where nothing stands at its place the word itself is shown.
        if cursor.is_done() || mark > after {
            cursor.go_to(after);
            return Err(cursor.fault(word, format!("{of} needs a number")));
        }
        return Err(cursor.fault(mark, format!("{of} needs a number")));
    }
    let decimals = decimals.trim_end_matches('0');
    let written = format!("{}{digits}{decimals}", if is_negative { "-" } else { "" });
    match written.parse() {
        Ok(mantissa) if decimals.len() <= MAX_DECIMALS => Ok(Number {
            mantissa,
            decimals: u8::try_from(decimals.len()).unwrap_or_default(),
        }),
        // A digit that is not there is 0.
        Err(_) if written.is_empty() || written == "-" => Ok(Number {
            mantissa: 0,
            decimals: 0,
        }),
        _ => {
            let text = cursor.text(mark);
            Err(cursor.fault(
                mark,
                format!("{of}: {text} is beyond the four bytes of a parameter"),
            ))
        }
    }
}

/// Reads hexadecimal digits after `$`: the four bytes of a parameter.
pub(super) fn hexadecimal(cursor: &mut Cursor, of: &str) -> Result<Number, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    let digits = cursor.take_while(|c| c.is_ascii_alphanumeric());
    let bits = match digits.len() <= MAX_HEX {
        true => u32::from_str_radix(&digits, 16).ok(),
        false => None,
    };
    match bits {
        Some(bits) => Ok(Number {
            mantissa: bits.cast_signed(),
            decimals: 0,
        }),
        None => {
            let text = cursor.text(mark);
            Err(cursor.fault(
                mark,
                format!("{of}: {text} is not $ with one to eight digits 0 to 9, A to F"),
            ))
        }
    }
}

/// Reads a parameter from its P on.
pub(super) fn parameter(cursor: &mut Cursor) -> Result<Parameter, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    let digits = cursor.take_while(|c| c.is_ascii_digit());
    if digits.is_empty() {
        return Err(cursor.fault(mark, "P needs the number of a parameter"));
    }
    let known = digits.parse().ok().and_then(Parameter::new);
    known.ok_or_else(|| {
        let message = format!("P{digits} is no parameter: P0 to P9999, P11000 to P18399, P20000 to P39999");
        cursor.fault(mark, message)
    })
}
