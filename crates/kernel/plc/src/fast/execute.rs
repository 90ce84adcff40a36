//! The loop that executes the fast form.

use bahn_exchange::{CELLS, signal};

use super::{CaseEntry, FastOp, FastProgram, Run, bits};
use crate::PlcError;
use crate::program::{Arithmetic, bit};
use crate::run::{CALLS_MAX, Processor, read_number};

/// What the loop works on, and its registers while something else needs them.
struct State<'f, 'r, 'p, 'a> {
    fast: &'f FastProgram,
    processor: &'r mut Processor<'p, 'a>,
    logic: bool,
    word: i32,
    index: i32,
    /// Index of the next operation.
    next: usize,
    /// What is added to the time before an instruction to get the time of the run.
    shift: i64,
    budget: i64,
    last_jump: u32,
    /// Index of the instruction where a time out was found.
    landed: usize,
    /// Leaps of the open calls.
    calls: [u32; CALLS_MAX],
    depth: usize,
}

/// Why the loop ended: at the instruction of an index.
enum End {
    /// By an EM; the time of the run.
    Returned(i64),
    /// There is no instruction.
    Nothing,
    Error(PlcError),
}

pub(super) fn run(fast: &FastProgram, processor: &mut Processor<'_, '_>, budget: u64) -> Run {
    let (logic, word, index) = (
        processor.registers.logic,
        processor.registers.word,
        processor.registers.index,
    );
    let mut state = State {
        fast,
        processor,
        logic,
        word,
        index,
        next: 0,
        shift: 0,
        budget: i64::try_from(budget).unwrap_or(i64::MAX),
        last_jump: 0,
        landed: 0,
        calls: [0; CALLS_MAX],
        depth: 0,
    };
    let end = state.run();
    state.leave(end)
}

