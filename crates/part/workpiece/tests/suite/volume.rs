//! Removed volumes against the volumes of the bodies that the tool sweeps.
//!
//! The error of a height map: a column counts whole or not at all, and only columns on the outline are
//! wrong, each by half a column at most, with either sign. So an outline of length `p` errs by less
//! than `p * resolution / 2` times the depth.

use std::f64::consts::PI;

use crate::common::*;
use bahn_path::{Axis, Blank, Plane};
use bahn_workpiece::{Resolution, Workpiece};
use proptest::prelude::*;

const MM: f64 = 0.1;

fn assert_near(volume: f64, exact: f64, error: f64) {
    assert!(
        (volume - exact).abs() <= error,
        "{volume} mm³, exact {exact} ± {error}"
    );
}

#[test]
fn plunge_is_a_cylinder() {
    let (r, depth) = (6.0, 5.0);
    let volume = removed(MM, flat(r), &[line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -depth))]);
    assert_near(volume, PI * r * r * depth, 2.0 * PI * r * MM / 2.0 * depth);
}

#[test]
fn through_hole_is_clamped_to_the_blank() {
    let r = 6.0;
    let volume = removed(MM, flat(r), &[line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -30.0))]);
    assert_near(volume, PI * r * r * 20.0, 2.0 * PI * r * MM / 2.0 * 20.0);
}

#[test]
fn rectangle_off_the_edge_is_exact() {
    // A 10 mm wide step along the whole side: the tool stands half outside, all borders are on the grid.
    let path = [line(at(0.0, -20.0, -3.0), at(0.0, 100.0, -3.0))];
    let volume = removed(MM, flat(10.0), &path);
    assert_near(volume, 10.0 * 80.0 * 3.0, 1e-3);
}

#[test]
fn ball_plunge_is_a_half_sphere() {
    let r = 8.0;
    let volume = removed(MM, ball(r), &[line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -r))]);
    assert_near(volume, 2.0 / 3.0 * PI * r.powi(3), 2.0 * PI * r * MM / 2.0 * r);
}

#[test]
fn torus_plunge_is_disc_and_quarter_ring() {
    // Depth = corner radius: cylinder of the flat radius q, and the quarter disc of radius c turned
    // about the axis: area pi c²/4 with its centroid at q + 4c/(3 pi) (Pappus).
    let (q, c) = (5.0, 3.0);
    let volume = removed(
        MM,
        torus(q + c, c),
        &[line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -c))],
    );
    let exact = PI * q * q * c + PI * c * c / 4.0 * 2.0 * PI * (q + 4.0 * c / (3.0 * PI));
    assert_near(volume, exact, 2.0 * PI * (q + c) * MM / 2.0 * c);
}

#[test]
fn full_circle_is_a_ring() {
    let (path_radius, r, depth) = (20.0f64, 5.0, 4.0);
    let start = at(70.0, 40.0, -depth);
    let ring = arc(Plane::XY, start, start, [50.0, 40.0], 360.0);
    let exact = PI * ((path_radius + r).powi(2) - (path_radius - r).powi(2)) * depth;
    // Chords lie inside the arc by less than a twentieth of the resolution.
    let error = 2.0 * PI * 2.0 * path_radius * MM * depth * (0.5 + 0.05);
    assert_near(removed(MM, flat(r), &[ring]), exact, error);
}

/// A flat end on a helix: after the last full turn the ring is at the end depth where the disc stood,
/// else at the depth of entry of the last turn.
#[test]
fn helix_lies_between_its_rings() {
    let (path_radius, r, pitch, turns) = (20.0f64, 5.0, 2.0, 3.0);
    let depth = pitch * turns;
    let helix = arc(
        Plane::XY,
        at(70.0, 40.0, 0.0),
        at(70.0, 40.0, -depth),
        [50.0, 40.0],
        360.0 * turns,
    );
    let area = PI * ((path_radius + r).powi(2) - (path_radius - r).powi(2));
    let volume = removed(MM, flat(r), &[helix]);
    assert!(volume < area * depth, "{volume}");
    assert!(volume > area * (depth - pitch), "{volume}");
    // A tool of small radius follows the helix: mean depth of the last turn is depth - pitch/2, less
    // the lead of the disc's edge, which is r/path_radius of a radian at most.
    let r = 1.0;
    let helix = arc(
        Plane::XY,
        at(70.0, 40.0, 0.0),
        at(70.0, 40.0, -depth),
        [50.0, 40.0],
        1080.0,
    );
    let area = PI * ((path_radius + r).powi(2) - (path_radius - r).powi(2));
    let lead = pitch * (r / path_radius) / (2.0 * PI);
    let mean = area * (depth - pitch / 2.0);
    assert_near(
        removed(MM, flat(r), &[helix]),
        mean,
        area * lead + 4.0 * PI * path_radius * MM / 2.0 * depth,
    );
}

