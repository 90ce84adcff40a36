//! How the stylus follows a surface in a plane: it taps, and at corners it turns [000:7807-7825].
//!
//! P.P.INT is the greatest distance of two points [003:6668], on walls, too: a stylus that is nine tenths of it along goes
//! straight to the surface, as far as TRAVEL and what is left of P.P.INT let it, and so turns by enough to find a wall again.
//!
//! Decision: The stylus of a digitizing leaves the surface for two fifths of an oscillation and goes no farther from
//! a point than nine tenths of P.P.INT along and 0.43 of it across, so that points lie nearer than P.P.INT on walls,
//! too; while it is deflected it goes along four times as fast as across at most; MP6240 counts after the last point,
//! and ends at the edge of the RANGE, where the stylus has not been; TIME counts seconds (also
//! `interpreter/src/digitize.rs`)

use bahn_path::{ScanJob, ScanPoint};

use super::glide::Glide;
use super::stylus::{Felt, Followed, Tracking, Wish};

/// Part of an oscillation that the stylus leaves the surface (inferred): two fifths, so that points lie nearer than the
/// interval also where the surface falls away.
const AWAY: f64 = 0.4;
/// Part of the interval that the stylus goes along, and across at most (inferred): together no more than the interval.
const ALONG: f64 = 0.9;
const ACROSS: f64 = 0.43;
/// It slows down before it has gone as far, 1/s (inferred).
const SLOWS: f64 = 40.0;
/// While it is deflected it goes no faster along than so many times as fast as across: the resultant leads off the surface
/// by more than a touch is inexact (inferred).
const RESULTANT: f64 = 4.0;
/// Two points that are nearer give no new direction, mm (inferred).
const NEAR_MM: f64 = 1e-3;
/// Touches without getting farther after which the stylus is stuck (inferred).
const STUCK: u32 = 20_000;
/// Turns without a touch after which the surface is lost (inferred).
const TURNS: u32 = 4;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Touched: along the resultant off the surface until free.
    Rise { for_s: f64 },
    /// Free: along the resultant to the surface.
    Fall,
    /// Outside corner: back against the scan direction until it touches.
    Back,
    /// Inside corner: back against the scan direction until free.
    Clear,
    /// Inside corner, free: on again until it touches.
    Forth,
    /// It does not become free: the axis of the probe retracts.
    Lift,
}

/// The follower of a surface.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    tracking: Tracking,
    /// Direction of the scan in the plane: along and off.
    direction: [f64; 2],
    /// The last point that was taken, mm.
    last: ScanPoint,
    phase: Phase,
    /// How far it may go along before it goes straight to the surface.
    pub cap_mm: f64,
    /// The farthest point along, and touches since.
    farthest: f64,
    stuck: u32,
    /// How often it has turned back since the last point.
    turns: u32,
    /// It is at the end of a line.
    barred: bool,
    /// Feed along and across, mm/s.
    along_mm_s: f64,
    across_mm_s: f64,
    period_s: f64,
    travel_mm: f64,
    interval_mm: f64,
    deflection_mm: f64,
    up: ScanPoint,
    /// The range, least and greatest.
    range: [ScanPoint; 2],
    /// Of a measuring probe.
    glide: Option<Glide>,
}

