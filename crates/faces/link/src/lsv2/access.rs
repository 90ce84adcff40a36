//! Logins, and what they are good for.

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use bahn_access::is_secret;
use bahn_parameters::code_numbers::PLC_MODE;

/// What a login is for. It holds for one connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Level {
    /// Reads what the control is.
    Inspect,
    /// Log book, date, keys.
    Diagnostics,
    /// Files of drive `TNC:`.
    File,
    /// Files of drive `PLC:`, too.
    FilePlc,
    /// The run, messages to the PLC.
    Dnc,
    /// Keys and screen of the control.
    Monitor,
    /// Memory of the PLC, changes of machine parameters.
    PlcDebug,
    /// Data by their path.
    Data,
}

/// The names by which clients log in (public).
const NAMES: &[(Level, &str)] = &[
    (Level::Inspect, "INSPECT"),
    (Level::Diagnostics, "DIAGNOSTICS"),
    (Level::File, "FILE"),
    (Level::FilePlc, "FILEPLC"),
    (Level::Dnc, "DNC"),
    (Level::Monitor, "MONITOR"),
    (Level::PlcDebug, "PLCDEBUG"),
    (Level::Data, "DATA"),
];

/// Characters of a password at most (public).
const PASSWORD_MAX: usize = 16;

impl Level {
    /// All levels of access.
    pub fn all() -> impl Iterator<Item = Level> {
        NAMES.iter().map(|(level, _)| *level)
    }

    /// The name of the level as a client sends it at login.
    pub fn name(self) -> &'static str {
        let row = NAMES.iter().find(|(level, _)| *level == self);
        row.map_or("", |(_, name)| name)
    }
}

impl FromStr for Level {
    type Err = String;

    fn from_str(text: &str) -> Result<Level, String> {
        let row = NAMES.iter().find(|(_, name)| name.eq_ignore_ascii_case(text));
        row.map(|(level, _)| *level).ok_or_else(|| {
            let names: Vec<&str> = NAMES.iter().map(|(_, name)| *name).collect();
            format!("{text} is no login; there are {}", names.join(", "))
        })
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The passwords of the levels.
///
/// ```
/// use bahn_link::lsv2::{Level, Passwords};
///
/// let mut passwords = Passwords::default();
/// assert!(passwords.admit(Level::File, "") && !passwords.admit(Level::FilePlc, ""));
/// passwords.set("FILE=steel")?;
/// assert!(!passwords.admit(Level::File, "") && passwords.admit(Level::File, "steel"));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Passwords {
    set: Vec<(Level, String)>,
}

impl Passwords {
    /// Sets one: `LEVEL=TEXT`.
    ///
    /// # Errors
    /// When there is no such level, or the text is empty or longer than 16 characters.
    pub fn set(&mut self, assignment: &str) -> Result<(), String> {
        let (level, text) = assignment
            .split_once('=')
            .ok_or_else(|| format!("{assignment} is not LEVEL=TEXT"))?;
        let level: Level = level.parse()?;
        if text.is_empty() || text.len() > PASSWORD_MAX || !text.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(format!(
                "the password of {level} needs 1 to {PASSWORD_MAX} characters without blanks"
            ));
        }
        self.set.retain(|(known, _)| *known != level);
        self.set.push((level, text.to_owned()));
        Ok(())
    }

    /// The code number that PLC files need [000:16915] is the password of their level, unless another one is set.
    fn of(&self, level: Level) -> Option<Cow<'_, str>> {
        let set = self.set.iter().find(|(known, _)| *known == level);
        let default = || (level == Level::FilePlc).then(|| PLC_MODE.to_string().into());
        set.map(|(_, text)| text.into()).or_else(default)
    }

    /// Whether a login with this password is admitted.
    pub fn admit(&self, level: Level, password: &str) -> bool {
        self.of(level).is_none_or(|text| is_secret(password, &text))
    }

    /// Levels that nobody has set a password for; at an address that others reach there may be none.
    pub fn missing(&self) -> impl Iterator<Item = Level> {
        Level::all().filter(|level| !self.set.iter().any(|(known, _)| known == level))
    }
}
