//! Modules 9100 to 9107: the data interfaces [000:15587-15833].

use bahn_exchange::STRING_LENGTH;
use bahn_parameters::interfaces::{BAUD_RATES, rates_exclude_each_other};

use super::numbers::{binary, hexadecimal};
use super::{Call, Outcome};
use crate::run::Text;
use crate::{DataInterface, InterfaceUser, PlcError};

/// Bytes of a binary transfer: two characters each [000:15605].
const BYTES_MAX: i32 = 63;

/// 9100: assigns an interface to the PLC. One that the PLC has already is initialised anew (inferred).
pub(super) fn assign(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface, parameters] = call.arguments()?;
    let (Some(number), true) = (interface_number(interface), call.from_submit) else {
        return Ok(Outcome::Failed);
    };
    if call.parameter(5000, 0) as usize == number + 1 {
        // It is inhibited for everybody [000:16984-16989].
        return Ok(Outcome::Failed);
    }
    let baud = match parameters {
        0 => BAUD_RATES.get(call.parameter(5040, 0) as usize).copied(),
        1 => Some(call.nc.data_interface(number).mode_baud),
        _ => None,
    };
    let other = call.nc.data_interface(1 - number).baud;
    let Some(baud) = baud.filter(|baud| !rates_exclude_each_other(*baud, other)) else {
        return Ok(Outcome::Failed);
    };
    let interface = call.nc.data_interface(number);
    if interface.user == Some(InterfaceUser::Nc) {
        return Ok(Outcome::Failed);
    }
    interface.assign_to_plc(baud, parameters == 1);
    Ok(Outcome::Done)
}

/// 9101: gives an interface back to the NC.
pub(super) fn release(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface] = call.arguments()?;
    let interface = assigned(call, interface);
    Ok(Outcome::of(interface.map(DataInterface::release).is_some()))
}

/// 9102: the status bits of an interface; also in the cyclic program.
pub(super) fn status(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface] = call.arguments()?;
    let bits = interface_number(interface).map(|number| {
        let interface = call.nc.data_interface(number);
        [
            interface.user.is_some(),
            interface.user == Some(InterfaceUser::Plc),
            interface.ready_as_reported(),
            interface.transmit.is_empty(),
            interface.transmit_error,
            // A string that is complete fills the buffer (inferred).
            interface.received,
            interface.receive_error,
            interface.end_of_text,
        ]
    });
    let word = bits.map(|bits| (0..).zip(bits).map(|(bit, set)| i32::from(set) << bit).sum());
    call.result_or_failed(word)
}

/// 9103: transmits a string, references replaced.
pub(super) fn transmit_text(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface, string] = call.arguments()?;
    let text = call.text(string).map(|text| call.resolved(&text));
    let text = text.filter(|text| text.len() < STRING_LENGTH);
    let text = text.and_then(|text| Text::try_from(text.as_slice()).ok());
    Ok(transmit(call, interface, text))
}

/// 9104: takes the received string.
pub(super) fn receive_text(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface, string] = call.arguments()?;
    let text = assigned(call, interface)
        .filter(|interface| interface.received)
        .map(|interface| interface.receive.clone());
    let done = text.is_some_and(|text| call.set_text(string, &text));
    Ok(taken(call, interface, done))
}

/// 9105: transmits bytes as hexadecimal text.
pub(super) fn transmit_bytes(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface, first, length] = call.arguments()?;
    let valid = (0..=BYTES_MAX).contains(&length);
    let bytes = call.bytes(first, length).filter(|_| valid);
    let text = bytes.and_then(|bytes| hexadecimal(&bytes));
    Ok(transmit(call, interface, text))
}

/// 9106: takes received hexadecimal text as bytes; the result is their number.
pub(super) fn receive_bytes(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface, first] = call.arguments()?;
    let text = received(call, interface).filter(|text| text.len() <= STRING_LENGTH);
    let bytes = text.and_then(|text| binary(&text));
    let length = bytes.as_ref().and_then(|bytes| i32::try_from(bytes.len()).ok());
    let done = bytes.is_some_and(|bytes| call.set_bytes(first, &bytes));
    call.result(length.filter(|_| done).unwrap_or(0))?;
    Ok(taken(call, interface, done))
}

/// 9107: reads one byte of the received hexadecimal text, which stays. After the text the value is not
/// defined in the manual; here it is 0 (inferred).
pub(super) fn peek(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [interface, offset] = call.arguments()?;
    let text = received(call, interface);
    let start = usize::try_from(offset).ok().filter(|_| offset <= BYTES_MAX);
    let byte = text.zip(start).and_then(|(text, start)| {
        let byte = text.get(start * 2..start * 2 + 2);
        byte.map_or(Some(0), |byte| binary(byte)?.first().copied())
    });
    call.result_or_failed(byte.map(i32::from))
}

fn interface_number(interface: i32) -> Option<usize> {
    usize::try_from(interface).ok().filter(|number| *number < 2)
}

/// The interface, when a submit job calls and the PLC has it.
fn assigned<'c>(call: &'c mut Call<'_>, interface: i32) -> Option<&'c mut DataInterface> {
    let number = interface_number(interface).filter(|_| call.from_submit)?;
    let interface = call.nc.data_interface(number);
    (interface.user == Some(InterfaceUser::Plc)).then_some(interface)
}

/// What was received, complete or not; `None` when there is nothing.
fn received(call: &mut Call<'_>, interface: i32) -> Option<Vec<u8>> {
    let interface = assigned(call, interface)?;
    (!interface.receive.is_empty()).then(|| interface.receive.clone())
}

fn transmit(call: &mut Call<'_>, interface: i32, text: Option<Text>) -> Outcome {
    let (Some(interface), Some(text)) = (assigned(call, interface), text) else {
        return Outcome::Failed;
    };
    Outcome::of(interface.start_transmission(&text))
}

/// Clears the receive buffer when its content was taken.
fn taken(call: &mut Call<'_>, interface: i32, done: bool) -> Outcome {
    if let (true, Some(interface)) = (done, assigned(call, interface)) {
        interface.clear_received();
    }
    Outcome::of(done)
}
