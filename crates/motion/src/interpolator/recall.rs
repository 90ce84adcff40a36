//! What is left of the path when the axes were moved away from it.

use bahn_path::{At, Curve, OverrideLaw, PathElement, Position, TechnologyFunction};

use super::{Interpolator, Phase};
use crate::gate::{Gate, place};
use crate::item::Item;

impl<E> Interpolator<E> {
    /// Takes back what is not executed, for the axes stand elsewhere: the path goes on from a position to
    /// where each of the elements leads, once they are given again. The rest of the element that was cut
    /// comes without the functions that are output already. The path must stand.
    pub fn recall(&mut self, position: Position) -> Vec<PathElement> {
        let rest = self.ring.current().and_then(|item| self.remainder(item));
        let mut elements: Vec<PathElement> = rest.into_iter().collect();
        elements.extend(self.ring.take_ahead().skip(1));
        self.position = position;
        self.clear();
        elements
    }

    /// What is left of the element that is executed.
    fn remainder(&self, item: &Item) -> Option<PathElement> {
        let element = &item.element;
        let covered = item.length - self.rest;
        let mut left = element.clone();
        let later = |function: &TechnologyFunction| match place(function) {
            Some(end) => end == Gate::End,
            None => match function.at {
                At::Length(length) => length >= self.output_to,
                _ => self.rest > 0.0,
            },
        };
        match self.phase {
            Phase::Begin => return Some(left),
            Phase::Gate(Gate::Start) | Phase::Move => {
                let from = if item.length > 0.0 {
                    covered / item.length
                } else {
                    0.0
                };
                (left.curve, left.start, left.end) =
                    element.curve.part(&element.start, &element.end, from, 1.0);
                left.end = element.end;
                // The spindle goes on from where it stands.
                if let OverrideLaw::Spindle(thread) = &mut left.override_law {
                    thread.orientation_deg = None;
                }
            }
            Phase::Dwell(_) | Phase::Finish => {
                left.curve = Curve::Hold;
                left.start = element.end;
                left.dwell_s = match self.phase {
                    Phase::Dwell(dwell) => dwell,
                    _ => 0.0,
                };
            }
            Phase::Gate(Gate::End) | Phase::Done | Phase::BlockEnd | Phase::Over => return None,
        }
        let functions = element
            .functions()
            .iter()
            .filter(|function| later(function))
            .cloned();
        let functions: Vec<TechnologyFunction> = functions
            .map(|mut function| {
                if let At::Length(length) = &mut function.at {
                    *length -= covered;
                }
                function
            })
            .collect();
        left.functions = (!functions.is_empty()).then(|| functions.into_boxed_slice());
        Some(left)
    }
}
