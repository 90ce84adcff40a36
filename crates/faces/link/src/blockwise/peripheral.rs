//! The device: a floppy disk unit, a personal computer, and a control that obeys what arrives.
//!
//! Decision: A device waits for the acknowledgement of a control without limit, since the control stops it by keeping
//! it back; a control waits as long as `timeout` says. ENQ after that time ends such a transfer with message N and
//! begins LSV/2
//!
//! Decision: READ-IN ALL asks for one type of files, plain-language programs if nothing else is said; a device gives
//! those of the code letter that carry their name, by name

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::directory::{REQUEST, answer};
use super::link::Link;
use super::terms::{Rights, candidates, code};
use crate::FileType;
use crate::files::{Files, Listed};
use crate::frame::{Kind, Piece};
use crate::protocol::{Ended, Event, Protocol, Question, Shown};
use crate::settings::Settings;
use crate::text::{Source, Taking, Unstored, beginning, is_name};

/// Begins LSV/2 between transfers.
const ENQ: u8 = 0x05;
const ESC: u8 = 0x1B;

/// What is being received.
enum Into {
    File(Taking),
    /// A program whose language its first line tells: its name without extension.
    Program(String),
}

enum Step {
    Idle,
    /// A line waits for its answer.
    Sending(Source),
    /// ETX waits for what the other side wants next.
    Sent,
    /// A file is received line by line.
    Receiving(Into),
    /// ETX has come: an EOT may follow, or more of the text, when it was none.
    Etx(Into),
    /// The operator is asked; the header waits without an answer.
    Question(String),
    /// An error waits for its acknowledgement.
    Refused,
}

/// The device at the other end of the line: a disk unit with its files.
pub struct Peripheral {
    link: Link,
    files: Box<dyn Files>,
    rights: Rights,
    step: Step,
    /// The file that is being transferred.
    name: String,
    /// The last file that was sent without being asked for by name.
    last: Option<String>,
    /// Wrong headers in sequence.
    wrong_headers: u8,
    /// What has come of an escape sequence.
    escape: Vec<u8>,
    /// Something was begun whose end is not yet reported.
    open: bool,
    events: VecDeque<Event>,
}

impl Peripheral {
    /// A device that waits for what the other side wants.
    pub fn new(settings: Settings, files: Box<dyn Files>, rights: Rights) -> Peripheral {
        Peripheral {
            link: Link::new(settings),
            files,
            rights,
            step: Step::Idle,
            name: String::new(),
            last: None,
            wrong_headers: 0,
            escape: Vec::new(),
            open: false,
            events: VecDeque::new(),
        }
    }

    fn piece(&mut self, piece: Piece) {
        let step = std::mem::replace(&mut self.step, Step::Idle);
        match (step, piece) {
            (step, Piece::Block(Kind::Header, text)) => {
                self.leave(step);
                self.wrong_headers = 0;
                self.open = true;
                self.header(&text);
            }
            (Step::Sending(source), Piece::Ack) => self.next_line(source),
            (Step::Sending(source), Piece::Nak) => {
                self.step = Step::Sending(source);
                self.repeat();
            }
            (step @ (Step::Sent | Step::Refused), Piece::Nak) => {
                self.step = step;
                self.repeat();
            }
            (Step::Refused, Piece::Eot | Piece::Ack) => {}
            (Step::Receiving(into) | Step::Etx(into), Piece::Block(Kind::Text, text)) => {
                self.line(into, &text)
            }
            (Step::Receiving(into) | Step::Etx(into), Piece::Wrong) => {
                self.step = Step::Receiving(into);
                if !self.link.refuse() {
                    self.refuse(3);
                }
            }
            (Step::Receiving(into), Piece::Etx) => {
                self.step = Step::Etx(into);
                if self.has_ended() {
                    self.end_of_file();
                }
            }
            (step @ Step::Etx(_), Piece::Eot) => {
                self.step = step;
                self.end_of_file();
            }
            (step @ Step::Receiving(_), Piece::Eot) => {
                self.step = step;
                if self.has_ended() {
                    self.end_of_file();
                } else {
                    self.abandon();
                }
            }
            (step @ (Step::Sending(_) | Step::Sent | Step::Idle | Step::Question(_)), Piece::Eot) => {
                self.eot(step)
            }
            // A block outside of a transfer: what it belongs to was given up.
            (Step::Idle, Piece::Block(Kind::Text, _)) => self.refuse(4),
            (Step::Idle, Piece::Wrong) => {
                self.wrong_headers += 1;
                if self.wrong_headers < super::link::TRIES {
                    self.link.send(&[self.link.settings.control.nak]);
                } else {
                    self.wrong_headers = 0;
                    self.refuse(3);
                }
            }
            (Step::Idle, Piece::Other(ENQ)) => self.events.push_back(Event::Enquiry),
            (step, _) => self.step = step,
        }
    }

