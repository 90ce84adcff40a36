//! Q parameters: the table, calculations and formulas.
//!
//! Decision: Values within 1e-9 count as equal in FN9-FN12

use bahn_parameters::MessageId;
use bahn_program::{BinaryOperator, Calculation, Condition, Expression, UnaryFunction, Value};

use crate::error::Fault;

/// Numbers of the parameters that the control itself writes [003:7587-7662].
pub(crate) mod preassigned {
    /// Radius of the current tool.
    pub const TOOL_RADIUS: u16 = 108;
    /// Tool axis: -1 none, 0 X, 1 Y, 2 Z (and 6, 7, 8 for U, V, W, inferred).
    pub const TOOL_AXIS: u16 = 109;
    /// Spindle: -1 undefined, 0 M3, 1 M4, 2 M5 after M3, 3 M5 after M4.
    pub const SPINDLE: u16 = 110;
    /// Coolant: 1 on, 0 off.
    pub const COOLANT: u16 = 111;
    /// Overlap factor of pockets, MP7430.
    pub const OVERLAP: u16 = 112;
    /// Unit of the main program: 0 mm, 1 inch.
    pub const UNIT: u16 = 113;
    /// Length of the current tool.
    pub const TOOL_LENGTH: u16 = 114;
    /// First of the four coordinates of a touch: X, Y, Z, IV.
    pub const TOUCH: u16 = 115;
    /// Radius compensation: 0 R0, 1 RL, 2 RR, 3 R+, 4 R-.
    pub const COMPENSATION: u16 = 123;
}

/// Difference below which two values count as equal in FN9-FN12. The control calculates with decimal
/// numbers of limited length, so 0.1 added ten times equals 1 there (inferred).
const COMPARE_TOLERANCE: f64 = 1e-9;

/// Greatest value of a Q parameter, either sign: that of a number in a program *(inferred)*. What is
/// calculated with such values stays finite.
pub const Q_VALUE_MAX: f64 = 1e15;

/// The table of Q parameters.
#[derive(Clone, Debug)]
pub(crate) struct QTable {
    values: Vec<f64>,
}

impl QTable {
    pub fn new(count: usize) -> QTable {
        QTable {
            values: vec![0.0; count],
        }
    }

    #[inline]
    pub fn get(&self, number: u16) -> Result<f64, Fault> {
        self.values
            .get(usize::from(number))
            .copied()
            .ok_or_else(|| out_of_range(number))
    }

    #[inline]
    pub fn set(&mut self, number: u16, value: f64) -> Result<(), Fault> {
        if !in_range(value) {
            return Err(Fault::new(
                MessageId::ArithmeticalError,
                "the result is too large",
            ));
        }
        *self
            .values
            .get_mut(usize::from(number))
            .ok_or_else(|| out_of_range(number))? = value;
        Ok(())
    }

    /// Writes a preassigned parameter; models without it have no place for it.
    pub fn preassign(&mut self, number: u16, value: f64) {
        if let Some(slot) = self.values.get_mut(usize::from(number))
            && in_range(value)
        {
            *slot = value;
        }
    }

    pub fn values(&self) -> &[f64] {
        &self.values
    }

    #[inline]
    pub fn value(&self, value: Value) -> Result<f64, Fault> {
        match value {
            Value::Number(number) => Ok(number),
            Value::Q { number, negative } => {
                let value = self.get(number)?;
                Ok(if negative { -value } else { value })
            }
        }
    }

    #[inline]
    pub fn calculate(&self, function: Calculation, a: Value, b: Value) -> Result<f64, Fault> {
        let a = self.value(a)?;
        let result = match function {
            Calculation::Assign => a,
            Calculation::Add => a + self.value(b)?,
            Calculation::Subtract => a - self.value(b)?,
            Calculation::Multiply => a * self.value(b)?,
            Calculation::Divide => divide(a, self.value(b)?)?,
            Calculation::SquareRoot => square_root(a)?,
            Calculation::Sine => sin_deg(a),
            Calculation::Cosine => cos_deg(a),
            Calculation::Length => a.hypot(self.value(b)?),
            Calculation::Angle => bahn_path::angle_deg([self.value(b)?, a]),
        };
        finite(result)
    }

    #[inline]
    pub fn holds(&self, condition: Condition, a: Value, b: Value) -> Result<bool, Fault> {
        let (a, b) = (self.value(a)?, self.value(b)?);
        let equal = (a - b).abs() <= COMPARE_TOLERANCE * a.abs().max(b.abs()).max(1.0);
        Ok(match condition {
            Condition::Equal => equal,
            Condition::NotEqual => !equal,
            Condition::Greater => a > b && !equal,
            Condition::Less => a < b && !equal,
        })
    }

    pub fn evaluate(&self, expression: &Expression) -> Result<f64, Fault> {
        finite(match expression {
            Expression::Value(value) => self.value(*value)?,
            Expression::Unary(function, operand) => unary(*function, self.evaluate(operand)?)?,
            Expression::Binary(operator, a, b) => {
                let (a, b) = (self.evaluate(a)?, self.evaluate(b)?);
                match operator {
                    BinaryOperator::Add => a + b,
                    BinaryOperator::Subtract => a - b,
                    BinaryOperator::Multiply => a * b,
                    BinaryOperator::Divide => divide(a, b)?,
                    BinaryOperator::Power => a.powf(b),
                }
            }
        })
    }
}

#[inline]
fn in_range(value: f64) -> bool {
    // Written so that what is no number is refused too.
    value.abs() <= Q_VALUE_MAX
}

