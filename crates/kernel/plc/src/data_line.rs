//! What comes over the data interfaces to the PLC: lines with their texts, and a host that is connected by LSV/2.
//!
//! What is on the wire (characters, protocol, baud rate) is the business of whoever has the wire; here texts are whole.

use std::fmt;

use bahn_path::Switch;
use bahn_text::quoted;

use crate::{DataInterface, HostLink, HostMessage, InterfaceUser};

/// The two interfaces by their number for the modules of the PLC: RS-232-C/V.24 is 0, RS-422/V.11 is 1 [000:15629].
const NAMES: [&str; 2] = ["rs232", "rs422"];
/// Characters of the receive buffer [000:15601].
const RECEIVED_MAX: usize = 128;
/// Messages of a host that wait to be read at most (inferred).
const MESSAGES_MAX: usize = HostLink::CAPACITY;

/// Something happens at an interface of the PLC.
///
/// ```
/// use bahn_plc::{DataLineEvent, LineEvent};
///
/// let event = DataLineEvent::Line(1, LineEvent::Received(b"FA81".to_vec()));
/// assert_eq!(event.to_string(), "rs422 received \"FA81\"");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DataLineEvent {
    /// At a line: 0 RS-232-C/V.24, 1 RS-422/V.11.
    Line(usize, LineEvent),
    /// At the connection with a host.
    Host(HostEvent),
}

/// Something happens at a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LineEvent {
    /// `ready on`, `ready off`: the other side is there and wants characters.
    Ready(Switch),
    /// `baud 9600`: the rate of the operating mode that the operator chose.
    ModeBaud(u32),
    /// `taken on`, `taken off`: the operator's input and output has the line. Not possible while the PLC has it.
    Taken(Switch),
    /// `sent`: the text of the PLC is on its way to the last character.
    Sent,
    /// `not-sent`: it was not possible to send it.
    NotSent,
    /// `received "TEXT"`: a text is complete, its end character is taken off. Lost when nobody receives.
    Received(Vec<u8>),
    /// `faulty`: what came could not be read.
    Faulty,
    /// `etx`: the other side does not want more.
    EndOfText,
}

/// Something happens at the connection with a host by LSV/2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HostEvent {
    /// `connected`: the connection was made.
    Connected,
    /// `disconnected`: it has ended.
    Disconnected,
    /// `message 42`, `message "TEXT"`: a message to the PLC. Not possible when too many wait to be read.
    Message(HostMessage),
    /// `taken`: the host has the first message of the PLC.
    Taken,
}

/// What an interface of the PLC wants of whoever has the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DataLineOrder {
    /// The PLC has got the line, initialised anew, or has given it back.
    Assigned {
        /// 0 RS-232-C/V.24, 1 RS-422/V.11.
        line: usize,
        /// How it is to be used; `None` when it was given back.
        setup: Option<LineSetup>,
    },
    /// This text is to be sent; [`LineEvent::Sent`] or [`LineEvent::NotSent`] answers.
    Send {
        /// 0 RS-232-C/V.24, 1 RS-422/V.11.
        line: usize,
        /// The text, without end character.
        text: Vec<u8>,
    },
    /// The PLC has taken what was received: another text finds place.
    Taken {
        /// 0 RS-232-C/V.24, 1 RS-422/V.11.
        line: usize,
    },
}

/// How the PLC wants to use a line [000:15609-15636].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineSetup {
    /// Data transfer rate, baud.
    pub baud: u32,
    /// Format and protocol of the operating mode that the operator chose, not those of MP5020.2, MP5030.2 and so on.
    pub of_mode: bool,
}

/// What of the interfaces has been ordered, to find what is new.
#[derive(Clone, Debug, Default)]
pub struct OrderedLines([Known; 2]);

/// What is known of a line: its setup, and how often something was so.
#[derive(Clone, Copy, Debug, Default)]
struct Known {
    setup: Option<LineSetup>,
    assigned: u32,
    begun: u32,
    taken: u32,
}

