//! Control and device of Bahn against each other over a bad line, and over noise: nothing is lost, nothing is doubled, every
//! transfer that is broken off is known to be.
#![allow(clippy::unwrap_used, reason = "what fails here fails the test")]

mod support;

use std::collections::VecDeque;
use std::time::Duration;

use bahn_link::blockwise::{self, DirectoryRequest, Rights, Want};
use bahn_link::{Ended, Event, Faults, FileType, Memory, Mode, Protocol, Settings, standard};
use bahn_parameters::ControlModel;
use proptest::prelude::*;
use support::{ext, settings};

/// Time of a character.
const CHARACTER: Duration = Duration::from_micros(260);
/// How long a character is in transit.
const DELAY: Duration = Duration::from_micros(100);

/// One direction of the line.
struct Direction {
    faults: Faults,
    free: Duration,
    in_transit: VecDeque<(Duration, u8)>,
}

impl Direction {
    fn new(seed: u64, direction: u64, one_in: u64) -> Direction {
        Direction {
            faults: Faults::with_rate(seed, direction, one_in),
            free: Duration::ZERO,
            in_transit: VecDeque::new(),
        }
    }

    /// One character goes, when the line is free; and what has arrived is heard.
    fn pass(&mut self, from: &mut dyn Protocol, to: &mut dyn Protocol, now: Duration) {
        if from.has_output() && now >= self.free && now >= self.faults.ready() {
            let (mut sent, mut passed) = (Vec::new(), Vec::new());
            from.send(1, now, &mut sent);
            sent.iter()
                .for_each(|byte| self.faults.pass(*byte, now, &mut passed));
            self.free = now + CHARACTER;
            self.in_transit
                .extend(passed.iter().map(|byte| (now + CHARACTER + DELAY, *byte & 0x7F)));
        }
        while let Some((time, byte)) = self.in_transit.front().copied()
            && time <= now
        {
            self.in_transit.pop_front();
            to.receive(byte, now);
        }
    }

    /// When it does something next.
    fn next(&self, from: &dyn Protocol) -> Option<Duration> {
        let goes = from.has_output().then(|| self.free.max(self.faults.ready()));
        let arrives = self.in_transit.front().map(|(time, _)| *time);
        goes.into_iter().chain(arrives).min()
    }
}

/// What the two sides of a transfer say of it.
struct Outcome {
    control: Option<bool>,
    device: Option<bool>,
    time: Duration,
}

/// How a transfer has ended, on one side: all of it must be complete.
fn follow(protocol: &mut dyn Protocol, end: &mut Option<bool>) {
    while let Some(event) = protocol.event() {
        if let Event::Ended(ended) = event {
            *end = Some(end.unwrap_or(true) && ended == Ended::Complete);
        }
    }
}

/// One transfer until both sides are done with it.
fn transfer(control: &mut dyn Protocol, device: &mut dyn Protocol, seed: u64, one_in: u64) -> Outcome {
    let mut lines = [0, 1].map(|direction| Direction::new(seed, direction, one_in));
    let mut now = Duration::from_secs(1);
    let mut outcome = Outcome {
        control: None,
        device: None,
        time: Duration::ZERO,
    };
    for _ in 0..50_000_000_u64 {
        let [out, back] = &mut lines;
        out.pass(control, device, now);
        back.pass(device, control, now);
        control.clock(now);
        device.clock(now);
        follow(control, &mut outcome.control);
        follow(device, &mut outcome.device);
        let [out, back] = &lines;
        let next = [
            out.next(control),
            back.next(device),
            control.deadline(),
            device.deadline(),
        ];
        let Some(next) = next.into_iter().flatten().min() else {
            break;
        };
        now = next.max(now + Duration::from_nanos(1));
    }
    outcome.time = now - Duration::from_secs(1);
    outcome
}

fn program(number: u64, lines: u64) -> String {
    let blocks: String = (1..=lines)
        .map(|line| {
            format!(
                "{line} L X{:+} Y{:+} F{}\n",
                line * 7919 % 1000,
                number % 997,
                100 + line % 900
            )
        })
        .collect();
    format!("0 BEGIN PGM 1 MM\n{blocks}{} END PGM 1 MM\n", lines + 1)
}

#[derive(Debug, Default)]
struct Tally {
    blocks: u64,
    transfers: u64,
    broken_off: u64,
    /// Sent well, but the sender has lost the last answer.
    doubted: u64,
}

