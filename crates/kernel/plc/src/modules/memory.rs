//! Modules 9000 to 9022: copying and addressing memory [000:14741-14849].

use bahn_exchange::{Bit, BitArea, Size};

use super::address::{BYTES, fits, operand};
use super::{Call, Outcome};
use crate::PlcError;

/// 9000: copies markers one after the other, upward.
pub(super) fn copy_markers(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [source, destination, length] = call.arguments()?;
    let end = i32::from(BitArea::M.count());
    if !fits(source, length, end) || !fits(destination, length, end) {
        return Ok(Outcome::Failed);
    }
    let marker = |number: i32| {
        u16::try_from(number)
            .ok()
            .and_then(|number| Bit::new(BitArea::M, number))
    };
    for offset in 0..length {
        if let (Some(from), Some(to)) = (marker(source + offset), marker(destination + offset)) {
            let value = call.image.bit(from);
            call.image.set_bit(to, value);
        }
    }
    Ok(Outcome::Done)
}

/// 9001: copies bytes one after the other, upward.
pub(super) fn copy_bytes(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [source, destination, length] = call.arguments()?;
    if !fits(source, length, BYTES) || !fits(destination, length, BYTES) {
        return Ok(Outcome::Failed);
    }
    for offset in 0..length {
        let from = operand(Size::Byte, source + offset);
        let to = operand(Size::Byte, destination + offset);
        if let (Some(from), Some(to)) = (from, to) {
            let value = call.image.number(from);
            call.image.set_number(to, value);
        }
    }
    Ok(Outcome::Done)
}

/// Module 9010: reads the byte at an address.
pub(super) fn read_byte(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    read(call, Size::Byte)
}

/// Module 9011: reads the word at an address.
pub(super) fn read_word(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    read(call, Size::Word)
}

/// Module 9012: reads the doubleword at an address.
pub(super) fn read_double(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    read(call, Size::Double)
}

/// Module 9020: writes the byte at an address.
pub(super) fn write_byte(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    write(call, Size::Byte)
}

/// Module 9021: writes the word at an address.
pub(super) fn write_word(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    write(call, Size::Word)
}

/// Module 9022: writes the doubleword at an address.
pub(super) fn write_double(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    write(call, Size::Double)
}

fn read(call: &mut Call<'_>, size: Size) -> Result<Outcome, PlcError> {
    let [address] = call.arguments()?;
    let number = operand(size, address);
    let value = number.map(|number| call.image.number(number));
    call.result_or_failed(value)
}

fn write(call: &mut Call<'_>, size: Size) -> Result<Outcome, PlcError> {
    let [address, value] = call.arguments()?;
    let Some(number) = operand(size, address) else {
        return Ok(Outcome::Failed);
    };
    call.image.set_number(number, value);
    Ok(Outcome::Done)
}
