//! What goes between a control that runs, its PLC and its panel: what a write does, what is recorded of it.

use bahn_system900::{Channels, Memory, Name, SpaceError, Status, Traffic, Unit, Writer};

use crate::memory::{memory, name};

/// A control that runs.
#[derive(Clone, Debug, PartialEq)]
struct Running {
    memory: Memory,
    traffic: Traffic,
}

impl Running {
    /// Two axes of one channel.
    fn of(entries: &[(&str, &str)], statuses: &[(&str, u32)]) -> Running {
        let blocks = [
            ("q102", "10000"),
            ("q103", "5000"),
            ("q110", "$01010058"),
            ("q111", "$02020059"),
        ];
        let mut memory = memory(&[&blocks[..], entries].concat());
        for (text, word) in statuses {
            memory.set_status(name(text), Status::from_word(*word)).unwrap();
        }
        Running {
            memory,
            traffic: Traffic::new(),
        }
    }

    fn write(&mut self, writer: Writer, text: &str, value: &str) -> Result<Option<i64>, SpaceError> {
        let value = value.parse().unwrap();
        self.traffic
            .write(&mut self.memory, 1500, writer, name(text), value)
    }

    /// What was recorded, without numbers and times.
    fn recorded(&self) -> Vec<String> {
        let records = self.traffic.events().records();
        records.map(|record| record.event.to_string()).collect()
    }
}

const PLC: u32 = 1 << 9;
const PANEL: u32 = 1 << 10;
const PANEL_ALWAYS: u32 = 1 << 14;
const SAMPLED: u32 = 1 << 15;

/// A write goes to PLC and panel as its status says, in the order of the writes, and not back [002:314-328].
#[test]
fn writes_go_to_plc_and_panel() {
    let mut running = Running::of(
        &[("P11271", "3")],
        &[("P1", PLC), ("P2", PANEL), ("P3", PANEL_ALWAYS | PLC)],
    );
    for (writer, text, value) in [
        (Writer::Program, "P1", "1"),
        (Writer::Program, "P2", "2"),
        (Writer::Plc, "P3", "3"),
        (Writer::Editor, "P3", "--"),
        (Writer::Program, "P4", "4"),
    ] {
        assert_eq!(running.write(writer, text, value), Ok(None));
    }
    let wanted = [
        "PARA CNC --> PLC K1 P1: 1",
        "PARA CNC --> OP K1 P2: 2",
        "PARA CNC <-- PLC K1 P3: 3",
        "PARA CNC --> OP K1 P3: 3",
        "PARA CNC <-- OP K1 P3: --",
        "PARA CNC --> PLC K1 P3: --",
    ];
    assert_eq!(running.recorded(), wanted);
}

/// Parameters with a marker go to the PLC, whatever their status says, and so does q1 [002:376-379].
#[test]
fn markers_go_to_the_plc() {
    let mut running = Running::of(&[("P11271", "1")], &[]);
    running.write(Writer::Control, "P8683", "2").unwrap();
    running.write(Writer::Plc, "P8703", "2").unwrap();
    running.write(Writer::Control, "q1", "2").unwrap();
    let wanted = [
        "PARA CNC --> PLC K1 P8683: 2",
        "PARA CNC <-- PLC K1 P8703: 2",
        "PARA CNC --> PLC K0 q1: 2",
    ];
    assert_eq!(running.recorded(), wanted);
}

/// Clearing P12111 or P12112 takes the report back that the position is reached [002:7795-7815].
#[test]
fn clearing_takes_reports_back() {
    let mut running = Running::of(&[("q2391", "1"), ("q2392", "1")], &[]);
    let number = |running: &Running, text: &str| running.memory.cell(name(text)).unwrap().number();
    for (text, value) in [("P12311", "-3"), ("P12312", "20"), ("P12311", "--")] {
        running.write(Writer::Plc, text, value).unwrap();
    }
    assert_eq!(
        (number(&running, "P12391"), number(&running, "P12392")),
        (Some(0.0), Some(1.0))
    );
    running.write(Writer::Program, "q2312", "--").unwrap();
    assert_eq!(number(&running, "P12392"), Some(0.0));
}

/// P11308 converts lengths at once, whoever names it; a value that is no unit is refused [002:6324-6355].
#[test]
fn a_write_changes_the_unit() {
    let mut running = Running::of(&[], &[("q9000", 0x0300_0010)]);
    let written = |running: &Running| running.memory.cell(name("q9000")).unwrap().written();
    running.write(Writer::Program, "q9000", "25.4").unwrap();
    running.write(Writer::Program, "q1308", "2").unwrap();
    assert_eq!(Unit::of(&running.memory), Unit::Inch(2));
    assert_eq!(written(&running), "1.00000");
    for wrong in ["4", "-1", "0.5", "$FF"] {
        let refused = running.write(Writer::Plc, "P11308", wrong);
        assert_eq!(refused, Err(SpaceError::NoUnit(name("P11308"))), "{wrong}");
    }
    running.write(Writer::Program, "P11308", "--").unwrap();
    assert_eq!(written(&running), "25.400");
}

/// What a lock holds back changes nothing and goes to nobody.
#[test]
fn what_is_locked_is_not_recorded() {
    let mut running = Running::of(
        &[("P8510", "$2"), ("P11271", "7")],
        &[("P1", 0x0003_0000 | PLC), ("P11308", 0x0001_0000)],
    );
    running.write(Writer::Plc, "P11010", "$1").unwrap();
    running.write(Writer::Plc, "P11000", "1").unwrap();
    running.memory.update_locks(Channels::NONE);
    let before = running.clone();
    for locked in ["P1", "P11308"] {
        assert_eq!(
            running.write(Writer::Program, locked, "1"),
            Err(SpaceError::Locked(name(locked), 1))
        );
    }
    assert_eq!(running, before);
    running.memory.update_locks(Channels::one(1));
    running.write(Writer::Plc, "P11000", "0").unwrap();
    running.memory.update_locks(Channels::one(1));
    assert_eq!(
        running.write(Writer::Editor, "P1", "2"),
        Err(SpaceError::Locked(name("P1"), 2))
    );
    running.memory.update_locks(Channels::NONE);
    assert_eq!(running.write(Writer::Editor, "P1", "2"), Ok(None));
}

