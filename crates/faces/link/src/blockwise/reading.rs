//! The control reads files in [000:17484-17512] [001:2092-2140].
//!
//! Decision: After END PGM and its ACK silence ends a file as ETX does, since everything is there and acknowledged;
//! after ETX without END PGM a moment is waited for more text, as ETX may have been a damaged STX

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::link::Link;
use crate::FileType;
use crate::files::Files;
use crate::frame::{Kind, Piece};
use crate::protocol::{Ended, Event, Protocol, Question, Shown};
use crate::settings::Settings;
use crate::text::{Taking, Unstored, beginning};

/// What the operator wants of the device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Want {
    /// READ-IN SELECTED PROGRAM: this file, with its extension.
    Selected(String),
    /// All files, READ-IN ALL PROGRAMS.
    All,
    /// READ-IN PROGRAM OFFERED: each after a question.
    Offered,
    /// PROGRAM DIRECTORY: only the names.
    Directory,
}

/// Within this part of its patience a device that ends its files with ETX has sent it *(inferred)*.
const ETX_PART: u32 = 4;

#[derive(Debug, PartialEq, Eq)]
enum Step {
    /// The header waits for its answer.
    Asked,
    /// A block is awaited.
    Block,
    /// The operator is asked; the block waits without an answer.
    Question(Question, Vec<u8>),
    /// ETX has come: an EOT may follow, or more of the text, when it was none.
    Etx,
    /// The transfer has ended.
    Over,
}

/// The control as it reads in.
pub struct Reading {
    link: Link,
    files: Box<dyn Files>,
    want: Want,
    kind: FileType,
    step: Step,
    taking: Option<Taking>,
    events: VecDeque<Event>,
    /// A message was shown.
    failed: bool,
    /// There is no room for more.
    holds: bool,
    /// Blocks that came and are not acknowledged: more than one when the line has doubled an acknowledgement.
    owes: u8,
}

impl Reading {
    /// Asks for files; without a name for those of a type.
    pub fn new(settings: Settings, files: Box<dyn Files>, want: Want, kind: FileType) -> Reading {
        let mut reading = Reading {
            link: Link::new(settings),
            files,
            want,
            kind,
            step: Step::Asked,
            taking: None,
            events: VecDeque::new(),
            failed: false,
            holds: false,
            owes: 0,
        };
        reading.ask();
        reading
    }

    /// Sends the header that asks for a file.
    fn ask(&mut self) {
        let control = self.link.settings.control;
        let (name, kind) = match &self.want {
            Want::Selected(name) => {
                let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
                (
                    stem.to_ascii_uppercase(),
                    FileType::of_extension(extension).unwrap_or(self.kind),
                )
            }
            Want::All | Want::Offered | Want::Directory => (String::new(), self.kind),
        };
        let mut header = vec![control.input_type.unwrap_or(kind.code() as u8)];
        header.extend(name.bytes());
        header.push(control.input);
        self.link.send_block(Kind::Header, &header);
        self.taking = None;
        self.step = Step::Asked;
    }

    fn is_selected(&self) -> bool {
        matches!(self.want, Want::Selected(_))
    }

    fn piece(&mut self, piece: Piece, now: Duration) {
        match (&self.step, piece) {
            (Step::Over | Step::Question(..), Piece::Block(Kind::Header, text)) => self.device(&text),
            (Step::Over | Step::Question(..), Piece::Eot) => self.eot(),
            (Step::Over | Step::Question(..), _) => {}
            (_, Piece::Block(Kind::Header, text)) => self.device(&text),
            (Step::Asked, Piece::Ack) => self.step = Step::Block,
            (Step::Asked, Piece::Nak) if self.link.repeat() => {}
            (Step::Asked, Piece::Nak) => {
                self.abort(Shown::Control(MessageId::TransferredDataIncorrect, Some('E')));
            }
            // The device has no more.
            (Step::Asked, Piece::Etx | Piece::Eot) if !self.is_selected() => self.finish(),
            (_, Piece::Block(Kind::Text, text)) => {
                self.step = Step::Block;
                self.line(text, now);
            }
            (_, Piece::Wrong) => {
                self.step = Step::Block;
                self.wrong();
            }
            (Step::Block, Piece::Etx) if self.taking.is_none() && !self.is_selected() => self.finish(),
            (Step::Asked | Step::Block, Piece::Etx) => {
                self.step = Step::Etx;
                if self.taking.as_ref().is_some_and(Taking::is_ended) && self.is_selected() {
                    self.end_of_file();
                }
            }
            (Step::Etx, Piece::Eot) => self.end_of_file(),
            (_, Piece::Eot) => self.eot(),
            _ => {}
        }
    }

