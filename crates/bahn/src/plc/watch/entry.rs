//! The line that is being typed.

use ratatui::crossterm::event::KeyCode;

use crate::plc::operand::{Content, Operand};

/// What is being typed.
pub(super) struct Entry {
    text: String,
    /// The operand that gets the value; `None` for new operands of the table.
    operand: Option<Operand>,
}

/// What was typed.
pub(super) enum Accepted {
    Value(Operand, Content),
    Operands(Vec<Operand>),
}

impl Entry {
    /// A value for an operand.
    pub fn value(operand: Operand) -> Entry {
        Entry {
            text: String::new(),
            operand: Some(operand),
        }
    }

    /// Operands for the table.
    pub fn operands() -> Entry {
        Entry {
            text: String::new(),
            operand: None,
        }
    }

    pub fn type_key(&mut self, code: KeyCode) {
        match code {
            KeyCode::Backspace => {
                self.text.pop();
            }
            KeyCode::Char(character) => self.text.push(character),
            _ => {}
        }
    }

    /// Reads what was typed.
    pub fn accept(&self) -> Result<Accepted, String> {
        match self.operand {
            Some(operand) => Ok(Accepted::Value(operand, operand.content(&self.text)?)),
            None => {
                let operands: Result<Vec<Operand>, String> = self.text.split(',').map(str::parse).collect();
                operands.map(Accepted::Operands)
            }
        }
    }

    /// As it is shown.
    pub fn prompt(&self) -> String {
        match self.operand {
            Some(operand) => format!("{operand} = {}_", self.text),
            None => format!("operands: {}_", self.text),
        }
    }
}
