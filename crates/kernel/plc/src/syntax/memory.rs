//! Operands in memory, constants and strings.

use bahn_exchange::{Bit, BitArea, Number, STRINGS, Size};
use bahn_parameters::ControlModel;

use super::form::{Class, Mnemonic};
use super::operand::{LineError, Operand, Scanner, label};
use crate::PlcError;
use crate::operand::{BitOperand, NumberOperand, TextOperand};

/// Longest immediate string [000:14084].
const LITERAL_LENGTH_MAX: usize = 37;
/// Last line of the message file and of the dialogue file [000:14081-14082].
const MESSAGE_LINE_MAX: u16 = 999;
const DIALOGUE_LINE_MAX: u16 = 4095;

/// Reads an operand that is a memory cell, constant, string or field. Also tells whether its letter is one
/// of the TNC 355: E for I, A for O, Z for C [000:16189-16202].
pub(super) fn memory_operand(
    mnemonic: Mnemonic,
    scanner: &mut Scanner,
    model: ControlModel,
) -> Result<(Operand, bool), LineError> {
    let at = scanner.at();
    let letter = scanner
        .peek()
        .ok_or_else(|| LineError::new(PlcError::OperandNotFound, at, "operand expected"))?
        .to_ascii_uppercase();
    let wrong_type = |class: Class| {
        (!mnemonic.takes(class)).then(|| {
            let detail = format!("{} does not take {letter}", mnemonic.spelling());
            LineError::new(PlcError::InvalidOperandType, at, detail)
        })
    };
    scanner.take(letter);
    let old_letter = matches!(letter, 'E' | 'A' | 'Z');
    if let Some(area) = BitArea::of_letter(letter) {
        return match wrong_type(Class::Bit) {
            Some(error) => Err(error),
            None => Ok((bit_operand(mnemonic, (area, model), scanner, at)?, old_letter)),
        };
    }
    let operand = match letter {
        'B' | 'W' | 'D' => {
            let (size, class) = match letter {
                'B' => (Size::Byte, Class::Byte),
                'W' => (Size::Word, Class::Word),
                _ => (Size::Double, Class::Double),
            };
            if let Some(error) = wrong_type(class) {
                return Err(error);
            }
            number_operand(size, scanner, at)?
        }
        'K' if scanner.peek().is_some_and(|c| c.eq_ignore_ascii_case(&'F')) => {
            if let Some(error) = wrong_type(Class::Field) {
                return Err(error);
            }
            scanner.take('F');
            scanner.skip_blanks();
            let name = label(scanner)?;
            scanner.take_all("[X]");
            Operand::Field(name)
        }
        'K' => {
            if let Some(error) = wrong_type(Class::Constant) {
                return Err(error);
            }
            Operand::Constant(scanner.constant()?)
        }
        'S' => {
            let (text, class) = text_operand(scanner, at)?;
            if let Some(error) = wrong_type(class) {
                return Err(error);
            }
            if matches!(text, TextOperand::Part { .. }) && stores_text(mnemonic) {
                let detail = "a part of a string cannot be stored to";
                return Err(LineError::new(PlcError::InvalidOperandType, at, detail));
            }
            Operand::Text(text)
        }
        _ => {
            let detail = format!("`{letter}` is no operand");
            return Err(LineError::new(PlcError::InvalidOperandType, at, detail));
        }
    };
    Ok((operand, old_letter))
}

fn stores_text(mnemonic: Mnemonic) -> bool {
    matches!(mnemonic, Mnemonic::Assign | Mnemonic::Overwrite)
}

/// Consecutive bits that a command moves.
fn width(mnemonic: Mnemonic) -> u16 {
    match mnemonic {
        Mnemonic::LoadByte | Mnemonic::AssignByte => 8,
        Mnemonic::LoadWord | Mnemonic::AssignWord => 16,
        Mnemonic::LoadDouble | Mnemonic::AssignDouble => 32,
        _ => 1,
    }
}