    /// EOT without ETX: after END PGM it ends the file, elsewhere the device gives up.
    fn eot(&mut self) {
        if self.taking.as_ref().is_some_and(Taking::is_ended) {
            self.end_of_file();
        } else if self.step != Step::Over {
            self.abort(Shown::Control(MessageId::ProgramIncomplete, None));
        }
    }

    fn wrong(&mut self) {
        // That NAK is sent three times ends it [000:17588].
        if !self.link.refuse() {
            self.link.send(&[self.link.settings.control.nak]);
            self.abort(Shown::Control(MessageId::TransferredDataIncorrect, Some('M')));
        }
    }

    /// A line of text that is right.
    fn line(&mut self, text: Vec<u8>, now: Duration) {
        if self.taking.is_some() {
            self.store(&text);
            return;
        }
        let begins = beginning(&text);
        if self.want == Want::Directory {
            let name = begins.map_or_else(
                || String::from_utf8_lossy(&text).chars().take(16).collect(),
                |begins| format!("{}.{}", begins.name, begins.kind.unwrap_or(self.kind).extension()),
            );
            self.events.push_back(Event::Listed(name, None));
            self.ask();
            return;
        }
        let name = match (&self.want, begins) {
            (Want::Selected(name), _) => name.clone(),
            (_, Some(begins)) => {
                format!("{}.{}", begins.name, begins.kind.unwrap_or(self.kind).extension())
            }
            // What stands before a program is not stored; who asks for any file gets its name from its first line.
            (_, None) => {
                self.link.acknowledge();
                return;
            }
        };
        match self.want {
            Want::Offered => self.question(Question::Offered(name), text),
            _ => self.begin(name, text, now),
        }
    }

    fn question(&mut self, question: Question, text: Vec<u8>) {
        self.events.push_back(Event::Question(question.clone()));
        self.step = Step::Question(question, text);
    }

    /// Begins a file with its first line, after a question when there is one of its name.
    fn begin(&mut self, name: String, text: Vec<u8>, _now: Duration) {
        match self.files.find(&name) {
            Some(found) if found.protected => {
                let shown = Shown::Control(MessageId::ProtectedPgm, None);
                if self.is_selected() {
                    self.abort(shown);
                } else {
                    self.show(shown);
                    self.question(Question::Protected(name), text);
                }
            }
            Some(_) => self.question(Question::Overread(name), text),
            None => self.create(&name, &text),
        }
    }

    fn create(&mut self, name: &str, text: &[u8]) {
        match self.files.create(name) {
            Ok(file) => {
                self.taking = Some(Taking::new(name, file));
                self.step = Step::Block;
                self.store(text);
            }
            Err(error) => self.abort(Shown::of_store(&error)),
        }
    }

    fn store(&mut self, text: &[u8]) {
        match self.taking.as_mut().map(|taking| taking.line(text)) {
            Some(Err(error)) => self.unstored(&error),
            _ if self.holds => self.owes = self.owes.saturating_add(1),
            _ => self.link.acknowledge(),
        }
    }

    fn unstored(&mut self, error: &Unstored) {
        self.abort(match error {
            Unstored::Incomplete => Shown::Control(MessageId::ProgramIncomplete, None),
            Unstored::Store(error) => Shown::of_store(error),
        });
    }

    /// The file has come to its end.
    fn end_of_file(&mut self) {
        let Some(taking) = self.taking.take() else {
            self.abort(Shown::Control(MessageId::ProgramIncomplete, None));
            return;
        };
        let name = taking.name.clone();
        match taking.commit() {
            Ok(()) => {
                self.events.push_back(Event::Received(name));
                if self.is_selected() {
                    self.finish();
                } else {
                    self.ask();
                }
            }
            Err(error) => self.unstored(&error),
        }
    }

    /// The device signals an error [000:17442-17450].
    fn device(&mut self, text: &[u8]) {
        let over = self.step == Step::Over;
        self.link.acknowledge();
        let text = String::from_utf8_lossy(text).trim().to_owned();
        self.link.send(&[self.link.settings.control.eot]);
        if !over {
            self.show(Shown::Device(text));
            self.over();
        }
    }

