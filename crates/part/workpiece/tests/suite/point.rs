//! Drills with a point: what their cone leaves, and what the spindle and the radius have to do with a cut.

use std::f64::consts::PI;

use crate::common::*;
use bahn_path::Axis;
use bahn_workpiece::EventKind;

#[track_caller]
fn close(actual: f64, expected: f64, relative: f64) {
    assert!(
        (actual / expected - 1.0).abs() < relative,
        "{actual} is not {expected}"
    );
}

/// A cone of 118 degrees under a cylinder, its tip at the programmed depth.
#[test]
fn a_drilled_hole_ends_in_a_cone() {
    let (radius, depth) = (5.0, 12.0);
    let tip = radius / (59.0_f64).to_radians().tan();
    let plunge = line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -depth));
    let expected = PI * radius * radius * (depth - tip) + PI * radius * radius * tip / 3.0;
    close(
        removed(0.05, drill(radius, 118.0), std::slice::from_ref(&plunge)),
        expected,
        1e-3,
    );
    let mut workpiece = workpiece(0.1);
    workpiece.cut(&plunge, &drill(radius, 118.0), Axis::Z);
    // Two millimetres beside the axis the cone is higher by 2 / tan 59; the middle of a column lies up to 0.07
    // mm off.
    let height = workpiece.part().height_at([52.0, 40.0]).unwrap();
    assert!(
        (height - (-depth + 2.0 / (59.0_f64).to_radians().tan())).abs() < 0.06,
        "{height}"
    );
    // Without an angle, or with a flat one, nothing changes.
    close(
        removed(0.05, drill(radius, 180.0), &[plunge]),
        PI * radius * radius * depth,
        1e-3,
    );
}

/// A countersink of 90 degrees along a line leaves a V: its section is a triangle, depth times depth.
#[test]
fn a_point_along_a_line_leaves_a_v() {
    let groove = |from: f64, to: f64| {
        let path = [line(at(20.0, 40.0, from), at(80.0, 40.0, to))];
        removed(0.05, drill(6.0, 90.0), &path)
    };
    // 60 mm long, with half a cone at either end.
    close(groove(-2.0, -2.0), 60.0 * 4.0 + PI * 8.0 / 3.0, 2e-3);
    // On a slope of 2 in 60 the integral of z² over the length: the ends are cones of depth 1 and 3.
    let slope = 60.0 * (27.0 - 1.0) / 6.0;
    let ends = 0.5 * PI / 3.0 * (1.0 + 27.0);
    close(groove(-1.0, -3.0), slope + ends, 5e-3);
    assert_eq!(groove(-1.0, -3.0), groove(-1.0, -3.0));
}

/// Whatever the slope: the swept cone is what many plunges along the line leave.
#[test]
fn a_slope_is_the_sum_of_plunges() {
    for (depth, angle) in [(6.0, 120.0), (18.0, 120.0), (18.0, 60.0)] {
        let tool = drill(4.0, angle);
        let swept = removed(0.1, tool, &[line(at(45.0, 35.0, 0.0), at(55.0, 42.0, -depth))]);
        let plunges: Vec<_> = (0..=2000)
            .map(|k| {
                let t = f64::from(k) / 2000.0;
                let bottom = at(45.0 + 10.0 * t, 35.0 + 7.0 * t, -depth * t);
                line(bottom, bottom)
            })
            .collect();
        close(swept, removed(0.1, tool, &plunges), 2e-3);
    }
}

#[test]
fn the_next_cut_is_noted_once() {
    let mut workpiece = workpiece(0.2);
    let cut = |x: f64| line(at(x, 40.0, 2.0), at(x, 40.0, -3.0));
    workpiece.note_cut(Some(EventKind::SpindleStopped));
    workpiece.cut(
        &line(at(10.0, 40.0, 9.0), at(90.0, 40.0, 9.0)),
        &flat(5.0),
        Axis::Z,
    );
    assert_eq!(workpiece.take_events(), []);
    workpiece.cut(&cut(20.0), &flat(5.0), Axis::Z);
    workpiece.cut(&cut(40.0), &flat(5.0), Axis::Z);
    workpiece.note_cut(None);
    workpiece.cut(&cut(60.0), &flat(5.0), Axis::Z);
    let kinds: Vec<_> = workpiece
        .take_events()
        .iter()
        .map(|e| (e.kind, e.count))
        .collect();
    assert_eq!(kinds, [(EventKind::SpindleStopped, 1)]);
}

#[test]
fn the_extent_is_what_is_left() {
    let mut workpiece = workpiece(0.5);
    assert_eq!(
        workpiece.part().extent(),
        Some([[0.0, 0.0, -20.0], [100.0, 80.0, 0.0]])
    );
    // All above Z-5, and a strip of 10 mm at the side down to the lower face.
    for y in 0..=9 {
        let y = f64::from(y) * 9.0;
        workpiece.cut(&line(at(-10.0, y, -5.0), at(110.0, y, -5.0)), &flat(5.0), Axis::Z);
    }
    workpiece.cut(
        &line(at(5.0, -20.0, -20.0), at(5.0, 100.0, -20.0)),
        &flat(5.0),
        Axis::Z,
    );
    assert_eq!(
        workpiece.part().extent(),
        Some([[10.0, 0.0, -20.0], [100.0, 80.0, -5.0]])
    );
}
