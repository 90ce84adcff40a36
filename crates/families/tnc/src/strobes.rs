//! What the PLC asks the NC for between the big handshakes: traverse range, datum correction, Q
//! parameters, actual-value transfer, keys, lubrication and lag tracking. Each strobe is taken after the scan
//! that set it, and reset, but for M2809 of the TNC 355, which the PLC resets itself [000:16286].
//!
//! Decision: M2809 transfers a whole number of four decades with sign once for each rising edge; M2585 to M2589 are
//! the code of M2527 although they are also listed as not implemented; M2598 and M2599, listed both ways, too, are
//! not there: modules 9093 and 9094 are (also `tnc/src/marker_codes.rs`)

use bahn_exchange::{Exchange, Image, signal};
use bahn_kernel::{Mover, OwnAxes};
use bahn_parameters::PerPlcAxis;
use bahn_parameters::plc::PlcParameters;

use crate::command::{Command, Mode};
use crate::datums::Datums;
use crate::marker_codes;
use crate::markers::{ACTUAL_TO_NOMINAL, LAG_TRACKING, LUBRICATED, LUBRICATION_PULSE, TRANSFER};
use crate::panel::PlcFaultCode;
use crate::positioning::PER_MM;
use crate::q_transfer::Q_FROM_PLC;
use crate::strobe_form::Form;

/// W576 ff. count in 1/10 µm [000:10950].
const PER_MM_TRACKING: f64 = 10_000.0;

/// What is remembered of strobes from scan to scan.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Strobes {
    /// The number of M2809 is taken, until the PLC resets it *(inferred: its rising edge counts)*.
    number_taken: bool,
}

impl Strobes {
    /// Looks at what was asked for in a scan.
    ///
    /// # Errors
    /// 1R for two uses of D528, or of the markers from M2560 on, in one scan [000:631-633].
    pub fn check(&mut self, positioning_wanted: bool, nc: &Image) -> Result<(), PlcFaultCode> {
        self.number_taken &= nc.bit(signal::TRANSFER_NUMBER_TNC355);
        let [number, datum] = match Form::of(nc) {
            Form::Words => [signal::TRANSFER_Q_PARAMETER, signal::CORRECT_DATUM].map(|strobe| nc.bit(strobe)),
            Form::Markers => [self.wants_number(nc), nc.bit(signal::CORRECT_DATUM_TNC355)],
        };
        let uses = [positioning_wanted, number, datum];
        if uses.into_iter().filter(|used| *used).count() > 1 {
            return Err(*b"1R");
        }
        Ok(())
    }

    fn wants_number(&self, nc: &Image) -> bool {
        nc.bit(signal::TRANSFER_NUMBER_TNC355) && !self.number_taken
    }

    /// M2713: D528 into Q100 to Q107 by W516 [000:6997-7008] [000:11657-11663]; or M2809: M2560 ff. into Q100 to Q103
    /// by M2817 and M2818 [000:16286-16288].
    pub fn q_parameter(&mut self, exchange: &mut Exchange) -> Option<(u16, f64)> {
        let nc = exchange.nc();
        if Form::of(nc) == Form::Markers {
            if !self.wants_number(nc) {
                return None;
            }
            self.number_taken = true;
            let value = marker_codes::q_value(nc)?;
            return Some((Q_FROM_PLC + marker_codes::q_number(nc), value));
        }
        if !nc.bit(signal::TRANSFER_Q_PARAMETER) {
            return None;
        }
        let number = nc.number(signal::KEY_CODE_OR_Q_NUMBER);
        let value = f64::from(nc.number(signal::TRANSFER_VALUE)) / PER_MM;
        exchange.nc_set(signal::TRANSFER_Q_PARAMETER, false);
        let number = u16::try_from(number).ok().filter(|number| *number <= 7)?;
        Some((Q_FROM_PLC + number, value))
    }
}

/// M2824: selects the traverse range in M2816 and M2817 [000:3510-3520]. 3 is not defined; the range stays (inferred).
/// Whether one was wanted.
pub(crate) fn take_range(datums: &mut Datums, axes: &mut OwnAxes, exchange: &mut Exchange) -> bool {
    let nc = exchange.nc();
    if !nc.bit(signal::ACTIVATE_TRAVERSE_RANGE) {
        return false;
    }
    let bits = [
        nc.bit(signal::TRAVERSE_RANGE_BIT_0),
        nc.bit(signal::TRAVERSE_RANGE_BIT_1),
    ];
    exchange.nc_set(signal::ACTIVATE_TRAVERSE_RANGE, false);
    let range = match bits {
        [false, false] => 0,
        [true, false] => 1,
        [false, true] => 2,
        [true, true] => return true,
    };
    datums.select_range(range, axes);
    true
}

