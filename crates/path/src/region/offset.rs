//! Regions grown and shrunk by a radius.

use super::arrangement::direction_at;
use super::vector::*;
use super::{Contour, RESOLUTION_MM, Region, Segment};
use crate::Point2;
use std::f64::consts::{PI, TAU};

impl Region {
    /// The region grown by a radius (positive, mm) or shrunk by it (negative): all points within the
    /// radius of the area, or all points from which the radius stays inside. Outside corners become arcs,
    /// inside corners intersections; arcs stay arcs. A shrunk region may fall apart or vanish.
    #[must_use]
    pub fn offset(&self, distance: f64) -> Region {
        if distance.abs() <= RESOLUTION_MM || !distance.is_finite() {
            return self.clone();
        }
        // Every outer contour and every hole is moved by itself: its moved elements, joined by arcs
        // about its corners, wind once or more around exactly the points of the grown area, or of the
        // shrunk one (the convolution of the contour with the circle). Parts and holes are put
        // together again by winding numbers.
        let mut moved: Vec<(usize, Contour)> = Vec::new();
        let mut parts: Vec<std::ops::Range<usize>> = Vec::new();
        for contour in &self.contours().to_vec() {
            let operand = moved.len();
            if contour.is_counter_clockwise() {
                parts.push(operand..operand);
            }
            let shrinks = contour.is_counter_clockwise() == (distance < 0.0);
            let vanishes = shrinks && contour.area() <= PI * distance * distance * (1.0 + 1e-9);
            // A vanished outer contour keeps its operand, with winding number 0.
            let chain = if vanishes {
                Contour::start_at(contour.start())
            } else {
                convolution(contour, distance)
            };
            moved.push((operand, chain));
            if let Some(part) = parts.last_mut() {
                part.end = moved.len();
            }
        }
        let contours: Vec<(usize, &Contour)> = moved.iter().map(|(operand, c)| (*operand, c)).collect();
        Region::overlay(&contours, moved.len(), &|winding| {
            parts.iter().any(|part| match winding.get(part.clone()) {
                // Holes run clockwise: a grown part's hole that still exists winds -1.
                Some([outer, holes @ ..]) => *outer >= 1 && holes.iter().all(|hole| *hole >= 0),
                _ => false,
            })
        })
    }

    /// What a tool of a radius can machine of the region without leaving it: shrunk, then grown again.
    /// Inside corners keep a remnant.
    #[must_use]
    pub fn opening(&self, radius: f64) -> Region {
        let radius = radius.abs();
        self.offset(-radius).offset(radius)
    }
}

/// The contour with every element moved to its right by `distance` (negative: left) and with an arc of
/// that radius about every corner, turned through the angle by which the direction changes there.
fn convolution(contour: &Contour, distance: f64) -> Contour {
    let mut moved: Vec<Segment> = Vec::new();
    let segments = contour.segments();
    let pairs = segments.iter().zip(segments.iter().cycle().skip(1));
    for (segment, next) in pairs {
        moved.extend(moved_right(segment, distance));
        let corner = segment.to();
        let (incoming, outgoing) = (segment.tangent(1.0), next.tangent(0.0));
        let turn = corner_angle(segment, next);
        let from = along(corner, left(incoming), -distance);
        let to = along(corner, left(outgoing), -distance);
        let arc = Segment::Arc {
            from,
            to,
            centre: corner,
            sweep_deg: turn.to_degrees(),
        };
        if segments.len() > 1 || !segment.is_full_circle() {
            moved.push(arc);
        }
    }
    // The chain may have steps below the resolution; it starts where its first element does.
    Contour::from_segments(moved).unwrap_or_else(|| Contour::start_at(contour.start()))
}

/// A line moved to its right, or an arc with the same centre. An arc moved beyond its centre goes on
/// on the other side; one moved onto its centre is gone.
fn moved_right(segment: &Segment, by: f64) -> Option<Segment> {
    match *segment {
        Segment::Line { from, to } => {
            let right = scale(left(unit(sub(to, from))), -by);
            Some(Segment::Line {
                from: add(from, right),
                to: add(to, right),
            })
        }
        Segment::Arc {
            from,
            to,
            centre,
            sweep_deg,
        } => {
            let radius = segment.radius()?;
            let moved = radius + by * sweep_deg.signum();
            let point = |p: Point2| along(centre, unit(sub(p, centre)), moved);
            let gone = moved.abs() <= RESOLUTION_MM;
            (!gone).then(|| Segment::Arc {
                from: point(from),
                to: point(to),
                centre,
                sweep_deg,
            })
        }
    }
}

/// Angle by which the direction turns between two segments, radians, left positive. At a cusp, where the
/// way goes straight back, the curvatures decide whether the tip (left turn) or the notch is inside.
fn corner_angle(segment: &Segment, next: &Segment) -> f64 {
    // Contours do not cross themselves, so this near to a cusp the order farther on is the order at it.
    const CUSP: f64 = 1e-3;
    let angle = angle_between(segment.tangent(1.0), next.tangent(0.0));
    if PI - angle.abs() > CUSP {
        return angle;
    }
    let reach = |s: &Segment| s.length().min(s.radius().unwrap_or(f64::INFINITY));
    let chord = 0.5 * reach(segment).min(reach(next));
    let back = direction_at(&segment.reversed(), chord);
    let on = direction_at(next, chord);
    match (angle > 0.0, cross(on, back) >= 0.0) {
        (true, false) => angle - TAU,
        (false, true) => angle + TAU,
        _ => angle,
    }
}
