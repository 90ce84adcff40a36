//! Numbers that are written finer than a control takes them.
//!
//! The manuals give the input resolutions [003:7825] [000:6419-6424] and not what becomes of a program from elsewhere
//! that is finer: its numbers are rounded, half steps away from zero *(inferred)*. Q parameters are calculated with
//! and keep what they have.
//!
//! Decision: With MP65 = 1 of a TNC 151/155 lengths have steps of 5 µm, or 0.0005 inch, where they are entered and in
//! programs; angles keep the step of the control
//!
//! Decision: Numbers finer than the input step of the control are rounded, half steps away from zero, and said once
//! for each program; F has the step of lengths; Q parameters keep what they have

use bahn_parameters::ControlModel;
use bahn_path::Axis;

use crate::{
    Coordinates, CycleBlock, CycleFunction, CycleWord, Feed, Operation, Quantity, Unit, Value, Word,
    cycle_parameters,
};

/// Input steps in an inch are ten times as fine as in a millimetre: 0.0001 inch for 1 um [003:7825]; others than TNC
/// 360 *(inferred)*.
const INCH_FACTOR: f64 = 10.0;
/// Part of a step that comes from reading decimals.
const SAME: f64 = 1e-3;
/// What is so near to half a step is half a step.
const HALF: f64 = 1e-6;
/// Added and taken away again it leaves the nearest whole number of what is below 2^51.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// Steps of a dwell time in a second [003:6474]; others than TNC 360 *(inferred)*.
const DWELL_STEPS: f64 = 1000.0;

/// The input steps of a control, for programs of one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputSteps {
    /// Steps in a millimetre or inch. F counts in them, too *(inferred)*.
    length: f64,
    /// Steps in a degree.
    angle: f64,
    /// Steps in a degree of cycle 13.
    orientation: f64,
}

impl InputSteps {
    /// Those of a model.
    pub fn of(model: ControlModel, unit: Unit) -> InputSteps {
        let limits = model.limits();
        let steps = |step: f64| (1.0 / step).round();
        InputSteps {
            length: match unit {
                Unit::Mm => steps(limits.resolution_mm),
                Unit::Inch => steps(limits.resolution_mm) * INCH_FACTOR,
            },
            angle: steps(limits.resolution_deg),
            orientation: steps(limits.orientation_step_deg),
        }
    }

    /// The same with a step of lengths of so many mm, where that is coarser: MP65 of a TNC 151/155 [001:1612-1614].
    pub fn not_finer(self, step_mm: Option<f64>, model: ControlModel) -> InputSteps {
        let coarser = step_mm.map_or(1.0, |step| step / model.limits().resolution_mm);
        InputSteps {
            length: self.length / coarser.round().max(1.0),
            ..self
        }
    }

    /// The step of lengths, mm or inches.
    pub fn length(&self) -> f64 {
        1.0 / self.length
    }

    /// The step of angles, degrees.
    pub fn angle(&self) -> f64 {
        1.0 / self.angle
    }

    /// Rounds the numbers of a block to the input steps. Whether one was finer.
    ///
    /// ```
    /// use bahn_parameters::ControlModel;
    /// use bahn_program::{InputSteps, Program, Unit};
    ///
    /// let program = |x| Program::from_bytes("1.H", format!("BEGIN PGM 1 MM\nL X{x}\n").into_bytes());
    /// let mut block = program("+1.0006").decode(0).blocks[1].clone();
    /// assert!(InputSteps::of(ControlModel::Tnc360, Unit::Mm).round(&mut block.operation));
    /// assert_eq!(block, program("+1.001").decode(0).blocks[1]);
    /// ```
    pub fn round(&self, operation: &mut Operation) -> bool {
        let length = |value: &mut Value| round(value, self.length);
        match operation {
            Operation::Motion(motion) => {
                let mut finer = self.coordinates(&mut motion.coordinates);
                if let Some(word) = &mut motion.polar_radius {
                    finer |= length(&mut word.value);
                }
                if let Some(word) = &mut motion.polar_angle {
                    finer |= round(&mut word.value, self.angle);
                }
                if let Some(Feed::Value(feed)) = &mut motion.feed {
                    finer |= length(feed);
                }
                finer | each(&mut motion.radius, length)
            }
            Operation::BlankMin(coordinates, _)
            | Operation::BlankMax(coordinates)
            | Operation::CircleCentre(coordinates) => self.coordinates(coordinates),
            Operation::ToolDefinition {
                length: a, radius: b, ..
            }
            | Operation::ToolCall {
                delta_length: a,
                delta_radius: b,
                ..
            } => each(a, length) | each(b, length),
            Operation::Rounding { radius: a, feed: b } | Operation::Chamfer { length: a, feed: b } => {
                length(a) | each(b, length)
            }
            Operation::Cycle(block) => self.cycle(CycleFunction::Definition, block),
            Operation::Probe(block) => self.cycle(CycleFunction::Probe, block),
            Operation::Modal(block) => {
                let mut finer = false;
                block
                    .operations
                    .iter_mut()
                    .for_each(|part| finer |= self.round(part));
                finer
            }
            _ => false,
        }
    }