/// A bit, whose number the directory must list. Commands that move several bits cross the gaps between the
/// boards by number, but may not leave the area (inferred).
fn bit_operand(
    mnemonic: Mnemonic,
    (area, model): (BitArea, ControlModel),
    scanner: &mut Scanner,
    at: usize,
) -> Result<Operand, LineError> {
    let ranges = ranges(area, model);
    let is_listed = |bit: &Bit| {
        let number = bit.number();
        ranges
            .iter()
            .any(|(first, last)| (*first..=*last).contains(&number))
    };
    let number = scanner.digits("number expected")?;
    let last = number.and_then(|number| number.checked_add(width(mnemonic) - 1));
    let bit = number.and_then(|number| Bit::new(area, number)).filter(is_listed);
    let end = ranges.last().map_or(0, |(_, last)| *last);
    match (bit, last.filter(|last| *last <= end)) {
        (Some(bit), Some(_)) => Ok(Operand::Bit(BitOperand {
            bit,
            indexed: scanner.take_all("[X]"),
        })),
        _ => Err(LineError::new(
            PlcError::OperandOutOfRange,
            at,
            bit_range(area, ranges, number),
        )),
    }
}

/// The numbers of an area; inputs and outputs are those of the control.
fn ranges(area: BitArea, model: ControlModel) -> &'static [(u16, u16)] {
    match area {
        BitArea::I => model.limits().inputs,
        BitArea::O => model.limits().outputs,
        BitArea::M | BitArea::T | BitArea::C => area.ranges(),
    }
}

fn bit_range(area: BitArea, ranges: &[(u16, u16)], number: Option<u16>) -> String {
    if let (BitArea::M, Some(macro_number @ 3264..=3267)) = (area, number) {
        let module = 200 + (macro_number - 3264) * 10;
        return format!(
            "the TNC 355 macro M{macro_number} is replaced by a module, as module {module} of the manual"
        );
    }
    let ranges: Vec<String> = ranges
        .iter()
        .map(|(first, last)| format!("{0}{first}-{0}{last}", area.letter()))
        .collect();
    format!("the range is {}", ranges.join(", "))
}

fn number_operand(size: Size, scanner: &mut Scanner, at: usize) -> Result<Operand, LineError> {
    let address = scanner.digits("address expected")?;
    match address.and_then(|address| Number::new(size, address)) {
        Some(number) => Ok(Operand::Number(NumberOperand {
            number,
            indexed: scanner.take_all("[X]"),
        })),
        None => {
            let detail = format!(
                "{} addresses are 0 to {} in steps of {}",
                size.letter(),
                1024 - size.bytes(),
                size.bytes()
            );
            Err(LineError::new(PlcError::OperandOutOfRange, at, detail))
        }
    }
}

fn text_operand(scanner: &mut Scanner, at: usize) -> Result<(TextOperand, Class), LineError> {
    if scanner.take('"') {
        let text = scanner.take_while(|c| c != '"');
        if !scanner.take('"') {
            let detail = "closing quotation mark expected";
            return Err(LineError::new(PlcError::NoLimiter, scanner.at(), detail));
        }
        // Characters outside the control's alphabet cannot be shown [pub p.614].
        let bytes: Vec<u8> = text.chars().map(|c| u8::try_from(c).unwrap_or(b'^')).collect();
        if bytes.len() > LITERAL_LENGTH_MAX {
            let detail = "immediate strings have at most 37 characters";
            return Err(LineError::new(PlcError::OperandOutOfRange, at, detail));
        }
        return Ok((TextOperand::Literal(bytes), Class::TextLiteral));
    }
    if scanner.take('#') {
        let message = scanner.take('E');
        if !message && !scanner.take('D') {
            return Err(LineError::new(
                PlcError::OperandNotFound,
                at,
                "S#E or S#D expected",
            ));
        }
        let last = if message {
            MESSAGE_LINE_MAX
        } else {
            DIALOGUE_LINE_MAX
        };
        let Some(line) = scanner
            .digits("line number expected")?
            .filter(|line| *line <= last)
        else {
            let detail = format!("lines are 0 to {last}");
            return Err(LineError::new(PlcError::OperandOutOfRange, at, detail));
        };
        let indexed = scanner.take_all("[X]");
        let operand = if message {
            TextOperand::Message { line, indexed }
        } else {
            TextOperand::Dialogue { line, indexed }
        };
        return Ok((operand, Class::TextReference));
    }
    let string = scanner.digits("string number expected")?;
    let string = string
        .and_then(|string| u8::try_from(string).ok())
        .filter(|string| usize::from(*string) < STRINGS);
    let Some(string) = string else {
        return Err(LineError::new(
            PlcError::OperandOutOfRange,
            at,
            "strings are S0 to S3",
        ));
    };
    let operand = if scanner.take_all("^X") {
        TextOperand::Part { string }
    } else {
        TextOperand::Memory {
            string,
            indexed: scanner.take_all("[X]"),
        }
    };
    Ok((operand, Class::TextMemory))
}
