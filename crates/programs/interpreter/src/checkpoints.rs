//! States of a run to go back to.
//!
//! Decision: States to go back to are kept of blocks whose elements are on their way and of no others
//!
//! Decision: A Q parameter that is recorded is that of the block that is executed, from the states kept for going
//! back

use std::collections::VecDeque;

use bahn_path::{Barrier, BlockRef, Position};
use bahn_program::Operation;

use crate::error::ProgramError;
use crate::run::Run;

/// How a run came to its end.
#[derive(Clone, Debug)]
pub(crate) enum Ended {
    Finished,
    Failed(Box<ProgramError>),
}

/// The state of a run at a block: Q parameters, calls, repeats, pole, transformations, tool.
#[derive(Clone)]
pub struct Checkpoint {
    pub(crate) run: Box<Run>,
    pub(crate) ended: Option<Ended>,
    pub(crate) waiting: Option<Barrier>,
    pub(crate) position: Position,
}

impl Checkpoint {
    /// Count of executed blocks up to and with the block that is executed next: the sequence of its elements.
    pub fn sequence(&self) -> u64 {
        self.run.pen.sequence + 1
    }

    /// The block that is executed next.
    pub fn at(&self) -> BlockRef {
        self.run.at.block_ref()
    }
}

/// States before the blocks whose elements are on their way. Blocks that left nothing have none, so a loop
/// without movements does not pile them up.
#[derive(Clone, Default)]
pub(crate) struct Kept {
    states: VecDeque<Checkpoint>,
    /// Sequence of the last element that was handed out.
    handed: u64,
}

impl Kept {
    /// Keeps the state before the next block. The queue of finished elements is empty.
    pub fn keep(&mut self, run: &mut Run, position: Position) {
        // Nobody goes back to a block of which nothing is on its way.
        if let Some(last) = self.states.back().map(Checkpoint::sequence)
            && last > self.handed
            && !run.pen.contour.holds_from(last)
        {
            self.states.pop_back();
        }
        let reported = std::mem::take(&mut run.reported);
        self.states.push_back(Checkpoint {
            run: Box::new(run.clone()),
            ended: None,
            waiting: None,
            position,
        });
        run.reported = reported;
    }

    pub fn handed(&mut self, sequence: u64) {
        self.handed = sequence;
    }

    /// Forgets the states before blocks that come before the one with a sequence.
    pub fn forget_before(&mut self, sequence: u64) {
        while self.states.get(1).is_some_and(|next| next.sequence() <= sequence) {
            self.states.pop_front();
        }
    }

    /// Takes the latest state of which something is so; forgets all.
    pub fn take(&mut self, so: impl Fn(&Checkpoint) -> bool) -> Option<Checkpoint> {
        let found = self.states.iter().rposition(so);
        let state = found.and_then(|at| self.states.swap_remove_back(at));
        self.states.clear();
        state
    }

    /// What is kept, in its order.
    pub fn states(&self) -> impl DoubleEndedIterator<Item = &Checkpoint> {
        self.states.iter()
    }

    /// States that are kept.
    pub fn count(&self) -> usize {
        self.states.len()
    }
}

/// Whether a block can move or output something.
pub(crate) fn acts(operation: &Operation) -> bool {
    !matches!(
        operation,
        Operation::Calculate { .. }
            | Operation::Formula { .. }
            | Operation::Jump { .. }
            | Operation::Label(_)
            | Operation::CallLabel { .. }
            | Operation::Comment(_)
            | Operation::Begin(_)
            | Operation::End(_)
            | Operation::CircleCentre(_)
    )
}
