//! Lines and circular arcs of the plane.
//!
//! Decision: An arc that ends beside the circle of its start (MP7431) gets a centre that fits both ends, or a short
//! line where that would move nearly a full circle

use super::RESOLUTION_MM;
use super::vector::*;
use crate::{Point2, Sense, sweep_deg};

/// Consecutive segments are one when centres or the point between them are no farther off than this, mm ...
const JOIN_MM: f64 = 1e-7;
/// ... and lines when they also turn by less than this sine: chains of short lines that follow a
/// curve stay as they are.
const JOIN_SINE: f64 = 1e-9;

/// A straight line or a circular arc between two points of the plane, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// A straight line.
    Line {
        /// Start point, mm.
        from: Point2,
        /// End point, mm.
        to: Point2,
    },
    /// A circular arc. `from` equal to `to` with a sweep of +-360 degrees is a full circle. Both ends
    /// are as far from the centre; [`Contour::push`](super::Contour::push) mends what rounding made of that.
    Arc {
        /// Start point, mm.
        from: Point2,
        /// End point, mm.
        to: Point2,
        /// Centre, mm.
        centre: Point2,
        /// Signed sweep, degrees; positive is counter-clockwise (DR+).
        sweep_deg: f64,
    },
}

impl Segment {
    /// A straight line between two points, mm.
    pub fn line(from: Point2, to: Point2) -> Segment {
        Segment::Line { from, to }
    }

    /// An arc about `centre` in the given sense; equal points give a full circle [003:2803]. When the
    /// two radii differ a little, the centre is moved along the chord until they agree, unless that
    /// moves the arc by more than twice the difference: nearly a full circle.
    pub fn arc(from: Point2, to: Point2, centre: Point2, sense: Sense) -> Segment {
        let about = |centre: Point2| Segment::Arc {
            from,
            to,
            centre,
            sweep_deg: sweep_deg(centre, from, to, sense),
        };
        let given = about(centre);
        let chord = unit(sub(to, from));
        let aside = dot(sub(middle(from, to), centre), chord);
        // Up to a half circle no point is moved farther than an end; beyond, one opposite the chord is.
        let near = |sweep: f64| sweep <= 180.0 || aside.abs() <= 2.0 * given.radii_differ();
        match given {
            Segment::Arc { sweep_deg, .. } if sweep_deg.abs() < 360.0 && near(sweep_deg.abs()) => {
                about(along(centre, chord, aside))
            }
            given => given,
        }
    }

    /// An arc whose radii differ by more than the resolution, as they do between rounded coordinates
    /// (MP7431 allows 0.016 mm), as one whose radii are the same, and the line to its end that may be left.
    pub(super) fn mended(&self) -> [Option<Segment>; 2] {
        let Segment::Arc {
            from,
            to,
            centre,
            sweep_deg,
        } = *self
        else {
            return [Some(*self), None];
        };
        if self.radii_differ() <= RESOLUTION_MM {
            return [Some(*self), None];
        }
        let mended = Segment::arc(from, to, centre, Sense::of_sweep(sweep_deg));
        if mended.radii_differ() <= RESOLUTION_MM {
            return [Some(mended), None];
        }
        let end = along(centre, unit(sub(to, centre)), distance(from, centre));
        let arc = Segment::Arc {
            from,
            to: end,
            centre,
            sweep_deg,
        };
        [Some(arc), Some(Segment::line(end, to))]
    }

    /// How much the radii at both ends of an arc differ, mm.
    fn radii_differ(&self) -> f64 {
        match *self {
            Segment::Line { .. } => 0.0,
            Segment::Arc { from, to, centre, .. } => (distance(from, centre) - distance(to, centre)).abs(),
        }
    }

    /// Where the segment begins, mm.
    pub fn from(&self) -> Point2 {
        match *self {
            Segment::Line { from, .. } | Segment::Arc { from, .. } => from,
        }
    }

