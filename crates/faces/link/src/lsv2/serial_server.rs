//! A device on a serial line: the line and one session, without a line and without a clock of its own.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use super::machine_commands::from_plc;
use super::{LineEvent, SerialLine, Session, Side, Site, Telegram};

/// A device that answers on a serial line.
pub struct SerialServer {
    line: SerialLine,
    site: Arc<Site>,
    session: Session,
    answers: VecDeque<Telegram>,
}

impl SerialServer {
    /// A device on a line that is idle.
    pub fn new(site: &Arc<Site>) -> SerialServer {
        SerialServer {
            line: SerialLine::new(Side::Control),
            site: Arc::clone(site),
            session: Session::new(site),
            answers: VecDeque::new(),
        }
    }

    /// A byte has arrived.
    pub fn byte(&mut self, byte: u8, now: Duration) {
        self.line.byte(byte, now);
        self.follow(now);
    }

    /// Advances the clock: what was awaited for too long is repeated or given up.
    pub fn tick(&mut self, now: Duration) {
        self.line.tick(now);
        if self.line.is_idle()
            && self.answers.is_empty()
            && self.session.takes_messages()
            && let Some(message) = self.site.device.plc_message()
        {
            self.answers.push_back(from_plc(&message));
        }
        self.follow(now);
    }

    /// What is to be sent.
    pub fn take_output(&mut self) -> Vec<u8> {
        self.line.take_output()
    }

    /// Nothing is in transit: the line may be another protocol's.
    pub fn is_idle(&self) -> bool {
        self.line.is_idle() && self.answers.is_empty()
    }

    /// The line was cut: logins end, what was half written is gone.
    pub fn reset(&mut self) {
        *self = SerialServer::new(&Arc::clone(&self.site));
    }

    fn follow(&mut self, now: Duration) {
        while let Some(event) = self.line.event() {
            match event {
                LineEvent::Received(telegram) => self.answers.extend(self.session.take(&telegram)),
                LineEvent::Sent => {}
                // Nobody is there any more.
                LineEvent::Failed(_) => {
                    self.session = Session::new(&self.site);
                    self.answers.clear();
                }
            }
        }
        if self.line.is_idle()
            && let Some(answer) = self.answers.pop_front()
        {
            self.line.send(&answer, now);
        }
    }
}
