//! System and channel parameters of a System 900.
#![allow(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use bahn_parameters::space::{
    Content, PARAMETERS_MIN, ParameterSpace, QError, QName, QParameters, QStatus, differences,
};

/// 30000 parameters with some of them entered.
fn space(entries: &[(&str, &str)]) -> QParameters {
    let mut space = QParameters::new(PARAMETERS_MIN).unwrap();
    for (name, value) in entries {
        enter(&mut space, name, value).unwrap();
    }
    space
}

fn enter(space: &mut QParameters, name: &str, value: &str) -> Result<(), QError> {
    let name = space.name(name)?;
    space.enter(name, value)
}

fn place(space: &QParameters, name: &str) -> Result<usize, QError> {
    space.place(space.name(name)?)
}

/// One channel: user block 1 from q10000 with 5000 parameters, the fixed ones behind it, user block 2 from q18000
/// [002:114-158].
#[test]
fn one_channel() {
    let space = space(&[
        ("q102", "10000"),
        ("q103", "5000"),
        ("q104", "18000"),
        ("q105", "2000"),
    ]);
    for (name, q) in [
        ("P0", 10_000),
        ("P4999", 14_999),
        ("P7000", 15_000),
        ("P9999", 17_999),
        ("P11271", 1271),
        ("P20000", 18_000),
        ("1:P21999", 19_999),
    ] {
        assert_eq!(place(&space, name), Ok(q), "{name}");
    }
    for name in [
        "P5000", "P6999", "P10000", "P10999", "P18400", "P19999", "P22000", "P30000", "P40000",
    ] {
        assert!(matches!(place(&space, name), Err(QError::Unknown(_))), "{name}");
    }
}

/// Two channels: q202 = 20000, q203 = 2000, q204 = 25000 make P7000 of channel 2 q22000, and its P20000 q25000
/// [002:164-210].
#[test]
fn the_same_number_is_another_parameter_in_another_channel() {
    let mut space = space(&[
        ("q102", "10000"),
        ("q103", "5000"),
        ("q202", "20000"),
        ("q203", "2000"),
        ("q204", "25000"),
        ("q205", "100"),
    ]);
    assert_eq!(place(&space, "2:P7000"), Ok(22_000));
    assert_eq!(place(&space, "K2:P20000"), Ok(25_000));
    assert_eq!(place(&space, "1:P7000"), Ok(15_000));
    assert_eq!(
        place(&space, "2:P11000"),
        place(&space, "1:P11000"),
        "shared by all"
    );
    assert!(place(&space, "3:P7000").is_err(), "no descriptor");
    assert!(place(&space, "9:P7000").is_err() && place(&space, "0:P7000").is_err());
    // A new descriptor moves the window at once.
    enter(&mut space, "q202", "21000").unwrap();
    assert_eq!(place(&space, "2:P7000"), Ok(23_000));
    // An end beyond the array is none.
    enter(&mut space, "q204", "29990").unwrap();
    assert_eq!(place(&space, "2:P20009"), Ok(29_999));
    assert!(place(&space, "2:P20010").is_err());
}

/// The axis word of a logical axis names the physical one in byte 3: `$421F0359` is an axis of number 31, of whose
/// block of 200 parameters P12000 + 200 (log - 1) is the first [002:68-111] [002:718-825].
#[test]
fn axis_parameters_are_those_of_the_physical_axis() {
    let space = space(&[
        ("q110", "$00010058"),
        ("q111", "$001F0359"),
        ("q112", "$00000000"),
    ]);
    assert_eq!(place(&space, "P12000"), Ok(2000));
    assert_eq!(place(&space, "P12153"), Ok(2153));
    assert_eq!(place(&space, "P12200"), Ok(2000 + 200 * 30));
    assert!(place(&space, "P12400").is_err(), "no physical axis");
    assert!(place(&space, "P12600").is_err(), "no axis word");
}