    /// A header comes: whatever was going on is over.
    fn leave(&mut self, step: Step) {
        match step {
            Step::Sent => self.events.push_back(Event::Sent(std::mem::take(&mut self.name))),
            Step::Receiving(into) | Step::Etx(into) => {
                let ended = matches!(&into, Into::File(taking) if taking.is_ended());
                self.step = Step::Receiving(into);
                if ended {
                    self.end_of_file();
                } else {
                    self.abandon();
                }
            }
            _ => {}
        }
    }

    /// Reports the end of what was begun, once.
    fn ended(&mut self, ended: Ended) {
        if std::mem::take(&mut self.open) || ended == Ended::Incomplete {
            self.events.push_back(Event::Ended(ended));
        }
    }

    /// EOT: the next nameless header gets the first file.
    fn eot(&mut self, step: Step) {
        self.last = None;
        match step {
            Step::Sent => self.events.push_back(Event::Sent(std::mem::take(&mut self.name))),
            Step::Sending(_) | Step::Question(_) => {
                self.link.clear();
                self.incomplete();
                return;
            }
            _ => {}
        }
        self.ended(Ended::Complete);
    }

    fn repeat(&mut self) {
        if !self.link.repeat() {
            self.refuse_as(3, Shown::Control(MessageId::TransferredDataIncorrect, Some('E')));
        }
    }

    fn header(&mut self, text: &[u8]) {
        let control = self.link.settings.control;
        let text = text.strip_suffix(b" ").unwrap_or(text);
        let Some((&mode, rest)) = text.split_last() else {
            return self.refuse(1);
        };
        let reads = mode == control.input && self.rights.gives;
        let writes = mode == control.output && self.rights.takes;
        if !reads && !writes {
            return self.refuse(1);
        }
        let (code, name) = rest
            .split_first()
            .map_or((None, &[][..]), |(code, name)| (Some(*code), name));
        if name.is_empty() && reads {
            return self.give_next(code);
        }
        if !is_name(name) {
            return self.refuse(2);
        }
        let stem = String::from_utf8_lossy(name).to_ascii_uppercase();
        if reads {
            self.give_named(&stem, code);
        } else {
            self.take(&stem, code);
        }
    }

    fn give_named(&mut self, stem: &str, code: Option<u8>) {
        let candidates = candidates(stem, code);
        let found = candidates
            .into_iter()
            .find(|name| self.rights.allow(name) && self.files.find(name).is_some());
        match found {
            Some(name) => self.give(&name),
            None => self.refuse(10),
        }
    }

    /// The file after the last one that carries its name, of the type that is asked for.
    fn give_next(&mut self, code: Option<u8>) {
        let known = code
            .map(char::from)
            .and_then(FileType::of_code)
            .map(FileType::code);
        let last = self.last.take();
        let fits = |file: &Listed| {
            let kind = file
                .name
                .rsplit_once('.')
                .and_then(|(_, extension)| FileType::of_extension(extension));
            let fits = kind.is_some_and(|kind| {
                kind.is_named_in_first_line() && known.map_or(kind.is_program(), |code| kind.code() == code)
            });
            fits && self.rights.allow(&file.name)
        };
        let mut files = self.files.list();
        files.sort_by_cached_key(|file| file.name.to_ascii_uppercase());
        let next = files.into_iter().find(|file| {
            fits(file)
                && last
                    .as_ref()
                    .is_none_or(|last| file.name.to_ascii_uppercase() > *last)
        });
        match next {
            Some(file) => {
                self.last = Some(file.name.to_ascii_uppercase());
                self.give(&file.name);
            }
            None => {
                self.last = last;
                self.link.send_awaiting(&[self.link.settings.control.etx]);
                self.step = Step::Idle;
            }
        }
    }

    fn give(&mut self, name: &str) {
        let settings = self.link.settings;
        match self.files.open(name) {
            Ok(file) => {
                name.clone_into(&mut self.name);
                self.link.acknowledge();
                self.next_line(Source::new(file, settings.characters, settings.decimal_comma));
            }
            Err(error) => self.refuse(code(&error)),
        }
    }