    /// Where the segment ends, mm.
    pub fn to(&self) -> Point2 {
        match *self {
            Segment::Line { to, .. } | Segment::Arc { to, .. } => to,
        }
    }

    /// Radius of an arc, mm; `None` for a line.
    pub fn radius(&self) -> Option<f64> {
        match *self {
            Segment::Line { .. } => None,
            Segment::Arc { from, to, centre, .. } => {
                Some(0.5 * (distance(from, centre) + distance(to, centre)))
            }
        }
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        match *self {
            Segment::Line { from, to } => distance(from, to),
            Segment::Arc { sweep_deg, .. } => self.radius().unwrap_or(0.0) * sweep_deg.abs().to_radians(),
        }
    }

    /// The point at the fraction `t` (0 start, 1 end).
    pub fn point(&self, t: f64) -> Point2 {
        match *self {
            _ if t <= 0.0 => self.from(),
            _ if t >= 1.0 => self.to(),
            Segment::Line { from, to } => along(from, sub(to, from), t),
            Segment::Arc {
                from,
                to,
                centre,
                sweep_deg,
            } => {
                let (r0, r1) = (distance(from, centre), distance(to, centre));
                let direction = turned(unit(sub(from, centre)), sweep_deg.to_radians() * t);
                along(centre, direction, r0 + (r1 - r0) * t)
            }
        }
    }

    /// Unit vector of the direction of travel at the fraction `t`; zero for a segment without length.
    pub fn tangent(&self, t: f64) -> Point2 {
        match *self {
            Segment::Line { from, to } => unit(sub(to, from)),
            Segment::Arc {
                from,
                centre,
                sweep_deg,
                ..
            } => {
                let radial = turned(
                    unit(sub(from, centre)),
                    sweep_deg.to_radians() * t.clamp(0.0, 1.0),
                );
                scale(left(radial), sweep_deg.signum())
            }
        }
    }

    /// The same segment travelled the other way.
    #[must_use]
    pub fn reversed(&self) -> Segment {
        match *self {
            Segment::Line { from, to } => Segment::Line { from: to, to: from },
            Segment::Arc {
                from,
                to,
                centre,
                sweep_deg,
            } => Segment::Arc {
                from: to,
                to: from,
                centre,
                sweep_deg: -sweep_deg,
            },
        }
    }

    /// The part between the fractions `t0` and `t1`.
    #[must_use]
    pub fn part(&self, t0: f64, t1: f64) -> Segment {
        let (from, to) = (self.point(t0), self.point(t1));
        match *self {
            Segment::Line { .. } => Segment::Line { from, to },
            Segment::Arc {
                centre, sweep_deg, ..
            } => Segment::Arc {
                from,
                to,
                centre,
                sweep_deg: sweep_deg * (t1 - t0),
            },
        }
    }

