//! How fast a joint between two motions may be passed.
//!
//! A corner that is passed without a stop changes the velocity at once: each axis makes a step of
//! `v · |Δt|`, v the path speed and Δt the difference of the two directions. Nominal values go out once
//! per contour cycle T, so that over two cycles the axis shows the second difference
//!
//! `Σ step · w + ∫ a · w`, w a triangle of width 2T, height 1/T and area 1:
//!
//! all velocity steps within the window, and beside them the ordinary acceleration, together. The axis
//! stays below its bound `sqrt(MP1060² + MP1070²)` when every corner keeps
//!
//! `v · |Δt| <= SHARE · reserve · τ`, where
//!
//! - `reserve` is what the ordinary acceleration on both sides, along the path and towards the centre
//!   of an arc, leaves of the bound of the axis;
//! - `τ` is the corner's own time: half the time to the corner before and to the next one, each at most
//!   T/2. No two corners own the same time, so many small ones in a row share a cycle, and in the limit
//!   of short lines on a curve the law becomes the one of radial acceleration, `v² <= r · a`;
//! - an arc within one cycle of a corner between lines takes its acceleration towards the centre out of
//!   the reserve of that corner too, as there are windows that see both;
//! - [`SHARE`] covers that a step acts at one instant of its own time, in the worst case the middle of
//!   the triangle.

use std::ops::Range;

use bahn_path::Axis;

use crate::limits::Dynamics;
use crate::motion::{MAIN, Motion, MotionEnd, PerAxis, product};

/// The part of the reserve that corners use. However corners lie, the sum of `τ · w` over them is at most
/// 5/4: one alone gives 1, two at a distance of T/2 give 9/8, three at that distance 5/4, and more do not
/// give more (searched numerically). So 4/5 of the reserve keeps the bound.
const SHARE: f64 = 0.8;
/// Differences of direction below this are rounding, no corner; thousands of them in one cycle make
/// less than a hundredth of a corner that is felt.
const NO_CHANGE: f64 = 1e-8;

/// What happens between two motions.
#[derive(Debug)]
pub(crate) enum Joint {
    /// The path stops.
    Stop,
    /// No change of direction: passed at this speed, mm/s.
    Smooth(f64),
    /// A change of direction that is passed.
    Corner(Corner),
}

/// The path since the corner or stop before.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Run {
    /// Its length, mm.
    way: f64,
    /// The last arc of it.
    bend: Option<Bend>,
}

/// An arc, some way from a corner.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// Greatest curvature of an axis at its end next to the corner, 1/mm.
    curvature: f64,
    /// In a run the way from its start to the end of the arc, at a corner that between the two, mm.
    way: f64,
}

impl Run {
    /// The path goes on with a motion.
    #[inline]
    pub(crate) fn add(&mut self, motion: &Motion) {
        self.way += motion.length;
        if let Some([_, curvature]) = motion.bends() {
            self.bend = Some(Bend {
                curvature,
                way: self.way,
            });
        }
    }

    /// Whether more of it changes nothing about the speed at the corner before it.
    #[inline]
    pub(crate) fn is_enough_for(&self, corner: &Corner) -> bool {
        self.way >= corner.reach(corner.speed)
    }

    /// The arc at some distance from the end of the run.
    #[inline]
    fn bend_before(&self) -> Option<Bend> {
        let way_to = |bend: Bend| Bend {
            way: self.way - bend.way,
            ..bend
        };
        self.bend.map(way_to).filter(|bend| bend.way > 0.0)
    }

    /// At a corner the run begins again. An arc that ends there is near to the next corner too.
    #[inline]
    pub(crate) fn turn(&mut self) {
        let ends_here = self.bend.filter(|bend| bend.way == self.way);
        self.way = 0.0;
        self.bend = ends_here.map(|bend| Bend { way: 0.0, ..bend });
    }

    /// At a stop the run begins again.
    #[inline]
    pub(crate) fn reset(&mut self) {
        *self = Run::default();
    }
}

