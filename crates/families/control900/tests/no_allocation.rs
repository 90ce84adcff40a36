//! An interpolation cycle allocates nothing: not while axes move, functions go to the PLC and blocks change.

#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod support;

use bahn_control900::{Plc900, Setup, StandardAnswers, Window900};
use bahn_path::{At, Axis, Synchronisation};
use bahn_plc::{Compilation, MemoryFiles, Options};
use bahn_system900::DataFile;
use support::Rig;
use support::list::Line;

#[test]
fn cycles_allocate_nothing() {
    let mut rig = Rig::on("P11051: $10050601\n");
    let lines: Vec<Line> = (0..40)
        .map(|at| {
            let to = [
                (Axis::X, f64::from(at % 3) * 10.0),
                (Axis::Y, f64::from(at) * 2.0),
            ];
            let line = Line::to(&to, 5000.0);
            match at % 4 {
                0 => line.with(4, At::Start, Synchronisation::Mos),
                1 => line.with(6, At::Start, Synchronisation::MvsSvs),
                2 => line.with(5, At::End, Synchronisation::MnsSns),
                _ => line,
            }
        })
        .collect();
    rig.start(1, &lines);
    rig.start(2, &lines);
    let mut moved = 0;
    while !(rig.control.run(1).1 && rig.control.run(2).1) {
        rig.control.prepare();
        let (control, plant) = (&mut rig.control, &mut rig.plant);
        let allocated = allocation_counter::measure(|| control.cycle(plant));
        assert_eq!(allocated.count_total, 0, "at {} us", rig.control.now_us());
        moved += usize::from(rig.read("P8938") > 0.0);
    }
    assert!(moved > 500, "{moved}");
    assert_eq!(rig.control.transfers().count(), 60);
}

/// Nor while a PLC program scans, and markers and double words go through its window.
#[test]
fn cycles_with_a_plc_program_allocate_nothing() {
    let axes = (1..=4).map(support::axis).collect::<String>();
    let text = format!("{}{axes}q103: 1000\nP11051: $00050000\n", support::TWO_CHANNELS);
    let file = DataFile::read(text.as_bytes());
    let memory = file.memory();
    // The release follows the marker of M6; a double word counts the cycles.
    let source =
        "       L     M406\n       = M305\n       L     D200\n       +     K+1\n       = D200\n       EM\n";
    let files = MemoryFiles::from([("MAIN.PLC", source)]);
    let program = Compilation::compile(&files, "MAIN.PLC", Options::default())
        .program
        .unwrap();
    let counter = memory.place("P500".parse().unwrap()).unwrap();
    let window = Window900::default()
        .marker(memory.marker("SAFREK1").unwrap(), "M305".parse().unwrap())
        .function(1, 6, "M406".parse().unwrap())
        .number(counter, memory.direction(counter), "D200".parse().unwrap());
    let setup = Setup {
        answers: StandardAnswers {
            m: false,
            ..StandardAnswers::ALL
        },
        plc: Some(Plc900 {
            program: program.into(),
            window,
        }),
        ..Setup::default()
    };
    let mut rig = Rig::with(&file, setup);
    let lines: Vec<Line> = (0..20)
        .map(|at| {
            let line = Line::to(&[(Axis::X, f64::from(at % 3) * 10.0)], 5000.0);
            line.with(6, At::Start, Synchronisation::MvsSvs)
        })
        .collect();
    rig.start(1, &lines);
    while !rig.control.run(1).1 {
        rig.control.prepare();
        let (control, plant) = (&mut rig.control, &mut rig.plant);
        let allocated = allocation_counter::measure(|| control.cycle(plant));
        assert_eq!(allocated.count_total, 0, "at {} us", rig.control.now_us());
    }
    assert_eq!(rig.control.transfers().count(), 20);
    assert!(rig.read("P500") > 100.0, "{}", rig.read("P500"));
}
