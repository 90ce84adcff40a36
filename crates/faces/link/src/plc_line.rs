//! The PLC at a line: how its texts go over it [000:15587-15833].
//!
//! The manual says what modules 9100 to 9107 do, and nothing of the bytes. With the standard protocol a text is a line, with
//! the blockwise one it is a block; what comes is acknowledged when the PLC has room for it *(inferred)*.
//!
//! Decision: A text of the PLC is a line with CR LF in the standard protocol, a block that is acknowledged in the
//! other; what comes is acknowledged, or the other side let go on, when the PLC has taken the text before; a text
//! with nobody at the line is refused (`M3171`)

use std::collections::VecDeque;
use std::time::Duration;

use bahn_tnc::LineEvent;

use crate::frame::{Decoder, Kind, Piece, encode};
use crate::settings::Settings;
use crate::{DC1, DC3};

/// Characters of the receive buffer [000:15601].
const TEXT_MAX: usize = 128;
/// Transmissions of a block at most [000:17404-17405].
const TRIES: u8 = 3;

/// The PLC's end of a line: bytes and time in, bytes and [events](LineEvent) out; it knows no clock and no channel.
///
/// Nothing goes over the line while the PLC has not got it.
#[derive(Clone, Debug, Default)]
pub struct PlcLine {
    settings: Option<Settings>,
    decoder: Decoder,
    /// A line that has not come to its end; of one that is too long nothing is kept.
    line: Vec<u8>,
    too_long: bool,
    /// The PLC has a text that it has not taken.
    awaits: bool,
    /// The text after that.
    held: Option<Vec<u8>>,
    /// Answers and stops, before everything else.
    replies: VecDeque<u8>,
    sending: Option<Sending>,
    /// The other side has stopped this one.
    stopped: bool,
    /// This one has stopped the other side.
    stops: bool,
    /// Blocks in a row that could not be read.
    wrong: u8,
    events: VecDeque<LineEvent>,
}

/// A text that is being sent.
#[derive(Clone, Debug)]
struct Sending {
    block: Vec<u8>,
    at: usize,
    transmissions: u8,
    /// When an answer must be there.
    until: Option<Duration>,
}

impl PlcLine {
    /// The PLC has got the line with these settings, or has given it back.
    pub fn assign(&mut self, settings: Option<Settings>) {
        *self = PlcLine {
            settings,
            ..PlcLine::default()
        };
    }

    /// The PLC wants a text to be sent.
    pub fn transmit(&mut self, text: &[u8]) {
        let Some(settings) = &self.settings else {
            return self.events.push_back(LineEvent::NotSent);
        };
        let block = match settings.blockwise {
            true => encode(settings, Kind::Text, text),
            false => [text, b"\r\n"].concat(),
        };
        self.sending = Some(Sending {
            block,
            at: 0,
            transmissions: 1,
            until: None,
        });
    }

    /// The PLC has taken a text.
    pub fn taken(&mut self) {
        self.awaits = false;
        let Some(settings) = self.settings else {
            return;
        };
        match self.held.take() {
            Some(text) => {
                if settings.blockwise {
                    self.replies.push_back(settings.control.ack);
                }
                self.deliver(text);
            }
            None if std::mem::take(&mut self.stops) && !settings.stop_by_rts => self.replies.push_back(DC1),
            None => {}
        }
    }

    /// A byte has come.
    pub fn receive(&mut self, byte: u8) {
        match self.settings {
            None => {}
            Some(settings) if settings.blockwise => {
                if let Some(piece) = self.decoder.take(&settings, byte) {
                    self.piece(&settings, piece);
                }
            }
            Some(settings) => self.character(&settings, byte),
        }
    }

    fn piece(&mut self, settings: &Settings, piece: Piece) {
        let control = &settings.control;
        match piece {
            Piece::Block(Kind::Text, text) => {
                self.wrong = 0;
                if text.len() > TEXT_MAX {
                    self.events.push_back(LineEvent::Faulty);
                    self.replies.push_back(control.ack);
                } else if self.awaits {
                    self.held = Some(text);
                } else {
                    self.replies.push_back(control.ack);
                    self.deliver(text);
                }
            }
            // An error of the device.
            Piece::Block(Kind::Header, _) => {
                self.replies.extend([control.ack, control.eot]);
                self.events.push_back(LineEvent::Faulty);
            }
            Piece::Wrong => {
                self.wrong += 1;
                if self.wrong < TRIES {
                    self.replies.push_back(control.nak);
                } else {
                    self.wrong = 0;
                    self.replies.push_back(control.eot);
                    self.events.push_back(LineEvent::Faulty);
                }
            }
            Piece::Ack if self.awaits_answer() => self.sent(LineEvent::Sent),
            Piece::Nak if self.awaits_answer() => self.again(),
            Piece::Etx => self.events.push_back(LineEvent::EndOfText),
            Piece::Other(DC3) => self.stopped = true,
            Piece::Other(DC1) => self.stopped = false,
            Piece::Ack | Piece::Nak | Piece::Eot | Piece::Other(_) => {}
        }
    }