/// So many blocks over a line with faults, in both directions.
fn campaign(blocks: u64, one_in: u64) -> Tally {
    let settings = settings(Mode::Fe2);
    let mut tally = Tally::default();
    while tally.blocks < blocks {
        let number = tally.transfers;
        let text = program(number, 20 + number % 200);
        let count = text.lines().count() as u64;
        let (there, stored) = (Memory::default(), Memory::default());
        there.put("1.H", &text);
        let reads = number.is_multiple_of(2);
        let (mut control, at_device): (Box<dyn Protocol>, &Memory) = if reads {
            let want = Want::Selected("1.H".into());
            let kind = FileType::of_code('H').unwrap();
            (
                Box::new(blockwise::Reading::new(
                    settings,
                    Box::new(stored.clone()),
                    want,
                    kind,
                )),
                &there,
            )
        } else {
            let names = vec!["1.H".to_owned()];
            (
                Box::new(blockwise::Writing::new(
                    settings,
                    Box::new(there.clone()),
                    names,
                    false,
                )),
                &stored,
            )
        };
        let mut device = blockwise::Peripheral::new(settings, Box::new(at_device.clone()), Rights::ALL);
        let outcome = transfer(control.as_mut(), &mut device, number, one_in);
        let has = stored.get("1.H");
        // What is stored is whole, block for block.
        if let Some(has) = &has {
            let wrong = has.lines().zip(text.lines()).find(|(has, sent)| has != sent);
            assert_eq!(wrong, None, "transfer {number} is not what was sent");
            assert_eq!(has.lines().count(), text.lines().count(), "transfer {number}");
        }
        let (receiver, sender) = match reads {
            true => (outcome.control, outcome.device),
            false => (outcome.device, outcome.control),
        };
        assert!(outcome.control.is_some(), "transfer {number} never ends");
        match (sender, receiver) {
            (Some(true), receiver) => {
                assert!(
                    has.is_some(),
                    "transfer {number}: the sender thinks that it is there, the receiver {receiver:?}"
                );
                tally.blocks += count;
            }
            (Some(false) | None, Some(true)) => {
                // Only the answer to the last block, or what stands after it, may be what was lost.
                assert!(has.is_some(), "transfer {number}");
                tally.doubted += 1;
            }
            (sender, receiver) => {
                let both = (sender, receiver);
                assert_eq!(
                    both,
                    (Some(false), Some(false)),
                    "transfer {number}: not said on both sides"
                );
                assert!(has.is_none(), "transfer {number}: broken off, and stored");
                tally.broken_off += 1;
            }
        }
        tally.transfers += 1;
    }
    tally
}

#[test]
fn a_million_blocks_over_a_line_with_faults() {
    let tally = campaign(1_000_000, 1000);
    println!("{tally:?}");
    // The line is so bad that some transfers end, and so good that most do not.
    assert!(
        tally.broken_off > 10 && tally.broken_off * 10 < tally.transfers,
        "{tally:?}"
    );
    assert!(tally.doubted * 20 < tally.transfers, "{tally:?}");
}

/// FE fills its line: in one direction it carries 95 % of what the baud rate allows, frames included.
#[test]
fn a_good_line_is_full() {
    let settings = settings(Mode::Fe2).on(Some(38_400), Duration::from_secs(3));
    let text = program(3, 3000);
    let there = Memory::default();
    there.put("1.H", &text);
    let stored = Memory::default();
    let mut control = blockwise::Writing::new(settings, Box::new(there), vec!["1.H".into()], false);
    let mut device = blockwise::Peripheral::new(settings, Box::new(stored.clone()), Rights::ALL);
    let outcome = transfer(&mut control, &mut device, 0, u64::MAX / 8);
    assert_eq!((outcome.control, outcome.device), (Some(true), Some(true)));
    assert_eq!(stored.get("1.H").unwrap(), text);
    // STX, ETB, BCC and DC1 of each block; the answer comes while DC1 goes.
    let characters: usize = text.lines().map(|line| line.len() + 4).sum();
    let part = (CHARACTER * characters as u32).as_secs_f64() / outcome.time.as_secs_f64();
    println!("{:.1} %", part * 100.0);
    assert!(part > 0.95, "{part}");
}

