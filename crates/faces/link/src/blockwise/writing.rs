//! The control sends files [000:17476-17483] [001:2140-2153].

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::link::Link;
use crate::FileType;
use crate::files::Files;
use crate::frame::{Kind, Piece};
use crate::protocol::{Ended, Event, Protocol, Question, Shown};
use crate::settings::Settings;
use crate::text::{Source, is_name};
use bahn_store::StoreError;

/// So many times its patience the control waits for a DC1 *(inferred)*.
const HELD: u32 = 10;

/// In this part of its patience a device says that it cannot store what was sent *(inferred)*.
const LEAVING_PART: u32 = 8;

enum Step {
    /// The operator is asked whether the next file goes.
    Question,
    /// The header waits for its answer.
    Offered(Source),
    /// A line waits for its answer.
    Block(Source),
    /// Everything has gone: the device may say that it cannot store it.
    Leaving,
    Over,
}

/// The control as it sends.
pub struct Writing {
    link: Link,
    files: Box<dyn Files>,
    names: VecDeque<String>,
    /// Each file after a question.
    confirmed: bool,
    step: Step,
    /// Stopped by DC3, and since when.
    stopped: bool,
    stopped_at: Duration,
    events: VecDeque<Event>,
}

impl Writing {
    /// Sends files; each after a question when it is to be confirmed.
    pub fn new(settings: Settings, files: Box<dyn Files>, names: Vec<String>, confirmed: bool) -> Writing {
        let mut writing = Writing {
            link: Link::new(settings),
            files,
            names: names.into(),
            confirmed,
            step: Step::Over,
            stopped: false,
            stopped_at: Duration::ZERO,
            events: VecDeque::new(),
        };
        writing.next_file();
        writing
    }

    fn next_file(&mut self) {
        match self.names.front().cloned() {
            None => self.step = Step::Leaving,
            Some(name) if self.confirmed => {
                self.events.push_back(Event::Question(Question::Output(name)));
                self.step = Step::Question;
            }
            Some(name) => self.offer(&name),
        }
    }

    fn offer(&mut self, name: &str) {
        let settings = self.link.settings;
        let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
        let opened = match is_name(stem.as_bytes()) {
            true => self.files.open(name),
            // A header has no room for another one [000:17482].
            false => Err(StoreError::BadName(name.to_owned())),
        };
        match opened {
            Ok(file) => {
                let of_type = FileType::of_extension(extension).map_or(b'A', |kind| kind.code() as u8);
                let mut header = vec![settings.control.output_type.unwrap_or(of_type)];
                header.extend(stem.to_ascii_uppercase().bytes());
                header.push(settings.control.output);
                self.link.send_block(Kind::Header, &header);
                self.step = Step::Offered(Source::new(file, settings.characters, settings.decimal_comma));
            }
            Err(error) => self.fail(Shown::of_store(&error)),
        }
    }

    /// Sends the next line, or the end of the file.
    fn next_line(&mut self, mut source: Source) {
        match source.next() {
            Ok(Some(line)) => {
                self.link.send_block(Kind::Text, &line);
                self.step = Step::Block(source);
            }
            Ok(None) => {
                let control = self.link.settings.control;
                self.link.send(&[control.etx, control.eot]);
                self.events.extend(self.names.pop_front().map(Event::Sent));
                self.next_file();
            }
            Err(error) => self.abort(Shown::Device(error.to_string())),
        }
    }

