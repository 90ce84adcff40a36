//! What a trace sees of an executed instruction [000:11414-11435].

use bahn_exchange::Image;

use super::memory::{read, read_bit, read_bits};
use super::registers::Registers;
use crate::access::{Named, operand};
use crate::operand::TextOperand;
use crate::program::{Instruction, PlcProgram};

/// Sees every executed instruction.
pub trait Tracer {
    /// A scan has begun: what the NC wrote and the inputs are in the memory.
    fn began(&mut self, _image: &Image) {}

    /// An instruction was executed.
    fn executed(&mut self, step: &TraceStep<'_>);
}

/// An executed instruction with what it left behind.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct TraceStep<'a> {
    /// The program that it belongs to.
    pub program: &'a PlcProgram,
    /// Index of the instruction.
    pub at: usize,
    /// The instruction itself, with its line.
    pub instruction: &'a Instruction,
    /// Accumulators and stacks after it.
    pub registers: &'a Registers,
    /// The memory after it.
    pub image: &'a Image,
    /// The identifier of the submit job that executed it; `None` for the cyclic program.
    pub job: Option<u8>,
}

/// The content of an operand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OperandContent {
    /// M, I, O, T, C.
    Bit(bool),
    /// B, W, D, K and consecutive bits.
    Number(i32),
    /// S, in the control's characters.
    Text(Vec<u8>),
}

/// What an instruction left behind when it was executed last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Executed {
    /// What its operand holds; `None` without an operand.
    pub operand: Option<OperandContent>,
    /// Logic accumulator after it.
    pub logic: bool,
    /// Word accumulator after it.
    pub word: i32,
}

/// The latest scan instruction by instruction: TRACE IN CODE [000:11414-11435].
#[derive(Clone, Debug, Default)]
pub struct CodeTrace {
    executed: Vec<Option<Executed>>,
}

impl CodeTrace {
    /// What an instruction did in that scan, by its index; `None` when it was passed by.
    pub fn executed(&self, at: usize) -> Option<&Executed> {
        self.executed.get(at)?.as_ref()
    }
}

impl Tracer for CodeTrace {
    fn began(&mut self, _image: &Image) {
        self.executed.fill(None);
    }

    fn executed(&mut self, step: &TraceStep<'_>) {
        let length = step.program.code.len();
        if self.executed.len() != length {
            self.executed.clear();
            self.executed.resize(length, None);
        }
        if let Some(place) = self.executed.get_mut(step.at) {
            *place = Some(Executed {
                operand: step.operand(),
                logic: step.registers.logic,
                word: step.registers.word,
            });
        }
    }
}

impl TraceStep<'_> {
    /// The content of the operand after the instruction; `None` for instructions without one.
    pub fn operand(&self) -> Option<OperandContent> {
        let (named, _) = operand(&self.instruction.op)?;
        let index = self.registers.index;
        Some(match named {
            Named::Bit(bit) => OperandContent::Bit(read_bit(self.image, bit, index)),
            Named::Bits(first, count) => OperandContent::Number(read_bits(self.image, first, count, index)),
            Named::Value(value) => OperandContent::Number(read(self.image, value, index)),
            Named::Text(text) => self.text_content(text, index),
            Named::String { string, indexed } => {
                self.text_content(&TextOperand::Memory { string, indexed }, index)
            }
        })
    }

    fn text_content(&self, operand: &TextOperand, index: i32) -> OperandContent {
        let mut reference = super::text::Reference::default();
        let text = super::text::read(self.image, operand, index, &mut reference);
        OperandContent::Text(text.unwrap_or_default().to_vec())
    }

    /// The line of source text.
    pub fn text(&self) -> &str {
        self.program.line_text(self.instruction)
    }

    /// The name of the file.
    pub fn file(&self) -> &str {
        self.program.file_name(self.instruction.file)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bahn_exchange::Exchange;
    use bahn_parameters::{ControlModel, ParameterList};

    use super::*;
    use crate::{Compilation, Machine, MemoryFiles, Options, Start, TestNc};

    /// The instruction after a jump that is taken is passed by, until the jump is not taken.
    #[test]
    fn a_scan_stands_by_its_instructions() {
        let text = "L I4\nJPT OVER\nL K+7\n= W8\nLBL OVER\nL I4\n= O2\nEM\n";
        let files = MemoryFiles::from([("MAIN.PLC", text)]);
        let compiled = Compilation::compile(&files, "MAIN.PLC", Options::default());
        let program = Arc::new(compiled.program.unwrap());
        let at = |line: u32| program.code.iter().position(|own| own.line == line).unwrap();
        let mut machine = Machine::new(Arc::clone(&program), Start::PowerOn);
        let mut nc = TestNc::new(ParameterList::reference(ControlModel::Tnc415b));
        let mut exchange = Exchange::default();
        let mut trace = CodeTrace::default();
        machine.scan_traced(&mut exchange, &mut nc, &mut trace).unwrap();
        let assigned = trace.executed(at(4)).unwrap();
        assert_eq!(
            (&assigned.operand, assigned.word),
            (&Some(OperandContent::Number(7)), 7)
        );
        assert!(!trace.executed(at(7)).unwrap().logic);
        exchange.nc_set("I4".parse().unwrap(), true);
        machine.scan_traced(&mut exchange, &mut nc, &mut trace).unwrap();
        assert_eq!(trace.executed(at(4)), None, "the scan passed it by");
        let output = trace.executed(at(7)).unwrap();
        assert_eq!(
            (&output.operand, output.logic),
            (&Some(OperandContent::Bit(true)), true)
        );
    }
}
