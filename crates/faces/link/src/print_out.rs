//! Bytes for a printer: no protocol but DC1 and DC3.

use std::time::Duration;

use crate::protocol::{Ended, Event, Protocol};
use crate::{DC1, DC3};

/// What is printed. It obeys DC3 and DC1, and is over when the last byte is sent.
///
/// ```
/// use std::time::Duration;
/// use bahn_link::{Ended, Event, PrintOut, Protocol};
///
/// let now = Duration::ZERO;
/// let mut print = PrintOut::new(b"ABC".to_vec());
/// let mut sent = Vec::new();
/// print.send(2, now, &mut sent);
/// print.receive(0x13, now);
/// assert!(!print.has_output());
/// print.receive(0x11, now);
/// print.send(2, now, &mut sent);
/// assert_eq!((sent.as_slice(), print.event()), (&b"ABC"[..], Some(Event::Ended(Ended::Complete))));
/// ```
#[derive(Clone, Debug)]
pub struct PrintOut {
    bytes: Vec<u8>,
    at: usize,
    stopped: bool,
    /// The end that is still to be reported.
    ended: Option<Ended>,
    over: bool,
}

impl PrintOut {
    /// Begins to print bytes.
    pub fn new(bytes: Vec<u8>) -> PrintOut {
        PrintOut {
            over: bytes.is_empty(),
            ended: bytes.is_empty().then_some(Ended::Complete),
            bytes,
            at: 0,
            stopped: false,
        }
    }

    fn finish(&mut self, ended: Ended) {
        if !self.over {
            self.over = true;
            self.ended = Some(ended);
        }
    }
}

impl Protocol for PrintOut {
    fn receive(&mut self, byte: u8, _now: Duration) {
        match byte {
            DC3 => self.stopped = true,
            DC1 => self.stopped = false,
            _ => {}
        }
    }

    fn clock(&mut self, _now: Duration) {}

    fn deadline(&self) -> Option<Duration> {
        None
    }

    fn has_output(&self) -> bool {
        !self.over && !self.stopped
    }

    fn send(&mut self, room: usize, _now: Duration, into: &mut Vec<u8>) {
        if !self.has_output() {
            return;
        }
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let count = rest.len().min(room);
        into.extend_from_slice(rest.get(..count).unwrap_or_default());
        self.at += count;
        if self.at == self.bytes.len() {
            self.finish(Ended::Complete);
        }
    }

    fn unplugged(&mut self, _now: Duration) {
        self.finish(Ended::Incomplete);
    }

    fn event(&mut self) -> Option<Event> {
        self.ended.take().map(Event::Ended)
    }

    fn answer(&mut self, _yes: bool, _now: Duration) {}

    fn end(&mut self, _now: Duration) {
        self.finish(Ended::Incomplete);
    }

    fn is_idle(&self) -> bool {
        self.over
    }
}
