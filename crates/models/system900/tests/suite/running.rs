//! Parameters of a control that runs: what a write does, and who hears of it.

use bahn_system900::{
    AxisCommand, Channels, Depth, EventBuffer, Memory, MessageKind, Name, News, Place, Receiver, Routine,
    Running, SpaceError, Status, Transfer, Unit, Writer,
};
use proptest::prelude::*;

use crate::memory::{memory, name};

/// Two axes of one channel, nothing waiting.
fn running(entries: &[(&str, &str)], statuses: &[(&str, u32)]) -> Running {
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
    let mut running = Running::new(memory, EventBuffer::new(Depth::Short));
    for receiver in Receiver::ALL {
        assert_eq!(running.next(receiver), Some(News::All));
        assert_eq!(running.next(receiver), None);
    }
    running
}

fn write(
    running: &mut Running,
    writer: Writer,
    text: &str,
    value: &str,
) -> Result<Option<Routine>, SpaceError> {
    running.write(1500, writer, name(text), value.parse().unwrap())
}

/// What waits for a receiver: names and values.
fn waiting(running: &mut Running, receiver: Receiver) -> Vec<(String, String)> {
    let mut all = Vec::new();
    while let Some(news) = running.next(receiver) {
        match news {
            News::All => all.push(("all".to_owned(), String::new())),
            News::One(transfer) => {
                let name = running.memory().name_of(transfer.place).to_string();
                all.push((name, transfer.cell.written()));
            }
        }
    }
    all
}

fn pairs(all: &[(&str, &str)]) -> Vec<(String, String)> {
    all.iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect()
}

const INTERPOLATOR: u32 = 1 << 8;
const PLC: u32 = 1 << 9;
const PANEL: u32 = 1 << 10;
const PANEL_ALWAYS: u32 = 1 << 14;
const SAMPLED: u32 = 1 << 15;

/// A write goes to interpolator, PLC and panel as its status says, in the order of the writes, and not back
/// [002:314-328].
#[test]
fn writes_go_to_their_receivers() {
    let mut running = running(
        &[],
        &[
            ("P1", INTERPOLATOR | PLC),
            ("P2", PANEL),
            ("P3", PANEL_ALWAYS | PLC),
        ],
    );
    for (writer, text, value) in [
        (Writer::Program, "P1", "1"),
        (Writer::Program, "P2", "2"),
        (Writer::Plc, "P3", "3"),
        (Writer::Editor, "P3", "--"),
        (Writer::Program, "P4", "4"),
        (Writer::Plc, "P1", "1.5"),
    ] {
        assert_eq!(write(&mut running, writer, text, value), Ok(None));
    }
    assert_eq!(
        waiting(&mut running, Receiver::Interpolator),
        pairs(&[("P1", "1"), ("P1", "1.5")])
    );
    assert_eq!(
        waiting(&mut running, Receiver::Plc),
        pairs(&[("P1", "1"), ("P3", "--")])
    );
    assert_eq!(
        waiting(&mut running, Receiver::Panel),
        pairs(&[("P2", "2"), ("P3", "3")])
    );
}

/// Parameters with a marker go to the PLC, whatever their status says.
#[test]
fn markers_go_to_the_plc() {
    let mut running = running(&[], &[]);
    write(&mut running, Writer::Control, "P8683", "2").unwrap();
    write(&mut running, Writer::Plc, "P8703", "2").unwrap();
    assert_eq!(waiting(&mut running, Receiver::Plc), pairs(&[("P8683", "2")]));
}

/// After power-on the PLC gets all parameters that are its own [002:316-320], the panel nothing: its bit was reset
/// [002:322-324].
#[test]
fn the_start_sends_all() {
    let statuses = [("P1", PLC), ("P2", PANEL), ("P3", PLC), ("P4", PANEL_ALWAYS)];
    let running = running(
        &[("P1", "1"), ("P2", "2"), ("P4", "4"), ("P5", "5"), ("P8709", "1")],
        &statuses,
    );
    let mut memory = running.memory().clone();
    memory.start();
    let running = Running::new(memory, EventBuffer::new(Depth::Short));
    let all = |receiver| -> Vec<String> {
        let own = running
            .all(receiver)
            .map(|transfer| running.memory().name_of(transfer.place).to_string());
        own.collect()
    };
    assert_eq!(all(Receiver::Plc), ["P1", "P8709"], "P3 is cleared");
    assert_eq!(all(Receiver::Panel), ["P4"]);
    assert_eq!(all(Receiver::Interpolator), [""; 0]);
}