/// M2716: datum correction D528 ff., or M2819: MP4210.32 ff. for the traverse range; each replaces the last one, when
/// it `may` be corrected: without a program, or during an M, S or T strobe [000:8910-8940] [000:16182].
pub(crate) fn datum_correction(
    may: bool,
    range: usize,
    numbers: &PlcParameters,
    exchange: &mut Exchange,
) -> Option<PerPlcAxis<f64>> {
    let form = Form::of(exchange.nc());
    let strobe = match form {
        Form::Words => signal::CORRECT_DATUM,
        Form::Markers => signal::CORRECT_DATUM_TNC355,
    };
    if !exchange.nc().bit(strobe) {
        return None;
    }
    exchange.nc_set(strobe, false);
    let nc = exchange.nc();
    may.then(|| match form {
        Form::Words => PerPlcAxis(TRANSFER.map(|number| f64::from(nc.number(number)) / PER_MM)),
        Form::Markers => PerPlcAxis::from_fn(|axis| numbers.datum_correction_mm(range, usize::from(axis))),
    })
}

/// M2552 ff.: the actual value becomes the nominal value, in Manual and Handwheel [000:5423-5434], in every mode on the
/// TNC 151/155 [001:486-499].
pub(crate) fn take_actual_values(mode: Mode, everywhere: bool, axes: &mut OwnAxes, nc: &Image) {
    if !(everywhere || matches!(mode, Mode::Manual | Mode::Handwheel)) {
        return;
    }
    for unit in axes.iter_mut() {
        let wanted = ACTUAL_TO_NOMINAL
            .get(unit.index)
            .is_some_and(|marker| nc.bit(*marker));
        if wanted && unit.mover == Mover::None {
            unit.transfer();
        }
    }
}

/// The strobe of a key that the PLC simulates.
fn key_strobe(nc: &Image) -> bahn_exchange::Bit {
    match Form::of(nc) {
        Form::Words => signal::SIMULATE_KEY,
        Form::Markers => signal::KEY_CODE_STROBE_TNC355,
    }
}

/// M2813: whether there is a key by its code in W516, or a soft-key function, and its command [000:7406-7440]; or
/// M2808 with the code in M2800 ff. [000:16284-16285], which knows no soft keys *(inferred: their codes have two
/// bytes)*.
pub(crate) fn key(nc: &Image) -> Option<Option<Command>> {
    if !nc.bit(key_strobe(nc)) {
        return None;
    }
    let code = match Form::of(nc) {
        Form::Words => nc.number(signal::KEY_CODE_OR_Q_NUMBER),
        Form::Markers => {
            let code = marker_codes::SIMULATED_KEY.read(nc);
            code.filter(|code| *code != 0)
                .and_then(|code| i32::try_from(code).ok())
                .unwrap_or(-1)
        }
    };
    Some(u16::try_from(code).ok().map(Command::of_key_code))
}

/// The key was executed, or M2187 = 1 [000:7406-7440].
pub(crate) fn end_key(done: bool, exchange: &mut Exchange) {
    exchange.nc_put(signal::SOFT_KEY_NOT_EXECUTED, !done);
    exchange.nc_set(key_strobe(exchange.nc()), false);
}

/// M2548 ff.: the PLC lubricated; the distance counts anew. The NC acts on the level and leaves the marker
/// to the PLC [000:3575-3598].
pub(crate) fn take_lubrication(axes: &mut OwnAxes, exchange: &mut Exchange) {
    for unit in axes.iter_mut() {
        let (Some(done), Some(pulse)) = (LUBRICATED.get(unit.index), LUBRICATION_PULSE.get(unit.index))
        else {
            continue;
        };
        if exchange.nc().bit(*done) && exchange.nc().bit(*pulse) {
            unit.travelled = 0.0;
            exchange.nc_set(*pulse, false);
        }
    }
}

/// W576 ff.: thermal lag tracking, once in each PLC cycle [000:3902-3912].
pub(crate) fn take_lag_tracking(step_mm: f64, axes: &mut OwnAxes, nc: &Image) {
    for unit in axes.iter_mut() {
        if let Some(word) = LAG_TRACKING.get(unit.index) {
            let offset = f64::from(nc.number(*word)) / PER_MM_TRACKING;
            unit.servo.track(offset, step_mm);
        }
    }
}
