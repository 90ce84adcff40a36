//! Noise: nothing of it panics, grows without bound, or leaves a file.

use std::time::Duration;

use proptest::prelude::*;

use super::*;

/// Bytes that look like telegrams more often than by chance.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let command = prop_oneof![
        Just("A_LGFILE\0"),
        Just("A_LGDNC\0"),
        Just("A_LGPLCDEBUG\0"),
        Just("A_LGFILEPLC\x00807667\0"),
        Just("A_LO"),
        Just("R_FL"),
        Just("C_FL"),
        Just("S_FL"),
        Just("T_FD"),
        Just("T_OK"),
        Just("R_DR"),
        Just("C_DC"),
        Just("C_DM"),
        Just("C_DD"),
        Just("C_FD"),
        Just("C_FR"),
        Just("C_FC"),
        Just("C_FA"),
        Just("R_FI"),
        Just("R_RI\0"),
        Just("R_MB\0"),
        Just("R_DP\0\0\0\0"),
        Just("C_CC\0"),
        Just("C_EK"),
        Just("M_PC"),
        Just("R_MC"),
        Just("C_MC"),
        Just("R_LB"),
    ];
    let tail = prop_oneof![
        "[A-C.\\\\/:\\x00]{0,12}".prop_map(String::into_bytes),
        proptest::collection::vec(any::<u8>(), 0..12),
    ];
    (command, tail).prop_map(|(command, tail)| [command.as_bytes(), &tail].concat())
}

fn only_inside(desk: &Desk) -> Result<(), TestCaseError> {
    let mut names: Vec<_> = std::fs::read_dir(&desk.folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    prop_assert_eq!(names, ["plc", "programs"]);
    prop_assert!(
        !desk.on_medium().iter().any(|name| name.starts_with('.')),
        "half a file"
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any telegrams in any order: each is answered by one telegram at most, and after them the session answers.
    #[test]
    fn any_telegrams(telegrams in proptest::collection::vec(bytes(), 1..60)) {
        let desk = Desk::new("any");
        let mut session = desk.session();
        for bytes in &telegrams {
            if let Some(answer) = Telegram::from_bytes(bytes).and_then(|telegram| session.take(&telegram)) {
                prop_assert!(answer.data.len() <= DATA_MAX);
            }
        }
        let login = session.take(&Telegram::new(Command(*b"A_LG")).string("INSPECT"));
        prop_assert_eq!(login.map(|answer| answer.command), Some(Command::T_OK));
        drop(session);
        only_inside(&desk)?;
    }

    /// Telegrams come out of a stream as they went in, however it is cut.
    #[test]
    fn a_stream_in_any_pieces(telegrams in proptest::collection::vec(bytes(), 1..20), pieces in proptest::collection::vec(1_usize..40, 1..50)) {
        let telegrams: Vec<_> = telegrams.iter().map(|bytes| Telegram::from_bytes(bytes).unwrap()).collect();
        let stream: Vec<u8> = telegrams.iter().flat_map(encode).collect();
        let mut reader = TcpReader::default();
        let mut read = Vec::new();
        let mut rest = stream.as_slice();
        for piece in pieces.iter().cycle() {
            if rest.is_empty() {
                break;
            }
            let (now, later) = rest.split_at(rest.len().min(*piece));
            reader.push(now);
            while let Some(telegram) = reader.telegram().unwrap() {
                read.push(telegram);
            }
            rest = later;
        }
        prop_assert_eq!(read, telegrams);
        prop_assert!(!reader.is_within());
    }

    /// Noise on a serial line, with pauses: after it, and a pause, the line answers.
    #[test]
    fn noise_on_a_line(noise in proptest::collection::vec((prop_oneof![any::<u8>(), Just(0x10), Just(0x02), Just(0x03), Just(0x05), Just(0x04)], 0_u64..2000), 0..300)) {
        let desk = Desk::new("noise");
        let mut control = SerialServer::new(&desk.site);
        let mut now = Duration::ZERO;
        for (byte, pause) in noise {
            now += Duration::from_millis(if pause > 1900 { pause } else { 0 });
            control.tick(now);
            control.byte(byte, now);
        }
        for _ in 0..200 {
            now += Duration::from_secs(1);
            control.tick(now);
            control.take_output();
        }
        prop_assert!(control.is_idle());
        control.byte(0x05, now);
        prop_assert_eq!(control.take_output(), b"\x100");
    }
}

/// Ten million bytes of noise, in telegrams of any length: the reader holds no more than one of them.
#[test]
fn ten_million_bytes() {
    let desk = Desk::new("million");
    let mut seed = 1_u64;
    let mut draw = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as u32
    };
    let mut control = SerialServer::new(&desk.site);
    let mut session = desk.session();
    let mut reader = TcpReader::default();
    let mut telegrams = 0;
    for number in 0..10_000_u64 {
        let bytes: Vec<u8> = (0..1000).map(|_| draw() as u8 & 0x1f).collect();
        for byte in &bytes {
            control.byte(*byte, Duration::from_millis(number));
        }
        control.tick(Duration::from_millis(number));
        control.take_output();
        // Lengths that may be: the stream goes on after each telegram.
        reader.push(&[&[0, 0, 3, 0xe8 - 4], b"S_FL".as_slice(), &bytes[..996]].concat());
        while let Ok(Some(telegram)) = reader.telegram() {
            session.take(&telegram);
            telegrams += 1;
        }
    }
    assert_eq!(telegrams, 10_000);
    assert!(!reader.is_within());
}
