//! Programs and cycles as the NC memory and the FLASH keep them: names and bytes.
//!
//! Decision: A program is `P` and its number, a cycle `Z` and its number, as P8800 and M functions call them

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use crate::name::repeated;

/// The name of a program or cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ProgramName {
    /// `P1000`.
    Program(u32),
    /// `Z6`.
    Cycle(u32),
}

/// It is no name of a program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no program: P1000, Z6")]
pub struct NoProgramName(String);

impl ProgramName {
    /// That of a file: `P1000` of `P1000.900`.
    ///
    /// ```
    /// use bahn_system900::ProgramName;
    /// assert_eq!(ProgramName::of_file("Z6.900"), Some(ProgramName::Cycle(6)));
    /// assert_eq!(ProgramName::of_file("1000.900"), None);
    /// ```
    pub fn of_file(name: &str) -> Option<ProgramName> {
        let stem = name.split('.').next()?;
        let number = |digits: &str| digits.parse().ok();
        match stem.split_at_checked(1)? {
            ("P" | "p", digits) => number(digits).map(ProgramName::Program),
            ("Z" | "z", digits) => number(digits).map(ProgramName::Cycle),
            _ => None,
        }
    }

    /// Whether it is a cycle.
    pub fn is_cycle(self) -> bool {
        matches!(self, ProgramName::Cycle(_))
    }
}

impl fmt::Display for ProgramName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProgramName::Program(number) => write!(f, "P{number}"),
            ProgramName::Cycle(number) => write!(f, "Z{number}"),
        }
    }
}

impl FromStr for ProgramName {
    type Err = NoProgramName;

    fn from_str(text: &str) -> Result<ProgramName, NoProgramName> {
        let wrong = || NoProgramName(repeated(text));
        let digits = text.get(1..).ok_or_else(wrong)?;
        let all = digits.bytes().all(|digit| digit.is_ascii_digit());
        let number = digits.parse().ok().filter(|_| all).ok_or_else(wrong)?;
        match text.chars().next() {
            Some('P' | 'p') => Ok(ProgramName::Program(number)),
            Some('Z' | 'z') => Ok(ProgramName::Cycle(number)),
            _ => Err(wrong()),
        }
    }
}

/// Programs and cycles by their names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Programs(BTreeMap<ProgramName, Vec<u8>>);

impl Programs {
    /// Takes a program, in place of one of the same name.
    pub fn insert(&mut self, name: ProgramName, bytes: Vec<u8>) {
        self.0.insert(name, bytes);
    }

    /// The bytes of a program.
    pub fn get(&self, name: ProgramName) -> Option<&[u8]> {
        self.0.get(&name).map(Vec::as_slice)
    }

    /// Takes a program away; whether there was one.
    pub fn remove(&mut self, name: ProgramName) -> bool {
        self.0.remove(&name).is_some()
    }

    /// Takes all of them away.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// All of them, programs before cycles, by their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (ProgramName, &[u8])> {
        self.0.iter().map(|(name, bytes)| (*name, bytes.as_slice()))
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// How many bytes all of them have.
    pub fn bytes(&self) -> usize {
        self.0.values().map(Vec::len).sum()
    }
}
