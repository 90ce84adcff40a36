//! The serial line: frames byte for byte, what is lost, and who yields.

use std::time::Duration;

use proptest::prelude::*;

use super::*;
use crate::lsv2::serial::check_byte;

const NOW: Duration = Duration::ZERO;

fn telegram(bytes: &[u8]) -> Telegram {
    Telegram::from_bytes(bytes).unwrap()
}

/// Check bytes of frames that were recorded on a real line (public).
#[test]
fn the_four_check_bytes() {
    for (bytes, check) in [
        (b"T_OK".as_slice(), 0x0c),
        (b"R_VR", 0x0a),
        (b"R_PR", 0x0c),
        (b"A_LGINSPECT\0", 0x40),
    ] {
        assert_eq!(check_byte(bytes), check);
        let framed = [b"\x10\x02", bytes, b"\x10\x03", &[check]].concat();
        assert_eq!(frame(&telegram(bytes)), framed);
    }
    let doubled = frame(&telegram(b"S_FL\x10\x10A"));
    assert_eq!(doubled, b"\x10\x02S_FL\x10\x10\x10\x10A\x10\x03\x44");
    assert_eq!(0x44, b"S_FLA\x03".iter().fold(0, |check, byte| check ^ byte));
}

/// A login as it stands on the line (public): what each side sends, one after the other.
#[test]
fn a_login_byte_for_byte() {
    let desk = Desk::new("line");
    let mut control = SerialServer::new(&desk.site);
    let conversation: [(&[u8], &[u8]); 7] = [
        (b"\x05", b"\x100"),
        // The host asks again, as it does when it has not seen the answer.
        (b"\x05", b"\x100"),
        (b"\x10\x02A_LGINSPECT\0\x10\x03\x40", b"\x101"),
        (b"\x04", b"\x05"),
        (b"\x100", b"\x10\x02T_OK\x10\x03\x0c"),
        (b"\x101", b"\x04"),
        (b"\x05", b"\x100"),
    ];
    for (sent, answered) in conversation {
        sent.iter().for_each(|byte| control.byte(*byte, NOW));
        assert_eq!(control.take_output(), answered, "to {}", sent.escape_ascii());
    }
}

#[test]
fn a_damaged_telegram_is_sent_again() {
    let mut control = SerialLine::new(Side::Control);
    let sent = |line: &mut SerialLine, bytes: &[u8]| {
        bytes.iter().for_each(|byte| line.byte(*byte, NOW));
        line.take_output()
    };
    assert_eq!(sent(&mut control, b"\x05"), b"\x100");
    assert_eq!(
        sent(&mut control, b"\x10\x02R_XR\x10\x03\x0a"),
        b"\x15",
        "a bit has flipped"
    );
    assert_eq!(
        sent(&mut control, b"\x10\x02R_\x10\x16VR\x10\x03\x0a"),
        b"\x15",
        "a DLE is single"
    );
    assert_eq!(sent(&mut control, b"\x10\x02R_VR\x10\x03\x0a"), b"\x101");
    assert_eq!(control.event(), None, "it is taken with EOT");
    assert_eq!(sent(&mut control, b"\x04"), b"");
    assert_eq!(control.event(), Some(LineEvent::Received(telegram(b"R_VR"))));
    assert!(control.is_idle());
}

#[test]
fn three_refusals_and_silence_are_reported() {
    let mut host = SerialLine::new(Side::Host);
    assert!(host.send(&telegram(b"R_VR"), NOW));
    assert!(!host.send(&telegram(b"R_PR"), NOW), "one after the other");
    assert_eq!(host.take_output(), b"\x05");
    b"\x100".iter().for_each(|byte| host.byte(*byte, NOW));
    for place in 1..=3 {
        assert_eq!(host.take_output(), frame(&telegram(b"R_VR")), "{place}");
        assert_eq!(host.event(), None);
        host.byte(0x15, NOW);
    }
    assert_eq!(host.event(), Some(LineEvent::Failed(LineFault::Refused)));
    assert_eq!(host.take_output(), b"\x04");
    // Nobody answers ENQ: asked three times, 3 s each.
    host.send(&telegram(b"R_VR"), NOW);
    for second in [2, 3, 5, 6, 8] {
        host.tick(Duration::from_secs(second));
        assert_eq!(host.event(), None, "{second}");
    }
    assert_eq!(host.take_output(), b"\x05\x05\x05");
    host.tick(Duration::from_secs(9));
    assert_eq!(host.event(), Some(LineEvent::Failed(LineFault::NoAnswer)));
}

