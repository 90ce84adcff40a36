//! The events of the cut that the operator gets.

use crate::common::*;
use bahn_path::{Axis, BlockRef, PathElement, Plane, Position};
use bahn_workpiece::{EventKind, Workpiece};

fn events(elements: &[PathElement], tool_axis: Axis) -> Vec<(EventKind, u64)> {
    let mut workpiece = workpiece(0.2);
    for element in elements {
        workpiece.cut(element, &flat(5.0), tool_axis);
    }
    workpiece
        .take_events()
        .into_iter()
        .map(|event| (event.kind, event.count))
        .collect()
}

#[test]
fn rapid_traverse_into_material_is_reported_with_its_block() {
    let mut workpiece = workpiece(0.2);
    let mut plunge = rapid(at(50.0, 40.0, 2.0), at(50.0, 40.0, -3.0));
    plunge.block = BlockRef {
        program: 2,
        block: 31,
    };
    workpiece.cut(&plunge, &flat(5.0), Axis::Z);
    let events = workpiece.take_events();
    assert_eq!(events.len(), 1);
    assert_eq!(
        (events[0].block, events[0].kind, events[0].count),
        (plunge.block, EventKind::RapidCut, 1)
    );
    assert_eq!(workpiece.take_events(), []);
    // The material is gone all the same.
    assert_eq!(workpiece.part().height_at([50.0, 40.0]), Some(-3.0));
}

#[test]
fn rapid_traverse_in_air_is_fine() {
    let path = [
        rapid(at(-20.0, -20.0, 50.0), at(50.0, 40.0, 2.0)),
        // Sliding over the surface removes nothing.
        rapid(at(50.0, 40.0, 0.0), at(60.0, 40.0, 0.0)),
        // Beside the blank, below its surface.
        rapid(at(-5.0, -20.0, -10.0), at(-5.0, 100.0, -10.0)),
    ];
    assert_eq!(events(&path, Axis::Z), []);
}

#[test]
fn rapid_traverse_in_the_slot_just_milled_is_fine() {
    let (a, b, c) = (at(20.3, 20.7, -4.0), at(77.1, 51.9, -4.0), at(77.1, 51.9, 2.0));
    let centre = [20.3, 51.9];
    let ring = arc(Plane::XY, b, at(20.3, 51.9 + 56.8, -4.0), centre, 90.0);
    let mut back = arc(Plane::XY, ring.end, b, centre, -90.0);
    back.feed = bahn_path::FeedRate::Rapid;
    assert_eq!(
        events(
            &[line(a, b), rapid(b, a), rapid(a, b), ring, back, rapid(b, c)],
            Axis::Z
        ),
        []
    );
}

#[test]
fn a_block_in_a_loop_is_counted() {
    let path: Vec<PathElement> = (0..5)
        .map(|k| rapid(at(50.0, 40.0, 0.0), at(50.0, 40.0, -1.0 - f64::from(k))))
        .collect();
    assert_eq!(events(&path, Axis::Z), [(EventKind::RapidCut, 5)]);
}

#[test]
fn tip_below_the_blank() {
    // The blank ends at Z-20.
    let drill = |x: f64, z: f64| line(at(x, 40.0, 2.0), at(x, 40.0, z));
    assert_eq!(events(&[drill(50.0, -20.0)], Axis::Z), []);
    assert_eq!(
        events(&[drill(50.0, -20.1)], Axis::Z),
        [(EventKind::BelowBlank, 1)]
    );
    // The tool's radius is 5: at its edge is over the blank, at it is beside it.
    assert_eq!(
        events(&[drill(-4.9, -25.0)], Axis::Z),
        [(EventKind::BelowBlank, 1)]
    );
    assert_eq!(events(&[drill(-5.1, -25.0)], Axis::Z), []);
    // It comes up before it is over the blank.
    assert_eq!(
        events(&[line(at(-40.0, 40.0, -30.0), at(-10.0, 40.0, -10.0))], Axis::Z),
        []
    );
    // Full circle around the blank's corner region: one element, one event.
    let start = at(10.0, 40.0, -21.0);
    assert_eq!(
        events(&[arc(Plane::XY, start, start, [50.0, 40.0], 360.0)], Axis::Z),
        [(EventKind::BelowBlank, 1)]
    );
}