/// A corner to pass. Its speed is known when the way to the next corner is.
#[derive(Debug)]
pub(crate) struct Corner {
    /// Speed that both motions allow, mm/s.
    speed: f64,
    /// Way from the corner or stop before, mm.
    before: f64,
    /// Contour cycle, s.
    cycle: f64,
    /// What the path can gain in speed within half a cycle, mm/s.
    gain: f64,
    steps: Steps,
    /// The nearest arcs before and after that do not begin or end at the corner itself.
    bends: [Option<Bend>; 2],
    /// Whether the one after is still to come.
    bend_to_come: bool,
}

/// The velocity steps of a corner.
#[derive(Debug)]
enum Steps {
    /// Between lines: the least `SHARE · reserve / |Δt|` and the least reserve of all axes, mm/s².
    Lines { limit: f64, reserve: f64 },
    /// Next to an arc the reserve depends on the speed: bound less acceleration along the path,
    /// difference of direction and curvature, for each axis.
    Arcs(Box<ArcSteps>),
}

#[derive(Debug)]
struct ArcSteps {
    reserve: PerAxis,
    change: PerAxis,
    curvature: PerAxis,
}

impl Joint {
    /// The joint between two motions. `run` is the path since the corner or stop before it;
    /// `any_angle` says that the corner is passed whatever its angle.
    #[inline]
    pub(crate) fn between(
        last: &Motion,
        next: &Motion,
        run: &Run,
        any_angle: bool,
        dynamics: &Dynamics,
    ) -> Joint {
        // From degrees of a rotary axis to mm there is no common speed.
        if last.rotary != next.rotary {
            return Joint::Stop;
        }
        let (from, to) = (last.end(), next.start());
        if !any_angle && cosine(&from, &to, last.rotary) < dynamics.corner_cosine {
            return Joint::Stop;
        }
        let axes = if last.main_axes && next.main_axes {
            MAIN
        } else {
            0..Axis::COUNT
        };
        let speed = last.speed.min(next.speed);
        let steps = Steps::between(&from, &to, [last.acceleration, next.acceleration], axes, dynamics);
        match steps {
            None => Joint::Smooth(speed),
            Some(steps) => Joint::Corner(Corner {
                speed,
                before: run.way,
                cycle: dynamics.cycle,
                gain: 0.5 * dynamics.cycle * last.acceleration.max(next.acceleration),
                steps,
                bends: [run.bend_before(), None],
                bend_to_come: to.curvature.is_none(),
            }),
        }
    }
}

/// Cosine of the change of direction between two motions of the same kind.
#[inline]
fn cosine(from: &MotionEnd, to: &MotionEnd, rotary: bool) -> f64 {
    let (a, b) = (from.direction, to.direction);
    let dot = product(a, b, rotary);
    if from.curvature.is_none() && to.curvature.is_none() {
        dot
    } else {
        // Where the radius of an arc changes the direction is not quite of length 1.
        dot / (product(a, a, rotary) * product(b, b, rotary)).sqrt()
    }
}

impl Corner {
    /// The way of one cycle at a speed.
    #[inline]
    fn reach(&self, speed: f64) -> f64 {
        self.cycle * (speed + self.gain)
    }

    /// After the corner and a `run` without a stop the path goes on with a motion.
    #[inline]
    pub(crate) fn meet(&mut self, next: &Motion, run: &Run) {
        if self.bend_to_come
            && let Some([curvature, _]) = next.bends()
        {
            self.bend_to_come = false;
            self.bends[1] = Some(Bend {
                curvature,
                way: run.way,
            });
        }
    }

