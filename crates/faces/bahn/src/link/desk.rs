//! Who attends a transfer: tells what happens, and answers what is asked.

use std::io::BufRead as _;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use bahn_link::{Attendant, Ended, Event, Question};
use bahn_parameters::ControlModel;
use clap::ValueEnum;
use serde::Serialize;

use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

/// How questions of the control are answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Answer {
    /// Every question with ENT.
    Yes,
    /// Every question with NO ENT.
    No,
    /// As a line of standard input says: y or n.
    #[default]
    Ask,
}

/// A file on the medium of the device.
#[derive(Debug, Serialize)]
struct Listed {
    name: String,
    sectors: Option<u32>,
}

/// What was transferred, as JSON.
#[derive(Debug, Default, Serialize)]
pub(super) struct Report {
    received: Vec<String>,
    sent: Vec<String>,
    listed: Vec<Listed>,
    free_sectors: Option<u32>,
    /// The message that the control shows, word for word.
    message: Option<String>,
    complete: bool,
}

/// When a command has done its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Until {
    /// When the transfer has ended.
    Ended,
    /// When the other side has ended it, and begins nothing more for so long; or pulls the cable.
    Quiet(Duration),
    /// Never: Ctrl-C ends it.
    Stopped,
}

/// The attendant of a command.
pub(super) struct Desk {
    model: ControlModel,
    answer: Answer,
    format: Format,
    until: Until,
    /// What stands before its lines, when there are several ports.
    name: &'static str,
    report: Report,
    ended: bool,
    ended_at: Option<Duration>,
    failed: bool,
    /// Somebody was connected at some time.
    had_peer: bool,
    typed: Option<Receiver<String>>,
    /// What follows when a file is stored.
    stored: Option<Box<dyn FnMut() + Send>>,
}

impl Desk {
    pub fn new(model: ControlModel, answer: Answer, format: Format, until: Until) -> Desk {
        Desk {
            model,
            answer,
            format,
            until,
            name: "",
            report: Report::default(),
            ended: false,
            ended_at: None,
            failed: false,
            had_peer: false,
            typed: None,
            stored: None,
        }
    }

    /// The same for one of several ports.
    pub fn of_port(self, name: &'static str) -> Desk {
        Desk { name, ..self }
    }

    /// Does something whenever a file is stored.
    pub fn when_stored(self, action: impl FnMut() + Send + 'static) -> Desk {
        Desk {
            stored: Some(Box::new(action)),
            ..self
        }
    }

    fn say(&self, text: &str) {
        if self.format == Format::Text {
            let name = self.name;
            // Whoever has closed the output knows; the transfer goes on.
            let _ = console::print(&format!("{name}{text}\n"));
        }
    }

    fn question(&mut self, question: &Question) -> Option<bool> {
        let text = match question {
            Question::Overread(name) => format!("ERASE/OVERREAD {name}"),
            Question::Offered(name) => format!("READ-IN {name}"),
            Question::Output(name) => format!("OUTPUT {name}"),
            Question::Protected(name) => format!("{name}: CONTINUE"),
        };
        match self.answer {
            Answer::Yes => Some(true),
            Answer::No => Some(false),
            Answer::Ask => {
                diagnostics::print_line(&format!("{text}? ENT = y, NO ENT = n"));
                self.typed.get_or_insert_with(typed_lines);
                None
            }
        }
    }

    /// Whether the control shows a message.
    pub fn has_failed(&self) -> bool {
        self.failed || self.report.message.is_some()
    }

    /// Its end: the report, and what came of it.
    pub fn finish(mut self) -> Result<Outcome, UsageError> {
        let done = self.report.message.is_none() && !self.failed;
        self.report.complete = done && (self.ended || self.until != Until::Ended);
        if self.format == Format::Json {
            console::print_json(&self.report)?;
        }
        Ok(match self.report.complete {
            true => Outcome::Fine,
            false => Outcome::ProgramError,
        })
    }
}

impl Attendant for Desk {
    fn event(&mut self, event: Event) -> Option<bool> {
        match event {
            Event::Received(name) => {
                self.say(&format!("{name} received"));
                self.report.received.push(name);
                if let Some(stored) = &mut self.stored {
                    stored();
                }
            }
            Event::Sent(name) => {
                self.say(&format!("{name} sent"));
                self.report.sent.push(name);
            }
            Event::Listed(name, sectors) => {
                let count = sectors.map_or_else(String::new, |count| format!("{count:>6}"));
                self.say(format!("{name:<20}{count}").trim_end());
                self.report.listed.push(Listed { name, sectors });
            }
            Event::Free(sectors) => {
                self.say(&format!("FREE: {sectors}"));
                self.report.free_sectors = Some(sectors);
            }
            Event::Question(question) => return self.question(&question),
            Event::Message(shown) => {
                let text = shown.text(self.model);
                self.say(&text);
                // The last one is what stands on the screen.
                self.report.message = Some(text);
            }
            Event::Enquiry => {}
            Event::Ended(ended) => {
                self.failed |= ended == Ended::Incomplete;
                self.ended = true;
                self.ended_at = None;
                if self.until == Until::Stopped {
                    // What a port that is always open has done is told, and forgotten.
                    self.report = Report::default();
                    self.failed = false;
                }
            }
        }
        None
    }

    fn answer(&mut self) -> Option<bool> {
        let line = self.typed.as_ref()?.try_recv();
        match line {
            Ok(line) => Some(matches!(line.trim().chars().next(), Some('y' | 'Y' | 'j' | 'J'))),
            // Nobody can answer any more.
            Err(std::sync::mpsc::TryRecvError::Disconnected) => {
                self.typed = None;
                self.answer = Answer::No;
                Some(false)
            }
            Err(std::sync::mpsc::TryRecvError::Empty) => None,
        }
    }

    fn is_over(&mut self, connected: bool, now: Duration) -> bool {
        let pulled = self.had_peer && !connected;
        self.had_peer |= connected;
        match self.until {
            Until::Ended => self.ended,
            Until::Quiet(time) => {
                let since = *self.ended_at.get_or_insert(now);
                pulled || (self.ended && now >= since + time)
            }
            Until::Stopped => false,
        }
    }
}

/// The lines of standard input, from a thread of their own.
fn typed_lines() -> Receiver<String> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}
