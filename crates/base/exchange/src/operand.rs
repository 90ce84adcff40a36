//! Operands and values as the user writes them.

use std::fmt;
use std::str::FromStr;

use crate::{Bit, Exchange, Image, Number, STRINGS, Size};

/// An operand that can be shown and set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// A marker, input, output, timer or counter.
    Bit(Bit),
    /// A byte, word or doubleword.
    Number(Number),
    /// A string, S0 to S3.
    Text(usize),
}

impl FromStr for Operand {
    type Err = String;

    fn from_str(text: &str) -> Result<Operand, String> {
        let text = text.trim();
        if let Ok(bit) = text.parse() {
            return Ok(Operand::Bit(bit));
        }
        if let Ok(number) = text.parse() {
            return Ok(Operand::Number(number));
        }
        text.strip_prefix(['S', 's'])
            .and_then(|number| number.parse().ok())
            .filter(|number| *number < STRINGS)
            .map(Operand::Text)
            .ok_or_else(|| format!("there is no operand `{text}`"))
    }
}

impl fmt::Display for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Operand::Bit(bit) => bit.fmt(f),
            Operand::Number(number) => number.fmt(f),
            Operand::Text(string) => write!(f, "S{string}"),
        }
    }
}

impl Operand {
    /// What it holds in an image; bits are 0 or 1.
    pub fn read(self, image: &Image) -> Content {
        match self {
            Operand::Bit(bit) => Content::Number(image.bit(bit).into()),
            Operand::Number(number) => Content::Number(image.number(number)),
            Operand::Text(string) => {
                let text = image.text(string).iter().map(|byte| char::from(*byte));
                Content::Text(text.collect())
            }
        }
    }

    /// Sets it from outside; the PLC sees it in the next cycle.
    pub fn write(self, exchange: &mut Exchange, content: &Content) {
        match (self, content) {
            (Operand::Bit(bit), Content::Number(value)) => exchange.nc_set(bit, *value != 0),
            (Operand::Number(number), Content::Number(value)) => exchange.nc_set_number(number, *value),
            (Operand::Text(string), Content::Text(text)) => {
                exchange.plc_mut().set_text(string, &characters(text));
            }
            // `content` makes only what fits.
            _ => {}
        }
    }

    /// Reads a value for it: a bit 0 or 1, a number signed or as the bits of its width, a text.
    ///
    /// # Errors
    /// In words, when it is no such value.
    pub fn content(self, text: &str) -> Result<Content, String> {
        let text = text.trim();
        match self {
            Operand::Text(_) => {
                let text = text
                    .strip_prefix('"')
                    .and_then(|text| text.strip_suffix('"'))
                    .unwrap_or(text);
                Ok(Content::Text(text.to_owned()))
            }
            Operand::Bit(_) => match text {
                "0" => Ok(Content::Number(0)),
                "1" => Ok(Content::Number(1)),
                _ => Err(format!("{self} takes 0 or 1, not `{text}`")),
            },
            Operand::Number(number) => {
                let (bits, width) = match number.size() {
                    Size::Byte => (8, "8 bits"),
                    Size::Word => (16, "16 bits"),
                    Size::Double => (32, "32 bits"),
                };
                let value = integer(text)
                    .filter(|value| (-(1_i64 << (bits - 1))..1_i64 << bits).contains(value))
                    .ok_or_else(|| format!("{self} takes a number of {width}, not `{text}`"))?;
                Ok(Content::Number(number.size().truncate(value as u32 as i32)))
            }
        }
    }
}

impl Operand {
    /// A content as tables of the PLC show it: decimal, hexadecimal and binary, those two in the width of the operand; empty where
    /// there is nothing to be said.
    ///
    /// ```
    /// use bahn_exchange::{Content, Operand};
    /// let word: Operand = "W8".parse()?;
    /// assert_eq!(word.forms(&Content::Number(10)), ["10", "000A", "0000000000001010"]);
    /// # Ok::<(), String>(())
    /// ```
    pub fn forms(self, content: &Content) -> [String; 3] {
        match (self, content) {
            (Operand::Number(number), Content::Number(value)) => {
                let size = number.size();
                let digits = usize::from(size.bytes()) * 2;
                let bits = match size {
                    Size::Byte => *value as u32 & 0xff,
                    Size::Word => *value as u32 & 0xffff,
                    Size::Double => *value as u32,
                };
                let width = digits * 4;
                [
                    value.to_string(),
                    format!("{bits:0digits$X}"),
                    format!("{bits:0width$b}"),
                ]
            }
            (_, Content::Number(value)) => [value.to_string(), String::new(), value.to_string()],
            (_, Content::Text(text)) => [text.clone(), String::new(), String::new()],
        }
    }
}