#[test]
fn what_stops_in_the_middle_is_refused_in_time() {
    let mut control = SerialLine::new(Side::Control);
    b"\x05\x10\x02R_V"
        .iter()
        .for_each(|byte| control.byte(*byte, NOW));
    control.take_output();
    control.tick(ANSWER - Duration::from_millis(1));
    assert_eq!(control.take_output(), b"");
    control.tick(ANSWER);
    assert_eq!(control.take_output(), b"\x15");
    control.tick(ANSWER * 2);
    assert!(control.is_idle() && control.event().is_none());
    // A telegram whose EOT was lost was confirmed, and counts.
    b"\x05\x10\x02R_VR\x10\x03\x0a"
        .iter()
        .for_each(|byte| control.byte(*byte, NOW));
    control.tick(NEXT);
    assert_eq!(control.event(), Some(LineEvent::Received(telegram(b"R_VR"))));
}

#[test]
fn the_control_yields_when_both_begin() {
    let (mut host, mut control) = (SerialLine::new(Side::Host), SerialLine::new(Side::Control));
    host.send(&telegram(b"R_VR"), NOW);
    control.send(&telegram(b"M_PC\0\0\0\x01"), NOW);
    let mut events = [Vec::new(), Vec::new()];
    for _ in 0..12 {
        for byte in host.take_output() {
            control.byte(byte, NOW);
        }
        for byte in control.take_output() {
            host.byte(byte, NOW);
        }
        events[0].extend(host.event());
        events[1].extend(control.event());
    }
    let message = LineEvent::Received(telegram(b"M_PC\0\0\0\x01"));
    assert_eq!(events[0], [LineEvent::Sent, message]);
    assert_eq!(
        events[1],
        [LineEvent::Received(telegram(b"R_VR")), LineEvent::Sent]
    );
}

/// Two ends and a line that loses, doubles and flips bytes; what is wrong is drawn from a seed.
struct Faulty {
    seed: u64,
    /// One byte of so many is damaged.
    of: u64,
}

impl Faulty {
    fn draw(&mut self, most: u64) -> u64 {
        self.seed = self
            .seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.seed >> 33) % most
    }

    fn carry(&mut self, bytes: Vec<u8>) -> Vec<u8> {
        let mut arrived = Vec::new();
        for byte in bytes {
            match self.draw(self.of * 3) {
                0 => {}
                1 => arrived.extend([byte, byte]),
                2 => arrived.push(byte ^ 1 << self.draw(8)),
                _ => arrived.push(byte),
            }
        }
        arrived
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Requests over a line with faults. What is answered is answered right: no telegram arrives that was not sent, unless two
    /// faults hide each other from the check byte, which a single one in a telegram cannot; without faults all are answered.
    #[test]
    fn telegrams_over_a_line_with_faults(seed: u64, of in prop_oneof![Just(u64::MAX / 3), 200_u64..5000]) {
        let (mut host, mut control) = (SerialLine::new(Side::Host), SerialLine::new(Side::Control));
        let mut line = Faulty { seed, of };
        let mut now = NOW;
        let (mut answered, mut failed) = (0, 0);
        for number in 0..40_u32 {
            let request = Telegram::new(Command(*b"R_NR")).long(number).raw(&[0x10, 0x10, 0x03]);
            prop_assert!(host.send(&request, now));
            let mut open = true;
            for _ in 0..400 {
                if !open {
                    break;
                }
                now += Duration::from_millis(100);
                host.tick(now);
                control.tick(now);
                for byte in line.carry(host.take_output()) {
                    control.byte(byte, now);
                }
                while let Some(event) = control.event() {
                    if let LineEvent::Received(telegram) = event
                        && telegram.command == Command(*b"R_NR")
                    {
                        control.send(&Telegram::with(telegram.command.answer(), telegram.data), now);
                    }
                }
                for byte in line.carry(control.take_output()) {
                    host.byte(byte, now);
                }
                while let Some(event) = host.event() {
                    match event {
                        LineEvent::Received(answer) if answer.data == request.data => {
                            answered += 1;
                            open = false;
                        }
                        LineEvent::Failed(_) => open = false,
                        _ => {}
                    }
                }
            }
            failed += u32::from(open);
            // What is left of this exchange ends before the next one begins.
            for _ in 0..200 {
                now += Duration::from_millis(100);
                host.tick(now);
                control.tick(now);
                for byte in host.take_output() {
                    control.byte(byte, now);
                }
                for byte in control.take_output() {
                    host.byte(byte, now);
                }
                while host.event().is_some() || control.event().is_some() {}
            }
            prop_assert!(host.is_idle() && control.is_idle(), "stuck");
        }
        if of > 5000 {
            prop_assert_eq!((answered, failed), (40, 0));
        }
    }
}
