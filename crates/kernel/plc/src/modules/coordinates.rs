//! Modules 9040 to 9042: coordinates of axes and spindle [000:14978-15021].

use super::{Call, Outcome};
use crate::{CoordinateKind, PlcError};

/// 9040: coordinates of all axes in 1/1000 mm.
pub(super) fn read_thousandths(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    read(call, 1000.0)
}

/// 9041: coordinates of all axes in 1/10 000 mm.
pub(super) fn read_ten_thousandths(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    read(call, 10_000.0)
}

fn read(call: &mut Call<'_>, scale: f64) -> Result<Outcome, PlcError> {
    let [target, kind] = call.arguments()?;
    let Some(kind) = CoordinateKind::numbered(kind) else {
        return Ok(Outcome::Failed);
    };
    let values = call.nc.coordinates(kind).map(|value| scaled(value, scale));
    Ok(Outcome::of(call.set_doubles(target, &values.0)))
}

/// 9042: angles of the spindle in 1/1000 degree: actual, nominal, actual in the reference system, trailing
/// error, distance to go. Its page is lost; limits as printed in the edition for the TNC 426.
pub(super) fn read_spindle(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    /// Lowest value of MP3010 that means a spindle with position control.
    const CONTROLLED: f64 = 6.0;
    /// Trailing error and distance to go at most, in 1/1000 degree.
    const DISTANCE_MAX: i32 = 2_879_912;
    let [target] = call.arguments()?;
    let mut values = [0; 5];
    if call.parameter(3010, 0) >= CONTROLLED {
        let spindle = call.nc.spindle_position();
        let turn = |angle: f64| scaled(angle.rem_euclid(360.0), 1000.0);
        let distance = |angle: f64| scaled(angle, 1000.0).clamp(-DISTANCE_MAX, DISTANCE_MAX);
        let actual = turn(spindle.actual);
        values = match spindle.closed_loop {
            Some(nominal) => [
                actual,
                turn(nominal.nominal),
                turn(spindle.reference),
                distance(nominal.trailing_error),
                distance(nominal.distance_to_go),
            ],
            // With open loop the nominal value is the actual one and both distances are 0.
            None => [actual, actual, turn(spindle.reference), 0, 0],
        };
    }
    Ok(Outcome::of(call.set_doubles(target, &values)))
}

fn scaled(value: f64, scale: f64) -> i32 {
    (value * scale).round() as i32
}