fn unary(function: UnaryFunction, a: f64) -> Result<f64, Fault> {
    Ok(match function {
        UnaryFunction::Negate => -a,
        UnaryFunction::Square => a * a,
        UnaryFunction::SquareRoot => square_root(a)?,
        UnaryFunction::Sine => sin_deg(a),
        UnaryFunction::Cosine => cos_deg(a),
        UnaryFunction::Tangent => divide(sin_deg(a), cos_deg(a))?,
        UnaryFunction::ArcSine => a.asin().to_degrees(),
        UnaryFunction::ArcCosine => a.acos().to_degrees(),
        UnaryFunction::ArcTangent => a.atan().to_degrees(),
        UnaryFunction::NaturalLogarithm => a.ln(),
        UnaryFunction::Logarithm => a.log10(),
        UnaryFunction::Exponential => a.exp(),
        UnaryFunction::Absolute => a.abs(),
        UnaryFunction::Integer => a.trunc(),
        UnaryFunction::Fraction => a.fract(),
    })
}

fn divide(a: f64, b: f64) -> Result<f64, Fault> {
    if b == 0.0 {
        return Err(Fault::new(MessageId::ArithmeticalError, "division by zero"));
    }
    Ok(a / b)
}

fn square_root(a: f64) -> Result<f64, Fault> {
    if a < 0.0 {
        return Err(Fault::new(
            MessageId::ArithmeticalError,
            "root of a negative number",
        ));
    }
    Ok(a.sqrt())
}

fn finite(value: f64) -> Result<f64, Fault> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Fault::new(
            MessageId::ArithmeticalError,
            "the result is not a number of the control's range",
        ))
    }
}

fn out_of_range(number: u16) -> Fault {
    Fault::new(
        MessageId::EntryValueIncorrect,
        format!("this control has no parameter Q{number}"),
    )
}

/// Sine of degrees, exact at multiples of 90 degrees.
pub(crate) fn sin_deg(angle_deg: f64) -> f64 {
    match angle_deg.rem_euclid(360.0) {
        0.0 | 180.0 => 0.0,
        90.0 => 1.0,
        270.0 => -1.0,
        _ => angle_deg.to_radians().sin(),
    }
}

/// Cosine of degrees, exact at multiples of 90 degrees.
pub(crate) fn cos_deg(angle_deg: f64) -> f64 {
    match angle_deg.rem_euclid(360.0) {
        0.0 => 1.0,
        90.0 | 270.0 => 0.0,
        180.0 => -1.0,
        _ => angle_deg.to_radians().cos(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn q(number: u16) -> Value {
        Value::Q {
            number,
            negative: false,
        }
    }

    /// The printed examples of FN0 to FN8 and FN13 [003:4149-4276].
    #[test]
    fn functions_calculate_as_printed() {
        let mut table = QTable::new(124);
        table.set(2, 30.0).unwrap();
        table.set(5, 45.0).unwrap();
        let number = Value::Number;
        let minus_q2 = Value::Q {
            number: 2,
            negative: true,
        };
        let cases = [
            (Calculation::Assign, number(60.0), number(0.0), 60.0),
            (Calculation::Add, minus_q2, number(-5.0), -35.0),
            (Calculation::Subtract, number(10.0), number(5.0), 5.0),
            (Calculation::Multiply, number(3.0), number(3.0), 9.0),
            (Calculation::Divide, number(8.0), q(2), 8.0 / 30.0),
            (Calculation::SquareRoot, number(4.0), number(0.0), 2.0),
            (Calculation::Sine, minus_q2, number(0.0), -0.5),
            (Calculation::Cosine, q(5), number(0.0), 0.5f64.sqrt()),
            (Calculation::Length, number(5.0), number(4.0), 41f64.sqrt()),
            // The angle whose tangent is 10 / -30, in the quadrant of both signs: 180 - atan(1/3).
            (
                Calculation::Angle,
                number(10.0),
                minus_q2,
                180.0 - (1.0f64 / 3.0).atan().to_degrees(),
            ),
        ];
        for (function, a, b, expected) in cases {
            let result = table.calculate(function, a, b).unwrap();
            assert!(
                (result - expected).abs() < 1e-12,
                "{function:?}: {result} instead of {expected}"
            );
        }
    }

    #[test]
    fn impossible_calculations_are_arithmetical_errors() {
        let table = QTable::new(10);
        let zero = Value::Number(0.0);
        for (function, a) in [(Calculation::Divide, 1.0), (Calculation::SquareRoot, -1.0)] {
            let fault = table.calculate(function, Value::Number(a), zero).unwrap_err();
            assert_eq!(
                fault.message,
                crate::error::Message::Control(MessageId::ArithmeticalError)
            );
        }
        assert!(table.get(10).is_err());
    }

    #[test]
    fn values_beyond_the_range_are_refused() {
        let mut table = QTable::new(10);
        assert_eq!(table.set(1, -Q_VALUE_MAX), Ok(()));
        for value in [1.1e15, f64::INFINITY, f64::NAN] {
            assert!(table.set(1, value).is_err());
            table.preassign(1, value);
            assert_eq!(table.get(1), Ok(-Q_VALUE_MAX));
        }
    }

    #[test]
    fn a_tenth_added_ten_times_is_one() {
        let mut table = QTable::new(10);
        for _ in 0..10 {
            let sum = table
                .calculate(Calculation::Add, q(1), Value::Number(0.1))
                .unwrap();
            table.set(1, sum).unwrap();
        }
        assert_ne!(table.get(1).unwrap(), 1.0);
        assert!(table.holds(Condition::Equal, q(1), Value::Number(1.0)).unwrap());
        assert!(!table.holds(Condition::Less, q(1), Value::Number(1.0)).unwrap());
    }
}
