//! A programming station whose PLC is inactive, MP170 = 2 of a TNC 151/155: in the place of a scan the buttons of the
//! standard interface act [001:463-465] [001:1005-1013], and what the NC puts out is acknowledged at once.
//!
//! Decision: MP170 = 2: buttons for start, rapid and directions act at E22, E21 and E9 to E16; stop and feed release, which
//! are openers, count as closed, since no wiring is asked for; no other input and no output does anything

use bahn_exchange::{Bit, BitArea, Exchange, signal as s};

use crate::panel::{Buttons, press};

/// Inputs of the buttons: start, rapid, and the first of the directions X+, X-, Y+ to IV-.
const START: u16 = 22;
const RAPID: u16 = 21;
const FIRST_DIRECTION: u16 = 9;

/// What is put out, with its acknowledgement.
const ACKNOWLEDGED: [(Bit, Bit); 5] = [
    (s::GEAR_STROBE, s::GEAR_ACK),
    (s::S_STROBE, s::S_ACK),
    (s::M_FUNCTION_STROBE, s::M_FUNCTION_ACK),
    (s::TOOL_CALL_STROBE, s::TOOL_CALL_ACK),
    (s::TOOL_DEF_STROBE, s::TOOL_DEF_ACK),
];

/// What a scan would have done.
pub(crate) fn scan(exchange: &mut Exchange) {
    exchange.begin_scan();
    let plc = exchange.plc_mut();
    let input = |number| Bit::new(BitArea::I, number).is_some_and(|bit| plc.bit(bit));
    let direction = |number| input(FIRST_DIRECTION + number);
    let buttons = Buttons {
        start: input(START),
        rapid: input(RAPID),
        directions: [0, 2, 4, 6].map(|plus| [direction(plus), direction(plus + 1)]),
    };
    press(&buttons, plc);
    for (strobe, acknowledgement) in ACKNOWLEDGED {
        let put_out = plc.bit(strobe);
        plc.set_bit(acknowledgement, put_out);
    }
    exchange.end_scan();
}
