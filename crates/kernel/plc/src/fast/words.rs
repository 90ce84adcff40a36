//! Word operands with their cells, and what is calculated with them.

use bahn_exchange::{CELLS, Image, Number, Size};

use crate::PlcError;
use crate::operand::{NumberOperand, Value};
use crate::program::{Arithmetic, BitOperation, Comparison, Gate, Transform, bit};

type Cells = [u8; CELLS];

/// What is read: a constant, or a number by its cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Constant(i32),
    Byte(u16),
    Word(u16),
    Double(u16),
}

impl Source {
    /// `None` for operands with index.
    pub(super) fn of(value: &Value) -> Option<Source> {
        match value {
            Value::Constant(value) => Some(Source::Constant(*value)),
            Value::Number(operand) => {
                let cell = u16::try_from(plain(operand)?.cell()).ok()?;
                Some(match operand.number.size() {
                    Size::Byte => Source::Byte(cell),
                    Size::Word => Source::Word(cell),
                    Size::Double => Source::Double(cell),
                })
            }
        }
    }

    /// The value, sign-extended.
    #[inline(always)]
    pub(super) fn read(self, cells: &Cells) -> i32 {
        match self {
            Source::Constant(value) => value,
            Source::Byte(cell) => i32::from(cells[usize::from(cell) % CELLS] as i8),
            Source::Word(cell) => i32::from(i16::from_be_bytes(bytes(cells, cell))),
            Source::Double(cell) => i32::from_be_bytes(bytes(cells, cell)),
        }
    }

    /// The low bits of a value that a comparison with this operand sees [000:13064].
    #[inline(always)]
    pub(super) fn truncate(self, value: i32) -> i32 {
        match self {
            Source::Byte(_) => Size::Byte.truncate(value),
            Source::Word(_) => Size::Word.truncate(value),
            Source::Double(_) | Source::Constant(_) => value,
        }
    }
}

/// A number operand with index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct IndexedNumber(NumberOperand);

impl IndexedNumber {
    /// `None` for constants and for operands without index.
    pub(super) fn of(value: &Value) -> Option<IndexedNumber> {
        match value {
            Value::Number(operand) if operand.indexed => Some(IndexedNumber(*operand)),
            Value::Number(_) | Value::Constant(_) => None,
        }
    }

    /// The number without index that it means; `None` outside the memory.
    #[inline(always)]
    fn number(self, index: i32) -> Option<Number> {
        let size = self.0.number.size();
        let address = i32::from(self.0.number.address()) + i32::from(index as i16) * i32::from(size.bytes());
        Number::new(size, u16::try_from(address).ok()?)
    }

    /// The value, sign-extended. Reads are not checked: outside is 0 (inferred) [000:14012-14016].
    #[inline(always)]
    pub(super) fn read(self, image: &Image, index: i32) -> i32 {
        self.number(index).map_or(0, |number| image.number(number))
    }

    #[inline(always)]
    pub(super) fn write(self, image: &mut Image, index: i32, value: i32) -> Result<(), PlcError> {
        let number = self.number(index).ok_or(PlcError::IndexOutOfRange)?;
        image.set_number(number, value);
        Ok(())
    }

    /// The low bits of a value that a comparison with this operand sees [000:13064].
    #[inline(always)]
    pub(super) fn truncate(self, value: i32) -> i32 {
        self.0.number.size().truncate(value)
    }
}

/// The operand without index.
fn plain(operand: &NumberOperand) -> Option<Number> {
    (!operand.indexed).then_some(operand.number)
}

#[inline(always)]
fn bytes<const N: usize>(cells: &Cells, cell: u16) -> [u8; N] {
    let rest = cells.get(usize::from(cell)..);
    rest.and_then(|rest| rest.first_chunk())
        .copied()
        .unwrap_or([0; N])
}

/// What is written: a number by its cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Destination {
    Byte(u16),
    Word(u16),
    Double(u16),
}

impl Destination {
    /// `None` for operands with index.
    pub(super) fn of(operand: &NumberOperand) -> Option<Destination> {
        let cell = u16::try_from(plain(operand)?.cell()).ok()?;
        Some(match operand.number.size() {
            Size::Byte => Destination::Byte(cell),
            Size::Word => Destination::Word(cell),
            Size::Double => Destination::Double(cell),
        })
    }

