//! The nominal time of a program before it runs.

use crate::program::{Condition, Instruction, Op, PlcProgram, Target};

/// Passes after which calls of earlier modules are no longer followed: as deep as calls may nest.
const PASSES_MAX: usize = 32;

/// The longest way from the first instruction to the end of the main program, in ns. Jumps backward are not
/// followed; a call counts the longest way through its module.
pub(super) fn nominal_time(program: &PlcProgram) -> u64 {
    let mut longest = vec![0_u64; program.code.len() + 1];
    for _ in 0..PASSES_MAX {
        let mut changed = false;
        for (at, instruction) in program.code.iter().enumerate().rev() {
            let time = way(program, instruction, at, &longest);
            if let Some(known) = longest.get_mut(at) {
                changed |= *known != time;
                *known = time;
            }
        }
        if !changed {
            break;
        }
    }
    longest.first().copied().unwrap_or(0)
}

/// The longest way from an instruction, when the ways after it are known.
fn way(program: &PlcProgram, instruction: &Instruction, at: usize, longest: &[u64]) -> u64 {
    let after = |at: usize| longest.get(at).copied().unwrap_or(0);
    let called = |target: &Target| match target {
        Target::Code(target) => after(*target),
        Target::Module(_) => 0,
    };
    let (time, skipped) = (u64::from(instruction.time), u64::from(instruction.time_skipped));
    let next = after(at + 1);
    match &instruction.op {
        Op::Jump { condition, target } => {
            let taken = time.saturating_add(if *target > at { after(*target) } else { 0 });
            match condition {
                Condition::Always => taken,
                _ => taken.max(skipped.saturating_add(next)),
            }
        }
        Op::Call { target, .. } => time.saturating_add(called(target)).saturating_add(next),
        Op::Case { table, .. } => {
            let entries = program.cases.get(*table).map_or(&[][..], Vec::as_slice);
            let longest = entries.iter().map(called).max().unwrap_or(0);
            time.saturating_add(longest).saturating_add(next)
        }
        Op::Return {
            condition: Condition::Always,
        } => time,
        _ => time.saturating_add(next),
    }
}
