//! What a command costs: time and bytes.

use crate::operand::TextOperand;
use crate::syntax::{Class, Command, Cost, Mnemonic, Operand};

/// What a command costs with its operand.
pub(super) fn cost_of(command: &Command) -> Cost {
    let class = class_of(command);
    let free = Cost {
        time: 0,
        skipped: 0,
        bytes: 0,
    };
    let mut cost = command.mnemonic.cost(class).unwrap_or(free);
    if let Operand::Text(TextOperand::Literal(text)) = &command.operand {
        // The text is added to the length, rounded up to an even number [000:14089].
        let length = u16::try_from(text.len().next_multiple_of(2)).unwrap_or(u16::MAX);
        cost.bytes = cost.bytes.saturating_add(length);
    }
    cost
}

/// What an appended EM costs.
pub(super) fn end_cost() -> Cost {
    let free = Cost {
        time: 0,
        skipped: 0,
        bytes: 0,
    };
    Mnemonic::End.cost(Class::None).unwrap_or(free)
}

fn class_of(command: &Command) -> Class {
    use bahn_exchange::Size;
    match &command.operand {
        Operand::None => Class::None,
        Operand::Bit(_) => Class::Bit,
        Operand::Number(operand) => match operand.number.size() {
            Size::Byte => Class::Byte,
            Size::Word => Class::Word,
            Size::Double => Class::Double,
        },
        Operand::Constant(_) => Class::Constant,
        Operand::Text(text) => match text {
            TextOperand::Memory { .. } | TextOperand::Part { .. } => Class::TextMemory,
            TextOperand::Literal(_) => Class::TextLiteral,
            TextOperand::Message { .. } | TextOperand::Dialogue { .. } => Class::TextReference,
        },
        Operand::Field(_) => Class::Field,
        Operand::Label(name) if super::labels::is_internal(name) && command.mnemonic.takes(Class::Module) => {
            Class::Module
        }
        Operand::Label(_) => Class::Label,
        Operand::File(_) => Class::File,
    }
}
