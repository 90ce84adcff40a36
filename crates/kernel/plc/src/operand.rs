//! Operands of instructions.

use std::fmt;

use bahn_exchange::{Bit, Number};

/// A bit operand, as `M500` or `M500[X]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BitOperand {
    /// The operand of the line.
    pub bit: Bit,
    /// Whether the index register is added to its number.
    pub indexed: bool,
}

/// A byte, word or doubleword, as `W8` or `W8[X]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NumberOperand {
    /// The operand of the line.
    pub number: Number,
    /// Whether the index register counts on from it: `n + X`, `n + 2X`, `n + 4X` [000:14022-14034].
    pub indexed: bool,
}

/// What word instructions read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Value {
    /// The content of a byte, word or doubleword.
    Number(NumberOperand),
    /// The number itself: `K+54`.
    Constant(i32),
}

/// What string instructions read [000:14070-14084].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum TextOperand {
    /// `S0` to `S3`, or `S0[X]`.
    Memory {
        /// The number of the line.
        string: u8,
        /// Whether the index register is added to it.
        indexed: bool,
    },
    /// `S0^X`: from the X-th character.
    Part {
        /// The number of the string.
        string: u8,
    },
    /// `S"COOLANT 1 ON"`, in the control's characters.
    Literal(Vec<u8>),
    /// `S#E10`: a line of the PLC message file.
    Message {
        /// The line, 0 to 999.
        line: u16,
        /// Whether the index register is added to it.
        indexed: bool,
    },
    /// `S#D10`: a line of the PLC dialogue file.
    Dialogue {
        /// The line, 0 to 4095.
        line: u16,
        /// Whether the index register is added to it.
        indexed: bool,
    },
}

impl fmt::Display for BitOperand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.bit, index(self.indexed))
    }
}

impl fmt::Display for NumberOperand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.number, index(self.indexed))
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(number) => number.fmt(f),
            Value::Constant(value) => write!(f, "K{value:+}"),
        }
    }
}

impl fmt::Display for TextOperand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TextOperand::Memory { string, indexed } => write!(f, "S{string}{}", index(*indexed)),
            TextOperand::Part { string } => write!(f, "S{string}^X"),
            TextOperand::Literal(text) => {
                let text: String = text.iter().map(|byte| char::from(*byte)).collect();
                write!(f, "S\"{text}\"")
            }
            TextOperand::Message { line, indexed } => write!(f, "S#E{line}{}", index(*indexed)),
            TextOperand::Dialogue { line, indexed } => write!(f, "S#D{line}{}", index(*indexed)),
        }
    }
}

fn index(indexed: bool) -> &'static str {
    if indexed { "[X]" } else { "" }
}
