//! From instructions to operations of the fast form.

use super::bits::{BitStep, IndexedBit, consecutive};
use super::words::{Destination, Function, IndexedNumber, Order, Source};
use super::{CaseEntry, FastOp, FastProgram, Leap};
use crate::operand::Value;
use crate::program::{Instruction, Op, PlcProgram, Target, Transform};

pub(super) fn translate(program: &PlcProgram) -> FastProgram {
    let mut translator = Translator {
        program,
        reached: reached(program),
        places: vec![0; program.code.len() + 1],
        fast: FastProgram {
            time_before: times(program),
            ..FastProgram::default()
        },
    };
    let mut at = 0;
    while at < program.code.len() {
        at += translator.translate(at).max(1);
    }
    translator.finish()
}

struct Translator<'p> {
    program: &'p PlcProgram,
    /// Whether control may come to an instruction from elsewhere.
    reached: Vec<bool>,
    /// The operation of each instruction that is reached from elsewhere.
    places: Vec<u32>,
    fast: FastProgram,
}

impl<'p> Translator<'p> {
    /// Translates the instruction of an index, perhaps with those after it; tells how many.
    fn translate(&mut self, at: usize) -> usize {
        let place = self.fast.code.len();
        if let Some(entry) = self.places.get_mut(at) {
            *entry = index(place);
        }
        let Some(instruction) = self.program.code.get(at) else {
            return 1;
        };
        if let Some(step) = BitStep::of(&instruction.op) {
            self.bit(at, step);
            return 1;
        }
        if matches!(instruction.op, Op::Nop) {
            // Who comes here comes to the next one.
            if self.is_reached(at)
                && let Some(next) = self.reached.get_mut(at + 1)
            {
                *next = true;
            }
            return 1;
        }
        let (op, count) = self
            .fused(at)
            .or_else(|| single(&instruction.op).map(|op| (op, 1)))
            .or_else(|| indexed(&instruction.op).map(|op| (op, 1)))
            .unwrap_or_else(|| (self.transfer(at, instruction), 1));
        self.push(at, op);
        count
    }

    fn push(&mut self, at: usize, op: FastOp) {
        self.fast.code.push(op);
        self.fast.origin.push(index(at));
    }

    /// Puts a bit instruction after those before it.
    fn bit(&mut self, at: usize, step: BitStep) {
        let first = index(self.fast.steps.len());
        self.fast.steps.push(step);
        if !self.is_reached(at)
            && let Some(FastOp::Bits { count, .. }) = self.fast.code.last_mut()
        {
            *count += 1;
            return;
        }
        self.push(at, FastOp::Bits { first, count: 1 });
    }

    /// A load with what is done with it.
    fn fused(&self, at: usize) -> Option<(FastOp, usize)> {
        let load = loaded(self.op(at)?)?;
        let second = self.op_after(at)?;
        if let Op::Compare { comparison, value } = second {
            let (order, operand) = (Order::from(*comparison), Source::of(value)?);
            return Some((FastOp::LoadCompare { load, order, operand }, 2));
        }
        if let Some(to) = assigned(second) {
            return Some((FastOp::Move { from: load, to }, 2));
        }
        let (function, operand) = calculated(second)?;
        if let Some(to) = self.op_after(at + 1).and_then(assigned) {
            let op = FastOp::Compute {
                load,
                function,
                operand,
                to,
            };
            return Some((op, 3));
        }
        let op = FastOp::LoadWord {
            load,
            function,
            operand,
        };
        Some((op, 2))
    }

    /// Jumps, calls, ends; everything else is left to the reference interpreter.
    fn transfer(&mut self, at: usize, instruction: &Instruction) -> FastOp {
        let time = i64::from(instruction.time);
        match &instruction.op {
            Op::Jump { condition, target } => FastOp::Jump {
                condition: *condition,
                leap: self.leap(at, time, *target),
            },
            Op::Call {
                condition,
                target: Target::Code(target),
            } => FastOp::Call {
                condition: *condition,
                leap: self.leap(at, time, *target),
            },
            Op::Call { condition, .. } => {
                let extra = time - i64::from(instruction.time_skipped);
                FastOp::Module {
                    condition: *condition,
                    at: index(at),
                    extra: i32::try_from(extra).unwrap_or(i32::MAX),
                }
            }
            Op::Return { condition } => FastOp::Return {
                condition: *condition,
                time: self.time_before(at) + time,
            },
            Op::Case { number, table } => {
                let entries = self.program.cases.get(*table).map_or(&[][..], Vec::as_slice);
                let entries = entries
                    .iter()
                    .map(|target| match target {
                        Target::Code(target) => CaseEntry::Code(self.leap(at, time, *target)),
                        Target::Module(number) => CaseEntry::Module(*number),
                    })
                    .collect();
                self.fast.cases.push(entries);
                FastOp::Case {
                    number: *number,
                    table: index(self.fast.cases.len() - 1),
                }
            }
            _ => FastOp::Reference { at: index(at) },
        }
    }

