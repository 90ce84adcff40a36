//! The transfer of functions to the PLC: data, strobe, acknowledgement.
//!
//! For every function the NC writes the data and sets the strobe; the PLC works and sets the
//! acknowledgement; the NC resets the strobe and goes on; the PLC resets the acknowledgement. As long as an
//! acknowledgement is still set, no further strobe is sent [000:7188-7204] [000:11750-11752].
//!
//! Decision: With MP7440 bit 2 = 1 the PLC neither positions axes nor corrects the datum during an M strobe, since
//! the path goes on: corrections come to nothing, positions are taken when no program runs. It may orient the spindle
//! and change the traverse range, which moves no axis of the path
//!
//! Decision: M2614 holds the path at the end of the block whose strobe was acknowledged under it; without a strobe it
//! holds nothing

use std::collections::VecDeque;

use bahn_exchange::{Bit, Exchange, Image, signal};
use bahn_kernel::LOOK_AHEAD;

use crate::marker_codes;

/// A function on its way to the PLC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transfer {
    /// Miscellaneous function M0 to M99: W260, M2045 [000:7188-7206].
    M(u8),
    /// TOOL CALL: W262 and W264, M2046; `more` announces a second code (M2093) [000:9227-9229].
    ToolCall {
        /// Tool or pocket number, by MP7480.
        w262: i16,
        /// Tool number where W262 is a pocket.
        w264: i16,
        /// Another code follows for the same tool change.
        more: bool,
    },
    /// TOOL DEF: W262 and W264, M2047 [000:9227-9229].
    ToolDef {
        /// Tool or pocket number, by MP7480.
        w262: i16,
        /// Tool number where W262 is a pocket.
        w264: i16,
    },
    /// Gear range with analogue spindle speed: W256, D356 and D756, M2043 [000:5612-5624].
    Gear {
        /// Gear code, 0 for the first range.
        code: u8,
        /// Programmed speed, 1/1000 rpm.
        speed: i32,
    },
    /// Coded spindle speed: W258, M2044 [000:5718-5745].
    SCode(u8),
    /// FN19: D280, D284, M2150, M2149 [000:11595-11655].
    Plc {
        /// The two values, 1/10 000 mm or inch; `None` leaves the doubleword as it is.
        values: [Option<i32>; 2],
        /// The program is in inches.
        inch: bool,
    },
}

/// A strobe with its acknowledgement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Handshake {
    /// Set and reset by the NC.
    pub strobe: Bit,
    /// Set and reset by the PLC.
    pub acknowledge: Bit,
}

const M: Handshake = pair(signal::M_FUNCTION_STROBE, signal::M_FUNCTION_ACK);
const TOOL_CALL: Handshake = pair(signal::TOOL_CALL_STROBE, signal::TOOL_CALL_ACK);
const TOOL_DEF: Handshake = pair(signal::TOOL_DEF_STROBE, signal::TOOL_DEF_ACK);
const GEAR: Handshake = pair(signal::GEAR_STROBE, signal::GEAR_ACK);
const S_CODE: Handshake = pair(signal::S_STROBE, signal::S_ACK);
const PLC: Handshake = pair(signal::FN19_STROBE, signal::FN19_ACK);

const fn pair(strobe: Bit, acknowledge: Bit) -> Handshake {
    Handshake { strobe, acknowledge }
}

impl Transfer {
    /// The markers of the transfer.
    pub fn handshake(self) -> Handshake {
        match self {
            Transfer::M(_) => M,
            Transfer::ToolCall { .. } => TOOL_CALL,
            Transfer::ToolDef { .. } => TOOL_DEF,
            Transfer::Gear { .. } => GEAR,
            Transfer::SCode(_) => S_CODE,
            Transfer::Plc { .. } => PLC,
        }
    }

