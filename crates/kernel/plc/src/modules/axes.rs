//! Modules 9120 to 9124: PLC axes [000:15907-16035][000:4092-4240].
//!
//! Decision: Bit 1 of module 9122 is of every axis, the others of PLC axes, which modules 9120 to 9123 move alone

use bahn_parameters::PLC_AXES;

use super::{Call, Outcome};
use crate::{PlcAxisCommand, PlcError};

/// 9120: positions an axis. Its page is lost: arguments as in the worked example, an incremental target
/// with bit 0 of the mode (inferred) [000:4193-4197].
pub(super) fn start(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [axis, target, feed, mode] = call.arguments()?;
    let command = PlcAxisCommand::Start {
        target: f64::from(target) / 10_000.0,
        incremental: mode & 1 != 0,
        feed: f64::from(feed),
    };
    let code = command_standing(call, axis, command);
    call.code(code)
}

/// 9121: stops an axis.
pub(super) fn stop(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const ALREADY_STATIONARY: i32 = 3;
    let [axis] = call.arguments()?;
    let code = match plc_axis(call, axis) {
        Ok(axis) if call.nc.plc_axis_status(axis).positioning => {
            call.nc.command_plc_axis(axis, PlcAxisCommand::Stop);
            0
        }
        Ok(_) => ALREADY_STATIONARY,
        Err(code) => code,
    };
    call.code(code)
}

/// 9122: status bits of an axis. Whether it is over its reference point is told of every axis; the other bits are those of
/// modules 9120 to 9123, which move PLC axes alone (inferred).
pub(super) fn status(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [axis] = call.arguments()?;
    let place = usize::try_from(axis).ok().filter(|axis| *axis < PLC_AXES);
    let word = place.map(|place| {
        let status = call.nc.plc_axis_status(place);
        let own = plc_axis(call, axis).is_ok();
        let bits = [
            own,
            status.referenced,
            own && status.positioning,
            own && status.negative,
            own && status.error,
        ];
        (0..).zip(bits).map(|(bit, set)| i32::from(set) << bit).sum()
    });
    call.result_or_failed(word)
}

/// 9123: moves an axis until its reference mark is found.
pub(super) fn traverse_reference_marks(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [axis, feed, flags] = call.arguments()?;
    let command = PlcAxisCommand::TraverseReferenceMarks {
        feed: f64::from(feed),
        negative: flags & 1 != 0,
    };
    let code = command_standing(call, axis, command);
    call.code(code)
}

/// 9124: sets the override of an axis.
pub(super) fn set_override(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const WRONG_VALUE: i32 = 3;
    let [axis, value] = call.arguments()?;
    let code = match plc_axis(call, axis) {
        Ok(axis) if (0..=10_000).contains(&value) => {
            call.nc.override_plc_axis(axis, f64::from(value) / 100.0);
            0
        }
        Ok(_) => WRONG_VALUE,
        Err(code) => code,
    };
    call.code(code)
}

const NO_SUCH_AXIS: i32 = 1;
const NOT_A_PLC_AXIS: i32 = 2;

/// Gives a command to an axis that must stand. Whether it stands is what the axis was at the start of the
/// scan (inferred) [000:15942].
fn command_standing(call: &mut Call<'_>, axis: i32, command: PlcAxisCommand) -> i32 {
    const ALREADY_POSITIONING: i32 = 3;
    match plc_axis(call, axis) {
        Ok(axis) if call.nc.plc_axis_status(axis).positioning => ALREADY_POSITIONING,
        Ok(axis) => {
            call.nc.command_plc_axis(axis, command);
            0
        }
        Err(code) => code,
    }
}

/// An axis that MP10 activates and MP60 gives to the PLC.
fn plc_axis(call: &Call<'_>, axis: i32) -> Result<usize, i32> {
    let axis = usize::try_from(axis)
        .ok()
        .filter(|axis| *axis < PLC_AXES)
        .ok_or(NO_SUCH_AXIS)?;
    let has = |number: u16| call.parameter(number, 0) as u32 >> axis & 1 != 0;
    if has(10) && has(60) {
        Ok(axis)
    } else {
        Err(NOT_A_PLC_AXIS)
    }
}