impl OrderedLines {
    /// Tells the orders since the last call. A line that has nothing new costs a comparison.
    pub fn news(&mut self, interfaces: &[DataInterface; 2], mut tell: impl FnMut(DataLineOrder)) {
        for (line, (known, interface)) in self.0.iter_mut().zip(interfaces).enumerate() {
            let is_of_plc = interface.user == Some(InterfaceUser::Plc);
            let setup = is_of_plc.then_some(LineSetup {
                baud: interface.baud,
                of_mode: interface.format_of_mode,
            });
            if (known.setup, known.assigned) != (setup, interface.assigned) {
                (known.setup, known.assigned) = (setup, interface.assigned);
                tell(DataLineOrder::Assigned { line, setup });
            }
            if known.taken != interface.taken {
                known.taken = interface.taken;
                tell(DataLineOrder::Taken { line });
            }
            if known.begun != interface.begun {
                known.begun = interface.begun;
                if !interface.transmit.is_empty() {
                    let text = interface.transmit.clone();
                    tell(DataLineOrder::Send { line, text });
                }
            }
        }
    }
}

impl DataLineEvent {
    /// Words with which the texts of such events begin.
    pub const WORDS: [&'static str; 3] = ["rs232", "rs422", "lsv2"];

    /// Reads what stands after such a word.
    pub fn parse(word: &str, rest: &str) -> Option<DataLineEvent> {
        if word == "lsv2" {
            return HostEvent::parse(rest).map(DataLineEvent::Host);
        }
        let line = NAMES.iter().position(|name| *name == word)?;
        LineEvent::parse(rest).map(|event| DataLineEvent::Line(line, event))
    }
}

impl LineEvent {
    fn parse(text: &str) -> Option<LineEvent> {
        let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
        match (word, rest.trim()) {
            ("ready", switch) => on_off(switch).map(LineEvent::Ready),
            ("taken", switch) => on_off(switch).map(LineEvent::Taken),
            ("baud", rate) => rate.parse().ok().map(LineEvent::ModeBaud),
            ("received", text) => quoted(text).map(LineEvent::Received),
            ("sent", "") => Some(LineEvent::Sent),
            ("not-sent", "") => Some(LineEvent::NotSent),
            ("faulty", "") => Some(LineEvent::Faulty),
            ("etx", "") => Some(LineEvent::EndOfText),
            _ => None,
        }
    }
}

impl HostEvent {
    fn parse(text: &str) -> Option<HostEvent> {
        let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
        match (word, rest.trim()) {
            ("connected", "") => Some(HostEvent::Connected),
            ("disconnected", "") => Some(HostEvent::Disconnected),
            ("taken", "") => Some(HostEvent::Taken),
            ("message", value) => {
                let number = value.parse().ok().map(HostMessage::Double);
                let message = number.or_else(|| quoted(value).map(HostMessage::Text));
                message.map(HostEvent::Message)
            }
            _ => None,
        }
    }
}

fn on_off(text: &str) -> Option<Switch> {
    match text {
        "on" => Some(Switch::On),
        "off" => Some(Switch::Off),
        _ => None,
    }
}

/// A text in quotes, with the escapes of a byte string.
struct Quoted<'a>(&'a [u8]);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", self.0.escape_ascii())
    }
}

impl fmt::Display for DataLineEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DataLineEvent::Line(line, event) => {
                let name = NAMES.get(*line).copied().unwrap_or("?");
                match event {
                    LineEvent::Ready(switch) => write!(f, "{name} ready {switch}"),
                    LineEvent::Taken(switch) => write!(f, "{name} taken {switch}"),
                    LineEvent::ModeBaud(baud) => write!(f, "{name} baud {baud}"),
                    LineEvent::Sent => write!(f, "{name} sent"),
                    LineEvent::NotSent => write!(f, "{name} not-sent"),
                    LineEvent::Received(text) => write!(f, "{name} received {}", Quoted(text)),
                    LineEvent::Faulty => write!(f, "{name} faulty"),
                    LineEvent::EndOfText => write!(f, "{name} etx"),
                }
            }
            DataLineEvent::Host(HostEvent::Connected) => write!(f, "lsv2 connected"),
            DataLineEvent::Host(HostEvent::Disconnected) => write!(f, "lsv2 disconnected"),
            DataLineEvent::Host(HostEvent::Taken) => write!(f, "lsv2 taken"),
            DataLineEvent::Host(HostEvent::Message(HostMessage::Double(value))) => {
                write!(f, "lsv2 message {value}")
            }
            DataLineEvent::Host(HostEvent::Message(HostMessage::Text(text))) => {
                write!(f, "lsv2 message {}", Quoted(text))
            }
        }
    }
}

/// The lines to the PLC and the host that is connected.
#[derive(Clone, Debug, Default)]
pub struct DataLines {
    /// By their number: 0 RS-232-C/V.24, 1 RS-422/V.11.
    pub interfaces: [DataInterface; 2],
    /// The host that is connected by LSV/2.
    pub host: Option<HostLink>,
}

