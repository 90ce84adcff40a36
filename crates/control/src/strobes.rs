//! What the PLC asks the NC for between the big handshakes: traverse range, datum correction, Q
//! parameters, actual-value transfer, keys, lubrication and lag tracking. Each strobe is taken after the scan
//! that set it, and reset.

use bahn_exchange::{Exchange, Image, signal};

use crate::axes::OwnAxes;
use crate::axis::Mover;
use crate::command::{Command, Mode};
use crate::markers::{ACTUAL_TO_NOMINAL, LAG_TRACKING, LUBRICATED, LUBRICATION_PULSE, TRANSFER};
use crate::positioning::PER_MM;
use crate::q_transfer::Q_FROM_PLC;
use bahn_parameters::PerPlcAxis;

/// W576 ff. count in 1/10 µm [000:10950].
const PER_MM_TRACKING: f64 = 10_000.0;

/// Two uses of D528 in one scan are a fault: 1R [000:631-633].
pub(crate) fn is_transfer_doubly_used(positioning_wanted: bool, nc: &Image) -> bool {
    let uses = [
        positioning_wanted,
        nc.bit(signal::TRANSFER_Q_PARAMETER),
        nc.bit(signal::CORRECT_DATUM),
    ];
    uses.into_iter().filter(|used| *used).count() > 1
}

/// M2824: whether a traverse range is wanted, and the one in M2816 and M2817 [000:3510-3520]. 3 is not defined; the
/// range stays (inferred).
pub(crate) fn range(exchange: &mut Exchange) -> Option<Option<usize>> {
    let nc = exchange.nc();
    if !nc.bit(signal::ACTIVATE_TRAVERSE_RANGE) {
        return None;
    }
    let bits = [
        nc.bit(signal::TRAVERSE_RANGE_BIT_0),
        nc.bit(signal::TRAVERSE_RANGE_BIT_1),
    ];
    exchange.nc_set(signal::ACTIVATE_TRAVERSE_RANGE, false);
    Some(match bits {
        [false, false] => Some(0),
        [true, false] => Some(1),
        [false, true] => Some(2),
        [true, true] => None,
    })
}

/// M2716: datum correction D528 ff., each replaces the last one, when it `may` be corrected: without a program, or
/// during an M, S or T strobe [000:8910-8940].
pub(crate) fn datum_correction(may: bool, exchange: &mut Exchange) -> Option<PerPlcAxis<f64>> {
    if !exchange.nc().bit(signal::CORRECT_DATUM) {
        return None;
    }
    exchange.nc_set(signal::CORRECT_DATUM, false);
    let nc = exchange.nc();
    may.then(|| PerPlcAxis(TRANSFER.map(|number| f64::from(nc.number(number)) / PER_MM)))
}

/// M2713: D528 into Q100 to Q107 by W516 [000:6997-7008] [000:11657-11663].
pub(crate) fn q_parameter(exchange: &mut Exchange) -> Option<(u16, f64)> {
    let nc = exchange.nc();
    if !nc.bit(signal::TRANSFER_Q_PARAMETER) {
        return None;
    }
    let number = nc.number(signal::KEY_CODE_OR_Q_NUMBER);
    let value = f64::from(nc.number(signal::TRANSFER_VALUE)) / PER_MM;
    exchange.nc_set(signal::TRANSFER_Q_PARAMETER, false);
    let number = u16::try_from(number).ok().filter(|number| *number <= 7)?;
    Some((Q_FROM_PLC + number, value))
}

/// M2552 ff.: the actual value becomes the nominal value, in Manual and Handwheel [000:5423-5434].
pub(crate) fn take_actual_values(mode: Mode, axes: &mut OwnAxes, nc: &Image) {
    if !matches!(mode, Mode::Manual | Mode::Handwheel) {
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

/// M2813: whether there is a key by its code in W516, or a soft-key function, and its command [000:7406-7440].
pub(crate) fn key(nc: &Image) -> Option<Option<Command>> {
    if !nc.bit(signal::SIMULATE_KEY) {
        return None;
    }
    Some(match nc.number(signal::KEY_CODE_OR_Q_NUMBER) {
        0x0000 => Some(Command::InternalStop),
        0x0400 => Some(Command::Mode(Mode::Reference)),
        0x0500 => Some(Command::RestorePosition),
        code @ 58..=127 => u8::try_from(code).ok().map(Command::Key),
        _ => None,
    })
}

/// The key was executed, or M2187 = 1 [000:7406-7440].
pub(crate) fn end_key(done: bool, exchange: &mut Exchange) {
    exchange.nc_put(signal::SOFT_KEY_NOT_EXECUTED, !done);
    exchange.nc_set(signal::SIMULATE_KEY, false);
}

/// M2548 ff.: the PLC lubricated; the way counts anew. The NC acts on the level and leaves the marker
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
