//! The envelope of what machine and path allow: rapid traverse of the axes, radial acceleration, corners, stops.

use crate::braking::{Braking, ROUNDING};
use crate::clone_within::clone_within;
use crate::segments::Segments;

#[derive(Debug)]
pub(crate) struct Allowed {
    /// The stop is where what is known ends.
    braking: Braking,
    /// Joints below this number are noted.
    seen: u64,
}

clone_within!(Allowed { braking, seen });

impl Allowed {
    /// For so many elements.
    pub(crate) fn with_capacity(capacity: usize) -> Allowed {
        Allowed {
            braking: Braking::with_capacity(capacity),
            seen: 0,
        }
    }

    /// The segments are others, or what they allow.
    pub(crate) fn forget(&mut self) {
        self.braking.forget();
        self.seen = 0;
    }

    /// The squared speed at the end of the current segment. `end` is the last joint; nothing is known after it.
    pub(crate) fn exit(&mut self, current: u64, end: u64, segments: &Segments) -> f64 {
        let Allowed { braking, seen } = self;
        braking.set_stop(Some(end));
        braking.pass(current);
        *seen = (*seen).max(current);
        while *seen < end {
            let level = segments.level(*seen);
            if level > braking.lowest() + ROUNDING * level {
                break;
            }
            braking.note(*seen, cap(*seen, segments) + level);
            *seen += 1;
        }
        let cap = |joint| cap(joint, segments);
        braking.at(current, f64::INFINITY, segments, cap).unwrap_or(0.0)
    }
}

/// Squared speed at which a joint may be passed, whatever comes after it.
#[inline]
fn cap(joint: u64, segments: &Segments) -> f64 {
    let (Some(before), Some(after)) = (segments.get(joint), segments.get(joint + 1)) else {
        return 0.0;
    };
    let slowest = before.greatest.min(after.greatest);
    before.cap.min(slowest * slowest)
}
