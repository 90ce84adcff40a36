//! The interpreter as what a control feeds from.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_path::{Axis, BlockRef, LiveData, Placement, Position};
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

    fn placement(&self) -> Option<&Arc<Placement>> {
        self.placement()
    }

    /// The range that a block digitizes, with the height at which the stylus is lifted.
    fn range(&self, block: BlockRef) -> Option<[Position; 2]> {
        let (_, job) = self.scan().filter(|(by, _)| *by == block)?;
        let mut range = [Position::UNKNOWN; 2];
        let axes = [Axis::X, Axis::Y, Axis::Z]
            .into_iter()
            .zip(job.min.iter().zip(&job.max));
        for ((axis, (min, max)), beside) in axes.zip(job.beside) {
            let [least, greatest] = &mut range;
            least[axis] = min - beside;
            let lifted = if axis == job.tool_axis {
                job.clearance_mm
            } else {
                f64::NEG_INFINITY
            };
            greatest[axis] = max.max(lifted) - beside;
        }
        Some(range)
    }

    fn set_machine_zero(&mut self, zero: &Position) {
        self.set_machine_zero(*zero);
    }

    fn take_values(&mut self, live: &LiveData) {
        for (number, value) in &live.q_values {
            self.set_q(*number, *value);
        }
    }

    fn is_computing(&self) -> bool {
        self.is_computing()
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
