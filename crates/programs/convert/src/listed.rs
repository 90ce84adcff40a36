//! The report of a conversion for people.

use bahn_program::{IsoLanguage, PlainLanguage};
use serde::Serialize;

/// A language of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// HEIDENHAIN plain language, files `.H`.
    Plain,
    /// DIN/ISO, files `.I`.
    Iso,
}

impl Language {
    /// How it is read and written.
    pub fn of(self) -> &'static dyn bahn_program::Language {
        match self {
            Language::Plain => &PlainLanguage,
            Language::Iso => &IsoLanguage,
        }
    }

    /// What the names of its files end with.
    pub const fn ending(self) -> &'static str {
        match self {
            Language::Plain => "H",
            Language::Iso => "I",
        }
    }
}

/// A block that could not be said as it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Listed {
    /// What reports call the block.
    pub block: u32,
    /// Its line in the file.
    pub line: u32,
    /// The block as it stands in the source.
    pub text: String,
    /// Why it is refused or left out.
    pub reason: String,
}