#[test]
fn another_tool_axis_is_not_shown() {
    let path = [line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -5.0))];
    assert_eq!(events(&path, Axis::X), [(EventKind::ToolAxisNotShown, 1)]);
    assert!(EventKind::ToolAxisNotShown.is_not_shown());
    // W carries the tool in Z.
    assert_eq!(events(&path, Axis::W), []);
}

#[test]
fn rotary_movements_are_not_shown_until_the_axis_is_back() {
    let mut workpiece = workpiece(0.2);
    let turned = |p: Position, c: f64| {
        let mut p = p;
        p[Axis::C] = c;
        p
    };
    let (above, below) = (at(50.0, 40.0, 2.0), at(50.0, 40.0, -5.0));
    let kinds = |workpiece: &mut Workpiece| -> Vec<_> {
        workpiece
            .take_events()
            .into_iter()
            .map(|event| (event.kind, event.count))
            .collect()
    };
    workpiece.cut(
        &line(turned(above, 0.0), turned(above, 90.0)),
        &flat(5.0),
        Axis::Z,
    );
    workpiece.cut(
        &line(turned(above, 90.0), turned(below, 90.0)),
        &flat(5.0),
        Axis::Z,
    );
    assert_eq!(kinds(&mut workpiece), [(EventKind::RotaryAxisNotShown, 2)]);
    // Nor while the tool leans, whatever the rotary axes do.
    let mut leans = line(above, below);
    let swivels = bahn_path::Swivels::default();
    let nowhere = bahn_path::Position::ZERO;
    let plane = bahn_path::Placement::tilted(&swivels, &nowhere, [&nowhere; 2], (Axis::Z, 0.0));
    leans.placement = Some(plane.into());
    workpiece.cut(&leans, &flat(5.0), Axis::Z);
    assert_eq!(kinds(&mut workpiece), [(EventKind::TiltedNotShown, 1)]);
    assert_eq!(workpiece.part().removed_mm3(), 0.0);
    workpiece.cut(
        &line(turned(above, 90.0), turned(above, 360.0)),
        &flat(5.0),
        Axis::Z,
    );
    kinds(&mut workpiece);
    workpiece.cut(
        &line(turned(above, 360.0), turned(below, 360.0)),
        &flat(5.0),
        Axis::Z,
    );
    assert_eq!(kinds(&mut workpiece), []);
    assert!(workpiece.part().removed_mm3() > 0.0);
}

#[test]
fn without_positions_or_radius_nothing_happens() {
    let mut unknown = at(50.0, 40.0, -5.0);
    unknown[Axis::Y] = f64::NAN;
    assert_eq!(events(&[line(unknown, unknown)], Axis::Z), []);
    let mut workpiece = workpiece(0.2);
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        workpiece.cut(
            &line(at(50.0, 40.0, 2.0), at(50.0, 40.0, -5.0)),
            &flat(radius),
            Axis::Z,
        );
    }
    assert_eq!(workpiece.part().removed_mm3(), 0.0);
    // The first position of an axis: the tool stands there.
    let mut start = at(50.0, 40.0, -5.0);
    start[Axis::X] = f64::NAN;
    workpiece.cut(&line(start, at(50.0, 40.0, -5.0)), &flat(5.0), Axis::Z);
    assert_eq!(workpiece.part().height_at([50.0, 40.0]), Some(-5.0));
}

#[test]
fn absurd_coordinates_do_no_harm() {
    let mut workpiece = workpiece(0.5);
    let far = [1e300, -1e300, f64::INFINITY, f64::MAX, 1e18, -1e18, 0.0];
    for (k, x) in far.iter().enumerate() {
        let y = far[(k + 3) % far.len()];
        workpiece.cut(&line(at(*x, y, -5.0), at(y, 10.0, *x)), &ball(4.0), Axis::Z);
        workpiece.cut(
            &arc(Plane::XY, at(*x, y, -5.0), at(y, *x, 1.0), [y, y], 90.0),
            &flat(4.0),
            Axis::Z,
        );
        workpiece.cut(
            &line(at(1.0, 1.0, -5.0), at(2.0, 10.0, -5.0)),
            &flat(x.abs()),
            Axis::Z,
        );
    }
    let removed = workpiece.part().removed_mm3();
    assert!((0.0..=160_000.0).contains(&removed));
}
