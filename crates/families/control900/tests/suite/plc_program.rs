//! A PLC program with its window: markers and double words are parameters [002:3606-3816] [002:5455-5501].

use bahn_control900::{Plc900, Setup, StandardAnswers, Window900};
use bahn_path::{At, Axis, Synchronisation};
use bahn_plc::{Compilation, MemoryFiles, Options};
use bahn_system900::{DataFile, Memory};

use crate::support::list::Line;
use crate::support::{Rig, TWO_CHANNELS, axis};

/// The program of every test: loops and axes enabled, reference as the axes say, mode and start as they are asked for, in channel 1.
/// Input 4 breaks off; output 7 is on while the program runs.
const PROGRAM: &str = "
       L     I3
       = M300             ; REOK_K1
       = M301             ; KAFR_K1
       = M302             ; REFALK1
       L     D200         ; P8683: the mode
       = D204             ; BA_K1
       L     M310         ; TASTAK1
       S     M303         ; STARTK1
       L     M311         ; TASTOK1
       R     M303
       L     I4
       = M304             ; ABBRUK1
       L     M312         ; AAST_K1
       = O7
";

/// What stands where.
fn window(memory: &Memory, more: impl FnOnce(Window900) -> Window900) -> Window900 {
    let marker = |window: Window900, name: &str, at: &str| {
        window.marker(memory.marker(name).unwrap(), at.parse().unwrap())
    };
    let mut all = Window900::default();
    for (name, at) in [
        ("REOK_K1", "M300"),
        ("KAFR_K1", "M301"),
        ("REFALK1", "M302"),
        ("STARTK1", "M303"),
        ("ABBRUK1", "M304"),
        ("SAFREK1", "M305"),
        ("TASTAK1", "M310"),
        ("TASTOK1", "M311"),
        ("AAST_K1", "M312"),
        ("FB+1", "M313"),
        ("REPO+2", "M314"),
    ] {
        all = marker(all, name, at);
    }
    for (name, at) in [("P8683", "D200"), ("P500", "D208")] {
        let place = memory.place(name.parse().unwrap()).unwrap();
        all = all.number(place, memory.direction(place), at.parse().unwrap());
    }
    let mode = memory.marker("BA_K1").unwrap();
    more(all.number(mode.place, mode.direction, "D204".parse().unwrap()))
}

/// Switched on with a program after the common one.
fn on(data: &str, program: &str, more: impl FnOnce(Window900) -> Window900) -> Rig {
    let axes = (1..=4).map(axis).collect::<String>();
    let text = format!("{TWO_CHANNELS}{axes}q103: 1000\n{data}");
    let file = DataFile::read(text.as_bytes());
    let source = format!("{PROGRAM}{program}       EM\n");
    let files = MemoryFiles::from([("MAIN.PLC", source.as_str())]);
    let compiled = Compilation::compile(&files, "MAIN.PLC", Options::default());
    assert!(compiled.errors.is_empty(), "{:?}", compiled.errors);
    let plc = Plc900 {
        program: compiled.program.unwrap().into(),
        window: window(file.memory(), more),
    };
    let setup = Setup {
        answers: StandardAnswers::NONE,
        plc: Some(plc),
        ..Setup::default()
    };
    let mut rig = Rig::with(&file, setup);
    rig.plant.ideal.inputs[3] = true;
    rig.seconds(0.1);
    rig
}

fn far() -> [Line; 1] {
    [Line::to(&[(Axis::X, 200.0)], 6000.0)]
}

/// The program gives enables, mode and start; the input breaks off, and the output tells that the program runs.
#[test]
fn the_program_is_the_plc() {
    let mut rig = on("", "", |window| window);
    assert_eq!(["P8700", "P8701", "P8709"].map(|name| rig.read(name)), [1.0; 3]);
    rig.start(1, &far());
    assert_eq!((rig.read("P8703"), rig.read("P8704")), (2.0, 1.0));
    rig.seconds(0.05);
    assert!(rig.control.commands().outputs[7]);
    rig.plant.ideal.inputs[4] = true;
    rig.until(|rig| rig.read("P8685") == 0.0);
    rig.seconds(0.05);
    assert!(!rig.control.commands().outputs[7]);
    assert_eq!((rig.read("P8705"), rig.read("P8704")), (1.0, 0.0));
    // The next start is another one.
    rig.plant.ideal.inputs[4] = false;
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 200.0);
    // STOP, and START goes on.
    rig.start(1, &[Line::to(&[(Axis::X, 0.0)], 6000.0)]);
    rig.operator("P8682", "1");
    rig.until(|rig| rig.read("P8685") == 1.0);
    rig.operator("P8682", "2");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 0.0);
}

/// A byte of an axis, shown and given: byte 1 of P12187 while X moves in plus; byte 1 of P12130 of physical axis 2.
#[test]
fn markers_of_axes_are_bytes() {
    let mut rig = on("", "       L     M313\n       = M314\n", |window| window);
    assert_eq!(
        rig.control
            .memory()
            .cell("q2330".parse().unwrap())
            .unwrap()
            .bits(),
        None
    );
    rig.start(1, &far());
    rig.seconds(0.1);
    let bits = |rig: &Rig, name: &str| rig.control.memory().cell(name.parse().unwrap()).unwrap().bits();
    assert_eq!(bits(&rig, "q2187").map(|bits| bits & 0xFF), Some(1));
    assert_eq!(bits(&rig, "q2330"), Some(1));
    rig.until_end(1);
    rig.seconds(0.5);
    assert_eq!(bits(&rig, "q2330"), Some(0));
}

