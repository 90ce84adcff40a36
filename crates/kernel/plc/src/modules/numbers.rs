//! Modules 9050 to 9054: numbers to text and back [000:15023-15198].

use super::{Call, Outcome};
use crate::PlcError;
use crate::run::Text;

/// 9050: mantissa and power of ten to the shortest decimal number [000:15023-15064].
pub(super) fn to_text(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [mantissa, exponent, string] = call.arguments()?;
    let text = decimal(mantissa, exponent, decimal_sign(call));
    Ok(Outcome::of(text.is_some_and(|text| call.set_text(string, &text))))
}

/// 9051: a number in a format of given width [000:15066-15120].
pub(super) fn to_formatted_text(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [value, mode, decimals, places, string] = call.arguments()?;
    let sign = decimal_sign(call);
    let format = Format::new(mode, decimals, places);
    let text = format.map(|format| format.text(value, sign));
    Ok(Outcome::of(text.is_some_and(|text| call.set_text(string, &text))))
}

/// 9052: text to mantissa and power of ten; the mantissa is pulled first [000:15122-15144].
pub(super) fn from_text(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [string] = call.arguments()?;
    let number = call.text(string).and_then(|text| parse(&text));
    let (mantissa, exponent) = number.unwrap_or((0, 0));
    call.result(exponent)?;
    call.result(mantissa)?;
    Ok(Outcome::of(number.is_some()))
}

/// 9053: bytes to hexadecimal text. More bytes than the string has room for are an error (inferred)
/// [000:15146-15171].
pub(super) fn to_hexadecimal(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [address, string, length] = call.arguments()?;
    let text = call.bytes(address, length).and_then(|bytes| hexadecimal(&bytes));
    Ok(Outcome::of(text.is_some_and(|text| call.set_text(string, &text))))
}

/// 9054: hexadecimal text to bytes [000:15173-15198].
pub(super) fn from_hexadecimal(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [string, address] = call.arguments()?;
    let bytes = call.text(string).and_then(|text| binary(&text));
    Ok(Outcome::of(
        bytes.is_some_and(|bytes| call.set_bytes(address, &bytes)),
    ))
}

/// Two characters per byte; `None` when they are more than a string has.
pub(super) fn hexadecimal(bytes: &[u8]) -> Option<Text> {
    const DIGITS: [u8; 16] = *b"0123456789ABCDEF";
    let mut text = Text::new();
    for byte in bytes {
        for digit in [byte >> 4, byte & 15] {
            text.try_push(DIGITS[usize::from(digit)]).ok()?;
        }
    }
    Some(text)
}

/// One byte from two characters 0-9 A-F; `None` for others and for an odd number of them.
pub(super) fn binary(text: &[u8]) -> Option<Text> {
    let digit = |character: u8| match character {
        b'0'..=b'9' => Some(character - b'0'),
        b'A'..=b'F' => Some(character - b'A' + 10),
        _ => None,
    };
    let mut bytes = Text::new();
    for pair in text.chunks(2) {
        let [high, low] = pair else {
            return None;
        };
        bytes.try_push(digit(*high)? << 4 | digit(*low)?).ok()?;
    }
    Some(bytes)
}

/// Comma or point, as MP7280 says [000:15033].
fn decimal_sign(call: &Call<'_>) -> u8 {
    if call.parameter(7280, 0) == 1.0 {
        b'.'
    } else {
        b','
    }
}

/// Places before and after the point that 9050 allows [000:15038-15039].
const PLACES_MAX: i64 = 10;

fn decimal(mantissa: i32, exponent: i32, sign: u8) -> Option<Text> {
    let mut digits = digits_of(mantissa.unsigned_abs().into());
    if mantissa == 0 {
        return Some(digits);
    }
    let mut exponent = i64::from(exponent);
    while digits.last() == Some(&b'0') {
        digits.pop();
        exponent += 1;
    }
    let before = digits.len() as i64 + exponent;
    if before > PLACES_MAX || -exponent > PLACES_MAX {
        return None;
    }
    if exponent >= 0 {
        digits.extend(std::iter::repeat_n(b'0', exponent as usize));
    } else {
        let decimals = exponent.unsigned_abs() as usize;
        pad(&mut digits, decimals + 1);
        digits.insert(digits.len() - decimals, sign);
    }
    if mantissa < 0 {
        digits.insert(0, b'-');
    }
    Some(digits)
}

