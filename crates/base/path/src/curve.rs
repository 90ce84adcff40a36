//! Lines, arcs, helices and corner arcs between two positions.

use crate::{Axis, CornerArc, PerAxis, Plane, Point2, Position, Sense};

/// The shape of a path element between its start and end position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// No axis moves: a dwell, or functions alone.
    Hold,
    /// All axes start and end together on a straight line [003:2522-2524].
    Line,
    /// A circular arc in a plane; axes outside the plane move linearly with the angle, which makes a
    /// helix of it [003:3243-3247].
    Arc(Arc),
    /// A circular arc in any plane of X, Y and Z, between two lines that meet in a corner.
    Corner(CornerArc),
}

/// The main axes X, Y and Z.
const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// A circular arc: about `centre`, from the angle of the start point through `sweep_deg`.
///
/// When start and end radius differ within the control's tolerance (MP7431), the radius changes
/// linearly with the angle, so that the end point is met exactly (inferred) [000:7012].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// The plane of the arc.
    pub plane: Plane,
    /// Centre in the plane, mm.
    pub centre: Point2,
    /// Signed sweep about the plane's normal, degrees; positive is counter-clockwise (DR+).
    pub sweep_deg: f64,
}

impl Arc {
    /// Start and end radius, mm.
    pub fn radii(&self, start: &Position, end: &Position) -> (f64, f64) {
        let s = self.plane.point(start);
        let e = self.plane.point(end);
        (
            (s[0] - self.centre[0]).hypot(s[1] - self.centre[1]),
            (e[0] - self.centre[0]).hypot(e[1] - self.centre[1]),
        )
    }

    fn at(&self, start: &Position, end: &Position, t: f64) -> Point2 {
        let s = self.plane.point(start);
        let (r0, r1) = self.radii(start, end);
        let radius = r0 + (r1 - r0) * t;
        let angle = (s[1] - self.centre[1]).atan2(s[0] - self.centre[0]) + (self.sweep_deg * t).to_radians();
        [
            self.centre[0] + radius * angle.cos(),
            self.centre[1] + radius * angle.sin(),
        ]
    }
}

impl Curve {
    /// Length of the movement between two positions: mm over the linear axes. When only rotary axes
    /// move it is the angle in degrees, as the feed rate is then degrees per minute [003:7424-7430].
    /// Axes without a position at the start add nothing.
    pub fn length(&self, start: &Position, end: &Position) -> f64 {
        let linear = self.linear_length(start, end);
        if linear > 0.0 {
            linear
        } else {
            self.rotary_length(start, end)
        }
    }

    /// Length over the linear axes, mm.
    pub fn linear_length(&self, start: &Position, end: &Position) -> f64 {
        match self {
            Curve::Hold => 0.0,
            Curve::Line => {
                const LINEAR: [Axis; 6] = [Axis::X, Axis::Y, Axis::Z, Axis::U, Axis::V, Axis::W];
                LINEAR
                    .iter()
                    .map(|a| square_or_zero(end[*a] - start[*a]))
                    .sum::<f64>()
                    .sqrt()
            }
            Curve::Arc(arc) => {
                let (r0, r1) = arc.radii(start, end);
                // Where the radius changes within MP7431 the distance outwards counts, too: it is all there is
                // when start and end lie in the same direction from the centre.
                let around = 0.5 * (r0 + r1) * arc.sweep_deg.abs().to_radians();
                let in_plane = around.hypot(r1 - r0);
                let outside: f64 = Axis::ALL
                    .iter()
                    .filter(|a| !a.is_rotary() && !arc.plane.contains(**a))
                    .map(|a| square_or_zero(end[*a] - start[*a]))
                    .sum();
                in_plane.hypot(outside.sqrt())
            }
            Curve::Corner(corner) => [Axis::U, Axis::V, Axis::W]
                .map(|axis| square_or_zero(end[axis] - start[axis]).sqrt())
                .into_iter()
                .fold(corner.circle(start, end).length_mm, f64::hypot),
        }
    }

