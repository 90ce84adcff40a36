//! System and channel parameters: where they lie, what they hold.

use bahn_system900::{Memory, Name, Place, SpaceError, Status, Value, ValueError};

/// A memory with some parameters entered.
pub fn memory(entries: &[(&str, &str)]) -> Memory {
    let mut memory = Memory::new();
    for (name, value) in entries {
        enter(&mut memory, name, value).unwrap();
    }
    memory
}

pub fn name(text: &str) -> Name {
    text.parse().unwrap()
}

fn enter(memory: &mut Memory, text: &str, value: &str) -> Result<(), SpaceError> {
    let value: Value = value
        .parse()
        .map_err(|error| SpaceError::Value(name(text), error))?;
    memory.enter(name(text), value).map(|_| ())
}

fn q(memory: &Memory, text: &str) -> Option<u32> {
    memory.q(name(text)).ok()
}

fn number(memory: &Memory, text: &str) -> Option<f64> {
    memory.cell(name(text)).unwrap().number()
}

/// One channel: user block 1 from q10000 with 5000 parameters, the fixed ones after it, user block 2 from q18000
/// [002:114-158]; q102, q103, q104, q105.
#[test]
fn one_channel() {
    let memory = memory(&[
        ("q102", "10000"),
        ("q103", "5000"),
        ("q104", "18000"),
        ("q105", "2000"),
    ]);
    for (name, at) in [
        ("P0", 10_000),
        ("P4999", 14_999),
        ("P7000", 15_000),
        ("P9999", 17_999),
        ("P11271", 1271),
        ("P11300", 1300),
        ("P20000", 18_000),
        ("1:P21999", 19_999),
        ("q18000", 18_000),
    ] {
        assert_eq!(q(&memory, name), Some(at), "{name}");
    }
    for text in [
        "P5000", "P6999", "P10000", "P10999", "P18400", "P19999", "P22000", "P30000", "P40000", "q30000",
        "P12000", "2:P7000", "9:P7000", "0:P7000",
    ] {
        assert_eq!(q(&memory, text), None, "{text}");
    }
    let said = |text: &str| memory.q(name(text)).unwrap_err().to_string();
    assert_eq!(said("P5000"), "P5000: its block has 5000 parameters, q103");
    assert_eq!(
        said("P30000"),
        "P30000: q106 and q107 of the channel do not say where it lies"
    );
    assert_eq!(
        said("P18400"),
        "P18400 is no parameter: its number is assigned to nothing"
    );
    assert_eq!(said("q30000"), "q30000 is no parameter: the last one is q29999");
    assert_eq!(said("2:P7000"), "2:P7000: there is no channel 2, q2 is 1");
    assert_eq!(
        said("P12200"),
        "P12200: logical axis 2 of channel 1 is no physical axis, q111"
    );
}

/// The third block may lie where it likes [002:709-715]: q106, q107.
#[test]
fn the_third_block() {
    let memory = memory(&[("q106", "19000"), ("q107", "50")]);
    assert_eq!(q(&memory, "P30000"), Some(19_000));
    assert_eq!(q(&memory, "P30049"), Some(19_049));
    assert_eq!(q(&memory, "P30050"), None);
}

/// Two channels: q202 = 20000, q203 = 2000, q204 = 25000 make P7000 of channel 2 q22000, and its P20000 q25000
/// [002:164-210].
#[test]
fn the_same_number_is_another_parameter_in_another_channel() {
    let mut memory = memory(&[
        ("q2", "2"),
        ("q102", "10000"),
        ("q103", "5000"),
        ("q202", "20000"),
        ("q203", "2000"),
        ("q204", "25000"),
        ("q205", "100"),
    ]);
    assert_eq!(q(&memory, "2:P7000"), Some(22_000));
    assert_eq!(q(&memory, "K2:P20000"), Some(25_000));
    assert_eq!(q(&memory, "P7000"), Some(15_000));
    assert_eq!(q(&memory, "2:P11000"), q(&memory, "P11000"), "shared by all");
    assert_eq!(q(&memory, "3:P7000"), None, "q2 is 2");
    // A new descriptor moves the block at once.
    enter(&mut memory, "q202", "21000").unwrap();
    assert_eq!(q(&memory, "2:P7000"), Some(23_000));
    // An end beyond the array is none.
    enter(&mut memory, "q204", "29990").unwrap();
    assert_eq!(q(&memory, "2:P20009"), Some(29_999));
    assert_eq!(q(&memory, "2:P20010"), None);
}

/// q2 channels: without it one, whatever the descriptors say.
#[test]
fn how_many_channels_there_are() {
    let mut memory = memory(&[("q202", "20000"), ("q203", "2000")]);
    assert_eq!((memory.channels(), q(&memory, "2:P7000")), (1, None));
    enter(&mut memory, "q2", "8").unwrap();
    assert_eq!((memory.channels(), q(&memory, "2:P7000")), (8, Some(22_000)));
    assert!(q(&memory, "3:P7000").is_none() && q(&memory, "9:P7000").is_none());
}