    /// The nearest point of the segment to `point`, as a fraction and the point itself.
    pub fn nearest(&self, point: Point2) -> (f64, Point2) {
        match *self {
            Segment::Line { from, to } => {
                let d = sub(to, from);
                let square = dot(d, d);
                let t = if square > 0.0 {
                    (dot(sub(point, from), d) / square).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                (t, self.point(t))
            }
            Segment::Arc { .. } => {
                if let Some(t) = self.fraction_of_direction(point) {
                    return (t, self.point(t));
                }
                let start = distance(point, self.from()) <= distance(point, self.to());
                if start {
                    (0.0, self.from())
                } else {
                    (1.0, self.to())
                }
            }
        }
    }

    /// Distance of a point to the segment, mm.
    pub fn distance(&self, point: Point2) -> f64 {
        distance(self.nearest(point).1, point)
    }

    /// Least and greatest corner of the bounding box.
    pub fn bounding_box(&self) -> (Point2, Point2) {
        let ((x0, x1), (y0, y1)) = (self.extent([1.0, 0.0]), self.extent([0.0, 1.0]));
        ([x0, y0], [x1, y1])
    }

    /// Least and greatest coordinate along a direction (unit vector).
    pub(super) fn extent(&self, direction: Point2) -> (f64, f64) {
        let (a, b) = (dot(self.from(), direction), dot(self.to(), direction));
        let (mut min, mut max) = (a.min(b), a.max(b));
        if let (Segment::Arc { centre, .. }, Some(radius)) = (*self, self.radius()) {
            for extreme in [
                along(centre, direction, radius),
                along(centre, direction, -radius),
            ] {
                if self.fraction_of_direction(extreme).is_some() {
                    min = min.min(dot(extreme, direction));
                    max = max.max(dot(extreme, direction));
                }
            }
        }
        (min, max)
    }

    /// Area between the segment and the origin, positive when the origin lies on its left: the summand
    /// of the shoelace formula, for an arc with the circular segment `r²/2 (φ - sin φ)`.
    pub(super) fn area_to_origin(&self) -> f64 {
        let triangle = 0.5 * cross(self.from(), self.to());
        match *self {
            Segment::Line { .. } => triangle,
            Segment::Arc { sweep_deg, .. } => {
                let (r, sweep) = (self.radius().unwrap_or(0.0), sweep_deg.to_radians());
                triangle + 0.5 * r * r * (sweep - sweep.sin())
            }
        }
    }

    /// Contribution of the segment to the winding number about a point, times one turn: the chord seen
    /// from the point by its crossing with the ray along `ray`, and the circular segment if the
    /// point lies between chord and arc.
    ///
    /// The chord counts half open (a chord end exactly on the ray belongs to one side, as if the point
    /// were a trifle to the left of the ray), and both tests use the same side of the chord, so that
    /// contributions of a closed chain always add up.
    pub(super) fn winding(&self, point: Point2, ray: Point2) -> i32 {
        let (a, b) = (sub(self.from(), point), sub(self.to(), point));
        let (above_a, above_b) = (cross(ray, a) > 0.0, cross(ray, b) > 0.0);
        let side = cross(a, b);
        let chord = match (above_a, above_b) {
            (false, true) if side > 0.0 => 1,
            (true, false) if side <= 0.0 => -1,
            _ => 0,
        };
        let Segment::Arc {
            centre, sweep_deg, ..
        } = *self
        else {
            return chord;
        };
        let radius = self.radius().unwrap_or(0.0);
        let counter_clockwise = sweep_deg > 0.0;
        // A counter-clockwise arc of any sweep lies right of its chord.
        let in_circle = distance(point, centre) < radius;
        // A chord through the point along the ray lies on either side by rounding alone.
        let left_of_chord = side > 0.0 || (side == 0.0 && above_a == above_b && dot(sub(b, a), ray) > 0.0);
        let on_arc_side = left_of_chord != counter_clockwise;
        let inside = in_circle && (on_arc_side || self.is_full_circle());
        match (inside, counter_clockwise) {
            (false, _) => chord,
            (true, true) => chord + 1,
            (true, false) => chord - 1,
        }
    }

    /// Whether it is longer than the resolution and finite.
    pub(super) fn is_proper(&self) -> bool {
        let length = self.length();
        length > RESOLUTION_MM && length.is_finite() && self.to().iter().all(|v| v.is_finite())
    }

    /// The segment between points that differ from its ends by no more than rounding or the resolution.
    pub(super) fn with_ends(&self, from: Point2, to: Point2) -> Segment {
        match *self {
            Segment::Line { .. } => Segment::Line { from, to },
            Segment::Arc {
                centre, sweep_deg, ..
            } => {
                let to = if self.is_full_circle() { from } else { to };
                Segment::Arc {
                    from,
                    to,
                    centre,
                    sweep_deg,
                }
            }
        }
    }

    /// The segment moved by a vector.
    pub(super) fn moved(&self, by: Point2) -> Segment {
        match *self {
            Segment::Line { from, to } => Segment::Line {
                from: add(from, by),
                to: add(to, by),
            },
            Segment::Arc {
                from,
                to,
                centre,
                sweep_deg,
            } => Segment::Arc {
                from: add(from, by),
                to: add(to, by),
                centre: add(centre, by),
                sweep_deg,
            },
        }
    }

    /// This segment and the one after it as one, if they belong to the same line or circle.
    pub(super) fn joined(&self, next: &Segment) -> Option<Segment> {
        match (*self, *next) {
            (Segment::Line { from, to: joint }, Segment::Line { to, .. }) => {
                let straight = Segment::Line { from, to };
                let (a, b) = (unit(sub(joint, from)), unit(sub(to, joint)));
                let forward = dot(a, b) > 0.0 && cross(a, b).abs() <= JOIN_SINE;
                (forward && straight.distance(joint) <= JOIN_MM).then_some(straight)
            }
            (
                Segment::Arc {
                    from,
                    to: joint,
                    centre,
                    sweep_deg: a,
                },
                Segment::Arc {
                    to,
                    centre: next_centre,
                    sweep_deg: b,
                    ..
                },
            ) => {
                let same_circle = distance(centre, next_centre) <= JOIN_MM
                    && (distance(from, centre) - distance(joint, centre)).abs() <= RESOLUTION_MM;
                let sweep_deg = a + b;
                let closes = distance(from, to) <= RESOLUTION_MM;
                if !same_circle || a.signum() != b.signum() || sweep_deg.abs() > 360.0 + 1e-6 {
                    None
                } else if closes && sweep_deg.abs() > 180.0 {
                    Some(Segment::Arc {
                        from,
                        to: from,
                        centre,
                        sweep_deg: 360f64.copysign(a),
                    })
                } else {
                    Some(Segment::Arc {
                        from,
                        to,
                        centre,
                        sweep_deg,
                    })
                }
            }
            _ => None,
        }
    }

    pub(super) fn is_full_circle(&self) -> bool {
        matches!(*self, Segment::Arc { sweep_deg, .. } if sweep_deg.abs() >= 360.0)
    }

    /// The fraction of an arc at which it points, seen from the centre, to `point`; `None` beside the arc.
    /// Within the resolution of an end it counts as that end.
    pub(super) fn fraction_of_direction(&self, point: Point2) -> Option<f64> {
        let Segment::Arc {
            from,
            centre,
            sweep_deg,
            ..
        } = *self
        else {
            return None;
        };
        let radius = self.radius().unwrap_or(0.0);
        let towards = sub(point, centre);
        if radius <= 0.0 || length(towards) <= 0.0 || sweep_deg == 0.0 {
            return None;
        }
        let mut angle = angle_between(sub(from, centre), towards).to_degrees() * sweep_deg.signum();
        let slack = (RESOLUTION_MM / radius).to_degrees();
        if angle < 0.0 {
            angle += 360.0;
        }
        let total = sweep_deg.abs();
        match angle {
            a if a <= total => Some(a / total),
            a if a <= total + slack => Some(1.0),
            a if a >= 360.0 - slack => Some(0.0),
            _ => None,
        }
    }

    /// The segment cut into equal pieces so that none sweeps more than 120 degrees.
    pub(super) fn pieces(&self) -> Vec<Segment> {
        const MAX_SWEEP_DEG: f64 = 120.0;
        match *self {
            Segment::Arc { sweep_deg, .. } if sweep_deg.abs() > MAX_SWEEP_DEG => {
                let count = (sweep_deg.abs() / MAX_SWEEP_DEG - 1e-9).ceil().clamp(1.0, 8.0);
                let step = 1.0 / count;
                (0..count as usize)
                    .map(|i| self.part(i as f64 * step, (i + 1) as f64 * step))
                    .collect()
            }
            _ => vec![*self],
        }
    }
}
