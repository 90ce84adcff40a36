//! Bracketed formulas: `^` before `*` and `/`, before `+` and `-`; a function takes the operand that
//! follows it. Operators of one rank are taken from left to right (inferred for `^`).

use std::f64::consts::PI;

use bahn_parameters::MessageId::{BlockNotKnown, EntryValueIncorrect};

use super::cursor::{Cursor, Parsed};
use crate::{BinaryOperator, Expression, UnaryFunction, Value};

/// Most operands, functions and operators of a formula, which bounds the depth of the tree.
const MAX_NODES: usize = 256;

/// Names of the functions. A name stands before any other that it begins with.
pub(crate) const FUNCTIONS: &[(&str, UnaryFunction)] = &[
    ("SQRT", UnaryFunction::SquareRoot),
    ("SQ", UnaryFunction::Square),
    ("SIN", UnaryFunction::Sine),
    ("COS", UnaryFunction::Cosine),
    ("TAN", UnaryFunction::Tangent),
    ("ASIN", UnaryFunction::ArcSine),
    ("ACOS", UnaryFunction::ArcCosine),
    ("ATAN", UnaryFunction::ArcTangent),
    ("LN", UnaryFunction::NaturalLogarithm),
    ("LOG", UnaryFunction::Logarithm),
    ("EXP", UnaryFunction::Exponential),
    ("NEG", UnaryFunction::Negate),
    ("ABS", UnaryFunction::Absolute),
    ("INT", UnaryFunction::Integer),
    ("FRAC", UnaryFunction::Fraction),
];

/// Reads what stands right of `=` in a formula.
pub(super) fn expression(c: &mut Cursor) -> Parsed<Expression> {
    let mut nodes = 0;
    sum(c, &mut nodes)
}

fn sum(c: &mut Cursor, nodes: &mut usize) -> Parsed<Expression> {
    let mut left = product(c, nodes)?;
    loop {
        let operator = if c.accept(b'+') {
            BinaryOperator::Add
        } else if c.accept(b'-') {
            BinaryOperator::Subtract
        } else {
            return Ok(left);
        };
        count(c, nodes)?;
        left = Expression::Binary(operator, Box::new(left), Box::new(product(c, nodes)?));
    }
}

fn product(c: &mut Cursor, nodes: &mut usize) -> Parsed<Expression> {
    let mut left = power(c, nodes)?;
    loop {
        let operator = if c.accept(b'*') {
            BinaryOperator::Multiply
        } else if c.accept(b'/') || c.keyword("DIV") {
            BinaryOperator::Divide
        } else {
            return Ok(left);
        };
        count(c, nodes)?;
        left = Expression::Binary(operator, Box::new(left), Box::new(power(c, nodes)?));
    }
}

fn power(c: &mut Cursor, nodes: &mut usize) -> Parsed<Expression> {
    let mut left = operand(c, nodes)?;
    while c.accept(b'^') {
        count(c, nodes)?;
        left = Expression::Binary(
            BinaryOperator::Power,
            Box::new(left),
            Box::new(operand(c, nodes)?),
        );
    }
    Ok(left)
}

/// A number, a Q parameter, PI, a bracket, or a function with its operand; each with an optional sign.
fn operand(c: &mut Cursor, nodes: &mut usize) -> Parsed<Expression> {
    count(c, nodes)?;
    c.skip_blanks();
    let start = c.position();
    let negative = c.peek() == b'-';
    if negative || c.peek() == b'+' {
        c.advance(1);
        c.skip_blanks();
    }
    let unsigned = c.peek_upper();
    if unsigned == b'(' {
        c.advance(1);
        let inner = sum(c, nodes)?;
        if !c.accept(b')') {
            return c.fault_from(start, EntryValueIncorrect, "the bracket is not closed");
        }
        return Ok(negated(negative, inner));
    }
    if unsigned.is_ascii_alphabetic() && unsigned != b'Q' {
        if c.keyword("PI") {
            return Ok(Expression::Value(Value::Number(if negative { -PI } else { PI })));
        }
        let Some((_, function)) = FUNCTIONS.iter().find(|(name, _)| c.keyword(name)) else {
            return c.fault_at_word(BlockNotKnown, "no control here knows this function");
        };
        let inner = operand(c, nodes)?;
        return Ok(negated(negative, Expression::Unary(*function, Box::new(inner))));
    }
    c.go_to(start);
    Ok(Expression::Value(c.required_value(start)?))
}

