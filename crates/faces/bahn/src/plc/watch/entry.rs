//! The line that is being typed.

use ratatui::crossterm::event::KeyCode;

use bahn_host::{Content, Operand};

/// What is being typed.
pub(super) struct Entry {
    text: String,
    wanted: Wanted,
}

/// What the text is read as.
#[derive(Clone, Copy)]
enum Wanted {
    /// A value for an operand.
    Value(Operand),
    /// New operands of the table.
    Operands,
    /// A line of the main file.
    Line,
}

/// What the typed text means.
pub(super) enum Accepted {
    Value(Operand, Content),
    Operands(Vec<Operand>),
    Line(u32),
}

impl Entry {
    /// A value for an operand.
    pub fn value(operand: Operand) -> Entry {
        Entry {
            text: String::new(),
            wanted: Wanted::Value(operand),
        }
    }

    /// Operands for the table.
    pub fn operands() -> Entry {
        Entry {
            text: String::new(),
            wanted: Wanted::Operands,
        }
    }

    /// A line of the main file, for a breakpoint.
    pub fn breakpoint() -> Entry {
        Entry {
            text: String::new(),
            wanted: Wanted::Line,
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
        match self.wanted {
            Wanted::Value(operand) => Ok(Accepted::Value(operand, operand.content(&self.text)?)),
            Wanted::Line => {
                let line = self.text.trim().parse().ok().filter(|line| *line > 0);
                line.map(Accepted::Line)
                    .ok_or_else(|| format!("`{}` is no line", self.text))
            }
            Wanted::Operands => {
                let operands: Result<Vec<Operand>, String> = self.text.split(',').map(str::parse).collect();
                operands.map(Accepted::Operands)
            }
        }
    }

    /// As it is shown.
    pub fn prompt(&self) -> String {
        match self.wanted {
            Wanted::Value(operand) => format!("{operand} = {}_", self.text),
            Wanted::Line => format!("breakpoint at line: {}_", self.text),
            Wanted::Operands => format!("operands: {}_", self.text),
        }
    }
}