    fn coordinates(&self, coordinates: &mut Coordinates) -> bool {
        let parameters = coordinates.parameters();
        let mut finer = false;
        for axis in coordinates
            .axes()
            .iter()
            .filter(|axis| !parameters.contains(*axis))
        {
            let number = coordinates.numbers()[axis];
            if let Some(value) = rounded(number, self.of_axis(axis)) {
                let incremental = coordinates.incremental().contains(axis);
                let value = Value::Number(value);
                coordinates.set(axis, Word { value, incremental });
                finer = true;
            }
        }
        finer
    }

    fn of_axis(&self, axis: Axis) -> f64 {
        if axis.is_rotary() { self.angle } else { self.length }
    }

    fn cycle(&self, function: CycleFunction, block: &mut CycleBlock) -> bool {
        let parameters = cycle_parameters(function, block.number, block.sub);
        // What stands in other blocks nobody can say.
        if parameters.is_empty() {
            return false;
        }
        let mut quantities = parameters
            .iter()
            .map(|parameter| parameter.quantity)
            .filter(|quantity| quantity.is_number());
        let mut finer = false;
        for word in &mut block.words {
            finer |= match word {
                CycleWord::Number(value) => {
                    let steps = quantities.next().and_then(|quantity| self.of_quantity(quantity));
                    steps.is_some_and(|steps| round(value, steps))
                }
                CycleWord::Coordinate(axis, word) => round(&mut word.value, self.of_axis(*axis)),
                CycleWord::Centre(axis, value) => round(value, self.of_axis(*axis)),
                CycleWord::Feed(Feed::Value(value)) => round(value, self.length),
                _ => false,
            };
        }
        finer
    }

    /// `None` for factors and what is no number.
    fn of_quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Length => Some(self.length),
            Quantity::Rotation | Quantity::Angle => Some(self.angle),
            Quantity::Orientation => Some(self.orientation),
            Quantity::Dwell => Some(DWELL_STEPS),
            _ => None,
        }
    }
}

fn each(value: &mut Option<Value>, round: impl FnMut(&mut Value) -> bool) -> bool {
    value.as_mut().is_some_and(round)
}

/// Rounds a number that stands in the program.
fn round(value: &mut Value, steps: f64) -> bool {
    let Value::Number(number) = value else {
        return false;
    };
    match rounded(*number, steps) {
        Some(near) => {
            *number = near;
            true
        }
        None => false,
    }
}

/// The nearest number of whole steps, when a number is none.
#[inline]
fn rounded(number: f64, steps: f64) -> Option<f64> {
    let count = number * steps;
    // Nearly all numbers are whole, and this is asked of each one: no call of a function for them.
    let nearest = (count + WHOLE) - WHOLE;
    if (count - nearest).abs() <= SAME {
        return None;
    }
    finer(count, steps)
}

