//! Operands with the index register [000:14010-14050].

use bahn_exchange::{Bit, Image, Number};

use crate::PlcError;
use crate::operand::{BitOperand, NumberOperand, Value};

/// The bit that an operand means; `None` when the index leads out of its area.
pub(super) fn bit_at(operand: BitOperand, index: i32) -> Option<Bit> {
    if !operand.indexed {
        return Some(operand.bit);
    }
    let number = i32::from(operand.bit.number()) + i32::from(index as i16);
    let bit = Bit::new(operand.bit.area(), u16::try_from(number).ok()?)?;
    (bit.number() <= bit.area().last()).then_some(bit)
}

/// The number that an operand means; `None` when the index leads out of the memory.
pub(super) fn number_at(operand: NumberOperand, index: i32) -> Option<Number> {
    if !operand.indexed {
        return Some(operand.number);
    }
    let size = operand.number.size();
    let offset = i32::from(index as i16) * i32::from(size.bytes());
    let address = i32::from(operand.number.address()) + offset;
    Number::new(size, u16::try_from(address).ok()?)
}

/// Reads a bit. Reads are not checked: outside the memory is 0 (inferred) [000:14012-14016].
pub(super) fn read_bit(image: &Image, operand: BitOperand, index: i32) -> bool {
    bit_at(operand, index).is_some_and(|bit| image.bit(bit))
}

/// Reads a number, sign-extended.
pub(crate) fn read_number(image: &Image, operand: NumberOperand, index: i32) -> i32 {
    number_at(operand, index).map_or(0, |number| image.number(number))
}

/// Reads what a word instruction reads.
pub(super) fn read(image: &Image, value: Value, index: i32) -> i32 {
    match value {
        Value::Number(number) => read_number(image, number, index),
        Value::Constant(value) => value,
    }
}

/// Writes a bit; an index may lead out of its area.
pub(super) fn write_bit(
    image: &mut Image,
    operand: BitOperand,
    index: i32,
    value: bool,
) -> Result<(), PlcError> {
    let bit = bit_at(operand, index).ok_or(PlcError::IndexOutOfRange)?;
    image.set_bit(bit, value);
    Ok(())
}

/// Writes a byte, word or doubleword; an index may lead out of the memory.
pub(super) fn write_number(
    image: &mut Image,
    operand: NumberOperand,
    index: i32,
    value: i32,
) -> Result<(), PlcError> {
    let number = number_at(operand, index).ok_or(PlcError::IndexOutOfRange)?;
    image.set_number(number, value);
    Ok(())
}

/// Reads consecutive bits, the first one lowest, sign-filled from the last one [000:12186-12223].
pub(super) fn read_bits(image: &Image, first: BitOperand, count: u8, index: i32) -> i32 {
    let mut value = 0_u32;
    for offset in 0..count {
        let bit = nth(first, index, offset).is_some_and(|bit| image.bit(bit));
        value |= u32::from(bit) << offset;
    }
    let unused = 32 - u32::from(count.clamp(1, 32));
    (value << unused) as i32 >> unused
}

/// Writes consecutive bits, the lowest to the first one.
pub(super) fn write_bits(
    image: &mut Image,
    first: BitOperand,
    count: u8,
    index: i32,
    value: i32,
) -> Result<(), PlcError> {
    let last = nth(first, index, count.saturating_sub(1));
    if bit_at(first, index).is_none() || last.is_none() {
        return Err(PlcError::IndexOutOfRange);
    }
    for offset in 0..count {
        if let Some(bit) = nth(first, index, offset) {
            image.set_bit(bit, value >> offset & 1 != 0);
        }
    }
    Ok(())
}

/// The bit that stands some places after an operand; commands that move several bits cross the gaps of
/// an area by number.
fn nth(first: BitOperand, index: i32, offset: u8) -> Option<Bit> {
    let shift = if first.indexed { i32::from(index as i16) } else { 0 };
    let number = i32::from(first.bit.number()) + shift + i32::from(offset);
    let bit = Bit::new(first.bit.area(), u16::try_from(number).ok()?)?;
    (bit.number() <= bit.area().last()).then_some(bit)
}
