//! The control sends by the standard protocol [000:17277-17286].

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::items::{Item, Items};
use super::{Outgoing, end_of_output};
use crate::files::Files;
use crate::protocol::{Ended, Event, Protocol, Question, Shown};
use crate::settings::Settings;
use crate::text::Source;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// The operator is asked whether the next file goes.
    Question,
    /// The lines of a file are sent.
    File,
    /// The end of a file is sent.
    End,
    Over,
}

/// The control as it sends.
pub struct Writing {
    settings: Settings,
    files: Box<dyn Files>,
    names: VecDeque<String>,
    /// Each file after a question.
    confirmed: bool,
    items: Items,
    outgoing: Outgoing,
    step: Step,
    events: VecDeque<Event>,
}

impl Writing {
    /// Sends files one after the other, without anything between them [000:17281]; each after a question when it is to be
    /// confirmed.
    pub fn new(settings: Settings, files: Box<dyn Files>, names: Vec<String>, confirmed: bool) -> Writing {
        let mut writing = Writing {
            settings,
            files,
            names: names.into(),
            confirmed,
            items: Items::default(),
            outgoing: Outgoing::new(),
            step: Step::File,
            events: VecDeque::new(),
        };
        writing.next_file();
        writing
    }

    fn next_file(&mut self) {
        match self.names.front().cloned() {
            None => {
                self.outgoing.bytes.extend(end_of_output(&self.settings));
                self.step = Step::End;
            }
            Some(name) if self.confirmed => {
                self.events.push_back(Event::Question(Question::Output(name)));
                self.step = Step::Question;
            }
            Some(name) => self.begin(&name),
        }
    }

    fn begin(&mut self, name: &str) {
        match self.files.open(name) {
            Ok(file) => {
                let source = Source::new(file, self.settings.characters, self.settings.decimal_comma);
                self.outgoing.begin(source);
                self.step = Step::File;
            }
            Err(error) => self.fail(Shown::of_store(&error)),
        }
    }

    fn refill(&mut self) {
        match self.outgoing.refill() {
            Ok(false) => {}
            Ok(true) => {
                self.events.extend(self.names.pop_front().map(Event::Sent));
                self.next_file();
            }
            Err(error) => self.fail(Shown::Device(error.to_string())),
        }
    }

    fn fail(&mut self, shown: Shown) {
        if self.step != Step::Over {
            self.outgoing.clear();
            self.step = Step::Over;
            self.events.push_back(Event::Message(shown));
            self.events.push_back(Event::Ended(Ended::Incomplete));
        }
    }
}

impl Protocol for Writing {
    fn receive(&mut self, byte: u8, _now: Duration) {
        match self.items.take(&self.settings, byte) {
            Some(Item::Dc3) => self.outgoing.stopped = true,
            Some(Item::Dc1) => self.outgoing.stopped = false,
            Some(Item::Error(shown)) => self.fail(shown),
            _ => {}
        }
    }

    fn clock(&mut self, _now: Duration) {}

    fn deadline(&self) -> Option<Duration> {
        None
    }

    fn has_output(&self) -> bool {
        self.outgoing.has_output()
    }

    fn send(&mut self, room: usize, _now: Duration, into: &mut Vec<u8>) {
        self.outgoing.take(room, into);
        if self.step == Step::File && self.outgoing.bytes.is_empty() {
            self.refill();
        }
        if self.step == Step::End && self.outgoing.bytes.is_empty() {
            self.step = Step::Over;
            self.events.push_back(Event::Ended(Ended::Complete));
        }
    }

    fn unplugged(&mut self, _now: Duration) {
        self.fail(Shown::Control(MessageId::ProgramIncomplete, None));
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, yes: bool, _now: Duration) {
        if self.step != Step::Question {
            return;
        }
        match self.names.front().cloned() {
            Some(name) if yes => self.begin(&name),
            _ => {
                self.names.pop_front();
                self.next_file();
            }
        }
    }

    fn end(&mut self, _now: Duration) {
        match self.step {
            // Between two files the menu is left.
            Step::Question => {
                self.names.clear();
                self.next_file();
            }
            Step::File => {
                self.fail(Shown::Control(MessageId::ProgramIncomplete, None));
                self.outgoing.bytes.extend(end_of_output(&self.settings));
            }
            Step::End | Step::Over => {}
        }
    }

    fn is_idle(&self) -> bool {
        self.step == Step::Over
    }
}
