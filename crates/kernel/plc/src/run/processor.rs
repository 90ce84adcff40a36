//! The reference interpreter: one instruction at a time.

use bahn_exchange::{Image, Size, signal};

use super::memory::{read, read_bit, read_bits, read_number, write_bit, write_bits, write_number};
use super::registers::Registers;
use super::submit::Queue;
use super::text;
use crate::modules::Call;
use crate::operand::{NumberOperand, Value};
use crate::program::{Arithmetic, Instruction, Op, PlcProgram, Target, bit};
use crate::{Nc, PlcError};

/// What an instruction works on.
pub(crate) struct Processor<'p, 'a> {
    pub(crate) program: &'p PlcProgram,
    pub(crate) image: &'a mut Image,
    pub(crate) registers: &'a mut Registers,
    pub(crate) queue: Jobs<'a>,
    pub(crate) nc: &'a mut dyn Nc,
}

/// The queue as the running program may use it.
pub(crate) enum Jobs<'a> {
    /// The cyclic program may submit.
    Cyclic(&'a mut Queue),
    /// A job may ask and cancel, but not submit [000:14327]. What it cancels is noted.
    Job(&'a Queue, &'a mut Option<i32>),
}

/// How an instruction ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The next instruction follows.
    Next,
    /// A jump, call, or end of a module: control is elsewhere now.
    Transferred,
    /// A jump, call or end whose condition does not hold.
    Skipped,
    /// The end of the run or of the job.
    Ended,
}

