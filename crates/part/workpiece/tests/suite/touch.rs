//! Probing: heights and touch positions.

use crate::common::*;
use bahn_path::{Axis, Blank, Plane, Position};
use bahn_workpiece::{Part, Resolution, Workpiece};

/// [`BLANK`] with a slot along X: Y 30 to 50, 7.3 mm deep, open at both ends.
fn slotted() -> Part {
    let mut workpiece = workpiece(0.1);
    workpiece.cut(
        &line(at(-20.0, 40.0, -7.3), at(120.0, 40.0, -7.3)),
        &flat(10.0),
        Axis::Z,
    );
    workpiece.finished()
}

fn touch(part: &Part, from: Position, to: Position, radius: f64) -> Option<[f64; 3]> {
    let p = part.touch(&from, &to, radius)?;
    Some([p[Axis::X], p[Axis::Y], p[Axis::Z]])
}

#[test]
fn heights() {
    let part = slotted();
    assert_eq!(part.height_at([50.0, 10.0]), Some(0.0));
    let floor = part.height_at([50.0, 40.0]).unwrap();
    assert!((floor + 7.3).abs() < 1e-6, "{floor}");
    assert_eq!(part.height_at([-0.01, 10.0]), None);
    assert_eq!(part.height_at([100.01, 10.0]), None);
}

#[test]
fn downward_the_position_is_the_surface() {
    let part = slotted();
    assert_eq!(
        touch(&part, at(50.0, 10.0, 15.0), at(50.0, 10.0, -5.0), 2.0),
        Some([50.0, 10.0, 0.0])
    );
    assert_eq!(
        touch(&part, at(50.0, 40.0, 15.0), at(50.0, 40.0, -30.0), 2.0),
        Some([50.0, 40.0, -7.3])
    );
    // Not far enough, and beside the blank.
    assert_eq!(
        touch(&part, at(50.0, 40.0, 15.0), at(50.0, 40.0, -7.0), 2.0),
        None
    );
    assert_eq!(
        touch(&part, at(-3.0, 10.0, 15.0), at(-3.0, 10.0, -30.0), 2.0),
        None
    );
}

#[test]
fn sideways_the_position_is_off_by_the_radius() {
    let part = slotted();
    // Outer sides of the blank: X0 and X100.
    assert_eq!(
        touch(&part, at(-30.0, 10.0, -5.0), at(30.0, 10.0, -5.0), 2.0),
        Some([-2.0, 10.0, -5.0])
    );
    assert_eq!(
        touch(&part, at(130.0, 10.0, -5.0), at(30.0, 10.0, -5.0), 2.0),
        Some([102.0, 10.0, -5.0])
    );
    // Walls of the slot: Y30 and Y50; the ball's centre is at Z-3.
    assert_eq!(
        touch(&part, at(50.0, 40.0, -5.0), at(50.0, 70.0, -5.0), 2.0),
        Some([50.0, 48.0, -5.0])
    );
    assert_eq!(
        touch(&part, at(50.0, 40.0, -5.0), at(50.0, 10.0, -5.0), 2.0),
        Some([50.0, 32.0, -5.0])
    );
}

/// Beside an edge the ball touches with its flank: the tip is lower than the edge by
/// r - sqrt(r² - d²).
#[test]
fn an_edge_is_touched_by_the_flank() {
    let part = slotted();
    // 1 mm from the wall at Y30: 0 - (2 - sqrt(4 - 1)) = -0.26795.
    assert_eq!(
        touch(&part, at(50.0, 31.0, 15.0), at(50.0, 31.0, -30.0), 2.0),
        Some([50.0, 31.0, -0.2679])
    );
    // The ball's centre 1 mm above the edge: its centre stops sqrt(4 - 1) = 1.73205 mm before it.
    assert_eq!(
        touch(&part, at(50.0, 40.0, -1.0), at(50.0, 10.0, -1.0), 2.0),
        Some([50.0, 31.7321, -1.0])
    );
}

#[test]
fn in_contact_from_the_beginning() {
    let part = slotted();
    let from = at(50.0, 10.0, -1.0);
    assert_eq!(
        touch(&part, from, at(50.0, 10.0, -5.0), 2.0),
        Some([50.0, 10.0, -1.0])
    );
    assert_eq!(touch(&part, from, from, 2.0), Some([50.0, 10.0, -1.0]));
    assert_eq!(touch(&part, at(50.0, 10.0, 1.0), at(50.0, 10.0, 1.0), 2.0), None);
}

#[test]
fn a_stylus_without_radius_is_a_point() {
    let part = slotted();
    assert_eq!(
        touch(&part, at(50.0, 40.0, -5.0), at(50.0, 70.0, -5.0), 0.0),
        Some([50.0, 50.0, -5.0])
    );
}

#[test]
fn tool_axis_x() {
    let plane = Plane::of_tool_axis(Axis::X).unwrap();
    let blank = Blank {
        plane,
        min: [-5.0, 10.0, 20.0],
        max: [0.0, 40.0, 60.0],
    };
    let part = Workpiece::new(&blank, Resolution::Millimetres(0.5))
        .unwrap()
        .finished();
    assert_eq!(part.height_at([25.0, 40.0]), Some(0.0));
    assert_eq!(
        touch(&part, at(9.0, 25.0, 40.0), at(-9.0, 25.0, 40.0), 1.5),
        Some([0.0, 25.0, 40.0])
    );
    assert_eq!(
        touch(&part, at(-3.0, 0.0, 40.0), at(-3.0, 20.0, 40.0), 1.5),
        Some([-3.0, 8.5, 40.0])
    );
}

#[test]
fn unknown_positions_touch_nothing() {
    let part = slotted();
    assert_eq!(touch(&part, Position::UNKNOWN, at(50.0, 10.0, -5.0), 2.0), None);
}
