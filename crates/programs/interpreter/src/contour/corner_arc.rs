//! M112: rounding arcs at the corners of straight, uncompensated blocks [000:5128-5158]; M124: points that are left out for
//! them.
//!
//! Decision: M112 rounds corners of lines of X, Y and Z, between skew ones by an arc in their own plane (`CornerArc`
//! of `path`), and of lines of any axes that lie in one main plane; beside other axes a corner stays sharp; a of r3
//! counts the axes that move; M124 without T leaves no point out, nor one with a function or before something that is
//! no straight line

mod radius;

use bahn_path::{At, Axis, AxisSet, Curve, FeedRate, PathElement, Placement, Plane};

use super::{ContourMove, Side};

pub(crate) use radius::CornerArcs;

/// The main axes, in which an arc may lie in any plane.
const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// M124: whether the point at the end of a movement is left out, unless the path goes on otherwise than in a straight
/// line after it.
pub(crate) fn is_left_out(item: &ContourMove) -> bool {
    let spacing = item.corner_arcs.map_or(0.0, |arcs| arcs.spacing_mm);
    let element = &item.element;
    spacing > 0.0
        && is_plain(item)
        && element.functions().is_empty()
        && element.dwell_s == 0.0
        && item.barrier.is_none()
        && element.start.known() == element.end.known()
        && element.length() < spacing
}

/// Whether a movement may begin where one began whose end is left out.
pub(crate) fn takes_over(left_out: &ContourMove, item: &ContourMove) -> bool {
    item.corner_arcs.is_some()
        && is_plain(item)
        && item.element.functions().iter().all(|output| output.at == At::End)
        && Placement::is_same(
            left_out.element.placement.as_ref(),
            item.element.placement.as_ref(),
        )
}

/// An uncompensated line of linear axes.
fn is_plain(item: &ContourMove) -> bool {
    let turns = |axis: Axis| axis.is_rotary() && item.element.moves(axis);
    item.side == Side::Off && item.element.curve == Curve::Line && !Axis::ALL.into_iter().any(turns)
}

/// Where an arc of M112 lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Lies {
    /// In a main plane.
    In(Plane),
    /// In any plane of X, Y and Z.
    InSpace,
}

/// Where the arc between two movements lies and its radius, mm; `None` where M112 makes none: elsewhere than between
/// uncompensated lines of the axes of one main plane or of X, Y and Z, and where the path stops for a function.
pub(crate) fn arc_between(held: &ContourMove, held_length: f64, item: &ContourMove) -> Option<(Lies, f64)> {
    let arcs = held.corner_arcs.filter(|_| item.corner_arcs.is_some())?;
    let both = [held, item];
    if both
        .iter()
        .any(|movement| movement.side != Side::Off || movement.element.curve != Curve::Line)
    {
        return None;
    }
    let moves = |axis: &Axis| both.iter().any(|movement| movement.element.moves(*axis));
    let moving: AxisSet = Axis::ALL.into_iter().filter(moves).collect();
    let plane = [held.plane, Plane::XY, Plane::YZ, Plane::ZX]
        .into_iter()
        .find(|plane| moving.iter().all(|axis| plane.contains(axis)));
    let passes = held.barrier.is_none()
        && held.element.dwell_s == 0.0
        && !held.element.functions().iter().any(|output| output.at == At::End)
        && !item
            .element
            .functions()
            .iter()
            .any(|output| output.at == At::Start);
    if !passes {
        return None;
    }
    let (lies, axes, included_deg, length) = match plane {
        Some(plane) => {
            let [ax, ay, _] = direction_in(plane, &held.element)?;
            let [bx, by, length] = direction_in(plane, &item.element)?;
            let included_deg = 180.0 - (ax * bx + ay * by).clamp(-1.0, 1.0).acos().to_degrees();
            let axes = AxisSet::EMPTY.with(plane.first).with(plane.second);
            (Lies::In(plane), axes, included_deg, length)
        }
        None => {
            let placements = both.map(|movement| movement.element.placement.as_ref());
            let (only_main, [one, other]) = (moving.iter().all(|axis| axis.index() < MAIN.len()), placements);
            if !only_main || !Placement::is_same(one, other) {
                return None;
            }
            let ([a, b], length) = directions_in_space(&held.element, &item.element)?;
            let cosine: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            let included_deg = 180.0 - cosine.clamp(-1.0, 1.0).acos().to_degrees();
            (Lies::InSpace, moving, included_deg, length)
        }
    };
    let feed = match held.element.feed {
        FeedRate::Programmed(feed) => Some(feed),
        FeedRate::Rapid => None,
    };
    let radius = arcs.radius_mm(axes, included_deg, held_length.min(length), feed);
    // A line that turns back has no arc, and one that goes straight on needs none.
    (radius.is_finite() && radius > 1e-4 && included_deg < 179.99).then_some((lies, radius))
}

/// The direction of a line in a plane, and its length.
fn direction_in(plane: Plane, element: &PathElement) -> Option<[f64; 3]> {
    let (a, b) = (plane.point(&element.start), plane.point(&element.end));
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    let length = x.hypot(y);
    (length > 0.0).then(|| [x / length, y / length, length])
}

/// The directions of two lines of X, Y and Z, and the length of the second; `None` unless all three have positions.
pub(crate) fn directions_in_space(one: &PathElement, other: &PathElement) -> Option<([[f64; 3]; 2], f64)> {
    let direction = |element: &PathElement| {
        let way = MAIN.map(|axis| element.end[axis] - element.start[axis]);
        let length = way.iter().map(|d| d * d).sum::<f64>().sqrt();
        (length > 0.0).then(|| (way.map(|d| d / length), length))
    };
    let ((a, _), (b, length)) = (direction(one)?, direction(other)?);
    Some(([a, b], length))
}

#[cfg(test)]
mod tests {
    use bahn_path::PerAxis;

    use super::*;

    const XY: AxisSet = AxisSet::EMPTY.with(Axis::X).with(Axis::Y);

    /// T 0.05, corner of 90°: r1 = 0.05 · sin 45° / (1 - sin 45°) = 0.1207 mm; lines of 10 mm: r2 = 5 mm;
    /// 6000 mm/min · 1.5 = 0.15 m/s and 0.5 m/s²: r3 = 45 mm. The smallest counts [000:5140-5152].
    #[test]
    fn the_smallest_of_three_radii() {
        let arcs = CornerArcs {
            tolerance_mm: 0.05,
            angle_deg: 10.0,
            acceleration_m_s2: PerAxis::splat(0.5),
            spacing_mm: 0.0,
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 5e-5, "{a} is not {b}");
        close(arcs.radius_mm(XY, 90.0, 10.0, Some(6000.0)), 0.1207);
        let free = CornerArcs {
            tolerance_mm: f64::INFINITY,
            ..arcs
        };
        close(free.radius_mm(XY, 90.0, 10.0, Some(6000.0)), 5.0);
        close(free.radius_mm(XY, 90.0, 1000.0, Some(6000.0)), 45.0);
        // Up to the limit angle the size does not depend on the feed: l/2 · tan(87°).
        close(
            free.radius_mm(XY, 174.0, 100.0, Some(1.0)),
            50.0 * 87f64.to_radians().tan(),
        );
        // The arc of r1 passes T from the corner: r · (1 / sin b - 1).
        let r = arcs.radius_mm(XY, 90.0, 10.0, None);
        close(r * (1.0 / 45f64.to_radians().sin() - 1.0), 0.05);
    }
}
