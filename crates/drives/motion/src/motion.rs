//! The geometry of an element as planning needs it.

use bahn_path::{Arc, Axis, CornerArc, Curve, PathElement, PerAxis, Placement, Point2, Position};

use crate::limits::{Dynamics, MAIN, Slowest};
use crate::placed::Placed;

/// Axes in degrees.
pub(crate) const ROTARY: [Axis; 3] = [Axis::A, Axis::B, Axis::C];
/// Axes parallel to X, Y and Z.
const PARALLEL: [Axis; 3] = [Axis::U, Axis::V, Axis::W];
/// Shorter movements count as standstill, mm or degrees: a thousandth of the finest resolution of any model.
const NO_LENGTH: f64 = 1e-7;
/// Longer movements count as this long, mm: no machine has them, and sums stay finite.
const LONGEST: f64 = 1e12;
/// An axis with a smaller share of the path does not move; it is rounding (a µm on a metre). At any
/// speed and acceleration of the machine parameters such an axis is far below its own limits.
const MOVES: f64 = 1e-6;
/// An axis that moves the length of the path, and what rounding adds.
const WHOLE: f64 = 1.0 + 1e-9;

/// An element that moves: its length, how fast it can be, and the direction at its ends.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    /// Path length, mm, or degrees when only rotary axes move.
    pub(crate) length: f64,
    /// Greatest path speed, mm/s; 0 when it cannot move.
    pub(crate) speed: f64,
    /// Greatest path speed at the end, mm/s, beside all that the joint there says.
    pub(crate) end_speed: f64,
    /// How fast its axes let it be.
    pub(crate) slowest: Slowest,
    /// Path speed that the radial acceleration allows, mm/s; infinite on lines.
    pub(crate) radial_speed: f64,
    /// Path acceleration, mm/s².
    pub(crate) acceleration: f64,
    /// Whether the length counts degrees of the rotary axes.
    pub(crate) rotary: bool,
    /// A line of X, Y and Z alone, which most are: formulas may leave out the other axes.
    pub(crate) main_axes: bool,
    /// Swivel axes are compensated: the main axes go farther, or less far, than the path.
    pub(crate) swings: bool,
    /// Degrees of the rotary axis for a mm of the path around a cylinder, either sign; 0 where none is unrolled.
    pub(crate) deg_per_mm: f64,
    /// Derivative of the axes by the path length at the start; of a line everywhere.
    direction: PerAxis<f64>,
    /// That at the end of an arc.
    end_direction: Option<PerAxis<f64>>,
}

impl Motion {
    /// The motion of an element, `None` when it has no length. Axes without a position at the start
    /// add nothing.
    #[inline]
    pub(crate) fn of(element: &PathElement, dynamics: &Dynamics) -> Option<Motion> {
        match &element.curve {
            Curve::Hold => None,
            Curve::Line => Motion::line(element, dynamics),
            Curve::Arc(arc) => Motion::arc(element, arc, dynamics),
            Curve::Corner(arc) => Motion::corner(element, arc, dynamics),
        }
    }

    fn line(element: &PathElement, dynamics: &Dynamics) -> Option<Motion> {
        let delta = known_delta(&element.start, &element.end);
        let (length, rotary) = path_length(&delta)?;
        let per_length = 1.0 / length;
        let direction = delta.map(|d| d * per_length);
        let share = direction.map(f64::abs);
        let main_axes = delta.values()[MAIN.len()..].iter().all(|d| *d == 0.0);
        let share = if main_axes {
            &share.values()[..MAIN.len()]
        } else {
            share.values()
        };
        let slowest = slowest(share, dynamics);
        let motion = Motion {
            length: length.min(LONGEST),
            speed: dynamics.speed(element.feed, element.override_law, slowest),
            end_speed: end_speed(element),
            slowest,
            radial_speed: f64::INFINITY,
            acceleration: acceleration(share, dynamics).min(dynamics.spindle_acceleration(element)),
            rotary,
            main_axes,
            swings: false,
            deg_per_mm: 0.0,
            direction,
            end_direction: None,
        };
        Some(motion.placed(element, dynamics))
    }

    /// The motion of the axes where the path does not stand upright in the machine.
    #[inline]
    fn placed(self, element: &PathElement, dynamics: &Dynamics) -> Motion {
        match &element.placement {
            None => self,
            Some(placement) => self.transformed(placement, element, dynamics),
        }
    }

