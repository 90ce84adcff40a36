use bahn_plc::{CompensationSize, PalletLine};

use crate::desk::{Desk, code};

fn line(program: &str, datum_table: Option<&str>) -> PalletLine {
    PalletLine {
        program: program.to_owned(),
        datum_table: datum_table.map(str::to_owned),
    }
}

/// Full sequence, a pallet file, and files in the memory.
fn pallets() -> Desk {
    let mut desk = Desk::new();
    desk.set("W272", 5).parameter("7224.0=%00000000");
    desk.nc.files = ["7432.H", "99.H", "99.I", "ISO.I", "ZERO.D"]
        .map(str::to_owned)
        .into();
    desk.nc.pallet = Some(vec![
        line("7432.H", Some("ZERO.D")),
        line("ISO", None),
        line("7432.T", None),
        line("123456789", None),
        line("GONE", None),
        line("GONE.H", None),
        line("99", None),
        line("99.I", Some("GONE")),
    ]);
    desk
}

#[test]
fn m9090_selects_program_and_datum_table() {
    let mut desk = pallets();
    assert_eq!(desk.submit(9090, &[0], 1), code(0));
    assert_eq!(desk.nc.program.as_deref(), Some("7432.H"));
    assert_eq!(desk.nc.datum_table.as_deref(), Some("ZERO.D"));
    assert_eq!(desk.submit(9090, &[1], 1), code(0), "the extension is found");
    assert_eq!(desk.nc.program.as_deref(), Some("ISO.I"));
    assert_eq!(
        desk.nc.datum_table.as_deref(),
        Some("ZERO.D"),
        "the datum table stays"
    );
    // Wrong type; too long without point; not found twice; .H and .I; datum table not found.
    for (line, number) in [(2, 6), (3, 6), (4, 7), (5, 7), (6, 8), (7, 9), (8, 5), (-1, 5)] {
        assert_eq!(desk.submit(9090, &[line], 1), code(number), "line {line}");
    }
    assert_eq!(desk.nc.program.as_deref(), Some("ISO.I"));
}

#[test]
fn m9090_depends_on_the_state() {
    let mut desk = pallets();
    assert_eq!(desk.cyclic(9090, &[0], 1), code(1));
    desk.nc.program_running = true;
    assert_eq!(desk.submit(9090, &[0], 1), code(2));
    desk.nc.program_running = false;
    assert_eq!(desk.set("W272", 1).submit(9090, &[0], 1), code(3));
    assert_eq!(desk.set("W272", 4).submit(9090, &[0], 1), code(0), "single block");
    desk.nc.pallet = None;
    assert_eq!(desk.submit(9090, &[0], 1), code(4));
}

#[test]
fn m9090_looks_for_types_that_are_not_disabled() {
    let mut desk = pallets();
    // Plain language and datum tables disabled.
    desk.parameter("7224.0=%00001001");
    assert_eq!(desk.submit(9090, &[0], 1), code(7));
    assert_eq!(desk.submit(9090, &[6], 1), code(0), "99.I is the only one now");
    assert_eq!(desk.nc.program.as_deref(), Some("99.I"));
    assert_eq!(desk.submit(9090, &[7], 1), code(0), "the datum table is ignored");
    assert_eq!(desk.nc.datum_table, None);
    // A locked type has no files [000:6857], so no pallet file has M status: bit 4.
    desk.parameter("7224.0=%00010000");
    assert_eq!(desk.submit(9090, &[0], 1), code(4));
}

#[test]
fn m9095_activates_a_line() {
    let mut desk = Desk::new();
    assert_eq!(desk.submit(9095, &[0], 1), code(6), "no .CMA file");
    let tables = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    desk.nc.compensation = Some(vec![
        tables(&[]),
        tables(&["A", "B"]),
        tables(&["A", "GONE"]),
        tables(&["LONG"]),
        tables(&["A", "B", "B"]),
        tables(&["C"; 4]),
        tables(&["WIDE", "A"]),
    ]);
    // Dependencies, and the points of each.
    for (name, dependencies, points) in [
        ("A", 1, 256),
        ("B", 1, 200),
        ("C", 3, 1),
        ("WIDE", 2, 192),
        ("LONG", 1, 257),
    ] {
        let size = CompensationSize { dependencies, points };
        desk.nc.compensation_tables.insert(name.to_owned(), size);
    }
    assert_eq!(desk.submit(9095, &[1], 1), code(0));
    assert_eq!(desk.nc.compensation_line, 1);
    // 256 + 200 + 200 points are more than 640, 2 · 192 + 256 are as many; four tables with three dependencies each are more
    // than ten [000:3770].
    for (line, number) in [(6, 0), (1, 0), (7, 1), (-1, 1), (2, 2), (3, 3), (4, 4), (5, 5)] {
        assert_eq!(desk.submit(9095, &[line], 1), code(number), "line {line}");
    }
    assert_eq!(desk.cyclic(9095, &[1], 1), code(7));
    desk.nc.program_running = true;
    assert_eq!(desk.submit(9095, &[0], 1), code(8));
    assert_eq!(desk.nc.compensation_line, 1);
    assert_eq!(desk.set("M2044", 1).submit(9095, &[0], 1), code(0));
    assert_eq!(desk.nc.compensation_line, 0);
}
