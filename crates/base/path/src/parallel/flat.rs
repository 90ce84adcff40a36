//! Lines and arcs of a contour seen in its plane: tangents, offsets, intersections.

use crate::{Curve, PathElement, Plane, Point2};

/// The plane part of a contour element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flat {
    /// A straight line with a length.
    Line {
        /// Start point, mm.
        start: Point2,
        /// End point, mm.
        end: Point2,
    },
    /// A circular arc.
    Arc {
        /// Start point, mm.
        start: Point2,
        /// End point, mm.
        end: Point2,
        /// Centre, mm.
        centre: Point2,
        /// Signed sweep, degrees; positive is counter-clockwise.
        sweep_deg: f64,
    },
}

impl Flat {
    /// The plane part of an element; `None` when it does not move in the plane.
    pub fn of(element: &PathElement, plane: Plane) -> Option<Flat> {
        let (start, end) = (plane.point(&element.start), plane.point(&element.end));
        match element.curve {
            Curve::Arc(arc) if arc.plane.contains(plane.first) && arc.plane.contains(plane.second) => {
                Some(Flat::Arc {
                    start,
                    end,
                    centre: arc.centre,
                    sweep_deg: arc.sweep_deg,
                })
            }
            Curve::Line if distance(start, end) > SAME_POINT_MM => Some(Flat::Line { start, end }),
            _ => None,
        }
    }

    /// Start point, mm.
    pub fn start(&self) -> Point2 {
        match *self {
            Flat::Line { start, .. } | Flat::Arc { start, .. } => start,
        }
    }

    /// End point, mm.
    pub fn end(&self) -> Point2 {
        match *self {
            Flat::Line { end, .. } | Flat::Arc { end, .. } => end,
        }
    }

    /// Unit direction of travel at the start.
    pub fn start_tangent(&self) -> Point2 {
        self.tangent_at(self.start())
    }

    /// Unit direction of travel at the end.
    pub fn end_tangent(&self) -> Point2 {
        self.tangent_at(self.end())
    }

    fn tangent_at(&self, point: Point2) -> Point2 {
        match *self {
            Flat::Line { start, end } => unit(sub(end, start)),
            Flat::Arc {
                centre, sweep_deg, ..
            } => {
                let radial = unit(sub(point, centre));
                scale(left(radial), sweep_deg.signum())
            }
        }
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        match *self {
            Flat::Line { start, end } => distance(start, end),
            Flat::Arc {
                start,
                end,
                centre,
                sweep_deg,
            } => 0.5 * (distance(start, centre) + distance(end, centre)) * sweep_deg.abs().to_radians(),
        }
    }

    /// The parallel curve at a distance to the left (negative: to the right). `None` when the radius
    /// of an arc would turn negative: the tool does not fit.
    pub fn offset(&self, to_left: f64) -> Option<Flat> {
        match *self {
            Flat::Line { start, end } => {
                let normal = scale(left(unit(sub(end, start))), to_left);
                Some(Flat::Line {
                    start: add(start, normal),
                    end: add(end, normal),
                })
            }
            Flat::Arc {
                start,
                end,
                centre,
                sweep_deg,
            } => {
                let outwards = -to_left * sweep_deg.signum();
                let moved = |p: Point2| {
                    let radius = distance(p, centre);
                    let result = radius + outwards;
                    (result > -SAME_POINT_MM).then(|| along(centre, unit(sub(p, centre)), result.max(0.0)))
                };
                Some(Flat::Arc {
                    start: moved(start)?,
                    end: moved(end)?,
                    centre,
                    sweep_deg,
                })
            }
        }
    }

    /// Path length from the start to a point on the carrier, forwards for a line's extension, for an
    /// arc in -180..180 degrees around the start.
    pub fn beyond_start(&self, point: Point2) -> f64 {
        match *self {
            Flat::Line { start, end } => dot(sub(point, start), unit(sub(end, start))),
            Flat::Arc {
                start,
                centre,
                sweep_deg,
                ..
            } => {
                angle_between(sub(start, centre), sub(point, centre))
                    * sweep_deg.signum()
                    * distance(start, centre)
            }
        }
    }

    /// Path length from a point on the carrier to the end: positive before the end.
    pub fn before_end(&self, point: Point2) -> f64 {
        match *self {
            Flat::Line { start, end } => dot(sub(end, point), unit(sub(end, start))),
            Flat::Arc {
                end,
                centre,
                sweep_deg,
                ..
            } => {
                angle_between(sub(point, centre), sub(end, centre))
                    * sweep_deg.signum()
                    * distance(end, centre)
            }
        }
    }

