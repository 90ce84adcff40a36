//! How fast the ends of the elements to come may be passed, so that braking is always in time.
//!
//! There are two envelopes of squared speed over the path. One is of what machine and path [*allow*](Allowed).
//! The end of what is known is a stop, and elements that are put after it only raise it. The other is of what is
//! [*wanted*](Wanted) and may be lowered at any time, even below the speed of the path. The path then brakes with
//! all that it has, and so stays below the envelope of what is allowed: it was below it before, and no path within the
//! acceleration can fall faster.
//!
//! Decision: Overrides may fall below the speed of the path at any time: it then brakes with all it has and so stays
//! below what the geometry allows

use crate::allowed::Allowed;
use crate::clone_within::clone_within;
use crate::joints::Caps;
use crate::limits::Dynamics;
use crate::segments::Segments;
use crate::stretch::Wish;
use crate::wanted::Wanted;

#[derive(Debug)]
pub(crate) struct Envelope {
    segments: Segments,
    /// Number of the segment that is executed.
    current: u64,
    /// The joint whose cap is still to be found out. Until then it is a stop, for what comes after it may raise
    /// its speed, and lower it too.
    held: Option<u64>,
    allowed: Allowed,
    wanted: Wanted,
    /// The greatest squared speed at the end of the current segment, once asked for.
    exit: Option<f64>,
}

clone_within!(Envelope {
    segments,
    current,
    held,
    allowed,
    wanted,
    exit
});

impl Caps for Envelope {
    fn join(&mut self, speed: f64) {
        self.set_cap(self.segments.last(), speed);
    }

    fn hold(&mut self) {
        self.held = self.segments.last();
    }

    fn settle(&mut self, speed: f64) {
        let held = self.held.take();
        self.set_cap(held, speed);
    }
}

impl Envelope {
    /// For so many elements.
    pub(crate) fn with_capacity(capacity: usize) -> Envelope {
        Envelope {
            segments: Segments::with_capacity(capacity),
            current: 0,
            held: None,
            allowed: Allowed::with_capacity(capacity),
            wanted: Wanted::with_capacity(capacity),
            exit: None,
        }
    }

    /// Puts a segment at the end of the path, without a wish when it has no length.
    pub(crate) fn push(&mut self, energy: f64, greatest: f64, wish: Option<Wish>) {
        let number = self.segments.push(energy, greatest);
        if let Some(wish) = wish {
            self.wanted.push(number, wish);
        }
        self.exit = None;
    }

    /// Drops everything; numbers go on from here.
    pub(crate) fn clear(&mut self, number: u64) {
        self.segments.clear(number);
        self.current = number;
        self.allowed.forget();
        self.wanted.clear();
        (self.held, self.exit) = (None, None);
    }

    /// Drops the segments before the current one.
    pub(crate) fn discard(&mut self) {
        self.segments.discard(self.current);
    }

