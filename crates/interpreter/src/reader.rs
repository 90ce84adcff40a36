//! The interpreter as what a control feeds from.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_path::{BlockRef, Position};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, Reader, Warning};

use crate::Interpreter;

impl Interpreter {
    /// The reader as an interpreter, for what only programs of a TNC have: Q parameters, tools, cycles. `None` for a
    /// program in another language.
    pub fn of(reader: &dyn Reader) -> Option<&Interpreter> {
        (reader as &dyn Any).downcast_ref()
    }

    /// The same, to be changed.
    pub fn of_mut(reader: &mut dyn Reader) -> Option<&mut Interpreter> {
        (reader as &mut dyn Any).downcast_mut()
    }
}

impl Reader for Interpreter {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, index: u16) -> Option<&Arc<Program>> {
        self.program(index)
    }

    fn at(&self) -> BlockRef {
        self.at()
    }

    fn blocks_executed(&self) -> u64 {
        self.blocks_executed()
    }

    fn position(&self) -> Position {
        self.position()
    }

    fn take_warnings(&mut self) -> Vec<Warning> {
        self.take_warnings()
    }

    fn goto(&mut self, block: u32) {
        self.goto(block);
    }

    fn keep_checkpoints(&mut self) {
        self.keep_checkpoints();
    }

    fn forget_before(&mut self, sequence: u64) {
        self.forget_before(sequence);
    }

    fn go_back(&mut self, so: &dyn Fn(Mark) -> bool) {
        self.go_back(|checkpoint| {
            so(Mark {
                sequence: checkpoint.sequence(),
                at: checkpoint.at(),
            })
        });
    }

    fn block_at(&self, sequence: u64) -> BlockRef {
        self.block_at(sequence)
    }

    fn retry(&mut self) {
        self.retry();
    }

    fn relocate(&mut self, position: &Position) {
        self.relocate(position);
    }

    fn stand_at(&mut self, position: &Position) {
        self.stand_at(position);
    }

    fn allow(&mut self, work: u32) {
        self.allow(work);
    }

    fn set_machine_rules(&mut self, rules: MachineRules) {
        self.settings.rules.machine = rules;
    }

    fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.set_interrupt(flag);
    }
}
