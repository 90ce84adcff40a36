//! All that changes while a program runs, but for its parameters: a state to go back to is a copy of it.

use std::collections::VecDeque;

use bahn_path::parallel::Side;
use bahn_path::{
    At, Axis, Barrier, BlockRef, Curve, FeedRate, Function, OverrideLaw, PathElement, PerAxis, Position,
    Synchronisation, TechnologyFunction,
};
use bahn_reader::ProgramError;

use crate::contour::Contour;
use crate::corner::Insert;
use crate::correction::Move;
use crate::item::Item;
use crate::modal::Modal;
use crate::refusal::{Refusal, wrong};

/// Why there is nothing to go on with.
#[derive(Clone, Debug)]
pub(crate) enum Ended {
    Finished,
    Failed(Box<ProgramError>),
}

/// A file that is executed, and where.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// Index among the files of the run.
    pub file: usize,
    /// The line that is executed next, from 1.
    pub line: u32,
    /// The block that stands there or comes next after it.
    pub block: u32,
    /// Loops of M24: the line of each, and how often it jumps still.
    pub loops: Vec<(u32, u32)>,
    /// The block that has called the cycle after it.
    pub called_at: u32,
}

/// The state of a run.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub frames: Vec<Frame>,
    /// How many blocks were executed so far.
    pub sequence: u64,
    /// The block that is executed, or was last.
    pub at: BlockRef,
    /// End of the last element that was handed out.
    pub position: Position,
    /// End of the last element that was made.
    pub here: Position,
    pub modal: Modal,
    /// What waits for what comes after it.
    pub contour: Contour,
    pub queue: VecDeque<Item>,
    pub waiting: Option<Barrier>,
    /// M22: the line to jump to where the PLC says so, once the barrier is left.
    pub skip: Option<u32>,
    /// The block of M0 that has stopped the run last.
    pub stopped: Option<BlockRef>,
    pub ended: Option<Ended>,
    /// Blocks since something moved.
    pub idle: u32,
    /// The shifts that the display leaves out.
    pub shown: PerAxis<f64>,
    /// Values are to be taken from the memory anew.
    pub is_stale: bool,
    /// The first block was looked for.
    pub has_begun: bool,
    /// Somebody has said where it begins: P8801 does not.
    pub is_placed: bool,
    /// The number of the block that it starts at, 0 for the first one, where a control says it: P8801 counts for others.
    pub start: Option<u32>,
}

/// So many blocks in a row without a movement are no program.
const IDLE_MAX: u32 = 100_000;
/// Cycles within cycles (inferred).
const DEPTH_MAX: usize = 10;

impl Run {
    pub fn at(position: Position) -> Run {
        Run {
            frames: vec![Frame::new(0)],
            sequence: 0,
            at: BlockRef::default(),
            position,
            here: position,
            modal: Modal::new(),
            contour: Contour::default(),
            queue: VecDeque::new(),
            waiting: None,
            skip: None,
            stopped: None,
            ended: None,
            idle: 0,
            shown: PerAxis::default(),
            is_stale: true,
            has_begun: false,
            is_placed: false,
            start: None,
        }
    }

    /// Calls a file.
    pub fn call(&mut self, file: usize) -> Result<(), Refusal> {
        if self.frames.len() > DEPTH_MAX {
            return wrong(format!("more than {DEPTH_MAX} cycles within one another"));
        }
        if let Some(caller) = self.frames.last_mut() {
            caller.called_at = self.at.block;
        }
        self.frames.push(Frame::new(file));
        Ok(())
    }

    /// Counts a block; so many without a movement are a fault.
    pub fn count(&mut self) -> Result<(), Refusal> {
        self.sequence += 1;
        self.idle += 1;
        match self.idle > IDLE_MAX {
            true => wrong("the program goes round and round without a movement"),
            false => Ok(()),
        }
    }

    /// A movement from where the path has come to.
    pub fn push(&mut self, curve: Curve, end: Position, feed: FeedRate, extra: Extra) -> Result<(), Refusal> {
        let mut element = PathElement::new(self.at, self.sequence, curve, [self.here, end], feed);
        if self.modal.override_off {
            element.override_law = OverrideLaw::Disabled;
        }
        if let Some(law) = extra.law {
            element.override_law = law;
        }
        let mut functions = extra.functions;
        if !matches!(curve, Curve::Hold) {
            self.show_shifts(&mut functions);
        }
        element.functions = (!functions.is_empty()).then(|| functions.into_boxed_slice());
        element.dwell_s = extra.dwell_s;
        if !matches!(curve, Curve::Hold) || extra.dwell_s > 0.0 {
            self.idle = 0;
        }
        self.here = end;
        let modal = &self.modal;
        let side = modal.side_of_path();
        if side == Side::Off && extra.insert.is_none() && self.contour.is_idle(&modal.contour) {
            self.queue.push_back(Item::Element(element));
            return Ok(());
        }
        let item = Move {
            element,
            plane: modal.plane,
            side,
            radius: modal.tool_radius,
        };
        self.contour
            .push(item, extra.insert, &modal.contour, &mut self.queue)
    }

    /// The display of an axis follows its shifts with the first movement under them.
    fn show_shifts(&mut self, functions: &mut Vec<TechnologyFunction>) {
        let mut first = 0;
        for axis in Axis::ALL {
            let (by, logical) = (self.modal.display_shift(axis), self.modal.logical[axis]);
            if by != self.shown[axis] && logical > 0 {
                self.shown[axis] = by;
                let shift = Function::Shift { logical, by };
                functions.insert(
                    first,
                    TechnologyFunction::new(shift, At::Start, Synchronisation::Mos),
                );
                first += 1;
            }
        }
    }

    /// Nothing moves: a dwell, functions, or a stop of the path.
    pub fn hold(&mut self, extra: Extra) -> Result<(), Refusal> {
        self.push(Curve::Hold, self.here, FeedRate::Rapid, extra)
    }

    pub fn barrier(&mut self, barrier: Barrier) -> Result<(), Refusal> {
        self.idle = 0;
        self.contour
            .barrier(barrier, &self.modal.contour, &mut self.queue)
    }

    /// The program ends.
    pub fn finish(&mut self) -> Result<(), Refusal> {
        self.contour.flush(&self.modal.contour, &mut self.queue)?;
        self.ended = Some(Ended::Finished);
        Ok(())
    }
}

/// What goes with an element.
#[derive(Debug, Default)]
pub(crate) struct Extra {
    pub functions: Vec<TechnologyFunction>,
    pub dwell_s: f64,
    pub law: Option<OverrideLaw>,
    /// G12: what is put into the corner after it.
    pub insert: Option<Insert>,
}

impl Frame {
    pub fn new(file: usize) -> Frame {
        Frame {
            file,
            line: 1,
            block: 1,
            loops: Vec::new(),
            called_at: 0,
        }
    }
}
