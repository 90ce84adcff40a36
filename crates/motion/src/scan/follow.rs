//! How the stylus follows a surface in a plane: it taps, and at corners it turns [000:7807-7825].

use bahn_path::{ScanJob, ScanPoint};

use super::glide::Glide;
use super::way::{Felt, Followed, Tracking, Wish};

/// Part of an oscillation that the stylus leaves the surface (inferred): two fifths, so that points lie nearer than the
/// interval also where the surface falls away.
const AWAY: f64 = 0.4;
/// Two points that are nearer give no new direction, mm (inferred).
const NEAR_MM: f64 = 1e-3;
/// Touches without getting farther after which the stylus is stuck (inferred).
const STUCK: u32 = 20_000;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Touched: along the resultant off the surface until free.
    Rise { for_s: f64 },
    /// Free: along the resultant to the surface.
    Fall,
    /// Outside corner: back against the scan direction until it touches.
    Back,
    /// Inside corner: back against the scan direction until free.
    Clear { from: ScanPoint },
    /// Inside corner, free: on again until it touches.
    Forth { from: ScanPoint },
    /// It does not become free: the axis of the probe retracts.
    Lift,
}

/// The follower of a surface.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    tracking: Tracking,
    /// Direction of the scan in the plane: along and off.
    direction: [f64; 2],
    /// The last point.
    last: ScanPoint,
    phase: Phase,
    /// How far it may go along before it goes straight to the surface.
    pub cap_mm: f64,
    /// The farthest point along, and touches since.
    farthest: f64,
    stuck: u32,
    /// Feed along and across, mm/s.
    along_mm_s: f64,
    across_mm_s: f64,
    period_s: f64,
    travel_mm: f64,
    interval_mm: f64,
    deflection_mm: f64,
    up: ScanPoint,
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
            along_mm_s: job.feed_mm_min() / 60.0,
            across_mm_s: job.rules.normal_mm_min / 60.0,
            period_s: 1.0 / job.rules.oscillations_hz,
            travel_mm: job.travel_mm,
            interval_mm: job.interval_mm,
            deflection_mm: job.rules.deflection_mm,
            up,
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
        let way = minus(felt.at, self.last);
        let (along, height) = (dot(way, self.direction()), dot(way, self.normal()));
        let advance = f64::from(u8::from(along < self.cap_mm));
        match self.phase {
            Phase::Rise { for_s } => {
                let for_s = for_s + felt.time_s;
                self.phase = Phase::Rise { for_s };
                if !felt.deflected && for_s >= AWAY * self.period_s {
                    self.phase = Phase::Fall;
                } else if felt.deflected && (height >= self.travel_mm || along >= self.interval_mm) {
                    self.phase = Phase::Clear { from: felt.at };
                }
                self.wish(advance, 1.0)
            }
            // Deflected without a touch of its own: it came from somewhere else.
            Phase::Fall if felt.deflected => self.touched(felt.at),
            Phase::Fall => {
                if height <= -self.travel_mm || along >= self.interval_mm && height < 0.0 {
                    self.phase = Phase::Back;
                }
                self.wish(advance, -1.0)
            }
            Phase::Back if felt.deflected => self.touched(felt.at),
            Phase::Back => {
                // Nothing there either: down again from here.
                if along < -self.interval_mm {
                    self.last = felt.at;
                    self.direction = [1.0, 0.0];
                    self.phase = Phase::Fall;
                }
                self.wish(-1.0, 0.0)
            }
            Phase::Clear { from } => {
                if !felt.deflected {
                    self.phase = Phase::Forth { from: felt.at };
                } else if dot(minus(from, felt.at), self.direction()) >= self.deflection_mm {
                    self.phase = Phase::Lift;
                }
                self.wish(-1.0, 0.0)
            }
            Phase::Forth { from } => {
                if felt.deflected {
                    return self.touched(felt.at);
                }
                if dot(minus(felt.at, from), self.direction()) > self.deflection_mm + self.interval_mm {
                    self.phase = Phase::Fall;
                }
                self.wish(1.0, 0.0)
            }
            Phase::Lift => {
                if !felt.deflected {
                    self.last = felt.at;
                    self.direction = [1.0, 0.0];
                    self.phase = Phase::Fall;
                }
                Followed::Moves(Wish::along(self.up, self.along_mm_s))
            }
        }
    }

    fn waits_for_touch(&self) -> bool {
        matches!(self.phase, Phase::Fall | Phase::Back | Phase::Forth { .. })
    }

    /// A new point: the direction of the scan is that from the last one to it.
    fn touched(&mut self, touch: ScanPoint) -> Followed {
        let way = minus(touch, self.last);
        let plane = [dot(way, self.tracking.along), dot(way, self.tracking.off)];
        let length = plane[0].hypot(plane[1]);
        if length > NEAR_MM {
            self.direction = plane.map(|part| part / length);
        }
        self.last = touch;
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
