//! The event buffer: what is recorded, and how it is printed.

use bahn_system900::{Cell, Depth, Event, EventBuffer, Key, Memory, Name, Partner, ProgramName};
use proptest::prelude::*;

use crate::memory::{memory, name};

/// What a parameter holds after it was given a value.
fn cell(value: &str) -> Cell {
    memory(&[("q2000", value)]).cell(Name::Q(2000)).unwrap()
}

/// The time of a line of the example.
fn ms(hours: u64, minutes: u64, seconds: u64, ms: u64) -> u64 {
    ((hours * 60 + minutes) * 60 + seconds) * 1000 + ms
}

const fn word(number: u8, pressed: u8, kind: u8) -> Key {
    Key(i32::from_le_bytes([number, pressed, 0, kind]))
}

/// Events with their times are these lines, in their order.
fn printed(lines: &[(u64, Event, &str)]) {
    let mut events = EventBuffer::new(Depth::Short);
    for (time, event, _) in lines {
        events.push(*time, *event);
    }
    let lines = (1..).zip(lines);
    let wanted: String = lines
        .map(|(number, (_, _, line))| format!("{number} {line}\n"))
        .collect();
    assert_eq!(events.to_string(), wanted);
    let output = events.output("1. 2.99", ms(2, 12, 57, 999));
    assert!(
        output.starts_with("SAMPLE DATA\n\nOutput:\nDATE: 1. 2.99\nTime: 02:12:57\n"),
        "{output}"
    );
    assert!(output.ends_with(&format!("{wanted}\nSAMPLE END\n")), "{output}");
}

/// The lines of the example, with its times [002:6106-6144]; keys have numbers where the drawing has names.
#[test]
fn printed_pictures_and_keys() {
    let picture = |letters: &[u8; 8]| Event::Picture(*letters);
    let key = |number, pressed, kind| Event::Key(word(number, pressed, kind));
    printed(&[
        (
            ms(0, 0, 0, 0),
            Event::Boot,
            "00:00:00,000 ======== system boot =============",
        ),
        (
            ms(2, 8, 39, 445),
            picture(b"INIT\0\0\0\0"),
            "02:08:39,445 PICTURE: INIT",
        ),
        (
            ms(2, 8, 42, 455),
            picture(b"A_INIT\0\0"),
            "02:08:42,455 PICTURE: A_INIT",
        ),
        (ms(2, 11, 55, 650), key(20, 1, 2), "02:11:55,650 C-KEY 20"),
        (
            ms(2, 11, 55, 700),
            key(20, 0, 2),
            "02:11:55,700 C-KEY 20 released",
        ),
        (ms(2, 11, 56, 965), key(5, 1, 1), "02:11:56,965 F-KEY F5"),
        (ms(2, 11, 58, 525), key(b'1', 0, 0), "02:11:58,525 KEY \"1\""),
        (ms(2, 11, 59, 0), key(13, 0, 0), "02:11:59,000 KEY 13"),
        (ms(2, 11, 59, 1), key(7, 1, 3), "02:11:59,001 T-KEY 7"),
    ]);
}

/// Likewise; arrows are `-->`.
#[test]
fn printed_parameters_and_messages() {
    let sent = |to, text, value| Event::Sent(to, name(text), cell(value));
    let came = Event::Received(Partner::Plc, name("P8703"), cell("1"));
    printed(&[
        (
            ms(2, 12, 8, 990),
            sent(Partner::Plc, "q1137", "65822"),
            "02:12:08,990 PARA CNC --> PLC K0 q1137: 65822",
        ),
        (
            ms(2, 12, 8, 995),
            came,
            "02:12:08,995 PARA CNC <-- PLC K1 P8703: 1",
        ),
        (
            ms(2, 12, 9, 0),
            sent(Partner::Panel, "2:P8900", "--"),
            "02:12:09,000 PARA CNC --> OP K2 P8900: --",
        ),
        (
            ms(2, 12, 13, 820),
            Event::Message(0, 3498),
            "02:12:13,820 K0 message: M3498",
        ),
        (
            ms(2, 12, 22, 0),
            Event::Written(name("P600"), cell("5")),
            "02:12:22,000 K1 P600: 5",
        ),
        (
            ms(2, 13, 22, 540),
            Event::Entry(cell("12345")),
            "02:13:22,540 P11279: 12345",
        ),
        (
            ms(123, 0, 0, 7),
            Event::Message(2, 1),
            "123:00:00,007 K2 message: M1",
        ),
    ]);
}