impl<'p> Processor<'p, '_> {
    /// Executes the next instruction. `None` when there is none: the program has no code there.
    pub(super) fn step(&mut self) -> Result<(Step, Option<&'p Instruction>), PlcError> {
        let program = self.program;
        let Some(instruction) = program.code.get(self.registers.next) else {
            return Ok((Step::Ended, None));
        };
        self.registers.next += 1;
        let step = self.execute(&instruction.op)?;
        Ok((step, Some(instruction)))
    }

    /// Executes one instruction and tells where the run goes on.
    #[expect(clippy::too_many_lines, reason = "one arm for each instruction")]
    pub(crate) fn execute(&mut self, op: &Op) -> Result<Step, PlcError> {
        let index = self.registers.index;
        match op {
            Op::Nop => {}
            Op::LoadBit { bit, invert } => {
                self.registers.logic = read_bit(self.image, *bit, index) != *invert;
            }
            Op::GateBit { gate, bit } => {
                let operand = read_bit(self.image, *bit, index);
                self.registers.logic = gate.bits(self.registers.logic, operand);
            }
            Op::AssignBit { bit, invert } => {
                write_bit(self.image, *bit, index, self.registers.logic != *invert)?;
            }
            Op::SetBit { bit, value, when } => {
                // An index is checked for write accesses; one that is not made is none (inferred).
                if self.registers.logic == *when {
                    write_bit(self.image, *bit, index, *value)?;
                }
            }
            Op::Load { value, transform } => self.registers.word = transform.apply(self.value(*value)),
            Op::LoadField { field } => self.registers.word = self.constant(*field)?,
            Op::LoadBits { first, count } => {
                self.registers.word = read_bits(self.image, *first, *count, index);
            }
            Op::LoadIndex => self.registers.word = index,
            Op::GateWord { gate, value } => {
                self.registers.word = gate.words(self.registers.word, self.value(*value));
            }
            Op::Arithmetic { operation, value } => {
                self.arithmetic(*operation, self.registers.word, self.value(*value));
            }
            Op::BitOperation { operation, value } => {
                self.registers.word = operation.apply(self.registers.word, self.value(*value));
            }
            Op::TestBit { value } => {
                self.registers.logic = self.registers.word & bit(self.value(*value)) != 0;
            }
            Op::Compare { comparison, value } => {
                let left = width(*value).truncate(self.registers.word);
                self.registers.logic = comparison.holds(left.cmp(&self.value(*value)));
            }
            Op::Assign { number, transform } => {
                write_number(self.image, *number, index, transform.apply(self.registers.word))?;
            }
            Op::AssignBits { first, count } => {
                write_bits(self.image, *first, *count, index, self.registers.word)?;
            }
            Op::StoreIndex => self.registers.index = self.registers.word,
            Op::StepNumber { number, by } => {
                let value = read_number(self.image, *number, index);
                write_number(self.image, *number, index, value.wrapping_add((*by).into()))?;
            }
            Op::StepWord { by } => {
                self.registers.word = self.registers.word.wrapping_add((*by).into());
            }
            Op::StepIndex { by } => self.registers.index = index.wrapping_add((*by).into()),
            Op::OpenLogic { level } => self.registers.buffer(*level, self.registers.logic.into()),
            Op::OpenWord { level } => self.registers.buffer(*level, self.registers.word),
            Op::CloseLogic { level, gate } => {
                let outside = self.registers.bracket(*level) != 0;
                self.registers.logic = gate.bits(outside, self.registers.logic);
            }
            Op::CloseWord { level, gate } => {
                self.registers.word = gate.words(self.registers.bracket(*level), self.registers.word);
            }
            Op::CloseArithmetic { level, operation } => {
                self.arithmetic(*operation, self.registers.bracket(*level), self.registers.word);
            }
            Op::CloseCompare { level, comparison } => {
                let outside = self.registers.bracket(*level);
                self.registers.logic = comparison.holds(outside.cmp(&self.registers.word));
            }
            Op::PushBit { bit } => {
                self.registers
                    .stack
                    .push_logic(read_bit(self.image, *bit, index))?;
            }
            Op::Push { value } => {
                let value = self.value(*value);
                self.registers.stack.push(value)?;
            }
            Op::PushLogic => self.registers.stack.push_logic(self.registers.logic)?,
            Op::PushWord => self.registers.stack.push(self.registers.word)?,
            Op::PushIndex => self.registers.stack.push(index)?,
            Op::PullBit { bit } => {
                let value = self.registers.stack.pull_logic()?;
                write_bit(self.image, *bit, index, value)?;
            }
            Op::Pull { number } => {
                let value = self.registers.stack.pull()?;
                write_number(self.image, *number, index, value)?;
            }
            Op::PullLogic => self.registers.logic = self.registers.stack.pull_logic()?,
            Op::PullWord => self.registers.word = self.registers.stack.pull()?,
            Op::PullIndex => self.registers.index = self.registers.stack.pull()?,
            Op::LoadText { text } => {
                let mut reference = text::Reference::default();
                let text = text::read(self.image, text, index, &mut reference)?;
                text::replace(&mut self.registers.text, text);
            }
            Op::AppendText { text } => {
                let mut reference = text::Reference::default();
                let more = text::read(self.image, text, index, &mut reference)?;
                text::append(&mut self.registers.text, more);
            }
            Op::AssignText { string, indexed } => {
                let string = text::string_number(*string, *indexed, index)?;
                self.image.set_text(string, &self.registers.text);
            }
            Op::OverwriteText { string, indexed } => {
                let string = text::string_number(*string, *indexed, index)?;
                text::overwrite(self.image, string, &self.registers.text);
            }
            Op::CompareText { comparison, text } => {
                let mut reference = text::Reference::default();
                let right = text::read(self.image, text, index, &mut reference)?;
                let order = text::compare(&self.registers.text, right);
                self.registers.logic = comparison.holds(order);
            }
            Op::Submit { target } => self.registers.word = self.submit(*target),
            Op::Reply { number } => {
                let identifier = self.identifier(*number);
                self.registers.word = match &self.queue {
                    Jobs::Cyclic(queue) => queue.reply(identifier),
                    Jobs::Job(queue, _) => queue.reply(identifier),
                };
            }
            Op::Cancel { number } => {
                let identifier = self.identifier(*number);
                match &mut self.queue {
                    Jobs::Cyclic(queue) => queue.cancel(identifier),
                    Jobs::Job(_, cancelled) => **cancelled = Some(identifier),
                }
            }
            Op::Jump { .. } | Op::Call { .. } | Op::Return { .. } | Op::Case { .. } => {
                return self.transfer(op);
            }
        }
        Ok(Step::Next)
    }

    /// Jumps, calls and ends.
    fn transfer(&mut self, op: &Op) -> Result<Step, PlcError> {
        let logic = self.registers.logic;
        match op {
            Op::Jump { condition, target } if condition.holds(logic) => self.registers.next = *target,
            Op::Call { condition, target } if condition.holds(logic) => self.call(*target)?,
            Op::Return { condition } if condition.holds(logic) => match self.registers.calls.pop() {
                Some(next) => self.registers.next = next,
                None => return Ok(Step::Ended),
            },
            Op::Case { number, table } => {
                let entry = read_number(self.image, *number, self.registers.index);
                let entries = self.program.cases.get(*table);
                let target = usize::try_from(entry).ok().and_then(|entry| entries?.get(entry));
                self.call(*target.ok_or(PlcError::CaseOutOfRange)?)?;
            }
            _ => return Ok(Step::Skipped),
        }
        Ok(Step::Transferred)
    }

    fn call(&mut self, target: Target) -> Result<(), PlcError> {
        match target {
            Target::Code(at) => self.registers.call(at),
            Target::Module(number) => self.call_module(number),
        }
    }

    /// Runs an internal module.
    pub(crate) fn call_module(&mut self, number: u16) -> Result<(), PlcError> {
        Call {
            image: self.image,
            stack: &mut self.registers.stack,
            nc: self.nc,
            from_submit: matches!(self.queue, Jobs::Job(..)),
        }
        .run(number)
    }

    fn submit(&mut self, target: Target) -> i32 {
        match (&mut self.queue, target) {
            (Jobs::Cyclic(queue), Target::Code(at)) => queue.submit(at),
            _ => 0,
        }
    }

    /// The identifier in an operand; in a byte it has no sign.
    fn identifier(&self, operand: NumberOperand) -> i32 {
        let value = read_number(self.image, operand, self.registers.index);
        match operand.number.size() {
            Size::Byte => value & 0xff,
            Size::Word | Size::Double => value,
        }
    }

    fn value(&self, value: Value) -> i32 {
        read(self.image, value, self.registers.index)
    }

    fn constant(&self, field: usize) -> Result<i32, PlcError> {
        let values = self.program.fields.get(field).map(|field| &field.values);
        let index = usize::try_from(self.registers.index as i16).ok();
        let value = index.and_then(|index| values?.get(index));
        value.copied().ok_or(PlcError::IndexOutOfRange)
    }

    /// Calculates, and sets or resets the error marker of the operation [000:12888][000:12926].
    fn arithmetic(&mut self, operation: Arithmetic, left: i32, right: i32) {
        let (result, correct) = operation.apply(left, right);
        self.registers.word = result;
        let marker = match operation {
            Arithmetic::Plus | Arithmetic::Minus => return,
            Arithmetic::Multiply => signal::MULTIPLICATION_ERROR,
            Arithmetic::Divide => signal::DIVISION_ERROR,
            Arithmetic::Modulo => signal::MODULO_ERROR,
        };
        self.image.set_bit(marker, !correct);
    }
}

/// The width over which an operand is compared [000:13064].
fn width(value: Value) -> Size {
    match value {
        Value::Number(operand) => operand.number.size(),
        Value::Constant(_) => Size::Double,
    }
}