/// The decimal digits of a number, at least one.
fn digits_of(mut number: u64) -> Text {
    let mut digits = Text::new();
    loop {
        digits.insert(0, b'0' + (number % 10) as u8);
        number /= 10;
        if number == 0 {
            return digits;
        }
    }
}

/// Puts zeros before a number until it has so many digits.
fn pad(digits: &mut Text, count: usize) {
    while digits.len() < count {
        digits.insert(0, b'0');
    }
}

/// How 9051 writes a number.
struct Format {
    signed: bool,
    inch: bool,
    align: Align,
    decimals: usize,
    places: usize,
}

/// Bits 1 and 0 of the mode.
enum Align {
    /// Sign and number stand left.
    Left,
    /// The sign stands left, the number right.
    SignLeft,
    /// Sign and number stand right.
    Right,
}

impl Format {
    /// Places in all that 9051 allows [000:15085].
    const PLACES_MAX: i64 = 16;

    /// `None` for what the manual forbids. The format 11 is an error too (inferred).
    fn new(mode: i32, decimals: i32, places: i32) -> Option<Format> {
        let align = match mode & 3 {
            0 => Align::Left,
            1 => Align::SignLeft,
            2 => Align::Right,
            _ => return None,
        };
        if decimals < 0 || places < 1 || i64::from(decimals) + i64::from(places) > Format::PLACES_MAX {
            return None;
        }
        Some(Format {
            signed: mode & 8 != 0,
            inch: mode & 4 != 0,
            align,
            decimals: decimals as usize,
            places: places as usize,
        })
    }

    fn text(&self, value: i32, point: u8) -> Text {
        let magnitude = u64::from(value.unsigned_abs());
        // Divided by 25.4 and rounded half up (inferred).
        let magnitude = if self.inch {
            (magnitude * 10 + 127) / 254
        } else {
            magnitude
        };
        let mut digits = digits_of(magnitude);
        pad(&mut digits, self.decimals + 1);
        let width = self.decimals + self.places;
        digits.drain(..digits.len().saturating_sub(width));
        // One digit stays before the point (inferred).
        while digits.len() > self.decimals + 1 && digits.first() == Some(&b'0') {
            digits.remove(0);
        }
        let blanks = width.saturating_sub(digits.len());
        if self.decimals > 0 {
            digits.insert(digits.len().saturating_sub(self.decimals), point);
        }
        let sign: &[u8] = match (self.signed, value < 0) {
            (false, _) => b"",
            (true, false) => b"+",
            (true, true) => b"-",
        };
        let blanks = std::iter::repeat_n(b' ', blanks);
        let (sign, digits) = (sign.iter().copied(), digits.into_iter());
        match self.align {
            Align::Left => sign.chain(digits).collect(),
            Align::SignLeft => sign.chain(blanks).chain(digits).collect(),
            Align::Right => blanks.chain(sign).chain(digits).collect(),
        }
    }
}

/// Reads a number that fills the string but for blanks around it (inferred). The mantissa that is too long
/// loses its last places.
fn parse(text: &[u8]) -> Option<(i32, i32)> {
    let text = text.trim_ascii();
    let length = super::strings::number_length(text)?;
    if length != text.len() {
        return None;
    }
    let negative = text.first() == Some(&b'-');
    let mut mantissa = 0_i64;
    let mut exponent = 0;
    let (mut after_point, mut full) = (false, false);
    for character in text {
        if matches!(character, b'.' | b',') {
            after_point = true;
        }
        if !character.is_ascii_digit() {
            continue;
        }
        let digit = i64::from(character - b'0');
        let longer = mantissa * 10 + if negative { -digit } else { digit };
        full |= i32::try_from(longer).is_err();
        if !full {
            mantissa = longer;
        }
        exponent += i32::from(full) - i32::from(after_point);
    }
    Some((i32::try_from(mantissa).ok()?, exponent))
}
