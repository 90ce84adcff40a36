//! Formulas in listings, with the fewest brackets that give the same formula back.

use super::Output;
use crate::parse::FUNCTIONS;
use crate::{BinaryOperator, Expression};

impl Output {
    pub(super) fn expression(&mut self, expression: &Expression) {
        match expression {
            Expression::Value(value) => self.unsigned(*value),
            Expression::Unary(function, operand) => {
                let name = FUNCTIONS
                    .iter()
                    .find(|(_, listed)| listed == function)
                    .map_or("", |(name, _)| name);
                self.text.push_str(name);
                self.text.push(' ');
                self.operand(operand, matches!(**operand, Expression::Binary(..)));
            }
            Expression::Binary(operator, left, right) => {
                // Equal ranks are taken from the left, so only a right operand of equal rank is bracketed.
                self.operand(left, rank(left) < operator_rank(*operator));
                self.word(match operator {
                    BinaryOperator::Add => "+",
                    BinaryOperator::Subtract => "-",
                    BinaryOperator::Multiply => "*",
                    BinaryOperator::Divide => "/",
                    BinaryOperator::Power => "^",
                });
                self.text.push(' ');
                self.operand(right, rank(right) <= operator_rank(*operator));
            }
        }
    }

    fn operand(&mut self, operand: &Expression, bracketed: bool) {
        if bracketed {
            self.text.push('(');
        }
        self.expression(operand);
        if bracketed {
            self.text.push(')');
        }
    }
}

/// How tightly an expression holds together.
fn rank(expression: &Expression) -> u8 {
    match expression {
        Expression::Binary(operator, ..) => operator_rank(*operator),
        Expression::Value(_) | Expression::Unary(..) => 4,
    }
}

fn operator_rank(operator: BinaryOperator) -> u8 {
    match operator {
        BinaryOperator::Add | BinaryOperator::Subtract => 1,
        BinaryOperator::Multiply | BinaryOperator::Divide => 2,
        BinaryOperator::Power => 3,
    }
}