/// Every protocol as control and as device.
fn protocols() -> Vec<(&'static str, Box<dyn Protocol>)> {
    let files = || {
        let files = Memory::default();
        files.put("1.H", program(1, 3));
        files.put("2.H", program(2, 3));
        Box::new(files)
    };
    let fe = settings(Mode::Fe1);
    let ext1 = ext(ControlModel::Tnc415b, &[(5020, 168.0), (5030, 0.0)]);
    let kind = FileType::of_code('H').unwrap();
    let names = || vec!["1.H".to_owned(), "2.H".to_owned()];
    let read =
        |want: Want| -> Box<dyn Protocol> { Box::new(blockwise::Reading::new(fe, files(), want, kind)) };
    let read_standard = |settings: Settings, want| -> Box<dyn Protocol> {
        Box::new(standard::Reading::new(settings, files(), want, kind))
    };
    vec![
        (
            "blockwise device",
            Box::new(blockwise::Peripheral::new(fe, files(), Rights::ALL)),
        ),
        ("blockwise selected", read(Want::Selected("9.H".into()))),
        ("blockwise all", read(Want::All)),
        ("blockwise offered", read(Want::Offered)),
        ("blockwise directory", read(Want::Directory)),
        ("directory of FE1", Box::new(DirectoryRequest::new(fe))),
        (
            "blockwise output",
            Box::new(blockwise::Writing::new(fe, files(), names(), false)),
        ),
        (
            "standard device",
            Box::new(standard::Peripheral::new(ext1, files(), Rights::ALL)),
        ),
        (
            "standard selected",
            read_standard(ext1, Want::Selected("9.H".into())),
        ),
        ("standard all", read_standard(settings(Mode::Me), Want::All)),
        (
            "standard output",
            Box::new(standard::Writing::new(ext1, files(), names(), false)),
        ),
    ]
}

/// Noise, and then what frees every port: silence, the END key or the cable.
fn survive(noise: &[u8], seed: u64) {
    for (name, mut protocol) in protocols() {
        let mut now = Duration::from_secs(1);
        let mut out = Vec::new();
        for (number, byte) in noise.iter().enumerate() {
            protocol.receive(*byte, now);
            if (number as u64 ^ seed).is_multiple_of(7) {
                out.clear();
                protocol.send(64, now, &mut out);
                now += Duration::from_micros(900);
                protocol.clock(now);
            }
            while let Some(event) = protocol.event() {
                if matches!(event, Event::Question(_)) {
                    protocol.answer(byte & 1 == 0, now);
                }
            }
        }
        let mut bytes = 0;
        for _ in 0..2000 {
            now += Duration::from_millis(20);
            protocol.clock(now);
            out.clear();
            protocol.send(100_000, now, &mut out);
            bytes += out.len();
            while let Some(event) = protocol.event() {
                if matches!(event, Event::Question(_)) {
                    protocol.answer(false, now);
                }
            }
        }
        assert!(bytes < 1 << 20, "{name} never stops sending");
        // DC3 may have come last; the operator and the cable have the last word.
        protocol.end(now);
        protocol.unplugged(now);
        assert!(protocol.is_idle(), "{name} is stuck");
        if name.ends_with("device") {
            // And it obeys again.
            let request = if name.starts_with("block") {
                "SOH H1E ETB BCC DC1"
            } else {
                "DC1"
            };
            let request = support::bytes(request);
            request.iter().for_each(|byte| protocol.receive(*byte, now));
            out.clear();
            protocol.send(100, now, &mut out);
            assert!(!out.is_empty(), "{name} does not obey any more");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn noise_leaves_nobody_stuck(noise in proptest::collection::vec(any::<u8>(), 0..3000), seed: u64) {
        survive(&noise, seed);
    }

    /// Noise that is made of what protocols are made of.
    #[test]
    fn meaningful_noise_leaves_nobody_stuck(
        pieces in proptest::collection::vec(prop::sample::select(vec![
            "SOH H1E ETB BCC DC1", "SOH HE ETB BCC", "SOH H7A ETB BCC DC1", "ACK", "NAK", "ETX", "EOT", "DC1", "DC3", "ENQ",
            "STX \"0 BEGIN PGM 1 MM\" ETB BCC DC1", "STX \"1 END PGM 1 MM\" ETB BCC", "STX \"1 L X+1\" ETB BAD", "ESC 13",
            "SOH \"ERR: 010\" ETB BCC", "\"0 BEGIN PGM 1 MM\" CR LF", "\"1 END PGM 1 MM\" CR LF", "ESC DC1 \"0 D\" CR LF",
            "STX", "ETB", "NUL*50", "ESC",
        ]), 0..200),
        seed: u64,
    ) {
        let noise: Vec<u8> = pieces.iter().flat_map(|piece| support::bytes(piece)).collect();
        survive(&noise, seed);
    }
}

/// Ten million bytes of noise on each port.
#[test]
fn ten_million_bytes_of_noise() {
    let mut state = 1_u64;
    let noise: Vec<u8> = (0..10_000_000)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        })
        .collect();
    survive(&noise, 1);
}
