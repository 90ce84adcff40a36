//! M112: rounding arcs at the corners of straight, uncompensated blocks [000:5128-5158].

use bahn_path::{At, Axis, Curve, FeedRate, PathElement};

use super::{ContourMove, Side};

/// Override that the feed counts with, 150 %.
const OVERRIDE: f64 = 1.5;

/// What M112 asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CornerArcs {
    /// T: how far the arc may pass the corner, mm; infinite without.
    pub tolerance_mm: f64,
    /// A: change of direction above which the arc is no larger than the feed needs, degrees.
    pub angle_deg: f64,
    /// Smallest acceleration of the axes and radial acceleration, m/s².
    pub acceleration_m_s2: f64,
}

impl CornerArcs {
    /// The radius between two lines that meet at an angle, mm: the smallest of three. The arc keeps to the
    /// tolerance; it takes no more than half of the shorter line; and beyond the limit angle it is no
    /// larger than the feed needs.
    ///
    /// `included_deg` is the angle between the lines, `shorter_mm` the length of the shorter one.
    pub fn radius_mm(&self, included_deg: f64, shorter_mm: f64, feed_mm_min: Option<f64>) -> f64 {
        let half = (0.5 * included_deg).to_radians();
        let by_tolerance = self.tolerance_mm * half.sin() / (1.0 - half.sin());
        let by_length = 0.5 * shorter_mm * half.tan();
        let least = by_tolerance.min(by_length);
        match feed_mm_min {
            Some(feed) if 180.0 - included_deg > self.angle_deg => {
                let speed_m_s = feed * OVERRIDE / 60_000.0;
                least.min(speed_m_s * speed_m_s / self.acceleration_m_s2 * 1000.0)
            }
            _ => least,
        }
    }
}

/// The radius of the arc between two movements, mm; `None` where M112 makes none: elsewhere than between
/// uncompensated lines in the working plane, and where the path stops for a function.
pub(crate) fn radius_between(held: &ContourMove, held_length: f64, item: &ContourMove) -> Option<f64> {
    let arcs = held.corner_arcs.filter(|_| item.corner_arcs.is_some())?;
    let flat = |movement: &ContourMove| {
        let PathElement {
            curve, start, end, ..
        } = &movement.element;
        let plane = movement.plane;
        movement.side == Side::Off
            && movement.in_plane
            && *curve == Curve::Line
            && Axis::ALL.iter().all(|axis| {
                plane.first == *axis
                    || plane.second == *axis
                    || start[*axis] == end[*axis]
                    || end[*axis].is_nan()
            })
    };
    let passes = held.barrier.is_none()
        && held.element.dwell_s == 0.0
        && !held.element.functions().iter().any(|output| output.at == At::End)
        && !item
            .element
            .functions()
            .iter()
            .any(|output| output.at == At::Start);
    if !(flat(held) && flat(item) && held.plane == item.plane && passes) {
        return None;
    }
    let direction = |element: &PathElement| {
        let (a, b) = (held.plane.point(&element.start), held.plane.point(&element.end));
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let length = x.hypot(y);
        (length > 0.0).then(|| [x / length, y / length, length])
    };
    let [ax, ay, _] = direction(&held.element)?;
    let [bx, by, length] = direction(&item.element)?;
    let included_deg = 180.0 - (ax * bx + ay * by).clamp(-1.0, 1.0).acos().to_degrees();
    let feed = match held.element.feed {
        FeedRate::Programmed(feed) => Some(feed),
        FeedRate::Rapid => None,
    };
    let radius = arcs.radius_mm(included_deg, held_length.min(length), feed);
    // A line that turns back has no arc, and one that goes straight on needs none.
    (radius.is_finite() && radius > 1e-4 && included_deg < 179.99).then_some(radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// T 0.05, corner of 90°: r1 = 0.05 · sin 45° / (1 - sin 45°) = 0.1207 mm; lines of 10 mm: r2 = 5 mm;
    /// 6000 mm/min · 1.5 = 0.15 m/s and 0.5 m/s²: r3 = 45 mm. The smallest counts [000:5140-5152].
    #[test]
    fn the_smallest_of_three_radii() {
        let arcs = CornerArcs {
            tolerance_mm: 0.05,
            angle_deg: 10.0,
            acceleration_m_s2: 0.5,
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 5e-5, "{a} is not {b}");
        close(arcs.radius_mm(90.0, 10.0, Some(6000.0)), 0.1207);
        let free = CornerArcs {
            tolerance_mm: f64::INFINITY,
            ..arcs
        };
        close(free.radius_mm(90.0, 10.0, Some(6000.0)), 5.0);
        close(free.radius_mm(90.0, 1000.0, Some(6000.0)), 45.0);
        // Up to the limit angle the size does not depend on the feed: l/2 · tan(87°).
        close(
            free.radius_mm(174.0, 100.0, Some(1.0)),
            50.0 * 87f64.to_radians().tan(),
        );
        // The arc of r1 passes T from the corner: r · (1 / sin b - 1).
        let r = arcs.radius_mm(90.0, 10.0, None);
        close(r * (1.0 / 45f64.to_radians().sin() - 1.0), 0.05);
    }
}
