//! The device of the standard protocol: a tape, a personal computer, and a control that obeys.

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::items::{Item, Items};
use super::{HELD_MAX, Outgoing};
use crate::blockwise::Rights;
use crate::files::Files;
use crate::protocol::{Ended, Event, Protocol, Question, Shown};
use crate::settings::Settings;
use crate::text::{Source, Taking, Unstored, beginning};
use crate::{DC1, DC3, FileType};

/// The device. DC1 is answered with all programs and one ETX; text up to ETX is stored under the names of its BEGIN lines.
pub struct Peripheral {
    settings: Settings,
    files: Box<dyn Files>,
    rights: Rights,
    items: Items,
    outgoing: Outgoing,
    /// What is still to be sent.
    names: VecDeque<String>,
    /// Everything was sent, and EOT has not come: a further DC1 gets ETX alone.
    sent: bool,
    taking: Option<Taking>,
    /// Something of a text has come.
    text: bool,
    question: Option<(String, Vec<u8>)>,
    held: VecDeque<u8>,
    failed: bool,
    /// A text has ended with ETX, and nothing has come since then: who waits for EOT gets it at this time.
    etx: Option<Duration>,
    now: Duration,
    events: VecDeque<Event>,
}

impl Peripheral {
    /// A device that waits for what the other side wants.
    pub fn new(settings: Settings, files: Box<dyn Files>, rights: Rights) -> Peripheral {
        Peripheral {
            settings,
            files,
            rights,
            items: Items::default(),
            outgoing: Outgoing::new(),
            names: VecDeque::new(),
            sent: false,
            taking: None,
            text: false,
            question: None,
            held: VecDeque::new(),
            failed: false,
            etx: None,
            now: Duration::ZERO,
            events: VecDeque::new(),
        }
    }

    fn is_sending(&self) -> bool {
        self.outgoing.source.is_some() || !self.names.is_empty()
    }

    fn item(&mut self, item: Item) {
        match item {
            Item::Dc3 => self.outgoing.stopped = true,
            Item::Dc1 if self.outgoing.stopped || self.is_sending() => self.outgoing.stopped = false,
            Item::Dc1 => self.start(),
            Item::Line(line) => self.line(&line),
            Item::Etx => self.end_of_text(),
            Item::Eot => self.eot(),
            Item::Enquiry if !self.is_sending() && !self.text => self.events.push_back(Event::Enquiry),
            Item::Error(shown) => self.fail(shown),
            Item::Enquiry => {}
        }
    }

    /// DC1: everything is sent.
    fn start(&mut self) {
        if !self.rights.gives {
            return;
        }
        if self.sent {
            self.outgoing.bytes.push_back(self.settings.control.etx);
            return;
        }
        let mut files: Vec<String> = self.files.list().into_iter().map(|file| file.name).collect();
        files.sort_by_cached_key(|name| name.to_ascii_uppercase());
        let is_program = |name: &String| {
            let kind = name
                .rsplit_once('.')
                .and_then(|(_, of)| FileType::of_extension(of));
            kind.is_some_and(FileType::is_program)
        };
        let only = &self.rights.only;
        self.names = files
            .into_iter()
            .filter(|name| match only.is_empty() {
                true => is_program(name),
                false => only.iter().any(|only| only.eq_ignore_ascii_case(name)),
            })
            .collect();
        self.next_file();
    }

    fn next_file(&mut self) {
        while let Some(name) = self.names.front() {
            if let Ok(file) = self.files.open(name) {
                let source = Source::new(file, self.settings.characters, self.settings.decimal_comma);
                self.outgoing.begin(source);
                return;
            }
            self.names.pop_front();
        }
        self.outgoing.bytes.push_back(self.settings.control.etx);
        self.sent = !self.settings.never_eot;
        self.events.push_back(Event::Ended(Ended::Complete));
    }

    fn refill(&mut self) {
        if self.outgoing.source.is_none() {
            return;
        }
        match self.outgoing.refill() {
            Ok(false) => {}
            Ok(true) => {
                self.events.extend(self.names.pop_front().map(Event::Sent));
                self.next_file();
            }
            Err(error) => self.fail(Shown::Device(error.to_string())),
        }
    }

    fn line(&mut self, line: &[u8]) {
        if !self.rights.takes {
            return;
        }
        self.text |= !line.is_empty();
        if let Some(begins) = beginning(line) {
            self.close_file();
            let kind = begins.kind.or(FileType::of_extension("H"));
            let name = format!("{}.{}", begins.name, kind.map_or("H", FileType::extension));
            return self.begin(name, line);
        }
        let Some(taking) = &mut self.taking else {
            return;
        };
        match taking.line(line) {
            Ok(()) if taking.is_ended() => self.close_file(),
            Ok(()) => {}
            Err(error) => self.unstored(&error),
        }
    }

