//! The elements to come as the envelopes see them.

use std::collections::VecDeque;

use crate::clone_within::clone_within;

/// Segments by their number.
#[derive(Debug)]
pub(crate) struct Segments {
    queue: VecDeque<Segment>,
    /// Number of the first one, and of the joint at its end.
    first: u64,
}

clone_within!(Segments { queue, first });

#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// By how much the squared speed can change along it.
    pub(crate) energy: f64,
    /// Sum of that from the start of the path to its end.
    pub(crate) level: f64,
    /// Greatest speed that machine and path allow along it, mm/s.
    pub(crate) greatest: f64,
    /// Squared speed that the joint at its end allows by itself.
    pub(crate) cap: f64,
}

impl Segments {
    pub(crate) fn with_capacity(capacity: usize) -> Segments {
        Segments {
            queue: VecDeque::with_capacity(capacity),
            first: 0,
        }
    }

    /// Puts a segment at the end; its number.
    pub(crate) fn push(&mut self, energy: f64, greatest: f64) -> u64 {
        let before = self.queue.back().map_or(0.0, |last| last.level);
        self.queue.push_back(Segment {
            energy,
            level: before + energy,
            greatest,
            cap: 0.0,
        });
        self.first + self.queue.len() as u64 - 1
    }

    /// Drops everything; numbers go on from here.
    pub(crate) fn clear(&mut self, number: u64) {
        self.queue.clear();
        self.first = number;
    }

    /// Drops the segments before one.
    pub(crate) fn discard(&mut self, before: u64) {
        let count = self.index(before).unwrap_or(0).min(self.queue.len());
        self.queue.drain(..count);
        self.first += count as u64;
    }

    /// Number of the last one.
    pub(crate) fn last(&self) -> Option<u64> {
        Some(self.first + self.queue.len().checked_sub(1)? as u64)
    }

    #[inline]
    pub(crate) fn get(&self, number: u64) -> Option<&Segment> {
        self.queue.get(self.index(number)?)
    }

    #[inline]
    pub(crate) fn get_mut(&mut self, number: u64) -> Option<&mut Segment> {
        let index = self.index(number)?;
        self.queue.get_mut(index)
    }

    /// Level at the end of one; infinite after the last.
    #[inline]
    pub(crate) fn level(&self, number: u64) -> f64 {
        self.get(number).map_or(f64::INFINITY, |segment| segment.level)
    }

    #[inline]
    fn index(&self, number: u64) -> Option<usize> {
        usize::try_from(number.checked_sub(self.first)?).ok()
    }
}
