//! What is done to a machine that is switched on, and by whom.

use std::fmt;

use bahn_control::Command;
use bahn_machine::{Event, KeyAction, Machine};
use bahn_servo::Plant;
use thiserror::Error;

/// A plant that can be operated: it has a panel, and things can happen to it.
pub trait Operable: Plant {
    /// Lets something happen to it.
    ///
    /// # Errors
    /// In words, when it has not what the event names.
    fn operate(&mut self, event: &Event) -> Result<(), String>;
}

impl Operable for Machine {
    fn operate(&mut self, event: &Event) -> Result<(), String> {
        self.act(event).map_err(|error| error.to_string())
    }
}

/// Something that is done.
///
/// ```
/// use bahn_host::Deed;
/// assert!(matches!(Deed::parse("mode full"), Ok(Deed::Command(_))));
/// assert_eq!(Deed::parse("key NC_START tap"), Ok(Deed::tap("NC_START")));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Deed {
    /// To the control.
    Command(Command),
    /// To the machine, with its text.
    Event(Event, String),
}

/// A text is nothing that can be done.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum DeedError {
    /// Its first word is no event and no command.
    #[error("`{0}` is no event and no command")]
    Unknown(String),
    /// What behind it is wrong.
    #[error("{0}")]
    Wrong(String),
}

impl Deed {
    /// Reads a command of the control or an event of the machine. `key 107` is a key of the keyboard,
    /// `key NC_START tap` one of the panel; `handwheel X 3` chooses the axis of the handwheel, `handwheel 500`
    /// turns it.
    ///
    /// # Errors
    /// When it is neither.
    pub fn parse(text: &str) -> Result<Deed, DeedError> {
        let (word, rest) = text
            .trim()
            .split_once(char::is_whitespace)
            .unwrap_or((text.trim(), ""));
        let rest = rest.trim();
        let is_command = match word {
            "key" => rest.parse::<u8>().is_ok(),
            "handwheel" => rest.starts_with(|first: char| first.is_ascii_alphabetic()),
            _ => false,
        };
        if Event::WORDS.contains(&word) && !is_command {
            let event = Event::parse(text).map_err(|error| DeedError::Wrong(error.to_string()))?;
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            return Ok(Deed::Event(event, text));
        }
        text.parse().map(Deed::Command).map_err(|error| {
            let error = error.to_string();
            match error.ends_with("is no command") {
                true => DeedError::Unknown(word.to_owned()),
                false => DeedError::Wrong(error),
            }
        })
    }

    /// A key of the panel is tapped.
    pub fn tap(key: &str) -> Deed {
        let event = Event::Key(key.to_owned(), KeyAction::Tap);
        Deed::Event(event, format!("key {key} tap"))
    }
}

impl fmt::Display for Deed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Deed::Command(command) => command.fmt(f),
            Deed::Event(_, text) => f.write_str(text),
        }
    }
}

/// Who does it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The operator who stands by.
    Operator,
    /// A script.
    Script,
    /// The log of another run.
    Log,
    /// Somebody else, by his name.
    Client(String),
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It was done.
    Done,
    /// The control refuses the command now.
    Refused,
    /// The machine has not what the event names; in words.
    Impossible(String),
}
