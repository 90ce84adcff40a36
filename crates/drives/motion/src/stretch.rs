//! What speed is wanted along the path: stretches of the same programmed feed.
//!
//! Programs change their feed seldom, so that a look-ahead of hundreds of elements has few stretches.

use std::collections::VecDeque;

use bahn_path::{FeedRate, OverrideLaw, PathElement};

use crate::clone_within::clone_within;
use crate::limits::{Dynamics, Slowest};

/// How fast an element is to run, beside what machine and path allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wish {
    feed: FeedRate,
    law: OverrideLaw,
    /// Rapid traverse is a share of what the axes can do.
    slowest: Slowest,
}

impl Wish {
    pub(crate) fn of(element: &PathElement, slowest: Slowest) -> Wish {
        Wish {
            feed: element.feed,
            law: element.override_law,
            slowest: match element.feed {
                FeedRate::Rapid => slowest,
                FeedRate::Programmed(_) => Slowest::default(),
            },
        }
    }

    /// Speed with the overrides as they are, mm/s.
    #[inline]
    fn speed(&self, dynamics: &Dynamics) -> f64 {
        dynamics.speed(self.feed, self.law, self.slowest)
    }
}

/// Elements in a row with the same wish, up to the next stretch. Elements without length belong to the one
/// before them.
#[derive(Clone, Debug)]
struct Stretch {
    /// Number of its first element.
    first: u64,
    wish: Wish,
    /// Squared speed, (mm/s)², with the overrides as they were when it was looked at.
    squared: f64,
}

/// The stretches from the element on that is executed. Before the first of them nothing moves.
#[derive(Debug)]
pub(crate) struct Stretches {
    queue: VecDeque<Stretch>,
    /// Number of the first stretch.
    gone: u64,
}

clone_within!(Stretches { queue, gone });

impl Stretches {
    /// For so many elements, each of which may be a stretch of its own.
    pub(crate) fn with_capacity(capacity: usize) -> Stretches {
        Stretches {
            queue: VecDeque::with_capacity(capacity),
            gone: 0,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.gone += self.queue.len() as u64;
        self.queue.clear();
    }

    /// The element of a number comes next.
    pub(crate) fn push(&mut self, number: u64, wish: Wish) {
        if self.queue.back().is_none_or(|last| last.wish != wish) {
            self.queue.push_back(Stretch {
                first: number,
                wish,
                squared: 0.0,
            });
        }
    }

    /// The element of a number is executed now. Whether that begins another stretch.
    #[inline]
    pub(crate) fn advance(&mut self, number: u64) -> bool {
        let begins = self.queue.get(1).is_some_and(|next| next.first <= number);
        if begins {
            self.queue.pop_front();
            self.gone += 1;
        }
        begins
    }

    /// Number of the first stretch.
    pub(crate) fn number(&self) -> u64 {
        self.gone
    }

    /// Looks at a stretch: its first element and its squared speed with the overrides as they are, (mm/s)².
    #[inline]
    pub(crate) fn look_at(&mut self, number: u64, dynamics: &Dynamics) -> Option<(u64, f64)> {
        let index = usize::try_from(number.checked_sub(self.gone)?).ok()?;
        let stretch = self.queue.get_mut(index)?;
        let speed = stretch.wish.speed(dynamics);
        stretch.squared = speed * speed;
        Some((stretch.first, stretch.squared))
    }

    /// Goes back over the stretches from an element on.
    pub(crate) fn back_from(&self, element: u64) -> Back<'_> {
        let count = self.queue.partition_point(|stretch| stretch.first <= element);
        Back {
            queue: &self.queue,
            count,
        }
    }
}

/// The stretches, looked at from the last one back.
#[derive(Clone, Debug)]
pub(crate) struct Back<'a> {
    queue: &'a VecDeque<Stretch>,
    /// Stretches that begin at the element or before it.
    count: usize,
}

impl Back<'_> {
    /// Squared speed, as it was looked at, of an element that is not after the one asked for before; infinite
    /// before the first stretch.
    #[inline]
    pub(crate) fn at(&mut self, element: u64) -> f64 {
        while let Some(stretch) = self.count.checked_sub(1).and_then(|last| self.queue.get(last)) {
            if stretch.first <= element {
                return stretch.squared;
            }
            self.count -= 1;
        }
        f64::INFINITY
    }
}
