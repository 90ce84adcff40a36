use bahn_parameters::{PLC_AXES, PerPlcAxis};
use bahn_plc::{ControlledSpindle, CoordinateKind, SpindlePosition};

use crate::desk::{Desk, done, failed};

fn doubles(desk: &Desk, first: u16) -> [i32; PLC_AXES] {
    [0, 4, 8, 12, 16].map(|offset| desk.get(&format!("D{}", first + offset)))
}

#[test]
fn m9040_and_m9041_read_all_axes() {
    let mut desk = Desk::new();
    desk.nc.coordinates.insert(
        CoordinateKind::Actual,
        PerPlcAxis([1.5, -2.0005, 0.0, 359.9994, -99_999.999]),
    );
    desk.nc
        .coordinates
        .insert(CoordinateKind::ShiftedDatum, PerPlcAxis::splat(1.0));
    assert_eq!(desk.cyclic(9040, &[100, 0], 0), done());
    assert_eq!(doubles(&desk, 100), [1500, -2001, 0, 359_999, -99_999_999]);
    assert_eq!(desk.cyclic(9041, &[100, 0], 0), done());
    assert_eq!(doubles(&desk, 100), [15_000, -20_005, 0, 3_599_994, -999_999_990]);
    assert_eq!(desk.submit(9041, &[1004, 6], 0), done(), "B1004 to B1023");
    assert_eq!(doubles(&desk, 1004), [10_000; PLC_AXES]);
    for module in [9040, 9041] {
        for wrong in [[100, 7], [100, -1], [102, 0], [1008, 0], [-4, 0], [1024, 0]] {
            assert_eq!(desk.cyclic(module, &wrong, 0), failed(), "{module} {wrong:?}");
        }
    }
}

#[test]
fn m9042_reads_the_spindle() {
    let mut desk = Desk::new();
    desk.nc.spindle = SpindlePosition {
        actual: -90.0,
        reference: 370.5,
        closed_loop: Some(ControlledSpindle {
            nominal: 359.0,
            trailing_error: -0.25,
            distance_to_go: 5000.0,
        }),
    };
    desk.parameter("3010=6");
    assert_eq!(desk.cyclic(9042, &[100], 0), done());
    assert_eq!(doubles(&desk, 100), [270_000, 359_000, 10_500, -250, 2_879_912]);
    desk.nc.spindle.closed_loop = None;
    assert_eq!(desk.cyclic(9042, &[100], 0), done());
    assert_eq!(doubles(&desk, 100), [270_000, 270_000, 10_500, 0, 0]);
    desk.parameter("3010=5");
    assert_eq!(desk.cyclic(9042, &[100], 0), done());
    assert_eq!(doubles(&desk, 100), [0; PLC_AXES]);
    for wrong in [1, 1008, -4] {
        assert_eq!(desk.cyclic(9042, &[wrong], 0), failed(), "{wrong}");
    }
}
