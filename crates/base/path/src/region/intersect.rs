//! Common points of two segments.

use super::Segment;
use super::vector::*;
use crate::Point2;

/// The points where two segments cross, touch or begin and end to overlap, within `tolerance` mm.
/// A point may be listed twice.
pub(super) fn intersections(a: &Segment, b: &Segment, tolerance: f64) -> impl Iterator<Item = Point2> {
    // Ends on the other segment: they are all there is to overlaps and make T joints exact.
    let end = |p: Point2, other: &Segment| (other.distance(p) <= tolerance).then_some(p);
    let [first, second] = crossings(a, b, tolerance);
    [
        end(a.from(), b),
        end(a.to(), b),
        end(b.from(), a),
        end(b.to(), a),
        first,
        second,
    ]
    .into_iter()
    .flatten()
}

/// The points where two segments cross, or touch between their ends within `tolerance` mm.
pub(super) fn crossings(a: &Segment, b: &Segment, tolerance: f64) -> [Option<Point2>; 2] {
    if beside(a, b, tolerance) || beside(b, a, tolerance) {
        return [None, None];
    }
    carriers_cross(a, b, tolerance).map(|p| p.filter(|p| within(a, *p) && within(b, *p)))
}

/// Whether both ends of one line lie surely on the same side of another one: most near lines do.
fn beside(line: &Segment, other: &Segment, tolerance: f64) -> bool {
    let (Segment::Line { from, to }, Segment::Line { from: p, to: q }) = (*line, *other) else {
        return false;
    };
    let d = sub(to, from);
    let (a, b) = (cross(d, sub(p, from)), cross(d, sub(q, from)));
    a * b > 0.0 && (a * a).min(b * b) > tolerance * tolerance * dot(d, d)
}

/// Whether a point of the segment's line or circle lies between its ends. Ends themselves are found
/// by their distance.
fn within(segment: &Segment, point: Point2) -> bool {
    match *segment {
        Segment::Line { from, to } => {
            let d = sub(to, from);
            let t = dot(sub(point, from), d);
            t >= 0.0 && t <= dot(d, d)
        }
        Segment::Arc { .. } => segment.fraction_of_direction(point).is_some(),
    }
}

/// Where the straight lines and full circles that carry the segments cross.
pub(super) fn carriers_cross(a: &Segment, b: &Segment, tolerance: f64) -> [Option<Point2>; 2] {
    match (*a, *b) {
        (Segment::Line { from: p, to: p1 }, Segment::Line { from: q, to: q1 }) => {
            let (d, e) = (sub(p1, p), sub(q1, q));
            let denominator = cross(d, e);
            if denominator * denominator <= 1e-24 * dot(d, d) * dot(e, e) {
                return [None, None];
            }
            [Some(along(p, d, cross(sub(q, p), e) / denominator)), None]
        }
        (Segment::Line { from, to }, Segment::Arc { centre, .. }) => {
            line_circle(from, to, centre, b.radius().unwrap_or(0.0), tolerance)
        }
        (Segment::Arc { centre, .. }, Segment::Line { from, to }) => {
            line_circle(from, to, centre, a.radius().unwrap_or(0.0), tolerance)
        }
        (Segment::Arc { centre: c, .. }, Segment::Arc { centre: d, .. }) => circle_circle(
            c,
            a.radius().unwrap_or(0.0),
            d,
            b.radius().unwrap_or(0.0),
            tolerance,
        ),
    }
}

/// Crossings of a straight line and a circle; a line that misses by less than the tolerance touches.
pub(super) fn line_circle(
    from: Point2,
    to: Point2,
    centre: Point2,
    radius: f64,
    tolerance: f64,
) -> [Option<Point2>; 2] {
    let direction = unit(sub(to, from));
    let foot = along(from, direction, dot(sub(centre, from), direction));
    half_chord(foot, direction, distance(foot, centre), radius, tolerance)
}

fn circle_circle(c: Point2, r: f64, d: Point2, s: f64, tolerance: f64) -> [Option<Point2>; 2] {
    let between = distance(c, d);
    if between <= tolerance {
        return [None, None];
    }
    let direction = unit(sub(d, c));
    // Distance of the common chord from the first centre.
    let mut to_chord = (between * between + (r - s) * (r + s)) / (2.0 * between);
    let misses = (between - (r + s)).max((r - s).abs() - between);
    if misses > tolerance {
        return [None, None];
    }
    if misses >= 0.0 {
        to_chord = r.copysign(to_chord);
    }
    half_chord(
        along(c, direction, to_chord),
        left(direction),
        to_chord.abs(),
        r,
        tolerance,
    )
}

/// The two ends of a chord through `foot`, which is `distance` away from the centre of the circle.
fn half_chord(
    foot: Point2,
    direction: Point2,
    distance: f64,
    radius: f64,
    tolerance: f64,
) -> [Option<Point2>; 2] {
    if distance > radius + tolerance {
        return [None, None];
    }
    let half = ((radius - distance) * (radius + distance)).max(0.0).sqrt();
    [
        Some(along(foot, direction, -half)),
        Some(along(foot, direction, half)),
    ]
}
