//! Where the program stops by itself: before a line, or after a cycle that changed an operand.

use bahn_host::{Content, Operand};

/// The breakpoints that are set.
#[derive(Debug, Default)]
pub struct Breakpoints {
    /// Lines of the main file.
    lines: Vec<u32>,
    /// Operands with the contents they had last.
    operands: Vec<(Operand, Content)>,
}

impl Breakpoints {
    /// A line has one.
    pub fn has_lines(&self) -> bool {
        !self.lines.is_empty()
    }

    /// Whether the main file, the first one, has a breakpoint at this line.
    pub fn is_line(&self, line: u32) -> bool {
        self.lines.contains(&line)
    }

    /// The line, if the program stops before this place.
    pub fn at(&self, (file, line): (u16, u32)) -> Option<u32> {
        (file == 0 && self.is_line(line)).then_some(line)
    }

    /// Sets a breakpoint or clears it; tells whether it is set now.
    pub fn turn_over_line(&mut self, line: u32) -> bool {
        let was = self.lines.len();
        self.lines.retain(|own| *own != line);
        let set = self.lines.len() == was;
        if set {
            self.lines.push(line);
        }
        set
    }

    /// The program stops when the operand changes.
    pub fn watches(&self, operand: Operand) -> bool {
        self.operands.iter().any(|(own, _)| *own == operand)
    }

    /// The program stops when the operand changes, or no more; tells which.
    pub fn turn_over(&mut self, operand: Operand, content: Content) -> bool {
        let was = self.operands.len();
        self.operands.retain(|(own, _)| *own != operand);
        let set = self.operands.len() == was;
        if set {
            self.operands.push((operand, content));
        }
        set
    }

    /// What changed in a cycle, in words.
    pub fn changed(&mut self, read: impl Fn(Operand) -> Content) -> Option<String> {
        let mut changes = Vec::new();
        for (operand, before) in &mut self.operands {
            let now = read(*operand);
            if now != *before {
                changes.push(format!("{operand} changed from {before} to {now}"));
                *before = now;
            }
        }
        (!changes.is_empty()).then(|| changes.join(", "))
    }
}
