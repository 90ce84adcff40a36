//! Values as people write them: decimal, `$` and up to eight hexadecimal digits, `--`.
//!
//! Decision: A value with more decimals than the status has raises them, to no more than nine; zeros at its end count
//! for nothing. One with fewer leaves them as they are [002:364]. What would need more than nine decimals or four bytes
//! is refused, never rounded
//!
//! Decision: A hexadecimal value gives the bits, whatever decimals the status has

use std::str::FromStr;

use crate::name::repeated;

/// A status has no more decimals after a write.
pub const DECIMALS_MAX: u8 = 9;

/// Digits of a decimal value; more do not go into four bytes.
const DIGITS_MAX: usize = 18;

/// What a parameter is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// `--`: no number, not 0 either.
    Cleared,
    /// All four bytes.
    Bits(i32),
    /// A number: its digits, and how many of them stand after the point.
    Decimal {
        /// The number without its point.
        digits: i64,
        /// As few as the number needs.
        decimals: u8,
    },
}

/// Why a value is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ValueError {
    /// It is none.
    #[error("`{0}` is no value: 12.5, -3, $1F, --")]
    NotANumber(String),
    /// Four bytes are too few for it.
    #[error("{0} does not go into four bytes")]
    TooGreat(String),
    /// No status has so many decimals.
    #[error("{0} has more than {DECIMALS_MAX} decimals")]
    TooFine(String),
}

impl FromStr for Value {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Value, ValueError> {
        let text = text.trim();
        let no_number = || ValueError::NotANumber(repeated(text));
        let too_great = || ValueError::TooGreat(repeated(text));
        if text == "--" {
            return Ok(Value::Cleared);
        }
        if let Some(digits) = text.strip_prefix('$') {
            if digits.is_empty() || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                return Err(no_number());
            }
            let bits = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() <= 8);
            let bits = bits.ok_or_else(too_great)?;
            return Ok(Value::Bits(i32::from_le_bytes(bits.to_le_bytes())));
        }
        let (is_negative, number) = match text.strip_prefix('-') {
            Some(number) => (true, number),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
        let all_digits = |text: &str| text.bytes().all(|digit| digit.is_ascii_digit());
        if (whole.is_empty() && fraction.is_empty()) || !all_digits(whole) || !all_digits(fraction) {
            return Err(no_number());
        }
        let fraction = fraction.trim_end_matches('0');
        if fraction.len() > usize::from(DECIMALS_MAX) {
            return Err(ValueError::TooFine(repeated(text)));
        }
        let whole = whole.trim_start_matches('0');
        if whole.len() + fraction.len() > DIGITS_MAX {
            return Err(too_great());
        }
        let digits = format!("0{whole}{fraction}").parse::<i64>();
        let digits = digits.map_err(|_| no_number())?;
        Ok(Value::Decimal {
            digits: if is_negative { -digits } else { digits },
            decimals: u8::try_from(fraction.len()).unwrap_or(DECIMALS_MAX),
        })
    }
}

impl Value {
    /// The four bytes and the decimals of a parameter that has so many decimals and is given this; `None` for the bytes
    /// when it is cleared.
    ///
    /// # Errors
    /// [`ValueError::TooGreat`] when it does not go into four bytes.
    pub fn counted(self, decimals: u8) -> Result<(Option<i32>, u8), ValueError> {
        match self {
            Value::Cleared => Ok((None, decimals)),
            Value::Bits(bits) => Ok((Some(bits), decimals)),
            Value::Decimal {
                digits,
                decimals: needed,
            } => {
                let raised = decimals.max(needed);
                let scale = 10i128.checked_pow(u32::from(raised - needed));
                let counted = scale.and_then(|scale| i128::from(digits).checked_mul(scale));
                let counted = counted.and_then(|counted| i32::try_from(counted).ok());
                let shown = || ValueError::TooGreat(shown(digits, needed));
                Ok((Some(counted.ok_or_else(shown)?), raised))
            }
        }
    }
}

/// A number with its point.
pub(crate) fn shown(digits: i64, decimals: u8) -> String {
    let width = usize::from(decimals) + 1;
    let all = format!("{:0>width$}", digits.unsigned_abs());
    let (whole, fraction) = all
        .split_at_checked(all.len() - usize::from(decimals))
        .unwrap_or((&all, ""));
    let sign = if digits < 0 { "-" } else { "" };
    match fraction {
        "" => format!("{sign}{whole}"),
        _ => format!("{sign}{whole}.{fraction}"),
    }
}