    fn transformed(self, placement: &Placement, element: &PathElement, dynamics: &Dynamics) -> Motion {
        let per_square = dynamics.radial / (self.radial_speed * self.radial_speed);
        let ends = [*self.start(), *self.end()];
        let placed = Placed::new(placement, element, ends, per_square, dynamics);
        let [direction, end_direction] = placed.directions;
        let slowest = slowest(placed.share.values(), dynamics);
        let radial_speed = self.radial_speed.min(placed.speed);
        let cylinder = placement.cylinder();
        let swings = placement.rotation().is_none() && cylinder.is_none();
        Motion {
            speed: dynamics
                .speed(element.feed, element.override_law, slowest)
                .min(radial_speed),
            slowest,
            radial_speed,
            acceleration: acceleration(placed.share.values(), dynamics)
                .min(dynamics.spindle_acceleration(element)),
            direction,
            swings,
            deg_per_mm: cylinder.map_or(0.0, |cylinder| cylinder.deg_per_mm),
            main_axes: self.main_axes && cylinder.is_none(),
            // Where swivel axes turn, a straight line is curved in the machine; a direction is then not of length 1.
            end_direction: (self.end_direction.is_some() || swings).then_some(end_direction),
            ..self
        }
    }

    fn arc(element: &PathElement, arc: &Arc, dynamics: &Dynamics) -> Option<Motion> {
        let plane = [arc.plane.first, arc.plane.second];
        let (from, r0) = polar(arc.plane.point(&element.start), arc.centre);
        let (to, r1) = polar(arc.plane.point(&element.end), arc.centre);
        let sweep = arc.sweep_deg.to_radians();
        let mut delta = known_delta(&element.start, &element.end);
        // Put the length in the plane, around and outwards, in the place of the chord.
        delta[plane[0]] = 0.5 * (r0 + r1) * sweep.abs();
        delta[plane[1]] = r1 - r0;
        let (length, rotary) = path_length(&delta)?;
        let per_length = 1.0 / length;

        // By the path length the angle changes with `turn` and the radius with `outward`.
        let turn = sweep * per_length;
        let outward = (r1 - r0) * per_length;
        let tangent = |radial: Point2, r: f64| {
            [
                -radial[1] * turn * r + radial[0] * outward,
                radial[0] * turn * r + radial[1] * outward,
            ]
        };
        let (start_direction, end_direction) = (tangent(from, r0), tangent(to, r1));
        let greatest = r0.max(r1);
        let fastest = (greatest * turn).hypot(outward);

        let mut direction = delta.map(|d| d * per_length);
        let mut share = direction.map(f64::abs);
        for i in 0..2 {
            direction[plane[i]] = start_direction[i];
            // The axis is fastest where the arc crosses the direction of the other axis from the
            // centre, else at one of its ends; the ends alone do not decide when the radius changes.
            let crosses = sweep.abs() >= std::f64::consts::PI || from[i] * to[i] <= 0.0;
            let at_ends = start_direction[i].abs().max(end_direction[i].abs());
            let spiral = (r1 - r0).abs() > NO_LENGTH;
            share[plane[i]] = if crosses || spiral { fastest } else { at_ends };
        }
        // Radial acceleration of a point that turns and moves outward: r·w² and 2·r'·w. On a circle
        // this is v = sqrt(r · MP1070) [000:5080-5086].
        let per_square = (greatest * turn * turn).hypot(2.0 * outward * turn);
        let radial_speed = if per_square > 0.0 {
            (dynamics.radial / per_square).sqrt()
        } else {
            f64::INFINITY
        };
        let directions = [direction, in_plane(&direction, plane, end_direction)];
        let along = (length, rotary);
        Some(Motion::curved(
            along,
            radial_speed,
            share,
            directions,
            element,
            dynamics,
        ))
    }

    /// The arc at a corner in space: a circle of any plane, beside which other axes may move.
    fn corner(element: &PathElement, arc: &CornerArc, dynamics: &Dynamics) -> Option<Motion> {
        let circle = arc.circle(&element.start, &element.end);
        let mut delta = known_delta(&element.start, &element.end);
        for (axis, length) in MAIN.into_iter().zip([circle.length_mm, 0.0, 0.0]) {
            delta[axis] = length;
        }
        let (length, rotary) = path_length(&delta)?;
        let around = circle.length_mm / length;
        let mut directions = [delta.map(|d| d / length); 2];
        let mut share = directions[0].map(f64::abs);
        for (i, axis) in MAIN.into_iter().enumerate() {
            let along = [0, 1, 2].map(|k| f64::from(u8::from(k == i)));
            share[axis] = circle.greatest_share(along) * around;
        }
        for (directions, t) in directions.iter_mut().zip([0.0, 1.0]) {
            for (axis, share) in MAIN.into_iter().zip(circle.direction(t)) {
                directions[axis] = share * around;
            }
        }
        // v = sqrt(r · MP1070), as on every circle [000:5080-5086].
        let radial_speed = (dynamics.radial * circle.radius_mm).sqrt() / around;
        let along = (length, rotary);
        Some(Motion::curved(
            along,
            radial_speed,
            share,
            directions,
            element,
            dynamics,
        ))
    }

