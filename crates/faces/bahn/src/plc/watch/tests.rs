//! Keys in, screen out.

use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Compilation, MemoryFiles, Options};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use super::*;
use crate::plc::bench::bench;
use crate::plc::options::{BenchOptions, MachineOptions, ProgramOptions};

fn watch(program: &str, operands: &str) -> Watch {
    let files = MemoryFiles::from([("MAIN.PLC", program)]);
    let program = Compilation::compile(&files, "MAIN.PLC", Options::default())
        .program
        .unwrap();
    let options = BenchOptions {
        set: Vec::new(),
        script: None,
    };
    let bench = bench(
        program.into(),
        ParameterList::reference(ControlModel::Tnc415b),
        &options,
        Exchange::default(),
    )
    .unwrap();
    let operands = operands
        .split(',')
        .map(|operand| operand.parse().unwrap())
        .collect();
    Watch::new(Subject::Bench(Box::new(bench)), operands, None)
}

/// Types characters, with `~` for Enter.
fn press(watch: &mut Watch, keys: &str) {
    for character in keys.chars() {
        let code = match character {
            '~' => KeyCode::Enter,
            '\u{2193}' => KeyCode::Down,
            character => KeyCode::Char(character),
        };
        assert!(watch.key(KeyEvent::new(code, KeyModifiers::NONE)));
    }
}

/// The screen of 80 x 24 characters as lines.
fn screen(watch: &Watch) -> Vec<String> {
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal.draw(|frame| screen::draw(frame, watch)).unwrap();
    let buffer = terminal.backend().buffer();
    (0..24)
        .map(|y| (0..80).map(|x| buffer[(x, y)].symbol()).collect())
        .collect()
}

fn shows(watch: &Watch, text: &str) -> bool {
    screen(watch).iter().any(|line| line.contains(text))
}

const DOOR: &str = "L I4\n= O2\nINC W8\nEM\n";

#[test]
fn cycles_are_stepped_and_inputs_turned_over() {
    let mut watch = watch(DOOR, "I4,O2,W8");
    press(&mut watch, "c ");
    assert!(shows(&watch, "STOP   cycle 1 ") && shows(&watch, "I4       1"));
    assert!(shows(&watch, "O2       0"), "the program has not run since");
    press(&mut watch, "c");
    assert!(shows(&watch, "O2       1"));
    assert!(shows(
        &watch,
        "W8       2              0002       0000000000000010"
    ));
}

#[test]
fn lines_are_stepped() {
    let mut watch = watch(DOOR, "I4,O2,W8");
    press(&mut watch, " ll");
    assert!(shows(&watch, "LINE   cycle 1 ") && shows(&watch, "O2       1") && shows(&watch, "LA 1"));
    assert!(shows(&watch, "*    2  = O2") && shows(&watch, ">    3  INC W8"));
    // The rest of the cycle, and the next line begins a new one.
    press(&mut watch, "c");
    assert!(shows(&watch, "STOP   cycle 1 ") && shows(&watch, "W8       1"));
    press(&mut watch, "l");
    assert!(shows(&watch, "LINE   cycle 2 ") && shows(&watch, ">    2  = O2"));
    press(&mut watch, "lll");
    assert!(shows(&watch, "STOP   cycle 2 "));
}

#[test]
fn values_and_operands_are_typed() {
    let mut watch = watch(DOOR, "I4,W8");
    press(&mut watch, "\u{2193}~-3");
    assert!(shows(&watch, "W8 = -3_"));
    press(&mut watch, "~c");
    assert!(shows(
        &watch,
        "W8       -2             FFFE       1111111111111110"
    ));
    press(&mut watch, "~70000~");
    assert!(shows(&watch, "takes a number of 16 bits"));
    watch.key(KeyEvent::new(KeyCode::Esc, KeyModifiers::NONE));
    press(&mut watch, "aB8,S1~~OIL~");
    assert!(shows(&watch, "B8       -1") && shows(&watch, "S1       OIL"));
    press(&mut watch, "d");
    assert!(!shows(&watch, "OIL"));
    assert!(!watch.key(KeyEvent::new(KeyCode::Char('q'), KeyModifiers::NONE)));
}

#[test]
fn errors_stop_until_the_program_starts_anew() {
    let mut watch = watch("L M1\nCMT 1\nINC W8\nEM\nLBL 1\nCM 1\nEM\n", "M1,W8");
    press(&mut watch, "r");
    assert!(shows(&watch, "RUN "));
    watch.cycle();
    press(&mut watch, " ");
    watch.cycle();
    assert!(shows(&watch, "ERROR  cycle 2 ") && shows(&watch, "MAIN.PLC:6: error 50: nesting too deep"));
    assert!(shows(&watch, "*    6  CM 1"));
    press(&mut watch, "c");
    assert!(shows(&watch, "ERROR  cycle 2 "), "a stopped PLC has no cycles");
    press(&mut watch, "n c");
    assert!(shows(&watch, "STOP   cycle 1 ") && shows(&watch, "W8       2"));
}

