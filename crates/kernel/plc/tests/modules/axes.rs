use bahn_plc::{CoordinateKind, NcStatus, PlcAxisCommand};

use crate::desk::{Desk, code, value};

const REFERENCED: i32 = 1 << 1;
const POSITIONING: i32 = 1 << 2;
const NEGATIVE: i32 = 1 << 3;

/// Axes X to 5 active, axes 4 and 5 are the PLC's.
fn desk() -> Desk {
    let mut desk = Desk::new();
    desk.parameter("10=%11111").parameter("60=%11000");
    desk
}

#[test]
fn m9120_starts_an_axis() {
    let mut desk = desk();
    assert_eq!(desk.cyclic(9120, &[4, -900_000, 3600, 0], 1), code(0));
    assert_eq!(desk.cyclic(9122, &[4], 1), value(1), "shows in the next scan");
    desk.nc.end_scan();
    let start = PlcAxisCommand::Start {
        target: -90.0,
        incremental: false,
        feed: 3600.0,
    };
    assert_eq!(desk.nc.axes[4].command, Some(start));
    assert_eq!(desk.cyclic(9122, &[4], 1), value(1 | POSITIONING | NEGATIVE));
    assert_eq!(desk.cyclic(9120, &[4, 0, 3600, 0], 1), code(3), "it must stand");
    desk.nc.axes[4].arrive();
    assert_eq!(desk.nc.axes[4].position, -90.0);
    assert_eq!(desk.submit(9120, &[4, 100_000, 100, 1], 1), code(0));
    desk.nc.end_scan();
    desk.nc.axes[4].arrive();
    assert_eq!(desk.nc.axes[4].position, -80.0, "10 degrees further");
    assert_eq!(desk.cyclic(9120, &[5, 0, 1, 0], 1), code(1));
    assert_eq!(desk.cyclic(9120, &[-1, 0, 1, 0], 1), code(1));
    assert_eq!(desk.cyclic(9120, &[0, 0, 1, 0], 1), code(2));
    assert_eq!(
        desk.parameter("10=%00111").cyclic(9120, &[4, 0, 1, 0], 1),
        code(2),
        "not active"
    );
}

#[test]
fn m9121_stops_an_axis() {
    let mut desk = desk();
    assert_eq!(desk.cyclic(9121, &[3], 1), code(3), "it stands already");
    desk.cyclic(9120, &[3, 1000, 100, 0], 1);
    desk.nc.end_scan();
    assert_eq!(desk.cyclic(9121, &[3], 1), code(0));
    desk.nc.end_scan();
    assert_eq!(desk.cyclic(9122, &[3], 1), value(1));
    assert_eq!(desk.cyclic(9121, &[5], 1), code(1));
    assert_eq!(desk.cyclic(9121, &[1], 1), code(2));
}

#[test]
fn m9122_tells_the_status() {
    let mut desk = desk();
    desk.nc.axes[3].status.referenced = true;
    desk.nc.axes[3].status.error = true;
    assert_eq!(desk.cyclic(9122, &[3], 1), value(0b1_0011));
    assert_eq!(desk.cyclic(9122, &[0], 1), value(0), "no PLC axis");
    // Bit 1 is of every axis, the others of what modules 9120 to 9123 do.
    desk.nc.axes[0].status.referenced = true;
    desk.nc.axes[0].status.negative = true;
    assert_eq!(desk.cyclic(9122, &[0], 1), value(REFERENCED));
    for wrong in [5, -1] {
        assert_eq!(desk.cyclic(9122, &[wrong], 1), (vec![0], true));
    }
}

#[test]
fn m9123_traverses_the_reference_mark() {
    let mut desk = desk();
    desk.nc.axes[4].status.referenced = true;
    desk.nc.axes[4].status.error = true;
    assert_eq!(desk.cyclic(9123, &[4, 500, 1], 1), code(0));
    desk.nc.end_scan();
    assert_eq!(
        desk.cyclic(9122, &[4], 1),
        value(1 | POSITIONING | NEGATIVE),
        "reference and error are gone"
    );
    assert_eq!(desk.cyclic(9123, &[4, 500, 0], 1), code(3));
    desk.nc.axes[4].arrive();
    assert_eq!(desk.cyclic(9122, &[4], 1), value(0b11));
    assert_eq!(desk.cyclic(9123, &[9, 500, 0], 1), code(1));
    assert_eq!(desk.cyclic(9123, &[2, 500, 0], 1), code(2));
}

#[test]
fn the_last_command_of_a_scan_is_executed() {
    let mut desk = desk();
    desk.cyclic(9120, &[4, 10_000, 100, 0], 1);
    desk.cyclic(9123, &[4, 500, 0], 1);
    desk.nc.end_scan();
    let traverse = PlcAxisCommand::TraverseReferenceMarks {
        feed: 500.0,
        negative: false,
    };
    assert_eq!(desk.nc.axes[4].command, Some(traverse));
}

#[test]
fn m9124_sets_the_override() {
    let mut desk = desk();
    assert_eq!(desk.nc.axes[4].override_percent, 100.0);
    assert_eq!(desk.cyclic(9124, &[4, 1250], 1), code(0));
    assert_eq!(desk.nc.axes[4].override_percent, 12.5);
    assert_eq!(desk.cyclic(9124, &[4, 10_000], 1), code(0));
    assert_eq!(desk.cyclic(9124, &[5, 0], 1), code(1));
    assert_eq!(desk.cyclic(9124, &[0, 0], 1), code(2));
    for wrong in [10_001, -1] {
        assert_eq!(desk.cyclic(9124, &[4, wrong], 1), code(3));
    }
}

#[test]
fn axes_travel_with_their_feed_rate() {
    let mut desk = desk();
    // 600 degrees/min are 10 degrees/s, 5 at half the override.
    desk.cyclic(9124, &[4, 5000], 1);
    desk.cyclic(9120, &[4, 100_000, 600, 0], 1);
    desk.nc.end_scan();
    desk.nc.travel(1.0);
    assert_eq!(desk.nc.axes[4].position, 5.0);
    assert_eq!(desk.nc.coordinates(CoordinateKind::DistanceToGo)[4], 5.0);
    desk.nc.travel(1.5);
    assert_eq!(desk.nc.coordinates(CoordinateKind::Actual)[4], 10.0);
    assert_eq!(desk.cyclic(9122, &[4], 1), value(1));
    // The reference traverse does not know the override.
    desk.cyclic(9123, &[4, 30, 1], 1);
    desk.nc.end_scan();
    desk.nc.travel(1.0);
    assert_eq!(desk.nc.axes[4].position, 9.5);
    desk.nc.travel(1.0);
    assert_eq!(desk.cyclic(9122, &[4], 1), value(1 | REFERENCED));
}
