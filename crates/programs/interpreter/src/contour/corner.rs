//! The way of the tool centre round the corner between two compensated elements.

use bahn_parameters::MessageId;
use bahn_path::{Arc, BlockRef, Curve, PathElement, Point2};

use super::flat::{self, Flat, SAME_POINT_MM};
use super::{ContourMove, Corner};
use crate::error::Fault;

/// Change of direction up to which two elements count as tangential: programs give arc ends rounded to
/// 0.001 mm, so tangential transitions are a little off. The tool comes nearer to the contour by at
/// most R (1 - cos 0.1°) = 1.5e-6 R (inferred).
const TANGENTIAL_DEG: f64 = 0.1;

/// Where and how a compensated element ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ending {
    pub end: Point2,
    /// Path length cut off at the end; negative when extended.
    pub end_cut: f64,
}

/// The way round a corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    /// End of the element before.
    pub ending: Ending,
    /// Start of the element after, and the path length cut off there.
    pub start: Point2,
    pub start_cut: f64,
    /// What lies between end and start.
    pub transition: Option<Curve>,
}

/// The way round the corner between `before` (parallel curve `a`) and `item` (parallel curve `b`).
pub(crate) fn corner(before: &ContourMove, a: &Flat, item: &ContourMove, b: &Flat) -> Result<Joint, Fault> {
    let (Some(contour_a), Some(contour_b)) = (
        Flat::of(&before.element, before.plane),
        Flat::of(&item.element, item.plane),
    ) else {
        return Err(Fault::from(MessageId::PlaneWronglyDefined).at(item.element.block));
    };
    let point = contour_b.start();
    let turn = flat::angle_between(contour_a.end_tangent(), contour_b.start_tangent());
    let outside = turn * item.side.sign() < 0.0;
    let straight = turn.abs().to_degrees() < TANGENTIAL_DEG;
    let gap = flat::distance(a.end(), b.start());
    let perpendicular = |transition| Joint {
        ending: Ending {
            end: a.end(),
            end_cut: 0.0,
        },
        start: b.start(),
        start_cut: 0.0,
        transition,
    };
    match before.corner {
        _ if gap <= SAME_POINT_MM => Ok(Joint {
            start: a.end(),
            ..perpendicular(None)
        }),
        _ if straight => Ok(perpendicular(Some(Curve::Line))),
        Corner::Open => Ok(perpendicular(Some(Curve::Line))),
        Corner::Normal if outside => {
            let sweep_deg = bahn_path::sweep_deg(point, a.end(), b.start(), item.side.sense().opposite());
            let arc = Arc {
                plane: item.plane,
                centre: point,
                sweep_deg,
            };
            Ok(perpendicular(Some(Curve::Arc(arc))))
        }
        Corner::Normal => intersect(before, a, item, b, 1.0),
        Corner::Intersection => intersect(before, a, item, b, if outside { -1.0 } else { 1.0 }),
    }
}

/// Intersection of the parallels: `sign` +1 inside (elements are shortened), -1 outside (M97: they are
/// extended). Of two intersections the one with the least change counts.
fn intersect(
    before: &ContourMove,
    a: &Flat,
    item: &ContourMove,
    b: &Flat,
    sign: f64,
) -> Result<Joint, Fault> {
    let cuts = |point: &Point2| (a.before_end(*point), b.beyond_start(*point));
    let usable = |point: &Point2| {
        let (back, forward) = cuts(point);
        back * sign >= -SAME_POINT_MM && forward * sign >= -SAME_POINT_MM
    };
    let none = |block| {
        Fault::new(
            MessageId::ToolRadiusTooLarge,
            "the paths beside the contour elements do not meet",
        )
        .at(block)
    };
    let point = a
        .intersections(b)
        .into_iter()
        .flatten()
        .filter(usable)
        .min_by(|p, q| {
            let size = |point: &Point2| {
                let (back, forward) = cuts(point);
                back.abs() + forward.abs()
            };
            size(p).total_cmp(&size(q))
        })
        .ok_or_else(|| none(shorter(before, a, item, b)))?;
    let (end_cut, start_cut) = cuts(&point);
    Ok(Joint {
        ending: Ending { end: point, end_cut },
        start: point,
        start_cut,
        transition: None,
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
        ..element.clone()
    }
}
