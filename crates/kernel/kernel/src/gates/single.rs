//! Single block: the path stops at the end of each programmed block with a motion until the operator starts the next one.
//!
//! The manual is silent; the control that it describes stops in the interpolator, so decoding, look-ahead and what is output
//! ahead go on (public: single-step mode, P-CHAN-00015 = -1).
//!
//! Decision: In single block the path stops at the end of each programmed block with a motion, and what stands in the
//! blocks after it goes out with the start of the next; acknowledgements, late functions and what is output ahead go
//! on

use super::held::SAME_MM;

/// What is in force of single block.
#[derive(Debug, Default)]
pub struct SingleBlock {
    on: bool,
    /// Distance along the path, mm, at which it can first come to a standstill: block ends before it are passed. Unknown as
    /// long as nobody has looked.
    first_mm: Option<f64>,
    /// The operator starts in this cycle, at this time, s.
    start_s: Option<f64>,
}

impl SingleBlock {
    /// Single block is on or off now: whether that has changed.
    pub fn switch(&mut self, on: bool) -> bool {
        let changed = on != self.on;
        if changed {
            (self.on, self.first_mm) = (on, None);
        }
        changed
    }

    /// Whether the path has to be looked at: where it can first come to a standstill.
    pub fn is_unseen(&self) -> bool {
        self.on && self.first_mm.is_none()
    }

    /// It can first come to a standstill at this distance along it, mm.
    pub fn see(&mut self, distance: f64) {
        self.first_mm = Some(distance);
    }

    /// The operator starts in this cycle, at this time, s. Two in a cycle are one.
    pub fn start(&mut self, at_s: f64) {
        self.start_s = Some(at_s);
    }

    /// In single block the path stops at this end of a block, mm along it, if it still can.
    pub fn stops_at(&self, distance: f64, backward: bool) -> bool {
        let can = |first: f64| {
            if backward {
                distance <= first + SAME_MM
            } else {
                distance >= first - SAME_MM
            }
        };
        self.on && self.first_mm.is_none_or(can)
    }

    /// Whether the path stands at this end of a block, mm along it, until the next start. It may still move or have run
    /// over it, if it could not stop any more: then it does so as soon as it can.
    pub fn stands_at_end(&mut self, distance: f64, backward: bool, moves: bool) -> bool {
        if !self.stops_at(distance, backward) {
            return false;
        }
        if moves {
            self.first_mm = None;
            return false;
        }
        self.start_s.take().is_none()
    }

    /// A start that nothing has taken, s.
    pub fn take_start(&mut self) -> Option<f64> {
        self.start_s.take()
    }

    /// The path turns, or begins anew: all ends of blocks count again.
    pub fn all_block_ends(&mut self) {
        self.first_mm = None;
    }
}