/// An arc in ZX with the tool axis Z: the flat end mills a trough whose section is the swept disc.
#[test]
fn arc_in_a_plane_of_the_tool_axis() {
    // A quarter circle about (50, 40, 5) from below to the right: z = 5 - 15 cos, x = 50 + 15 sin.
    // In ZX, Z is the first axis: start angle 180 deg (Z-), turning to X+ is clockwise.
    let (radius, r) = (15.0, 0.5);
    let quarter = arc(
        Plane::ZX,
        at(50.0, 40.0, -10.0),
        at(65.0, 40.0, 5.0),
        [5.0, 50.0],
        -90.0,
    );
    let volume = removed(0.05, ball(r), &[quarter]);
    // Below Z0 the ball's centre (r over the tip) is at height z + r: the trough is about 2r wide and
    // as deep as the path. Area under the tip's path: the segment of the circle below Z0, half of it:
    // angle a with cos a = 5/15.
    let a = (5.0f64 / radius).acos();
    let half_segment = 0.5 * (radius * radius * a - 5.0 * radius * a.sin());
    assert!(
        volume < 2.0 * r * half_segment * 1.1 + PI * r * r * 10.0,
        "{volume}"
    );
    assert!(volume > 2.0 * r * (half_segment - r * radius), "{volume}");
    // The depth along the path is that of the circle, at the tip of the ball.
    let mut workpiece = workpiece(0.05);
    workpiece.cut(
        &arc(
            Plane::ZX,
            at(50.0, 40.0, -10.0),
            at(65.0, 40.0, 5.0),
            [5.0, 50.0],
            -90.0,
        ),
        &ball(r),
        Axis::Z,
    );
    let height = workpiece.part().height_at([50.025, 40.025]).unwrap();
    assert!((height + 10.0).abs() < 0.01, "{height}");
}

#[test]
fn every_orientation_removes_the_same() {
    // The same slot in the same blank, turned into the three working planes, and with a parallel axis.
    let mut volumes = Vec::new();
    for plane in [Plane::XY, Plane::YZ, Plane::ZX] {
        let (first, second, normal) = (plane.first, plane.second, plane.normal);
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for (axis, length) in [(first, 100.0), (second, 80.0), (normal, 20.0)] {
            min[axis.index()] = -length / 2.0;
            max[axis.index()] = length / 2.0;
        }
        let mut workpiece = Workpiece::new(&Blank { plane, min, max }, Resolution::Millimetres(0.2)).unwrap();
        let mut a = at(0.0, 0.0, 0.0);
        a[first] = -30.0;
        a[second] = 5.0;
        a[normal] = 4.0;
        let mut b = a;
        b[first] = 25.0;
        b[second] = 17.0;
        workpiece.cut(&line(a, b), &flat(6.0), normal);
        volumes.push(workpiece.part().removed_mm3());
    }
    let mut blank = BLANK;
    blank.plane = Plane::of_tool_axis(Axis::W).unwrap();
    let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.2)).unwrap();
    let mut a = at(20.0, 45.0, 0.0);
    a[Axis::W] = -6.0;
    a[Axis::U] = 0.0;
    let mut b = a;
    b[Axis::U] = 55.0;
    b[Axis::Y] = 57.0;
    workpiece.cut(&line(a, b), &flat(6.0), Axis::W);
    volumes.push(workpiece.part().removed_mm3());
    assert!(volumes[0] > 0.0);
    for volume in &volumes[1..] {
        assert_near(*volume, volumes[0], 1e-6 * volumes[0]);
    }
}

