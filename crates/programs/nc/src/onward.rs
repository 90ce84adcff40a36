//! An arc that does not begin where the block before it has ended: the axes were moved meanwhile, or the run was stopped
//! inside it.
//!
//! Decision: A run that goes on inside a block keeps the end of that block; an arc is gone on with where the axes
//! stand on it within 0.01 mm, as far as its end may lie beside it. At its start all of it is left, also of a full
//! circle, which ends there, too: it is rather cut twice than not at all

use bahn_path::{Arc, Curve, Point2, Position, Sense, sweep_deg};

/// The axes stand on the circle, at its start or at its end, when they are no farther from there than the end of an arc may
/// lie beside it, mm (inferred).
const ON_CIRCLE_MM: f64 = 0.01;

/// What is left of an arc that begins at `start`, from where the axes stand to its `end`. At the start all of it is left,
/// also of a full circle, which ends there, too: it is rather cut twice than not at all (inferred). At the end a straight
/// line is left, as long as the tolerance at most.
///
/// # Errors
/// When the arc does not lead through there.
pub(crate) fn rest(
    arc: &Arc,
    start: &Position,
    stands: &Position,
    end: &Position,
) -> Result<Curve, &'static str> {
    let at = arc.plane.point(stands);
    let (radius, _) = arc.radii(start, end);
    if (distance(at, arc.centre) - radius).abs() > ON_CIRCLE_MM {
        return Err("the arc does not lead through where the axes stand");
    }
    let from = arc.plane.point(start);
    let turn = 360.0_f64.copysign(arc.sweep_deg);
    let mut passed = sweep_deg(arc.centre, from, at, Sense::of_sweep(turn));
    // Before the start, not nearly a turn after it.
    if distance(at, from) <= ON_CIRCLE_MM && 2.0 * passed.abs() > 360.0 {
        passed -= turn;
    }
    let sweep_deg = arc.sweep_deg - passed;
    if sweep_deg * turn > 0.0 {
        return Ok(Curve::Arc(Arc { sweep_deg, ..*arc }));
    }
    if distance(at, arc.plane.point(end)) <= ON_CIRCLE_MM {
        return Ok(Curve::Line);
    }
    Err("the axes stand after the end of the arc")
}

fn distance(from: Point2, to: Point2) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1])
}
