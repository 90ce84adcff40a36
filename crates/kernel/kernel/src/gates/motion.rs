//! What moves along the path.

use bahn_motion::{Interpolator, Limits, Prepared};
use bahn_path::{Barrier, BlockRef, ElementSource, LiveData, PathElement, Position, Step};

use super::places::Places;
use crate::track::LOOK_AHEAD;

/// Nearer to a place the path is there, mm.
pub const ROUNDING_MM: f64 = 1e-9;
/// Slower than this it stands, mm/s: it brakes over less than the distance above.
const STANDS_MM_S: f64 = 1e-3;

/// The path in motion.
#[derive(Debug)]
pub struct Motion {
    limits: Limits,
    /// It, sampled in each cycle.
    pub path: Interpolator<()>,
    /// It once more, to be run ahead; taken while that is done.
    pub preview: Option<Box<Interpolator<()>>>,
    /// Number of the element that the interpolator is given next.
    fed: u64,
    /// So much of it is executed already, mm.
    part_mm: Option<f64>,
    /// Greatest path acceleration that it was given last, mm/s².
    acceleration_mm_s2: f64,
    /// The place that the path has come to or stands at.
    pub reached: u64,
    /// Distance along the path before the last cycle, mm.
    pub distance_before_mm: f64,
    /// The path stood still in the last cycle.
    pub still: bool,
    /// The standstill was reported.
    pub stands: bool,
    /// It stands because it is held.
    pub held: bool,
}

/// Gives the interpolator the elements of the track.
struct Feed<'a, T, O> {
    track: &'a Places<T, O>,
    fed: &'a mut u64,
    /// So much of the next element is executed already, mm.
    part_mm: &'a mut Option<f64>,
    /// Elements with another path acceleration wait until the limits are others.
    acceleration_mm_s2: f64,
    /// Nothing comes after those that are known before the path has come to their end.
    closed: bool,
}

impl<T: Copy, O> ElementSource for Feed<'_, T, O> {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        match self.track.leg(*self.fed) {
            Some(leg) if self.part_mm.is_some() => {
                let along = self.part_mm.take().unwrap_or(0.0);
                let element = leg.rest(along, false).element(*self.fed);
                *self.fed += 1;
                Step::Element(element)
            }
            Some(leg) if leg.driving.limit.acceleration_mm_s2 == self.acceleration_mm_s2 => {
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

impl Motion {
    /// The path stands somewhere.
    pub fn new(limits: &Limits, start: Position) -> Motion {
        let mut path = Interpolator::new(limits, LOOK_AHEAD);
        path.set_position(start);
        Motion {
            limits: limits.clone(),
            path,
            preview: Some(Box::new(Interpolator::new(limits, LOOK_AHEAD))),
            fed: 1,
            part_mm: None,
            acceleration_mm_s2: f64::INFINITY,
            reached: 1,
            distance_before_mm: 0.0,
            still: true,
            stands: true,
            held: false,
        }
    }

    /// The path goes on from somewhere, with an element of which so much is executed already, mm.
    pub fn begin_on(&mut self, position: Position, number: u64, part: Option<f64>) {
        self.turn(position);
        (self.fed, self.reached, self.part_mm) = (number, number, part);
    }

    /// The path turns where it is.
    pub fn turn(&mut self, position: Position) {
        self.path.clear();
        self.path.set_position(position);
    }

    /// Gives the interpolator what is known of the path; nothing comes after that before the path is there when it is `closed`.
    pub fn feed<T: Copy, O>(&mut self, track: &Places<T, O>, closed: bool) {
        loop {
            let mut feed = Feed {
                track,
                fed: &mut self.fed,
                part_mm: &mut self.part_mm,
                acceleration_mm_s2: self.acceleration_mm_s2,
                closed,
            };
            if self.path.stop().is_some() && feed.track.leg(*feed.fed).is_some() {
                self.path.resume(&mut feed, LiveData::default());
            }
            let prepared = self.path.prepare(&mut feed, usize::MAX);
            let next = track.leg(self.fed).map(|leg| leg.driving.limit);
            match next {
                Some(limit) if prepared == Prepared::Starved => {
                    self.acceleration_mm_s2 = limit.acceleration_mm_s2;
                    self.path
                        .set_limits(&within(&self.limits, self.acceleration_mm_s2));
                }
                _ => return,
            }
        }
    }

    /// Path speed, mm/s: 0 where a rest below the rounding is left.
    pub fn speed(&self) -> f64 {
        let speed = self.path.speed_mm_s();
        if speed < STANDS_MM_S && self.path.rest_mm() < ROUNDING_MM {
            0.0
        } else {
            speed
        }
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
