//! The control reads in by the standard protocol [000:17266-17349].

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::HELD_MAX;
use super::items::{Item, Items};
use crate::blockwise::Want;
use crate::files::Files;
use crate::protocol::{Ended, Event, Protocol, Question, Shown};
use crate::settings::Settings;
use crate::text::{Beginning, Taking, Unstored, beginning, is_end};
use crate::{DC1, DC3, FileType};

/// What becomes of the text that comes.
enum Text {
    /// A first line is awaited.
    Search,
    /// The file is stored while it comes.
    Taking(Taking),
    /// It is read, but not stored.
    Skip,
}

/// The control as it reads in.
pub struct Reading {
    settings: Settings,
    files: Box<dyn Files>,
    want: Want,
    kind: FileType,
    items: Items,
    text: Text,
    outgoing: VecDeque<u8>,
    /// The operator is asked: what comes meanwhile waits.
    question: Option<(Question, Vec<u8>)>,
    held: VecDeque<u8>,
    /// There is no room for more.
    holds: bool,
    /// Something has come since the last DC1.
    answered: bool,
    /// A text has come to its end: the device may have no more.
    had_text: bool,
    quiet: Duration,
    over: bool,
    failed: bool,
    events: VecDeque<Event>,
}

impl Reading {
    /// Starts the device with DC1.
    pub fn new(settings: Settings, files: Box<dyn Files>, want: Want, kind: FileType) -> Reading {
        Reading {
            settings,
            files,
            want,
            kind,
            items: Items::default(),
            text: Text::Search,
            outgoing: [DC1].into(),
            question: None,
            held: VecDeque::new(),
            holds: false,
            answered: false,
            had_text: false,
            quiet: Duration::ZERO,
            over: false,
            failed: false,
            events: VecDeque::new(),
        }
    }

    fn item(&mut self, item: Item) {
        match item {
            Item::Line(line) => self.line(line),
            Item::Etx => self.end_of_text(),
            Item::Eot => {
                self.last_line();
                if !self.over && self.question.is_none() {
                    self.close_file();
                    self.finish();
                }
            }
            Item::Error(shown) => self.fail(shown),
            Item::Dc1 | Item::Dc3 | Item::Enquiry => {}
        }
    }

    /// The file that is wanted has no first line with its name [000:16939].
    fn is_nameless(&self) -> bool {
        let Want::Selected(name) = &self.want else {
            return false;
        };
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
        FileType::of_extension(extension).is_none_or(|kind| !kind.is_named_in_first_line())
    }

    fn line(&mut self, line: Vec<u8>) {
        self.answered |= !line.is_empty();
        let nameless = self.is_nameless();
        match &mut self.text {
            Text::Taking(taking) => {
                let next = !taking.is_ended() && self.want == Want::All && beginning(&line).is_some();
                if next {
                    self.close_file();
                    return self.line(line);
                }
                if let Err(error) = taking.line(&line) {
                    return self.unstored(&error);
                }
                if taking.is_ended() {
                    self.close_file();
                }
            }
            Text::Skip => {
                if is_end(&line) {
                    self.text = Text::Search;
                }
            }
            Text::Search if nameless => {
                if let Want::Selected(name) = self.want.clone()
                    && (!line.is_empty() || self.had_text)
                {
                    self.begin(name, line);
                }
            }
            Text::Search => {
                if let Some(begins) = beginning(&line) {
                    self.first_line(&begins, line);
                }
            }
        }
    }

    /// Takes the first line of a file.
    fn first_line(&mut self, begins: &Beginning, line: Vec<u8>) {
        let kind = begins.kind.unwrap_or(self.kind);
        let name = format!("{}.{}", begins.name, kind.extension());
        match &self.want {
            Want::Directory => {
                self.events.push_back(Event::Listed(name, None));
                self.text = Text::Skip;
            }
            Want::Selected(wanted) if !wanted.eq_ignore_ascii_case(&name) => self.text = Text::Skip,
            Want::Selected(wanted) => self.begin(wanted.clone(), line),
            Want::Offered => self.ask(Question::Offered(name), line),
            Want::All => self.begin(name, line),
        }
    }

    fn ask(&mut self, question: Question, line: Vec<u8>) {
        self.events.push_back(Event::Question(question.clone()));
        self.question = Some((question, line));
        if !self.settings.stop_by_rts {
            self.outgoing.push_back(DC3);
        }
    }

    fn begin(&mut self, name: String, line: Vec<u8>) {
        match self.files.find(&name) {
            Some(found) if found.protected => {
                let shown = Shown::Control(MessageId::ProtectedPgm, None);
                if matches!(self.want, Want::Selected(_)) {
                    self.fail(shown);
                } else {
                    self.show(shown);
                    self.ask(Question::Protected(name), line);
                }
            }
            Some(_) => self.ask(Question::Overread(name), line),
            None => self.create(&name, &line),
        }
    }

    fn create(&mut self, name: &str, line: &[u8]) {
        match self.files.create(name) {
            Ok(file) => {
                let mut taking = Taking::new(name, file);
                match taking.line(line) {
                    Ok(()) => self.text = Text::Taking(taking),
                    Err(error) => self.unstored(&error),
                }
            }
            Err(error) => self.fail(Shown::of_store(&error)),
        }
    }

