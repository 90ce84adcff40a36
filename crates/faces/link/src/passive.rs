//! A port that obeys what arrives: a device of the transfer protocols, and LSV/2 between transfers.

use std::collections::VecDeque;
use std::time::Duration;

use crate::blockwise::{self, Rights};
use crate::files::Files;
use crate::lsv2::SerialServer;
use crate::protocol::{Event, Protocol};
use crate::settings::Settings;
use crate::standard;

/// How often LSV/2 is given the time while it has something to do.
const TICK: Duration = Duration::from_millis(50);

/// A device by the protocol of a port.
pub fn peripheral(settings: Settings, files: Box<dyn Files>, rights: Rights) -> Box<dyn Protocol> {
    match settings.blockwise {
        true => Box::new(blockwise::Peripheral::new(settings, files, rights)),
        false => Box::new(standard::Peripheral::new(settings, files, rights)),
    }
}

/// A device that speaks LSV/2, too: ENQ between transfers begins it [000:17514-17540].
pub struct Passive {
    device: Box<dyn Protocol>,
    lsv2: SerialServer,
    /// LSV/2 has the line.
    talks: bool,
    outgoing: VecDeque<u8>,
    ticked: Duration,
    events: VecDeque<Event>,
}

impl Passive {
    /// A port between transfers.
    pub fn new(device: Box<dyn Protocol>, lsv2: SerialServer) -> Passive {
        Passive {
            device,
            lsv2,
            talks: false,
            outgoing: VecDeque::new(),
            ticked: Duration::ZERO,
            events: VecDeque::new(),
        }
    }

    fn follow(&mut self) {
        self.outgoing.extend(self.lsv2.take_output());
        if !self.outgoing.is_empty() {
            self.talks = true;
        } else if self.talks && self.lsv2.is_idle() {
            self.talks = false;
        }
    }

    fn say(&mut self, byte: u8, now: Duration) {
        self.talks = true;
        self.lsv2.byte(byte, now);
        self.follow();
    }
}

impl Protocol for Passive {
    fn receive(&mut self, byte: u8, now: Duration) {
        if self.talks {
            return self.say(byte, now);
        }
        self.device.receive(byte, now);
        while let Some(event) = self.device.event() {
            match event {
                Event::Enquiry => self.say(ENQ, now),
                other => self.events.push_back(other),
            }
        }
    }

    fn clock(&mut self, now: Duration) {
        self.device.clock(now);
        if now >= self.ticked + TICK && (self.talks || self.device.is_idle()) {
            self.ticked = now;
            self.lsv2.tick(now);
            self.follow();
        }
    }

    fn deadline(&self) -> Option<Duration> {
        let tick = self.ticked + TICK;
        match self.device.deadline() {
            Some(deadline) if !self.talks => Some(deadline.min(tick)),
            _ => Some(tick),
        }
    }

    fn has_output(&self) -> bool {
        !self.outgoing.is_empty() || self.device.has_output()
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        if self.outgoing.is_empty() {
            return self.device.send(room, now, into);
        }
        into.extend(self.outgoing.drain(..room.min(self.outgoing.len())));
        self.follow();
    }

    fn unplugged(&mut self, now: Duration) {
        self.device.unplugged(now);
        self.lsv2.reset();
        self.outgoing.clear();
        self.talks = false;
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front().or_else(|| self.device.event())
    }

    fn answer(&mut self, yes: bool, now: Duration) {
        self.device.answer(yes, now);
    }

    fn end(&mut self, now: Duration) {
        self.device.end(now);
    }

    fn is_idle(&self) -> bool {
        !self.talks && self.device.is_idle()
    }

    fn has_stopped_by_rts(&self) -> bool {
        self.device.has_stopped_by_rts()
    }

    fn is_transparent(&self) -> bool {
        self.talks
    }
}

/// ENQ, with which LSV/2 begins.
const ENQ: u8 = 0x05;
