//! Single block: the path stops at the end of each programmed block with a motion until the operator starts the next one.
//!
//! The manual is silent; the control that it describes stops in the interpolator, so decoding, look-ahead and what is output
//! ahead go on (public: single-step mode, P-CHAN-00015 = -1).

use bahn_motion::{Drive, State};

use super::Channel;
use super::leads::SAME;
use crate::plc::cycle_at;
use crate::report::Warning;

/// What is in force of single block.
#[derive(Debug, Default)]
pub(super) struct Single {
    on: bool,
    /// Way along the path, mm, at which it can first come to a standstill: block ends before it are passed. Unknown as
    /// long as nobody has looked.
    first: Option<f64>,
    /// The operator starts in this cycle, at this time, s.
    start: Option<f64>,
    /// Starts that are over.
    starts: usize,
}

/// Cycles of braking that are looked at: the slowest axis stands long before.
const BRAKING: usize = 1_000_000;

impl Channel<'_> {
    /// What the script says of single block at this moment.
    pub(super) fn follow_single(&mut self, t: f64) {
        let Some(script) = self.plc.script() else { return };
        let on = script.singles.iter().any(|range| range.contains(&t));
        if on != self.single.on {
            (self.single.on, self.single.first) = (on, None);
            self.open_to = self.cursor.0;
        }
        if self.single.on && self.single.first.is_none() {
            self.single.first = Some(self.braked());
        }
        while let Some(start) = script.starts.get(self.single.starts)
            && cycle_at(*start, self.cycle_s) <= self.cycle
        {
            self.single.starts += 1;
            // Two in a cycle are one.
            self.single.start = Some(*start);
        }
    }

    /// Where the path would stand if it braked now: the way along it, mm.
    fn braked(&self) -> f64 {
        let mut path = self.path.clone();
        let drive = Drive {
            hold: true,
            ..Drive::default()
        };
        for _ in 0..BRAKING {
            if path.speed_mm_s() <= 0.0 || path.cycle(&drive).state == State::Held {
                break;
            }
        }
        self.way_of(&path)
    }

    /// In single block the path stops at this end of a block, if it still can.
    pub(super) fn stops_at(&self, place: u64, backward: bool) -> bool {
        let way = self.track.way(place);
        let can = |first: f64| {
            if backward {
                way <= first + SAME
            } else {
                way >= first - SAME
            }
        };
        self.single.on && self.single.first.is_none_or(can)
    }

    /// Whether the path stands at this end of a block until the next start. It may have run over it, if it could not
    /// stop any more: then it does so as soon as it can.
    pub(super) fn stands_at_end(&mut self, place: u64, backward: bool, run_over: bool) -> bool {
        if !self.stops_at(place, backward) {
            return false;
        }
        if !self.still || run_over {
            self.single.first = None;
            return false;
        }
        self.single.start.take().is_none()
    }

    /// A start while the path does not stand at the end of a block has no effect.
    pub(super) fn drop_start(&mut self) {
        if let Some(start) = self.single.start.take() {
            self.record.warnings.push(Warning {
                message: format!(
                    "the start at {start} s has no effect: the path does not stand at the end of a block"
                ),
                program: self.program.clone(),
                block: self.track.block_before(self.reached).to_string(),
            });
        }
    }

    /// The path turns, or begins anew: all ends of blocks count again.
    pub(super) fn all_block_ends(&mut self) {
        self.single.first = None;
    }
}