/// Clearing is a command for P12110 to P12112, also when they are cleared; it takes the report back that the position
/// is reached [002:7795-7815].
#[test]
fn clearing_is_a_command() {
    let statuses = [
        ("q2310", INTERPOLATOR),
        ("q2311", INTERPOLATOR),
        ("q2312", INTERPOLATOR),
    ];
    let mut running = running(&[("q2391", "1"), ("q2392", "1")], &statuses);
    let number = |running: &Running, text: &str| running.memory().cell(name(text)).unwrap().number();
    for (text, value) in [
        ("P12310", "5.5"),
        ("P12311", "-3"),
        ("P12312", "20"),
        ("P12310", "--"),
        ("P12310", "--"),
        ("P12311", "--"),
    ] {
        write(&mut running, Writer::Plc, text, value).unwrap();
    }
    assert_eq!(
        (number(&running, "P12391"), number(&running, "P12392")),
        (Some(0.0), Some(1.0))
    );
    write(&mut running, Writer::Program, "q2312", "--").unwrap();
    assert_eq!(number(&running, "P12392"), Some(0.0));
    let mut commands = Vec::new();
    while let Some(News::One(transfer)) = running.next(Receiver::Interpolator) {
        commands.push(AxisCommand::of(transfer).unwrap());
    }
    let wanted = [
        AxisCommand::SetPosition(Some(5.5)),
        AxisCommand::MoveBy(Some(-3.0)),
        AxisCommand::MoveTo(Some(20.0)),
        AxisCommand::SetPosition(None),
        AxisCommand::SetPosition(None),
        AxisCommand::MoveBy(None),
        AxisCommand::MoveTo(None),
    ];
    assert_eq!(commands, wanted.map(|command| (2, command)));
    let reports = pairs(&[("P12312", "--"), ("P12391", "0"), ("P12392", "0")]);
    let heard = waiting(&mut running, Receiver::Plc);
    assert!(
        reports.iter().skip(1).all(|report| heard.contains(report)),
        "{heard:?}"
    );
    let cell = running.memory().cell(name("P12004")).unwrap();
    for place in [
        Place::Q(2004),
        Place::Q(110),
        Place::Q(8510),
        Place::OfChannel(1, 1, 153),
    ] {
        assert_eq!(AxisCommand::of(Transfer { place, cell }), None);
    }
}

/// P11308 converts lengths at once, whoever names it; a value that is no unit is refused [002:6324-6355].
#[test]
fn a_write_changes_the_unit() {
    let mut running = running(&[], &[("q9000", 0x0300_0010)]);
    write(&mut running, Writer::Program, "q9000", "25.4").unwrap();
    write(&mut running, Writer::Program, "q1308", "2").unwrap();
    assert_eq!(Unit::of(running.memory()), Unit::Inch(2));
    assert_eq!(running.memory().cell(name("q9000")).unwrap().written(), "1.00000");
    assert_eq!(
        running.next(Receiver::Panel),
        Some(News::All),
        "many parameters are others"
    );
    for wrong in ["4", "-1", "0.5", "$FF"] {
        let refused = write(&mut running, Writer::Plc, "P11308", wrong);
        assert_eq!(refused, Err(SpaceError::NoUnit(name("P11308"))), "{wrong}");
    }
    write(&mut running, Writer::Program, "P11308", "--").unwrap();
    assert_eq!(running.memory().cell(name("q9000")).unwrap().written(), "25.400");
}

