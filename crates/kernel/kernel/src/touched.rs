//! What probed points come to: sides, corners, circles.

/// A point of the plane, mm.
pub type Point = [f64; 2];

/// Points that are nearer than this give no direction, mm (inferred) [003:7896].
const NEAREST_MM: f64 = 1e-3;

/// Where the ball touched a side of the workpiece: its centre, and the direction in which it was moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The centre of the ball, mm.
    pub centre: Point,
    /// The direction in which it was moved.
    pub towards: Point,
}

/// The angle of a side with the first axis, degrees, more than -90 to 90 [003:1485]; `None` for points that are too near.
pub fn angle_deg([a, b]: &[Contact; 2]) -> Option<f64> {
    let [x, y] = way(a, b)?;
    Some(within_90(y.atan2(x).to_degrees()))
}

/// An angle of a line, more than -90 to 90 degrees.
pub fn within_90(angle_deg: f64) -> f64 {
    let turned = angle_deg.rem_euclid(180.0);
    if turned > 90.0 { turned - 180.0 } else { turned }
}

fn way(a: &Contact, b: &Contact) -> Option<Point> {
    let way = [b.centre[0] - a.centre[0], b.centre[1] - a.centre[1]];
    (way[0].hypot(way[1]) >= NEAREST_MM).then_some(way)
}

/// The corner of two sides, each given by two touches of a ball; `None` for sides that are parallel or have no direction.
pub fn corner(sides: &[[Contact; 2]; 2], radius: f64) -> Option<Point> {
    // normal · p = distance, the normal towards the material.
    let line = |side: &[Contact; 2]| {
        let [a, b] = side;
        let [x, y] = way(a, b)?;
        let length = x.hypot(y);
        let normal = [-y / length, x / length];
        let sign = if dot(normal, a.towards) < 0.0 { -1.0 } else { 1.0 };
        let normal = [sign * normal[0], sign * normal[1]];
        Some((normal, dot(normal, a.centre) + radius))
    };
    let [(n, c), (m, d)] = [line(&sides[0])?, line(&sides[1])?];
    let det = n[0] * m[1] - n[1] * m[0];
    /// Sides that meet at less than 0.1° have no corner (inferred).
    const PARALLEL: f64 = 1.7e-3;
    (det.abs() > PARALLEL).then(|| [(c * m[1] - d * n[1]) / det, (n[0] * d - m[0] * c) / det])
}

/// A circle in the plane of the touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Centre in the plane of the touches, mm.
    pub centre: Point,
    /// Radius of the wall, mm.
    pub radius: f64,
}

/// The circle that fits best through the centres of touches (least squares of Kåsa, exact for points that lie on one),
/// then from centres to the wall: outwards when the touches go away from the centre. `None` for fewer than three
/// points, or points of a line.
pub fn circle(contacts: &[Contact], ball_radius: f64) -> Option<Circle> {
    if contacts.len() < 3 {
        return None;
    }
    let count = contacts.len() as f64;
    let mean = [0, 1].map(|k| contacts.iter().map(|contact| contact.centre[k]).sum::<f64>() / count);
    let [mut uu, mut uv, mut vv, mut ru, mut rv] = [0.0; 5];
    for contact in contacts {
        let [u, v] = [contact.centre[0] - mean[0], contact.centre[1] - mean[1]];
        let square = u * u + v * v;
        uu += u * u;
        uv += u * v;
        vv += v * v;
        ru += u * square / 2.0;
        rv += v * square / 2.0;
    }
    let det = uu * vv - uv * uv;
    if det <= NEAREST_MM * NEAREST_MM * (uu + vv) {
        return None;
    }
    let centre = [(ru * vv - rv * uv) / det, (rv * uu - ru * uv) / det];
    let radius = (dot(centre, centre) + (uu + vv) / count).sqrt();
    let centre = [mean[0] + centre[0], mean[1] + centre[1]];
    let outwards = |contact: &Contact| {
        let from = [contact.centre[0] - centre[0], contact.centre[1] - centre[1]];
        dot(from, contact.towards)
    };
    let inside = contacts.iter().map(outwards).sum::<f64>() > 0.0;
    let radius = if inside {
        radius + ball_radius
    } else {
        radius - ball_radius
    };
    Some(Circle { centre, radius })
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use proptest::prelude::*;

    fn touch(centre: Point, towards: Point) -> Contact {
        Contact { centre, towards }
    }

    #[test]
    fn angles_are_those_of_a_line() {
        for (angle, expected) in [
            (0.0, 0.0),
            (90.0, 90.0),
            (-90.0, 90.0),
            (179.0, -1.0),
            (-100.0, 80.0),
        ] {
            assert_eq!(within_90(angle), expected);
        }
        let same = touch([1.0, 1.0], [1.0, 0.0]);
        assert_eq!(angle_deg(&[same; 2]), None);
        assert_eq!(circle(&[same; 4], 2.0), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// A corner anywhere, turned by any angle, is found from touches of any ball along its sides.
        #[test]
        fn a_corner_is_found(
            p in prop::array::uniform2(-100.0..100.0f64), angle in -1.5..1.5f64, between in 0.3..2.8f64,
            ways in prop::array::uniform2(5.0..50.0f64), radius in 0.5..5.0f64,
        ) {
            // Material lies to the left of the first side and to the right of the second.
            let side = |angle: f64, inwards: f64| {
                let (sin, cos) = angle.sin_cos();
                let normal = [-sin * inwards, cos * inwards];
                ways.map(|way| touch(
                    [p[0] + way * cos - radius * normal[0], p[1] + way * sin - radius * normal[1]],
                    normal,
                ))
            };
            prop_assume!((ways[0] - ways[1]).abs() > 1.0);
            let found = corner(&[side(angle, 1.0), side(angle + between, -1.0)], radius).unwrap();
            prop_assert!((found[0] - p[0]).hypot(found[1] - p[1]) < 1e-6);
        }

        /// A circle is found from within and from outside, by any four touches that are not all at one place.
        #[test]
        fn a_circle_is_found(
            centre in prop::array::uniform2(-100.0..100.0f64), wall in 10.0..50.0f64, from in 0.0..6.0f64,
            ball in 0.5..5.0f64, inside: bool,
        ) {
            let sign = if inside { 1.0 } else { -1.0 };
            let contacts = [0.0, 1.0, 2.5, 4.0].map(|angle: f64| {
                let (sin, cos) = (from + angle).sin_cos();
                let at = wall - sign * ball;
                touch([centre[0] + at * cos, centre[1] + at * sin], [sign * cos, sign * sin])
            });
            let found = circle(&contacts, ball).unwrap();
            prop_assert!((found.centre[0] - centre[0]).hypot(found.centre[1] - centre[1]) < 1e-6);
            prop_assert!((found.radius - wall).abs() < 1e-6);
        }
    }
}
