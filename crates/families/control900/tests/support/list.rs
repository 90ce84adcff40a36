//! A program in no language at all: lines to places, with functions before and after.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_path::{
    At, Axis, BlockRef, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position, Step,
    Synchronisation, TechnologyFunction,
};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, ProgramError, Reader, Warning};

/// A line: its block number is ten times its place from 1 on.
#[derive(Clone, Debug, Default)]
pub struct Line {
    pub to: Vec<(Axis, f64)>,
    /// mm/min; rapid without.
    pub feed: Option<f64>,
    pub functions: Vec<(Function, At, Synchronisation)>,
}

impl Line {
    /// A line with a feed.
    pub fn to(to: &[(Axis, f64)], feed: f64) -> Line {
        Line {
            to: to.to_vec(),
            feed: Some(feed),
            functions: Vec::new(),
        }
    }

    /// With a function.
    pub fn with(self, m: u16, at: At, how: Synchronisation) -> Line {
        self.says(Function::M(m), at, how)
    }

    /// With a function that is none of M.
    pub fn says(mut self, function: Function, at: At, how: Synchronisation) -> Line {
        self.functions.push((function, at, how));
        self
    }
}

/// Lines that are gone along one after the other.
#[derive(Clone)]
pub struct Lines {
    lines: Vec<Line>,
    next: u32,
    position: Position,
    executed: u64,
}

impl Lines {
    pub fn boxed(lines: &[Line]) -> Box<dyn Reader> {
        Box::new(Lines {
            lines: lines.to_vec(),
            next: 0,
            position: Position::ZERO,
            executed: 0,
        })
    }
}

impl ElementSource for Lines {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Box<ProgramError>> {
        let Some(line) = self.lines.get(self.next as usize).cloned() else {
            return Step::End;
        };
        let start = self.position;
        for (axis, to) in &line.to {
            self.position[*axis] = *to;
        }
        self.next += 1;
        self.executed += 1;
        let feed = line.feed.map_or(FeedRate::Rapid, FeedRate::Programmed);
        let curve = if line.to.is_empty() {
            Curve::Hold
        } else {
            Curve::Line
        };
        let block = BlockRef {
            program: 0,
            block: self.next * 10,
        };
        let mut element = PathElement::new(block, self.executed, curve, [start, self.position], feed);
        let functions: Vec<_> = line
            .functions
            .iter()
            .map(|(function, at, how)| TechnologyFunction::new(function.clone(), *at, *how))
            .collect();
        element.functions = (!functions.is_empty()).then(|| functions.into());
        Step::Element(element)
    }

    fn resume(&mut self, _: LiveData) {}
}

impl Reader for Lines {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, _: u16) -> Option<&Arc<Program>> {
        None
    }

    fn at(&self) -> BlockRef {
        BlockRef {
            program: 0,
            block: (self.next + 1) * 10,
        }
    }

    fn blocks_executed(&self) -> u64 {
        self.executed
    }

    fn position(&self) -> Position {
        self.position
    }

    fn take_warnings(&mut self) -> Vec<Warning> {
        Vec::new()
    }

    fn goto(&mut self, block: u32) {
        self.next = (block / 10).saturating_sub(1);
    }

    fn keep_checkpoints(&mut self) {}

    fn forget_before(&mut self, _: u64) {}

    fn go_back(&mut self, _: &dyn Fn(Mark) -> bool) {}

    fn block_at(&self, _: u64) -> BlockRef {
        self.at()
    }

    fn retry(&mut self) {}

    fn relocate(&mut self, position: &Position) {
        self.position = *position;
    }

    fn stand_at(&mut self, position: &Position) {
        self.position = *position;
    }

    fn allow(&mut self, _: u32) {}

    fn set_machine_rules(&mut self, _: MachineRules) {}

    fn set_interrupt(&mut self, _: Arc<AtomicBool>) {}
}