    /// Writes the data, in words and in the markers of the TNC 355.
    fn write(self, exchange: &mut Exchange) {
        match self {
            Transfer::M(code) => {
                exchange.nc_set_number(signal::M_CODE, code.into());
                marker_codes::M_FUNCTION.put(code.into(), exchange);
            }
            Transfer::ToolCall { w262, w264, .. } | Transfer::ToolDef { w262, w264 } => {
                exchange.nc_set_number(signal::T_CODE, w262.into());
                exchange.nc_set_number(signal::TOOL_NUMBER, w264.into());
                marker_codes::put_tool(w262, exchange);
            }
            Transfer::Gear { code, speed } => {
                exchange.nc_set_number(signal::GEAR_CODE, code.into());
                exchange.nc_set_number(signal::PROGRAMMED_SPINDLE_SPEED, speed);
                exchange.nc_set_number(signal::SPINDLE_SPEED_FROM_PLC, speed);
                marker_codes::GEAR.put(code.into(), exchange);
            }
            Transfer::SCode(code) => {
                exchange.nc_set_number(signal::S_CODE, code.into());
                marker_codes::SPEED.put(code.into(), exchange);
            }
            Transfer::Plc { values, .. } => {
                for (value, number) in values
                    .into_iter()
                    .zip([signal::FN19_FIRST_VALUE, signal::FN19_SECOND_VALUE])
                {
                    if let Some(value) = value {
                        exchange.nc_set_number(number, value);
                    }
                }
            }
        }
    }

    /// Writes the data and sets the strobe.
    fn send(self, exchange: &mut Exchange) {
        self.write(exchange);
        match self {
            Transfer::M(code) if exchange.nc().bit(signal::ENABLE_DECODED_M) => {
                if let Some(marker) = signal::DECODED_M_FUNCTIONS.get(code.into()) {
                    exchange.nc_set(marker, true);
                }
            }
            Transfer::ToolCall { more, .. } => exchange.nc_set(signal::TOOL_CALL_ANOTHER_T_FOLLOWS, more),
            Transfer::Plc { inch, .. } => exchange.nc_set(signal::FN19_INCH, inch),
            _ => {}
        }
        exchange.nc_set(self.handshake().strobe, true);
    }

    /// Resets what the strobe set.
    fn end(self, exchange: &mut Exchange) {
        exchange.nc_set(self.handshake().strobe, false);
        if let Transfer::M(code) = self
            && let Some(marker) = signal::DECODED_M_FUNCTIONS.get(code.into())
            && exchange.nc().bit(marker)
        {
            exchange.nc_set(marker, false);
        }
    }
}

/// What the PLC has to do before the handshake goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waiting {
    /// The PLC must set the acknowledgement.
    Acknowledge(Handshake),
    /// The PLC must reset the acknowledgement of the last transfer before the next strobe.
    AcknowledgeReset(Handshake),
}

impl std::fmt::Display for Waiting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Waiting::Acknowledge(pair) => {
                write!(f, "strobe {}: the PLC must set {}", pair.strobe, pair.acknowledge)
            }
            Waiting::AcknowledgeReset(pair) => {
                write!(
                    f,
                    "next strobe {}: the PLC must reset {}",
                    pair.strobe, pair.acknowledge
                )
            }
        }
    }
}

/// The transfers in their order, one at a time.
#[derive(Clone, Debug)]
pub(crate) struct Handshakes {
    queue: VecDeque<Transfer>,
    active: Option<Transfer>,
    /// The PLC inhibited the read-in when it acknowledged, and still does.
    inhibits: bool,
}

/// Transfers that wait before the path is held.
const CROWD: usize = 16;
/// Transfers of one block at most (inferred).
const PER_BLOCK: usize = 8;
/// Transfers that wait at most: while the path that is held comes to a standstill, it passes the blocks that
/// it has looked ahead at, and no others.
const CAPACITY: usize = CROWD + LOOK_AHEAD * PER_BLOCK;

impl Default for Handshakes {
    fn default() -> Handshakes {
        Handshakes {
            queue: VecDeque::with_capacity(CAPACITY),
            active: None,
            inhibits: false,
        }
    }
}

impl Handshakes {
    /// Adds a transfer after those that wait.
    pub fn push(&mut self, transfer: Transfer) {
        debug_assert!(self.queue.len() < CAPACITY, "the path is held before");
        self.queue.push_back(transfer);
    }

    /// So many transfers wait that the path is held until the PLC has taken some.
    pub fn is_crowded(&self) -> bool {
        self.queue.len() >= CROWD
    }