    fn leap(&mut self, at: usize, time: i64, target: usize) -> u32 {
        let target = target.min(self.program.code.len());
        let before = self.time_before(target);
        self.fast.leaps.push(Leap {
            target: index(target),
            to: index(target),
            at: index(at),
            shift: self.time_before(at) + time - before,
            before,
            back: index(at + 1),
            before_back: self.time_before(at + 1),
        });
        index(self.fast.leaps.len() - 1)
    }

    /// Sets the targets of leaps, now that every instruction has its place.
    fn finish(mut self) -> FastProgram {
        let end = index(self.fast.code.len());
        if let Some(place) = self.places.last_mut() {
            *place = end;
        }
        for leap in &mut self.fast.leaps {
            for target in [&mut leap.to, &mut leap.back] {
                *target = self.places.get(*target as usize).copied().unwrap_or(end);
            }
        }
        self.fast.code.shrink_to_fit();
        self.fast.steps.shrink_to_fit();
        self.fast
    }

    fn op(&self, at: usize) -> Option<&'p Op> {
        self.program.code.get(at).map(|instruction| &instruction.op)
    }

    /// The instruction after another, when control comes from there only.
    fn op_after(&self, at: usize) -> Option<&'p Op> {
        self.op(at + 1).filter(|_| !self.is_reached(at + 1))
    }

    fn is_reached(&self, at: usize) -> bool {
        self.reached.get(at).copied().unwrap_or(true)
    }

    fn time_before(&self, at: usize) -> i64 {
        self.fast.time_before.get(at).copied().unwrap_or(0)
    }
}

/// The fast form of an instruction that goes on to the next one and has no index.
fn single(op: &Op) -> Option<FastOp> {
    if let Some((function, operand)) = calculated(op) {
        return Some(FastOp::Word { function, operand });
    }
    Some(match op {
        Op::Load { value, transform } => FastOp::Word {
            function: (*transform).into(),
            operand: Source::of(value)?,
        },
        Op::Arithmetic { operation, value } => FastOp::Arithmetic {
            operation: *operation,
            operand: Source::of(value)?,
        },
        Op::Compare { comparison, value } => FastOp::Compare {
            order: (*comparison).into(),
            operand: Source::of(value)?,
        },
        Op::TestBit { value } => FastOp::TestBit {
            operand: Source::of(value)?,
        },
        Op::Assign { number, transform } => FastOp::Assign {
            to: Destination::of(number)?,
            transform: *transform,
        },
        Op::StepNumber { number, by } => FastOp::Step {
            from: Source::of(&Value::Number(*number))?,
            to: Destination::of(number)?,
            by: *by,
        },
        Op::LoadBits { first, count } => FastOp::LoadBits {
            cell: consecutive(first, *count)?,
            count: *count,
        },
        Op::AssignBits { first, count } => FastOp::AssignBits {
            cell: consecutive(first, *count)?,
            count: *count,
        },
        Op::Push { value } => FastOp::Push {
            operand: Source::of(value)?,
        },
        Op::PushWord => FastOp::PushWord,
        Op::Pull { number } => FastOp::Pull {
            to: Destination::of(number)?,
        },
        Op::PullWord => FastOp::PullWord,
        Op::LoadIndex => FastOp::LoadIndex,
        Op::StoreIndex => FastOp::StoreIndex,
        Op::StepIndex { by } => FastOp::StepIndex { by: *by },
        Op::OpenWord { level } => FastOp::OpenWord { level: *level },
        Op::CloseWord { level, gate } => FastOp::CloseWord {
            level: *level,
            function: (*gate).into(),
        },
        Op::CloseArithmetic { level, operation } => match Function::of_arithmetic(*operation) {
            Some(function) => FastOp::CloseWord {
                level: *level,
                function,
            },
            None => FastOp::CloseArithmetic {
                level: *level,
                operation: *operation,
            },
        },
        Op::CloseCompare { level, comparison } => FastOp::CloseCompare {
            level: *level,
            order: (*comparison).into(),
        },
        _ => return None,
    })
}