#[cold]
fn finer(count: f64, steps: f64) -> Option<f64> {
    let whole = (count + HALF.copysign(count)).round();
    ((count - whole).abs() > SAME).then(|| whole / steps)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]
    use super::*;
    use crate::Program;

    #[test]
    fn half_steps_go_away_from_zero() {
        for (number, expected) in [
            (1.00005, Some(1.0001)),
            (-1.00005, Some(-1.0001)),
            (1.000_04, Some(1.0)),
            (1.0001, None),
            (99_999.999_9, None),
            (99_999.999_96, Some(100_000.0)),
            (0.000_01, Some(0.0)),
            (f64::NAN, None),
            (1e300, None),
        ] {
            assert_eq!(rounded(number, 1e4), expected, "{number}");
        }
    }

    /// Each number has the steps of what it is, which differs from cycle to probe function and from unit to unit.
    #[test]
    fn numbers_of_cycles_have_the_steps_of_their_quantity() {
        for (unit, text, expected) in [
            (
                "MM",
                "TCH PROBE 5.4 HEIGHT: +100.0004",
                "TCH PROBE 5.4 HEIGHT: +100",
            ),
            (
                "MM",
                "TCH PROBE 6.2 TRAVEL: 0.5004 L.SPAC: 0.2 P.P. INT: 0.8004",
                "TCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 0.2 P.P. INT: 0.8",
            ),
            (
                "MM",
                "TCH PROBE 7.3 TRAVEL: 0.5 L.SPAC: 0.2004 P.P. INT: 0.8",
                "TCH PROBE 7.3 TRAVEL: 0.5 L.SPAC: 0.2 P.P. INT: 0.8",
            ),
            (
                "MM",
                "TCH PROBE 7.1 TIME: 200 X+50.0004",
                "TCH PROBE 7.1 TIME: 200 X+50",
            ),
            // 0.0001 inch, but 0.001 degree [003:7825].
            (
                "INCH",
                "CYCL DEF 6.3 ANGLE +30.0004 F50",
                "CYCL DEF 6.3 ANGLE +30 F50",
            ),
            (
                "INCH",
                "CYCL DEF 6.2 PECKG -0.50004 F50 ALLOW +0.0004",
                "CYCL DEF 6.2 PECKG -0.5 F50 ALLOW +0.0004",
            ),
            ("MM", "CYCL DEF 9.1 DWELL 0.5004", "CYCL DEF 9.1 DWELL 0.5"),
            // 0.1 degree [003:6528].
            ("MM", "CYCL DEF 13.1 ANGLE 30.04", "CYCL DEF 13.1 ANGLE 30"),
            // Factors.
            ("MM", "CYCL DEF 11.1 SCL 0.999996", "CYCL DEF 11.1 SCL 0.999996"),
            (
                "MM",
                "CYCL DEF 26.1 X0.999996 CCX+0.0004",
                "CYCL DEF 26.1 X0.999996 CCX+0",
            ),
        ] {
            let operation = |block| {
                let text = format!("BEGIN PGM 1 {unit}\n{block}\n");
                let program = Program::from_bytes("1.H", text.into_bytes());
                let block = program.decode(0).blocks[1].clone();
                (block.operation, program.unit())
            };
            let (mut rounded, unit) = operation(text);
            let finer = InputSteps::of(ControlModel::Tnc360, unit).round(&mut rounded);
            assert_eq!(rounded, operation(expected).0, "{text}");
            assert_eq!(finer, text != expected, "{text}");
        }
    }

    /// MP65 = 1: 5 µm, ten times as fine in an inch; a degree keeps its steps. Without it the step is that of the model.
    #[test]
    fn a_coarser_step_is_that_of_lengths() {
        let model = ControlModel::Tnc155;
        for (unit, step, coarse) in [(Unit::Mm, 0.001, 0.005), (Unit::Inch, 0.0001, 0.0005)] {
            let steps = InputSteps::of(model, unit);
            assert_eq!(steps.not_finer(None, model), steps);
            let coarser = steps.not_finer(Some(0.005), model);
            assert!((steps.length() - step).abs() < 1e-12 && (coarser.length() - coarse).abs() < 1e-12);
            assert_eq!(coarser.angle(), steps.angle());
        }
    }

    /// All that can be written with as many places as the control takes stays as it is.
    #[test]
    fn what_is_no_finer_stays() {
        for count in (-999_999_999i64..=999_999_999).step_by(7919) {
            let number: f64 = format!(
                "{}{:05}.{:04}",
                if count < 0 { "-" } else { "+" },
                count.abs() / 10_000,
                count.abs() % 10_000
            )
            .parse()
            .unwrap();
            assert_eq!(rounded(number, 1e4), None, "{number}");
        }
    }
}
