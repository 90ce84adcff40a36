//! One envelope of squared speed over the path, as far as the element that is executed has to brake for it.
//!
//! A joint that may be passed at the squared speed c limits the joints before it to `c + E`, E the level of
//! squared speed there (see [`Window`](crate::window::Window)); at a joint the least of all from it on counts. They
//! are noted once each, in their order and not before they come within the braking distance, in a queue that keeps
//! the falling lows only. From the joint that is found to limit the envelope is made back to here, joint by joint
//! so that nothing is lost by sums, and serves until that joint is passed. So each joint is looked at once and
//! made once, however long the look-ahead.

use std::collections::VecDeque;

use crate::clone_within::clone_within;
use crate::segments::Segments;

/// What part of the level may be rounding when two joints are compared: that of the sums over some thousand elements.
pub(crate) const ROUNDING: f64 = 1e-12;

#[derive(Debug, Default)]
pub(crate) struct Braking {
    lows: VecDeque<Low>,
    /// A joint that is a stop whatever else it is.
    stop: Option<u64>,
    /// The envelope at the joints from this number on.
    from: u64,
    squared: VecDeque<f64>,
}

clone_within!(Braking {
    lows,
    stop,
    from,
    squared
});

/// A joint that limits the ones before it: its number, and squared speed plus level.
#[derive(Clone, Copy, Debug)]
struct Low {
    joint: u64,
    key: f64,
}

impl Braking {
    /// For so many elements: within it nothing allocates.
    pub(crate) fn with_capacity(capacity: usize) -> Braking {
        Braking {
            lows: VecDeque::with_capacity(capacity),
            squared: VecDeque::with_capacity(capacity),
            ..Braking::default()
        }
    }

    /// All joints are to be noted anew.
    pub(crate) fn forget(&mut self) {
        self.lows.clear();
        self.squared.clear();
    }

    /// The element of a number is executed.
    #[inline]
    pub(crate) fn pass(&mut self, current: u64) {
        while self.lows.front().is_some_and(|low| low.joint < current) {
            self.lows.pop_front();
        }
        while self.from < current && self.squared.pop_front().is_some() {
            self.from += 1;
        }
    }

    /// The least of what was noted; joints whose level is above that cannot limit the current one.
    #[inline]
    pub(crate) fn lowest(&self) -> f64 {
        self.lows.front().map_or(f64::INFINITY, |low| low.key)
    }

    /// Notes a joint that lies after all others, by its squared speed plus level.
    #[inline]
    pub(crate) fn note(&mut self, joint: u64, key: f64) {
        while self.lows.back().is_some_and(|low| low.key >= key) {
            self.lows.pop_back();
        }
        self.lows.push_back(Low { joint, key });
    }

    /// The stop is at this joint. Whether it was elsewhere.
    pub(crate) fn set_stop(&mut self, joint: Option<u64>) -> bool {
        let moved = self.stop != joint;
        let end = self.from + self.squared.len() as u64;
        if moved && [self.stop, joint].into_iter().flatten().any(|stop| stop < end) {
            self.squared.clear();
        }
        self.stop = joint;
        moved
    }

    pub(crate) fn stop(&self) -> Option<u64> {
        self.stop
    }

    /// The squared speed of the envelope at the current joint; `None` when no joint that was noted is lower than
    /// `bound`, a squared speed plus level. `cap` gives the squared speed of a joint by itself.
    #[inline]
    pub(crate) fn at(
        &mut self,
        current: u64,
        bound: f64,
        segments: &Segments,
        cap: impl FnMut(u64) -> f64,
    ) -> Option<f64> {
        let last = self.limiting(current, bound, segments)?;
        if self.from != current || self.from + self.squared.len() as u64 <= last {
            self.make(current, last, segments, cap);
        }
        self.squared.front().copied()
    }

    /// The last joint that may limit the current one.
    #[inline]
    fn limiting(&self, current: u64, bound: f64, segments: &Segments) -> Option<u64> {
        let stop = self.stop.filter(|stop| *stop >= current);
        let stop = stop.and_then(|joint| Some((joint, segments.get(joint)?.level)));
        let lowest = self.lowest().min(bound);
        let lowest = stop.map_or(lowest, |(_, key)| key.min(lowest));
        let limits = |key: f64| key <= lowest + ROUNDING * key;
        let low = self.lows.iter().take_while(|low| limits(low.key)).last();
        let stop = stop.filter(|(_, key)| limits(*key));
        low.map(|low| low.joint).max(stop.map(|(joint, _)| joint))
    }

    /// Makes the envelope from a joint back to the current one.
    fn make(&mut self, current: u64, last: u64, segments: &Segments, mut cap: impl FnMut(u64) -> f64) {
        self.squared.clear();
        self.from = current;
        let mut entry = f64::INFINITY;
        for number in (current..=last).rev() {
            let cap = cap(number);
            let squared = if self.stop == Some(number) {
                0.0
            } else {
                cap.min(entry)
            };
            self.squared.push_front(squared);
            entry = squared + segments.get(number).map_or(0.0, |segment| segment.energy);
        }
    }
}
