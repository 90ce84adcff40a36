//! G02 and G03: the arc between two positions.

use bahn_path::{Arc, Curve, Plane, Point2, Position, Sense, sweep_deg};

/// How the centre is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Centre {
    /// I, J, K from the start, 0 where it does not stand [public: G162 is in force from the start].
    FromStart([f64; 3]),
    /// R: the shorter arc, or with a negative value the longer one (public).
    Radius(f64),
}

/// The end may lie this far from the circle through the start, mm (inferred).
const TOLERANCE_MM: f64 = 0.01;

/// The arc from start to end in a plane.
pub(crate) fn arc(
    plane: Plane,
    start: &Position,
    end: &Position,
    centre: Centre,
    sense: Sense,
) -> Result<Curve, String> {
    let (s, e) = (plane.point(start), plane.point(end));
    let centre = match centre {
        Centre::FromStart(ijk) => {
            // I belongs to X, J to Y, K to Z, whatever the plane.
            let along = |axis| ijk.get(bahn_path::Axis::index(axis)).copied().unwrap_or_default();
            [s[0] + along(plane.first), s[1] + along(plane.second)]
        }
        Centre::Radius(radius) => about(s, e, radius, sense)?,
    };
    let sweep_deg = sweep_deg(centre, s, e, sense);
    let arc = Arc {
        plane,
        centre,
        sweep_deg,
    };
    let (from, to) = arc.radii(start, end);
    if from <= TOLERANCE_MM {
        return Err("the circle has no radius".into());
    }
    if (from - to).abs() > TOLERANCE_MM {
        return Err(format!(
            "the end lies {:.4} mm beside the circle, whose radius is {from:.4} mm",
            (from - to).abs()
        ));
    }
    Ok(Curve::Arc(arc))
}

/// The centre of a circle of a radius through two points.
fn about(s: Point2, e: Point2, radius: f64, sense: Sense) -> Result<Point2, String> {
    let (dx, dy) = (e[0] - s[0], e[1] - s[1]);
    let chord = dx.hypot(dy);
    if chord == 0.0 {
        return Err("R describes no full circle".into());
    }
    let half = chord / 2.0;
    if radius.abs() < half - TOLERANCE_MM {
        return Err(format!("R={radius} does not reach the end, {chord:.4} mm away"));
    }
    let height = (radius * radius - half * half).max(0.0).sqrt();
    // Of the shorter arc the centre lies on the side to which it turns.
    let side = sense.sign() * if radius > 0.0 { height } else { -height };
    Ok([
        s[0] + dx / 2.0 - dy / chord * side,
        s[1] + dy / 2.0 + dx / chord * side,
    ])
}