    /// Length over the rotary axes, degrees.
    pub fn rotary_length(&self, start: &Position, end: &Position) -> f64 {
        const ROTARY: [Axis; 3] = [Axis::A, Axis::B, Axis::C];
        ROTARY
            .iter()
            .map(|a| square_or_zero(end[*a] - start[*a]))
            .sum::<f64>()
            .sqrt()
    }

    /// The position at the fraction `t` (0 start, 1 end) of the curve.
    pub fn position(&self, start: &Position, end: &Position, t: f64) -> Position {
        if t >= 1.0 {
            return *end;
        }
        let mut result = *end;
        for axis in Axis::ALL {
            if !start[axis].is_nan() {
                result[axis] = start[axis] + (end[axis] - start[axis]) * t;
            }
        }
        match self {
            Curve::Arc(arc) => arc.plane.set(&mut result, arc.at(start, end, t)),
            Curve::Corner(corner) => {
                for (axis, value) in MAIN.into_iter().zip(corner.circle(start, end).place(t)) {
                    result[axis] = value;
                }
            }
            Curve::Hold | Curve::Line => {}
        }
        result
    }

    /// Least and greatest position of each axis on the curve. An axis without a position at the start counts
    /// with its end alone.
    pub fn bounds(&self, start: &Position, end: &Position) -> [Position; 2] {
        // `f64::min` and `max` pass over NaN.
        let mut min: Position = PerAxis::from_fn(|axis| start[axis].min(end[axis])).into();
        let mut max: Position = PerAxis::from_fn(|axis| start[axis].max(end[axis])).into();
        let arc = match self {
            Curve::Hold | Curve::Line => return [min, max],
            Curve::Corner(corner) => {
                let circle = corner.circle(start, end);
                for (i, axis) in MAIN.into_iter().enumerate() {
                    if let Some(value) = circle
                        .turning_point(i)
                        .and_then(|t| circle.place(t).get(i).copied())
                    {
                        min[axis] = min[axis].min(value);
                        max[axis] = max[axis].max(value);
                    }
                }
                return [min, max];
            }
            Curve::Arc(arc) => arc,
        };
        let s = arc.plane.point(start);
        let (r0, r1) = arc.radii(start, end);
        let first = (s[1] - arc.centre[1]).atan2(s[0] - arc.centre[0]).to_degrees();
        let (from, to) = if arc.sweep_deg < 0.0 {
            (first + arc.sweep_deg, first)
        } else {
            (first, first + arc.sweep_deg)
        };
        let quadrant = (from / 90.0).ceil();
        // A full turn and more passes all four quadrant points.
        for step in 0..4 {
            let angle = (quadrant + f64::from(step)) * 90.0;
            if angle > to {
                break;
            }
            let (axis, centre) = if (quadrant + f64::from(step)).rem_euclid(2.0) == 0.0 {
                (arc.plane.first, arc.centre[0])
            } else {
                (arc.plane.second, arc.centre[1])
            };
            let radius = r0.max(r1);
            if (quadrant + f64::from(step)).rem_euclid(4.0) < 2.0 {
                max[axis] = max[axis].max(centre + radius);
            } else {
                min[axis] = min[axis].min(centre - radius);
            }
        }
        [min, max]
    }

    /// Derivative of the position by the path length at the fraction `t`: a vector over all axes that
    /// has length 1 over the axes that [`Curve::length`] counts. Zero when nothing moves.
    pub fn tangent(&self, start: &Position, end: &Position, t: f64) -> PerAxis<f64> {
        let mut result = PerAxis::splat(0.0);
        let length = self.length(start, end);
        if length <= 0.0 {
            return result;
        }
        for axis in Axis::ALL {
            let delta = end[axis] - start[axis];
            if !delta.is_nan() {
                result[axis] = delta / length;
            }
        }
        if let Curve::Corner(corner) = self {
            let circle = corner.circle(start, end);
            for (axis, share) in MAIN.into_iter().zip(circle.direction(t)) {
                result[axis] = share * circle.length_mm / length;
            }
        }
        if let Curve::Arc(arc) = self {
            let (r0, r1) = arc.radii(start, end);
            let p = arc.at(start, end, t);
            let radius = (r0 + (r1 - r0) * t).max(f64::MIN_POSITIVE);
            let radial = [(p[0] - arc.centre[0]) / radius, (p[1] - arc.centre[1]) / radius];
            let along = arc.sweep_deg.to_radians() * radius / length;
            let outward = (r1 - r0) / length;
            result[arc.plane.first] = -radial[1] * along + radial[0] * outward;
            result[arc.plane.second] = radial[0] * along + radial[1] * outward;
        }
        result
    }

