//! What is done to a System 900: a parameter gets a value, by the operator or by the PLC.

use std::fmt;
use std::str::FromStr;

use bahn_system900::{Name, Value};

/// Who writes a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The operator in the parameter editor: locks hold him back.
    Operator,
    /// The operator with keys, and at pages for zero points and tools: the lock of the editor holds him not back there, all
    /// others do.
    Panel,
    /// The PLC, which no lock holds back.
    Plc,
}

/// A parameter gets a value.
///
/// ```
/// use bahn_host::{By, Command900};
/// let command: Command900 = "plc 2:P8706=1".parse()?;
/// assert_eq!((command.by, command.to_string()), (By::Plc, "plc 2:P8706=1".to_owned()));
/// assert_eq!("k1 : p 8682 = 2".parse::<Command900>()?.to_string(), "P8682=2");
/// assert_eq!("P8682".parse::<Command900>(), Err("it is written `P8682=2`, or `plc P8706=1`".to_owned()));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Command900 {
    /// Who writes it.
    pub by: By,
    /// Which.
    pub name: Name,
    /// What it gets.
    pub value: Value,
    /// The value as it was written.
    written: String,
}

/// The first word of what the PLC does, and of what is done with keys.
const PLC: &str = "plc";
const PANEL: &str = "panel";

impl Command900 {
    /// The operator gives a parameter a whole number.
    pub fn by_operator(name: Name, number: i64) -> Command900 {
        Command900 {
            by: By::Operator,
            name,
            value: Value::Decimal {
                digits: number,
                decimals: 0,
            },
            written: number.to_string(),
        }
    }

    /// The operator gives a parameter a value with a key, or at a page for it.
    ///
    /// # Errors
    /// In words, when the value is none.
    pub fn at_the_panel(name: Name, value: &str) -> Result<Command900, String> {
        assignment(By::Panel, &format!("{name}={value}"))
    }

    /// Several of one writer: `P8682=2, 2:P8043=1`.
    ///
    /// # Errors
    /// In words.
    pub fn parse_all(text: &str) -> Result<Vec<Command900>, String> {
        let (by, rest) = writer(text);
        rest.split(',').map(|part| assignment(by, part)).collect()
    }
}

/// Who writes, and the rest.
fn writer(text: &str) -> (By, &str) {
    let text = text.trim();
    match text.split_once(char::is_whitespace) {
        Some((PLC, rest)) => (By::Plc, rest),
        Some((PANEL, rest)) => (By::Panel, rest),
        _ => (By::Operator, text),
    }
}

fn assignment(by: By, text: &str) -> Result<Command900, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("it is written `P8682=2`, or `plc P8706=1`")?;
    let written = value.trim().to_owned();
    Ok(Command900 {
        by,
        name: name
            .parse()
            .map_err(|error: bahn_system900::NoName| error.to_string())?,
        value: written
            .parse()
            .map_err(|error: bahn_system900::ValueError| error.to_string())?,
        written,
    })
}

impl FromStr for Command900 {
    type Err = String;

    fn from_str(text: &str) -> Result<Command900, String> {
        let (by, rest) = writer(text);
        assignment(by, rest)
    }
}

impl fmt::Display for Command900 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.by {
            By::Operator => {}
            By::Panel => write!(f, "{PANEL} ")?,
            By::Plc => write!(f, "{PLC} ")?,
        }
        write!(f, "{}={}", self.name, self.written)
    }
}