/// The axis word of a logical axis (q110 is the first) names the physical one in byte 3: of `$421F0359` it is number 31,
/// of whose block of 200 parameters P12000 + 200 (log - 1) is the first [002:68-111] [002:718-825].
#[test]
fn axis_parameters_are_those_of_the_physical_axis() {
    let memory = memory(&[
        ("q110", "$00010058"),
        ("q111", "$421F0359"),
        ("q112", "$00000000"),
    ]);
    assert_eq!(q(&memory, "P12000"), Some(2000));
    assert_eq!(q(&memory, "P12150"), Some(2150));
    assert_eq!(q(&memory, "P12200"), Some(2000 + 200 * 30));
    assert_eq!(q(&memory, "P12400"), None, "no physical axis");
    assert_eq!(q(&memory, "P12600"), None, "no axis word");
}

/// P12153 to P12157 exist once for each channel, also where two channels have the same axis; their status at start is that of
/// q2153 to q2157 [002:8350-8360].
#[test]
fn positions_of_a_channel_have_no_q_number() {
    let mut memory = memory(&[("q2", "2"), ("q110", "$00010058"), ("q210", "$00010058")]);
    for number in 12_153..=12_157 {
        let place = memory.place(Name::P(1, number));
        assert_eq!(place, Ok(Place::OfChannel(1, 1, number - 12_000)), "P{number}");
        let error = memory.q(Name::P(1, number)).unwrap_err().to_string();
        assert_eq!(error, format!("P{number} exists per channel and has no q number"));
    }
    assert_eq!(
        (q(&memory, "P12152"), q(&memory, "P12158")),
        (Some(2152), Some(2158))
    );
    enter(&mut memory, "P12153", "1.5").unwrap();
    enter(&mut memory, "2:P12153", "-2").unwrap();
    enter(&mut memory, "q2153", "7").unwrap();
    assert_eq!(
        ["P12153", "2:P12153", "q2153"].map(|name| number(&memory, name)),
        [Some(1.5), Some(-2.0), Some(7.0)]
    );
    memory
        .set_status(name("q2154"), Status::from_word(0x0300_0010))
        .unwrap();
    memory.start();
    let status = memory.cell(name("2:P12154")).unwrap().status();
    assert_eq!(status.to_string(), "$03000010");
}

/// The example of the manual: P1000 with the status $30020401 is loaded, sent to the operating panel, closed by lock 2,
/// hexadecimal and stored [002:253-259].
#[test]
fn the_status_of_the_example() {
    let status: Status = "$30020401".parse().unwrap();
    assert!(status.is_loaded() && status.is_hexadecimal() && status.is_stored());
    let receivers = status.receivers();
    assert!(receivers.panel && !receivers.panel_always && !receivers.plc && !receivers.interpolator);
    assert!(!status.is_real_time() && !status.synchronises() && !status.is_length() && !status.is_fast());
    assert_eq!(
        (status.decimals(), status.locks().collect::<Vec<_>>()),
        (0, vec![2])
    );
    assert_eq!(status.to_string(), "$30020401");
    for bits in [
        (0x04u32, Status::is_real_time as fn(Status) -> bool),
        (0x08, Status::synchronises),
        (0x10, Status::is_length),
        (0x80, Status::is_fast),
    ] {
        assert!(bits.1(Status::from_word(bits.0)));
    }
    for wrong in ["30020401", "$3002041", "$300204011", "$3002040G", "", "$"] {
        assert!(wrong.parse::<Status>().is_err(), "{wrong}");
    }
}

/// More decimals than the status has raise them, with fewer it stays; nothing is lost.
#[test]
fn values_keep_their_decimals() {
    let mut memory = memory(&[("q102", "10000"), ("q103", "5000")]);
    let p1000 = name("P1000");
    let shown = |memory: &Memory| memory.cell(p1000).unwrap().written();
    memory.set_status(p1000, Status::from_word(0x0300_0000)).unwrap();
    enter(&mut memory, "P1000", "12.5").unwrap();
    assert_eq!(shown(&memory), "12.500");
    enter(&mut memory, "P1000", "-0.12345").unwrap();
    assert_eq!(shown(&memory), "-0.12345");
    enter(&mut memory, "P1000", "7.000000000").unwrap();
    assert_eq!(shown(&memory), "7.00000", "zeros at the end are nothing to lose");
    enter(&mut memory, "P1000", "0.000000001").unwrap();
    assert_eq!(shown(&memory), "0.000000001");
    assert_eq!(number(&memory, "P1000"), Some(1e-9));
    // 2147483647 is 2^31 - 1; with nine decimals little else goes in.
    let refused = |memory: &mut Memory, value: &str| match enter(memory, "P1000", value) {
        Err(SpaceError::Value(_, error)) => error,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(&mut memory, "3"), ValueError::TooGreat("3".to_owned()));
    let fine = ValueError::TooFine("0.0000000001".to_owned());
    assert_eq!(refused(&mut memory, "0.0000000001"), fine);
    enter(&mut memory, "P1000", "2.147483647").unwrap();
    assert_eq!(
        shown(&memory),
        "2.147483647",
        "what was refused has changed nothing"
    );
    memory.set_status(p1000, Status::default()).unwrap();
    for (value, written) in [
        ("-2147483648", "-2147483648"),
        ("+5", "5"),
        ("5.", "5"),
        (".5", "0.5"),
        ("--", "--"),
    ] {
        enter(&mut memory, "P1000", value).unwrap();
        assert_eq!(shown(&memory), written);
    }
    assert_eq!(number(&memory, "P1000"), None, "cleared is not 0");
    memory.set_status(p1000, Status::default()).unwrap();
    for great in [
        "2147483648",
        "-2147483649",
        "$100000000",
        "99999999999999999999999",
    ] {
        let error = refused(&mut memory, great);
        assert!(matches!(error, ValueError::TooGreat(_)), "{great}: {error}");
    }
    for wrong in [
        "", "1e3", "$", "$-1", "nan", "inf", "0x10", "1 2", "-", ".", "1.2.3", "--5", "1,5",
    ] {
        let error = refused(&mut memory, wrong);
        assert!(matches!(error, ValueError::NotANumber(_)), "{wrong}: {error}");
    }
}

