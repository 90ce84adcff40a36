//! The byte channel: a line to a device, real or simulated, with its speed and its faults.
//!
//! `spec`: how a port is written; `wire`: sockets, `pty` and serial ports; `redial`: a connection
//! that is made again; `pace`: the speed of a line; `fault`: a bad one.

mod error;
mod fault;
mod pace;
mod poll;
mod pty;
mod redial;
mod spec;
mod wire;

use std::collections::VecDeque;
use std::io;
use std::time::{Duration, Instant};

pub use fault::Faults;
pub use spec::{Line, Spec, SpecError};

use crate::Characters;
use pace::Pace;
use poll::Got;
use wire::Wire;

use error::BAUD;
pub use error::ChannelError;

/// Bytes that are read at once.
const CHUNK: usize = 4096;
/// Bytes that wait to be written where nothing paces them.
const AHEAD: usize = 4096;
/// Characters that a serial port may hold: what a DC3 cannot stop any more.
const AHEAD_OF_UART: usize = 8;

/// What has happened on a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happened {
    /// Bytes have come, or time has passed.
    Nothing,
    /// A device is connected.
    Opened,
    /// The cable is pulled.
    Closed,
}

/// A line to a device.
///
/// ```
/// use std::time::Duration;
/// use bahn_link::{Channel, Characters, Happened, Line, Spec};
///
/// let listening = Spec::of(Line::Listen("127.0.0.1:0".into()));
/// let mut ours = Channel::open(&listening, Characters::FIXED)?;
/// let theirs = Spec::of(Line::Connect(ours.place()));
/// let mut theirs = Channel::open(&theirs, Characters::FIXED)?;
/// let second = Duration::from_secs(1);
/// assert_eq!(ours.wait(second)?, Happened::Opened);
/// theirs.send(b"A\xC1");
/// theirs.wait(Duration::ZERO)?;
/// while ours.received() < 2 {
///     ours.wait(second)?;
/// }
/// // Of seven data bits bit 7 is none.
/// assert_eq!((ours.receive(), ours.receive(), ours.receive()), (Some(b'A'), Some(b'A'), None));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Channel {
    wire: Wire,
    line: Line,
    characters: Characters,
    pace: Option<Pace>,
    /// What is sent, and what is received.
    faults: Option<[Faults; 2]>,
    start: Instant,
    incoming: VecDeque<u8>,
    outgoing: Vec<u8>,
    connected: bool,
    transparent: bool,
}

impl Channel {
    /// Opens a channel; one that listens waits for its peer later.
    ///
    /// # Errors
    /// When it is taken, or nobody answers.
    pub fn open(spec: &Spec, characters: Characters) -> Result<Channel, ChannelError> {
        let wire = Wire::open(&spec.line, characters, spec.baud)?;
        let paced = spec.baud.or(wire.has_lines().then_some(BAUD));
        Ok(Channel {
            connected: !matches!(wire, Wire::Listener { .. } | Wire::Pty(_)),
            wire,
            line: spec.line.clone(),
            characters,
            pace: paced.map(|baud| Pace::new(characters.time(baud))),
            faults: spec
                .fault
                .map(|seed| [0, 1].map(|direction| Faults::of_seed(seed, direction))),
            start: Instant::now(),
            incoming: VecDeque::new(),
            outgoing: Vec::new(),
            transparent: false,
        })
    }

    /// One that connects does so again when its peer has closed, from now on.
    pub fn connect_again(&mut self) {
        self.wire.redial();
    }

    /// All eight bits of a byte count from now on, or those of the characters again.
    pub(crate) fn set_transparent(&mut self, on: bool) {
        self.transparent = on;
    }

    /// Where the other side finds it: address or name of the pseudo terminal.
    pub fn place(&self) -> String {
        self.wire.place().unwrap_or_else(|| self.line.to_string())
    }

    /// The symbolic link that goes with it, for who ends the process without dropping it.
    pub fn link(&self) -> Option<std::path::PathBuf> {
        self.wire.link().cloned()
    }

    /// Time since it was opened.
    pub fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// Whether a device is connected, as far as the channel can know.
    pub fn is_connected(&self) -> bool {
        self.connected
    }

    /// How many bytes may be sent now.
    pub fn room(&mut self) -> usize {
        let now = self.start.elapsed();
        if let Some([sent, _]) = &self.faults
            && now < sent.ready()
        {
            return 0;
        }
        if self.wire.has_lines() && !self.wire.lines().0 {
            return 0;
        }
        let waiting = self.outgoing.len();
        match &mut self.pace {
            Some(pace) if self.wire.has_lines() => pace.room(now).min(AHEAD_OF_UART.saturating_sub(waiting)),
            Some(pace) if waiting == 0 => pace.room(now),
            Some(_) => 0,
            None => AHEAD.saturating_sub(waiting),
        }
    }

