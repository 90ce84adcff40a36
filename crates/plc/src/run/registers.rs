//! What the cyclic program and every submit job have of their own.

use crate::PlcError;

/// Open brackets at most [000:13234].
const BRACKETS: usize = 16;
/// Bytes of the data stack [000:12035].
const STACK_BYTES: usize = 128;
/// Nested calls at most [000:12030].
pub(crate) const CALLS_MAX: usize = 32;

/// Accumulators, index register, stacks and program counter of the cyclic program or of a submit job.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Registers {
    /// Logic accumulator.
    pub logic: bool,
    /// Word accumulator.
    pub word: i32,
    /// Index register.
    pub index: i32,
    /// Index of the next instruction.
    pub next: usize,
    /// String accumulator, without end character.
    pub(crate) text: Vec<u8>,
    /// Buffered accumulators by bracket level.
    pub(crate) brackets: [i32; BRACKETS],
    pub(crate) stack: DataStack,
    /// Where calls return to.
    pub(crate) calls: Vec<usize>,
}

impl Registers {
    /// String accumulator.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// Nested calls.
    pub fn call_depth(&self) -> usize {
        self.calls.len()
    }

    /// Bytes on the data stack.
    pub fn stack_bytes(&self) -> usize {
        self.stack.words.len() * 2
    }

    /// At the start of every cycle: X is 0 [000:14020], stacks are empty (inferred). The accumulators keep
    /// their values.
    pub(crate) fn restart(&mut self) {
        self.index = 0;
        self.next = 0;
        self.stack.words.clear();
        self.calls.clear();
    }

    /// Enters a module.
    pub(crate) fn call(&mut self, target: usize) -> Result<(), PlcError> {
        if self.calls.len() >= CALLS_MAX {
            return Err(PlcError::NestingTooDeep);
        }
        self.calls.push(self.next);
        self.next = target;
        Ok(())
    }

    pub(crate) fn bracket(&self, level: u8) -> i32 {
        self.brackets.get(usize::from(level)).copied().unwrap_or(0)
    }

    pub(crate) fn buffer(&mut self, level: u8, value: i32) {
        if let Some(bracket) = self.brackets.get_mut(usize::from(level)) {
            *bracket = value;
        }
    }
}

/// The data stack: words of 16 bits, last in, first out [000:13658-13692].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct DataStack {
    words: Vec<u16>,
}

/// A logic operand lies in bit 7 of its word.
const LOGIC: u16 = 1 << 7;

impl DataStack {
    /// Pushes 32 bits. The high word lies on top (inferred).
    pub(crate) fn push(&mut self, value: i32) -> Result<(), PlcError> {
        if (self.words.len() + 2) * 2 > STACK_BYTES {
            return Err(PlcError::StackOverflow);
        }
        self.words.push(value as u16);
        self.words.push((value >> 16) as u16);
        Ok(())
    }

    /// Pulls 32 bits.
    pub(crate) fn pull(&mut self) -> Result<i32, PlcError> {
        let (Some(high), Some(low)) = (self.words.pop(), self.words.pop()) else {
            return Err(PlcError::StackUnderflow);
        };
        Ok((u32::from(high) << 16 | u32::from(low)) as i32)
    }

    /// Pushes one bit.
    pub(crate) fn push_logic(&mut self, value: bool) -> Result<(), PlcError> {
        if (self.words.len() + 1) * 2 > STACK_BYTES {
            return Err(PlcError::StackOverflow);
        }
        self.words.push(if value { LOGIC } else { 0 });
        Ok(())
    }

    /// Pulls one bit.
    pub(crate) fn pull_logic(&mut self) -> Result<bool, PlcError> {
        let word = self.words.pop().ok_or(PlcError::StackUnderflow)?;
        Ok(word & LOGIC != 0)
    }
}
