//! Digitizing: the stylus of a triggering probe taps along the surface, in lines or in levels [000:7722-7880]; that of a
//! measuring one stays deflected [000:7882-7958].
//!
//! A [`Scan`] wants a velocity in every cycle and gets what the stylus feels; how far the axes have come and where the
//! stylus was deflected it learns, too. So it is the same on a machine and on a height map.

mod course;
mod follow;
mod glide;
mod stylus;

use bahn_path::{ScanFault, ScanJob, ScanPoint, Scanned};

use course::Course;
use follow::Follower;
use stylus::{Felt, Wish};

/// Points of a scan at most; a program of more is refused by every control (inferred).
const POINTS_MAX: u64 = 10_000_000;
/// How far the surface may lie below the range, mm: the stylus overshoots (inferred).
const BELOW_MM: f64 = 0.1;
/// What rounding leaves of the distance to an end, mm.
const ROUNDING_MM: f64 = 1e-9;

/// What the stylus feels in a cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sense {
    /// It is deflected now.
    pub deflected: bool,
    /// Where the tip is.
    pub at: ScanPoint,
    /// Where the tip was when it was deflected within the cycle.
    pub touch: Option<ScanPoint>,
    /// How far a measuring probe is deflected: the tip is there beside `at`, mm.
    pub deflection: ScanPoint,
}

/// What a cycle of a scan comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScanStep {
    /// The scan goes on.
    Moves,
    /// It goes on, and this is a point of the surface.
    Point(ScanPoint),
    /// It is over: the axes stand.
    Over(Scanned),
}

/// A scan that runs.
#[derive(Clone, Debug)]
pub struct Scan {
    job: ScanJob,
    course: Course,
    follower: Follower,
    /// Nominal position, mm, and speed, mm/s.
    position: ScanPoint,
    velocity: ScanPoint,
    acceleration_mm_s2: f64,
    points: u64,
    /// Since the scan began, s.
    time_s: f64,
    over: Option<Option<ScanFault>>,
}

impl Scan {
    /// A scan that begins where [`ScanJob::begin`] says, with this acceleration of the axes, m/s².
    pub fn new(job: ScanJob, acceleration_m_s2: f64) -> Scan {
        Scan {
            course: Course::new(&job),
            follower: Follower::new(&job),
            position: job.begin(),
            velocity: [0.0; 3],
            acceleration_mm_s2: acceleration_m_s2 * 1e3,
            points: 0,
            time_s: 0.0,
            over: None,
            job,
        }
    }

    /// Nominal position of the tip, mm.
    pub fn position(&self) -> ScanPoint {
        self.position
    }

    /// Nominal speed of the tip, mm/s.
    pub fn velocity_mm_s(&self) -> ScanPoint {
        self.velocity
    }

    /// The axes stand somewhere else: it goes on from there, off the surface first.
    pub fn stand_at(&mut self, at: ScanPoint) {
        self.position = at;
        self.velocity = [0.0; 3];
        self.follower.retreat();
    }

    /// The number of points that were taken so far.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Lines that were scanned to their end, or levels that were orbited.
    pub fn lines_ended(&self) -> u32 {
        self.course.ended()
    }

    /// Breaks it off with a message; the axes come to a standstill.
    pub fn break_off(&mut self, fault: ScanFault) {
        self.over.get_or_insert(Some(fault));
    }

    /// Spends a cycle of this time, s, with a feed override, 0 to 1: none holds the stylus where it is.
    pub fn cycle(&mut self, time_s: f64, sense: &Sense, feed: f64) -> ScanStep {
        let felt = Felt {
            at: sense.at,
            nominal: self.position,
            deflected: sense.deflected,
            touch: sense.touch,
            deflection: sense.deflection,
            time_s,
        };
        let (mut wish, mut point) = (Wish::stand(), None);
        if self.over.is_none() && feed > 0.0 {
            self.time_s += time_s;
            match self.course.cycle(&mut self.follower, &self.job, &felt) {
                Ok((wanted, touched)) => (wish, point) = (wanted, touched),
                Err(end) => self.over = Some(end),
            }
            self.guard(&felt);
        }
        self.slew(&wish, time_s, feed);
        if let Some(point) = point {
            self.points += 1;
            return ScanStep::Point(point);
        }
        match self.over {
            Some(fault) if self.velocity == [0.0; 3] => ScanStep::Over(Scanned {
                at: self.position,
                fault,
            }),
            _ => ScanStep::Moves,
        }
    }