impl State<'_, '_, '_, '_> {
    #[expect(
        clippy::too_many_lines,
        reason = "one arm for each instruction; its registers are locals of one function"
    )]
    fn run(&mut self) -> End {
        let fast = self.fast;
        // Local, so that they are registers of the host; `self` has them while something else needs them.
        let (mut logic, mut word, mut index, mut next) = (self.logic, self.word, self.index, self.next);
        macro_rules! outside {
            ($what:expr) => {{
                (self.logic, self.word, self.index, self.next) = (logic, word, index, next);
                let result = $what;
                (logic, word, index, next) = (self.logic, self.word, self.index, self.next);
                match result {
                    Ok(()) => {}
                    Err(error) => return End::Error(error),
                }
            }};
        }
        // What may fail, but needs no registers of the loop.
        macro_rules! checked {
            ($what:expr) => {
                match $what {
                    Ok(value) => value,
                    Err(error) => {
                        (self.logic, self.word, self.index, self.next) = (logic, word, index, next);
                        return End::Error(error);
                    }
                }
            };
        }
        loop {
            let Some(op) = fast.code.get(next) else {
                (self.logic, self.word, self.index, self.next) = (logic, word, index, next);
                return End::Nothing;
            };
            next += 1;
            let cells = self.processor.image.cells_mut();
            match *op {
                FastOp::Bits { first, count } => {
                    let first = first as usize;
                    let steps = fast.steps.get(first..first + count as usize);
                    logic = bits::run(steps.unwrap_or(&[]), cells, logic);
                }
                FastOp::Word { function, operand } => word = function.apply(word, operand.read(cells)),
                FastOp::Move { from, to } => {
                    word = from.read(cells);
                    to.write(cells, word);
                }
                FastOp::Compute {
                    load,
                    function,
                    operand,
                    to,
                } => {
                    word = function.apply(load.read(cells), operand.read(cells));
                    to.write(cells, word);
                }
                FastOp::LoadWord {
                    load,
                    function,
                    operand,
                } => word = function.apply(load.read(cells), operand.read(cells)),
                FastOp::Compare { order, operand } => {
                    logic = order.holds(operand.truncate(word), operand.read(cells));
                }
                FastOp::LoadCompare { load, order, operand } => {
                    word = load.read(cells);
                    logic = order.holds(operand.truncate(word), operand.read(cells));
                }
                FastOp::TestBit { operand } => {
                    logic = word & bit(operand.read(cells)) != 0;
                }
                FastOp::Arithmetic { operation, operand } => {
                    word = arithmetic(cells, operation, word, operand.read(cells));
                }
                FastOp::Assign { to, transform } => to.write(cells, transform.apply(word)),
                FastOp::Step { from, to, by } => {
                    to.write(cells, from.read(cells).wrapping_add(by.into()));
                }
                FastOp::LoadBits { cell, count } => word = bits::read(cells, cell, count),
                FastOp::AssignBits { cell, count } => bits::write(cells, cell, count, word),
                FastOp::LoadIndex => word = index,
                FastOp::StoreIndex => index = word,
                FastOp::StepIndex { by } => index = index.wrapping_add(by.into()),
                FastOp::OpenWord { level } => self.processor.registers.buffer(level, word),
                FastOp::CloseWord { level, function } => {
                    word = function.apply(self.processor.registers.bracket(level), word);
                }
                FastOp::CloseArithmetic { level, operation } => {
                    let outside = self.processor.registers.bracket(level);
                    word = arithmetic(cells, operation, outside, word);
                }
                FastOp::CloseCompare { level, order } => {
                    logic = order.holds(self.processor.registers.bracket(level), word);
                }
                FastOp::GateIndexed { table, operand } => {
                    let content = u32::from(operand.read(cells, index));
                    logic = u32::from(table) >> (2 * content + u32::from(logic)) & 1 != 0;
                }
                FastOp::AssignIndexed { invert, to } => {
                    checked!(to.write(cells, index, logic != invert));
                }
                FastOp::SetIndexed { value, when, to } => {
                    if logic == when {
                        checked!(to.write(cells, index, value));
                    }
                }
                FastOp::WordIndexed { function, operand } => {
                    word = function.apply(word, operand.read(self.processor.image, index));
                }
                FastOp::CompareIndexed { order, operand } => {
                    let right = operand.read(self.processor.image, index);
                    logic = order.holds(operand.truncate(word), right);
                }
                FastOp::AssignWordIndexed { to, transform } => {
                    checked!(to.write(self.processor.image, index, transform.apply(word)));
                }
                FastOp::Push { operand } => {
                    let value = operand.read(cells);
                    checked!(self.processor.registers.stack.push(value));
                }
                FastOp::PushWord => checked!(self.processor.registers.stack.push(word)),
                FastOp::Pull { to } => {
                    let value = checked!(self.processor.registers.stack.pull());
                    to.write(cells, value);
                }
                FastOp::PullWord => word = checked!(self.processor.registers.stack.pull()),
                FastOp::Reference { at } => outside!(self.reference(at)),
                FastOp::Jump { condition, leap } => {
                    if condition.holds(logic)
                        && let Some(leap) = fast.leaps.get(leap as usize)
                    {
                        next = leap.to as usize;
                        self.last_jump = leap.at;
                        self.shift += leap.shift;
                        if self.shift + leap.before > self.budget {
                            outside!(self.time_out(leap.target));
                        }
                    }
                }
                FastOp::Call { condition, leap } => {
                    if condition.holds(logic) {
                        outside!(self.call(leap));
                    }
                }
                FastOp::Return { condition, time } => {
                    if condition.holds(logic) {
                        let Some(leap) = self.pop().and_then(|leap| fast.leaps.get(leap as usize)) else {
                            (self.logic, self.word, self.index, self.next) = (logic, word, index, next);
                            return End::Returned(self.shift + time);
                        };
                        self.last_jump = fast.origin.get(next - 1).copied().unwrap_or(0);
                        self.shift += time - leap.before_back;
                        next = leap.back as usize;
                        if self.shift + leap.before_back > self.budget {
                            outside!(self.time_out(leap.at + 1));
                        }
                    }
                }
                FastOp::Module { condition, at, extra } => {
                    if condition.holds(logic) {
                        outside!(self.module(at, extra));
                    }
                }
                FastOp::Case { number, table } => {
                    let entry = read_number(self.processor.image, number, index);
                    outside!(self.case(table, entry));
                }
            }
        }
    }

    /// Lets the reference interpreter execute an instruction.
    #[inline(never)]
    fn reference(&mut self, at: u32) -> Result<(), PlcError> {
        let program = self.processor.program;
        let Some(instruction) = program.code.get(at as usize) else {
            return Ok(());
        };
        self.give();
        let result = self.processor.execute(&instruction.op);
        self.logic = self.processor.registers.logic;
        self.word = self.processor.registers.word;
        self.index = self.processor.registers.index;
        result.map(|_| ())
    }

    /// Calls an internal module, which is a transfer of control and back.
    fn module(&mut self, at: u32, extra: i32) -> Result<(), PlcError> {
        self.reference(at)?;
        self.shift += i64::from(extra);
        self.back_at(at)
    }

    /// Control was transferred by an instruction and is after it again.
    fn back_at(&mut self, at: u32) -> Result<(), PlcError> {
        self.last_jump = at;
        if self.shift + self.time_before(at as usize + 1) > self.budget {
            return self.time_out(at + 1);
        }
        Ok(())
    }

    /// Calls the entry of a table.
    #[inline(never)]
    fn case(&mut self, table: u32, entry: i32) -> Result<(), PlcError> {
        let table = self.fast.cases.get(table as usize);
        let entry = usize::try_from(entry).ok().and_then(|entry| table?.get(entry));
        match entry.copied().ok_or(PlcError::CaseOutOfRange)? {
            CaseEntry::Code(leap) => self.call(leap),
            CaseEntry::Module(number) => {
                self.give();
                self.processor.call_module(number)?;
                self.back_at(self.here())
            }
        }
    }

    /// Calls the code of a leap.
    #[inline(always)]
    fn call(&mut self, leap: u32) -> Result<(), PlcError> {
        let Some(target) = self.fast.leaps.get(leap as usize) else {
            return Ok(());
        };
        let place = self.calls.get_mut(self.depth);
        *place.ok_or(PlcError::NestingTooDeep)? = leap;
        self.depth += 1;
        self.next = target.to as usize;
        self.last_jump = target.at;
        self.shift += target.shift;
        if self.shift + target.before > self.budget {
            return self.time_out(target.target);
        }
        Ok(())
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<u32> {
        self.depth = self.depth.checked_sub(1)?;
        self.calls.get(self.depth).copied()
    }

    /// The run took too long when control came to the instruction of an index.
    #[cold]
    fn time_out(&mut self, landed: u32) -> Result<(), PlcError> {
        self.landed = landed as usize;
        Err(PlcError::TimeOut)
    }

    /// Index of the instruction that was executed last, when it was not fused.
    fn here(&self) -> u32 {
        self.fast
            .origin
            .get(self.next.saturating_sub(1))
            .copied()
            .unwrap_or(0)
    }

    fn time_before(&self, at: usize) -> i64 {
        self.fast
            .time_before
            .get(at)
            .or(self.fast.time_before.last())
            .copied()
            .unwrap_or(0)
    }

    /// Puts the accumulators where the reference interpreter has them.
    fn give(&mut self) {
        self.processor.registers.logic = self.logic;
        self.processor.registers.word = self.word;
        self.processor.registers.index = self.index;
    }

    /// Puts everything where the reference interpreter leaves it, and tells how the run ended.
    fn leave(mut self, end: End) -> Run {
        self.give();
        bits::clear_brackets(self.processor.image.cells_mut());
        let fast = self.fast;
        let calls = self.calls.iter().take(self.depth);
        self.processor.registers.calls = calls
            .filter_map(|leap| fast.leaps.get(*leap as usize))
            .map(|leap| leap.at as usize + 1)
            .collect();
        let here = self.here() as usize;
        let last_jump = self.last_jump as usize;
        let instructions = self.fast.time_before.len().saturating_sub(1);
        let (next, elapsed, end) = match end {
            End::Nothing => (instructions, self.shift + self.time_before(instructions), Ok(())),
            End::Returned(elapsed) if elapsed > self.budget => {
                (here + 1, elapsed, Err((PlcError::TimeOut, last_jump)))
            }
            End::Returned(elapsed) => (here + 1, elapsed, Ok(())),
            // Control is at the target already.
            End::Error(PlcError::TimeOut) => (
                self.landed,
                self.shift + self.time_before(self.landed),
                Err((PlcError::TimeOut, last_jump)),
            ),
            End::Error(error) => (here + 1, self.shift + self.time_before(here), Err((error, here))),
        };
        self.processor.registers.next = next;
        Run {
            elapsed: u64::try_from(elapsed).unwrap_or(0),
            last_jump,
            end,
        }
    }
}

/// Calculates, and sets or resets the error marker of the operation [000:12888][000:12926].
fn arithmetic(cells: &mut [u8; CELLS], operation: Arithmetic, left: i32, right: i32) -> i32 {
    let (result, correct) = operation.apply(left, right);
    let marker = match operation {
        Arithmetic::Plus | Arithmetic::Minus => return result,
        Arithmetic::Multiply => signal::MULTIPLICATION_ERROR,
        Arithmetic::Divide => signal::DIVISION_ERROR,
        Arithmetic::Modulo => signal::MODULO_ERROR,
    };
    cells[marker.cell() % CELLS] = u8::from(!correct);
    result
}
