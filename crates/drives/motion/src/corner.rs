//! How fast a joint between two motions may be passed.
//!
//! A corner that is passed without a stop changes the velocity at once: each axis makes a step of
//! `v · |Δt|`, v the path speed and Δt the difference of the two directions. The servo spreads it over its
//! window W ([`SERVO_WINDOW_S`]); over that time the axis shows
//!
//! `Σ step · w`, w a triangle of width 2W, height 1/W and area 1:
//!
//! all velocity steps within the window together. At constant speed they stay below the bound
//! `sqrt(MP1060² + MP1070²)` of the axis, beside the ordinary acceleration, when every corner keeps
//!
//! `v · |Δt| <= SHARE · bound · τ`, where
//!
//! - `τ` is the corner's own time: half the time to the corner before and to the next one, each at most
//!   W/2. A corner for itself owns W: it is passed at the feed, whatever its angle, as long as the step is
//!   one that the servo follows. No two corners own the same time, so many small ones in a row share a
//!   window, and in the limit of short lines on a curve the law becomes one of radial acceleration,
//!   `v² <= r · a`;
//! - [`SHARE`] covers that a step acts at one instant of its own time, in the worst case the middle of
//!   the triangle.
//!
//! Decision: Corners without compensation stop unless tangential, within MP7460 or M90; those are passed at the feed
//! as far as the servo follows the step of velocity (`SERVO_WINDOW_S`)
//!
//! Decision: A rotary axis that moves beside linear ones keeps to MP7460 with a degree for a mm counted as a mm, at
//! tangential joints too; M90 passes it

use bahn_path::{Axis, PerAxis};

use crate::limits::{Dynamics, MAIN};
use crate::motion::{Motion, ROTARY, product};

/// The time over which the servo spreads a step of velocity, s *(inferred)*: 2.5 time constants of a loop
/// with kv = 1 (m/min)/mm, from which machines are commissioned [000:9674-9682]. It decides how great a
/// step may be at a corner that MP7460 or M90 passes: with MP1060 = 1 and MP1070 = 0.5 m/s² an axis may
/// change its velocity at once by 134 mm/s, so that a corner of 90 degrees is passed at 8 m/min.
pub const SERVO_WINDOW_S: f64 = 0.15;
/// The part of the bound that corners use. However corners lie, the sum of `τ · w` over them is at most
/// 5/4: one alone gives 1, two at a distance of W/2 give 9/8, three at that distance 5/4, and more do not
/// give more (searched numerically). So 4/5 keeps the bound.
const SHARE: f64 = 0.8;
/// Differences of direction below this are rounding, no corner; thousands of them in one window make
/// less than a hundredth of a corner that is felt.
const NO_CHANGE: f64 = 1e-8;

/// Which change of direction a joint may have to be passed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Passing {
    /// Up to the angle of MP7460.
    #[default]
    ByAngle,
    /// The path is tangential by construction, but for rounding; axes beside it keep to MP7460.
    Tangential,
    /// Any angle is passed at constant speed: M90.
    AnyAngle,
}

/// What happens between two motions.
#[derive(Clone, Debug)]
pub(crate) enum Joint {
    /// The path stops at the corner.
    Stop,
    /// No change of direction: passed at this speed, mm/s.
    Smooth(f64),
    /// A change of direction that is passed.
    Corner(Corner),
}

/// A corner to pass. Its speed is known when the distance to the next corner is.
#[derive(Clone, Debug)]
pub(crate) struct Corner {
    /// Speed that both motions allow, mm/s.
    speed: f64,
    /// Distance from the corner or stop before, mm.
    before: f64,
    /// The servo's window W, s.
    window: f64,
    /// The least `SHARE · bound / |Δt|` of all axes, mm/s².
    limit: f64,
}

