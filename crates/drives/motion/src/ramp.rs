//! One move of constant acceleration, driven in steps of time from where it is.

/// What part of the squared speed may be rounding: an end speed that is missed by less is met.
const ROUNDING: f64 = 1e-12;

/// A distance to go at changing speed: from the speed now to at most the speed at its end, not faster than
/// `limit` in between, with the same acceleration up and down.
///
/// A speed above the limit is brought down to it. Where the distance is too short for braking to the end
/// speed, it is braked all along and ends faster.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ramp {
    /// Speed now, mm/s.
    pub(crate) speed: f64,
    /// Distance to go, mm.
    pub(crate) rest: f64,
    /// Acceleration of both slopes, mm/s².
    pub(crate) acceleration: f64,
    /// Greatest speed, mm/s.
    pub(crate) limit: f64,
    /// Square of the greatest speed at the end, (mm/s)².
    pub(crate) exit_squared: f64,
}

/// Where a time has led to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Driven {
    /// Still on the way: speed and distance to go.
    OnTheWay { speed: f64, rest: f64 },
    /// At the end: speed there and time that is left, s.
    Arrived { speed: f64, left: f64 },
}

impl Ramp {
    /// Drives for a time, s.
    #[inline]
    pub(crate) fn drive(&self, time: f64) -> Driven {
        let Ramp {
            speed: v,
            rest,
            acceleration: a,
            limit,
            ..
        } = *self;
        if rest <= 0.0 {
            return Driven::Arrived { speed: v, left: time };
        }
        let squared = v * v;
        let change = 2.0 * a * rest;
        let tolerance = ROUNDING * squared;
        // The speed at the end and the greatest (or, when braking to the limit, the lasting) one.
        let (peak, exit) = if squared - change > self.exit_squared + tolerance {
            (v, (squared - change).sqrt())
        } else if v <= limit {
            let reachable = squared + change;
            let exit_squared = self.exit_squared.min(reachable);
            let meeting = (0.5 * (squared + exit_squared + change)).max(squared);
            // The square root is for short distances only.
            let peak = if limit * limit <= meeting {
                limit
            } else {
                meeting.sqrt()
            };
            let exit = if exit_squared == limit * limit {
                limit
            } else {
                exit_squared.sqrt()
            };
            (peak, exit.min(peak))
        } else {
            (limit, self.exit_squared.sqrt().min(limit))
        };
        let per_a = 1.0 / a;
        let (first, last) = ((peak - v).abs() * per_a, (peak - exit) * per_a);
        if time < first {
            let to = if peak > v { v + a * time } else { v - a * time };
            let rest = (rest - 0.5 * (v + to) * time).clamp(0.0, rest);
            return Driven::OnTheWay { speed: to, rest };
        }
        let last_distance = 0.5 * (peak + exit) * last;
        let after_first = rest - 0.5 * (v + peak) * first;
        let steady = (after_first - last_distance).max(0.0);
        if peak <= 0.0 {
            // It stands where it is, unless it just arrived.
            return if steady <= ROUNDING * rest {
                Driven::Arrived {
                    speed: 0.0,
                    left: time - first,
                }
            } else {
                Driven::OnTheWay {
                    speed: 0.0,
                    rest: after_first.clamp(0.0, rest),
                }
            };
        }
        let time = time - first;
        if time * peak < steady {
            let rest = (after_first - peak * time).clamp(0.0, rest);
            return Driven::OnTheWay { speed: peak, rest };
        }
        // Counted from the end, so that it is met.
        let left = time - steady / peak - last;
        if left >= 0.0 {
            return Driven::Arrived { speed: exit, left };
        }
        let to_go = -left;
        Driven::OnTheWay {
            speed: exit + a * to_go,
            rest: ((exit + 0.5 * a * to_go) * to_go).min(rest),
        }
    }
}