/// `P1000 $30020401`: loaded, sent to the panel, locked by lock 2, hexadecimal and stored [002:253-259]. The manual
/// prints `$300204 01`, byte 4 first: byte 2 is `04`, byte 3 is `02`.
#[test]
fn status_bytes() {
    let status = QStatus::from_word(0x3002_0401);
    assert!(status.is_loaded() && status.is_hexadecimal() && status.is_stored());
    assert!(!status.is_real_time() && !status.synchronises() && !status.is_length());
    let receivers = status.receivers();
    assert!(receivers.panel && !receivers.plc && !receivers.interpolator && !receivers.procedure);
    assert_eq!(status.lock([false, true, false, false]), Some(2));
    assert_eq!(status.lock([true, false, true, true]), None);
    assert_eq!(status.decimals(), 0);
}

#[test]
fn entry_as_the_status_says() {
    let mut space = space(&[("q102", "10000"), ("q103", "5000")]);
    let p1000 = space.name("P1000").unwrap();
    assert_eq!(space.written(p1000).unwrap(), "--");
    assert_eq!(space.content(p1000), Ok(Content::Cleared));
    // Three decimals: 12.5 is kept as 12500.
    space.set_status(p1000, QStatus::from_word(0x0300_0000)).unwrap();
    space.enter(p1000, "12.5").unwrap();
    assert_eq!(space.content(p1000), Ok(Content::Number(12.5)));
    assert_eq!(space.written(p1000).unwrap(), "12.500");
    assert!(space.status(p1000).unwrap().is_loaded());
    // The same bits as hexadecimal number: 12500 = $30D4.
    space.set_status(p1000, QStatus::from_word(0x3000_0000)).unwrap();
    assert_eq!(space.written(p1000).unwrap(), "$30D4");
    // All 32 bits.
    space.enter(p1000, "$FFFFFFFF").unwrap();
    assert_eq!(space.content(p1000), Ok(Content::Number(-1.0)));
    assert_eq!(space.written(p1000).unwrap(), "$FFFFFFFF");
    space.enter(p1000, "--").unwrap();
    assert_eq!(space.content(p1000), Ok(Content::Cleared));
    for wrong in ["", "1e3", "$", "$-1", "nan", "inf", "0x10", "1 2"] {
        assert!(
            matches!(space.enter(p1000, wrong), Err(QError::NotANumber(..))),
            "{wrong}"
        );
    }
    for great in ["2147483648", "-2147483649", "$100000000"] {
        assert!(
            matches!(space.enter(p1000, great), Err(QError::TooGreat(..))),
            "{great}"
        );
    }
    space.enter(p1000, "-2147483648").unwrap();
}

/// A lock holds entries back, not the PLC, nor who sets the status [002:358-362].
#[test]
fn locks() {
    let mut space = space(&[]);
    let q = QName::Q(2000);
    space.set_status(q, QStatus::from_word(0x0002_0200)).unwrap();
    space.set_lock(2, true);
    assert_eq!(space.enter(q, "5"), Err(QError::Locked(q, 2)));
    assert!(space.write(q, Some(7)).unwrap().plc, "status byte 2 bit 1");
    assert_eq!(space.content(q), Ok(Content::Number(7.0)));
    space.set_lock(2, false);
    assert_eq!(space.enter(q, "5"), Ok(()));
}

#[test]
fn names() {
    let space = space(&[]);
    assert_eq!(QParameters::new(29_999), None);
    assert_eq!(QParameters::new(50_001), None);
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
    ] {
        assert!(matches!(space.name(wrong), Err(QError::NoName(_))), "{wrong}");
    }
    assert!(matches!(space.name("q30000"), Err(QError::Unknown(_))));
    assert_eq!(space.name("q29999"), Ok(QName::Q(29_999)));
    assert_eq!(space.names().count(), PARAMETERS_MIN);
    let mut other = space.clone();
    enter(&mut other, "q12", "0").unwrap();
    assert_eq!(differences(&space, &other), [QName::Q(12)], "cleared is not 0");
}
