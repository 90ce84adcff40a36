//! String operands [000:14054-14297].

use std::cmp::Ordering;

use bahn_exchange::{Image, STRING_LENGTH, STRINGS};

use super::registers::Text;
use crate::PlcError;
use crate::operand::TextOperand;

/// Characters of a string without its end character.
pub(super) const TEXT_LENGTH_MAX: usize = STRING_LENGTH - 1;

/// Begins a reference to a line of a text file.
const SUBSTITUTE: u8 = 0x1a;
/// Highest line that an index may lead to [000:12047].
const INDEXED_LINE_MAX: i32 = 999;

/// The characters that an operand means. A reference to a text file is written into `reference`.
pub(super) fn read<'a>(
    image: &'a Image,
    operand: &'a TextOperand,
    index: i32,
    reference: &'a mut Reference,
) -> Result<&'a [u8], PlcError> {
    match operand {
        TextOperand::Memory { string, indexed } => Ok(image.text(string_number(*string, *indexed, index)?)),
        TextOperand::Part { string } => {
            let start = usize::try_from(index as i16).map_err(|_| PlcError::IndexOutOfRange)?;
            let rest = image
                .string((*string).into())
                .get(start..)
                .filter(|rest| !rest.is_empty())
                .ok_or(PlcError::IndexOutOfRange)?;
            let end = rest.iter().position(|character| *character == 0);
            Ok(end.and_then(|end| rest.get(..end)).unwrap_or(rest))
        }
        TextOperand::Literal(text) => Ok(text),
        TextOperand::Message { line, indexed } => {
            Ok(reference.write(b'E', line_number(*line, *indexed, index)?))
        }
        TextOperand::Dialogue { line, indexed } => {
            Ok(reference.write(b'D', line_number(*line, *indexed, index)?))
        }
    }
}

/// The string memory that an operand means.
pub(super) fn string_number(string: u8, indexed: bool, index: i32) -> Result<usize, PlcError> {
    let shift = if indexed { i32::from(index as i16) } else { 0 };
    usize::try_from(i32::from(string) + shift)
        .ok()
        .filter(|string| *string < STRINGS)
        .ok_or(PlcError::IndexOutOfRange)
}

fn line_number(line: u16, indexed: bool, index: i32) -> Result<u16, PlcError> {
    if !indexed {
        return Ok(line);
    }
    u16::try_from(i32::from(line) + i32::from(index as i16))
        .ok()
        .filter(|line| i32::from(*line) <= INDEXED_LINE_MAX)
        .ok_or(PlcError::IndexOutOfRange)
}

/// `<SUB>E010`: replaced by the line of the file when the text is shown or sent. Lines from 1000 on have
/// four digits (inferred) [000:14079-14084].
#[derive(Default)]
pub(super) struct Reference([u8; 6]);

impl Reference {
    fn write(&mut self, file: u8, line: u16) -> &[u8] {
        let digit = |divisor: u16| b'0' + (line / divisor % 10) as u8;
        let [thousands, hundreds, tens, ones] = [1000, 100, 10, 1].map(digit);
        let length = if line < 1000 {
            self.0 = [SUBSTITUTE, file, hundreds, tens, ones, 0];
            5
        } else {
            self.0 = [SUBSTITUTE, file, thousands, hundreds, tens, ones];
            6
        };
        self.0.get(..length).unwrap_or(&self.0)
    }
}

/// Compares two strings by character codes; of two references to one file the lines are compared, not the
/// texts [000:14178-14184].
pub(super) fn compare(left: &[u8], right: &[u8]) -> Ordering {
    match (referred_line(left), referred_line(right)) {
        (Some((file, line)), Some((other_file, other_line))) if file == other_file => line.cmp(&other_line),
        _ => left.cmp(right),
    }
}

fn referred_line(text: &[u8]) -> Option<(u8, u16)> {
    let [SUBSTITUTE, file @ (b'E' | b'D'), digits @ ..] = text else {
        return None;
    };
    let line = std::str::from_utf8(digits).ok()?.parse().ok()?;
    Some((*file, line))
}

/// Appends characters, as many as fit (inferred) [000:14105-14118].
pub(super) fn append(text: &mut Text, more: &[u8]) {
    let room = TEXT_LENGTH_MAX.saturating_sub(text.len());
    text.extend(more.iter().take(room).copied());
}

/// Puts other characters in place of all; what is too long is cut off.
pub(super) fn replace(text: &mut Text, by: &[u8]) {
    text.clear();
    text.extend(by.iter().take(STRING_LENGTH).copied());
}

/// Overwrites the beginning of a string memory: the end character is not copied [000:14137-14154].
pub(super) fn overwrite(image: &mut Image, string: usize, text: &[u8]) {
    if let Some(memory) = image.string_mut(string) {
        for (cell, character) in memory.iter_mut().zip(text) {
            *cell = *character;
        }
    }
}
