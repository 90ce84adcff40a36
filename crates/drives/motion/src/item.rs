//! An element with what driving it needs.

use bahn_path::{At, FeedRate, OverrideLaw, PathElement};

use crate::gate::{Gate, place, wait};
use crate::late::Awaits;
use crate::limits::{Dynamics, Slowest};
use crate::motion::Motion;

#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub(crate) element: PathElement,
    /// Path length, mm; 0 when nothing moves.
    pub(crate) length: f64,
    /// Path acceleration, mm/s².
    pub(crate) acceleration: f64,
    /// Where functions are output, and whether the path waits for them.
    pub(crate) start: Output,
    pub(crate) end: Output,
    /// Whether there are functions along its length.
    pub(crate) along: bool,
    /// The last element of its block, as far as is known.
    pub(crate) block_end: bool,
    /// The distance along the path to its start since the path began, mm.
    pub(crate) from: f64,
    /// What must be acknowledged before it begins.
    pub(crate) awaits: Awaits,
    /// How fast its axes let it be.
    pub(crate) slowest: Slowest,
    /// Path speed that the radial acceleration allows, mm/s; infinite on lines.
    radial_speed: f64,
}

/// What an element outputs at one of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    Nothing,
    /// Functions for which the path does not wait.
    Passing,
    /// Functions of which one at least must be acknowledged.
    Waiting,
}

impl Item {
    pub(crate) fn new(element: PathElement, motion: Option<&Motion>) -> Item {
        Item {
            start: Output::of(&element, Gate::Start),
            end: Output::of(&element, Gate::End),
            along: element
                .functions()
                .iter()
                .any(|function| place(function).is_none() && !matches!(function.at, At::Ahead(_))),
            length: motion.map_or(0.0, |motion| motion.length),
            acceleration: motion.map_or(1.0, |motion| motion.acceleration),
            slowest: motion.map_or(Slowest::default(), |motion| motion.slowest),
            radial_speed: motion.map_or(f64::INFINITY, |motion| motion.radial_speed),
            block_end: false,
            from: 0.0,
            awaits: Awaits::default(),
            element,
        }
    }

    /// By how much the squared speed can change along it.
    #[inline]
    pub(crate) fn energy(&self) -> f64 {
        2.0 * self.acceleration * self.length
    }

    /// Greatest speed that machine and path allow, mm/s; infinite when nothing moves.
    pub(crate) fn greatest(&self, dynamics: &Dynamics) -> f64 {
        self.speed(dynamics, FeedRate::Rapid, OverrideLaw::Disabled)
    }

    /// Greatest path speed with the overrides as they are, mm/s; infinite when nothing moves.
    pub(crate) fn feed(&self, dynamics: &Dynamics) -> f64 {
        self.speed(dynamics, self.element.feed, self.element.override_law)
    }

    #[inline]
    fn speed(&self, dynamics: &Dynamics, feed: FeedRate, law: OverrideLaw) -> f64 {
        if self.length > 0.0 {
            dynamics.speed(feed, law, self.slowest).min(self.radial_speed)
        } else {
            f64::INFINITY
        }
    }

    /// Greatest speed from and to standstill at a feed, mm/s.
    pub(crate) fn peak(&self, feed: f64) -> f64 {
        feed.min((self.acceleration * self.length).sqrt())
    }

    /// The time in which it brakes to a standstill from that, s.
    pub(crate) fn braking_s(&self, feed: f64) -> f64 {
        self.peak(feed) / self.acceleration
    }

    /// How many outputs the element makes at most.
    pub(crate) fn outputs(&self) -> usize {
        self.element.functions().len()
    }
}

impl Output {
    fn of(element: &PathElement, end: Gate) -> Output {
        let mut output = Output::Nothing;
        for function in element.functions() {
            if place(function) == Some(end) {
                let waits = wait(function, element).is_some();
                output = match output {
                    Output::Waiting => output,
                    _ if waits => Output::Waiting,
                    _ => Output::Passing,
                };
            }
        }
        output
    }
}
