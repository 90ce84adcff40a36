//! What is left of an element when the axes were moved away from the path.

use bahn_path::{At, Curve, OverrideLaw, PathElement, TechnologyFunction};

use super::phase::Phase;
use crate::gate::{Gate, place};

/// How far the element was executed that is taken back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Executed {
    /// The number of the element.
    pub(super) number: u64,
    /// Functions have still to be acknowledged after it.
    pub(super) late: bool,
    pub(super) phase: Phase,
    /// Its length and the distance to go, mm.
    pub(super) length: f64,
    pub(super) rest: f64,
    /// Functions along it up to this length are output, mm.
    pub(super) output_to: f64,
}

impl Executed {
    fn covered(&self) -> f64 {
        self.length - self.rest
    }

    /// What is left of the element, without the functions that are output already.
    pub(super) fn remainder(&self, mut left: PathElement) -> Option<PathElement> {
        match self.phase {
            Phase::Begin => return Some(left),
            Phase::Gate(Gate::Start) | Phase::Move => {
                let from = if self.length > 0.0 {
                    self.covered() / self.length
                } else {
                    0.0
                };
                let end = left.end;
                (left.curve, left.start, left.end) = left.curve.part(&left.start, &end, from, 1.0);
                left.end = end;
                // The spindle goes on from where it stands.
                if let OverrideLaw::Spindle(thread) = &mut left.override_law {
                    thread.orientation_deg = None;
                }
            }
            Phase::Dwell(_) | Phase::Finish => {
                left.curve = Curve::Hold;
                left.start = left.end;
                left.dwell_s = match self.phase {
                    Phase::Dwell(dwell) => dwell,
                    _ => 0.0,
                };
            }
            Phase::Gate(Gate::End) | Phase::Done | Phase::BlockEnd | Phase::Over => return None,
        }
        left.functions = self.later(left.functions);
        Some(left)
    }

    /// The functions that are still to be output, at their places on the rest of the element.
    fn later(&self, functions: Option<Box<[TechnologyFunction]>>) -> Option<Box<[TechnologyFunction]>> {
        let mut functions = functions?.into_vec();
        functions.retain(|function| match (place(function), function.at) {
            (Some(end), _) => end == Gate::End,
            (None, At::Ahead(_)) => false,
            (None, At::Length(length)) => length >= self.output_to,
            (None, _) => self.rest > 0.0,
        });
        for function in &mut functions {
            if let At::Length(length) = &mut function.at {
                *length -= self.covered();
            }
        }
        (!functions.is_empty()).then(|| functions.into_boxed_slice())
    }
}