/// Active locks follow switches, definitions and AUTO; what is refused changes nothing and is sent to nobody.
#[test]
fn locks_follow_switches() {
    let mut running = running(
        &[("P8510", "$2")],
        &[("P1", 0x0003_0000 | PLC), ("P11308", 0x0001_0000)],
    );
    write(&mut running, Writer::Plc, "P11010", "$1").unwrap();
    write(&mut running, Writer::Program, "P1", "1").unwrap();
    write(&mut running, Writer::Plc, "P11000", "1").unwrap();
    assert_eq!(waiting(&mut running, Receiver::Plc), pairs(&[("P1", "1")]));
    let before = running.clone();
    assert_eq!(
        write(&mut running, Writer::Program, "P1", "2"),
        Err(SpaceError::Locked(name("P1"), 1))
    );
    let unit = name("P11308");
    assert_eq!(
        write(&mut running, Writer::Program, "P11308", "1"),
        Err(SpaceError::Locked(unit, 1))
    );
    assert_eq!(running, before);
    write(&mut running, Writer::Plc, "P11000", "0").unwrap();
    running.set_auto(Channels::one(1));
    assert_eq!(
        write(&mut running, Writer::Editor, "P1", "2"),
        Err(SpaceError::Locked(name("P1"), 2))
    );
    running.set_auto(Channels::NONE);
    assert_eq!(write(&mut running, Writer::Editor, "P1", "2"), Ok(None));
}

/// A parameter does the same by its system number; a refusal has the name that was said.
#[test]
fn names_say_the_same() {
    let mut running = running(&[], &[("P1", 0x0001_0000)]);
    // P8553 is q10000 + 5000 + 1553.
    assert_eq!(write(&mut running, Writer::Program, "q16553", "12004"), Ok(None));
    assert_eq!(
        running.memory().cell(name("P8554")).unwrap().number(),
        Some(2004.0)
    );
    write(&mut running, Writer::Plc, "q1010", "$1").unwrap();
    write(&mut running, Writer::Plc, "q1000", "1").unwrap();
    let refused = SpaceError::Locked(name("q10001"), 1);
    assert_eq!(write(&mut running, Writer::Program, "q10001", "2"), Err(refused));
    let great = write(&mut running, Writer::Plc, "q10001", "3000000000").unwrap_err();
    assert_eq!(
        great.to_string(),
        "q10001: 3000000000 does not go into four bytes"
    );
    let unit = write(&mut running, Writer::Plc, "q1308", "4").unwrap_err();
    assert_eq!(
        unit.to_string(),
        "q1308 is 0 for metric lengths, 1, 2 or 3 for inches"
    );
}

/// What is left to the control: q10, messages, their acknowledgement.
#[test]
fn routines_are_asked_for() {
    let mut running = running(&[], &[]);
    for (text, value, routine) in [
        ("q10", "170", Some(Routine::Flash(170))),
        (
            "P8501",
            "2001",
            Some(Routine::Message(1, MessageKind::High, 2001)),
        ),
        (
            "P8503",
            "1320",
            Some(Routine::Message(1, MessageKind::Display, 1320)),
        ),
        ("P8503", "0", None),
        ("P8503", "--", None),
        ("P8504", "2", None),
        ("P8508", "1", Some(Routine::Acknowledge(1))),
        ("P8553", "7000", None),
    ] {
        assert_eq!(
            write(&mut running, Writer::Control, text, value),
            Ok(routine),
            "{text}"
        );
    }
    assert_eq!(
        running.memory().cell(name("P8554")).unwrap().number(),
        Some(15_000.0)
    );
    assert_eq!(
        running.events().to_string(),
        "1 00:00:01,500 K1 message: M2001\n2 00:00:01,500 K1 message: M1320\n"
    );
}

/// A write of a parameter with the sample bit is recorded when P11271 asks for it, transfers likewise, P11279 always
/// [002:330-335] [002:6169-6198].
#[test]
fn writes_are_recorded() {
    let entries = [("P11271", "7")];
    let mut running = running(
        &entries,
        &[("P600", SAMPLED), ("q1137", PLC | SAMPLED), ("P601", PANEL)],
    );
    for (writer, text, value) in [
        (Writer::Program, "P600", "5"),
        (Writer::Control, "q1137", "65822"),
        (Writer::Plc, "P600", "--"),
        (Writer::Program, "P601", "1"),
        (Writer::Editor, "P11279", "12345"),
    ] {
        write(&mut running, writer, text, value).unwrap();
    }
    let time = "00:00:01,500";
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
    let wanted: String = (1..)
        .zip(lines)
        .map(|(number, line)| format!("{number} {time} {line}\n"))
        .collect();
    assert_eq!(running.events().to_string(), wanted);
    write(&mut running, Writer::Plc, "P11271", "0").unwrap();
    write(&mut running, Writer::Program, "P600", "6").unwrap();
    assert_eq!(running.events().count(), 8, "nothing is recorded any more");
}

