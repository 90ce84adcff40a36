//! The envelope of what is wanted: programmed feed, overrides, the stop of single block.
//!
//! It may change altogether from one cycle to the next. But it is the feed of the own stretch unless the path must
//! brake for a slower one already, and only where stretches begin can it fall. So a change costs as many steps as
//! the feed changes within the braking distance, and the distance to the place for which it does brake.

use crate::braking::{Braking, ROUNDING};
use crate::clone_within::clone_within;
use crate::limits::Dynamics;
use crate::segments::Segments;
use crate::stretch::{Stretches, Wish};

#[derive(Debug)]
pub(crate) struct Wanted {
    stretches: Stretches,
    /// The stop is that of single block.
    braking: Braking,
    /// Squared speed of the current stretch.
    own: Option<f64>,
    /// Stretches below this number are noted.
    seen: u64,
}

clone_within!(Wanted {
    stretches,
    braking,
    own,
    seen
});

impl Wanted {
    /// For so many elements.
    pub(crate) fn with_capacity(capacity: usize) -> Wanted {
        Wanted {
            stretches: Stretches::with_capacity(capacity),
            braking: Braking::with_capacity(capacity),
            own: None,
            seen: 0,
        }
    }

    /// The element of a number comes next.
    pub(crate) fn push(&mut self, number: u64, wish: Wish) {
        self.stretches.push(number, wish);
    }

    /// Drops all stretches, and the stop of single block.
    pub(crate) fn clear(&mut self) {
        self.stretches.clear();
        self.braking.set_stop(None);
        self.forget();
    }

    /// The element of a number is executed now.
    #[inline]
    pub(crate) fn advance(&mut self, number: u64) {
        if self.stretches.advance(number) {
            self.own = None;
        }
    }

    /// The overrides have changed.
    pub(crate) fn forget(&mut self) {
        self.own = None;
        self.seen = 0;
        self.braking.forget();
    }

    /// The stop of single block is at the end of this element. Whether it was elsewhere.
    pub(crate) fn set_stop(&mut self, number: Option<u64>) -> bool {
        self.braking.set_stop(number)
    }

    /// Whether that stop is before an element, or there is none.
    pub(crate) fn stop_is_before(&self, number: u64) -> bool {
        self.braking.stop().is_none_or(|stop| stop < number)
    }

    /// The squared speed at the end of the current element.
    pub(crate) fn exit(&mut self, current: u64, segments: &Segments, dynamics: &Dynamics) -> f64 {
        let own = match self.own {
            Some(own) => own,
            None => self.begin(current, dynamics),
        };
        let Wanted {
            stretches,
            braking,
            seen,
            ..
        } = self;
        braking.pass(current);
        let bound = segments.level(current) + own;
        while let Some((first, squared)) = stretches.look_at(*seen, dynamics) {
            let joint = first.saturating_sub(1);
            let level = segments.level(joint);
            if level > bound.min(braking.lowest()) + ROUNDING * level {
                break;
            }
            braking.note(joint, squared + level);
            *seen += 1;
        }
        let mut back = None;
        let cap = |joint: u64| {
            // From the last joint back: the feeds on both sides of each.
            let back = back.get_or_insert_with(|| stretches.back_from(joint + 1));
            back.at(joint + 1).min(back.at(joint))
        };
        braking.at(current, bound, segments, cap).unwrap_or(own)
    }

    /// The stretch of the current element begins, or its speed has changed.
    fn begin(&mut self, current: u64, dynamics: &Dynamics) -> f64 {
        let number = self.stretches.number();
        let own = match self.stretches.look_at(number, dynamics) {
            Some((first, squared)) if first <= current => {
                self.seen = self.seen.max(number + 1);
                squared
            }
            // Nothing moves yet.
            _ => {
                self.seen = self.seen.max(number);
                f64::INFINITY
            }
        };
        self.own = Some(own);
        own
    }
}
