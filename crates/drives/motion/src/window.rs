//! The look-ahead: speeds at the joints, as fast as braking in time allows.
//!
//! Everything is reckoned in squared speeds. Along an element of length s and acceleration a the square
//! can change by 2·a·s; E is the sum of that from the start of the path. From joint j the path can come
//! down to the cap of a later joint k when `v_j² <= cap_k + E_k - E_j`. So the speed at j is bounded by
//! the least `cap_k + E_k` of all joints from j on, less E_j: a suffix minimum, which a queue that keeps
//! only the falling lows gives in O(1) per element. The speed is final as soon as no later joint can
//! lower it: caps are never negative and E only grows, so that is when the path can stop from it within
//! what is known. The window is then only as long as the braking distance, however long the program.

use std::collections::VecDeque;

use crate::joints::Caps;
use crate::profile::{Profile, Speed};

/// Most elements that look-ahead holds. When the braking distance has more of them (65.5 mm of lines of
/// 1 µm), the path is planned so that it can stop within these.
pub const MAX_LOOK_AHEAD: usize = 65_536;

/// The elements whose exit speed is not final yet, as far as dynamics go.
#[derive(Clone, Debug)]
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

    /// The profile of the first segment if its exit speed is final. With `now` a path that could still
    /// become faster is planned to stop within what is known.
    #[inline]
    pub(crate) fn pop(&mut self, now: bool) -> Option<Profile> {
        let first = *self.segments.front().filter(|_| self.decided > self.first)?;
        // The end of the first undecided segment is where a stop is possible.
        let undecided = usize::try_from(self.decided - self.first).ok();
        let known = undecided
            .and_then(|i| self.segments.get(i))
            .map_or(f64::INFINITY, |s| s.energy);
        let reachable = self.entry.squared + 2.0 * first.acceleration * first.length;
        // The joint's own cap is taken as it is, not as what rounding leaves of it in `cap + E - E`.
        let low = match self.lows.front() {
            Some(low) if low.joint != self.first => low.key - first.energy,
            _ => first.cap,
        };
        let mut exit = reachable.min(low).min(first.cap);
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

impl Caps for Window {
    #[inline]
    fn join(&mut self, speed: f64) {
        if let Some(last) = self.segments.back_mut() {
            last.cap = speed * speed;
            self.joined += 1;
            if self.held.is_none() {
                self.decide();
            }
        }
    }

    /// Until the joint is settled no later one is of use.
    #[inline]
    fn hold(&mut self) {
        self.held = Some(self.joined);
        self.joined += 1;
    }

    #[inline]
    fn settle(&mut self, speed: f64) {
        if let Some(joint) = self.held.take() {
            if let Some(segment) = self.segment_mut(joint) {
                segment.cap = speed * speed;
            }
            self.decide();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Length, acceleration, feed, speed cap of the joint at the end (0 is a stop), and whether that
    /// joint is held until so many more segments are known.
    type Input = (f64, f64, f64, f64, Option<usize>);

    /// The classic two passes over the whole path: backward so that braking is in time, forward so that
    /// accelerating is. Squared speeds at the ends of the segments.
    fn two_passes(path: &[Input]) -> Vec<f64> {
        let mut speeds: Vec<f64> = path
            .iter()
            .enumerate()
            .map(|(i, (_, _, feed, cap, _))| {
                let next = path.get(i + 1).map_or(0.0, |next| next.2.min(*cap));
                next.min(*feed).powi(2)
            })
            .collect();
        for i in (1..path.len()).rev() {
            let (length, a, ..) = path[i];
            speeds[i - 1] = speeds[i - 1].min(speeds[i] + 2.0 * a * length);
        }
        let mut entry = 0.0f64;
        for (speed, (length, a, ..)) in speeds.iter_mut().zip(path) {
            *speed = speed.min(entry + 2.0 * a * length);
            entry = *speed;
        }
        speeds
    }

    /// Runs the window like the planner does: takes out what is final after every segment.
    fn run(path: &[Input]) -> Vec<Profile> {
        let mut window = Window::new();
        let mut held: Option<(f64, usize)> = None;
        let mut profiles = Vec::new();
        for (i, (length, a, feed, _, _)) in path.iter().enumerate() {
            if let Some((_, _, last_feed, cap, hold)) = i.checked_sub(1).map(|last| path[last]) {
                let speed = cap.min(last_feed).min(*feed);
                match (held, hold) {
                    (None, Some(count)) => {
                        window.hold();
                        held = Some((speed, i + count));
                    }
                    _ => window.join(speed),
                }
            }
            window.push(*length, *a, *feed);
            if let Some((speed, _)) = held.take_if(|(_, until)| *until <= i) {
                window.settle(speed);
            }
            profiles.extend(std::iter::from_fn(|| window.pop(false)));
        }
        if let Some((speed, _)) = held {
            window.settle(speed);
        }
        window.join(0.0);
        profiles.extend(std::iter::from_fn(|| window.pop(false)));
        profiles
    }

    fn input() -> impl Strategy<Value = Input> {
        (
            prop_oneof![1 => Just(0.0), 9 => 0.001..10.0f64],
            prop_oneof![Just(1000.0), 10.0..5000.0f64],
            1.0..500.0f64,
            prop_oneof![1 => Just(0.0), 3 => 0.0..200.0f64, 3 => Just(1000.0)],
            prop_oneof![2 => Just(None), 1 => (0usize..5).prop_map(Some)],
        )
    }

    proptest! {
        #[test]
        fn look_ahead_is_as_good_as_knowing_the_whole_path(path in prop::collection::vec(input(), 1..300)) {
            let profiles = run(&path);
            prop_assert_eq!(profiles.len(), path.len());
            for (profile, expected) in profiles.iter().zip(two_passes(&path)) {
                // Squares, as they are what is added up; E is some 1e5 here, some 1e-11 of it are rounding.
                let exit = profile.exit_mm_s.powi(2);
                prop_assert!((exit - expected).abs() <= 1e-9 * (1.0 + expected), "{exit} {expected}");
            }
        }
    }

    /// 1000 mm/s needs 500 mm to brake with 1000 mm/s². A joint is final as soon as that is known, and
    /// while the path accelerates even sooner: the first of the segments of 1 mm is final at its end,
    /// for the next one lets the path stop from sqrt(2 · 1000 · 1) mm/s.
    #[test]
    fn the_window_is_as_long_as_the_braking_distance() {
        let mut window = Window::new();
        let mut longest = 0;
        let mut count = 0;
        for i in 0..5000 {
            if i > 0 {
                window.join(1000.0);
            }
            window.push(1.0, 1000.0, 1000.0);
            longest = longest.max(window.segments.len());
            count += std::iter::from_fn(|| window.pop(false)).count();
            if i == 1 {
                assert_eq!(count, 1);
            }
        }
        assert_eq!(longest, 501, "a segment and the 500 mm after it");
    }

    /// Planned at once, every segment can still stop within what is known.
    #[test]
    fn a_full_window_leaves_room_to_stop() {
        let mut window = Window::new();
        for _ in 0..10 {
            window.push(1.0, 1000.0, 1000.0);
            window.join(1000.0);
        }
        window.push(1.0, 1000.0, 1000.0);
        let exits: Vec<f64> = std::iter::from_fn(|| window.pop(true))
            .map(|profile| profile.exit_mm_s.powi(2))
            .collect();
        // v² rises by 2000 with every mm and falls with the rest of the 11 mm: up to 5 mm, then down.
        let expected = (1..=10).map(|i| 2000.0 * f64::from(i.min(11 - i)));
        for (exit, expected) in exits.iter().zip(expected) {
            assert!((exit - expected).abs() < 1e-6, "{exit} {expected}");
        }
        assert_eq!(exits.len(), 10);
    }
}