    /// Writes the low bits of a value.
    #[inline(always)]
    pub(super) fn write(self, cells: &mut Cells, value: i32) {
        match self {
            Destination::Byte(cell) => cells[usize::from(cell) % CELLS] = value as u8,
            Destination::Word(cell) => put(cells, cell, (value as i16).to_be_bytes()),
            Destination::Double(cell) => put(cells, cell, value.to_be_bytes()),
        }
    }
}

#[inline(always)]
fn put<const N: usize>(cells: &mut Cells, cell: u16, value: [u8; N]) {
    let rest = cells.get_mut(usize::from(cell)..);
    if let Some(place) = rest.and_then(|rest| rest.first_chunk_mut()) {
        *place = value;
    }
}

/// What becomes of the word accumulator and an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Load,
    LoadNot,
    LoadMinus,
    And,
    AndNot,
    Or,
    OrNot,
    Xor,
    XorNot,
    Plus,
    Minus,
    ShiftLeft,
    ShiftRight,
    Set,
    Clear,
}

impl Function {
    #[inline(always)]
    pub(super) fn apply(self, word: i32, operand: i32) -> i32 {
        match self {
            Function::Load => operand,
            Function::LoadNot => !operand,
            Function::LoadMinus => operand.wrapping_neg(),
            Function::And => word & operand,
            Function::AndNot => word & !operand,
            Function::Or => word | operand,
            Function::OrNot => word | !operand,
            Function::Xor => word ^ operand,
            Function::XorNot => !(word ^ operand),
            Function::Plus => word.wrapping_add(operand),
            Function::Minus => word.wrapping_sub(operand),
            Function::ShiftLeft => BitOperation::ShiftLeft.apply(word, operand),
            Function::ShiftRight => BitOperation::ShiftRight.apply(word, operand),
            Function::Set => word | bit(operand),
            Function::Clear => word & !bit(operand),
        }
    }

    /// The functions without error marker.
    pub(super) fn of_arithmetic(operation: Arithmetic) -> Option<Function> {
        match operation {
            Arithmetic::Plus => Some(Function::Plus),
            Arithmetic::Minus => Some(Function::Minus),
            Arithmetic::Multiply | Arithmetic::Divide | Arithmetic::Modulo => None,
        }
    }
}

impl From<Gate> for Function {
    fn from(gate: Gate) -> Function {
        match gate {
            Gate::And => Function::And,
            Gate::AndNot => Function::AndNot,
            Gate::Or => Function::Or,
            Gate::OrNot => Function::OrNot,
            Gate::Xor => Function::Xor,
            Gate::XorNot => Function::XorNot,
        }
    }
}

impl From<Transform> for Function {
    fn from(transform: Transform) -> Function {
        match transform {
            Transform::Plain => Function::Load,
            Transform::Not => Function::LoadNot,
            Transform::Minus => Function::LoadMinus,
        }
    }
}

impl From<BitOperation> for Function {
    fn from(operation: BitOperation) -> Function {
        match operation {
            BitOperation::ShiftLeft => Function::ShiftLeft,
            BitOperation::ShiftRight => Function::ShiftRight,
            BitOperation::Set => Function::Set,
            BitOperation::Clear => Function::Clear,
        }
    }
}

/// A comparison as the set of orders for which it holds: bit 0 less, bit 1 equal, bit 2 greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Order(u8);

impl Order {
    #[inline(always)]
    pub(super) fn holds(self, left: i32, right: i32) -> bool {
        let order = u32::from(left >= right) + u32::from(left > right);
        u32::from(self.0) >> order & 1 != 0
    }
}

impl From<Comparison> for Order {
    fn from(comparison: Comparison) -> Order {
        use std::cmp::Ordering::{Equal, Greater, Less};
        let holds = |(at, order)| u8::from(comparison.holds(order)) << at;
        Order([(0, Less), (1, Equal), (2, Greater)].into_iter().map(holds).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_holds_as_its_comparison() {
        use Comparison::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
        for comparison in [Equal, Less, Greater, LessEqual, GreaterEqual, NotEqual] {
            for (left, right) in [(-1, 1), (1, 1), (1, -1), (i32::MIN, i32::MAX)] {
                let expected = comparison.holds(left.cmp(&right));
                assert_eq!(
                    Order::from(comparison).holds(left, right),
                    expected,
                    "{comparison:?}"
                );
            }
        }
    }
}