    /// The point of its carrier that is nearest to another point: where an arc about that one touches it.
    pub fn nearest(&self, to: Point2) -> Point2 {
        match *self {
            Flat::Line { start, end } => {
                let u = unit(sub(end, start));
                along(start, u, dot(sub(to, start), u))
            }
            Flat::Arc { start, centre, .. } => along(centre, unit(sub(to, centre)), distance(start, centre)),
        }
    }

    /// Intersections of the carriers: the whole straight lines and circles.
    pub fn intersections(&self, other: &Flat) -> Intersections {
        match (*self, *other) {
            (Flat::Line { start: a, end: b }, Flat::Line { start: c, end: d }) => line_line(a, b, c, d),
            (Flat::Line { start: a, end: b }, Flat::Arc { start, centre, .. })
            | (Flat::Arc { start, centre, .. }, Flat::Line { start: a, end: b }) => {
                line_circle(a, b, centre, distance(start, centre))
            }
            (
                Flat::Arc {
                    start: s1,
                    centre: c1,
                    ..
                },
                Flat::Arc {
                    start: s2,
                    centre: c2,
                    ..
                },
            ) => circle_circle(c1, distance(s1, c1), c2, distance(s2, c2)),
        }
    }
}

/// Up to two points.
pub type Intersections = [Option<Point2>; 2];

/// Points nearer together than this count as one, mm: a thousandth of the finest input step.
pub const SAME_POINT_MM: f64 = 1e-7;

fn line_line(a: Point2, b: Point2, c: Point2, d: Point2) -> Intersections {
    let (u, v) = (unit(sub(b, a)), unit(sub(d, c)));
    let denominator = cross(u, v);
    if denominator.abs() < 1e-12 {
        return [None, None];
    }
    let t = cross(sub(c, a), v) / denominator;
    [Some(along(a, u, t)), None]
}

fn line_circle(a: Point2, b: Point2, centre: Point2, radius: f64) -> Intersections {
    let u = unit(sub(b, a));
    let foot = along(a, u, dot(sub(centre, a), u));
    let height = distance(foot, centre);
    if height > radius + SAME_POINT_MM {
        return [None, None];
    }
    let half = (radius * radius - height * height).max(0.0).sqrt();
    [Some(along(foot, u, half)), Some(along(foot, u, -half))]
}

fn circle_circle(c1: Point2, r1: f64, c2: Point2, r2: f64) -> Intersections {
    let d = distance(c1, c2);
    if d < SAME_POINT_MM || d > r1 + r2 + SAME_POINT_MM || d < (r1 - r2).abs() - SAME_POINT_MM {
        return [None, None];
    }
    let along_axis = (r1 * r1 - r2 * r2 + d * d) / (2.0 * d);
    let half = (r1 * r1 - along_axis * along_axis).max(0.0).sqrt();
    let u = unit(sub(c2, c1));
    let foot = along(c1, u, along_axis);
    [
        Some(along(foot, left(u), half)),
        Some(along(foot, left(u), -half)),
    ]
}

// Small vectors of the plane.

/// The sum of two vectors.
pub fn add(a: Point2, b: Point2) -> Point2 {
    [a[0] + b[0], a[1] + b[1]]
}

/// `a` less `b`.
pub fn sub(a: Point2, b: Point2) -> Point2 {
    [a[0] - b[0], a[1] - b[1]]
}

/// The vector so many times as long.
pub fn scale(a: Point2, factor: f64) -> Point2 {
    [a[0] * factor, a[1] * factor]
}

/// `a` moved by `length` along the direction `u`.
pub fn along(a: Point2, u: Point2, length: f64) -> Point2 {
    [a[0] + u[0] * length, a[1] + u[1] * length]
}

/// The scalar product.
pub fn dot(a: Point2, b: Point2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive when `b` points to the left of `a`.
pub fn cross(a: Point2, b: Point2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The vector turned 90 degrees counter-clockwise.
pub fn left(a: Point2) -> Point2 {
    [-a[1], a[0]]
}

/// How far two points are apart.
pub fn distance(a: Point2, b: Point2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The vector at length 1; zero stays zero.
pub fn unit(a: Point2) -> Point2 {
    let length = a[0].hypot(a[1]);
    if length > 0.0 {
        [a[0] / length, a[1] / length]
    } else {
        [0.0, 0.0]
    }
}

/// Angle from `a` to `b`, radians in -pi..pi, counter-clockwise positive.
pub fn angle_between(a: Point2, b: Point2) -> f64 {
    cross(a, b).atan2(dot(a, b))
}