    fn piece(&mut self, piece: Piece, now: Duration) {
        let step = std::mem::replace(&mut self.step, Step::Over);
        match (step, piece) {
            (Step::Offered(source) | Step::Block(source), Piece::Ack) => self.next_line(source),
            (step @ (Step::Offered(_) | Step::Block(_)), Piece::Nak) => {
                self.step = step;
                if !self.link.repeat() {
                    let has_codes = self.link.settings.model.has_transfer_codes();
                    self.abort(match has_codes {
                        true => Shown::Control(MessageId::TransferredDataIncorrect, Some('E')),
                        false => Shown::Control(MessageId::ProgramIncomplete, None),
                    });
                }
            }
            (Step::Offered(_) | Step::Block(_) | Step::Leaving, Piece::Block(Kind::Header, text)) => {
                self.link.acknowledge();
                self.link.send(&[self.link.settings.control.eot]);
                let text = String::from_utf8_lossy(&text).trim().to_owned();
                self.fail(Shown::Device(text));
            }
            (Step::Offered(_) | Step::Block(_), Piece::Eot) => {
                self.fail(Shown::Control(MessageId::ProgramIncomplete, None));
            }
            (step @ (Step::Offered(_) | Step::Block(_)), piece) => {
                self.step = step;
                match piece {
                    Piece::Other(crate::DC3) => (self.stopped, self.stopped_at) = (true, now),
                    Piece::Other(crate::DC1) => self.stopped = false,
                    // An error of the device that has come damaged.
                    Piece::Wrong => self.link.send(&[self.link.settings.control.nak]),
                    _ => {}
                }
            }
            (step, _) => self.step = step,
        }
    }

    /// The end, with everything sent.
    fn complete(&mut self) {
        self.step = Step::Over;
        self.events.push_back(Event::Ended(Ended::Complete));
    }

    /// The end, by an error: EOT tells the device [000:17424].
    fn abort(&mut self, shown: Shown) {
        self.link.clear();
        self.link.send(&[self.link.settings.control.eot]);
        self.fail(shown);
    }

    fn fail(&mut self, shown: Shown) {
        self.step = Step::Over;
        self.stopped = false;
        self.events.push_back(Event::Message(shown));
        self.events.push_back(Event::Ended(Ended::Incomplete));
    }
}

impl Protocol for Writing {
    fn receive(&mut self, byte: u8, now: Duration) {
        if let Some(piece) = self.link.receive(byte, now) {
            self.piece(piece, now);
        }
    }

    fn clock(&mut self, now: Duration) {
        if self.deadline().is_some_and(|deadline| now >= deadline) {
            if self.link.is_inside() {
                self.link.give_block_up(now);
            } else if matches!(self.step, Step::Leaving) {
                self.complete();
            } else {
                self.abort(Shown::Control(MessageId::TransferredDataIncorrect, Some('N')));
            }
        }
    }

    fn deadline(&self) -> Option<Duration> {
        match self.step {
            Step::Offered(_) | Step::Block(_) if self.stopped => {
                Some(self.stopped_at + self.link.settings.patience * HELD)
            }
            Step::Offered(_) | Step::Block(_) if self.link.is_inside() => {
                self.link.quiet_for(self.link.gap())
            }
            Step::Offered(_) | Step::Block(_) => self.link.quiet_for(self.link.settings.patience),
            Step::Leaving => self.link.quiet_for(self.link.settings.patience / LEAVING_PART),
            Step::Question | Step::Over => None,
        }
    }

    fn has_output(&self) -> bool {
        !self.stopped && self.link.has_output()
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        if !self.stopped {
            self.link.take(room, now, into);
        }
    }

    fn unplugged(&mut self, _now: Duration) {
        self.link.clear();
        if matches!(self.step, Step::Leaving) {
            self.complete();
        } else if !matches!(self.step, Step::Over) {
            self.fail(Shown::Control(MessageId::ProgramIncomplete, None));
        }
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, yes: bool, _now: Duration) {
        if !matches!(self.step, Step::Question) {
            return;
        }
        match self.names.front().cloned() {
            Some(name) if yes => self.offer(&name),
            // The next one in the directory is offered at once [000:17483].
            _ => {
                self.names.pop_front();
                self.next_file();
            }
        }
    }

    fn end(&mut self, _now: Duration) {
        match self.step {
            Step::Over => {}
            Step::Leaving => self.complete(),
            // Between two files the menu is left.
            Step::Question => {
                self.names.clear();
                self.next_file();
            }
            _ => self.abort(Shown::Control(MessageId::ProgramIncomplete, None)),
        }
    }

    fn is_idle(&self) -> bool {
        matches!(self.step, Step::Over)
    }
}
