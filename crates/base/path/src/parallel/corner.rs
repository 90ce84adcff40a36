//! Roundings and chamfers between two elements of a contour.

use super::flat::{self, Flat, SAME_POINT_MM};
use crate::{Arc, Curve, PathElement, Plane, Point2, Sense};

/// Sine of the change of direction up to which there is no corner to round.
const TANGENTIAL: f64 = 1e-6;

/// It does not go in between the elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

/// An arc between two elements that touches both.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    /// Where it touches the element before, mm.
    pub from: Point2,
    /// Where it touches the element after, mm.
    pub to: Point2,
    /// The arc.
    pub arc: Arc,
}

/// The arc of a radius between two elements; `None` when these are tangential: there is no corner to round.
///
/// # Errors
/// When the radius is too large for the elements.
pub fn rounding(plane: Plane, [a, b]: [Flat; 2], radius: f64) -> Result<Option<Rounded>, TooLarge> {
    let (ta, tb) = (a.end_tangent(), b.start_tangent());
    let turn = flat::cross(ta, tb);
    if turn.abs() < TANGENTIAL && flat::dot(ta, tb) > 0.0 {
        return Ok(None);
    }
    let side = if turn > 0.0 { 1.0 } else { -1.0 };
    let (Some(oa), Some(ob)) = (a.offset(side * radius), b.offset(side * radius)) else {
        return Err(TooLarge);
    };
    // The centre is the intersection of the parallels; with arcs take the one nearest to the corner
    // whose tangent points lie on both elements.
    let corner = a.end();
    let fits = |centre: &Point2| {
        let (back, forward) = (oa.before_end(*centre), ob.beyond_start(*centre));
        let slack = SAME_POINT_MM;
        back >= -slack && forward >= -slack && back <= oa.length() + slack && forward <= ob.length() + slack
    };
    let centre = oa
        .intersections(&ob)
        .into_iter()
        .flatten()
        .filter(fits)
        .min_by(|p, q| flat::distance(*p, corner).total_cmp(&flat::distance(*q, corner)))
        .ok_or(TooLarge)?;
    let (from, to) = (a.nearest(centre), b.nearest(centre));
    let sweep_deg = crate::sweep_deg(centre, from, to, Sense::of_sweep(side));
    let arc = Arc {
        plane,
        centre,
        sweep_deg,
    };
    Ok(Some(Rounded { from, to, arc }))
}

/// Start and end of the straight cut that takes so much, mm, off two straight lines.
///
/// # Errors
/// When one of them is shorter.
pub fn chamfer([a, b]: [Flat; 2], length: f64) -> Result<[Point2; 2], TooLarge> {
    if length > a.length() + SAME_POINT_MM || length > b.length() + SAME_POINT_MM {
        return Err(TooLarge);
    }
    Ok([
        flat::along(a.end(), a.end_tangent(), -length),
        flat::along(b.start(), b.start_tangent(), length),
    ])
}

/// Shortens two elements to what was put between them.
pub fn cut(plane: Plane, [before, after]: [&mut PathElement; 2], [a, b]: [Flat; 2], [from, to]: [Point2; 2]) {
    shorten(&mut before.curve, a.before_end(from) / a.length());
    plane.set(&mut before.end, from);
    shorten(&mut after.curve, b.beyond_start(to) / b.length());
    plane.set(&mut after.start, to);
}

fn shorten(curve: &mut Curve, fraction: f64) {
    if let Curve::Arc(arc) = curve {
        arc.sweep_deg *= 1.0 - fraction;
    }
}