impl Joint {
    /// The joint between two motions. `before` is the distance since the corner or stop before it, mm.
    #[inline]
    pub(crate) fn between(
        last: &Motion,
        next: &Motion,
        before: f64,
        passing: Passing,
        dynamics: &Dynamics,
    ) -> Joint {
        // From degrees of a rotary axis to mm there is no common speed.
        // Nor from a surface to its cylinder.
        if last.rotary != next.rotary || last.deg_per_mm != next.deg_per_mm {
            return Joint::Stop;
        }
        let only_main = last.main_axes && next.main_axes;
        let turn = match passing {
            Passing::AnyAngle => 1.0,
            Passing::Tangential => 1.0 - beside(last, next, only_main),
            Passing::ByAngle => cosine(last, next) - beside(last, next, only_main),
        };
        if turn < dynamics.corner_cosine || last.end_speed <= 0.0 {
            return Joint::Stop;
        }
        let axes = if only_main { &MAIN[..] } else { &Axis::ALL };
        let speed = last.speed.min(next.speed).min(last.end_speed);
        match step_limit(last.end(), next.start(), axes, dynamics) {
            None => Joint::Smooth(speed),
            Some(limit) => Joint::Corner(Corner {
                speed,
                before,
                window: dynamics.servo_window,
                limit,
            }),
        }
    }
}

/// Cosine of the change of direction between two motions of the same kind.
#[inline]
fn cosine(last: &Motion, next: &Motion) -> f64 {
    let (a, b) = (last.end(), next.start());
    let product = |a: &PerAxis<f64>, b: &PerAxis<f64>, rotary: bool| {
        let linear = product(a, b, rotary);
        if last.deg_per_mm == 0.0 {
            return linear;
        }
        // What the rotary axis turns is the distance around the cylinder.
        let turned = ROTARY.iter().map(|i| a[*i] * b[*i]).sum::<f64>();
        linear + turned / (last.deg_per_mm * last.deg_per_mm)
    };
    let dot = product(a, b, last.rotary);
    if last.swings || next.swings {
        // The axes may change how far they go for the path as suddenly as where they go: both count as one change.
        let squares = [a, b].map(|direction| product(direction, direction, last.rotary));
        return (dot - 0.5 * (squares[0] + squares[1])) / (squares[0] * squares[1]).sqrt() + 1.0;
    }
    if last.is_curved() || next.is_curved() {
        // Where the radius of an arc changes the direction is not quite of length 1.
        dot / (product(a, a, last.rotary) * product(b, b, last.rotary)).sqrt()
    } else {
        dot
    }
}

/// What rotary axes that move beside the path add to its change of direction, as a part of the cosine: a degree
/// for a mm counts like a mm, so that such an axis makes no greater step of velocity than a linear one does at a
/// corner of MP7460 (inferred). A chord `|Δt|` stands for `1 - |Δt|² / 2`.
#[inline]
fn beside(last: &Motion, next: &Motion, only_main: bool) -> f64 {
    if only_main || last.rotary || last.deg_per_mm != 0.0 {
        return 0.0;
    }
    let (a, b) = (last.end(), next.start());
    0.5 * ROTARY
        .iter()
        .map(|axis| (b[*axis] - a[*axis]) * (b[*axis] - a[*axis]))
        .sum::<f64>()
}

/// The least `SHARE · bound / |Δt|`, mm/s²; `None` when no axis changes its velocity.
#[inline]
fn step_limit(from: &PerAxis<f64>, to: &PerAxis<f64>, axes: &[Axis], dynamics: &Dynamics) -> Option<f64> {
    let (mut limit, mut greatest) = (f64::INFINITY, 0.0);
    for axis in axes.iter().copied() {
        let change = (to[axis] - from[axis]).abs();
        greatest = if change > greatest { change } else { greatest };
        let own = SHARE * dynamics.bound[axis] / change.max(NO_CHANGE);
        limit = if own < limit { own } else { limit };
    }
    (greatest > NO_CHANGE).then_some(limit)
}

impl Corner {
    /// Whether a longer distance after the corner changes nothing about its speed.
    #[inline]
    pub(crate) fn knows_enough(&self, after: f64) -> bool {
        after >= self.window * self.speed
    }

    /// The speed of passing, mm/s, when the distance to the next corner is at least `after`: the greatest v with
    /// `v <= limit · τ(v)`. τ is the least of three functions that fall with v (no distance, the shorter one or
    /// both count), so v is the least of their solutions.
    pub(crate) fn pass_speed(&self, after: f64) -> f64 {
        let (limit, half) = (self.limit, 0.5 * self.limit * self.window);
        let both = (0.5 * limit * (self.before + after)).sqrt();
        // v = limit · (W/2 + distance / 2v): v² - half·v = limit·distance/2
        let distance = self.before.min(after);
        let shorter = 0.5 * (half + (half * half + 2.0 * limit * distance).sqrt());
        self.speed.min(2.0 * half).min(both).min(shorter)
    }
}
