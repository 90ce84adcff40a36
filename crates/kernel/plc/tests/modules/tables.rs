use bahn_plc::{MemoryTable, TableKind};

use crate::desk::{Desk, code};

const TOOL: i32 = 0;
const DATUM: i32 = 1;
const POCKET: i32 = 2;

/// Tool table and pocket table with five lines, no datum table.
fn desk() -> Desk {
    let mut desk = Desk::new();
    for kind in [TableKind::Tool, TableKind::Pocket] {
        desk.nc.tables.insert(kind, MemoryTable::new(kind, 5));
    }
    desk
}

#[test]
fn m9092_finds_the_vacant_pocket() {
    let mut desk = desk();
    // A pocket without a tool has number -1 [000:15422], and is looked for as that of tool 0 [000:15379].
    for (pocket, tool) in [(0, 12), (1, -1), (2, 7), (3, 0), (4, 9)] {
        assert_eq!(desk.submit(9094, &[POCKET, pocket, 0, tool], 1), code(0));
    }
    assert_eq!(desk.submit(9093, &[POCKET, 1, 0], 2), (vec![-1, 0], false));
    assert_eq!(desk.submit(9092, &[POCKET, -1, 0, 0], 2), (vec![1, 0], false));
    assert_eq!(desk.submit(9092, &[POCKET, 7, 0, 0], 2), (vec![2, 0], false));
    assert_eq!(desk.submit(9092, &[POCKET, 0, 0, 0], 2), (vec![1, 0], false));
    assert_eq!(
        desk.submit(9092, &[POCKET, 0, 0, 2], 2),
        (vec![3, 0], false),
        "the next one"
    );
    assert_eq!(
        desk.submit(9092, &[POCKET, 0, 0, 4], 2),
        (vec![-1, 6], true),
        "no other"
    );
    assert_eq!(
        desk.submit(9092, &[POCKET, 0, 0, 5], 2),
        (vec![-1, 4], true),
        "no such line"
    );
    assert_eq!(desk.submit(9092, &[POCKET, 0, 5, 0], 2), (vec![-1, 5], true));
    assert_eq!(desk.submit(9092, &[3, 0, 0, 0], 2), (vec![-1, 2], true));
    assert_eq!(desk.submit(9092, &[DATUM, 0, 0, 0], 2), (vec![-1, 3], true));
    assert_eq!(desk.cyclic(9092, &[POCKET, 0, 0, 0], 2), (vec![-1, 1], true));
}

#[test]
fn m9093_reads_what_m9094_wrote() {
    let mut desk = desk();
    // L = -12.3456 mm of tool 2; its replacement tool is not defined.
    assert_eq!(desk.submit(9094, &[TOOL, 2, 0, -123_456], 1), code(0));
    assert_eq!(desk.submit(9093, &[TOOL, 2, 0], 2), (vec![-123_456, 0], false));
    assert_eq!(desk.submit(9093, &[TOOL, 2, 3], 2), (vec![-1, 0], false));
    assert_eq!(desk.submit(9092, &[TOOL, -123_456, 0, 0], 2), (vec![2, 0], false));
    assert_eq!(desk.nc.geometry_initialised, 1);
    assert_eq!(desk.submit(9093, &[3, 2, 0], 2), (vec![0, 2], true));
    assert_eq!(desk.submit(9093, &[DATUM, 2, 0], 2), (vec![0, 3], true));
    assert_eq!(desk.submit(9093, &[TOOL, 5, 0], 2), (vec![0, 4], true));
    assert_eq!(desk.submit(9093, &[TOOL, -1, 0], 2), (vec![0, 4], true));
    for element in [2, 4, 22, -1] {
        assert_eq!(
            desk.submit(9093, &[TOOL, 2, element], 2),
            (vec![0, 5], true),
            "{element}"
        );
    }
    assert_eq!(desk.cyclic(9093, &[TOOL, 2, 0], 2), (vec![0, 1], true));
}

#[test]
fn m9094_error_codes() {
    let mut desk = desk();
    assert_eq!(desk.cyclic(9094, &[POCKET, 0, 1, 1], 1), code(1));
    assert_eq!(desk.submit(9094, &[-1, 0, 1, 1], 1), code(2));
    assert_eq!(desk.submit(9094, &[DATUM, 0, 1, 1], 1), code(3));
    assert_eq!(desk.submit(9094, &[POCKET, 9, 1, 1], 1), code(4));
    assert_eq!(desk.submit(9094, &[POCKET, 0, 9, 1], 1), code(5));
    assert_eq!(desk.submit(9094, &[POCKET, 0, 1, 2], 1), code(6), "ST is 0 or 1");
    assert_eq!(
        desk.submit(9094, &[TOOL, 0, 0, 1_000_000_000], 1),
        code(6),
        "100 000 mm"
    );
    assert_eq!(desk.nc.geometry_initialised, 0);
}
