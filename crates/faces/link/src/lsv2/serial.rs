//! Telegrams on a serial line: asked for, framed, confirmed and ended by control characters [000:17514-17540] (public).
//!
//! `ENQ` is answered `DLE 0`, `DLE STX` telegram `DLE ETX` BCC is answered `DLE 1` or, to have it again, `NAK`; `EOT` ends.
//! A `DLE` of the telegram is doubled. The machine knows no line and no clock: it is given bytes and times.
//!
//! Decision: A serial line of LSV/2 yields as the control when both ends begin; a telegram that was confirmed counts
//! without its EOT; everything is tried three times

use std::collections::VecDeque;
use std::time::Duration;

use super::{Telegram, tcp};

const STX: u8 = 0x02;
const ETX: u8 = 0x03;
const EOT: u8 = 0x04;
const ENQ: u8 = 0x05;
const DLE: u8 = 0x10;
const NAK: u8 = 0x15;
/// After `DLE`: go on.
const READY: u8 = b'0';
/// After `DLE`: the telegram is acknowledged.
const TAKEN: u8 = b'1';

/// From `STX` to `ETX`, and until `ENQ` or the check byte is answered (public).
pub const ANSWER: Duration = Duration::from_secs(3);
/// From an answer to the next character (public).
pub const NEXT: Duration = Duration::from_secs(1);
/// A telegram or `ENQ` is sent so often at most, as blocks are [000:17404-17405] (inferred).
const TRIES: u8 = 3;
/// Bytes of a telegram at most: command and data.
const BYTES_MAX: usize = 4 + tcp::DATA_MAX;

/// Who yields when both begin at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The host, whose telegram goes first (inferred).
    Host,
    /// The control, which yields when both sides begin.
    Control,
}

/// What has happened on the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LineEvent {
    /// A telegram has arrived.
    Received(Telegram),
    /// The telegram that was to be sent was taken.
    Sent,
    /// It was not: the reason.
    Failed(LineFault),
}

/// Why a telegram was not sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LineFault {
    /// The other side does not answer.
    #[error("nobody answers")]
    NoAnswer,
    /// It was refused three times.
    #[error("the telegram was refused three times")]
    Refused,
    /// It was not confirmed.
    #[error("the telegram was not confirmed")]
    NotConfirmed,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Idle,
    /// `ENQ` was sent, its answer is awaited.
    Asked,
    /// The telegram was sent.
    Framed,
    /// `ENQ` was answered: `DLE STX` is due.
    Ready,
    /// The bytes of a telegram are received.
    Text,
    /// The check byte is due.
    Check,
    /// The telegram was taken or refused: `EOT`, or the telegram again.
    Answered { taken: bool },
}

/// One end of a serial line.
///
/// ```
/// use std::time::Duration;
/// use bahn_link::lsv2::{Command, LineEvent, SerialLine, Side, Telegram};
///
/// let mut host = SerialLine::new(Side::Host);
/// let mut control = SerialLine::new(Side::Control);
/// host.send(&Telegram::new(Command(*b"R_VR")), Duration::ZERO);
/// for _ in 0..3 {
///     for byte in host.take_output() {
///         control.byte(byte, Duration::ZERO);
///     }
///     for byte in control.take_output() {
///         host.byte(byte, Duration::ZERO);
///     }
/// }
/// assert_eq!(control.event(), Some(LineEvent::Received(Telegram::new(Command(*b"R_VR")))));
/// assert_eq!(host.event(), Some(LineEvent::Sent));
/// ```
#[derive(Debug)]
pub struct SerialLine {
    side: Side,
    state: State,
    /// When something has to have happened.
    due: Option<Duration>,
    output: Vec<u8>,
    events: VecDeque<LineEvent>,
    /// What is being sent, framed.
    frame: Option<Vec<u8>>,
    tries: u8,
    /// What is being received.
    text: Vec<u8>,
    broken: bool,
    /// The last byte was a `DLE`.
    escaped: bool,
}

/// The check byte: all bytes of the telegram and `ETX`, without the `DLE` that frame them (public).
pub(crate) fn check_byte(bytes: &[u8]) -> u8 {
    bytes.iter().fold(ETX, |check, byte| check ^ byte)
}

/// A telegram between `DLE STX` and its check byte.
pub fn frame(telegram: &Telegram) -> Vec<u8> {
    let bytes = telegram.bytes();
    let mut frame = vec![DLE, STX];
    for byte in &bytes {
        if *byte == DLE {
            frame.push(DLE);
        }
        frame.push(*byte);
    }
    frame.extend([DLE, ETX, check_byte(&bytes)]);
    frame
}

impl SerialLine {
    /// An end that is idle.
    pub fn new(side: Side) -> SerialLine {
        SerialLine {
            side,
            state: State::Idle,
            due: None,
            output: Vec::new(),
            events: VecDeque::new(),
            frame: None,
            tries: 0,
            text: Vec::new(),
            broken: false,
            escaped: false,
        }
    }

    /// Nothing is in transit.
    pub fn is_idle(&self) -> bool {
        self.state == State::Idle && self.frame.is_none()
    }

    /// Begins to send a telegram, as soon as the line is idle; false while another one is in transit.
    pub fn send(&mut self, telegram: &Telegram, now: Duration) -> bool {
        if self.frame.is_some() {
            return false;
        }
        self.frame = Some(frame(telegram));
        self.tries = 0;
        if self.state == State::Idle {
            self.ask(now);
        }
        true
    }

    fn ask(&mut self, now: Duration) {
        self.output.push(ENQ);
        self.wait(State::Asked, now, ANSWER);
    }