fn negated(negative: bool, inner: Expression) -> Expression {
    if negative {
        Expression::Unary(UnaryFunction::Negate, Box::new(inner))
    } else {
        inner
    }
}

fn count(c: &mut Cursor, nodes: &mut usize) -> Parsed<()> {
    *nodes += 1;
    if *nodes > MAX_NODES {
        return c.fault_at_word(EntryValueIncorrect, "the formula is too long");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::test::{fault, operation, q};
    use super::*;
    use crate::Operation;
    use BinaryOperator::{Add, Divide, Multiply, Power, Subtract};
    use UnaryFunction::{Negate, Sine, Square, SquareRoot};

    fn formula(text: &str) -> Expression {
        match operation(text) {
            Operation::Formula {
                target: 1,
                expression,
            } => *expression,
            other => panic!("{text}: {other:?}"),
        }
    }

    fn n(number: f64) -> Expression {
        Expression::Value(Value::Number(number))
    }

    fn p(number: i32) -> Expression {
        Expression::Value(q(number))
    }

    fn binary(a: Expression, operator: BinaryOperator, b: Expression) -> Expression {
        Expression::Binary(operator, Box::new(a), Box::new(b))
    }

    fn unary(function: UnaryFunction, a: Expression) -> Expression {
        Expression::Unary(function, Box::new(a))
    }

    #[test]
    fn functions_take_the_next_operand() {
        let sum = binary(unary(Sine, n(30.0)), Add, unary(SquareRoot, p(2)));
        assert_eq!(formula("Q1 = SIN 30 + SQRT Q2"), sum);
        assert_eq!(formula("q1=sin30+sqrtq2"), sum);
        assert_eq!(formula("Q1 = SQ SIN -30"), unary(Square, unary(Sine, n(-30.0))));
        assert_eq!(
            formula("Q1 = SIN 30 ^ 2"),
            binary(unary(Sine, n(30.0)), Power, n(2.0))
        );
        assert_eq!(
            formula("Q1 = SIN (30 + 2)"),
            unary(Sine, binary(n(30.0), Add, n(2.0)))
        );
    }

    #[test]
    fn ranks_of_operators() {
        assert_eq!(
            formula("Q1 = 1 + 2 * 3 ^ 4"),
            binary(
                n(1.0),
                Add,
                binary(n(2.0), Multiply, binary(n(3.0), Power, n(4.0)))
            )
        );
        assert_eq!(
            formula("Q1 = 8 - 4 - 2"),
            binary(binary(n(8.0), Subtract, n(4.0)), Subtract, n(2.0))
        );
        assert_eq!(
            formula("Q1 = 8 / 4 DIV 2"),
            binary(binary(n(8.0), Divide, n(4.0)), Divide, n(2.0))
        );
        assert_eq!(
            formula("Q1 = (1 + 2) * 3"),
            binary(binary(n(1.0), Add, n(2.0)), Multiply, n(3.0))
        );
    }

    #[test]
    fn signs_and_constants() {
        assert_eq!(formula("Q1 = -Q5 + +3"), binary(p(-5), Add, n(3.0)));
        assert_eq!(
            formula("Q1 = -(Q5 + 1)"),
            unary(Negate, binary(p(5), Add, n(1.0)))
        );
        assert_eq!(formula("Q1 = - SIN 5"), unary(Negate, unary(Sine, n(5.0))));
        assert_eq!(formula("Q1 = NEG Q5"), unary(Negate, p(5)));
        assert_eq!(formula("Q1 = 2 * PI"), binary(n(2.0), Multiply, n(PI)));
        assert_eq!(formula("Q1 = +Q5"), p(5));
    }

    #[test]
    fn faulty_formulas() {
        assert_eq!(fault("Q1 = (1 + 2"), (EntryValueIncorrect, 6, 6));
        assert_eq!(fault("Q1 = 1 +"), (EntryValueIncorrect, 9, 1));
        assert_eq!(fault("Q1 ="), (EntryValueIncorrect, 5, 1));
        assert_eq!(fault("Q1 = SGN Q2"), (BlockNotKnown, 6, 3));
        assert_eq!(fault("Q1 5").0, EntryValueIncorrect);
        assert_eq!(fault("Q1 = 5 X+3").0, bahn_parameters::MessageId::UnexpectedText);
        assert_eq!(
            fault(&format!("Q1 = {}1", "(".repeat(100_000))).0,
            EntryValueIncorrect
        );
        assert_eq!(
            fault(&format!("Q1 = 1{}", "+1".repeat(100_000))).0,
            EntryValueIncorrect
        );
    }
}
