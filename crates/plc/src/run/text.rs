//! String operands [000:14054-14297].

use std::cmp::Ordering;

use bahn_exchange::{Image, STRING_LENGTH, STRINGS};

use crate::PlcError;
use crate::operand::TextOperand;

/// Characters of a string without its end character.
pub(super) const TEXT_LENGTH_MAX: usize = STRING_LENGTH - 1;

/// Begins a reference to a line of a text file.
const SUBSTITUTE: u8 = 0x1a;
/// Highest line that an index may lead to [000:12047].
const INDEXED_LINE_MAX: i32 = 999;

/// The characters that an operand means.
pub(super) fn read(image: &Image, operand: &TextOperand, index: i32) -> Result<Vec<u8>, PlcError> {
    match operand {
        TextOperand::Memory { string, indexed } => {
            Ok(image.text(string_number(*string, *indexed, index)?).to_vec())
        }
        TextOperand::Part { string } => {
            let start = usize::try_from(index as i16).map_err(|_| PlcError::IndexOutOfRange)?;
            let rest = image
                .string((*string).into())
                .get(start..)
                .filter(|rest| !rest.is_empty())
                .ok_or(PlcError::IndexOutOfRange)?;
            Ok(rest
                .iter()
                .copied()
                .take_while(|character| *character != 0)
                .collect())
        }
        TextOperand::Literal(text) => Ok(text.clone()),
        TextOperand::Message { line, indexed } => reference(b'E', line_number(*line, *indexed, index)?),
        TextOperand::Dialogue { line, indexed } => reference(b'D', line_number(*line, *indexed, index)?),
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
fn reference(file: u8, line: u16) -> Result<Vec<u8>, PlcError> {
    let mut text = vec![SUBSTITUTE, file];
    text.extend(format!("{line:03}").bytes());
    Ok(text)
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
pub(super) fn append(text: &mut Vec<u8>, more: &[u8]) {
    let room = TEXT_LENGTH_MAX.saturating_sub(text.len());
    text.extend(more.iter().take(room));
}

/// Overwrites the beginning of a string memory: the end character is not copied [000:14137-14154].
pub(super) fn overwrite(image: &mut Image, string: usize, text: &[u8]) {
    if let Some(memory) = image.string_mut(string) {
        for (cell, character) in memory.iter_mut().zip(text) {
            *cell = *character;
        }
    }
}
