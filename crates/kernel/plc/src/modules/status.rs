//! Modules 9035 and 9036: status of the control [000:14899-14976].

use super::{Call, Outcome};
use crate::{JogLimit, PlcError, StatusChange, StatusItem};

/// 9035: reads one item of status.
pub(super) fn read(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [number] = call.arguments()?;
    let value = StatusItem::numbered(number).map(|item| call.nc.status(item));
    call.result_or_failed(value)
}

/// 9036: changes one item of status.
pub(super) fn write(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const WRONG_NUMBER: i32 = 1;
    const OUT_OF_RANGE: i32 = 2;
    const DISABLED: i32 = 3;
    let [number, value] = call.arguments()?;
    let code = match change(number, value) {
        Err(Fault::Number) => WRONG_NUMBER,
        Err(Fault::Value) => OUT_OF_RANGE,
        Ok(change) if !enabled(call, &change) => DISABLED,
        Ok(change) => {
            call.nc.change_status(change);
            0
        }
    };
    call.code(code)
}

enum Fault {
    Number,
    Value,
}

/// Longest jog increment that a limit may allow, in 1/10 000 mm: 50 mm [000:14948].
const JOG_LIMIT_MAX: i32 = 500_000;

fn change(number: i32, value: i32) -> Result<StatusChange, Fault> {
    let axis = match number {
        0..=4 => Some(number as usize),
        5 | 6 => None,
        10 => {
            return Ok(StatusChange::JogLimit(match value {
                -2 => JogLimit::SmallerOfLastIncrementAndLimit,
                0..=JOG_LIMIT_MAX => JogLimit::At(f64::from(value) / 10_000.0),
                _ => JogLimit::LastIncrement,
            }));
        }
        _ => return Err(Fault::Number),
    };
    match (number, u8::try_from(value)) {
        (6, Ok(axis @ 0..=4)) => Ok(StatusChange::HandwheelAxis(axis.into())),
        (0..=5, Ok(factor @ 0..=10)) => Ok(StatusChange::Subdivision { axis, factor }),
        _ => Err(Fault::Value),
    }
}

/// Subdivision is the PLC's with MP7641 = 1, the axis with MP7640 from 0 to 4 [000:14942-14953].
fn enabled(call: &Call<'_>, change: &StatusChange) -> bool {
    match change {
        StatusChange::Subdivision { .. } => call.parameter(7641, 0) == 1.0,
        StatusChange::HandwheelAxis(_) => call.parameter(7640, 0) <= 4.0,
        StatusChange::JogLimit(_) => true,
    }
}
