//! The unit of lengths, P11308: all parameters with the inch bit are converted when it changes [002:282-290]
//! [002:6324-6362].
//!
//! Decision: In inches a parameter has as many decimals more as P11308 says, and as many less when it becomes metric again;
//! the value is rounded to them. What does not go into four bytes so gives up decimals, and what does not go in without any
//! keeps the unit from changing. A parameter in hexadecimal notation is no length and stays
//!
//! Decision: What went there and back comes out the same the next time: with two or three decimals more a metric value is
//! not changed by it at all, with one decimal more by one unit of its last place at most, and an inch value not at all
//!
//! Decision: G170 is inches with one decimal more, unless P11308 has them already; G171 is metric

use crate::array::Cell;
use crate::memory::{Memory, SpaceError};
use crate::numbers::UNIT;
use crate::value::{DECIMALS_MAX, ValueError, shown};

/// Millimetres in five inches, which is a whole number.
const FIVE_INCHES: i128 = 127;

/// What lengths are counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Millimetres.
    Metric,
    /// Inches, with so many decimals more: 1 to 3.
    Inch(u8),
}

impl Unit {
    /// Of a value of P11308; `None` for one that says no unit.
    pub fn from_value(value: Option<i64>) -> Option<Unit> {
        match value {
            None | Some(0) => Some(Unit::Metric),
            Some(decimals @ 1..=3) => u8::try_from(decimals).ok().map(Unit::Inch),
            Some(_) => None,
        }
    }

    /// That of a memory; metric where P11308 says none.
    pub fn of(memory: &Memory) -> Unit {
        Unit::from_value(memory.shared(UNIT).whole()).unwrap_or(Unit::Metric)
    }

    /// That of G170 or G171, with what is in force; `None` for other words.
    pub fn of_g(g: u16, now: Unit) -> Option<Unit> {
        match (g, now) {
            (170, Unit::Metric) => Some(Unit::Inch(1)),
            (170, inch) => Some(inch),
            (171, _) => Some(Unit::Metric),
            _ => None,
        }
    }

    /// The value of P11308, which is also how many decimals there are more.
    pub fn value(self) -> u8 {
        match self {
            Unit::Metric => 0,
            Unit::Inch(decimals) => decimals,
        }
    }

    /// The width of a manual step, of one in the table: a tenth of it in inches [002:6357-6360].
    pub fn step(self, width: f64) -> f64 {
        match self {
            Unit::Metric => width,
            Unit::Inch(_) => width / 10.0,
        }
    }
}

/// A length in another unit; `None` when it does not go into four bytes.
fn converted(cell: Cell, from: Unit, to: Unit) -> Option<Cell> {
    let status = cell.status;
    if !status.is_length() || status.is_hexadecimal() {
        return Some(cell);
    }
    let decimals = i32::from(status.decimals());
    let wanted = decimals + i32::from(to.value()) - i32::from(from.value());
    let wanted = u8::try_from(wanted.clamp(0, DECIMALS_MAX.into())).unwrap_or(0);
    let (times, by) = match (from, to) {
        (Unit::Metric, Unit::Inch(_)) => (5, FIVE_INCHES),
        (Unit::Inch(_), Unit::Metric) => (FIVE_INCHES, 5),
        _ => (1, 1),
    };
    let power = |digits: i32| 10i128.pow(u32::try_from(digits).unwrap_or(0));
    (0..=wanted).rev().find_map(|places| {
        let more = i32::from(places) - decimals;
        let scaled = i128::from(cell.mantissa) * times * power(more);
        let mantissa = rounded(scaled, by * power(-more)).try_into().ok()?;
        let status = status.with_decimals(places);
        Some(Cell { mantissa, status })
    })
}

/// A quotient to the nearest whole number, half of one away from zero.
fn rounded(number: i128, by: i128) -> i128 {
    (2 * number.abs() + by) / (2 * by) * number.signum()
}

impl Memory {
    /// Changes the unit: all parameters with the inch bit are converted, and P11308 says it. Nothing is allocated.
    ///
    /// # Errors
    /// When a length does not go into four bytes in the other unit; then nothing has changed.
    pub fn change_unit(&mut self, to: Unit) -> Result<(), SpaceError> {
        let from = Unit::of(self);
        if from != to {
            let refused = |cell: Cell| converted(cell, from, to).is_none();
            if let Some(place) = self.places().find(|place| refused(self.at(*place))) {
                let cell = self.at(place);
                let written = shown(cell.mantissa.into(), cell.status.decimals());
                return Err(SpaceError::Value(
                    self.name_of(place),
                    ValueError::TooGreat(written),
                ));
            }
            for cell in self.cells_mut() {
                *cell = converted(*cell, from, to).unwrap_or(*cell);
            }
        }
        self.set_shared(UNIT, to.value().into());
        Ok(())
    }
}