    /// M2614: after the block whose strobe was acknowledged none is executed [000:10835].
    pub fn inhibit_read_in(&self) -> bool {
        self.inhibits
    }

    /// Nothing is on its way.
    pub fn is_idle(&self) -> bool {
        self.active.is_none() && self.queue.is_empty()
    }

    /// A strobe of M, S, T, G or Q is set: the PLC may write Q parameters.
    pub fn strobe_is_set(&self) -> bool {
        self.active.is_some()
    }

    /// A strobe of M, S, T, G or Q is set: the PLC may position axes and correct the datum, but not during an M function at
    /// which the axes may go on, those that do not wait [000:7255].
    pub fn lets_plc_move(&self, axes_wait_at_m: bool) -> bool {
        self.active
            .is_some_and(|transfer| axes_wait_at_m || !matches!(transfer, Transfer::M(_)))
    }

    /// Goes on by one control cycle; the transfer that was acknowledged in it. Its strobe is reset only
    /// when it `may_end`.
    pub fn cycle(&mut self, exchange: &mut Exchange, may_end: bool) -> Option<Transfer> {
        self.inhibits &= exchange.nc().bit(signal::READ_IN_INHIBIT);
        if let Some(transfer) = self.active {
            if !may_end || !exchange.nc().bit(transfer.handshake().acknowledge) {
                return None;
            }
            transfer.end(exchange);
            self.active = None;
            self.inhibits |= exchange.nc().bit(signal::READ_IN_INHIBIT);
            return Some(transfer);
        }
        let next = self.queue.front()?;
        if !exchange.nc().bit(next.handshake().acknowledge) {
            next.send(exchange);
            self.active = self.queue.pop_front();
        }
        None
    }

    /// The transfer that the PLC has acknowledged and whose strobe is still set.
    pub fn acknowledged(&self, nc: &Image) -> Option<Transfer> {
        self.active
            .filter(|transfer| nc.bit(transfer.handshake().acknowledge))
    }

    /// The acknowledgement, or its reset, that the next step waits for; `None` when nothing is held up.
    pub fn waiting(&self, nc: &Image) -> Option<Waiting> {
        if let Some(transfer) = self.active {
            return Some(Waiting::Acknowledge(transfer.handshake()));
        }
        let handshake = self.queue.front()?.handshake();
        nc.bit(handshake.acknowledge)
            .then_some(Waiting::AcknowledgeReset(handshake))
    }

