//! A port that the PLC may have: while it has it, its texts go over the line, otherwise what the port is for.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bahn_tnc::{LineEvent, Switch};

use crate::plc_line::PlcLine;
use crate::protocol::{Event, Protocol};
use crate::settings::Settings;
use crate::{DC1, DC3};

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
    /// What is to be printed while nobody else needs the line.
    print: VecDeque<u8>,
}

impl PlcHold {
    /// The PLC has got the port with these settings, or has given it back.
    pub fn assign(&self, settings: Option<Settings>) {
        let mut held = self.held();
        held.assigned = settings.is_some();
        held.line.assign(settings);
    }

    /// Whether the PLC has the port.
    pub fn is_assigned(&self) -> bool {
        self.held().assigned
    }

    /// The PLC wants a text to be sent.
    pub fn transmit(&self, text: &[u8]) {
        self.held().line.transmit(text);
    }

    /// The PLC has taken a text.
    pub fn taken(&self) {
        self.held().line.taken();
    }

    /// A line is printed as soon as neither the PLC nor a transfer has the port; `false` when too much waits already.
    pub fn print(&self, line: &str) -> bool {
        let mut held = self.held();
        let fits = held.print.len() + line.len() + 2 <= PRINT_MAX;
        if fits {
            held.print.extend(line.bytes().chain(*b"\r\n"));
        }
        fits
    }

    /// What the control is to get.
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

/// Bytes that wait to be printed at most *(inferred)*.
const PRINT_MAX: usize = 1 << 16;

/// A port and what it is for while the PLC has not got it.
pub struct SharedPort {
    hold: PlcHold,
    other: Box<dyn Protocol>,
    /// The PLC had it when somebody looked last.
    was_assigned: bool,
    /// The other one is in the middle of something, as the control knows.
    taken: bool,
    /// The printer has stopped what is printed.
    stopped: bool,
}

impl SharedPort {
    /// A port that a PLC shares with another protocol.
    pub fn new(hold: PlcHold, other: Box<dyn Protocol>) -> SharedPort {
        SharedPort {
            hold,
            other,
            was_assigned: false,
            taken: false,
            stopped: false,
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

    /// Something is to be printed, and nobody else needs the line.
    fn prints(&self) -> bool {
        let waits = || !self.hold.held().print.is_empty();
        !self.was_assigned && !self.stopped && self.other.is_idle() && !self.other.has_output() && waits()
    }

    /// The control knows whether a transfer has the line.
    fn look(&mut self) {
        let taken = !self.was_assigned && !self.other.is_idle();
        if taken != self.taken {
            self.taken = taken;
            self.hold.tell(LineEvent::Taken(Switch::from(taken)));
        }
    }
}

impl Protocol for SharedPort {
    fn receive(&mut self, byte: u8, now: Duration) {
        if self.is_plc(now) {
            return self.hold.held().line.receive(byte);
        }
        // A printer that is full says so.
        let prints = self.other.is_idle() && !self.hold.held().print.is_empty();
        match byte {
            DC3 if prints => self.stopped = true,
            DC1 if prints || self.stopped => self.stopped = false,
            _ => self.other.receive(byte, now),
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
            false => self.other.has_output() || self.prints(),
        }
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        match self.was_assigned {
            true => self.hold.held().line.send(room, now, into),
            false if self.prints() => {
                let mut held = self.hold.held();
                let count = room.min(held.print.len());
                into.extend(held.print.drain(..count));
            }
            false => self.other.send(room, now, into),
        }
    }

    fn plugged(&mut self, now: Duration) {
        self.hold.tell(LineEvent::Ready(Switch::On));
        self.other.plugged(now);
    }

    fn unplugged(&mut self, now: Duration) {
        self.hold.tell(LineEvent::Ready(Switch::Off));
        self.stopped = false;
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::PrintOut;
    use bahn_parameters::{ControlModel, ParameterList};

    const NOW: Duration = Duration::ZERO;

    fn sent(port: &mut SharedPort) -> Vec<u8> {
        port.clock(NOW);
        let mut bytes = Vec::new();
        while port.has_output() {
            port.send(4, NOW, &mut bytes);
        }
        bytes
    }

    /// The other one is a transfer of three bytes; the PLC has the port after it, then what was printed meanwhile goes out.
    #[test]
    fn one_after_the_other_has_the_port() {
        let hold = PlcHold::default();
        let mut port = SharedPort::new(hold.clone(), Box::new(PrintOut::new(b"ABC".to_vec())));
        port.plugged(NOW);
        assert!(hold.print("Q5 +20.25"));
        port.clock(NOW);
        assert_eq!(
            hold.take_events(),
            [LineEvent::Ready(Switch::On), LineEvent::Taken(Switch::On)]
        );
        let mut first = Vec::new();
        port.send(3, NOW, &mut first);
        assert_eq!(first, b"ABC");
        port.clock(NOW);
        assert_eq!(hold.take_events(), [LineEvent::Taken(Switch::Off)]);

        let list = ParameterList::reference(ControlModel::Tnc425);
        hold.assign(Some(Settings::of_plc(&list)));
        hold.transmit(b"PALLET");
        assert_eq!(sent(&mut port), b"PALLET\r\n");
        assert_eq!(hold.take_events(), [LineEvent::Sent]);
        hold.assign(None);
        port.receive(DC3, NOW);
        assert_eq!(sent(&mut port), b"", "the printer is full");
        port.receive(DC1, NOW);
        assert_eq!(sent(&mut port), b"Q5 +20.25\r\n");
        let long = "X".repeat(PRINT_MAX);
        assert!(!hold.print(&long));
        port.unplugged(NOW);
        assert_eq!(hold.take_events(), [LineEvent::Ready(Switch::Off)]);
    }
}