/// Keys and pictures are parameters of the panel, and recorded [002:6036-6068].
#[test]
fn keys_and_pictures_are_recorded() {
    let mut running = running(&[], &[]);
    // `INIT` and `_A`, the first letter in byte 1.
    let letters = |text: &[u8; 4]| format!("${:X}", u32::from_le_bytes(*text));
    for (text, value) in [
        ("P11260", "$02000114".to_owned()),
        ("P11261", letters(b"INIT")),
        ("P11262", letters(b"_A\0\0")),
        ("P11260", "--".to_owned()),
    ] {
        write(&mut running, Writer::Editor, text, &value).unwrap();
    }
    let lines = "1 00:00:01,500 C-KEY 20\n2 00:00:01,500 PICTURE: INIT_A\n";
    assert_eq!(running.events().to_string(), lines);
}

/// With P11280 = 1 exchanges with the PLC are counted, and the last one is shown [002:6205-6247].
#[test]
fn exchanges_with_the_plc_are_counted() {
    let mut running = running(&[], &[("P5", PLC), ("q1160", PLC), ("q9000", PLC)]);
    let shown = |running: &Running, first: u32| {
        let of = |number| running.memory().cell(Name::P(1, number)).unwrap().number();
        [first, first + 1, first + 2, first + 3].map(of)
    };
    write(&mut running, Writer::Program, "P5", "1.5").unwrap();
    assert_eq!(shown(&running, 11_281), [None; 4], "not before it is asked for");
    write(&mut running, Writer::Program, "P11280", "1").unwrap();
    write(&mut running, Writer::Program, "P5", "1.5").unwrap();
    // Its four bytes: 15, with one decimal.
    assert_eq!(
        shown(&running, 11_281),
        [Some(1.0), Some(1.0), Some(5.0), Some(15.0)]
    );
    write(&mut running, Writer::Program, "q1160", "3").unwrap();
    write(&mut running, Writer::Control, "q9000", "--").unwrap();
    assert_eq!(
        shown(&running, 11_281),
        [Some(2.0), Some(0.0), Some(9000.0), None]
    );
    write(&mut running, Writer::Plc, "P7", "7").unwrap();
    assert_eq!(
        shown(&running, 11_291),
        [Some(1.0), Some(1.0), Some(7.0), Some(7.0)]
    );
}

/// q1 goes to the PLC [002:376-379].
#[test]
fn the_number_of_axes_goes_to_the_plc() {
    let running = running(&[("q1", "2")], &[]);
    let all: Vec<Place> = running
        .all(Receiver::Plc)
        .map(|transfer| transfer.place)
        .collect();
    assert_eq!(all, [Place::Q(1)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whoever takes all that waits has what the memory has, however much was written between.
    #[test]
    fn a_receiver_knows_the_memory(writes in proptest::collection::vec((0u32..50, -9i32..9), 0..200), many in any::<bool>()) {
        let statuses: Vec<(String, u32)> = (0..50).map(|p| (format!("P{p}"), PLC)).collect();
        let statuses: Vec<(&str, u32)> = statuses.iter().map(|(text, word)| (text.as_str(), *word)).collect();
        let mut running = running(&[], &statuses);
        let mut known = std::collections::BTreeMap::new();
        for _ in 0..if many { 20 } else { 1 } {
            for (p, value) in &writes {
                running.write(0, Writer::Program, Name::P(1, *p), value.to_string().parse().unwrap()).unwrap();
            }
        }
        let waiting = writes.len() * if many { 20 } else { 1 };
        let mut count = 0;
        while let Some(news) = running.next(Receiver::Plc) {
            count += 1;
            match news {
                News::All => known.extend(running.all(Receiver::Plc).map(|transfer| (transfer.place, transfer.cell))),
                News::One(transfer) => drop(known.insert(transfer.place, transfer.cell)),
            }
        }
        prop_assert!(count <= 1025 && (waiting > 1024 || count == waiting), "{} of {}", count, waiting);
        let memory: &Memory = running.memory();
        for (p, _) in &writes {
            let place = memory.place(Name::P(1, *p)).unwrap();
            prop_assert_eq!(known.get(&place), Some(&memory.at(place)));
        }
    }
}
