use bahn_plc::{OrientationDirection, SpindleOrientation, ToolCallBlock};

use crate::desk::{Desk, code, done, failed};

#[test]
fn m9130_outputs_a_voltage() {
    let mut desk = Desk::new();
    desk.parameter("3010=2").parameter("3011=2");
    assert_eq!(desk.cyclic(9130, &[0, -2500], 0), done());
    assert_eq!(desk.nc.spindle_voltage, -2.5);
    assert_eq!(desk.submit(9130, &[0, 12_000], 0), done());
    assert_eq!(desk.nc.spindle_voltage, 10.0, "limited");
    assert_eq!(desk.cyclic(9130, &[1, 0], 0), failed());
    assert_eq!(desk.parameter("3011=1").cyclic(9130, &[0, 0], 0), failed());
    assert_eq!(
        desk.parameter("3011=2")
            .parameter("3010=3")
            .cyclic(9130, &[0, 0], 0),
        failed()
    );
    assert_eq!(desk.nc.spindle_voltage, 10.0);
}

#[test]
fn m9150_inserts_a_tool_call() {
    let mut desk = Desk::new();
    desk.set("B100", 0b1_1111)
        .set("B101", 2)
        .set("W102", 17)
        .set("D104", 1_500_500)
        .set("D108", -5000)
        .set("D112", 1);
    assert_eq!(desk.cyclic(9150, &[0, 100], 1), code(0));
    let block = ToolCallBlock {
        tool: Some(17),
        axis: Some(2),
        speed: Some(1500.5),
        length_oversize: -0.5,
        radius_oversize: 0.0001,
    };
    assert_eq!(desk.nc.tool_call, Some(block));
    // Only the spindle speed; the others modal, oversizes 0.
    assert_eq!(desk.set("B100", 0b100).submit(9150, &[0, 100], 1), code(0));
    let block = ToolCallBlock {
        tool: None,
        axis: None,
        speed: Some(1500.5),
        length_oversize: 0.0,
        radius_oversize: 0.0,
    };
    assert_eq!(desk.nc.tool_call, Some(block));
    for wrong in [[1, 100], [-1, 100], [0, 101], [0, 1012], [0, -16], [0, i32::MAX]] {
        assert_eq!(desk.cyclic(9150, &wrong, 1), code(2), "{wrong:?}");
    }
    desk.nc.program_running = true;
    assert_eq!(desk.cyclic(9150, &[0, 100], 1), code(1));
    assert_eq!(desk.set("M2046", 1).cyclic(9150, &[0, 100], 1), code(0));
}

#[test]
fn m9171_orients_the_spindle() {
    let mut desk = Desk::new();
    desk.set("M2719", 1).parameter("3010=6").parameter("3520.1=25.5");
    assert_eq!(desk.cyclic(9171, &[900_000, 10_000, -1], 0), done());
    assert_eq!(desk.get("M2712"), 1);
    let expected = SpindleOrientation {
        angle: 90.0,
        added_to_cycle: false,
        speed: 10.0,
        direction: OrientationDirection::Negative,
    };
    assert_eq!(desk.nc.orientation, Some(expected));
    assert_eq!(desk.cyclic(9171, &[-5000, 0, 4], 0), done());
    let expected = SpindleOrientation {
        angle: -0.5,
        added_to_cycle: true,
        speed: 25.5,
        direction: OrientationDirection::Positive,
    };
    assert_eq!(
        desk.nc.orientation,
        Some(expected),
        "speed of MP3520.1; the last call holds"
    );
    let directions = [
        (0, OrientationDirection::Shortest, false),
        (1, OrientationDirection::Positive, false),
        (2, OrientationDirection::Negative, true),
        (3, OrientationDirection::Shortest, true),
    ];
    for (number, direction, added_to_cycle) in directions {
        desk.cyclic(9171, &[0, 1, number], 0);
        let found = desk.nc.orientation.unwrap();
        assert_eq!(
            (found.direction, found.added_to_cycle),
            (direction, added_to_cycle),
            "{number}"
        );
    }
}

#[test]
fn m9171_errors() {
    let mut desk = Desk::new();
    desk.parameter("3010=8");
    assert_eq!(desk.cyclic(9171, &[0, 0, 0], 0), failed(), "M2719 = 0");
    desk.set("M2719", 1);
    assert_eq!(desk.submit(9171, &[0, 0, 0], 0), failed());
    assert_eq!(desk.cyclic(9171, &[0, -1, 0], 0), failed());
    for direction in [-2, 5] {
        assert_eq!(desk.cyclic(9171, &[0, 0, direction], 0), failed());
    }
    desk.nc.orienting = true;
    assert_eq!(desk.cyclic(9171, &[0, 0, 0], 0), failed());
    desk.nc.orienting = false;
    desk.parameter("3010=5");
    assert_eq!(desk.cyclic(9171, &[0, 0, 0], 0), failed(), "not controlled");
    assert_eq!((desk.nc.orientation, desk.get("M2712")), (None, 0));
}