/// A double word holds the integer of the number: 12.5 with one decimal is 125, and 126 is 12.6. Whoever wrote last counts.
#[test]
fn a_parameter_is_the_integer_of_its_number() {
    let program =
        "       L     I5\n       IFT\n       L     D208\n       +     K+1\n       = D208\n       ENDI\n";
    let mut rig = on("P500: 12.5\n", program, |window| window);
    let word = |rig: &Rig| rig.control.plc().unwrap().plc().number("D208".parse().unwrap());
    assert_eq!(word(&rig), 125);
    rig.plant.ideal.inputs[5] = true;
    rig.until(|rig| rig.read("P500") >= 12.6);
    rig.plant.ideal.inputs[5] = false;
    rig.seconds(0.05);
    let counted = rig.read("P500");
    assert_eq!(word(&rig), (counted * 10.0).round() as i32);
    rig.operator("P500", "3.5");
    rig.seconds(0.05);
    assert_eq!((word(&rig), rig.read("P500")), (35, 3.5));
}

/// M8 flies: its marker is 1 for one PLC cycle. M6 waits: its marker is 1 until the block release, which the program gives at once
/// where nothing else is to be done.
#[test]
fn m_functions_have_markers() {
    // P11051: M6 before with stop; P11052: M8 before, flying. The program counts the cycles in which it sees them.
    let data = "P11051: $00050000\nP11052: $00000001\n";
    let program = "       L     M408\n       IFT\n       L     W10\n       +     K+1\n       = W10\n       ENDI\n\
                   \x20      L     M406\n       IFT\n       L     W12\n       +     K+1\n       = W12\n       ENDI\n\
                   \x20      L     M406\n       A     I6\n       = M305\n";
    let mut rig = on(data, program, |window| {
        window
            .function(1, 6, "M406".parse().unwrap())
            .function(1, 8, "M408".parse().unwrap())
    });
    let to = |x: f64| Line::to(&[(Axis::X, x)], 6000.0);
    let lines = [
        to(20.0),
        to(40.0).with(8, At::Start, Synchronisation::Mos),
        to(60.0).with(6, At::Start, Synchronisation::MvsSvs),
    ];
    rig.start(1, &lines);
    rig.until(|rig| rig.read("P8559") == 1.0);
    let word = |rig: &Rig, name: &str| rig.control.plc().unwrap().plc().number(name.parse().unwrap());
    assert_eq!(word(&rig, "W10"), 1);
    // Half a second of 10 ms.
    rig.seconds(0.5);
    assert!((49..=51).contains(&word(&rig, "W12")), "{}", word(&rig, "W12"));
    assert_eq!(rig.read("P12151"), 40.0);
    rig.plant.ideal.inputs[6] = true;
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 60.0);
    let transfer = *rig.control.transfers().last().unwrap();
    assert!(transfer.m == 6 && transfer.ack_us.is_some(), "{transfer:?}");
    rig.seconds(0.1);
    assert_eq!(
        rig.read("P8706"),
        0.0,
        "the release is taken back with the marker"
    );
}

/// Each function with stop has its own acknowledgement: of three in a row never two markers are 1 at once.
#[test]
fn an_acknowledged_function_is_over() {
    let program = "       L     M405\n       A     M406\n       S     M20\n       L     M405\n       O     M406\n       = M305\n";
    let mut rig = on("P11051: $00050500\n", program, |window| {
        window
            .function(1, 5, "M405".parse().unwrap())
            .function(1, 6, "M406".parse().unwrap())
    });
    let line = |m: u16| Line::to(&[], 6000.0).with(m, At::Start, Synchronisation::MvsSvs);
    rig.start(
        1,
        &[
            line(5),
            line(6),
            line(5),
            line(6),
            Line::to(&[(Axis::X, 10.0)], 6000.0),
        ],
    );
    rig.until_end(1);
    assert_eq!(
        rig.control
            .transfers()
            .filter(|transfer| transfer.ack_us.is_some())
            .count(),
        4
    );
    assert!(!rig.control.plc().unwrap().plc().bit("M20".parse().unwrap()));
}

/// What the operator gives beside the PLC, as a script does, is seen by it.
#[test]
fn the_operator_may_be_the_plc_too() {
    let mut rig = on("", "", |window| window);
    rig.plc("P8700", "0");
    assert_eq!(rig.read("P8700"), 0.0);
    // The program says at its next cycle what holds.
    rig.seconds(0.05);
    assert_eq!(rig.read("P8700"), 1.0);
}

/// An error of the program stops it: a scan without end, with its place; the circuit opens.
#[test]
fn an_error_of_the_program_stops_all() {
    let mut rig = on("", "LBL WAIT\n       L     I7\n       JPT   WAIT\n", |window| {
        window
    });
    rig.start(1, &far());
    rig.plant.ideal.inputs[7] = true;
    rig.until(|rig| !rig.control.messages().is_empty());
    let said = rig.control.messages()[0].to_string();
    assert!(said.starts_with("the PLC has stopped at MAIN.PLC:"), "{said}");
    rig.seconds(2.0);
    assert_eq!(rig.read("P8685"), 0.0);
    assert!(!rig.control.commands().outputs[7] && !rig.control.commands().control_ready);
}