/// A breakpoint stops before its line, in running too; a second one at the same line clears it.
#[test]
fn breakpoints_stop_before_their_line() {
    let mut watch = watch(DOOR, "I4,O2,W8");
    press(&mut watch, "b3~");
    assert!(shows(&watch, "breakpoint at line 3 of the main file set") && shows(&watch, "    3! INC W8"));
    press(&mut watch, "r");
    watch.cycle();
    assert!(shows(&watch, "stopped before line 3") && shows(&watch, "LINE   cycle 1 "));
    assert!(shows(&watch, ">    3! INC W8") && shows(&watch, "W8       0"));
    // On with the rest of the cycle, then the same place of the next one.
    press(&mut watch, "c");
    assert!(shows(&watch, "W8       1"));
    press(&mut watch, "c");
    assert!(shows(&watch, "stopped before line 3") && shows(&watch, "LINE   cycle 2 "));
    press(&mut watch, "b3~c");
    assert!(!shows(&watch, "3! INC") && shows(&watch, "STOP   cycle 2 "));
    // The first line stops before the cycle begins.
    press(&mut watch, "b1~c");
    assert!(shows(&watch, "stopped before line 1") && shows(&watch, "STOP   cycle 2 "));
    press(&mut watch, "c");
    assert!(shows(&watch, "STOP   cycle 3 "));
    press(&mut watch, "bx~");
    assert!(shows(&watch, "`x` is no line"));
}

#[test]
fn a_change_of_an_operand_stops() {
    let mut watch = watch(DOOR, "I4,O2");
    press(&mut watch, "\u{2193}x");
    assert!(shows(&watch, "a change of O2 stops the program") && shows(&watch, "O2!"));
    press(&mut watch, "r");
    watch.cycle();
    assert!(shows(&watch, "RUN "), "nothing has changed");
    watch.set("I4".parse().unwrap(), &Content::Number(1));
    watch.cycle();
    assert!(shows(&watch, "O2 changed from 0 to 1") && shows(&watch, "STOP "));
    press(&mut watch, "xr");
    watch.set("I4".parse().unwrap(), &Content::Number(0));
    watch.cycle();
    assert!(shows(&watch, "RUN "));
}

/// The program has the rows that the table leaves; names of fixed markers and the course of the values.
#[test]
fn names_trend_and_a_large_program() {
    let program = "L I4\n".to_owned() + &"= O2\n".repeat(60) + "INC W8\nEM\n";
    let mut watch = watch(&program, "M2045,W8");
    // The meaning of the chosen one in words, the names as far as the screen has room.
    let row = screen(&watch)
        .into_iter()
        .find(|line| line.contains("TABLE  M2045"))
        .unwrap();
    let meaning = bahn_exchange::signal::all()
        .iter()
        .find(|signal| signal.name == "M_FUNCTION_STROBE");
    assert!(row.contains(meaning.unwrap().function), "{row}");
    assert!(shows(&watch, " m_functi"));
    let lines = screen(&watch)
        .iter()
        .filter(|line| line.contains("  = O2"))
        .count();
    assert!(lines >= 9, "{lines} lines of the program on 24 rows");
    press(&mut watch, "tccc");
    assert!(shows(&watch, "TREND") && shows(&watch, "\u{2581}\u{2585}\u{2588}"));
}

/// The table of a machine that runs: scans only, and the control says what it does.
#[test]
fn a_running_machine_is_watched() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/mill");
    let program = ProgramOptions {
        file: folder,
        model: ControlModel::default(),
        parameters: None,
        strict: false,
    };
    let bench = BenchOptions {
        set: vec!["M900=1".to_owned()],
        script: None,
    };
    let machine = MachineOptions {
        part: vec!["CIRCLE.H".into()],
    };
    let subject = subject::open(&program, &bench, &machine, || Ok(Exchange::default())).unwrap();
    let operands = ["M900", "I3", "M2451"].map(|name| name.parse().unwrap());
    let mut watch = Watch::new(subject.unwrap(), operands.to_vec(), None);
    press(&mut watch, "c");
    assert!(shows(&watch, "M900     1") && shows(&watch, "STOP   cycle 1 "));
    assert!(shows(&watch, "PLC  0.5") && shows(&watch, "whole scans only"));
    // After four seconds, 200 scans of 20 ms, the reference run is on its way.
    press(&mut watch, "r");
    for _ in 0..200 {
        watch.cycle();
    }
    assert!(shows(&watch, "RUN    cycle 201 ") && shows(&watch, "reference") && shows(&watch, "I3       1"));
    // An operand of its own keeps what is set; an input is the machine's.
    press(&mut watch, "s c");
    assert!(shows(&watch, "M900     0"));
    press(&mut watch, "\u{2193} ");
    assert!(shows(&watch, "is read from the machine") && shows(&watch, "I3       1"));
    for key in ["l", "b", "n"] {
        press(&mut watch, key);
        assert!(shows(&watch, "on a machine there are whole scans"), "{key}");
    }
}
