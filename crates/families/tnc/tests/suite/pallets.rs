//! Module 9090 on the running control: a line of the pallet file selects program and datum table, and modules 9092 to
//! 9094 and cycle 7 work with that table [000:15328-15545].

use crate::stand::*;
use crate::support::*;
use bahn_plc::{MemoryTable, PalletLine, TableFile, TableKind};
use bahn_tnc::{NcFiles, Remembered};

/// Keys A and C: module 9090 with lines 0 and 1 of the pallet file, D with a line that is missing; the answer in
/// W92. Key B: X of line 7 of the datum table is read and written 12.5 mm, and a line with Y = 30 mm is looked for. Key E:
/// what A does, and then what B does, in one submit job.
fn plc() -> String {
    let pallet = |line| call(&[line], 9090, &["W92"]);
    let table = [
        call(&["K+1", "K+7", "K+0"], 9093, &["D100", "W104"]),
        call(&["K+1", "K+7", "K+0", "K+125000"], 9094, &["W106"]),
        call(&["K+1", "K+300000", "K+1", "K+0"], 9092, &["W108", "W110"]),
    ];
    let jobs = [
        (20, pallet("K+0")),
        (21, table.concat()),
        (22, pallet("K+1")),
        (23, pallet("K+5")),
        (24, pallet("K+0") + &table.concat()),
    ];
    let [mut main, mut modules] = [String::from(ACKNOWLEDGE), String::new()];
    for (key, job) in jobs {
        main += &format!(
            "       L     I{key}\n       AN    M{key}\n       CMT   ASK{key}\n       L     I{key}\n       = M{key}\n"
        );
        modules += &format!(
            "       EM\nLBL ASK{key}\n       SUBM  JOB{key}\n       = B80\n       EM\nLBL JOB{key}\n{job}"
        );
    }
    main + &modules
}

/// Two datum tables; line 7 of ONE is X 10, Y 20, of TWO X -15, Y 30.
fn files() -> NcFiles {
    let table = |x: f64, y: f64| {
        let mut table = MemoryTable::with_lines(TableKind::Datum, [0, 7].into_iter());
        table.set_value(7, 0, x);
        table.set_value(7, 1, y);
        table
    };
    let line = |program: &str, datum_table: Option<&str>| PalletLine {
        program: program.to_owned(),
        datum_table: datum_table.map(str::to_owned),
    };
    NcFiles {
        names: ["1.H", "2.H", "ONE.D", "TWO.D"].map(str::to_owned).into(),
        pallet: Some([(0, line("2", Some("TWO"))), (1, line("1.H", None))].into()),
        datum_tables: [("ONE.D", table(10.0, 20.0)), ("TWO.D", table(-15.0, 30.0))]
            .map(|(name, table)| (name.to_owned(), table))
            .into(),
        datum_table: Some("ONE.D".to_owned()),
        ..NcFiles::default()
    }
}

fn build(remembered: Remembered) -> Build {
    let shifted = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #7\nL X+60 Y+70 R0 F6000";
    let mut build = bench(&plc())
        .program("1.H", shifted)
        .program("2.H", &format!("{shifted}\nL X+61"));
    build.files = files();
    build.remembered = remembered;
    build
}

fn tap(rig: &mut Rig, key: char) {
    rig.event(&format!("key {key} press"));
    rig.seconds(0.2);
    rig.event(&format!("key {key} release"));
    rig.seconds(0.2);
}

/// Where the axes of the plane come to when the selected program runs to its end, from the workpiece datum.
fn run_to_end(rig: &mut Rig) -> [f64; 2] {
    run(rig, 5.0);
    rig.seconds(0.2);
    ['X', 'Y'].map(|axis| display(rig, axis))
}

