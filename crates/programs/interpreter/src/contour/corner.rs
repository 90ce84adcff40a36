//! The way of the tool centre round the corner between two compensated elements.

use bahn_parameters::MessageId;
use bahn_path::parallel::{Flat, Joint, joint};
use bahn_path::{BlockRef, Curve, PathElement};

use super::ContourMove;
use crate::error::Fault;

/// The way round the corner between `before` (parallel curve `a`) and `item` (parallel curve `b`).
pub(crate) fn corner(before: &ContourMove, a: &Flat, item: &ContourMove, b: &Flat) -> Result<Joint, Fault> {
    let (Some(contour_a), Some(contour_b)) = (
        Flat::of(&before.element, before.plane),
        Flat::of(&item.element, item.plane),
    ) else {
        return Err(Fault::from(MessageId::PlaneWronglyDefined).at(item.element.block));
    };
    let contour = [contour_a, contour_b];
    let joint = joint(item.plane, contour, [*a, *b], item.side, before.corner.round());
    joint.ok_or_else(|| {
        Fault::new(
            MessageId::ToolRadiusTooLarge,
            "the paths beside the contour elements do not meet",
        )
        .at(shorter(before, a, item, b))
    })
}

/// The block of the shorter of two elements: the one that the tool does not fit.
fn shorter(before: &ContourMove, a: &Flat, item: &ContourMove, b: &Flat) -> BlockRef {
    if a.length() < b.length() {
        before.element.block
    } else {
        item.element.block
    }
}

/// The element that leads round an outside corner. Axes outside the plane stand where `item` starts: they may
/// have moved since the end of `before`.
pub(crate) fn transition(
    before: &ContourMove,
    item: &ContourMove,
    curve: Curve,
    joint: &Joint,
) -> PathElement {
    let mut element = bare(&before.element, curve);
    element.start = item.element.start;
    element.end = item.element.start;
    before.plane.set(&mut element.start, joint.ending.end);
    before.plane.set(&mut element.end, joint.start);
    element.tangential_end = matches!(curve, Curve::Arc(_));
    element
}

/// A copy of an element without functions and dwell, for the pieces that the control inserts.
pub(super) fn bare(element: &PathElement, curve: Curve) -> PathElement {
    PathElement {
        curve,
        functions: None,
        dwell_s: 0.0,
        constant_speed: false,
        tangential_end: false,
        end_feed: None,
        ..element.clone()
    }
}
