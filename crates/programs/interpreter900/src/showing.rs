//! When the reader shows what: the look-ahead its last block, the control the one that it executes.

use bahn_system900::Memory;

use crate::reader::Reader900;
use crate::shown::{block_words, state_of, words_of};

impl Reader900 {
    /// Shows what is in force in the block of a place in the order of execution.
    pub fn show_executed(&self, sequence: u64, memory: &mut Memory) {
        if let Some(state) = self.shown.of(sequence) {
            memory.show_executed(self.channel, state);
        }
    }

    /// Keeps what is in force in the block that was read last.
    pub(crate) fn note_block(&mut self) {
        let Some(memory) = &self.memory else { return };
        let words = words_of(&self.block, memory, self.channel, &self.axes, &self.run.modal);
        let state = state_of(&self.run, &self.files, &words);
        self.shown.note(self.run.sequence, state);
    }

    /// Shows the block that the look-ahead has read last.
    pub(crate) fn show_read(&mut self) {
        let Some(memory) = &mut self.memory else { return };
        if self.run.sequence == 0 || self.shown_read == self.run.sequence {
            return;
        }
        self.shown_read = self.run.sequence;
        let words = words_of(&self.block, memory, self.channel, &self.axes, &self.run.modal);
        let state = state_of(&self.run, &self.files, &words);
        memory.show_read(self.channel, &state, &block_words(&words, &self.run.modal));
    }
}