/// The fast form of an instruction with index.
fn indexed(op: &Op) -> Option<FastOp> {
    // Bit `2 * content + LA` is the new LA.
    let table = |rule: &dyn Fn(bool, bool) -> bool| {
        let states = [(false, false), (true, false), (false, true), (true, true)];
        let bits = states.into_iter().enumerate();
        bits.fold(0, |table, (at, (logic, content))| {
            table | u8::from(rule(logic, content)) << at
        })
    };
    Some(match op {
        Op::LoadBit { bit, invert } => FastOp::GateIndexed {
            table: table(&|_, content| content != *invert),
            operand: IndexedBit::of(bit)?,
        },
        Op::GateBit { gate, bit } => FastOp::GateIndexed {
            table: table(&|logic, content| gate.bits(logic, content)),
            operand: IndexedBit::of(bit)?,
        },
        Op::AssignBit { bit, invert } => FastOp::AssignIndexed {
            invert: *invert,
            to: IndexedBit::of(bit)?,
        },
        Op::SetBit { bit, value, when } => FastOp::SetIndexed {
            value: *value,
            when: *when,
            to: IndexedBit::of(bit)?,
        },
        Op::Load { value, transform } => FastOp::WordIndexed {
            function: (*transform).into(),
            operand: IndexedNumber::of(value)?,
        },
        Op::GateWord { gate, value } => FastOp::WordIndexed {
            function: (*gate).into(),
            operand: IndexedNumber::of(value)?,
        },
        Op::BitOperation { operation, value } => FastOp::WordIndexed {
            function: (*operation).into(),
            operand: IndexedNumber::of(value)?,
        },
        Op::Arithmetic { operation, value } => FastOp::WordIndexed {
            function: Function::of_arithmetic(*operation)?,
            operand: IndexedNumber::of(value)?,
        },
        Op::Compare { comparison, value } => FastOp::CompareIndexed {
            order: (*comparison).into(),
            operand: IndexedNumber::of(value)?,
        },
        Op::Assign { number, transform } => FastOp::AssignWordIndexed {
            to: IndexedNumber::of(&Value::Number(*number))?,
            transform: *transform,
        },
        _ => return None,
    })
}

/// What an instruction loads unchanged.
fn loaded(op: &Op) -> Option<Source> {
    match op {
        Op::Load { value, transform } => match (value, transform) {
            (value, Transform::Plain) => Source::of(value),
            (Value::Constant(value), transform) => Some(Source::Constant(transform.apply(*value))),
            _ => None,
        },
        _ => None,
    }
}

/// Where an instruction puts the word accumulator unchanged.
fn assigned(op: &Op) -> Option<Destination> {
    match op {
        Op::Assign {
            number,
            transform: Transform::Plain,
        } => Destination::of(number),
        _ => None,
    }
}

/// What an instruction makes of the word accumulator, without an error marker.
fn calculated(op: &Op) -> Option<(Function, Source)> {
    match op {
        Op::GateWord { gate, value } => Some(((*gate).into(), Source::of(value)?)),
        Op::Arithmetic { operation, value } => {
            Some((Function::of_arithmetic(*operation)?, Source::of(value)?))
        }
        Op::BitOperation { operation, value } => Some(((*operation).into(), Source::of(value)?)),
        Op::StepWord { by } => Some((Function::Plus, Source::Constant((*by).into()))),
        _ => None,
    }
}

/// For each instruction whether control may come there from elsewhere: targets, and places after calls.
fn reached(program: &PlcProgram) -> Vec<bool> {
    let mut reached = vec![false; program.code.len() + 1];
    let mut mark = |at: usize| {
        if let Some(reached) = reached.get_mut(at) {
            *reached = true;
        }
    };
    mark(0);
    for (at, instruction) in program.code.iter().enumerate() {
        match &instruction.op {
            Op::Jump { target, .. } => mark(*target),
            Op::Call { target, .. } => {
                mark(at + 1);
                mark_target(&mut mark, *target);
            }
            Op::Case { .. } => mark(at + 1),
            _ => {}
        }
    }
    for target in program.cases.iter().flatten() {
        mark_target(&mut mark, *target);
    }
    reached
}

fn mark_target(mark: &mut impl FnMut(usize), target: Target) {
    if let Target::Code(at) = target {
        mark(at);
    }
}

/// The nominal time before each instruction and after the last, when no jump is taken.
fn times(program: &PlcProgram) -> Vec<i64> {
    let mut sum = 0;
    let sums = program.code.iter().map(|instruction| {
        sum += i64::from(match instruction.op {
            Op::Jump { .. } | Op::Call { .. } | Op::Return { .. } => instruction.time_skipped,
            _ => instruction.time,
        });
        sum
    });
    std::iter::once(0).chain(sums).collect()
}

/// Programs are far shorter than 2^32 instructions: the code has 128 KB.
fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}
