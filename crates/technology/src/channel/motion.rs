//! What moves: the path along its track, and axes on their own.

use bahn_motion::{Aim, Interpolator, Limits, PointToPoint, Prepared};
use bahn_path::{Barrier, BlockRef, ElementSource, LiveData, PathElement, Position, Step};

use super::plan::Plan;
use super::track::Track;

/// Elements that the interpolator looks ahead.
const LOOK_AHEAD: usize = 512;

/// Nearer to a place the path is there, mm.
pub(super) const ROUNDING_MM: f64 = 1e-9;
/// Slower than this it stands, mm/s: it brakes over less than the distance above.
const STANDS_MM_S: f64 = 1e-3;

/// The path and the axes that move.
pub(super) struct Motion<'a> {
    limits: &'a Limits,
    pub(super) path: Interpolator<()>,
    /// Number of the element that the interpolator is given next.
    fed: u64,
    /// So much of it is executed already, mm.
    part: Option<f64>,
    /// Greatest path acceleration that it was given last, mm/s².
    acceleration: f64,
    /// The place that the path has come to or stands at.
    pub(super) reached: u64,
    /// Distance along the path before the last cycle, mm.
    pub(super) distance_before: f64,
    /// The path stood still in the last cycle.
    pub(super) still: bool,
    /// The standstill was reported.
    pub(super) stands: bool,
    /// It stands because it is held.
    pub(super) held: bool,
    /// Where axes stand that moved on their own.
    pub(super) ended_at: Position,
    /// Axes that move on their own.
    pub(super) independent: Vec<(bahn_din::Independent, PointToPoint)>,
}

/// Gives the interpolator the elements of the track.
struct Feed<'a> {
    track: &'a Track,
    fed: &'a mut u64,
    /// So much of the next element is executed already, mm.
    part: &'a mut Option<f64>,
    /// Elements with another path acceleration wait until the limits are others.
    acceleration: f64,
    /// Nothing comes after those that are known before the path has come to their end.
    closed: bool,
}

impl ElementSource for Feed<'_> {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        match self.track.leg(*self.fed) {
            Some(leg) if self.part.is_some() => {
                let along = self.part.take().unwrap_or(0.0);
                let element = leg.rest(along, false).element(*self.fed);
                *self.fed += 1;
                Step::Element(element)
            }
            Some(leg) if leg.driving.limit.acceleration_mm_s2 == self.acceleration => {
                let element: PathElement = leg.element(*self.fed);
                *self.fed += 1;
                Step::Element(element)
            }
            Some(_) => Step::Starved,
            None if self.closed => Step::Barrier(Barrier::Acknowledge {
                block: BlockRef::default(),
            }),
            None => Step::Starved,
        }
    }

    fn resume(&mut self, _: LiveData) {}
}

impl<'a> Motion<'a> {
    /// The path stands somewhere.
    pub(super) fn new(limits: &'a Limits, start: Position) -> Motion<'a> {
        let mut path = Interpolator::new(limits, LOOK_AHEAD);
        path.set_position(start);
        Motion {
            limits,
            path,
            fed: 1,
            part: None,
            acceleration: f64::INFINITY,
            reached: 1,
            distance_before: 0.0,
            still: true,
            stands: true,
            held: false,
            ended_at: Position::UNKNOWN,
            independent: Vec::new(),
        }
    }

    /// The path begins anew, somewhere, with an element.
    pub(super) fn begin(&mut self, start: Position, first: u64) {
        self.begin_on(start, first, None);
        self.ended_at = Position::UNKNOWN;
        self.independent.clear();
    }

    /// The path goes on from somewhere, with an element of which so much is executed already, mm.
    pub(super) fn begin_on(&mut self, position: Position, number: u64, part: Option<f64>) {
        self.turn(position);
        (self.fed, self.reached, self.part) = (number, number, part);
    }

    /// The path turns where it is.
    pub(super) fn turn(&mut self, position: Position) {
        self.path.clear();
        self.path.set_position(position);
    }

    /// Gives the interpolator what is known of the path.
    pub(super) fn feed(&mut self, plan: &Plan<'_>) {
        let track = &plan.track;
        let closed = plan.decoding.holds || plan.decoding.ended;
        loop {
            let mut feed = Feed {
                track,
                fed: &mut self.fed,
                part: &mut self.part,
                acceleration: self.acceleration,
                closed,
            };
            if self.path.stop().is_some() && feed.track.leg(*feed.fed).is_some() {
                self.path.resume(&mut feed, LiveData::default());
            }
            let prepared = self.path.prepare(&mut feed, usize::MAX);
            let next = track.leg(self.fed).map(|leg| leg.driving.limit);
            match next {
                Some(limit) if prepared == Prepared::Starved => {
                    self.acceleration = limit.acceleration_mm_s2;
                    self.path.set_limits(&within(self.limits, self.acceleration));
                }
                _ => return,
            }
        }
    }

    /// Path speed, mm/s.
    pub(super) fn speed(&self) -> f64 {
        let speed = self.path.speed_mm_s();
        if speed < STANDS_MM_S && self.path.rest_mm() < ROUNDING_MM {
            0.0
        } else {
            speed
        }
    }

    /// An axis begins to move on its own, from where it is.
    pub(super) fn begin_independent(&mut self, independent: bahn_din::Independent, at: f64) {
        let at = if at.is_nan() { 0.0 } else { at };
        self.independent
            .retain(|(other, _)| other.axis != independent.axis);
        self.independent.push((independent, PointToPoint::new(at)));
    }

    /// Axes that move on their own do so for a cycle, s. Whether there are any.
    pub(super) fn cycle_independent(&mut self, cycle_s: f64) -> bool {
        let any = !self.independent.is_empty();
        let limits = self.limits;
        let mut ended = Vec::new();
        self.independent.retain_mut(|(order, axis)| {
            let greatest = limits.max_feed_mm_min[order.axis];
            let feed = if order.rapid {
                greatest
            } else {
                order.feed_mm_min.min(greatest)
            };
            let acceleration = limits.acceleration_m_s2[order.axis];
            axis.cycle(cycle_s, Aim::Position(order.end), feed, acceleration);
            let is_at = axis.is_at(order.end);
            if is_at {
                ended.push((order.axis, order.end));
            }
            !is_at
        });
        for (axis, end) in ended {
            self.ended_at[axis] = end;
        }
        any
    }
}

/// The limits with which an element is driven within a path acceleration, mm/s².
fn within(limits: &Limits, acceleration_mm_s2: f64) -> Limits {
    let greatest = acceleration_mm_s2 / 1000.0;
    Limits {
        acceleration_m_s2: limits.acceleration_m_s2.map(|own| own.min(greatest)),
        ..limits.clone()
    }
}