    fn character(&mut self, settings: &Settings, byte: u8) {
        match byte {
            DC3 => self.stopped = true,
            DC1 => self.stopped = false,
            b'\n' | 0x0C => self.complete(),
            byte if byte == settings.control.etx => {
                self.complete();
                self.events.push_back(LineEvent::EndOfText);
            }
            byte if byte < b' ' => {}
            _ if self.line.len() == TEXT_MAX => self.too_long = true,
            byte => self.line.push(byte),
        }
    }

    /// A line is complete; an empty one is no text.
    fn complete(&mut self) {
        let text = std::mem::take(&mut self.line);
        if std::mem::take(&mut self.too_long) {
            self.events.push_back(LineEvent::Faulty);
        } else if text.is_empty() {
        } else if !self.awaits {
            self.deliver(text);
        } else if self.held.replace(text).is_some() {
            // It came although it was stopped.
            self.events.push_back(LineEvent::Faulty);
        }
    }

    fn deliver(&mut self, text: Vec<u8>) {
        self.events.push_back(LineEvent::Received(text));
        self.awaits = true;
        let settings = self
            .settings
            .filter(|settings| !settings.blockwise && !self.stops);
        if let Some(settings) = settings {
            self.stops = true;
            if !settings.stop_by_rts {
                self.replies.push_back(DC3);
            }
        }
    }

    fn awaits_answer(&self) -> bool {
        let whole = |sending: &Sending| sending.at == sending.block.len();
        self.sending.as_ref().is_some_and(whole)
    }

    fn sent(&mut self, event: LineEvent) {
        self.sending = None;
        self.events.push_back(event);
    }

    fn again(&mut self) {
        match self
            .sending
            .as_mut()
            .filter(|sending| sending.transmissions < TRIES)
        {
            Some(sending) => {
                (sending.at, sending.until) = (0, None);
                sending.transmissions += 1;
            }
            None => self.sent(LineEvent::NotSent),
        }
    }

    /// Advances the clock, which ends what it has waited for too long.
    pub fn clock(&mut self, now: Duration) {
        if self.deadline().is_some_and(|until| now >= until) {
            self.sent(LineEvent::NotSent);
        }
    }

    /// When [`PlcLine::clock`] is to be called at the latest.
    pub fn deadline(&self) -> Option<Duration> {
        self.sending.as_ref()?.until
    }

    /// Whether it has something to send.
    pub fn has_output(&self) -> bool {
        let unsent = |sending: &Sending| sending.at < sending.block.len();
        !self.replies.is_empty() || !self.stopped && self.sending.as_ref().is_some_and(unsent)
    }