/// Module 9090: program and datum table of a line, and its faults; what is selected is there after power-off.
#[test]
fn a_pallet_selects_program_and_datum_table() {
    let mut rig = ready(build(Remembered::default()));
    // The table of the folder: 60 + 10, 70 + 20.
    let [x, y] = run_to_end(&mut rig);
    near(x, 70.0);
    near(y, 90.0);
    rig.control.stored();
    // Line 0: program 2 and table TWO: 61 - 15, 70 + 30; to be stored at once.
    tap(&mut rig, 'A');
    assert_eq!(rig.number("W92"), 0);
    let kept = rig.control.unsaved().unwrap();
    assert_eq!(
        (kept.pallet_line, kept.program.as_deref()),
        (Some(0), Some("2.H"))
    );
    assert_eq!(kept.datum_table.as_deref(), Some("TWO.D"));
    let [x, y] = run_to_end(&mut rig);
    near(x, 46.0);
    near(y, 100.0);
    // Line 1 names no table: that of line 0 stays. Line 5 is not there.
    for (key, answer) in [('C', 0), ('D', 5)] {
        tap(&mut rig, key);
        assert_eq!(rig.number("W92"), answer);
        let kept = rig.control.remember();
        assert_eq!(
            (kept.pallet_line, kept.program.as_deref()),
            (Some(1), Some("1.H"))
        );
        assert_eq!(kept.datum_table.as_deref(), Some("TWO.D"));
    }
    let [x, _] = run_to_end(&mut rig);
    near(x, 45.0);
    // In MDI the modes do not fit.
    rig.command("mode mdi");
    tap(&mut rig, 'A');
    assert_eq!(rig.number("W92"), 3);
    // After power-off the same are selected.
    let kept = rig.control.remember();
    let mut rig = build(kept.clone()).rig();
    assert_eq!(rig.control.remember(), kept);
    rig.power_on();
    tap(&mut rig, 'B');
    assert_eq!((rig.number("D100"), rig.number("W104")), (-150_000, 0));
}

/// Modules 9092, 9093 and 9094 on the selected datum table; what is written counts at once and after power-off.
#[test]
fn the_selected_datum_table_is_read_and_written() {
    let mut rig = ready(build(Remembered::default()));
    rig.control.stored();
    tap(&mut rig, 'B');
    assert_eq!((rig.number("D100"), rig.number("W104")), (100_000, 0), "X of ONE");
    assert_eq!(rig.number("W106"), 0);
    // Found is line -1 with fault 6: Y = 30 is in the other table.
    assert_eq!((rig.number("W108"), rig.number("W110")), (-1, 6));
    let kept = rig.control.unsaved().unwrap();
    let written: Vec<_> = kept
        .written_datums
        .iter()
        .map(|(name, row)| (name.as_str(), row.line, row.element, row.value, row.file))
        .collect();
    assert_eq!(written, [("ONE.D", 7, 0, 12.5, 10.0)]);
    let [x, y] = run_to_end(&mut rig);
    near(x, 72.5);
    near(y, 90.0);
    // The other table: what was written into the first one stays there.
    tap(&mut rig, 'A');
    tap(&mut rig, 'B');
    assert_eq!(rig.number("D100"), -150_000, "X of TWO");
    assert_eq!((rig.number("W108"), rig.number("W110")), (7, 0));
    // After power-off both are as they were written, but for an element that its file says anew.
    let kept = rig.control.remember();
    assert_eq!(kept.written_datums.len(), 2);
    for (file, expected) in [(-15.0, 125_000), (-16.0, -160_000)] {
        let mut build = build(kept.clone());
        build
            .files
            .datum_tables
            .get_mut("TWO.D")
            .unwrap()
            .set_value(7, 0, file);
        let mut rig = ready(build);
        tap(&mut rig, 'B');
        assert_eq!(rig.number("D100"), expected);
    }
}

/// A job that selects a line with 9090 reads and writes the table of that line: the one before stays as it is.
#[test]
fn a_job_works_on_the_table_it_has_selected() {
    let mut rig = ready(build(Remembered::default()));
    tap(&mut rig, 'E');
    assert_eq!((rig.number("W92"), rig.number("W106")), (0, 0));
    assert_eq!(rig.number("D100"), -150_000, "X of TWO");
    assert_eq!(
        (rig.number("W108"), rig.number("W110")),
        (7, 0),
        "Y = 30 is in TWO"
    );
    let written: Vec<_> = rig.control.remember().written_datums;
    let names: Vec<_> = written
        .iter()
        .map(|(name, row)| (name.as_str(), row.value))
        .collect();
    assert_eq!(names, [("TWO.D", 12.5)]);
}

/// The PLC writes while the program waits for it: the next block finds the new datum.
#[test]
fn a_datum_that_is_written_in_a_run_counts() {
    let mut build = build(Remembered::default());
    build.plc = build
        .plc
        .replace("= M2482\n", "= M2482\n       AN    I23\n       = M2482\n");
    let shift = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #7";
    let mut rig = ready(build.program(
        "1.H",
        &format!("{shift}\nL X+60 R0 F6000\nL M8\nL X+61\n{shift}\nL X+62"),
    ));
    rig.event("key D press");
    rig.start();
    rig.until(5.0, "the strobe", |rig| rig.bit("M2045"));
    near(display(&rig, 'X'), 70.0);
    tap(&mut rig, 'B');
    assert_eq!(rig.number("W106"), 0);
    rig.event("key D release");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(0.2);
    near(display(&rig, 'X'), 74.5);
}