fn dot(a: ScanPoint, b: ScanPoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn minus(a: ScanPoint, b: ScanPoint) -> ScanPoint {
    std::array::from_fn(|k| a[k] - b[k])
}

impl Follower {
    pub fn new(job: &ScanJob) -> Follower {
        let mut up = [0.0; 3];
        if let Some(height) = up.get_mut(job.tool_place()) {
            *height = 1.0;
        }
        Follower {
            tracking: Tracking { along: up, off: up },
            direction: [1.0, 0.0],
            last: job.begin(),
            phase: Phase::Fall,
            cap_mm: job.interval_mm,
            farthest: f64::NEG_INFINITY,
            stuck: 0,
            turns: 0,
            barred: false,
            along_mm_s: job.feed_mm_min() / 60.0,
            across_mm_s: job.rules.normal_mm_min / 60.0,
            period_s: 1.0 / job.rules.oscillations_hz,
            travel_mm: job.travel_mm,
            interval_mm: job.interval_mm,
            deflection_mm: job.rules.deflection_mm,
            up,
            range: [job.min, job.max],
            glide: job.rules.measuring.map(Glide::new),
        }
    }

    /// Off the surface before the next touch.
    pub fn retreat(&mut self) {
        self.phase = Phase::Rise { for_s: 0.0 };
    }

    /// Begins at a point of the surface.
    pub fn begin(&mut self, tracking: Tracking, at: ScanPoint) {
        self.tracking = tracking;
        self.direction = [1.0, 0.0];
        self.last = at;
        self.phase = Phase::Rise { for_s: 0.0 };
        self.cap_mm = self.interval_mm;
        self.farthest = f64::NEG_INFINITY;
        self.stuck = 0;
        self.turns = 0;
        if let Some(glide) = &mut self.glide {
            glide.begin();
        }
    }

    /// The last point of the surface.
    pub fn last(&self) -> ScanPoint {
        self.last
    }

    /// The direction of the scan in space.
    pub fn direction(&self) -> ScanPoint {
        let [along, off] = self.direction;
        std::array::from_fn(|k| along * self.tracking.along[k] + off * self.tracking.off[k])
    }

    /// Off the surface, across the direction of the scan.
    fn normal(&self) -> ScanPoint {
        let [along, off] = self.direction;
        std::array::from_fn(|k| along * self.tracking.off[k] - off * self.tracking.along[k])
    }

    fn wish(&self, along: f64, across: f64) -> Followed {
        let (d, n) = (self.direction(), self.normal());
        let velocity =
            std::array::from_fn(|k| along * self.along_mm_s * d[k] + across * self.across_mm_s * n[k]);
        Followed::Moves(Wish { velocity, end: None })
    }

    /// Whether it may go no farther along: then straight off the surface, and straight to it.
    pub fn bar(&mut self, barred: bool) {
        self.barred = barred;
        if barred
            && self.glide.is_none()
            && matches!(self.phase, Phase::Rise { .. } | Phase::Fall | Phase::Forth)
        {
            self.direction = [1.0, 0.0];
            if self.phase == Phase::Forth {
                self.phase = Phase::Fall;
            }
        }
    }

    /// Follows the surface for a cycle.
    pub fn cycle(&mut self, felt: &Felt) -> Followed {
        if let Some(glide) = &mut self.glide {
            let followed = glide.cycle(felt, &self.tracking, self.last, self.interval_mm);
            if let Followed::Touched(point, _) = followed {
                self.last = point;
            }
            return followed;
        }
        if let Some(touch) = felt.touch.filter(|_| self.waits_for_touch()) {
            return self.touched(touch);
        }
        let offset = minus(felt.at, self.last);
        let (along, height) = (dot(offset, self.direction()), dot(offset, self.normal()));
        let advance = self.advance(felt);
        match self.phase {
            Phase::Rise { for_s } => {
                let for_s = for_s + felt.time_s;
                self.phase = Phase::Rise { for_s };
                // The stylus takes no more than MP6240.
                let pressed = !self.barred && along >= self.reach().min(self.deflection_mm) - NEAR_MM;
                if !felt.deflected && for_s >= AWAY * self.period_s {
                    self.phase = Phase::Fall;
                } else if felt.deflected && (height >= self.stroke() || pressed) {
                    self.phase = Phase::Clear;
                }
                self.wish(advance, 1.0)
            }
            // Deflected without a touch of its own: it came from somewhere else.
            Phase::Fall | Phase::Back | Phase::Forth if felt.deflected => self.touched(felt.at),
            Phase::Fall => {
                if height <= -self.stroke() {
                    self.phase = Phase::Back;
                }
                self.wish(advance, -1.0)
            }
            Phase::Back => {
                if along < -self.reach() {
                    return self.turn_round();
                }
                self.wish(-1.0, 0.0)
            }
            Phase::Clear => {
                if !felt.deflected {
                    self.phase = Phase::Forth;
                } else if along <= -self.deflection_mm || self.is_at_edge(felt.nominal) {
                    self.phase = Phase::Lift;
                }
                self.wish(-1.0, 0.0)
            }
            Phase::Forth => {
                if along >= self.reach() - NEAR_MM {
                    self.phase = Phase::Fall;
                }
                self.wish(advance, 0.0)
            }
            Phase::Lift => {
                if !felt.deflected {
                    self.direction = [1.0, 0.0];
                    // Where it becomes free is the surface.
                    return self.touched(felt.at);
                }
                Followed::Moves(Wish::along(self.up, self.along_mm_s))
            }
        }
    }

    /// Going back from here leads out of the range, where the stylus has not been (inferred).
    fn is_at_edge(&self, at: ScanPoint) -> bool {
        let [least, greatest] = self.range;
        let direction = self.direction();
        (0..3).any(|k| {
            let beyond =
                direction[k] > 0.0 && at[k] <= least[k] || direction[k] < 0.0 && at[k] >= greatest[k];
            beyond && self.up[k] == 0.0
        })
    }

    /// How far it goes along from point to point, mm.
    fn reach(&self) -> f64 {
        self.cap_mm.min(ALONG * self.interval_mm)
    }

    /// How far it goes across, mm.
    fn stroke(&self) -> f64 {
        self.travel_mm.min(ACROSS * self.interval_mm)
    }

    /// Part of the feed along: none any more where the interval is used up, by the nominal position, which leads.
    fn advance(&self, felt: &Felt) -> f64 {
        let offset = minus(felt.nominal, self.last);
        let left = self.reach() - dot(offset, self.direction());
        let greatest = match felt.deflected {
            true => self.along_mm_s.min(RESULTANT * self.across_mm_s),
            false => self.along_mm_s,
        };
        (left * SLOWS).clamp(0.0, greatest) / self.along_mm_s
    }

    /// Nothing after the last point either: it was the tip of something thin, and its other side is scanned.
    fn turn_round(&mut self) -> Followed {
        self.turns += 1;
        if self.turns > TURNS {
            return Followed::Stuck;
        }
        self.direction = self.direction.map(|part| -part);
        self.keep_on();
        self.phase = Phase::Fall;
        self.wish(0.0, 0.0)
    }

    /// A line of the meander never goes back: seen from the probe a surface has one height at each place.
    fn keep_on(&mut self) {
        let [along, off] = self.direction;
        if self.tracking.off == self.up && along < 0.0 {
            self.direction = [0.0, off.signum()];
        }
    }

    fn waits_for_touch(&self) -> bool {
        matches!(self.phase, Phase::Fall | Phase::Back | Phase::Forth)
    }

    /// A new point: the direction of the scan is that from the last one to it.
    fn touched(&mut self, touch: ScanPoint) -> Followed {
        let offset = minus(touch, self.last);
        let plane = [dot(offset, self.tracking.along), dot(offset, self.tracking.off)];
        let length = plane[0].hypot(plane[1]);
        if length > NEAR_MM {
            self.direction = plane.map(|part| part / length);
            self.keep_on();
        }
        self.last = touch;
        self.turns = 0;
        self.phase = Phase::Rise { for_s: 0.0 };
        let reached = dot(touch, self.tracking.along);
        if reached > self.farthest + NEAR_MM {
            self.farthest = reached;
            self.stuck = 0;
        } else {
            self.stuck += 1;
        }
        if self.stuck > STUCK {
            return Followed::Stuck;
        }
        Followed::Touched(touch, Wish::stand())
    }
}