    /// What ends every scan.
    fn guard(&mut self, felt: &Felt) {
        let place = self.job.tool_place();
        let tip: ScanPoint = std::array::from_fn(|k| felt.at[k] + felt.deflection[k]);
        let [low, high, at] = [&self.job.min, &self.job.max, &tip].map(|of| of.get(place).copied());
        let (low, high, at) = (low.unwrap_or(0.0), high.unwrap_or(0.0), at.unwrap_or(0.0));
        let depth = felt.deflection.iter().map(|part| part * part).sum::<f64>().sqrt();
        if self
            .job
            .rules
            .measuring
            .is_some_and(|rules| depth > rules.limit_mm)
        {
            self.break_off(ScanFault::DeflectionExceedsMax);
        } else if self.has_left_range(&tip) {
            self.break_off(ScanFault::RangeExceeded);
        } else if at < low - BELOW_MM && (!felt.deflected || felt.touch.is_some()) {
            // A deflected stylus is pressed on: its ball is on the surface, above.
            self.break_off(match self.points {
                0 => ScanFault::Inaccessible,
                _ => ScanFault::RangeExceeded,
            });
        } else if at >= self.job.clearance_mm && felt.deflected {
            self.break_off(ScanFault::CannotRetract);
        } else if felt.touch.is_some() && at > high + BELOW_MM {
            self.break_off(match self.points {
                0 => ScanFault::Inaccessible,
                _ => ScanFault::RangeExceeded,
            });
        } else if self.points >= POINTS_MAX {
            self.break_off(ScanFault::MemoryFull);
        }
    }

    /// A measuring probe that has lost the surface, or counts the wrong way, is led off: it must not leave the range by
    /// more than it may be deflected (inferred).
    fn has_left_range(&self, tip: &ScanPoint) -> bool {
        let Some(rules) = &self.job.rules.measuring else {
            return false;
        };
        let up = self.job.tool_place();
        (0..3).any(|k| {
            let (low, high) = (self.job.min[k] - rules.limit_mm, self.job.max[k] + rules.limit_mm);
            // At the start it stands at clearance height.
            let high = if k == up {
                high.max(self.job.clearance_mm + BELOW_MM)
            } else {
                high
            };
            tip[k] < low && k != up || tip[k] > high
        })
    }

    /// The speed goes over to the one that is wanted as fast as the axes can; what brakes for the end of a line or for a
    /// level does so first.
    fn slew(&mut self, wish: &Wish, time_s: f64, feed: f64) {
        let mut wanted = wish.velocity.map(|part| part * feed);
        let possible = self.acceleration_mm_s2 * time_s;
        let mut braked = 0.0;
        let mut along = 0.0;
        if let Some((axis, sign, end)) = wish.end {
            let able = landing_speed((end - self.position[axis]) * sign, possible, time_s);
            wanted[axis] = sign * (wanted[axis] * sign).min(able);
            braked = (self.velocity[axis] * sign - able).clamp(0.0, possible);
            self.velocity[axis] -= braked * sign;
            along = -braked * sign * (wanted[axis] - self.velocity[axis]);
        }
        let missing: ScanPoint = std::array::from_fn(|k| wanted[k] - self.velocity[k]);
        let square = missing.iter().map(|v| v * v).sum::<f64>();
        // The greatest part with which both together are no more than possible.
        let left = possible * possible - braked * braked;
        let part = if square + 2.0 * along > left {
            ((along * along + square * left).sqrt() - along) / square
        } else {
            1.0
        };
        for k in 0..3 {
            self.velocity[k] += missing[k] * part;
            if part == 1.0 {
                self.velocity[k] = wanted[k];
            }
            self.position[k] += self.velocity[k] * time_s;
        }
        if let Some((axis, _, end)) = wish.end
            && (self.position[axis] - end).abs() < ROUNDING_MM
        {
            self.position[axis] = end;
        }
    }
}

/// The greatest speed of a cycle, mm/s, from which an axis that loses `step` mm/s in each of the next ones stops after
/// `distance` mm: n cycles of v, v - step, v - 2 step and so on, the last of them no faster than a step.
fn landing_speed(distance: f64, step: f64, time_s: f64) -> f64 {
    if distance <= 0.0 {
        return 0.0;
    }
    // n (n - 1) / 2 < distance / (step time) <= n (n + 1) / 2
    let steps = distance / (step * time_s);
    let n = (((8.0 * steps + 1.0).sqrt() - 1.0) / 2.0).ceil().max(1.0);
    step * (steps / n + (n - 1.0) / 2.0)
}
