//! What is done to a machine that is switched on, and by whom.

use std::fmt;

use bahn_machine::{Event, KeyAction};
use bahn_tnc::{Command, CommandError, split_channel};
use thiserror::Error;

/// Something that is done, on a control of one family or another: a TNC where nothing else is said.
///
/// ```
/// use bahn_host::Action;
/// assert!(matches!(Action::parse("mode full"), Ok(Action::Command(0, _))));
/// assert_eq!(Action::parse("key NC_START tap"), Ok(Action::tap("NC_START")));
/// let second = Action::parse("2: mode full")?;
/// assert!(matches!(second, Action::Command(1, _)));
/// assert_eq!(second.to_string(), "2: mode full");
/// # Ok::<(), bahn_host::ActionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Action<C = Command> {
    /// To a channel of the control, from 0.
    Command(usize, C),
    /// To the machine, with its text.
    Event(Event, String),
}

/// A text is nothing that can be done.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ActionError {
    /// Its first word is no event and no command.
    #[error("`{0}` is no event and no command")]
    Unknown(String),
    /// What after it is wrong.
    #[error("{0}")]
    Wrong(String),
}

impl Action {
    /// Reads a command of the control or an event of the machine; `2: mode full` goes to the second channel. `key 107` is a key of the keyboard,
    /// `key NC_START tap` one of the panel; `handwheel X 3` chooses the axis of the handwheel, `handwheel 500`
    /// turns it.
    ///
    /// # Errors
    /// When it is neither.
    pub fn parse(text: &str) -> Result<Action, ActionError> {
        if let (Some(channel), command) = split_channel(text) {
            return Action::command_to(channel, command);
        }
        let (word, rest) = text
            .trim()
            .split_once(char::is_whitespace)
            .unwrap_or((text.trim(), ""));
        let rest = rest.trim();
        let is_command = match word {
            "key" => rest.parse::<u8>().is_ok(),
            // An axis is a letter alone; `handwheel key X` and `handwheel S1 3` are done at the handwheel.
            "handwheel" => {
                let first = rest.split_whitespace().next().unwrap_or_default();
                first.len() == 1 && first.starts_with(|first: char| first.is_ascii_alphabetic())
            }
            // The probe is put into the spindle and taken out, its stylus is pushed; what it does there are commands.
            "probe" => !matches!(rest.split_whitespace().next(), Some("insert" | "remove" | "push")),
            _ => false,
        };
        if Event::WORDS.contains(&word) && !is_command {
            let event = Event::parse(text).map_err(|error| ActionError::Wrong(error.to_string()))?;
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            return Ok(Action::Event(event, text));
        }
        let command = text.parse().map_err(|error| match error {
            CommandError::Unknown(word) => ActionError::Unknown(word),
            CommandError::Wrong(what) => ActionError::Wrong(what),
        })?;
        Ok(Action::Command(0, command))
    }

    /// Events happen to the machine as a whole: only commands go to a channel.
    fn command_to(channel: usize, text: &str) -> Result<Action, ActionError> {
        let command = text.parse().map_err(|error: CommandError| {
            let what = format!("{error}; a channel takes commands, events happen to the machine");
            ActionError::Wrong(what)
        });
        command.map(|command| Action::Command(channel, command))
    }
}

impl<C> Action<C> {
    /// A key of the panel is tapped.
    pub fn tap(key: &str) -> Action<C> {
        let event = Event::Key(key.to_owned(), KeyAction::Tap);
        Action::Event(event, format!("key {key} tap"))
    }
}

impl<C: fmt::Display> fmt::Display for Action<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Action::Command(0, command) => command.fmt(f),
            Action::Command(channel, command) => write!(f, "{}: {command}", channel + 1),
            Action::Event(_, text) => f.write_str(text),
        }
    }
}

/// Who has something done to the machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The operator who stands by.
    Operator,
    /// A line of a script whose time has come.
    Script,
    /// The log of another run.
    Log,
    /// Somebody else, by his name.
    Client(String),
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The machine has taken it.
    Done,
    /// The control refuses the command now.
    Refused,
    /// The machine has not what the event names; in words.
    Impossible(String),
}
