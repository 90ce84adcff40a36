//! Main programs that are still being transferred while they run [003:1640-1690].
//!
//! Decision: A block of a program that is still being transferred is executed when the next one has begun; a label
//! ahead is waited for, a contour cycle waits for the whole program
//!
//! Decision: In a program that is transferred while it runs labels stand ahead only, on all models; what the manual
//! of the TNC 360 forbids beside that is forbidden there only (also `parameters/src/limits.rs`)

use std::sync::Arc;

use bahn_parameters::MessageId;
use bahn_path::BlockRef;
use bahn_program::{Block, MFunctions, Operation, Program};

use crate::Interpreter;
use crate::checkpoints::Kept;
use crate::code::Fetched;
use crate::error::Fault;
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
            let at = std::mem::take(&mut self.run.at);
            self.run = Run::new(&self.settings, program.unit());
            self.run.at = at;
        }
        self.code.grow(program);
        self.starved = false;
    }

    /// The main program is transferred while it runs.
    pub fn is_transferred(&self) -> bool {
        self.settings.transferred
    }

    /// The run waits for blocks that have not come yet.
    pub fn is_starved(&self) -> bool {
        self.starved
    }

    /// The first block of the main program that may still be executed, also when the run goes back: those before it are not
    /// needed any more.
    pub fn needs_from(&self) -> u32 {
        let kept = self.kept.iter().flat_map(Kept::states);
        let kept = kept.map(|state| state.run.at.in_main()).min();
        let next = self.run.at.in_main();
        kept.map_or(next, |kept| kept.min(next))
    }

    /// A label of a main program that is transferred; those after the block that goes there are erased
    /// *(inferred)*, whether they are still known or not.
    pub(crate) fn label_ahead(&self, label: u16) -> Option<Result<u32, Fault>> {
        let at = self.run.at.block_ref();
        if !self.settings.transferred || at.program != 0 || label == 0 {
            return None;
        }
        let main = self.code.program(0)?;
        let missing = || {
            let detail = format!("there is no LBL {label} after the block");
            Fault::new(MessageId::LabelNumberNotAllocated, detail)
        };
        Some(main.label_after(label, at.block).ok_or_else(missing))
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
        let after = self.settings.transferred;
        let known = |main: &Arc<Program>| {
            let found = match after {
                true => main.label_after(label, at.block),
                false => main.label(label),
            };
            label == 0 || found.is_some()
        };
        contours || !self.code.program(0).is_some_and(known)
    }
}

fn calls_cycle(block: &Block) -> bool {
    let calls = |m: &MFunctions| m.contains(99) || m.contains(89);
    let called = matches!(block.operation, Operation::CycleCall(_));
    called || block.operation.m().is_some_and(calls)
}