    /// The last line may have no end of its own.
    fn last_line(&mut self) {
        if let Some(line) = self.items.rest() {
            self.line(line);
        }
    }

    /// ETX: the device has sent its text.
    fn end_of_text(&mut self) {
        self.last_line();
        if self.question.is_some() {
            self.held.push_front(self.settings.control.etx);
            return;
        }
        self.close_file();
        if self.over {
            return;
        }
        let more =
            matches!(self.want, Want::All | Want::Offered) && self.answered && !self.settings.never_eot;
        if more {
            // The next text is asked for [000:17336-17343].
            self.answered = false;
            self.had_text = true;
            self.outgoing.push_back(DC1);
        } else {
            self.finish();
        }
    }

    fn close_file(&mut self) {
        let Text::Taking(taking) = std::mem::replace(&mut self.text, Text::Search) else {
            return;
        };
        let name = taking.name.clone();
        match taking.commit() {
            Ok(()) => {
                self.events.push_back(Event::Received(name));
                if matches!(self.want, Want::Selected(_)) {
                    // What else the device sends is read, but not stored.
                    self.want = Want::Selected(String::from(".H"));
                }
            }
            Err(error) => self.unstored(&error),
        }
    }

    fn unstored(&mut self, error: &Unstored) {
        self.fail(match error {
            Unstored::Incomplete => Shown::Control(MessageId::ProgramIncomplete, None),
            Unstored::Store(error) => Shown::of_store(error),
        });
    }

    fn show(&mut self, shown: Shown) {
        self.failed = true;
        self.events.push_back(Event::Message(shown));
    }

    fn fail(&mut self, shown: Shown) {
        if !self.over {
            self.show(shown);
            self.finish();
        }
    }

    /// The end: EOT, but for ME.
    fn finish(&mut self) {
        self.text = Text::Search;
        self.question = None;
        if self.over {
            return;
        }
        if !self.settings.never_eot {
            self.outgoing.push_back(self.settings.control.eot);
        }
        self.over = true;
        self.events.push_back(Event::Ended(Ended::unless(self.failed)));
    }

    fn take(&mut self, byte: u8) {
        if self.over {
            return;
        }
        if let Some(item) = self.items.take(&self.settings, byte) {
            self.item(item);
        }
    }
}

impl Protocol for Reading {
    fn receive(&mut self, byte: u8, now: Duration) {
        self.quiet = now;
        if self.question.is_none() {
            self.take(byte);
        } else if self.held.len() < HELD_MAX {
            self.held.push_back(byte);
        } else {
            self.fail(Shown::Control(MessageId::TransferredDataIncorrect, Some('C')));
        }
    }

    fn clock(&mut self, now: Duration) {
        if self.deadline().is_some_and(|deadline| now >= deadline) {
            self.finish();
        }
    }

    fn deadline(&self) -> Option<Duration> {
        // A device that has sent a text and answers the next DC1 with nothing has no more; the operator would press END.
        let waits = self.had_text && !self.answered && !self.over && !self.items.is_inside();
        (waits && self.outgoing.is_empty()).then(|| self.quiet + self.settings.patience)
    }

    fn has_output(&self) -> bool {
        !self.outgoing.is_empty()
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        if !self.outgoing.is_empty() {
            into.extend(self.outgoing.drain(..room.min(self.outgoing.len())));
            self.quiet = now;
        }
    }

    fn unplugged(&mut self, _now: Duration) {
        let whole = self.had_text && !self.answered && matches!(self.text, Text::Search);
        if whole && self.question.is_none() {
            self.finish();
        } else {
            self.fail(Shown::Control(MessageId::ProgramIncomplete, None));
        }
        self.outgoing.clear();
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, yes: bool, _now: Duration) {
        let Some((question, line)) = self.question.take() else {
            return;
        };
        match (question, yes) {
            (Question::Overread(name), true) => self.create(&name, &line),
            (Question::Overread(_), false) => self.fail(Shown::Control(MessageId::EraseOverread, None)),
            (Question::Offered(name), true) => self.begin(name, line),
            (Question::Protected(_), false) => self.finish(),
            // It is read in, but not stored [000:17347-17349].
            _ => self.text = Text::Skip,
        }
        if self.over || self.question.is_some() {
            return;
        }
        if !self.settings.stop_by_rts {
            self.outgoing.push_back(DC1);
        }
        while self.question.is_none()
            && let Some(byte) = self.held.pop_front()
        {
            self.take(byte);
        }
    }

    fn hold(&mut self, on: bool) {
        if self.over || self.holds == on {
            return;
        }
        self.holds = on;
        if !self.settings.stop_by_rts {
            self.outgoing.push_back(if on { DC3 } else { DC1 });
        }
    }

    fn end(&mut self, _now: Duration) {
        // END before anything has come [000:17275].
        if !self.answered && !self.had_text && !self.over {
            self.outgoing = super::end_of_output(&self.settings).into();
            self.over = true;
            self.events.push_back(Event::Ended(Ended::Complete));
        } else if matches!(self.text, Text::Search) {
            self.finish();
        } else {
            self.fail(Shown::Control(MessageId::ProgramIncomplete, None));
        }
    }

    fn is_idle(&self) -> bool {
        self.over
    }

    fn has_stopped_by_rts(&self) -> bool {
        self.settings.stop_by_rts && (self.question.is_some() || self.holds)
    }
}
