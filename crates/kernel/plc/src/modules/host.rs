//! Modules 9110 and 9111: messages to and from a host by LSV/2 [000:15835-15905].

use super::{Call, Outcome, string_number};
use crate::{HostLink, HostMessage, PlcError};

const NO_CONNECTION: i32 = 1;
const WRONG_TYPE: i32 = 3;
const WRONG_ADDRESS: i32 = 4;

/// 9110: sends a doubleword or a string.
pub(super) fn transmit(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const BUFFER_FULL: i32 = 2;
    let [kind, address] = call.arguments()?;
    let message = match kind {
        0 => call
            .double(address)
            .map(|double| HostMessage::Double(call.image.number(double)))
            .ok_or(WRONG_ADDRESS),
        1 => call
            .text(address)
            .map(|text| HostMessage::Text(text.to_vec()))
            .ok_or(WRONG_ADDRESS),
        _ => Err(WRONG_TYPE),
    };
    let code = match (message, call.nc.host()) {
        (Err(code), _) => code,
        (Ok(_), None) => NO_CONNECTION,
        (Ok(_), Some(host)) if host.outgoing.len() >= HostLink::CAPACITY => BUFFER_FULL,
        (Ok(message), Some(host)) => {
            host.outgoing.push_back(message);
            0
        }
    };
    call.code(code)
}

/// 9111: takes the first message of a type.
pub(super) fn receive(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const NO_MESSAGE: i32 = 2;
    let [kind, address] = call.arguments()?;
    let exists = match kind {
        0 => call.double(address).is_some(),
        1 => string_number(address).is_some(),
        _ => return call.code(WRONG_TYPE),
    };
    if !exists {
        return call.code(WRONG_ADDRESS);
    }
    let Some(host) = call.nc.host() else {
        return call.code(NO_CONNECTION);
    };
    let wanted = |message: &HostMessage| matches!(message, HostMessage::Text(_)) == (kind == 1);
    let message = host
        .incoming
        .iter()
        .position(wanted)
        .and_then(|position| host.incoming.remove(position));
    match message {
        None => return call.code(NO_MESSAGE),
        Some(HostMessage::Double(value)) => {
            if let Some(double) = call.double(address) {
                call.image.set_number(double, value);
            }
        }
        // What is longer than a string memory is cut (inferred).
        Some(HostMessage::Text(text)) => {
            if let Some(string) = string_number(address) {
                call.image.set_text(string, &text);
            }
        }
    }
    call.code(0)
}