/// Likewise.
#[test]
fn printed_blocks_and_functions() {
    let program = ProgramName::Program(1000);
    let function = |m, place, branch| Event::Function {
        channel: 1,
        m,
        place,
        branch,
    };
    let at = ms(2, 12, 21, 340);
    printed(&[
        (
            ms(2, 12, 21, 15),
            Event::Block(1, program, 11_160),
            "02:12:21,015 PROG: K1 P1000 N11160",
        ),
        (
            ms(2, 12, 21, 16),
            Event::Block(2, ProgramName::Cycle(6), 10),
            "02:12:21,016 PROG: K2 Z6 N10",
        ),
        (
            at,
            function(30, 0, None),
            "02:12:21,340 K1 M30 --> PLC, NR in the block:0, without branch",
        ),
        (
            at,
            function(7, 2, Some(300)),
            "02:12:21,340 K1 M7 --> PLC, NR in the block:2, branch to N300",
        ),
        (
            at,
            Event::EndOfBlock(1),
            "02:12:21,340 K1 END OF BLOCK CNC --> PLC, CNC WAITS for acknowledgement",
        ),
        (
            at,
            Event::Release(1, cell("1")),
            "02:12:21,340 K1 CNC <-- PLC SAFRE: 1",
        ),
    ]);
}

/// Which of some events of the channels 1 and 2 are recorded.
fn recorded(memory: &Memory) -> Vec<&'static str> {
    let one = cell("1");
    let all = [
        ("boot", Event::Boot),
        ("key", Event::Key(word(1, 1, 2))),
        ("message", Event::Message(2, 2001)),
        ("entry", Event::Entry(one)),
        ("to plc", Event::Sent(Partner::Plc, name("P600"), one)),
        ("from plc 2", Event::Received(Partner::Plc, name("2:P600"), one)),
        ("to panel", Event::Sent(Partner::Panel, name("q20"), one)),
        ("written", Event::Written(name("P600"), one)),
        ("written q", Event::Written(name("q600"), one)),
        ("written 2", Event::Written(name("2:P600"), one)),
        (
            "m",
            Event::Function {
                channel: 1,
                m: 3,
                place: 0,
                branch: None,
            },
        ),
        ("end", Event::EndOfBlock(1)),
        ("release 2", Event::Release(2, one)),
        ("block", Event::Block(1, ProgramName::Program(1), 1)),
        ("block 2", Event::Block(2, ProgramName::Program(1), 1)),
    ];
    let wanted = all.into_iter().filter(|(_, event)| event.is_wanted(memory));
    wanted.map(|(title, _)| title).collect()
}

/// Keys, messages and entries always, other events as P11271 of channel 1 and P11272 of channel 2 say; P11270 = 1 stops
/// all [002:6074-6084] [002:6169-6195].
#[test]
fn what_is_recorded() {
    let always = ["boot", "key", "message", "entry"];
    let with = |more: &[&'static str]| [&always[..], more].concat();
    for (parameter, value, more) in [
        ("P11271", "0", &[][..]),
        ("P11271", "1", &["to plc"]),
        ("P11272", "1", &["from plc 2"]),
        ("P11271", "2", &["to panel"]),
        ("P11271", "4", &["written", "written q"]),
        ("P11272", "4", &["written 2"]),
        ("P11271", "16", &["m", "end"]),
        ("P11272", "16", &["release 2"]),
        ("P11271", "256", &["block"]),
        ("P11272", "256", &["block 2"]),
        ("P11278", "$FFFFFFFF", &[]),
    ] {
        assert_eq!(
            recorded(&memory(&[(parameter, value)])),
            with(more),
            "{parameter}={value}"
        );
        let stopped = memory(&[(parameter, value), ("P11270", "1")]);
        assert_eq!(recorded(&stopped), [""; 0]);
        let mut events = EventBuffer::new(Depth::Long);
        events.record(&stopped, 0, Event::Boot);
        assert_eq!(events.count(), 0);
    }
}

proptest! {
    /// The last 100 or 2000 events are kept, in their order and with their numbers; a clone goes on as its original.
    #[test]
    fn the_last_events_are_kept(count in 0u64..2300, is_long in any::<bool>()) {
        let depth = if is_long { Depth::Long } else { Depth::Short };
        let mut events = EventBuffer::new(depth);
        for time in 0..count {
            events.push(time, Event::EndOfBlock(1));
        }
        let kept = count.min(depth.records() as u64);
        let numbers: Vec<(u64, u64)> = events.records().map(|record| (record.number, record.time_ms)).collect();
        let wanted: Vec<(u64, u64)> = (count - kept..count).map(|time| (time + 1, time)).collect();
        prop_assert_eq!(numbers, wanted);
        let mut clone = events.clone();
        for events in [&mut events, &mut clone] {
            events.push(9, Event::Boot);
        }
        prop_assert_eq!(events, clone);
    }
}