/// Hexadecimal digits are the bits, whatever sign they are.
#[test]
fn hexadecimal_values_are_bits() {
    let mut memory = memory(&[("q1000", "$FFFFFFFF")]);
    assert_eq!(number(&memory, "q1000"), Some(-1.0));
    memory
        .set_status(Name::Q(1000), Status::from_word(0x1000_0000))
        .unwrap();
    assert_eq!(memory.cell(Name::Q(1000)).unwrap().written(), "$FFFFFFFF");
    enter(&mut memory, "q1000", "$1f").unwrap();
    assert_eq!(memory.cell(Name::Q(1000)).unwrap().written(), "$1F");
    assert_eq!(number(&memory, "q1000"), Some(31.0));
}

/// A lock holds entries back, not the PLC, nor who sets the status [002:358-362].
#[test]
fn locks() {
    let mut memory = memory(&[]);
    let q = Name::Q(2000);
    memory.set_status(q, Status::from_word(0x0002_0200)).unwrap();
    memory.set_lock(2, true);
    assert_eq!(enter(&mut memory, "q2000", "5"), Err(SpaceError::Locked(q, 2)));
    let receivers = memory.write(q, "7".parse().unwrap()).unwrap();
    assert!(receivers.plc, "status byte 2 bit 1");
    assert_eq!(number(&memory, "q2000"), Some(7.0));
    memory.set_lock(2, false);
    assert_eq!(enter(&mut memory, "q2000", "5"), Ok(()));
}

/// A number in P8553 is answered in P8554 [002:3453-3457].
#[test]
fn the_control_says_where_a_parameter_lies() {
    let mut memory = memory(&[("q102", "10000"), ("q103", "5000"), ("P8553", "7000")]);
    assert_eq!(number(&memory, "P8554"), Some(15_000.0));
    enter(&mut memory, "P8553", "10500").unwrap();
    assert_eq!(number(&memory, "P8554"), None);
}

#[test]
fn names() {
    for (text, name) in [
        ("q102", Name::Q(102)),
        ("Q 1 02", Name::Q(102)),
        ("p7000", Name::P(1, 7000)),
        (" 2 : P 7000 ", Name::P(2, 7000)),
        ("k2:p7000", Name::P(2, 7000)),
        ("q0", Name::Q(0)),
    ] {
        assert_eq!(text.parse(), Ok(name), "{text}");
    }
    for wrong in [
        "",
        "q",
        "P",
        "102",
        "2:q102",
        "q-1",
        "q1.0",
        "x:P1",
        "2P1",
        "q99999999999",
        ":P1",
        "KP1",
        "K:P1",
        "qq1",
        "300:P1",
        "P1P",
    ] {
        assert!(wrong.parse::<Name>().is_err(), "{wrong}");
    }
    let shown = [Name::Q(102), Name::P(1, 7000), Name::P(2, 7000)].map(|name| name.to_string());
    assert_eq!(shown, ["q102", "P7000", "2:P7000"]);
}

/// A place has the name of a channel parameter where there is one.
#[test]
fn places_have_names() {
    let memory = memory(&[
        ("q2", "2"),
        ("q102", "10000"),
        ("q103", "5000"),
        ("q202", "20000"),
        ("q203", "2000"),
        ("q110", "$01010058"),
        ("q210", "$01020058"),
    ]);
    for (q, name) in [
        (102, "q102"),
        (1300, "P11300"),
        (2160, "P12160"),
        (2360, "2:P12160"),
        (2153, "q2153"),
        (2560, "q2560"),
        (9000, "q9000"),
        (10_000, "P0"),
        (15_000, "P7000"),
        (22_000, "2:P7000"),
        (26_000, "q26000"),
    ] {
        assert_eq!(memory.name_of(Place::Q(q)).to_string(), name);
    }
    let own = memory.name_of(Place::OfChannel(2, 1, 153));
    assert_eq!(own.to_string(), "2:P12153");
}