    /// The part of the curve between the fractions `from` and `to`: its shape, start and end.
    /// Curves can be split at any length, for block scan and stops inside an element.
    pub fn part(&self, start: &Position, end: &Position, from: f64, to: f64) -> (Curve, Position, Position) {
        let curve = match self {
            Curve::Arc(arc) => Curve::Arc(Arc {
                sweep_deg: arc.sweep_deg * (to - from),
                ..*arc
            }),
            Curve::Corner(corner) => Curve::Corner(corner.part(start, end, from, to)),
            Curve::Hold | Curve::Line => *self,
        };
        (
            curve,
            self.position(start, end, from),
            self.position(start, end, to),
        )
    }
}

fn square_or_zero(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value * value }
}

/// The angle of a direction, degrees in 0..360, counter-clockwise from the first axis.
pub fn angle_deg(vector: Point2) -> f64 {
    let angle = vector[1].atan2(vector[0]).to_degrees();
    if angle < 0.0 { angle + 360.0 } else { angle }
}

/// Signed sweep from the angle of `start` to the angle of `end` about `centre` in the given sense.
/// Equal points give a full circle of 360 degrees [003:2803].
pub fn sweep_deg(centre: Point2, start: Point2, end: Point2, sense: Sense) -> f64 {
    let a = [start[0] - centre[0], start[1] - centre[1]];
    let b = [end[0] - centre[0], end[1] - centre[1]];
    let cross = a[0] * b[1] - a[1] * b[0];
    let dot = a[0] * b[0] + a[1] * b[1];
    let signed = cross.atan2(dot).to_degrees();
    // Points nearer together than the control's input resolution count as one point: a full circle.
    const SAME_POINT_MM: f64 = 1e-7;
    if (end[0] - start[0]).hypot(end[1] - start[1]) < SAME_POINT_MM {
        return 360.0 * sense.sign();
    }
    // An end in the very direction of the start is a full turn in either sense.
    match sense {
        Sense::CounterClockwise if signed <= 0.0 => signed + 360.0,
        Sense::Clockwise if signed >= 0.0 => signed - 360.0,
        _ => signed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn end_in_the_direction_of_the_start_is_a_full_turn_both_ways() {
        // The end lies 0.01 mm farther out, as rounded coordinates give it (MP7431).
        let (centre, start, end) = ([50.0, 50.0], [60.0, 50.0], [60.01, 50.0]);
        assert_eq!(sweep_deg(centre, start, end, Sense::CounterClockwise), 360.0);
        assert_eq!(sweep_deg(centre, start, end, Sense::Clockwise), -360.0);
        assert_eq!(
            sweep_deg(centre, start, [50.0, 60.0], Sense::CounterClockwise),
            90.0
        );
        assert_eq!(sweep_deg(centre, start, [50.0, 60.0], Sense::Clockwise), -270.0);
    }

    #[test]
    fn the_way_outwards_counts() {
        let mut start = Position::UNKNOWN;
        Plane::XY.set(&mut start, [10.0, 0.0]);
        let mut end = start;
        Plane::XY.set(&mut end, [10.016, 0.0]);
        let arc = Curve::Arc(Arc {
            plane: Plane::XY,
            centre: [0.0, 0.0],
            sweep_deg: 0.0,
        });
        assert!((arc.length(&start, &end) - 0.016).abs() < 1e-12);
    }
}