    /// Takes back everything: EMERGENCY STOP, internal stop. No other code of a tool change follows any more, M2093 = 0
    /// *(inferred)*: so the PLC knows of one that is broken off between its codes.
    pub fn abort(&mut self, exchange: &mut Exchange) {
        if let Some(transfer) = self.active.take() {
            transfer.end(exchange);
        }
        self.queue.clear();
        exchange.nc_put(signal::TOOL_CALL_ANOTHER_T_FOLLOWS, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One PLC scan in which the PLC sets the acknowledgement to a value.
    fn scan(exchange: &mut Exchange, acknowledge: bool) {
        exchange.begin_scan();
        exchange.plc_mut().set_bit(signal::M_FUNCTION_ACK, acknowledge);
        exchange.end_scan();
    }

    /// W260 and M2045 come together; M2045 stays until the scan in which the PLC sets M2482 has ended;
    /// the next M function waits for M2482 = 0 [000:7188-7204].
    #[test]
    fn edges_of_an_m_function() {
        let mut exchange = Exchange::default();
        let mut handshakes = Handshakes::default();
        handshakes.push(Transfer::M(3));
        handshakes.push(Transfer::M(8));
        assert_eq!(handshakes.cycle(&mut exchange, true), None);
        assert!(
            !exchange.plc().bit(signal::M_FUNCTION_STROBE),
            "the PLC sees it with the next scan"
        );
        scan(&mut exchange, false);
        assert!(exchange.plc().bit(signal::M_FUNCTION_STROBE));
        assert_eq!(exchange.plc().number(signal::M_CODE), 3);
        assert_eq!(handshakes.cycle(&mut exchange, true), None, "not acknowledged");
        assert_eq!(handshakes.waiting(exchange.nc()), Some(Waiting::Acknowledge(M)));
        scan(&mut exchange, true);
        assert_eq!(handshakes.cycle(&mut exchange, true), Some(Transfer::M(3)));
        assert!(
            exchange.plc().bit(signal::M_FUNCTION_STROBE),
            "until the next scan"
        );
        assert_eq!(handshakes.cycle(&mut exchange, true), None);
        assert_eq!(
            handshakes.waiting(exchange.nc()),
            Some(Waiting::AcknowledgeReset(M))
        );
        scan(&mut exchange, true);
        assert!(!exchange.plc().bit(signal::M_FUNCTION_STROBE));
        assert_eq!(handshakes.cycle(&mut exchange, true), None);
        assert_eq!(exchange.nc().number(signal::M_CODE), 3, "M2482 is still set");
        scan(&mut exchange, false);
        assert_eq!(handshakes.cycle(&mut exchange, true), None);
        assert_eq!(exchange.nc().number(signal::M_CODE), 8);
    }

    /// With M2496 = 1 one of M1900-M1999 goes with the strobe [000:7188-7204].
    #[test]
    fn decoded_m_functions() {
        let mut exchange = Exchange::default();
        exchange.nc_set(signal::ENABLE_DECODED_M, true);
        let mut handshakes = Handshakes::default();
        handshakes.push(Transfer::M(70));
        handshakes.cycle(&mut exchange, true);
        let m1970 = signal::DECODED_M_FUNCTIONS.get(70);
        assert_eq!(m1970.map(|marker| exchange.nc().bit(marker)), Some(true));
        scan(&mut exchange, true);
        assert_eq!(handshakes.cycle(&mut exchange, true), Some(Transfer::M(70)));
        assert_eq!(m1970.map(|marker| exchange.nc().bit(marker)), Some(false));
    }

    /// `FN19:PLC =+20.25/+100`: D280 = 202 500, D284 = 1 000 000, M2150 = 0 [000:11595-11655].
    #[test]
    fn values_for_the_plc() {
        let mut exchange = Exchange::default();
        let mut handshakes = Handshakes::default();
        handshakes.push(Transfer::Plc {
            values: [Some(202_500), Some(1_000_000)],
            inch: false,
        });
        handshakes.cycle(&mut exchange, true);
        exchange.begin_scan();
        let plc = exchange.plc();
        assert!(plc.bit(signal::FN19_STROBE) && !plc.bit(signal::FN19_INCH));
        assert_eq!(plc.number(signal::FN19_FIRST_VALUE), 202_500);
        assert_eq!(plc.number(signal::FN19_SECOND_VALUE), 1_000_000);
    }

    /// Broken off between the two codes of a tool change: M2093 = 0, and no strobe comes.
    #[test]
    fn no_other_code_follows_what_is_broken_off() {
        let mut exchange = Exchange::default();
        let mut handshakes = Handshakes::default();
        for more in [true, false] {
            let (w262, w264) = (1, 0);
            handshakes.push(Transfer::ToolCall { w262, w264, more });
        }
        handshakes.cycle(&mut exchange, true);
        exchange.begin_scan();
        exchange.plc_mut().set_bit(signal::TOOL_CALL_ACK, true);
        exchange.end_scan();
        assert!(handshakes.cycle(&mut exchange, true).is_some());
        let markers = [signal::TOOL_CALL_STROBE, signal::TOOL_CALL_ANOTHER_T_FOLLOWS];
        assert_eq!(markers.map(|marker| exchange.nc().bit(marker)), [false, true]);
        handshakes.abort(&mut exchange);
        assert_eq!(markers.map(|marker| exchange.nc().bit(marker)), [false, false]);
        assert!(handshakes.is_idle());
    }

    #[test]
    fn abort_takes_the_strobe_back() {
        let mut exchange = Exchange::default();
        let mut handshakes = Handshakes::default();
        handshakes.push(Transfer::SCode(80));
        handshakes.push(Transfer::M(3));
        handshakes.cycle(&mut exchange, true);
        assert!(exchange.nc().bit(signal::S_STROBE));
        handshakes.abort(&mut exchange);
        assert!(!exchange.nc().bit(signal::S_STROBE) && handshakes.is_idle());
    }
}
