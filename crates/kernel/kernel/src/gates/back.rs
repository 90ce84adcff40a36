//! Where the path is in backward motion.

use std::collections::VecDeque;

use bahn_path::{Barrier, BlockRef, ElementSource, LiveData, Step};

use super::functions::Functions;
use super::places::Places;

/// The path goes back.
#[derive(Debug)]
pub struct Back {
    /// The element on which it turned.
    pub from: u64,
    /// How much of that was executed, mm.
    pub along_mm: f64,
    /// Number of the backward motion that the interpolator is given next: the first is 1.
    pub fed: u64,
    /// The place to which the path has come back.
    pub reached: u64,
    /// The place whose functions were looked at last.
    pub seen: u64,
    /// In single block it stands there.
    pub at_limit: bool,
}

/// The functions that go out again, on the way back and after it.
#[derive(Debug)]
pub struct Again<T> {
    /// Those that are to be output at the place that was looked at last.
    pub queue: VecDeque<T>,
    /// Those that are waited for there.
    pub gate: Vec<T>,
    /// Those that the path comes over when it has turned forward, with their new tickets.
    pub renewed: Vec<(T, T)>,
}

impl<T: Copy> Again<T> {
    /// There are none.
    pub fn new() -> Again<T> {
        Again {
            queue: VecDeque::new(),
            gate: Vec::new(),
            renewed: Vec::new(),
        }
    }

    /// Room for so many.
    pub fn make_room(&mut self, count: usize) {
        self.queue.reserve(count.saturating_sub(self.queue.len()));
        self.gate.reserve(count.saturating_sub(self.gate.len()));
        self.renewed.reserve(count.saturating_sub(self.renewed.len()));
    }

    /// The way back begins.
    pub fn clear(&mut self) {
        self.queue.clear();
        self.gate.clear();
    }

    /// Whether the path stands for one on its way back.
    pub fn is_waited_for(&self) -> bool {
        !self.queue.is_empty() || !self.gate.is_empty()
    }

    /// The function for which the next one cannot be output now.
    pub fn blocker<F: Functions<Ticket = T>>(&self, family: &F) -> Option<T>
    where
        T: Ord,
    {
        let next = self.queue.front();
        next.and_then(|ticket| family.blocker(*ticket))
    }
}

/// Gives the interpolator the elements of the track from one on back.
pub struct FeedBack<'a, T, O> {
    /// The path that is driven backwards.
    pub track: &'a Places<T, O>,
    /// Where it is on it.
    pub back: &'a mut Back,
}

impl<T: Copy, O> ElementSource for FeedBack<'_, T, O> {
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
            self.back.along_mm
        } else {
            leg.length_mm
        };
        let element = leg.rest(along, true).element(self.back.fed);
        self.back.fed += 1;
        Step::Element(element)
    }

    fn resume(&mut self, _: LiveData) {}
}

impl Back {
    /// The element that is so many back.
    pub fn element(&self, back: u64) -> Option<u64> {
        (self.from + 1).checked_sub(back)
    }
}