    fn next_line(&mut self, mut source: Source) {
        match source.next() {
            Ok(Some(line)) => {
                self.link.send_block(Kind::Text, &line);
                self.step = Step::Sending(source);
            }
            Ok(None) => {
                self.link.send_awaiting(&[self.link.settings.control.etx]);
                self.step = Step::Sent;
            }
            Err(_) => self.refuse(104),
        }
    }

    fn take(&mut self, stem: &str, code: Option<u8>) {
        let candidates = candidates(stem, code);
        let known = code.map(char::from).and_then(FileType::of_code);
        let name = known.map_or_else(
            || candidates.first().cloned().unwrap_or_default(),
            |kind| format!("{stem}.{}", kind.extension()),
        );
        if !self.rights.allow(&name) {
            return self.refuse(11);
        }
        let found = candidates
            .iter()
            .filter(|other| known.is_none() || **other == name)
            .find_map(|other| self.files.find(other));
        match found {
            Some(found) if found.protected => self.refuse(11),
            Some(_) if self.rights.asks => {
                self.events
                    .push_back(Event::Question(Question::Overread(name.clone())));
                self.name = stem.to_owned();
                self.step = Step::Question(if known.is_some() { name } else { String::new() });
            }
            Some(_) | None => self.begin(stem, known.is_some().then_some(name)),
        }
    }

    /// Lines may come; what has no type yet gets it by its first line.
    fn begin(&mut self, stem: &str, name: Option<String>) {
        match name {
            Some(name) => match self.files.create(&name) {
                Ok(file) => self.step = Step::Receiving(Into::File(Taking::new(&name, file))),
                Err(error) => return self.refuse(code(&error)),
            },
            None => self.step = Step::Receiving(Into::Program(stem.to_owned())),
        }
        self.link.acknowledge();
    }

    fn line(&mut self, into: Into, text: &[u8]) {
        let mut taking = match into {
            Into::File(taking) => taking,
            Into::Program(stem) => {
                let Some(kind) = beginning(text).and_then(|begins| begins.kind) else {
                    // A comment before the program.
                    self.step = Step::Receiving(Into::Program(stem));
                    return self.link.acknowledge();
                };
                let name = format!("{stem}.{}", kind.extension());
                match self.files.create(&name) {
                    Ok(file) => Taking::new(&name, file),
                    Err(error) => return self.refuse(code(&error)),
                }
            }
        };
        match taking.line(text) {
            Ok(()) => {
                self.step = Step::Receiving(Into::File(taking));
                self.link.acknowledge();
            }
            Err(error) => self.unstored(&error),
        }
    }

    fn has_ended(&self) -> bool {
        matches!(&self.step, Step::Receiving(Into::File(taking)) | Step::Etx(Into::File(taking)) if taking.is_ended())
    }

    fn end_of_file(&mut self) {
        match std::mem::replace(&mut self.step, Step::Idle) {
            Step::Receiving(Into::File(taking)) | Step::Etx(Into::File(taking)) => {
                let name = taking.name.clone();
                match taking.commit() {
                    Ok(()) => {
                        self.events.push_back(Event::Received(name));
                        self.ended(Ended::Complete);
                    }
                    Err(error) => self.unstored(&error),
                }
            }
            _ => self.refuse(4),
        }
    }

    fn unstored(&mut self, error: &Unstored) {
        self.refuse(match error {
            Unstored::Incomplete => 4,
            Unstored::Store(error) => code(error),
        });
    }

    /// The other side gives up, or is gone.
    fn abandon(&mut self) {
        self.step = Step::Idle;
        self.incomplete();
    }

    fn incomplete(&mut self) {
        self.tell(Shown::Control(MessageId::ProgramIncomplete, None));
    }

    /// Reports why what was begun has failed.
    fn tell(&mut self, shown: Shown) {
        self.events.push_back(Event::Message(shown));
        self.ended(Ended::Incomplete);
    }

    /// The answer is overdue: somebody else may begin. Until somebody does, a control may keep it back as long as it wants.
    fn is_forsaken(&self, now: Duration) -> bool {
        let overdue = self.link.quiet_for(self.link.settings.patience);
        matches!(self.step, Step::Sending(_)) && overdue.is_some_and(|overdue| now >= overdue)
    }

    /// Signals an error; nothing partial is left.
    fn refuse(&mut self, code: u16) {
        self.refuse_as(code, Shown::Device(error_text(code)));
    }

