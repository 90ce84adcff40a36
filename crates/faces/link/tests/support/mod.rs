//! Conversations over a line, written as the manual prints them.
//!
//! A line is `T: SOH H 15 E ETB BCC DC1`: T is the control, P the device; what is no control character is text, in quotes when
//! it has blanks; `BCC` is the check character of what stands before it, `BAD` a wrong one; `NUL*50` is fifty of them.
//! Between lines the operator does something (`yes`, `no`, `END`), or the line is `quiet` until somebody loses patience.
#![allow(dead_code, reason = "every test file uses its part")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::expect_used,
    reason = "what fails in the support of tests fails the test"
)]

use std::time::Duration;

use bahn_link::{Ended, Event, Mode, Protocol, Question, Settings};
use bahn_parameters::{ControlModel, ParameterList};

/// Which side of a conversation is tested; the other one is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Control,
    Device,
}

pub fn settings(mode: Mode) -> Settings {
    Settings::of(&ParameterList::reference(ControlModel::Tnc415b), mode)
}

/// EXT1 with the values of some machine parameters.
pub fn ext(model: ControlModel, values: &[(u16, f64)]) -> Settings {
    let mut list = ParameterList::reference(model);
    for (number, value) in values {
        let index = if list.get(*number, 0).is_some() { 0 } else { 1 };
        list.set(*number, index, *value).unwrap();
    }
    Settings::of(&list, Mode::Ext1)
}

const CONTROL: [(&str, u8); 14] = [
    ("NUL", 0),
    ("SOH", 1),
    ("STX", 2),
    ("ETX", 3),
    ("EOT", 4),
    ("ENQ", 5),
    ("ACK", 6),
    ("LF", 10),
    ("CR", 13),
    ("DC1", 0x11),
    ("DC3", 0x13),
    ("NAK", 0x15),
    ("ETB", 0x17),
    ("ESC", 0x1B),
];

/// The bytes of a line of a conversation.
pub fn bytes(line: &str) -> Vec<u8> {
    let mut bytes: Vec<u8> = Vec::new();
    let mut block = 0;
    let mut rest = line.trim();
    while !rest.is_empty() {
        let (word, after, quoted) = match rest.strip_prefix('"') {
            Some(text) => {
                let (text, after) = text.split_once('"').unwrap();
                (text, after, true)
            }
            None => {
                let (word, after) = rest.split_once(' ').unwrap_or((rest, ""));
                (word, after, false)
            }
        };
        rest = after.trim_start();
        let (name, count) = match word.split_once('*') {
            Some((name, count)) if !quoted => (name, count.parse().unwrap()),
            _ => (word, 1),
        };
        let control = CONTROL.iter().find(|(known, _)| *known == name && !quoted);
        let check = bytes[block.min(bytes.len())..]
            .iter()
            .fold(0, |check, byte| check ^ byte)
            & 0x7F;
        match (control, word) {
            (Some((_, byte)), _) => {
                if matches!(byte, 1 | 2) {
                    block = bytes.len();
                }
                bytes.extend(std::iter::repeat_n(*byte, count));
            }
            (None, "BCC") if !quoted => bytes.push(check),
            (None, "BAD") if !quoted => bytes.push(check ^ 0x40),
            _ => bytes.extend(word.bytes()),
        }
    }
    bytes
}

/// Bytes as a line of a conversation, for messages of tests.
pub fn shown(bytes: &[u8]) -> String {
    let name = |byte: &u8| match CONTROL.iter().find(|(_, known)| known == byte) {
        Some((name, _)) => format!("<{name}>"),
        None if (b' '..0x7F).contains(byte) => char::from(*byte).to_string(),
        None => format!("<{byte:02X}>"),
    };
    bytes.iter().map(name).collect()
}

/// The events of a protocol, as words.
pub fn described(event: &Event, model: ControlModel) -> String {
    match event {
        Event::Received(name) => format!("received {name}"),
        Event::Sent(name) => format!("sent {name}"),
        Event::Listed(name, None) => format!("listed {name}"),
        Event::Listed(name, Some(sectors)) => format!("listed {name} {sectors}"),
        Event::Free(sectors) => format!("free {sectors}"),
        Event::Question(Question::Overread(name)) => format!("overread {name}?"),
        Event::Question(Question::Offered(name)) => format!("offered {name}?"),
        Event::Question(Question::Output(name)) => format!("output {name}?"),
        Event::Question(Question::Protected(name)) => format!("protected {name}?"),
        Event::Message(shown) => shown.text(model),
        Event::Enquiry => "enquiry".into(),
        Event::Ended(Ended::Complete) => "complete".into(),
        Event::Ended(Ended::Incomplete) => "broken off".into(),
    }
}

/// Lets a protocol have a conversation: what it says is compared byte by byte, what the other side says is played. Returns
/// what it reported.
pub fn converse(role: Role, protocol: &mut dyn Protocol, script: &str) -> Vec<String> {
    let model = ControlModel::Tnc415b;
    let own = if role == Role::Control { 'T' } else { 'P' };
    let mut now = Duration::from_secs(1);
    let mut pending: Vec<u8> = Vec::new();
    for line in script.lines().map(str::trim).filter(|line| !line.is_empty()) {
        now += Duration::from_millis(1);
        protocol.clock(now);
        while protocol.has_output() {
            protocol.send(7, now, &mut pending);
        }
        match line.split_once(':') {
            Some(("T" | "P", text)) if line.starts_with(own) => {
                let expected = bytes(text);
                let said: Vec<u8> = pending.drain(..expected.len().min(pending.len())).collect();
                assert!(
                    said == expected,
                    "{role:?}: `{line}`: expected {}, said {} and {}",
                    shown(&expected),
                    shown(&said),
                    shown(&pending)
                );
            }
            Some(("T" | "P", text)) => {
                assert!(
                    pending.is_empty(),
                    "{role:?}: before `{line}` said {}",
                    shown(&pending)
                );
                for byte in bytes(text) {
                    protocol.receive(byte, now);
                }
            }
            _ => match line {
                "yes" | "no" if role == Role::Control => protocol.answer(line == "yes", now),
                "END" if role == Role::Control => protocol.end(now),
                "pulled" => protocol.unplugged(now),
                "quiet" => {
                    // Past every patience there is.
                    for _ in 0..100 {
                        now += Duration::from_millis(100);
                        protocol.clock(now);
                    }
                }
                _ => {}
            },
        }
    }
    while protocol.has_output() {
        protocol.send(100, now, &mut pending);
    }
    // Nobody says anything any more.
    for _ in 0..20 {
        now += Duration::from_millis(50);
        protocol.clock(now);
    }
    assert!(
        pending.is_empty(),
        "{role:?}: at the end said {}",
        shown(&pending)
    );
    std::iter::from_fn(|| protocol.event())
        .map(|event| described(&event, model))
        .collect()
}
