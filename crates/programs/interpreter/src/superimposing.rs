//! The words of M118: how far the handwheel may lead each axis beside the path [000:742].

use bahn_parameters::MessageId;
use bahn_path::{Axis, Position};
use bahn_program::MFunctions;

use crate::error::Fault;
use crate::numbers::Numbers;

/// Greatest range, mm or degrees: that of coordinates.
const MOST: f64 = 99_999.999_9;

/// The ranges of M118, mm or degrees; without words there are none any more.
pub(crate) fn ranges(m: &MFunctions, numbers: &Numbers) -> Result<Position, Fault> {
    let mut ranges = Position::ZERO;
    for axis in Axis::ALL {
        let Some(value) = m.argument(118, axis.letter()) else {
            continue;
        };
        let value = numbers.q.value(value)?;
        if !(0.0..=MOST).contains(&value) {
            let detail = format!("{} of M118 is 0 to {MOST}, not {value}", axis.letter());
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        ranges[axis] = if axis.is_rotary() {
            value
        } else {
            value * numbers.unit_mm
        };
    }
    Ok(ranges)
}
