//! A port that the PLC may have: while it has it, its texts go over the line, otherwise what the port is for.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bahn_control::LineEvent;

use crate::plc_line::PlcLine;
use crate::protocol::{Event, Protocol};
use crate::settings::Settings;

/// How often one looks for texts of the PLC.
const LOOK: Duration = Duration::from_millis(5);
/// Events that wait to be taken; more than that are of a line that nobody follows.
const EVENTS_MAX: usize = 1024;

/// The PLC's hold on a port: orders of the control go in, events for it come out. Clones are the same one.
#[derive(Clone, Debug, Default)]
pub struct PlcHold(Arc<Mutex<Held>>);

#[derive(Debug, Default)]
struct Held {
    line: PlcLine,
    assigned: bool,
    events: Vec<LineEvent>,
}

impl PlcHold {
    /// The PLC has got the port with these settings, or has given it back.
    pub fn assign(&self, settings: Option<Settings>) {
        let mut held = self.held();
        held.assigned = settings.is_some();
        held.line.assign(settings);
    }

    /// The PLC wants a text to be sent.
    pub fn transmit(&self, text: &[u8]) {
        self.held().line.transmit(text);
    }

    /// The PLC has taken a text.
    pub fn taken(&self) {
        self.held().line.taken();
    }

    /// What the control is to be told.
    pub fn take_events(&self) -> Vec<LineEvent> {
        let mut held = self.held();
        let mut events = std::mem::take(&mut held.events);
        events.extend(std::iter::from_fn(|| held.line.event()));
        events
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, event: LineEvent) {
        let mut held = self.held();
        if held.events.len() < EVENTS_MAX {
            held.events.push(event);
        }
    }
}

/// A port and what it is for while the PLC has not got it.
pub struct SharedPort {
    hold: PlcHold,
    other: Box<dyn Protocol>,
    /// The PLC had it when somebody looked last.
    was_assigned: bool,
    /// The other one is in the middle of something, as the control knows.
    taken: bool,
}

impl SharedPort {
    /// A port.
    pub fn new(hold: PlcHold, other: Box<dyn Protocol>) -> SharedPort {
        SharedPort {
            hold,
            other,
            was_assigned: false,
            taken: false,
        }
    }

    /// Whether the PLC has it. What the other one was in the middle of ends as if the cable were pulled.
    fn is_plc(&mut self, now: Duration) -> bool {
        let assigned = self.hold.held().assigned;
        if assigned && !self.was_assigned {
            self.other.unplugged(now);
        }
        self.was_assigned = assigned;
        assigned
    }

    /// The control knows whether a transfer has the line.
    fn look(&mut self) {
        let taken = !self.was_assigned && !self.other.is_idle();
        if taken != self.taken {
            self.taken = taken;
            self.hold.tell(LineEvent::Taken(taken));
        }
    }
}

impl Protocol for SharedPort {
    fn receive(&mut self, byte: u8, now: Duration) {
        if self.is_plc(now) {
            self.hold.held().line.receive(byte);
        } else {
            self.other.receive(byte, now);
        }
    }

    fn clock(&mut self, now: Duration) {
        if self.is_plc(now) {
            self.hold.held().line.clock(now);
        } else {
            self.other.clock(now);
        }
        self.look();
    }

    fn deadline(&self) -> Option<Duration> {
        match self.was_assigned {
            true => self.hold.held().line.deadline(),
            false => self.other.deadline(),
        }
    }

    fn patience(&self) -> Option<Duration> {
        Some(LOOK)
    }

    fn has_output(&self) -> bool {
        match self.was_assigned {
            true => self.hold.held().line.has_output(),
            false => self.other.has_output(),
        }
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        match self.was_assigned {
            true => self.hold.held().line.send(room, now, into),
            false => self.other.send(room, now, into),
        }
    }

    fn plugged(&mut self, now: Duration) {
        self.hold.tell(LineEvent::Ready(true));
        self.other.plugged(now);
    }

    fn unplugged(&mut self, now: Duration) {
        self.hold.tell(LineEvent::Ready(false));
        if self.was_assigned {
            self.hold.held().line.unplugged();
        }
        self.other.unplugged(now);
        self.look();
    }

    fn event(&mut self) -> Option<Event> {
        self.other.event()
    }

    fn answer(&mut self, yes: bool, now: Duration) {
        self.other.answer(yes, now);
    }

    fn end(&mut self, now: Duration) {
        self.other.end(now);
    }

    fn is_idle(&self) -> bool {
        self.other.is_idle()
    }

    fn is_transparent(&self) -> bool {
        !self.was_assigned && self.other.is_transparent()
    }

    fn hold(&mut self, on: bool) {
        self.other.hold(on);
    }

    fn has_stopped_by_rts(&self) -> bool {
        match self.was_assigned {
            true => self.hold.held().line.has_stopped_by_rts(),
            false => self.other.has_stopped_by_rts(),
        }
    }
}
