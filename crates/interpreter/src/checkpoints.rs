//! States of a run to go back to.

use std::collections::VecDeque;

use bahn_path::{Barrier, BlockRef, Frame, Position};
use bahn_program::Operation;

use crate::run::Run;
use crate::{Ended, Interpreter};

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
    pub fn states(&self) -> impl Iterator<Item = &Checkpoint> {
        self.states.iter()
    }

    /// States that are kept.
    pub fn count(&self) -> usize {
        self.states.len()
    }
}

impl Interpreter {
    /// Keeps the state before each block whose elements are on their way, for [`Interpreter::go_back`].
    pub fn keep_checkpoints(&mut self) {
        self.kept = Some(Kept::default());
    }

    /// Forgets the states before blocks that come before the one with a sequence: it is executed.
    pub fn forget_before(&mut self, sequence: u64) {
        if let Some(kept) = &mut self.kept {
            kept.forget_before(sequence);
        }
    }

    /// Goes back to the latest kept state of which something is so, if there is one; the kept states are
    /// forgotten.
    pub fn go_back(&mut self, so: impl Fn(&Checkpoint) -> bool) {
        if let Some(state) = self.kept.as_mut().and_then(|kept| kept.take(so)) {
            self.restore(&state);
        }
    }

    /// A Q parameter after the last block that was read; 0 for one that the model does not have.
    pub fn q_value(&self, number: u16) -> f64 {
        self.run.numbers.q.get(number).unwrap_or(0.0)
    }

    /// A Q parameter before the block of a sequence, as far as states are kept; 0 for one that the model does not have.
    pub fn q_value_at(&self, number: u16, sequence: u64) -> f64 {
        let before = self
            .state_before(sequence)
            .map(|state| state.run.numbers.q.get(number).unwrap_or(0.0));
        before.unwrap_or_else(|| self.q_value(number))
    }

    /// The transformations before the block of a sequence, as far as states are kept, else after the last block that was
    /// read.
    pub fn frame_at(&self, sequence: Option<u64>) -> Frame {
        let before = sequence.and_then(|sequence| self.state_before(sequence));
        before.map_or(self.run.modal.frame, |state| state.run.modal.frame)
    }

    /// The block with which a run goes on from a sequence, as [`Interpreter::go_back`] finds it.
    pub fn block_at(&self, sequence: u64) -> BlockRef {
        self.state_before(sequence)
            .map_or_else(|| self.at(), Checkpoint::at)
    }

    /// Program section repeats that are under way before the block of a sequence: the CALL LBL block, and how many are
    /// left [003:3762].
    pub fn repeats_at(&self, sequence: u64) -> impl Iterator<Item = (BlockRef, u32)> + '_ {
        let run = self.state_before(sequence).map_or(&self.run, |state| &*state.run);
        run.at.repeats()
    }

    fn state_before(&self, sequence: u64) -> Option<&Checkpoint> {
        let mut states = self.kept.as_ref()?.states.iter();
        states.rfind(|state| state.sequence() <= sequence)
    }

    /// States that are kept, to be seen that they do not pile up.
    pub fn checkpoints(&self) -> usize {
        self.kept.as_ref().map_or(0, Kept::count)
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