    fn show(&mut self, shown: Shown) {
        self.failed = true;
        self.events.push_back(Event::Message(shown));
    }

    /// The end, by an error: EOT tells the device [000:17424].
    fn abort(&mut self, shown: Shown) {
        self.show(shown);
        self.finish();
    }

    /// Ends the transfer with EOT.
    fn finish(&mut self) {
        self.link.send(&[self.link.settings.control.eot]);
        self.over();
    }

    fn over(&mut self) {
        self.taking = None;
        self.owes = 0;
        self.step = Step::Over;
        self.events.push_back(Event::Ended(Ended::unless(self.failed)));
    }

    /// How long it may be quiet now.
    fn limit(&self) -> Option<Duration> {
        let settings = &self.link.settings;
        let ended = self.taking.as_ref().is_some_and(Taking::is_ended);
        match &self.step {
            Step::Over | Step::Question(..) => None,
            _ if self.owes > 0 => None,
            _ if self.link.is_inside() => Some(self.link.gap()),
            Step::Etx => Some(settings.moment()),
            Step::Block if ended && !self.is_selected() => {
                Some(settings.patience / ETX_PART + settings.moment())
            }
            Step::Asked | Step::Block => Some(settings.patience),
        }
    }

    fn quiet(&mut self, now: Duration) {
        let incomplete = Shown::Control(MessageId::ProgramIncomplete, None);
        if self.link.is_inside() {
            self.link.give_block_up(now);
            return match self.step {
                Step::Asked => {}
                _ => self.wrong(),
            };
        }
        match self.step {
            Step::Asked => self.abort(Shown::Control(MessageId::TransferredDataIncorrect, Some('N'))),
            Step::Etx => self.end_of_file(),
            // Everything is there, and was acknowledged.
            Step::Block if self.taking.as_ref().is_some_and(Taking::is_ended) => self.end_of_file(),
            Step::Block => self.abort(incomplete),
            Step::Over | Step::Question(..) => {}
        }
    }
}

impl Protocol for Reading {
    fn receive(&mut self, byte: u8, now: Duration) {
        if let Some(piece) = self.link.receive(byte, now) {
            self.piece(piece, now);
        }
    }

    fn clock(&mut self, now: Duration) {
        if self.deadline().is_some_and(|deadline| now >= deadline) {
            self.quiet(now);
        }
    }

    fn deadline(&self) -> Option<Duration> {
        self.link.quiet_for(self.limit()?)
    }

    fn has_output(&self) -> bool {
        self.link.has_output()
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        self.link.take(room, now, into);
    }

    fn unplugged(&mut self, _now: Duration) {
        self.link.clear();
        if self.step == Step::Over {
            return;
        }
        let ended = self.taking.as_ref().is_some_and(Taking::is_ended);
        if ended || (self.step == Step::Etx && self.taking.is_some()) {
            self.end_of_file();
            if self.step == Step::Asked {
                // Nobody answers any more.
                self.over();
            }
        } else {
            self.show(Shown::Control(MessageId::ProgramIncomplete, None));
            self.over();
        }
        self.link.clear();
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, yes: bool, now: Duration) {
        let Step::Question(question, text) = std::mem::replace(&mut self.step, Step::Block) else {
            return;
        };
        match (question, yes) {
            (Question::Overread(name), true) => self.create(&name, &text),
            (Question::Overread(_), false) => self.abort(Shown::Control(MessageId::EraseOverread, None)),
            (Question::Offered(name), true) => self.begin(name, text, now),
            (Question::Offered(_) | Question::Protected(_), false) if self.want != Want::Offered => {
                self.finish()
            }
            // The next file is asked for at once [000:17504-17512].
            _ => self.ask(),
        }
    }

    fn hold(&mut self, on: bool) {
        self.holds = on;
        if !on {
            (0..std::mem::take(&mut self.owes)).for_each(|_| self.link.acknowledge());
        }
    }

    fn end(&mut self, _now: Duration) {
        if self.step != Step::Over {
            self.abort(Shown::Control(MessageId::ProgramIncomplete, None));
        }
    }

    fn is_idle(&self) -> bool {
        self.step == Step::Over
    }
}