    fn wait(&mut self, state: State, now: Duration, time: Duration) {
        self.state = state;
        self.escaped = false;
        self.due = Some(now + time);
    }

    /// The line is free: what waits goes out.
    fn rest(&mut self, now: Duration) {
        self.state = State::Idle;
        self.escaped = false;
        self.due = None;
        if self.frame.is_some() {
            self.ask(now);
        }
    }

    /// What is to be sent.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    /// What has happened, one after the other.
    pub fn event(&mut self) -> Option<LineEvent> {
        self.events.pop_front()
    }

    /// When [`SerialLine::tick`] has something to do.
    pub fn due(&self) -> Option<Duration> {
        self.due
    }

    /// Advances the clock: what was awaited for too long is repeated or given up.
    pub fn tick(&mut self, now: Duration) {
        if self.due.is_none_or(|due| now < due) {
            return;
        }
        match self.state {
            State::Idle => self.due = None,
            State::Asked => self.again(now, LineFault::NoAnswer),
            State::Framed => self.again(now, LineFault::NotConfirmed),
            // The other side is gone.
            State::Ready | State::Answered { taken: false } => self.rest(now),
            State::Text | State::Check => self.refuse(now),
            // Its EOT was lost: the telegram was acknowledged.
            State::Answered { taken: true } => self.receive(now),
        }
    }

    /// Tries again, or gives up.
    fn again(&mut self, now: Duration, fault: LineFault) {
        self.tries += 1;
        if self.tries >= TRIES {
            self.give_up(fault, now);
        } else if self.state == State::Framed {
            self.put_frame(now);
        } else {
            self.ask(now);
        }
    }

    fn give_up(&mut self, fault: LineFault, now: Duration) {
        self.frame = None;
        self.events.push_back(LineEvent::Failed(fault));
        self.output.push(EOT);
        self.rest(now);
    }

    fn put_frame(&mut self, now: Duration) {
        if let Some(frame) = &self.frame {
            self.output.extend_from_slice(frame);
        }
        self.wait(State::Framed, now, ANSWER);
    }

    /// A byte has arrived.
    pub fn byte(&mut self, byte: u8, now: Duration) {
        match self.state {
            State::Idle => {
                if byte == ENQ {
                    self.ready(now);
                }
            }
            State::Asked => self.asked(byte, now),
            State::Framed => self.framed(byte, now),
            State::Ready | State::Answered { .. } => self.between(byte, now),
            State::Text => self.text(byte, now),
            State::Check => self.check(byte, now),
        }
    }

    fn ready(&mut self, now: Duration) {
        self.output.extend([DLE, READY]);
        self.wait(State::Ready, now, NEXT);
    }

    fn asked(&mut self, byte: u8, now: Duration) {
        match (std::mem::replace(&mut self.escaped, byte == DLE), byte) {
            (true, READY) => {
                self.tries = 0;
                self.put_frame(now);
            }
            // Both have begun: the control yields, and asks again when the host has ended.
            (_, ENQ) if self.side == Side::Control => self.ready(now),
            _ => {}
        }
    }

    fn framed(&mut self, byte: u8, now: Duration) {
        match (std::mem::replace(&mut self.escaped, byte == DLE), byte) {
            (true, TAKEN) => {
                self.output.push(EOT);
                self.sent();
                self.rest(now);
            }
            (false, NAK) => {
                self.again(now, LineFault::Refused);
            }
            // It answers already, so it has taken the telegram.
            (_, ENQ) => {
                self.sent();
                self.ready(now);
            }
            _ => {}
        }
    }

    fn sent(&mut self) {
        self.frame = None;
        self.events.push_back(LineEvent::Sent);
    }

    /// Between ENQ and text, or text and EOT.
    fn between(&mut self, byte: u8, now: Duration) {
        match (std::mem::replace(&mut self.escaped, byte == DLE), byte) {
            (true, STX) => {
                self.text.clear();
                self.broken = false;
                self.wait(State::Text, now, ANSWER);
            }
            // It has not seen the answer, or begins the next telegram.
            (_, ENQ) => {
                if self.state == (State::Answered { taken: true }) {
                    self.deliver();
                }
                self.ready(now);
            }
            (_, EOT) if self.state == (State::Answered { taken: true }) => self.receive(now),
            (_, EOT) => self.rest(now),
            _ => {}
        }
    }

    fn deliver(&mut self) {
        if let Some(telegram) = Telegram::from_bytes(&self.text) {
            self.events.push_back(LineEvent::Received(telegram));
        }
        self.text.clear();
    }

    fn receive(&mut self, now: Duration) {
        self.deliver();
        self.rest(now);
    }

    fn text(&mut self, byte: u8, now: Duration) {
        match (std::mem::replace(&mut self.escaped, false), byte) {
            (false, DLE) => self.escaped = true,
            (true, ETX) => self.state = State::Check,
            // The telegram begins anew.
            (true, STX) => {
                self.text.clear();
                self.broken = false;
            }
            (true, DLE) | (false, _) => match self.text.len() < BYTES_MAX {
                true => self.text.push(byte),
                false => self.refuse(now),
            },
            (true, _) => self.broken = true,
        }
    }

    fn check(&mut self, byte: u8, now: Duration) {
        if self.broken || byte != check_byte(&self.text) || self.text.len() < 4 {
            return self.refuse(now);
        }
        self.output.extend([DLE, TAKEN]);
        self.wait(State::Answered { taken: true }, now, NEXT);
    }

    fn refuse(&mut self, now: Duration) {
        self.output.push(NAK);
        self.wait(State::Answered { taken: false }, now, ANSWER);
    }
}
