//! Where the path is in backward motion.

use std::collections::VecDeque;

use bahn_path::{Barrier, BlockRef, ElementSource, LiveData, Step};

use super::order::OrderId;
use super::track::Track;

#[derive(Debug, Default)]
pub(super) struct Backward {
    pub(super) back: Option<Back>,
}

/// The path goes back.
#[derive(Debug)]
pub(super) struct Back {
    /// The element on which it turned, and how much of that was executed, mm.
    pub(super) from: u64,
    pub(super) along: f64,
    /// Number of the backward motion that the interpolator is given next: the first is 1.
    pub(super) fed: u64,
    /// The place to which the path has come back, and the one whose functions were looked at last.
    pub(super) reached: u64,
    pub(super) seen: u64,
    /// Functions that are to be output at that place, and those that are waited for.
    pub(super) queue: VecDeque<OrderId>,
    pub(super) gate: Vec<OrderId>,
    /// In single block it stands there.
    pub(super) at_limit: bool,
}

impl Backward {
    pub(super) fn is_on(&self) -> bool {
        self.back.is_some()
    }
}

/// Gives the interpolator the elements of the track from one on back.
pub(super) struct FeedBack<'a> {
    pub(super) track: &'a Track,
    pub(super) back: &'a mut Back,
}

impl ElementSource for FeedBack<'_> {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        let number = self.back.element(self.back.fed);
        let leg = number.and_then(|number| self.track.leg(number));
        let Some(leg) = leg else {
            return Step::Barrier(Barrier::Acknowledge {
                block: BlockRef::default(),
            });
        };
        let along = if self.back.fed == 1 {
            self.back.along
        } else {
            leg.length
        };
        let element = leg.rest(along, true).element(self.back.fed);
        self.back.fed += 1;
        Step::Element(element)
    }

    fn resume(&mut self, _: LiveData) {}
}

impl Back {
    /// The element that is so many back.
    pub(super) fn element(&self, back: u64) -> Option<u64> {
        (self.from + 1).checked_sub(back)
    }

    /// It cannot go on where it is.
    pub(super) fn waits(&self) -> bool {
        !self.queue.is_empty() || !self.gate.is_empty() || self.at_limit
    }
}
