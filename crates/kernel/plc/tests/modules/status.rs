use bahn_plc::{JogLimit, StatusChange, StatusItem};

use crate::desk::{Desk, code, value};

#[test]
fn m9035_reads_by_number() {
    let mut desk = Desk::new();
    desk.nc.status.insert(StatusItem::HandwheelAxis, -1);
    desk.nc.status.insert(StatusItem::Subdivision5, 10);
    desk.nc.status.insert(StatusItem::WorkingPlane, 0b101);
    assert_eq!(desk.cyclic(9035, &[9], 1), value(-1));
    assert_eq!(desk.cyclic(9035, &[15], 1), value(10));
    assert_eq!(desk.submit(9035, &[18], 1), value(0b101));
    assert_eq!(desk.cyclic(9035, &[0], 1), value(0));
    for wrong in [-1, 19] {
        assert_eq!(desk.cyclic(9035, &[wrong], 1), (vec![0], true));
    }
}

#[test]
fn m9036_writes_by_number() {
    let mut desk = Desk::new();
    desk.parameter("7640=4").parameter("7641=1");
    assert_eq!(desk.cyclic(9036, &[3, 10], 1), code(0));
    assert_eq!(desk.cyclic(9036, &[5, 0], 1), code(0));
    assert_eq!(desk.submit(9036, &[6, 4], 1), code(0));
    // 0.25 mm; none; none as well; the smaller one.
    for value in [2500, -1, 500_001, -2] {
        assert_eq!(desk.cyclic(9036, &[10, value], 1), code(0));
    }
    assert_eq!(
        desk.nc.status_changes,
        [
            StatusChange::Subdivision {
                axis: Some(3),
                factor: 10
            },
            StatusChange::Subdivision {
                axis: None,
                factor: 0
            },
            StatusChange::HandwheelAxis(4),
            StatusChange::JogLimit(JogLimit::At(0.25)),
            StatusChange::JogLimit(JogLimit::LastIncrement),
            StatusChange::JogLimit(JogLimit::LastIncrement),
            StatusChange::JogLimit(JogLimit::SmallerOfLastIncrementAndLimit),
        ]
    );
    for number in [-1, 7, 8, 9, 11] {
        assert_eq!(desk.cyclic(9036, &[number, 0], 1), code(1), "{number}");
    }
    for (number, value) in [(0, 11), (4, -1), (5, 11), (6, 5), (6, -1)] {
        assert_eq!(desk.cyclic(9036, &[number, value], 1), code(2), "{number}");
    }
    desk.parameter("7641=0").parameter("7640=5");
    assert_eq!(desk.cyclic(9036, &[0, 1], 1), code(3), "MP7641 = 0");
    assert_eq!(desk.cyclic(9036, &[6, 1], 1), code(3), "MP7640 = 5");
    assert_eq!(desk.nc.status_changes.len(), 7);
}
