//! The look-ahead: speeds at the joints, as fast as braking in time allows.
//!
//! Everything is reckoned in squared speeds. Along an element of length s and acceleration a the square
//! can change by 2·a·s; E is the sum of that from the start of the path. From joint j the path can come
//! down to the cap of a later joint k when `v_j² <= cap_k + E_k - E_j`. So the speed at j is bounded by
//! the least `cap_k + E_k` of all joints from j on, less E_j: a suffix minimum, which a queue that keeps
//! only the falling lows gives in O(1) per element. The speed is final as soon as no later joint can
//! lower it: caps are never negative and E only grows, so that is when the path can stop from it within
//! what is known. The window is then only as long as the way of braking, however long the program.

use std::collections::VecDeque;

use crate::profile::{Profile, Speed};

/// Most elements that look-ahead holds. When the way of braking has more of them (65.5 mm of lines of
/// 1 µm), the path is planned so that it can stop within these.
pub const MAX_LOOK_AHEAD: usize = 65_536;

/// The elements whose exit speed is not final yet, as far as dynamics go.
#[derive(Debug)]
pub(crate) struct Window {
    segments: VecDeque<Segment>,
    /// Number of the first segment, and of the joint at its end.
    first: u64,
    /// Joints from the first on whose cap is known to look-ahead: numbers below this.
    decided: u64,
    /// Joints whose cap was given; between `decided` and this they wait for the one of `held`.
    joined: u64,
    held: Option<u64>,
    lows: VecDeque<Low>,
    /// Speed at the start of the first segment.
    entry: Speed,
    /// Segments handed out since E was last made to count from the first segment.
    since_rebase: usize,
}

#[derive(Clone, Copy, Debug)]
struct Segment {
    length: f64,
    acceleration: f64,
    speed: f64,
    /// E at the end.
    energy: f64,
    /// Cap of the squared speed at the end.
    cap: f64,
}

/// A joint that limits the ones before it: its number and `cap + E`.
#[derive(Clone, Copy, Debug)]
struct Low {
    joint: u64,
    key: f64,
}

impl Window {
    pub(crate) fn new() -> Window {
        Window {
            segments: VecDeque::new(),
            first: 0,
            decided: 0,
            joined: 0,
            held: None,
            lows: VecDeque::new(),
            entry: Speed::ZERO,
            since_rebase: 0,
        }
    }

    pub(crate) fn is_full(&self) -> bool {
        self.segments.len() >= MAX_LOOK_AHEAD
    }

    /// Puts a segment at the end of the path. Its end joint is to be given by `join` or `hold` before
    /// the next one.
    #[inline]
    pub(crate) fn push(&mut self, length: f64, acceleration: f64, speed: f64) {
        let before = self.segments.back().map_or(0.0, |s| s.energy);
        let energy = before + 2.0 * acceleration * length;
        self.segments.push_back(Segment {
            length,
            acceleration,
            speed,
            energy,
            cap: 0.0,
        });
    }

    /// The speed at the end of the last segment may be at most `speed`.
    #[inline]
    pub(crate) fn join(&mut self, speed: f64) {
        if let Some(last) = self.segments.back_mut() {
            last.cap = speed * speed;
            self.joined += 1;
            if self.held.is_none() {
                self.decide();
            }
        }
    }

    /// The speed at the end of the last segment is still to be found out; `settle` gives it. Until
    /// then no later joint is of use.
    #[inline]
    pub(crate) fn hold(&mut self) {
        self.held = Some(self.joined);
        self.joined += 1;
    }

    /// Gives the joint that `hold` left open.
    #[inline]
    pub(crate) fn settle(&mut self, speed: f64) {
        if let Some(joint) = self.held.take() {
            if let Some(segment) = self.segment_mut(joint) {
                segment.cap = speed * speed;
            }
            self.decide();
        }
    }

    /// The profile of the first segment if its exit speed is final. With `now` a path that could still
    /// become faster is planned to stop within what is known.
    #[inline]
    pub(crate) fn pop(&mut self, now: bool) -> Option<Profile> {
        let first = *self.segments.front()?;
        // The end of the first undecided segment is where a stop is possible.
        let known = match usize::try_from(self.decided - self.first)
            .ok()
            .and_then(|i| self.segments.get(i))
        {
            Some(segment) => segment.energy,
            None => f64::INFINITY,
        };
        let reachable = self.entry.squared + 2.0 * first.acceleration * first.length;
        let low = self
            .lows
            .front()
            .map_or(f64::INFINITY, |low| low.key - first.energy);
        let mut exit = reachable.min(low).min(first.speed * first.speed);
        if self.decided > self.first {
            exit = exit.min(first.cap);
        }
        if exit + first.energy > known {
            if !now {
                return None;
            }
            exit = known - first.energy;
        }
        let exit = self.exit_speed(exit.max(0.0), first.speed);
        self.remove_first(first.energy);
        let profile = Profile::new(first.length, first.acceleration, first.speed, self.entry, exit);
        self.entry = exit;
        Some(profile)
    }

    /// Saves the square root where the speed stays the same or is the greatest of the segment.
    fn exit_speed(&self, squared: f64, speed: f64) -> Speed {
        if squared == self.entry.squared {
            self.entry
        } else if squared == speed * speed {
            Speed {
                value: speed,
                squared,
            }
        } else {
            Speed::from_squared(squared)
        }
    }

    fn remove_first(&mut self, energy: f64) {
        self.segments.pop_front();
        if self.lows.front().is_some_and(|low| low.joint == self.first) {
            self.lows.pop_front();
        }
        self.first += 1;
        self.decided = self.decided.max(self.first);
        self.since_rebase += 1;
        // Once per window length E starts at the first segment again, so that sums stay small and
        // their rounding with them: one subtraction per segment on the average.
        if self.since_rebase > self.segments.len() {
            self.since_rebase = 0;
            self.segments
                .iter_mut()
                .for_each(|segment| segment.energy -= energy);
            self.lows.iter_mut().for_each(|low| low.key -= energy);
        }
    }

    fn decide(&mut self) {
        while self.decided < self.joined {
            let joint = self.decided;
            let Some(segment) = self.segment_mut(joint) else {
                break;
            };
            let key = segment.cap + segment.energy;
            while self.lows.back().is_some_and(|low| low.key >= key) {
                self.lows.pop_back();
            }
            self.lows.push_back(Low { joint, key });
            self.decided += 1;
        }
    }

    #[inline]
    fn segment_mut(&mut self, joint: u64) -> Option<&mut Segment> {
        self.segments
            .get_mut(usize::try_from(joint.checked_sub(self.first)?).ok()?)
    }
}