    /// Takes what is to be sent, `room` bytes at most; the caller must send all of them.
    pub fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        let replies = room.min(self.replies.len());
        into.extend(self.replies.drain(..replies));
        let Some(settings) = self.settings.filter(|_| !self.stopped) else {
            return;
        };
        let Some(sending) = &mut self.sending else {
            return;
        };
        let rest = sending.block.get(sending.at..).unwrap_or_default();
        let count = rest.len().min(room - replies);
        into.extend_from_slice(rest.get(..count).unwrap_or_default());
        sending.at += count;
        if count > 0 && sending.at == sending.block.len() {
            match settings.blockwise {
                true => sending.until = Some(now + settings.patience),
                false => self.sent(LineEvent::Sent),
            }
        }
    }

    /// The cable is pulled.
    pub fn unplugged(&mut self) {
        let settings = self.settings;
        let awaits = self.awaits;
        let was_sending = self.sending.is_some();
        let events = std::mem::take(&mut self.events);
        self.assign(settings);
        (self.awaits, self.events) = (awaits, events);
        if was_sending {
            self.events.push_back(LineEvent::NotSent);
        }
    }

    /// What the control is to get.
    pub fn event(&mut self) -> Option<LineEvent> {
        self.events.pop_front()
    }

    /// Whether it has stopped the other side by RTS.
    pub(crate) fn has_stopped_by_rts(&self) -> bool {
        self.stops && self.settings.is_some_and(|settings| settings.stop_by_rts)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_parameters::{ControlModel, ParameterList};
    use proptest::prelude::*;

    const NOW: Duration = Duration::ZERO;

    /// The PLC has the line, as `MP5030.2` says.
    fn line(blockwise: bool) -> (PlcLine, Settings) {
        let mut list = ParameterList::reference(ControlModel::Tnc425);
        list.set(5030, 2, f64::from(u8::from(blockwise))).unwrap();
        let settings = Settings::of_plc(&list);
        let mut line = PlcLine::default();
        line.assign(Some(settings));
        (line, settings)
    }

    fn come(line: &mut PlcLine, bytes: &[u8]) -> Vec<LineEvent> {
        bytes.iter().for_each(|byte| line.receive(*byte));
        std::iter::from_fn(|| line.event()).collect()
    }

    fn sent(line: &mut PlcLine) -> Vec<u8> {
        let mut bytes = Vec::new();
        while line.has_output() {
            line.send(3, NOW, &mut bytes);
        }
        bytes
    }

    fn received(text: &str) -> LineEvent {
        LineEvent::Received(text.into())
    }

    #[test]
    fn a_text_is_a_line() {
        let (mut plc, _) = line(false);
        plc.transmit(b"PALLET 7");
        assert_eq!(sent(&mut plc), b"PALLET 7\r\n");
        assert_eq!(come(&mut plc, b""), [LineEvent::Sent]);
        // The other side is stopped until the PLC has taken what has come.
        assert_eq!(come(&mut plc, b"\0READY\r\n"), [received("READY")]);
        assert_eq!(sent(&mut plc), [DC3]);
        assert_eq!(come(&mut plc, b"NEXT\n"), []);
        plc.taken();
        assert_eq!(come(&mut plc, b""), [received("NEXT")]);
        plc.taken();
        assert_eq!(sent(&mut plc), [DC1]);
        assert_eq!(come(&mut plc, b"\r\n\x03"), [LineEvent::EndOfText]);
        assert_eq!(come(&mut plc, &[b'A'; 200]), []);
        assert_eq!(come(&mut plc, b"\n"), [LineEvent::Faulty]);
        // The other side may stop this one.
        plc.transmit(b"A");
        come(&mut plc, &[DC3]);
        assert_eq!(sent(&mut plc), b"");
        come(&mut plc, &[DC1]);
        assert_eq!(sent(&mut plc), b"A\r\n");
    }

    #[test]
    fn a_text_is_a_block_that_is_acknowledged() {
        let (mut plc, settings) = line(true);
        let block = encode(&settings, Kind::Text, b"FA81");
        plc.transmit(b"FA81");
        assert_eq!(sent(&mut plc), block);
        for _ in 0..2 {
            assert_eq!(come(&mut plc, &[settings.control.nak]), []);
            assert_eq!(sent(&mut plc), block);
        }
        assert_eq!(come(&mut plc, &[settings.control.ack]), [LineEvent::Sent]);
        plc.transmit(b"FA81");
        for _ in 0..3 {
            assert_eq!(sent(&mut plc), block);
            come(&mut plc, &[settings.control.nak]);
        }
        assert_eq!(sent(&mut plc), b"");
        plc.transmit(b"FA81");
        sent(&mut plc);
        plc.clock(settings.patience);
        assert_eq!(come(&mut plc, b""), [LineEvent::NotSent; 1]);

        assert_eq!(come(&mut plc, &block), [received("FA81")]);
        assert_eq!(sent(&mut plc), [settings.control.ack]);
        // The second one is acknowledged when the PLC has taken the first.
        assert_eq!(come(&mut plc, &block), []);
        assert_eq!(sent(&mut plc), b"");
        plc.taken();
        assert_eq!(sent(&mut plc), [settings.control.ack]);
    }

    #[test]
    fn damaged_blocks_come_again_twice() {
        let (mut plc, settings) = line(true);
        let mut damaged = encode(&settings, Kind::Text, b"FA81");
        damaged[2] ^= 1;
        for expected in [settings.control.nak, settings.control.nak, settings.control.eot] {
            let events = come(&mut plc, &damaged);
            assert_eq!(
                events.contains(&LineEvent::Faulty),
                expected == settings.control.eot
            );
            assert_eq!(sent(&mut plc), [expected]);
        }
    }

    #[test]
    fn nothing_goes_over_a_line_that_the_plc_has_not_got() {
        let mut plc = PlcLine::default();
        assert_eq!(come(&mut plc, b"READY\n"), []);
        plc.transmit(b"A");
        assert_eq!(
            (come(&mut plc, b""), plc.has_output()),
            (vec![LineEvent::NotSent], false)
        );
        let (mut plc, _) = line(true);
        plc.transmit(b"A");
        plc.unplugged();
        assert_eq!(
            (come(&mut plc, b""), plc.has_output()),
            (vec![LineEvent::NotSent], false)
        );
    }

    proptest! {
        /// Noise leaves nothing that grows, and a text gets through when it is over.
        #[test]
        fn noise_ends(noise in prop::collection::vec(any::<u8>(), 0..400), blockwise: bool) {
            let (mut plc, settings) = line(blockwise);
            for event in come(&mut plc, &noise) {
                if let LineEvent::Received(text) = event {
                    prop_assert!(text.len() <= TEXT_MAX);
                }
            }
            plc.assign(Some(settings));
            let text = match blockwise {
                true => encode(&settings, Kind::Text, b"OK"),
                false => b"OK\n".to_vec(),
            };
            prop_assert_eq!(come(&mut plc, &text), [received("OK")]);
        }
    }
}