    /// Goes on to the next segment.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.current += 1;
        self.wanted.advance(self.current);
        self.exit = None;
    }

    /// The overrides have changed.
    pub(crate) fn forget_wanted(&mut self) {
        self.wanted.forget();
        self.exit = None;
    }

    /// The stop of single block is at the end of this segment.
    pub(crate) fn set_stop(&mut self, number: Option<u64>) {
        if self.wanted.set_stop(number) {
            self.exit = None;
        }
    }

    /// Whether that stop is passed, or there is none.
    pub(crate) fn stop_is_passed(&self) -> bool {
        self.wanted.stop_is_before(self.current)
    }

    /// The greatest speeds of the segments from the current one on have changed.
    pub(crate) fn set_greatest(&mut self, speeds: impl Iterator<Item = f64>) {
        for (number, greatest) in (self.current..).zip(speeds) {
            if let Some(segment) = self.segments.get_mut(number) {
                segment.greatest = greatest;
            }
        }
        self.allowed.forget();
        self.forget_wanted();
    }

    /// Squared speed that the joint at the end of the current segment allows by itself.
    #[inline]
    pub(crate) fn cap(&self) -> f64 {
        self.segments.get(self.current).map_or(0.0, |segment| segment.cap)
    }

    /// Greatest squared speed at the end of the current segment.
    #[inline]
    pub(crate) fn exit(&mut self, dynamics: &Dynamics) -> f64 {
        if let Some(exit) = self.exit {
            return exit;
        }
        let held = self.held.filter(|held| *held >= self.current);
        let end = held.or(self.segments.last()).unwrap_or(0);
        let exit = if self.current < end {
            let allowed = self.allowed.exit(self.current, end, &self.segments);
            let wanted = self.wanted.exit(self.current, &self.segments, dynamics);
            allowed.min(wanted)
        } else {
            0.0
        };
        self.exit = Some(exit);
        exit
    }

    /// Sets the cap of a joint that is still kept.
    fn set_cap(&mut self, number: Option<u64>, speed: f64) {
        if let Some(segment) = number.and_then(|number| self.segments.get_mut(number)) {
            segment.cap = speed * speed;
            self.exit = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use bahn_path::{BlockRef, Curve, FeedRate, OverrideLaw, PathElement, PerAxis, Position};
    use proptest::prelude::*;

    use super::*;
    use crate::limits::{Limits, Slowest};

    #[derive(Clone, Debug)]
    enum Action {
        /// A segment, and how the joint before it comes to its cap.
        Push(Segment, Joint),
        /// The held joint gets its cap.
        Settle(f64),
        /// The path goes on by so many segments, asking at each of them.
        Advance(usize),
        Discard,
        Overrides([f64; 3]),
        RapidLimit(f64),
        /// Single block stops so many segments ahead, or nowhere.
        Stop(Option<u64>),
        Clear,
    }

    #[derive(Clone, Debug)]
    struct Segment {
        energy: f64,
        /// `None` for one without length.
        motion: Option<(FeedRate, OverrideLaw, Slowest)>,
    }

    #[derive(Clone, Copy, Debug)]
    enum Joint {
        Cap(f64),
        Hold,
    }

    impl Segment {
        fn speed(&self, dynamics: &Dynamics, machine: bool) -> f64 {
            match self.motion {
                None => f64::INFINITY,
                Some((_, _, slowest)) if machine => {
                    dynamics.speed(FeedRate::Rapid, OverrideLaw::Disabled, slowest)
                }
                Some((feed, law, slowest)) => dynamics.speed(feed, law, slowest),
            }
        }

        fn wish(&self) -> Option<Wish> {
            let (feed, override_law, slowest) = self.motion?;
            let element = PathElement {
                block: BlockRef::default(),
                sequence: 1,
                curve: Curve::Hold,
                start: Position::ZERO,
                end: Position::ZERO,
                feed,
                override_law,
                constant_speed: false,
                tangential_end: false,
                end_feed: None,
                dwell_s: 0.0,
                placement: None,
                functions: None,
            };
            Some(Wish::of(&element, slowest))
        }
    }

    fn action() -> impl Strategy<Value = Action> {
        let decades = |from: f64, to: f64| (from.ln()..to.ln()).prop_map(f64::exp);
        let feed = prop_oneof![
            3 => Just(FeedRate::Programmed(6000.0)),
            3 => (100.0..20_000.0f64).prop_map(FeedRate::Programmed),
            1 => Just(FeedRate::Rapid),
        ];
        let law = prop_oneof![
            6 => Just(OverrideLaw::Free),
            1 => Just(OverrideLaw::Disabled),
            1 => Just(OverrideLaw::Tapping { from_percent: 60.0, to_percent: 110.0 }),
        ];
        let slowest = (0.7..1.0f64, 2000.0..60_000.0f64).prop_map(|(share, limit)| Slowest {
            time: share * 60.0 / limit,
            share,
        });
        let segment = prop_oneof![
            9 => (decades(0.1, 10_000.0), feed, law, slowest)
                .prop_map(|(energy, feed, law, slowest)| Segment { energy, motion: Some((feed, law, slowest)) }),
            1 => Just(Segment { energy: 0.0, motion: None }),
        ];
        let speed = || prop_oneof![1 => Just(0.0), 3 => decades(1.0, 1000.0), 3 => Just(1000.0)];
        let joint = prop_oneof![5 => speed().prop_map(Joint::Cap), 1 => Just(Joint::Hold)];
        let percent = prop_oneof![1 => Just(0.0), 3 => 1.0..150.0f64, 2 => Just(100.0)];
        prop_oneof![
            12 => (segment, joint).prop_map(|(segment, joint)| Action::Push(segment, joint)),
            1 => speed().prop_map(Action::Settle),
            4 => (0usize..12).prop_map(Action::Advance),
            1 => Just(Action::Discard),
            3 => prop::array::uniform3(percent).prop_map(Action::Overrides),
            1 => (500.0..70_000.0f64).prop_map(Action::RapidLimit),
            1 => prop::option::of(0u64..10).prop_map(Action::Stop),
            1 => Just(Action::Clear),
        ]
    }

    /// All segments and caps since the last clearing, and what was done to them.
    struct Whole {
        segments: Vec<Segment>,
        caps: Vec<f64>,
        held: Option<usize>,
        first: u64,
        current: usize,
        stop: Option<u64>,
    }

    impl Whole {
        fn settle(&mut self, envelope: &mut Envelope, speed: f64) {
            if let Some(held) = self.held.take() {
                self.caps[held] = speed;
                Caps::settle(envelope, speed);
            }
        }

        /// The pass over all segments, from the last one backwards.
        fn exit(&self, dynamics: &Dynamics) -> f64 {
            let (mut entry, mut feed, mut exit) = (0.0f64, 0.0f64, 0.0);
            for (index, segment) in self.segments.iter().enumerate().skip(self.current).rev() {
                let own = segment.speed(dynamics, false).min(segment.speed(dynamics, true));
                let slowest = own.min(feed);
                exit = (self.caps[index] * self.caps[index])
                    .min(slowest * slowest)
                    .min(entry);
                if self.stop == Some(self.first + index as u64) {
                    exit = 0.0;
                }
                entry = exit + segment.energy;
                feed = own;
            }
            exit
        }

        fn compare(&self, envelope: &mut Envelope, dynamics: &Dynamics) -> Result<(), TestCaseError> {
            // What has no length has an end, but no speed to be limited on the way there.
            if self
                .segments
                .get(self.current)
                .is_some_and(|segment| segment.motion.is_some())
            {
                prop_assert_eq!(envelope.exit(dynamics).to_bits(), self.exit(dynamics).to_bits());
            }
            Ok(())
        }

        fn apply(
            &mut self,
            action: Action,
            envelope: &mut Envelope,
            dynamics: &mut Dynamics,
        ) -> Result<(), TestCaseError> {
            match action {
                Action::Push(segment, joint) => {
                    if let Some(last) = self.segments.len().checked_sub(1) {
                        match joint {
                            Joint::Cap(speed) => {
                                self.caps[last] = speed;
                                envelope.join(speed);
                            }
                            Joint::Hold => {
                                self.settle(envelope, 50.0);
                                envelope.hold();
                                self.held = Some(last);
                            }
                        }
                    }
                    envelope.push(segment.energy, segment.speed(dynamics, true), segment.wish());
                    self.segments.push(segment);
                    self.caps.push(0.0);
                }
                Action::Settle(speed) => self.settle(envelope, speed),
                Action::Advance(count) => {
                    for _ in 0..count {
                        if self.current + 1 < self.segments.len() {
                            self.current += 1;
                            envelope.advance();
                            self.compare(envelope, dynamics)?;
                        }
                    }
                }
                Action::Discard => envelope.discard(),
                Action::Overrides(percent) => {
                    dynamics.set_overrides(percent);
                    envelope.forget_wanted();
                }
                Action::RapidLimit(limit) => {
                    dynamics.set_rapid_limit(limit);
                    let ahead = self.segments.iter().skip(self.current);
                    envelope.set_greatest(ahead.map(|segment| segment.speed(dynamics, true)));
                }
                Action::Stop(ahead) => {
                    self.stop = ahead.map(|ahead| self.first + self.current as u64 + ahead);
                    envelope.set_stop(self.stop);
                }
                Action::Clear => {
                    self.first += self.segments.len() as u64;
                    self.segments.clear();
                    self.caps.clear();
                    (self.held, self.stop, self.current) = (None, None, 0);
                    envelope.clear(self.first);
                }
            }
            self.compare(envelope, dynamics)
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

        /// However little of the envelopes is made, and in whatever order: bit by bit what one pass over all that
        /// is known gives.
        #[test]
        fn it_is_as_good_as_a_pass_over_the_whole_path(actions in prop::collection::vec(action(), 1..200)) {
            let limits = Limits {
                max_feed_mm_min: PerAxis::splat(30_000.0),
                acceleration_m_s2: PerAxis::splat(1.0),
                radial_acceleration_m_s2: 0.5,
                corner_angle_deg: 10.0,
                servo_lag: true,
                cycle_s: 0.003,
                servo_window_s: 0.15,
                spindle: Default::default(),
                feed_override_percent: 100.0,
                rapid_override_percent: 100.0,
            };
            let mut dynamics = Dynamics::new(&limits);
            let mut envelope = Envelope::with_capacity(200);
            let mut whole = Whole {
                segments: Vec::new(),
                caps: Vec::new(),
                held: None,
                first: 0,
                current: 0,
                stop: None,
            };
            for action in actions {
                whole.apply(action, &mut envelope, &mut dynamics)?;
            }
        }
    }
}
