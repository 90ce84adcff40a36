//! How the path goes on from where it is.

use std::sync::Arc;

use bahn_path::{Axis, Curve, Function, PathElement, Placement, Position};

/// An element whose arc starts farther than this from where the path is gets a line to its start, mm.
const GAP: f64 = 1e-6;

/// The axes of an arc at a corner in space.
const CORNER: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// Lets an element start where the path is, axis by axis where that is known. An arc must start where
/// it was programmed; when that is elsewhere the answer is a line to there.
///
/// Where the element stands in another placement than the path `at` its end, that place has another name there.
pub(crate) fn connect(
    at: &Position,
    placement: Option<&Arc<Placement>>,
    element: &mut PathElement,
) -> Option<PathElement> {
    let from_source = element.start;
    let changed;
    let at = if Placement::is_same(placement, element.placement.as_ref()) {
        at
    } else {
        let [from, to] = [placement, element.placement.as_ref()].map(|placement| placement.map(Arc::as_ref));
        changed = Placement::change(from, to, at);
        &changed
    };
    // The tip of another tool stands elsewhere in the tool axis, without a movement.
    let tool_axis = element
        .functions()
        .iter()
        .find_map(|output| match &output.function {
            Function::Tool(call) => Some(call.axis),
            _ => None,
        });
    for axis in at.known().iter() {
        if tool_axis == Some(axis) && matches!(element.curve, Curve::Hold) && !from_source[axis].is_nan() {
            continue;
        }
        element.start[axis] = at[axis];
        // What the element does not move stays where it is.
        let stays = match &element.curve {
            Curve::Arc(arc) if axis == arc.plane.first || axis == arc.plane.second => false,
            Curve::Corner(_) if CORNER.contains(&axis) => false,
            _ => element.end[axis] == from_source[axis],
        };
        if stays || element.end[axis].is_nan() || matches!(element.curve, Curve::Hold) {
            element.end[axis] = at[axis];
        }
    }
    let fixed: &[Axis] = match &element.curve {
        Curve::Arc(arc) => &[arc.plane.first, arc.plane.second],
        Curve::Corner(_) => &CORNER,
        Curve::Hold | Curve::Line => return None,
    };
    let mut gap = false;
    for axis in fixed.iter().copied() {
        if !from_source[axis].is_nan() {
            gap |= (from_source[axis] - element.start[axis]).abs() > GAP;
        }
    }
    if !gap {
        return None;
    }
    let start = element.start;
    for axis in fixed.iter().copied() {
        if !from_source[axis].is_nan() {
            element.start[axis] = from_source[axis];
        }
    }
    Some(PathElement {
        block: element.block,
        sequence: element.sequence,
        curve: Curve::Line,
        start,
        end: element.start,
        feed: element.feed,
        override_law: element.override_law,
        constant_speed: false,
        tangential_end: false,
        end_feed: None,
        dwell_s: 0.0,
        placement: element.placement.clone(),
        functions: None,
    })
}