impl DataLines {
    /// Lets it happen; whether it is possible.
    pub fn happen(&mut self, event: DataLineEvent) -> bool {
        match event {
            DataLineEvent::Line(line, event) => self
                .interfaces
                .get_mut(line)
                .is_some_and(|interface| at_line(interface, event)),
            DataLineEvent::Host(event) => self.at_host(event),
        }
    }

    fn at_host(&mut self, event: HostEvent) -> bool {
        match (event, &mut self.host) {
            (HostEvent::Connected, host) => {
                host.get_or_insert_default();
                true
            }
            (HostEvent::Disconnected, host) => {
                *host = None;
                true
            }
            (_, None) => false,
            (HostEvent::Message(message), Some(host)) => {
                let fits = host.incoming.len() < MESSAGES_MAX;
                if fits {
                    host.incoming.push_back(message);
                }
                fits
            }
            (HostEvent::Taken, Some(host)) => host.outgoing.pop_front().is_some(),
        }
    }

    /// The lines and the host are those of the control that was on before; what waited is gone.
    pub fn follow_on(&mut self, before: &DataLines) {
        for (interface, before) in self.interfaces.iter_mut().zip(&before.interfaces) {
            (interface.ready, interface.was_ready) = (before.ready, before.was_ready);
            interface.mode_baud = before.mode_baud;
            // A transfer of the operator ends with the control, and is told so by whoever has the line.
        }
        self.host = before.host.is_some().then(HostLink::default);
    }
}

fn at_line(interface: &mut DataInterface, event: LineEvent) -> bool {
    let receives = interface.user == Some(InterfaceUser::Plc) && interface.receiving;
    match event {
        LineEvent::Ready(switch) => interface.ready = switch.is_on(),
        LineEvent::ModeBaud(baud) => interface.mode_baud = baud,
        LineEvent::Taken(Switch::On) if interface.user == Some(InterfaceUser::Plc) => return false,
        LineEvent::Taken(Switch::On) => interface.assign_to_nc(),
        LineEvent::Taken(Switch::Off) if interface.user == Some(InterfaceUser::Nc) => interface.release(),
        LineEvent::Taken(Switch::Off) => {}
        LineEvent::Sent => interface.transmit.clear(),
        LineEvent::NotSent => {
            interface.transmit.clear();
            interface.transmit_error = true;
        }
        LineEvent::Received(_) | LineEvent::Faulty | LineEvent::EndOfText if !receives => return false,
        // A text that nobody has taken yet stays; the new one is lost, and that is an error.
        LineEvent::Received(text) if interface.received || text.len() > RECEIVED_MAX => {
            interface.receive_error = true;
        }
        LineEvent::Received(text) => {
            interface.receive = text;
            interface.received = true;
        }
        LineEvent::Faulty => interface.receive_error = true,
        LineEvent::EndOfText => {
            interface.end_of_text = true;
            interface.receiving = false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_byte_goes_through_the_log() {
        let all: Vec<u8> = (0..=255).collect();
        let event = DataLineEvent::Line(0, LineEvent::Received(all));
        let text = event.to_string();
        let (word, rest) = text.split_once(' ').unwrap();
        assert_eq!(DataLineEvent::parse(word, rest), Some(event));
        for wrong in ["\"A", "A", "\"A\"B\"", "\"\\x1\"", "\"\\q\"", "\"A\\\""] {
            assert_eq!(quoted(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_operator_waits_while_the_plc_has_the_line() {
        let mut interface = DataInterface {
            user: Some(InterfaceUser::Plc),
            receiving: true,
            ..DataInterface::default()
        };
        assert!(!at_line(&mut interface, LineEvent::Taken(Switch::On)));
        assert!(at_line(&mut interface, LineEvent::Received(b"1".to_vec())));
        // The second one comes before the first is taken.
        assert!(at_line(&mut interface, LineEvent::Received(b"2".to_vec())));
        assert_eq!(
            (interface.receive.as_slice(), interface.receive_error),
            (&b"1"[..], true)
        );
        interface.release();
        assert!(!at_line(&mut interface, LineEvent::Received(b"3".to_vec())));
        // The operator transfers at the rate of his operating mode, which counts for the other interface, too [000:15617].
        assert!(at_line(&mut interface, LineEvent::ModeBaud(38_400)));
        assert!(at_line(&mut interface, LineEvent::Taken(Switch::On)));
        assert_eq!(
            (interface.user, interface.baud),
            (Some(InterfaceUser::Nc), 38_400)
        );
    }
}