    fn begin(&mut self, name: String, line: &[u8]) {
        match self.files.find(&name) {
            Some(found) if found.protected => self.fail(Shown::Control(MessageId::ProtectedPgm, None)),
            Some(_) if self.rights.asks => {
                self.events
                    .push_back(Event::Question(Question::Overread(name.clone())));
                self.question = Some((name, line.to_vec()));
                if !self.settings.stop_by_rts {
                    self.outgoing.bytes.push_back(DC3);
                }
            }
            _ => self.create(&name, line),
        }
    }

    fn create(&mut self, name: &str, line: &[u8]) {
        let file = self.files.create(name).map_err(Unstored::Store);
        let taking = file.and_then(|file| {
            let mut taking = Taking::new(name, file);
            taking.line(line).map(|()| taking)
        });
        match taking {
            Ok(taking) => self.taking = Some(taking),
            Err(error) => self.unstored(&error),
        }
    }

    fn close_file(&mut self) {
        if let Some(taking) = self.taking.take() {
            let name = taking.name.clone();
            match taking.commit() {
                Ok(()) => self.events.push_back(Event::Received(name)),
                Err(error) => self.unstored(&error),
            }
        }
    }

    fn end_of_text(&mut self) {
        if let Some(line) = self.items.rest() {
            self.line(&line);
        }
        if self.question.is_some() {
            self.held.push_front(self.settings.control.etx);
            return;
        }
        self.close_file();
        if std::mem::take(&mut self.text) {
            self.events
                .push_back(Event::Ended(Ended::unless(std::mem::take(&mut self.failed))));
            if !self.settings.never_eot {
                self.etx = Some(self.now + self.settings.moment());
            }
        }
    }

    fn eot(&mut self) {
        let sending = self.is_sending();
        let receiving = self.text || self.items.is_inside();
        self.sent = false;
        if sending {
            self.outgoing.clear();
            self.names.clear();
            self.incomplete();
        } else if receiving {
            // EOT without ETX ends a text whose programs are whole.
            self.end_of_text();
            self.etx = None;
        }
    }

    fn unstored(&mut self, error: &Unstored) {
        self.fail(match error {
            Unstored::Incomplete => Shown::Control(MessageId::ProgramIncomplete, None),
            Unstored::Store(error) => Shown::of_store(error),
        });
    }

    fn incomplete(&mut self) {
        self.taking = None;
        self.text = false;
        self.failed = false;
        self.events
            .push_back(Event::Message(Shown::Control(MessageId::ProgramIncomplete, None)));
        self.events.push_back(Event::Ended(Ended::Incomplete));
    }

    /// What is wrong with one program; others of the text are stored all the same.
    fn fail(&mut self, shown: Shown) {
        self.taking = None;
        self.failed = true;
        self.events.push_back(Event::Message(shown));
    }

    fn take(&mut self, byte: u8) {
        if let Some(item) = self.items.take(&self.settings, byte) {
            self.item(item);
        }
    }
}

impl Protocol for Peripheral {
    fn receive(&mut self, byte: u8, now: Duration) {
        self.now = now;
        self.etx = None;
        if self.question.is_none() {
            self.take(byte);
        } else if self.held.len() < HELD_MAX {
            self.held.push_back(byte);
        } else {
            self.question = None;
            self.held.clear();
            self.incomplete();
        }
    }

    /// A control ends what it sends with ETX EOT; ETX alone is the end of a device, which a control answers EOT
    /// [000:17321-17323]. So public senders wait for it.
    fn clock(&mut self, now: Duration) {
        self.now = now;
        if self.etx.take_if(|time| now >= *time).is_some() {
            self.outgoing.bytes.push_back(self.settings.control.eot);
        }
    }

    fn deadline(&self) -> Option<Duration> {
        self.etx
    }

    fn has_output(&self) -> bool {
        self.outgoing.has_output()
    }

    fn send(&mut self, room: usize, _now: Duration, into: &mut Vec<u8>) {
        self.outgoing.take(room, into);
        if self.outgoing.bytes.is_empty() {
            self.refill();
        }
    }

    fn unplugged(&mut self, _now: Duration) {
        self.etx = None;
        let open = self.taking.is_some() || self.question.is_some() || self.items.is_inside();
        let busy = self.is_sending() || open || self.text;
        self.outgoing.clear();
        self.names.clear();
        self.held.clear();
        self.items = Items::default();
        self.question = None;
        self.sent = false;
        if busy {
            self.incomplete();
        }
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, yes: bool, now: Duration) {
        self.now = now;
        let Some((name, line)) = self.question.take() else {
            return;
        };
        if yes {
            self.create(&name, &line);
        } else {
            self.fail(Shown::Control(MessageId::EraseOverread, None));
        }
        if !self.settings.stop_by_rts {
            self.outgoing.bytes.push_back(DC1);
        }
        while self.question.is_none()
            && let Some(byte) = self.held.pop_front()
        {
            self.take(byte);
        }
    }

    fn end(&mut self, now: Duration) {
        self.unplugged(now);
    }

    fn is_idle(&self) -> bool {
        !self.is_sending() && !self.text && self.outgoing.bytes.is_empty() && self.question.is_none()
    }

    fn has_stopped_by_rts(&self) -> bool {
        self.settings.stop_by_rts && self.question.is_some()
    }
}
