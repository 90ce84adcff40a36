use crate::desk::{Desk, code, done, failed, value};

#[test]
fn m9000_copies_markers_upward() {
    let mut desk = Desk::new();
    desk.set("M100", 1).set("M102", 1);
    assert_eq!(desk.cyclic(9000, &[100, 200, 3], 0), done());
    assert_eq!(
        ["M200", "M201", "M202", "M203"].map(|m| desk.get(m)),
        [1, 0, 1, 0]
    );
    // The destination one above the source: the first marker runs through the block [000:14753].
    assert_eq!(desk.cyclic(9000, &[100, 101, 3], 0), done());
    assert_eq!(
        ["M100", "M101", "M102", "M103"].map(|m| desk.get(m)),
        [1, 1, 1, 1]
    );
    // Markers end at M3263.
    assert_eq!(desk.cyclic(9000, &[3263, 0, 1], 0), done());
    for wrong in [
        [3263, 0, 2],
        [0, 3264, 1],
        [-1, 0, 1],
        [0, 0, -1],
        [1, 1, i32::MAX],
    ] {
        assert_eq!(desk.cyclic(9000, &wrong, 0), failed(), "{wrong:?}");
    }
}

#[test]
fn m9001_copies_bytes() {
    let mut desk = Desk::new();
    desk.set("D100", 0x0102_0304);
    assert_eq!(desk.cyclic(9001, &[100, 201, 4], 0), done());
    assert_eq!(
        ["B200", "B201", "B204", "B205"].map(|b| desk.get(b)),
        [0, 1, 4, 0]
    );
    for wrong in [[1021, 0, 4], [0, 1021, 4], [-1, 0, 1], [0, 0, 1025]] {
        assert_eq!(desk.cyclic(9001, &wrong, 0), failed(), "{wrong:?}");
    }
}

#[test]
fn m9010_to_9012_read() {
    let mut desk = Desk::new();
    desk.set("D100", 0x8102_0304_u32 as i32);
    assert_eq!(desk.cyclic(9010, &[100], 1), value(0x81 - 0x100));
    assert_eq!(desk.cyclic(9011, &[102], 1), value(0x0304));
    assert_eq!(desk.cyclic(9012, &[100], 1), value(0x8102_0304_u32 as i32));
    let wrong = [
        (9010, 1024),
        (9010, -1),
        (9011, 101),
        (9011, 1024),
        (9012, 102),
        (9012, 1021),
    ];
    for (module, address) in wrong {
        assert_eq!(
            desk.cyclic(module, &[address], 1),
            (vec![0], true),
            "{module} {address}"
        );
    }
}

#[test]
fn m9020_to_9022_write() {
    let mut desk = Desk::new();
    assert_eq!(desk.cyclic(9020, &[100, 0x1ff], 0), done());
    assert_eq!(desk.get("B100"), -1, "the low byte");
    assert_eq!(desk.cyclic(9021, &[102, -2], 0), done());
    assert_eq!(desk.get("W102"), -2);
    assert_eq!(desk.cyclic(9022, &[104, 100_000], 0), done());
    assert_eq!(desk.get("D104"), 100_000);
    let wrong = [
        (9020, 1024),
        (9020, -1),
        (9021, 101),
        (9021, 1024),
        (9022, 102),
        (9022, 1024),
    ];
    for (module, address) in wrong {
        assert_eq!(
            desk.cyclic(module, &[address, 1], 0),
            failed(),
            "{module} {address}"
        );
    }
}

#[test]
fn a_module_that_works_resets_the_error_status() {
    let mut desk = Desk::new();
    desk.set("M3171", 1);
    assert_eq!(desk.cyclic(9010, &[0], 1), code(0));
}