    /// Signals an error that has another name on this side of the line.
    fn refuse_as(&mut self, code: u16, shown: Shown) {
        let text = error_text(code);
        // The device sends no DC1 after it.
        let with_dc1 = std::mem::replace(&mut self.link.settings.with_dc1, false);
        self.link.send_block(Kind::Header, text.as_bytes());
        self.link.settings.with_dc1 = with_dc1;
        self.step = Step::Refused;
        self.tell(shown);
    }

    /// A character of the escape sequence that asks for the directory.
    fn escaped(&mut self, byte: u8) -> bool {
        if byte == ESC
            && matches!(self.step, Step::Idle | Step::Sent | Step::Refused)
            && !self.link.is_inside()
        {
            self.escape.clear();
        } else if self.escape.is_empty() {
            return false;
        }
        self.escape.push(byte);
        let wanted = REQUEST.get(1..).unwrap_or_default();
        if self.escape == wanted {
            let files: Vec<Listed> = self.files.list();
            let known = |file: &Listed| {
                let kind = file
                    .name
                    .rsplit_once('.')
                    .and_then(|(_, of)| FileType::of_extension(of));
                kind.is_some() && self.rights.allow(&file.name)
            };
            let files: Vec<Listed> = files.into_iter().filter(known).collect();
            self.link.send(&answer(&files));
        }
        let goes_on = wanted.starts_with(&self.escape);
        if self.escape == wanted || !goes_on {
            self.escape.clear();
        }
        goes_on
    }

    fn limit(&self) -> Option<Duration> {
        let settings = &self.link.settings;
        match &self.step {
            // A control may keep its acknowledgement back as long as it wants [000:17434-17438].
            Step::Idle | Step::Question(_) | Step::Sending(_) if !self.link.is_inside() => None,
            _ if self.link.is_inside() => Some(self.link.gap()),
            Step::Etx(_) => Some(settings.moment()),
            _ => Some(settings.patience),
        }
    }

    fn quiet(&mut self, now: Duration) {
        if self.link.is_inside() {
            self.link.give_block_up(now);
            return self.piece(Piece::Wrong);
        }
        match &self.step {
            Step::Etx(_) => self.end_of_file(),
            Step::Receiving(_) if self.has_ended() => self.end_of_file(),
            Step::Receiving(_) => self.abandon(),
            Step::Sent => {
                self.step = Step::Idle;
                self.events.push_back(Event::Sent(std::mem::take(&mut self.name)));
                self.ended(Ended::Complete);
            }
            Step::Refused => self.step = Step::Idle,
            Step::Idle | Step::Question(_) | Step::Sending(_) => {}
        }
    }
}

impl Protocol for Peripheral {
    fn receive(&mut self, byte: u8, now: Duration) {
        if self.escaped(byte) {
            return;
        }
        if byte == ENQ && self.is_forsaken(now) {
            self.step = Step::Idle;
            self.link.clear();
            self.tell(Shown::Control(MessageId::TransferredDataIncorrect, Some('N')));
        }
        if let Some(piece) = self.link.receive(byte, now) {
            self.piece(piece);
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
        self.escape.clear();
        self.last = None;
        let ended = self.has_ended();
        match std::mem::replace(&mut self.step, Step::Idle) {
            step @ (Step::Receiving(_) | Step::Etx(_)) => {
                self.step = step;
                if ended {
                    self.end_of_file();
                } else {
                    self.abandon();
                }
            }
            Step::Sent => {
                self.events.push_back(Event::Sent(std::mem::take(&mut self.name)));
                self.ended(Ended::Complete);
            }
            Step::Sending(_) | Step::Question(_) => self.incomplete(),
            Step::Idle | Step::Refused => {}
        }
        self.step = Step::Idle;
        self.link.clear();
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, yes: bool, _now: Duration) {
        let Step::Question(name) = std::mem::replace(&mut self.step, Step::Idle) else {
            return;
        };
        if yes {
            let stem = std::mem::take(&mut self.name);
            self.begin(&stem, (!name.is_empty()).then_some(name));
        } else {
            self.events
                .push_back(Event::Message(Shown::Control(MessageId::EraseOverread, None)));
            self.refuse(11);
        }
    }

    fn end(&mut self, _now: Duration) {
        if !matches!(self.step, Step::Idle | Step::Sent | Step::Refused) {
            self.link.clear();
            self.refuse(4);
        }
    }

    fn is_idle(&self) -> bool {
        matches!(self.step, Step::Idle | Step::Refused | Step::Sent) && !self.link.has_output()
    }
}

/// What travels, and what the side says that has found it [000:17603-17625].
fn error_text(code: u16) -> String {
    format!("ERR: {code:03}")
}