    /// The speed of passing, mm/s, when the path to the next corner is at least `after`.
    pub(crate) fn pass_speed(&self, after: &Run) -> f64 {
        let after = after.way.max(0.0);
        if self.allows(self.speed, after) {
            return self.speed;
        }
        match &self.steps {
            Steps::Lines { limit, .. } if self.bend(self.speed) == 0.0 => {
                self.solve(*limit, after).min(self.speed)
            }
            // Rare and monotone: halving until the speed is known to a part in 2^40.
            Steps::Lines { .. } | Steps::Arcs(_) => {
                let (mut low, mut high) = (0.0, self.speed);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if self.allows(middle, after) {
                        low = middle
                    } else {
                        high = middle
                    }
                }
                low
            }
        }
    }

    /// Greatest curvature of the arcs nearby that a cycle at a speed reaches, 1/mm.
    #[inline]
    fn bend(&self, speed: f64) -> f64 {
        let mut greatest = 0.0;
        for bend in self.bends.iter().flatten() {
            if bend.curvature > greatest && bend.way < self.reach(speed) {
                greatest = bend.curvature;
            }
        }
        greatest
    }

    fn allows(&self, speed: f64, after: f64) -> bool {
        let time = self.own_time(speed, after);
        let bend = self.bend(speed);
        match &self.steps {
            Steps::Lines { limit, .. } if bend == 0.0 => speed <= limit * time,
            Steps::Lines { limit, reserve } => speed <= limit * time * (1.0 - bend * speed * speed / reserve),
            Steps::Arcs(arcs) => {
                let ArcSteps {
                    reserve,
                    change,
                    curvature,
                } = arcs.as_ref();
                let step = speed / (SHARE * time);
                (0..reserve.len()).all(|i| {
                    let towards_centre = curvature[i].max(bend) * speed * speed;
                    change[i] <= NO_CHANGE || change[i] * step + towards_centre <= reserve[i]
                })
            }
        }
    }

    /// The time τ that the corner owns. Within half a cycle the path can become faster by `gain`, so
    /// ways are at least as long in time as at that speed.
    fn own_time(&self, speed: f64, after: f64) -> f64 {
        let (half, per_way) = (0.5 * self.cycle, 0.5 / (speed + self.gain));
        (self.before * per_way).min(half) + (after * per_way).min(half)
    }

    /// The greatest v with `v <= limit · own_time(v)`. `own_time` is the least of three functions that
    /// fall with v (no way, the shorter way or both ways count), so v is the least of their solutions.
    fn solve(&self, limit: f64, after: f64) -> f64 {
        let gain = self.gain;
        // v · (v + gain) = q
        let root = |gain: f64, q: f64| 0.5 * ((gain * gain + 4.0 * q).sqrt() - gain);
        let cycle = limit * self.cycle;
        let both = root(gain, 0.5 * limit * (self.before + after));
        // v = limit · (T/2 + way / 2(v + gain)): v² + (gain - h)·v = h·gain + limit·way/2, h = limit·T/2
        let h = 0.5 * cycle;
        let shorter = root(gain - h, h * gain + 0.5 * limit * self.before.min(after));
        cycle.min(both).min(shorter)
    }
}

impl Steps {
    /// `None` when no axis changes its velocity.
    #[inline]
    fn between(
        from: &MotionEnd,
        to: &MotionEnd,
        acceleration: [f64; 2],
        axes: Range<usize>,
        dynamics: &Dynamics,
    ) -> Option<Steps> {
        let (d0, d1) = (from.direction, to.direction);
        let mut change = [0.0; Axis::COUNT];
        let mut reserve = [0.0; Axis::COUNT];
        let mut greatest = 0.0f64;
        for i in axes.clone() {
            change[i] = (d1[i] - d0[i]).abs();
            greatest = if change[i] > greatest { change[i] } else { greatest };
            let (along0, along1) = (acceleration[0] * d0[i].abs(), acceleration[1] * d1[i].abs());
            reserve[i] = dynamics.bound[i] - if along0 > along1 { along0 } else { along1 };
        }
        if greatest <= NO_CHANGE {
            return None;
        }
        if from.curvature.is_none() && to.curvature.is_none() {
            let (mut limit, mut least) = (f64::INFINITY, f64::INFINITY);
            for i in axes {
                let own = SHARE * reserve[i] / change[i].max(NO_CHANGE);
                limit = if own < limit { own } else { limit };
                least = if reserve[i] < least { reserve[i] } else { least };
            }
            return Some(Steps::Lines {
                limit,
                reserve: least,
            });
        }
        let zero = [0.0; Axis::COUNT];
        let (c0, c1) = (from.curvature.unwrap_or(zero), to.curvature.unwrap_or(zero));
        let mut curvature = zero;
        for i in 0..curvature.len() {
            curvature[i] = c0[i].abs().max(c1[i].abs());
        }
        Some(Steps::Arcs(Box::new(ArcSteps {
            reserve,
            change,
            curvature,
        })))
    }
}
