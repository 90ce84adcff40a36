//! Names of parameters: `q102`, `P7000`, `2:P7000`.
//!
//! Decision: A parameter is named by its channel parameter of channel 1 without the channel, by that of another channel
//! with it. `K2:P7000`, as data files write it, is read wherever a name is; blanks and case do not count

use std::fmt;
use std::str::FromStr;

/// The name of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Name {
    /// System parameter: its number.
    Q(u32),
    /// Channel parameter: channel from 1 on, number.
    P(u8, u32),
}

/// It is no name of a parameter.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no parameter: q102, P7000, 2:P7000")]
pub struct NoName(pub String);

/// Longer words are shortened where they are repeated.
const SHOWN_MAX: usize = 40;

/// A word of somebody, as a message repeats it.
pub(crate) fn repeated(text: &str) -> String {
    match text.char_indices().nth(SHOWN_MAX) {
        Some((end, _)) => format!("{}..", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

impl Name {
    /// Channel and number of a channel parameter.
    pub fn of_channel(self) -> Option<(u8, u32)> {
        match self {
            Name::Q(_) => None,
            Name::P(channel, number) => Some((channel, number)),
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Name::Q(number) => write!(f, "q{number}"),
            Name::P(1, number) => write!(f, "P{number}"),
            Name::P(channel, number) => write!(f, "{channel}:P{number}"),
        }
    }
}

impl serde::Serialize for Name {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for Name {
    type Err = NoName;

    fn from_str(text: &str) -> Result<Name, NoName> {
        read(text).ok_or_else(|| NoName(repeated(text.trim())))
    }
}

fn read(text: &str) -> Option<Name> {
    let compact: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let letter = compact.find(['q', 'Q', 'p', 'P'])?;
    let (before, from) = compact.split_at_checked(letter)?;
    let number = digits(from.get(1..)?)?;
    if from.starts_with(['q', 'Q']) {
        return before.is_empty().then_some(Name::Q(number));
    }
    if before.is_empty() {
        return Some(Name::P(1, number));
    }
    let channel = before.strip_prefix(['K', 'k']).unwrap_or(before);
    let channel = digits(channel.strip_suffix(':')?)?;
    Some(Name::P(channel.try_into().ok()?, number))
}

fn digits(text: &str) -> Option<u32> {
    let all = !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_digit());
    all.then(|| text.parse().ok()).flatten()
}
