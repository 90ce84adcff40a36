//! G2 and G3: the arc between two positions of the control.

use bahn_path::{Arc, Plane, Point2, Position, Sense, sweep_deg};

use crate::refusal::Refusal;

/// How the centre is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Centre {
    /// From the start, along the axes of the plane.
    FromStart(Point2),
    /// The shorter arc, or with a negative value the longer one (inferred).
    Radius(f64),
}

/// The message of a radius that differs too much [002:4371-4376].
const RADIUS_ERROR: u16 = 1238;

/// The arc in a plane; the radius at its end may differ so much from that at its start, mm.
pub(crate) fn arc(
    plane: Plane,
    [start, end]: [&Position; 2],
    centre: Centre,
    sense: Sense,
    admitted_mm: f64,
) -> Result<Arc, Refusal> {
    let (s, e) = (plane.point(start), plane.point(end));
    let centre = match centre {
        Centre::FromStart([i, j]) => [s[0] + i, s[1] + j],
        Centre::Radius(radius) => about(s, e, radius, sense, admitted_mm)?,
    };
    let arc = Arc {
        plane,
        centre,
        sweep_deg: sweep_deg(centre, s, e, sense),
    };
    let (from, to) = arc.radii(start, end);
    if from <= admitted_mm {
        return Err(Refusal::of("the circle has no radius"));
    }
    match (from - to).abs() > admitted_mm {
        true => Err(Refusal::numbered(
            RADIUS_ERROR,
            format!("the radius is {from:.4} mm at the start of the circle and {to:.4} mm at its end"),
        )),
        false => Ok(arc),
    }
}

/// The centre of a circle of a radius through two points.
fn about(s: Point2, e: Point2, radius: f64, sense: Sense, admitted_mm: f64) -> Result<Point2, Refusal> {
    let (dx, dy) = (e[0] - s[0], e[1] - s[1]);
    let chord = dx.hypot(dy);
    if chord == 0.0 {
        return Err(Refusal::of("R describes no full circle"));
    }
    let half = chord / 2.0;
    if radius.abs() < half - admitted_mm {
        let detail = format!("R{radius} does not reach the end, {chord:.4} mm away");
        return Err(Refusal::numbered(RADIUS_ERROR, detail));
    }
    let height = (radius * radius - half * half).max(0.0).sqrt();
    // Of the shorter arc the centre lies on the side to which it turns.
    let side = sense.sign() * if radius > 0.0 { height } else { -height };
    Ok([
        s[0] + dx / 2.0 - dy / chord * side,
        s[1] + dy / 2.0 + dx / chord * side,
    ])
}

/// The radius of an arc, mm; where it changes the one in the middle.
pub(crate) fn radius(arc: &Arc, start: &Position, end: &Position) -> f64 {
    let (from, to) = arc.radii(start, end);
    (from + to) / 2.0
}