/// A parameter does the same by its system number; a refusal has the name that was said.
#[test]
fn names_say_the_same() {
    let mut running = Running::of(&[], &[("P1", 0x0001_0000)]);
    // P8553 is q10000 + 5000 + 1553.
    assert_eq!(running.write(Writer::Program, "q16553", "12004"), Ok(None));
    let found = running.memory.cell(name("P8554")).unwrap().number();
    assert_eq!(found, Some(2004.0));
    running.write(Writer::Plc, "q1010", "$1").unwrap();
    running.write(Writer::Plc, "q1000", "1").unwrap();
    running.memory.update_locks(Channels::NONE);
    let refused = SpaceError::Locked(name("q10001"), 1);
    assert_eq!(running.write(Writer::Program, "q10001", "2"), Err(refused));
    let great = running.write(Writer::Plc, "q10001", "3000000000").unwrap_err();
    assert_eq!(
        great.to_string(),
        "q10001: 3000000000 does not go into four bytes"
    );
    let unit = running.write(Writer::Plc, "q1308", "4").unwrap_err();
    assert_eq!(
        unit.to_string(),
        "q1308 is 0 for metric lengths, 1, 2 or 3 for inches"
    );
}

/// q10 is a function that the control executes.
#[test]
fn a_function_is_asked_for() {
    let mut running = Running::of(&[], &[]);
    assert_eq!(running.write(Writer::Editor, "q10", "170"), Ok(Some(170)));
    assert_eq!(running.write(Writer::Editor, "q10", "--"), Ok(None));
    assert_eq!(running.write(Writer::Editor, "q11", "170"), Ok(None));
}

/// A write of a parameter with the sample bit is recorded when P11271 asks for it, transfers likewise, P11279 always
/// [002:330-335] [002:6169-6198].
#[test]
fn writes_are_recorded() {
    let mut running = Running::of(
        &[("P11271", "7")],
        &[("P600", SAMPLED), ("q1137", PLC | SAMPLED), ("P601", PANEL)],
    );
    for (writer, text, value) in [
        (Writer::Program, "P600", "5"),
        (Writer::Control, "q1137", "65822"),
        (Writer::Plc, "P600", "--"),
        (Writer::Program, "P601", "1"),
        (Writer::Editor, "P11279", "12345"),
    ] {
        running.write(writer, text, value).unwrap();
    }
    let lines = [
        "K1 P600: 5",
        "PARA CNC --> PLC K0 q1137: 65822",
        "K0 q1137: 65822",
        "PARA CNC <-- PLC K1 P600: --",
        "K1 P600: --",
        "PARA CNC --> OP K1 P601: 1",
        "PARA CNC <-- OP K0 q1279: 12345",
        "P11279: 12345",
    ];
    assert_eq!(running.recorded(), lines);
    running.write(Writer::Plc, "P11271", "0").unwrap();
    running.write(Writer::Program, "P600", "6").unwrap();
    assert_eq!(running.recorded().len(), 8, "nothing is recorded any more");
}

/// Keys and pictures are parameters of the panel, and recorded [002:6036-6068].
#[test]
fn keys_and_pictures_are_recorded() {
    let mut running = Running::of(&[], &[]);
    // `INIT` and `_A`, the first letter in byte 1.
    let letters = |text: &[u8; 4]| format!("${:X}", u32::from_le_bytes(*text));
    for (text, value) in [
        ("P11260", "$02000114".to_owned()),
        ("P11261", letters(b"INIT")),
        ("P11262", letters(b"_A\0\0")),
        ("P11260", "--".to_owned()),
    ] {
        running.write(Writer::Editor, text, &value).unwrap();
    }
    assert_eq!(running.recorded(), ["C-KEY 20", "PICTURE: INIT_A"]);
}

/// With P11280 = 1 exchanges with the PLC are counted, and the last one is shown [002:6205-6247].
#[test]
fn exchanges_with_the_plc_are_counted() {
    let mut running = Running::of(&[], &[("P5", PLC), ("q1160", PLC), ("q9000", PLC)]);
    let shown = |running: &Running, first: u32| {
        let of = |number| running.memory.cell(Name::P(1, number)).unwrap().number();
        [first, first + 1, first + 2, first + 3].map(of)
    };
    running.write(Writer::Program, "P5", "1.5").unwrap();
    assert_eq!(shown(&running, 11_281), [None; 4], "not before it is asked for");
    running.write(Writer::Program, "P11280", "1").unwrap();
    running.write(Writer::Program, "P5", "1.5").unwrap();
    // Its four bytes: 15, with one decimal.
    assert_eq!(
        shown(&running, 11_281),
        [Some(1.0), Some(1.0), Some(5.0), Some(15.0)]
    );
    running.write(Writer::Program, "q1160", "3").unwrap();
    running.write(Writer::Control, "q9000", "--").unwrap();
    assert_eq!(
        shown(&running, 11_281),
        [Some(2.0), Some(0.0), Some(9000.0), None]
    );
    running.write(Writer::Plc, "P7", "7").unwrap();
    assert_eq!(
        shown(&running, 11_291),
        [Some(1.0), Some(1.0), Some(7.0), Some(7.0)]
    );
}
