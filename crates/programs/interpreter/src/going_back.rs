//! What a run was before blocks that are still on their way, and back to them.

use bahn_path::{BlockRef, Frame};

use crate::Interpreter;
use crate::checkpoints::{Checkpoint, Kept};

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
        let mut states = self.kept.as_ref()?.states();
        states.rfind(|state| state.sequence() <= sequence)
    }

    /// States that are kept, to be seen that they do not pile up.
    pub fn checkpoints(&self) -> usize {
        self.kept.as_ref().map_or(0, Kept::count)
    }
}
