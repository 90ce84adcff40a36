//! Modules 9130, 9150 and 9171: spindle voltage, inserted TOOL CALL, spindle orientation
//! [000:16037-16160].

use bahn_exchange::{Size, signal};

use super::{Call, Outcome, address};
use crate::{OrientationDirection, PlcError, SpindleOrientation, ToolCallBlock};

/// 9130: outputs a voltage where the spindle's analogue output is free.
pub(super) fn output_voltage(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const SPINDLE: i32 = 0;
    /// MP3010 from this on means that the NC outputs the speed.
    const ANALOGUE_SPEED: f64 = 3.0;
    /// MP3011 that gives the output to this module.
    const OUTPUT_BY_MODULE: f64 = 2.0;
    const MILLIVOLTS_MAX: i32 = 10_000;
    let [output, millivolts] = call.arguments()?;
    let free = call.parameter(3010, 0) < ANALOGUE_SPEED && call.parameter(3011, 0) == OUTPUT_BY_MODULE;
    if output != SPINDLE || !free {
        return Ok(Outcome::Failed);
    }
    let millivolts = millivolts.clamp(-MILLIVOLTS_MAX, MILLIVOLTS_MAX);
    call.nc.output_spindle_voltage(f64::from(millivolts) / 1000.0);
    Ok(Outcome::Done)
}

/// 9150: inserts a TOOL CALL. A parameter block that does not lie in the memory counts as an unknown
/// command (inferred).
pub(super) fn insert_block(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const WITHOUT_STROBE: i32 = 1;
    const UNKNOWN_COMMAND: i32 = 2;
    const TOOL_CALL: i32 = 0;
    let [command, address] = call.arguments()?;
    let block = (command == TOOL_CALL).then(|| tool_call(call, address)).flatten();
    let code = match block {
        _ if call.runs_without_strobe() => WITHOUT_STROBE,
        None => UNKNOWN_COMMAND,
        Some(block) => {
            call.nc.insert_tool_call(block);
            0
        }
    };
    call.code(code)
}

/// Reads the parameter block [000:16100-16113].
fn tool_call(call: &Call<'_>, address: i32) -> Option<ToolCallBlock> {
    let number = |size, offset| {
        let number = address::operand(size, address.checked_add(offset)?)?;
        Some(call.image.number(number))
    };
    let active = number(Size::Byte, 0)?;
    let given = |bit: u32, value: i32| (active >> bit & 1 != 0).then_some(value);
    Some(ToolCallBlock {
        tool: given(0, number(Size::Word, 2)?),
        axis: given(1, number(Size::Byte, 1)?),
        speed: given(2, number(Size::Double, 4)?).map(|speed| f64::from(speed) / 1000.0),
        length_oversize: f64::from(given(3, number(Size::Double, 8)?).unwrap_or(0)) / 10_000.0,
        radius_oversize: f64::from(given(4, number(Size::Double, 12)?).unwrap_or(0)) / 10_000.0,
    })
}

/// 9171: orients the spindle. Without word processing, or a spindle that is controlled, it is an error (inferred).
pub(super) fn orient(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    /// MP3010 from this on means a controlled spindle [000:5444-5472].
    const CONTROLLED: f64 = 6.0;
    let [angle, speed, direction] = call.arguments()?;
    let Some((direction, from_cycle)) = direction_of(direction) else {
        return Ok(Outcome::Failed);
    };
    let controlled = call.parameter(3010, 0) >= CONTROLLED;
    let allowed = controlled && !call.from_submit && call.image.bit(signal::WORD_PROCESSING);
    if !allowed || speed < 0 || call.nc.spindle_orienting() {
        return Ok(Outcome::Failed);
    }
    let speed = match speed {
        0 => call.parameter(3520, 1),
        _ => f64::from(speed) / 1000.0,
    };
    call.nc.orient_spindle(SpindleOrientation {
        angle: f64::from(angle) / 10_000.0,
        added_to_cycle: from_cycle,
        speed,
        direction,
    });
    call.image.set_bit(signal::ORIENT_SPINDLE, true);
    Ok(Outcome::Done)
}

/// Direction, and whether the angle of CYCL DEF 13 is meant [000:16147-16152].
fn direction_of(direction: i32) -> Option<(OrientationDirection, bool)> {
    Some(match direction {
        -1 => (OrientationDirection::Negative, false),
        0 => (OrientationDirection::Shortest, false),
        1 => (OrientationDirection::Positive, false),
        2 => (OrientationDirection::Negative, true),
        3 => (OrientationDirection::Shortest, true),
        4 => (OrientationDirection::Positive, true),
        _ => return None,
    })
}