/// What an operand holds. Numbers are signed.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(untagged)]
pub enum Content {
    /// Of a bit, 0 or 1, or of a number.
    Number(i32),
    /// The value of a string.
    Text(String),
}

impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Content::Number(value) => value.fmt(f),
            Content::Text(text) => write!(f, "\"{text}\""),
        }
    }
}

/// `operand=value`, or a machine parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Assignment {
    /// An operand and what it is to hold.
    Operand(Operand, Content),
    /// A machine parameter with its value, `4110.2=4`.
    Parameter(String),
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Assignment::Operand(operand, content) => write!(f, "{operand}={content}"),
            Assignment::Parameter(text) => write!(f, "MP{text}"),
        }
    }
}

impl Assignment {
    /// Whether a text is meant as one: `I4=1`, `W6 = 5`, `mp 4110.2=4`.
    ///
    /// ```
    /// use bahn_exchange::Assignment;
    /// assert!(Assignment::is_meant("W7=1") && Assignment::is_meant("mp 1010 = 5"));
    /// assert!(!Assignment::is_meant("mdi Q1=5") && !Assignment::is_meant("m 5"));
    /// ```
    pub fn is_meant(text: &str) -> bool {
        let Some((name, _)) = text.split_once('=') else {
            return false;
        };
        let name = name.trim();
        let is_word = !name.contains(char::is_whitespace);
        is_word || parameter(name).is_some() || name.parse::<Operand>().is_ok()
    }

    /// Reads an assignment, `M100=1`.
    ///
    /// # Errors
    /// In words, when the text is no assignment.
    pub fn parse(text: &str) -> Result<Assignment, String> {
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| format!("`{}` is not operand=value", text.trim()))?;
        let name = name.trim();
        if let Some(number) = parameter(name) {
            return Ok(Assignment::Parameter(format!("{number}={}", value.trim())));
        }
        let operand: Operand = name.parse()?;
        Ok(Assignment::Operand(operand, operand.content(value)?))
    }

    /// Reads several assignments with commas between.
    ///
    /// # Errors
    /// The error of the first that is no assignment.
    pub fn parse_all(text: &str) -> Result<Vec<Assignment>, String> {
        parts(text).map(Assignment::parse).collect()
    }
}

/// The number of a machine parameter, after `MP`.
fn parameter(name: &str) -> Option<&str> {
    let (prefix, number) = name.split_at_checked(2)?;
    let number = number.trim();
    let is_one =
        prefix.eq_ignore_ascii_case("MP") && number.starts_with(|first: char| first.is_ascii_digit());
    is_one.then_some(number)
}

/// Splits at commas outside texts.
pub fn parts(text: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    text.split(move |character| {
        quoted ^= character == '"';
        character == ',' && !quoted
    })
}

/// Decimal, or hexadecimal after `$`.
fn integer(text: &str) -> Option<i64> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let value = match digits.strip_prefix('$') {
        Some(digits) => i64::from(u32::from_str_radix(digits, 16).ok()?),
        None => i64::from(digits.parse::<u32>().ok()?),
    };
    Some(if negative { -value } else { value })
}

/// In the control's characters.
fn characters(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(c).unwrap_or(b'?')).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_in_their_width() {
        let forms = |operand: &str, value| {
            let operand: Operand = operand.parse().unwrap();
            operand.forms(&Content::Number(value))
        };
        assert_eq!(forms("B8", -2), ["-2", "FE", "11111110"]);
        assert_eq!(forms("W8", 10), ["10", "000A", "0000000000001010"]);
        assert_eq!(forms("D8", -1), ["-1".to_owned(), "F".repeat(8), "1".repeat(32)]);
        assert_eq!(forms("O2", 1), ["1", "", "1"]);
    }

    #[test]
    fn values_fit_their_operands() {
        let content = |text: &str| match Assignment::parse(text) {
            Ok(Assignment::Operand(_, content)) => Some(content.to_string()),
            _ => None,
        };
        assert_eq!(content("B8=200").as_deref(), Some("-56"));
        assert_eq!(content(" w6 = -3 ").as_deref(), Some("-3"));
        assert_eq!(content("D8=$FFFFFFFF").as_deref(), Some("-1"));
        assert_eq!(content("S0=\"A=B\"").as_deref(), Some("\"A=B\""));
        for wrong in ["B8=256", "I4=2", "W7=1", "M5", "S4=x", "W6=$", "D0=--1"] {
            assert_eq!(content(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn commas_in_texts_do_not_separate() {
        assert_eq!(
            parts("S0=\"A,B\",I4=1").collect::<Vec<_>>(),
            ["S0=\"A,B\"", "I4=1"]
        );
    }
}
