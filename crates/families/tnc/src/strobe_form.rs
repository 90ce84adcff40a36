//! Which strobes the NC takes: those with words (M2719 = 1), or those of the TNC 355 with markers (M2719 = 0)
//! [000:16166-16183].
//!
//! The handshakes are the same: the form says which marker is the strobe and where its number stands. Strobes
//! of the marker form that move something have a complement. It is 1 at rest; the PLC sets the strobe and resets the
//! complement together, the NC does the reverse at the end [000:10737-10740] [000:10803-10806]. Where the two agree
//! the PLC program is faulty, as with the keys of the panel [000:7543-7585].
//!
//! Decision: M2719 = 0 takes the strobes of the TNC 355, M2719 = 1 those with words; codes from the NC stand in words
//! and markers always (also `tnc/src/marker_codes.rs`)
//!
//! Decision: Strobes of movements of the TNC 355 agree with their complements as ERROR IN PLC-PROGRAM 1E to 1H, 2K,
//! 2P, the codes that the manual's series leave out

use bahn_exchange::{Bit, Exchange, Image, signal as s};

use crate::marker_codes::MarkerCode;
use crate::markers::{AXES, PLC_POSITIONING};
use crate::panel::PlcFaultCode;

/// The strobes that the NC takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// M2719 = 1: numbers in words.
    Words,
    /// M2719 = 0: numbers in markers.
    Markers,
}

impl Form {
    /// The form that the PLC has chosen.
    pub fn of(nc: &Image) -> Form {
        if nc.bit(s::WORD_PROCESSING) {
            Form::Words
        } else {
            Form::Markers
        }
    }

    /// The strobe of the PLC positioning of an axis is set.
    pub fn positions(self, index: usize, nc: &Image) -> bool {
        let strobe = match self {
            Form::Words => PLC_POSITIONING.get(index).copied(),
            Form::Markers => POSITIONING.get(index).map(|pair| pair.strobe),
        };
        strobe.is_some_and(|strobe| nc.bit(strobe))
    }

    /// Resets the strobe of the PLC positioning of an axis.
    pub fn end_positioning(self, index: usize, exchange: &mut Exchange) {
        match self {
            Form::Words => {
                if let Some(strobe) = PLC_POSITIONING.get(index) {
                    exchange.nc_set(*strobe, false);
                }
            }
            Form::Markers => {
                if let Some(pair) = POSITIONING.get(index) {
                    pair.end(exchange);
                }
            }
        }
    }
}

/// A strobe of the marker form with its complement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    strobe: Bit,
    complement: Bit,
    /// The markers that choose the position.
    pub code: MarkerCode,
    /// The letters after `ERROR IN PLC-PROGRAM`. The manual prints none for these pairs; in its series 1A (M2448) to 1P
    /// (M2463) and 2A (M2512) to 2N (M2525) they are the ones that are left out *(inferred)*.
    fault: PlcFaultCode,
}

impl Pair {
    /// The PLC has set the strobe.
    pub fn is_set(&self, nc: &Image) -> bool {
        nc.bit(self.strobe)
    }

    /// The PLC has taken the strobe back, and the complement is still reset.
    pub fn is_taken_back(&self, nc: &Image) -> bool {
        !nc.bit(self.strobe) && !nc.bit(self.complement)
    }

    /// Strobe and complement are as at rest again.
    pub fn end(&self, exchange: &mut Exchange) {
        exchange.nc_put(self.strobe, false);
        exchange.nc_put(self.complement, true);
    }

    /// # Errors
    /// The code of the fault when strobe and complement agree.
    pub fn check(&self, nc: &Image) -> Result<(), PlcFaultCode> {
        if nc.bit(self.strobe) == nc.bit(self.complement) {
            return Err(self.fault);
        }
        Ok(())
    }
}

const fn pair(strobe: Bit, complement: Bit, code: MarkerCode, fault: &PlcFaultCode) -> Pair {
    Pair {
        strobe,
        complement,
        code,
        fault: *fault,
    }
}

/// PLC positioning X, Y, Z, 4, 5. That the 5th axis has the markers between those of the 4th and of the spindle is
/// inferred: the table of equivalents ends with the 4th [000:16175-16183].
pub(crate) const POSITIONING: [Pair; AXES] = [
    pair(
        s::POSITION_AXIS_X_TNC355,
        s::COMPLEMENT_M2452,
        MarkerCode::position(s::POSITION_CODE_AXIS_X_TNC355),
        b"1E",
    ),
    pair(
        s::POSITION_AXIS_Y_TNC355,
        s::COMPLEMENT_M2453,
        MarkerCode::position(s::POSITION_CODE_AXIS_Y_TNC355),
        b"1F",
    ),
    pair(
        s::POSITION_AXIS_Z_TNC355,
        s::COMPLEMENT_M2454,
        MarkerCode::position(s::POSITION_CODE_AXIS_Z_TNC355),
        b"1G",
    ),
    pair(
        s::POSITION_AXIS_4_TNC355,
        s::COMPLEMENT_M2455,
        MarkerCode::position(s::POSITION_CODE_AXIS_4_TNC355),
        b"1H",
    ),
    pair(
        s::POSITION_AXIS_5_TNC355,
        s::COMPLEMENT_M2522,
        MarkerCode::position(s::POSITION_CODE_AXIS_5_TNC355),
        b"2K",
    ),
];

/// Spindle orientation: M2527, M2543, M2585 to M2589 [000:16183].
pub(crate) const ORIENTATION: Pair = pair(
    s::START_SPINDLE_ORIENTATION_TNC355,
    s::COMPLEMENT_M2527,
    MarkerCode::position(s::ORIENTATION_CODE_TNC355),
    b"2P",
);

/// At power-on all pairs are at rest.
pub(crate) fn preset(exchange: &mut Exchange) {
    for pair in POSITIONING.iter().chain([&ORIENTATION]) {
        pair.end(exchange);
    }
}
