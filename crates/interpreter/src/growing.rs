//! Main programs that are still being transferred while they run [003:1640-1690].

use std::sync::Arc;

use bahn_path::BlockRef;
use bahn_program::{Block, MFunctions, Operation, Program};

use crate::Interpreter;
use crate::code::Fetched;
use crate::run::Run;

impl Interpreter {
    /// The main program has grown: a later version of it, see [`Program::more`]. After [`Step::Starved`] the run
    /// goes on with the blocks that have come.
    ///
    /// [`Step::Starved`]: bahn_path::Step::Starved
    pub fn grow(&mut self, program: Arc<Program>) {
        let had_begun = self.code.program(0).is_some_and(|main| main.begin().is_some());
        if !had_begun && self.run.pen.sequence == 0 {
            // Only now it is known what it is measured in.
            self.run = Run::new(&self.settings, program.unit());
        }
        self.code.grow(program);
        self.starved = false;
    }

    /// Whether what a block needs has not come yet: the block itself and the next one, which may round its corner,
    /// a label it goes to, the subprograms of a contour cycle.
    #[cold]
    pub(crate) fn must_wait(&mut self, at: BlockRef) -> bool {
        self.starved = self.needs_more(at);
        self.starved
    }

    fn needs_more(&mut self, at: BlockRef) -> bool {
        if at.program != 0 {
            return false;
        }
        let is_last_of_chunk = (at.block + 1).is_multiple_of(Program::CHUNK_SIZE);
        let Some(Fetched { block, next, .. }) = self.code.block(at.program, at.block) else {
            return true;
        };
        if next.is_none() && !is_last_of_chunk {
            return true;
        }
        let label = match block.operation {
            Operation::Jump { label, .. } | Operation::CallLabel { label, .. } => label,
            _ => 0,
        };
        let calls_cycle = self.run.modal.cycle_after_each_block || calls_cycle(block);
        // Its subprograms are executed ahead, which may be anywhere.
        let contours = calls_cycle && self.run.modal.cycle.is_contour_cycle();
        let known = |main: &Arc<Program>| label == 0 || main.label(label).is_some();
        contours || !self.code.program(0).is_some_and(known)
    }
}

fn calls_cycle(block: &Block) -> bool {
    let calls = |m: &MFunctions| m.contains(99) || m.contains(89);
    match &block.operation {
        Operation::CycleCall(_) => true,
        Operation::Motion(motion) => calls(&motion.m),
        Operation::Stop(m) | Operation::Miscellaneous(m) => calls(m),
        _ => false,
    }
}