    /// When there may be room again.
    fn next_room(&self) -> Duration {
        let paced = self.pace.as_ref().map(Pace::next).unwrap_or_default();
        let slow = self.faults.as_ref().map(|[sent, _]| sent.ready());
        paced.max(slow.unwrap_or_default())
    }

    /// Sends bytes, as many as there is room for.
    pub fn send(&mut self, bytes: &[u8]) {
        let now = self.start.elapsed();
        for byte in bytes {
            let byte = if self.transparent {
                *byte
            } else {
                self.characters.mask(*byte)
            };
            match &mut self.faults {
                Some([sent, _]) => sent.pass(byte, now, &mut self.outgoing),
                None => self.outgoing.push(byte),
            }
        }
        if let Some(pace) = &mut self.pace {
            pace.sent(bytes.len());
        }
    }

    /// Stops the other side by RTS, or lets it go on.
    pub(crate) fn request_to_send(&mut self, on: bool) {
        self.wire.request_to_send(on);
    }

    /// Whether the device is ready for service: DSR, where there is one.
    pub fn is_ready(&mut self) -> bool {
        self.wire.lines().1
    }

    /// Waits until bytes have come or so much time has passed; writes what waits. Who wants to send more waits no longer
    /// than until there is room.
    ///
    /// # Errors
    /// When the channel does not work any more.
    pub fn wait(&mut self, at_most: Duration) -> io::Result<Happened> {
        let end = Instant::now() + at_most;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            if !self.outgoing.is_empty() {
                let written = self.wire.write(&self.outgoing)?;
                self.outgoing.drain(..written);
            }
            let blocked = !self.outgoing.is_empty();
            let wait = if blocked { Duration::ZERO } else { left };
            let mut buffer = [0; CHUNK];
            match self.wire.read(&mut buffer, wait)? {
                Got::Bytes(count) => {
                    self.take(buffer.get(..count).unwrap_or_default());
                    return Ok(Happened::Nothing);
                }
                Got::Opened => {
                    self.connected = true;
                    self.incoming.clear();
                    return Ok(Happened::Opened);
                }
                Got::Closed => {
                    self.connected = false;
                    self.outgoing.clear();
                    return Ok(Happened::Closed);
                }
                Got::Nothing if left.is_zero() => return Ok(Happened::Nothing),
                Got::Nothing if blocked => self.wire.wait_to_write(left.min(Duration::from_millis(5)))?,
                Got::Nothing => {}
            }
        }
    }

    /// How long one may wait when there is more to send.
    pub(crate) fn until_room(&self) -> Duration {
        self.next_room().saturating_sub(self.start.elapsed())
    }

    fn take(&mut self, bytes: &[u8]) {
        let now = self.start.elapsed();
        let mut passed = Vec::with_capacity(bytes.len());
        match &mut self.faults {
            Some([_, received]) => bytes
                .iter()
                .for_each(|byte| received.pass(*byte, now, &mut passed)),
            None => passed.extend_from_slice(bytes),
        }
        let transparent = self.transparent;
        let mask = |byte| {
            if transparent {
                byte
            } else {
                self.characters.mask(byte)
            }
        };
        self.incoming.extend(passed.into_iter().map(mask));
    }

    /// Bytes that have come and are not yet taken.
    pub fn received(&self) -> usize {
        self.incoming.len()
    }

    /// The next byte that has come.
    pub fn receive(&mut self) -> Option<u8> {
        self.incoming.pop_front()
    }

    /// Whether everything that was sent is written.
    pub(crate) fn is_written(&self) -> bool {
        self.outgoing.is_empty()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn hear(channel: &mut Channel, count: usize) -> Vec<u8> {
        let end = channel.now() + SECOND * 5;
        while channel.received() < count && channel.now() < end {
            channel.wait(Duration::from_millis(50)).unwrap();
        }
        std::iter::from_fn(|| channel.receive()).collect()
    }

    fn until(channel: &mut Channel, happened: Happened) {
        let end = channel.now() + SECOND * 5;
        while channel.wait(Duration::from_millis(50)).unwrap() != happened {
            assert!(channel.now() < end, "never {happened:?}");
        }
    }

    /// A pseudo terminal is opened, spoken over, closed and opened again; its link goes with it.
    #[test]
    fn a_pseudo_terminal_is_a_cable() {
        let link = std::env::temp_dir().join(format!("bahn-pty-{}", std::process::id()));
        let spec = Spec::of(Line::Pty(Some(link.clone())));
        let mut ours = Channel::open(&spec, Characters::FIXED).unwrap();
        assert!(!ours.is_connected());
        for _ in 0..2 {
            let serial = Spec::of(Line::Serial(link.display().to_string()));
            let mut theirs = Channel::open(&serial, Characters::FIXED).unwrap();
            until(&mut ours, Happened::Opened);
            ours.send(b"\x01\x03\x11\x13\r\n\x7F");
            ours.wait(Duration::ZERO).unwrap();
            assert_eq!(hear(&mut theirs, 7), b"\x01\x03\x11\x13\r\n\x7F");
            theirs.send(b"\x1A\x04\x00x");
            theirs.wait(Duration::ZERO).unwrap();
            assert_eq!(hear(&mut ours, 4), b"\x1A\x04\x00x");
            drop(theirs);
            until(&mut ours, Happened::Closed);
        }
        drop(ours);
        assert!(std::fs::symlink_metadata(&link).is_err());
    }

    /// What was sent last arrives, though the sender closes at once and has something unread itself.
    #[test]
    fn the_last_word_arrives() {
        let link = std::env::temp_dir().join(format!("bahn-last-{}", std::process::id()));
        for line in [Line::Pty(Some(link)), Line::Listen("127.0.0.1:0".into())] {
            let mut ours = Channel::open(&Spec::of(line.clone()), Characters::FIXED).unwrap();
            let theirs = match line {
                Line::Pty(_) => Line::Serial(ours.place()),
                _ => Line::Connect(ours.place()),
            };
            let mut theirs = Channel::open(&Spec::of(theirs), Characters::FIXED).unwrap();
            until(&mut ours, Happened::Opened);
            theirs.send(b"unread");
            theirs.wait(Duration::ZERO).unwrap();
            std::thread::sleep(Duration::from_millis(20));
            ours.send(b"\x04");
            let closing = std::thread::spawn(move || {
                while !ours.outgoing.is_empty() {
                    let written = ours.wire.write(&ours.outgoing).unwrap();
                    ours.outgoing.drain(..written);
                }
                drop(ours);
            });
            std::thread::sleep(Duration::from_millis(100));
            assert_eq!(hear(&mut theirs, 1), b"\x04", "{line}");
            drop(theirs);
            closing.join().unwrap();
        }
    }

    /// One peer at a time; who closes has pulled the cable, the next one is taken.
    #[test]
    fn one_peer_after_the_other() {
        let mut ours =
            Channel::open(&Spec::of(Line::Listen("127.0.0.1:0".into())), Characters::FIXED).unwrap();
        let connect = Spec::of(Line::Connect(ours.place()));
        let mut first = Channel::open(&connect, Characters::FIXED).unwrap();
        until(&mut ours, Happened::Opened);
        let mut second = Channel::open(&connect, Characters::FIXED).unwrap();
        second.send(b"2");
        second.wait(Duration::ZERO).unwrap();
        first.send(b"1");
        first.wait(Duration::ZERO).unwrap();
        assert_eq!(hear(&mut ours, 1), b"1");
        drop(first);
        until(&mut ours, Happened::Closed);
        until(&mut ours, Happened::Opened);
        assert_eq!(hear(&mut ours, 1), b"2");
        // Whoever sees that connects again, and has what is said to it then.
        let mut again = Channel::open(&connect, Characters::FIXED).unwrap();
        again.connect_again();
        drop(second);
        until(&mut ours, Happened::Closed);
        until(&mut ours, Happened::Opened);
        let place = ours.place();
        drop(ours);
        until(&mut again, Happened::Closed);
        assert!(!again.is_connected());
        let mut ours = Channel::open(&Spec::of(Line::Listen(place)), Characters::FIXED).unwrap();
        until(&mut again, Happened::Opened);
        until(&mut ours, Happened::Opened);
        ours.send(b"3");
        ours.wait(Duration::ZERO).unwrap();
        assert_eq!(hear(&mut again, 1), b"3");
        // A taken address cannot be opened twice.
        assert!(Channel::open(&Spec::of(Line::Listen(ours.place())), Characters::FIXED).is_err());
    }

    /// At 38,400 baud a second is 3840 characters, on any channel.
    #[test]
    fn a_paced_channel_takes_its_time() {
        let mut ours =
            Channel::open(&Spec::of(Line::Listen("127.0.0.1:0".into())), Characters::FIXED).unwrap();
        let connect = Spec {
            baud: Some(38_400),
            ..Spec::of(Line::Connect(ours.place()))
        };
        let mut theirs = Channel::open(&connect, Characters::FIXED).unwrap();
        until(&mut ours, Happened::Opened);
        let (start, mut left) = (Instant::now(), 1920_usize);
        while left > 0 {
            let room = theirs.room().min(left);
            theirs.send(&vec![b'U'; room]);
            left -= room;
            let wait = theirs.until_room();
            theirs.wait(wait).unwrap();
        }
        assert!(
            start.elapsed() >= Duration::from_millis(490),
            "{:?}",
            start.elapsed()
        );
        assert_eq!(hear(&mut ours, 1920).len(), 1920);
    }
}
