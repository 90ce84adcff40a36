//! What the cyclic program and every submit job have of their own.

use arrayvec::ArrayVec;
use bahn_exchange::STRING_LENGTH;

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
    /// Logic accumulator LA.
    pub logic: bool,
    /// Word accumulator WA.
    pub word: i32,
    /// Index register X.
    pub index: i32,
    /// Index of the next instruction.
    pub next: usize,
    /// String accumulator, without end character.
    pub(crate) text: Text,
    /// Buffered accumulators by bracket level.
    pub(crate) brackets: [i32; BRACKETS],
    pub(crate) stack: DataStack,
    /// Where calls return to.
    pub(crate) calls: ArrayVec<usize, CALLS_MAX>,
}

/// Characters of a string. Nothing here allocates: scans run in the cycle of the control.
pub(crate) type Text = ArrayVec<u8, STRING_LENGTH>;

impl Registers {
    /// String accumulator SA.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// How many calls are open.
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

    /// Goes to an instruction and notes where to come back.
    pub(crate) fn call(&mut self, target: usize) -> Result<(), PlcError> {
        let result = self.calls.try_push(self.next);
        result.map_err(|_| PlcError::NestingTooDeep)?;
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
    words: ArrayVec<u16, { STACK_BYTES / 2 }>,
}

/// A logic operand lies in bit 7 of its word.
const LOGIC: u16 = 1 << 7;

impl DataStack {
    /// Pushes 32 bits. The high word lies on top (inferred).
    #[inline]
    pub(crate) fn push(&mut self, value: i32) -> Result<(), PlcError> {
        let words = [value as u16, (value >> 16) as u16];
        let result = self.words.try_extend_from_slice(&words);
        result.map_err(|_| PlcError::StackOverflow)
    }

    /// Takes 32 bits from the data stack.
    #[inline]
    pub(crate) fn pull(&mut self) -> Result<i32, PlcError> {
        let (Some(high), Some(low)) = (self.words.pop(), self.words.pop()) else {
            return Err(PlcError::StackUnderflow);
        };
        Ok((u32::from(high) << 16 | u32::from(low)) as i32)
    }

    /// Puts one bit, a word long, on the data stack.
    pub(crate) fn push_logic(&mut self, value: bool) -> Result<(), PlcError> {
        let result = self.words.try_push(if value { LOGIC } else { 0 });
        result.map_err(|_| PlcError::StackOverflow)
    }

    /// Takes one bit, a word long, from the data stack.
    pub(crate) fn pull_logic(&mut self) -> Result<bool, PlcError> {
        let word = self.words.pop().ok_or(PlcError::StackUnderflow)?;
        Ok(word & LOGIC != 0)
    }
}
