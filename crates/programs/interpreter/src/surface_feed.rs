//! M116: the feed of rotary axes is that of the tool over the workpiece, mm/min [000:6559-6561].
//!
//! Decision: M116 counts the radius in the middle of a block; half a turn under M126 goes in positive direction (also
//! `interpreter/src/tilting.rs`)

use bahn_path::{Axis, Curve, FeedRate, Position};

use crate::context::Context;
use crate::numbers::known;

/// The feed of a movement of which the tool's way over the workpiece is longer, or shorter, than what the path counts: the
/// linear axes alone, or degrees where only rotary axes move. A rotary axis whose centre the machine geometry does not
/// describe adds nothing, and where no other moves its feed stays one in degrees/min.
pub(crate) fn surface_feed(
    c: &Context<'_>,
    feed: FeedRate,
    curve: &Curve,
    [start, end]: [&Position; 2],
) -> FeedRate {
    let (true, FeedRate::Programmed(programmed)) = (c.modal.tilting.surface_feed, feed) else {
        return feed;
    };
    let linear = curve.linear_length(start, end);
    let way = |axis: Axis| {
        let turn = (end[axis] - start[axis]).to_radians();
        // Where the linear axes move as well the radius is that in the middle of both (inferred).
        let radius = 0.5 * (radius_mm(c, axis, start)? + radius_mm(c, axis, end)?);
        (!turn.is_nan()).then_some(radius * turn)
    };
    let ways = [Axis::A, Axis::B, Axis::C].map(way).into_iter().flatten();
    let surface = ways.fold(linear, f64::hypot);
    // Nothing of it has a way: the tool is in the centre.
    if surface <= 0.0 {
        return feed;
    }
    FeedRate::Programmed(programmed * curve.length(start, end) / surface)
}

/// How far the tip is from the centre of a rotary axis, mm.
fn radius_mm(c: &Context<'_>, axis: Axis, path: &Position) -> Option<f64> {
    let swivels = c.settings.rules.swivels.as_ref()?;
    let (tool_axis, length) = (c.modal.plane.normal, c.modal.length_mm.unwrap_or(0.0));
    let tool = [Axis::X, Axis::Y, Axis::Z].map(|main| if main == tool_axis { length } else { 0.0 });
    let mut axes = match &c.pen.placement {
        Some(placement) => placement.to_nose(path),
        None => {
            let mut nose = *path;
            nose[tool_axis] += length;
            nose
        }
    };
    let zero = &c.settings.rules.machine_zero;
    for axis in Axis::ALL {
        axes[axis] = known(axes[axis]) - known(zero[axis]);
    }
    swivels.radius_mm(axis, &axes, tool)
}