    /// The motion on an arc of a length, which counts rotary axes or not.
    fn curved(
        (length, rotary): (f64, bool),
        radial_speed: f64,
        share: PerAxis<f64>,
        [direction, end_direction]: [PerAxis<f64>; 2],
        element: &PathElement,
        dynamics: &Dynamics,
    ) -> Motion {
        let slowest = slowest(share.values(), dynamics);
        let speed = dynamics.speed(element.feed, element.override_law, slowest);
        let motion = Motion {
            length: length.min(LONGEST),
            speed: speed.min(radial_speed),
            end_speed: end_speed(element),
            slowest,
            radial_speed,
            acceleration: acceleration(share.values(), dynamics),
            rotary,
            main_axes: false,
            swings: false,
            deg_per_mm: 0.0,
            direction,
            end_direction: Some(end_direction),
        };
        motion.placed(element, dynamics)
    }

    /// Derivative of the axes by the path length at the start.
    #[inline]
    pub(crate) fn start(&self) -> &PerAxis<f64> {
        &self.direction
    }

    /// Derivative of the axes by the path length at the end.
    #[inline]
    pub(crate) fn end(&self) -> &PerAxis<f64> {
        self.end_direction.as_ref().unwrap_or(&self.direction)
    }

    /// Whether it is an arc.
    #[inline]
    pub(crate) fn is_curved(&self) -> bool {
        self.end_direction.is_some()
    }
}

/// Greatest speed at the end of an element, mm/s, whatever the override is.
fn end_speed(element: &PathElement) -> f64 {
    element
        .end_feed
        .map_or(f64::INFINITY, |feed| feed.max(0.0) / 60.0)
}

/// The axes with other values in a plane.
fn in_plane(axes: &PerAxis<f64>, plane: [Axis; 2], values: Point2) -> PerAxis<f64> {
    let mut axes = *axes;
    axes[plane[0]] = values[0];
    axes[plane[1]] = values[1];
    axes
}

/// Scalar product over the axes that the path length counts.
#[inline]
pub(crate) fn product(a: &PerAxis<f64>, b: &PerAxis<f64>, rotary: bool) -> f64 {
    let sum = |axes: [Axis; 3]| axes.iter().map(|axis| a[*axis] * b[*axis]).sum::<f64>();
    if rotary {
        sum(ROTARY)
    } else {
        sum(MAIN) + sum(PARALLEL)
    }
}

#[inline]
fn known_delta(start: &Position, end: &Position) -> PerAxis<f64> {
    PerAxis::from_fn(|axis| {
        let d = end[axis] - start[axis];
        if d.is_nan() { 0.0 } else { d }
    })
}

/// Path length and whether it counts rotary axes: they do only when no linear axis moves
/// [003:7424-7430].
#[inline]
fn path_length(delta: &PerAxis<f64>) -> Option<(f64, bool)> {
    let squares = |[a, b, c]: [Axis; 3]| delta[a] * delta[a] + delta[b] * delta[b] + delta[c] * delta[c];
    let linear = squares(MAIN) + squares(PARALLEL);
    let least = NO_LENGTH * NO_LENGTH;
    if linear > least {
        return linear.is_finite().then(|| (linear.sqrt(), false));
    }
    let rotary = squares(ROTARY);
    (rotary > least && rotary.is_finite()).then(|| (rotary.sqrt(), true))
}

/// How fast the axes let a movement be.
#[inline]
fn slowest(share: &[f64], dynamics: &Dynamics) -> Slowest {
    let mut slowest = Slowest::default();
    for (share, slowness) in share.iter().zip(dynamics.slowness.values()) {
        let share = if *share > MOVES { *share } else { 0.0 };
        let time = share * slowness;
        slowest.time = if time > slowest.time { time } else { slowest.time };
        slowest.share = if share > slowest.share {
            share
        } else {
            slowest.share
        };
    }
    slowest
}

/// The smallest MP1060 of the moving axes [000:4749]. An axis that moves farther than the path is long
/// (a rotary axis beside a short line) must not exceed its own either (inferred).
#[inline]
fn acceleration(share: &[f64], dynamics: &Dynamics) -> f64 {
    let mut least = f64::INFINITY;
    let mut farthest = 0.0f64;
    for (share, acceleration) in share.iter().zip(dynamics.acceleration.values()) {
        let a = if *share > MOVES {
            *acceleration
        } else {
            f64::INFINITY
        };
        least = if a < least { a } else { least };
        farthest = if *share > farthest { *share } else { farthest };
    }
    if farthest > WHOLE {
        for (share, acceleration) in share.iter().zip(dynamics.acceleration.values()) {
            least = least.min(acceleration / share.max(MOVES));
        }
    }
    least
}

/// Unit vector from the centre to a point, and the distance.
fn polar(point: Point2, centre: Point2) -> (Point2, f64) {
    let d = [point[0] - centre[0], point[1] - centre[1]];
    let r = d[0].hypot(d[1]);
    (if r > 0.0 { d.map(|x| x / r) } else { [1.0, 0.0] }, r)
}
