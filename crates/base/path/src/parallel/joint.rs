//! The way of the tool centre round the corner between two compensated elements.

use super::flat::{self, Flat, SAME_POINT_MM};
use super::side::Side;
use crate::{Arc, Curve, Plane, Point2};

/// Change of direction up to which two elements count as tangential: programs give arc ends rounded to
/// 0.001 mm, so tangential transitions are a little off. The tool comes nearer to the contour by at
/// most R (1 - cos 0.1°) = 1.5e-6 R (inferred).
const TANGENTIAL_DEG: f64 = 0.1;
/// An element that would be run backwards by more than this is too short for the tool, mm.
const BACKWARDS_MM: f64 = 1e-6;

/// How the path goes round a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Round {
    /// An arc about the corner where it lies outside, the intersection inside.
    Arc,
    /// The intersection outside, too.
    Meet,
    /// Both parallels in full, and straight from one to the other.
    Open,
}

/// Where and how a compensated element ends.
#[derive(Clone, Copy, Debug)]
pub struct Ending {
    /// End point, mm.
    pub end: Point2,
    /// Path length cut off at the end, mm; negative when extended.
    pub end_cut: f64,
}

/// The way round a corner.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// End of the element before.
    pub ending: Ending,
    /// Start of the element after, mm.
    pub start: Point2,
    /// Path length cut off there, mm.
    pub start_cut: f64,
    /// What lies between end and start.
    pub transition: Option<Curve>,
}

/// The change of direction from one element to the next, degrees; positive is counter-clockwise.
pub fn turn_deg([before, after]: [Flat; 2]) -> f64 {
    flat::angle_between(before.end_tangent(), after.start_tangent()).to_degrees()
}

/// The way round the corner between two elements of a contour, whose parallels are `a` and `b`; `None` where these do not
/// meet.
pub fn joint(plane: Plane, contour: [Flat; 2], [a, b]: [Flat; 2], side: Side, round: Round) -> Option<Joint> {
    let [_, after] = contour;
    let turn = turn_deg(contour);
    let outside = turn * side.sign() < 0.0;
    let straight = turn.abs() < TANGENTIAL_DEG;
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
    match round {
        _ if gap <= SAME_POINT_MM => Some(Joint {
            start: a.end(),
            ..perpendicular(None)
        }),
        _ if straight => Some(perpendicular(Some(Curve::Line))),
        Round::Open => Some(perpendicular(Some(Curve::Line))),
        Round::Arc if outside => {
            let centre = after.start();
            let sweep_deg = crate::sweep_deg(centre, a.end(), b.start(), side.sense().opposite());
            let arc = Arc {
                plane,
                centre,
                sweep_deg,
            };
            Some(perpendicular(Some(Curve::Arc(arc))))
        }
        Round::Arc => intersection(&a, &b, 1.0),
        Round::Meet => intersection(&a, &b, if outside { -1.0 } else { 1.0 }),
    }
}

/// The way from one parallel to another on the shortest way at their intersection, whatever the contour does between them.
pub fn meeting(a: &Flat, b: &Flat) -> Option<Joint> {
    intersection(a, b, 1.0)
}

/// Intersection of the parallels: `sign` +1 inside (elements are shortened), -1 outside (they are
/// extended). Of two intersections the one with the least change counts.
fn intersection(a: &Flat, b: &Flat, sign: f64) -> Option<Joint> {
    let cuts = |point: &Point2| (a.before_end(*point), b.beyond_start(*point));
    let usable = |point: &Point2| {
        let (back, forward) = cuts(point);
        back * sign >= -SAME_POINT_MM && forward * sign >= -SAME_POINT_MM
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
        })?;
    let (end_cut, start_cut) = cuts(&point);
    Some(Joint {
        ending: Ending { end: point, end_cut },
        start: point,
        start_cut,
        transition: None,
    })
}

/// The shape of an element beside the contour, of whose parallel so much is cut off at both ends; `None` where it would be
/// run backwards.
pub fn what_is_left(curve: Curve, parallel: &Flat, start_cut: f64, end_cut: f64) -> Option<Curve> {
    let length = parallel.length();
    let left_over = length - start_cut - end_cut;
    if left_over < -BACKWARDS_MM {
        return None;
    }
    Some(match curve {
        Curve::Arc(arc) if length > SAME_POINT_MM => Curve::Arc(Arc {
            sweep_deg: arc.sweep_deg * (left_over / length).max(0.0),
            ..arc
        }),
        // An inside arc of exactly the tool radius: the tool centre stands still.
        Curve::Arc(_) => Curve::Line,
        other => other,
    })
}
