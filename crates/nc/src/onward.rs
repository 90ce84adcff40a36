//! A motion that does not begin where the block before it has ended: the axes were moved meanwhile, or the run was stopped
//! inside it.

use bahn_din::Motion;
use bahn_path::{Arc, Axis, Curve, Position, sweep_deg};

/// The axes stand on the circle when they are no farther from it than its end may be, mm (inferred).
const ON_CIRCLE_MM: f64 = 0.01;

/// The same motion from where the axes stand to its end. Axes that it does not move stay where they stand.
///
/// # Errors
/// When an arc does not lead through there.
pub(crate) fn from(motion: &Motion, stands: &Position) -> Result<Motion, &'static str> {
    let mut end = motion.end;
    for axis in Axis::ALL.into_iter().filter(|axis| !turns(motion, *axis)) {
        if motion.start[axis] == motion.end[axis] || motion.end[axis].is_nan() {
            end[axis] = stands[axis];
        }
    }
    let curve = match motion.curve {
        Curve::Arc(arc) => Curve::Arc(rest(&arc, motion, stands)?),
        other => other,
    };
    Ok(Motion {
        curve,
        start: *stands,
        end,
        ..motion.clone()
    })
}

/// An arc moves both axes of its plane, also where it ends at its start.
fn turns(motion: &Motion, axis: Axis) -> bool {
    matches!(&motion.curve, Curve::Arc(arc) if axis == arc.plane.first || axis == arc.plane.second)
}

/// What is left of an arc.
fn rest(arc: &Arc, motion: &Motion, stands: &Position) -> Result<Arc, &'static str> {
    let at = arc.plane.point(stands);
    let start = arc.plane.point(&motion.start);
    let (radius, _) = arc.radii(&motion.start, &motion.end);
    let away = (at[0] - arc.centre[0]).hypot(at[1] - arc.centre[1]) - radius;
    if away.abs() > ON_CIRCLE_MM {
        return Err("the arc does not lead through where the axes stand");
    }
    if at == start {
        return Ok(*arc);
    }
    let passed = sweep_deg(arc.centre, start, at, arc.sweep_deg > 0.0);
    let left = arc.sweep_deg - passed;
    if left * arc.sweep_deg < 0.0 {
        return Err("the axes stand behind the end of the arc");
    }
    Ok(Arc {
        sweep_deg: left,
        ..*arc
    })
}