/// What a tool leaves over one column, found by trying many positions along the line.
fn sampled_height(a: [f64; 3], b: [f64; 3], point: [f64; 2], tool: &bahn_path::ToolShape) -> f64 {
    let flat = tool.radius - tool.corner_radius;
    let mut lowest = 0.0f64;
    for k in 0..=20_000 {
        let t = f64::from(k) / 20_000.0;
        let p = [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t);
        let distance = (point[0] - p[0]).hypot(point[1] - p[1]);
        if distance <= tool.radius {
            let rise = (distance - flat).max(0.0);
            let c = tool.corner_radius;
            lowest = lowest.min(p[2] + c - (c * c - rise * rise).max(0.0).sqrt());
        }
    }
    lowest.max(-20.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn slot_is_track_and_disc(
        x0 in 20.0..80.0f64, y0 in 20.0..60.0f64, x1 in 20.0..80.0f64, y1 in 20.0..60.0f64,
        r in 1.0..15.0f64, depth in 0.1..15.0f64,
    ) {
        let length = (x1 - x0).hypot(y1 - y0);
        let volume = removed(0.2, flat(r), &[line(at(x0, y0, -depth), at(x1, y1, -depth))]);
        let exact = (2.0 * r * length + PI * r * r) * depth;
        let error = (2.0 * length + 2.0 * PI * r) * 0.2 / 2.0 * depth;
        prop_assert!((volume - exact).abs() <= error, "{} exact {} ± {}", volume, exact, error);
    }

    /// A flat end on a ramp: mean depth of the track, and of the disc at the deeper end. The body: in
    /// the cross direction, at offset v, the bottom runs from the deep end's far edge at full depth
    /// over the deep disc (2 sqrt(r²-v²)), then rises over the length to the shallow depth. Volume =
    /// disc area * deep + track area * mean depth.
    #[test]
    fn ramp_of_a_flat_end(
        x0 in 20.0..80.0f64, y0 in 20.0..60.0f64, x1 in 20.0..80.0f64, y1 in 20.0..60.0f64,
        r in 1.0..15.0f64, z0 in 0.1..15.0f64, z1 in 0.1..15.0f64,
    ) {
        let length = (x1 - x0).hypot(y1 - y0);
        let volume = removed(0.2, flat(r), &[line(at(x0, y0, -z0), at(x1, y1, -z1))]);
        let deep = z0.max(z1);
        let exact = PI * r * r * deep + 2.0 * r * length * 0.5 * (z0 + z1);
        let error = (2.0 * length + 2.0 * PI * r) * 0.2 / 2.0 * deep;
        prop_assert!((volume - exact).abs() <= error, "{} exact {} ± {}", volume, exact, error);
    }

    /// Every column is as low as the lowest tool position over it.
    #[test]
    fn columns_have_the_lowest_tool_height(
        a in [20.0..80.0f64, 20.0..60.0f64, -15.0..2.0f64],
        b in [20.0..80.0f64, 20.0..60.0f64, -15.0..2.0f64],
        r in 2.0..15.0f64, corner in 0.0..1.0f64, kind in 0..3, u in 0.0..1.0f64, v in -0.95..0.95f64,
        level in any::<bool>(),
    ) {
        let b = if level { [b[0], b[1], a[2]] } else { b };
        let tool = match kind { 0 => flat(r), 1 => ball(r), _ => torus(r, corner * r) };
        let mut workpiece = workpiece(0.1);
        workpiece.cut(&line(at(a[0], a[1], a[2]), at(b[0], b[1], b[2])), &tool, Axis::Z);
        // A point near the track, moved to the centre of its column.
        let length = (b[0] - a[0]).hypot(b[1] - a[1]).max(1e-6);
        let across = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
        let centre = |k: usize| {
            let value = a[k] + (b[k] - a[k]) * u + across[k] * v * r;
            ((value / 0.1).floor() + 0.5) * 0.1
        };
        let point = [centre(0), centre(1)];
        let expected = sampled_height(a, b, point, &tool);
        let height = workpiece.part().height_at(point).unwrap_or(-20.0);
        // The sampling is too high by a step of 1/20000 of the line; at the rim of the tool the
        // height changes as a square root.
        let slope = (b[2] - a[2]).abs() / length;
        let error = 0.01 + 0.05 * slope;
        prop_assert!((height - expected).abs() <= error, "{} expected {}", height, expected);
    }

    /// A line cut in pieces leaves the same as the whole line, forward and backward.
    #[test]
    fn pieces_and_reversal_change_nothing(
        a in [20.0..80.0f64, 20.0..60.0f64, -15.0..0.0f64],
        b in [20.0..80.0f64, 20.0..60.0f64, -15.0..0.0f64],
        r in 0.5..10.0f64, kind in 0..3, pieces in 2..40usize, level in any::<bool>(),
    ) {
        let b = if level { [b[0], b[1], a[2]] } else { b };
        let tool = match kind { 0 => flat(r), 1 => ball(r), _ => torus(r, 0.3 * r) };
        let point = |k: usize| {
            let t = k as f64 / pieces as f64;
            at(a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)
        };
        let whole = removed(0.2, tool, &[line(point(0), point(pieces))]);
        let parts: Vec<_> = (0..pieces).map(|k| line(point(k), point(k + 1))).collect();
        let back: Vec<_> = (0..pieces).rev().map(|k| line(point(k + 1), point(k))).collect();
        // Columns exactly on the rim may fall to either side.
        let error = 1e-3 * whole + 0.1;
        prop_assert!((removed(0.2, tool, &parts) - whole).abs() <= error);
        prop_assert!((removed(0.2, tool, &back) - whole).abs() <= error);
    }
}
