//! What an operand can be, the characters it is read from, and labels.

use crate::PlcError;
use crate::operand::{BitOperand, NumberOperand, TextOperand};

/// Characters that tell labels apart [000:14004].
const LABEL_SIGNIFICANT: usize = 16;
/// Characters that a label may have.
const LABEL_LENGTH_MAX: usize = 32;
/// Highest label number [000:14002].
const LABEL_NUMBER_MAX: u32 = 511;
/// Numbers of internal modules.
pub(crate) const MODULE_NUMBERS: std::ops::RangeInclusive<u32> = 9000..=9255;

/// The operand of a command.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Operand {
    None,
    Bit(BitOperand),
    Number(NumberOperand),
    Constant(i32),
    Text(TextOperand),
    Field(String),
    Label(String),
    File(String),
}

/// An error in a line, or a deviation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LineError {
    pub error: PlcError,
    pub column: u32,
    pub detail: String,
}

impl LineError {
    pub(crate) fn new(error: PlcError, at: usize, detail: impl Into<String>) -> LineError {
        LineError {
            error,
            column: u32::try_from(at.saturating_add(1)).unwrap_or(u32::MAX),
            detail: detail.into(),
        }
    }
}

/// Walks over the characters of a line.
pub(super) struct Scanner<'a> {
    characters: &'a [char],
    at: usize,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(characters: &'a [char], at: usize) -> Scanner<'a> {
        Scanner { characters, at }
    }

    pub(super) fn at(&self) -> usize {
        self.at
    }

    pub(super) fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    pub(super) fn skip_blanks(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.at += 1;
        }
    }

    pub(super) fn take_while(&mut self, wanted: impl Fn(char) -> bool) -> String {
        let mut taken = String::new();
        while let Some(character) = self.peek().filter(|c| wanted(*c)) {
            taken.push(character);
            self.at += 1;
        }
        taken
    }

    /// Takes a character when it comes next, after blanks.
    pub(super) fn take(&mut self, wanted: char) -> bool {
        let mut ahead = self.at;
        while self.characters.get(ahead).is_some_and(|c| c.is_whitespace()) {
            ahead += 1;
        }
        let found = self
            .characters
            .get(ahead)
            .is_some_and(|c| c.eq_ignore_ascii_case(&wanted));
        if found {
            self.at = ahead + 1;
        }
        found
    }

    /// Takes all of some characters, or none.
    pub(super) fn take_all(&mut self, wanted: &str) -> bool {
        let start = self.at;
        let found = wanted.chars().all(|character| self.take(character));
        if !found {
            self.at = start;
        }
        found
    }

    /// A decimal number after blanks; `None` when it is larger than any address.
    pub(super) fn digits(&mut self, expected: &str) -> Result<Option<u16>, LineError> {
        self.skip_blanks();
        let at = self.at;
        let digits = self.take_while(|c| c.is_ascii_digit());
        if digits.is_empty() {
            return Err(LineError::new(PlcError::OperandNotFound, at, expected));
        }
        Ok(digits.parse().ok())
    }

    /// The value after `K`: `+54`, `-1`, `$FF`. All 32 bits may be given; `$` is two's complement.
    pub(super) fn constant(&mut self) -> Result<i32, LineError> {
        self.skip_blanks();
        let at = self.at;
        let out_of_range = || LineError::new(PlcError::OperandOutOfRange, at, "constants have 32 bits");
        let missing = || LineError::new(PlcError::OperandNotFound, at, "value expected");
        let negative = self.take('-');
        if !negative {
            self.take('+');
        }
        if self.take('$') {
            self.skip_blanks();
            let digits = self.take_while(|c| c.is_ascii_hexdigit());
            if digits.is_empty() {
                return Err(missing());
            }
            let value = u32::from_str_radix(&digits, 16).map_err(|_| out_of_range())? as i32;
            return Ok(if negative { value.wrapping_neg() } else { value });
        }
        self.skip_blanks();
        let digits = self.take_while(|c| c.is_ascii_digit());
        if digits.is_empty() {
            return Err(missing());
        }
        let value: i64 = digits.parse().map_err(|_| out_of_range())?;
        i32::try_from(if negative { -value } else { value }).map_err(|_| out_of_range())
    }
}

/// A label: a number, or a name of which 16 characters count [000:14002-14006].
pub(super) fn label(scanner: &mut Scanner) -> Result<String, LineError> {
    let at = scanner.at();
    let word = scanner.take_while(|c| !c.is_whitespace() && c != '[');
    let error = |error, detail: &str| Err(LineError::new(error, at, detail));
    if word.is_empty() {
        return error(PlcError::OperandNotFound, "label expected");
    }
    if word.bytes().all(|byte| byte.is_ascii_digit()) {
        return match word.parse::<u32>() {
            Ok(number) if number <= LABEL_NUMBER_MAX || MODULE_NUMBERS.contains(&number) => {
                Ok(number.to_string())
            }
            _ => error(PlcError::OperandOutOfRange, "label numbers are 0 to 511"),
        };
    }
    if !word.is_ascii() {
        return error(PlcError::InvalidOperandType, "label names are ASCII");
    }
    if word.len() > LABEL_LENGTH_MAX {
        return error(
            PlcError::OperandOutOfRange,
            "label names have at most 32 characters",
        );
    }
    Ok(word.chars().take(LABEL_SIGNIFICANT).collect())
}
