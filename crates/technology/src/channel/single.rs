//! Single block: the path stops at the end of each programmed block with a motion until the operator starts the next one.
//!
//! The manual is silent; the control that it describes stops in the interpolator, so decoding, look-ahead and what is output
//! ahead go on (public: single-step mode, P-CHAN-00015 = -1).

use bahn_motion::{Drive, Interpolator, State};

use super::leads::SAME;
use crate::plc::{Script, cycle_at};

/// What is in force of single block.
#[derive(Debug, Default)]
pub(super) struct Single {
    on: bool,
    /// Distance along the path, mm, at which it can first come to a standstill: block ends before it are passed. Unknown as
    /// long as nobody has looked.
    first: Option<f64>,
    /// The operator starts in this cycle, at this time, s.
    start: Option<f64>,
    /// Starts that are over.
    starts: usize,
}

/// Cycles of braking that are looked at: the slowest axis stands long before.
const BRAKING: usize = 1_000_000;

/// Where the path would stand if it braked now.
pub(super) fn braked(mut path: Interpolator<()>) -> Interpolator<()> {
    let drive = Drive {
        hold: true,
        ..Drive::default()
    };
    for _ in 0..BRAKING {
        if path.speed_mm_s() <= 0.0 || path.cycle(&drive).state == State::Held {
            break;
        }
    }
    path
}

impl Single {
    /// What the script says of single block at a moment: whether that has changed.
    pub(super) fn switch(&mut self, script: &Script, t: f64) -> bool {
        let on = script.singles.iter().any(|range| range.contains(&t));
        let changed = on != self.on;
        if changed {
            (self.on, self.first) = (on, None);
        }
        changed
    }

    /// Whether the path has to be looked at: where it can first come to a standstill.
    pub(super) fn is_unseen(&self) -> bool {
        self.on && self.first.is_none()
    }

    /// It can first come to a standstill at this distance along it, mm.
    pub(super) fn see(&mut self, distance: f64) {
        self.first = Some(distance);
    }

    /// Takes the starts of the script up to a cycle, whose length is in s.
    pub(super) fn take_starts(&mut self, script: &Script, cycle: u64, cycle_s: f64) {
        while let Some(start) = script.starts.get(self.starts)
            && cycle_at(*start, cycle_s) <= cycle
        {
            self.starts += 1;
            // Two in a cycle are one.
            self.start = Some(*start);
        }
    }

    /// In single block the path stops at this end of a block, mm along it, if it still can.
    pub(super) fn stops_at(&self, distance: f64, backward: bool) -> bool {
        let can = |first: f64| {
            if backward {
                distance <= first + SAME
            } else {
                distance >= first - SAME
            }
        };
        self.on && self.first.is_none_or(can)
    }

    /// Whether the path stands at this end of a block, mm along it, until the next start. It may still move or have run
    /// over it, if it could not stop any more: then it does so as soon as it can.
    pub(super) fn stands_at_end(&mut self, distance: f64, backward: bool, moves: bool) -> bool {
        if !self.stops_at(distance, backward) {
            return false;
        }
        if moves {
            self.first = None;
            return false;
        }
        self.start.take().is_none()
    }

    /// A start that nothing has taken, s.
    pub(super) fn take_start(&mut self) -> Option<f64> {
        self.start.take()
    }

    /// The path turns, or begins anew: all ends of blocks count again.
    pub(super) fn all_block_ends(&mut self) {
        self.first = None;
    }
}
