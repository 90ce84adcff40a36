//! Circles of G2 and G3, in the machine.
//!
//! Decision: Centre words count from the start of the circle; one that is missing is 0. A circle by its centre that ends
//! where it begins is a full one. R is the shorter arc, negative the longer one

use bahn_path::{Arc, Curve, Plane, Point2, Position, Sense, sweep_deg};

use crate::refusal::{Refusal, wrong};

/// How far the ends of a circle by its radius may be further apart than its diameter, as a part of it.
const ROUNDING: f64 = 1e-9;

/// How a circle is said.
pub(crate) enum By {
    /// From the start to the centre, mm.
    Centre(Point2),
    /// mm, negative for the longer arc.
    Radius(f64),
}

/// The circle between two points; `error_max` is how much its radii may differ, mm.
pub(crate) fn circle(
    plane: Plane,
    [start, end]: [&Position; 2],
    by: By,
    sense: Sense,
    error_max: f64,
) -> Result<Curve, Refusal> {
    let (from, to) = (plane.point(start), plane.point(end));
    let centre = match by {
        By::Centre([x, y]) => [from[0] + x, from[1] + y],
        By::Radius(radius) => with_radius(from, to, radius, sense)?,
    };
    let radius = |point: Point2| (point[0] - centre[0]).hypot(point[1] - centre[1]);
    if radius(from) <= 0.0 {
        return wrong("the circle has no radius");
    }
    if (radius(from) - radius(to)).abs() > error_max {
        return Err(Refusal::Numbered(
            1238,
            "the end of the circle does not lie on it: its radii differ by more than P8843",
        ));
    }
    let is_full = (from[0] - to[0]).hypot(from[1] - to[1]) <= error_max * 1e-3;
    let sweep = match is_full {
        true => match sense {
            Sense::Clockwise => -360.0,
            Sense::CounterClockwise => 360.0,
        },
        false => sweep_deg(centre, from, to, sense),
    };
    Ok(Curve::Arc(Arc {
        plane,
        centre,
        sweep_deg: sweep,
    }))
}

fn with_radius(from: Point2, to: Point2, radius: f64, sense: Sense) -> Result<Point2, Refusal> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let chord = dx.hypot(dy);
    if chord <= 0.0 {
        return wrong("a circle by its radius needs an end of its own");
    }
    let half = chord / 2.0;
    let size = radius.abs();
    if half > size * (1.0 + ROUNDING) {
        return wrong(format!("R{radius} is too small: the ends are {chord} mm apart"));
    }
    let height = (size * size - half * half).max(0.0).sqrt();
    // The centre of the shorter arc counter-clockwise lies to the left of the chord.
    let is_left = (sense == Sense::CounterClockwise) ^ (radius < 0.0);
    let height = if is_left { height } else { -height };
    Ok([
        from[0] + dx / 2.0 - dy / chord * height,
        from[1] + dy / 2.0 + dx / chord * height,
    ])
}
