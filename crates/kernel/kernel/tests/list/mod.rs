//! A program in no language at all: places of X and Y, each with the function that goes out before it; it may stop, or probe.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_path::{
    At, Axis, Barrier, BlockRef, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position,
    Step, Synchronisation, TechnologyFunction,
};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, ProgramError, Reader, Warning};

/// 50 mm/s.
const FEED_MM_MIN: f64 = 3000.0;

/// The program stops before the place.
pub const STOP: u16 = 0;
/// The place is probed to.
pub const PROBE: u16 = 1;
/// 10 mm/s.
const PROBING_MM_MIN: f64 = 600.0;

/// Places that are gone to one after the other.
#[derive(Clone)]
pub struct Places {
    places: Vec<(f64, f64, Option<u16>)>,
    next: u32,
    position: Position,
    /// It waits for an answer.
    waits: Option<Barrier>,
}

impl Places {
    /// From the datum on. No program knows where the axis of the magazine is.
    pub fn new(places: &[(f64, f64, Option<u16>)]) -> Places {
        let mut position = Position::ZERO;
        position[Axis::A] = f64::NAN;
        Places {
            places: places.to_vec(),
            next: 0,
            position,
            waits: None,
        }
    }
}

impl ElementSource for Places {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Box<ProgramError>> {
        if let Some(barrier) = self.waits {
            return Step::Barrier(barrier);
        }
        let Some((x, y, function)) = self.places.get(self.next as usize).copied() else {
            return Step::End;
        };
        let (start, block) = (self.position, self.at());
        match function {
            Some(STOP) => {
                // It goes on to the place.
                self.places[self.next as usize].2 = None;
                self.waits = Some(Barrier::Stop { block });
                return self.next();
            }
            Some(PROBE) => {
                let mut to = start;
                (to[Axis::X], to[Axis::Y]) = (x, y);
                self.next += 1;
                self.waits = Some(Barrier::Probe {
                    block,
                    from: start,
                    to,
                    feed_mm_min: PROBING_MM_MIN,
                    stylus_radius: 0.0,
                });
                return self.next();
            }
            _ => {}
        }
        (self.position[Axis::X], self.position[Axis::Y]) = (x, y);
        self.next += 1;
        let (ends, feed) = ([start, self.position], FeedRate::Programmed(FEED_MM_MIN));
        let mut element = PathElement::new(block, self.next.into(), Curve::Line, ends, feed);
        let out = |code| TechnologyFunction::new(Function::M(code), At::Start, Synchronisation::MvsSvs);
        element.functions = function.map(|code| [out(code)].into());
        Step::Element(element)
    }

    fn resume(&mut self, live: LiveData) {
        self.waits = None;
        if let Some(touch) = live.touch {
            self.position = touch.position;
        }
    }
}

impl Reader for Places {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, _: u16) -> Option<&Arc<Program>> {
        None
    }

    fn at(&self) -> BlockRef {
        BlockRef {
            program: 0,
            block: self.next,
        }
    }

    fn blocks_executed(&self) -> u64 {
        self.next.into()
    }

    fn position(&self) -> Position {
        self.position
    }

    fn take_warnings(&mut self) -> Vec<Warning> {
        Vec::new()
    }

    fn goto(&mut self, block: u32) {
        self.next = block;
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
