//! A line of the text: its characters with their columns, without comments and with macros replaced.
//!
//! Decision: Names of synchronisation types are macros that need no definition, as in the listings of Fig. 23 and 24;
//! macros and P parameters end with their program

use std::collections::BTreeMap;

use bahn_path::Synchronisation;
use bahn_text::Span;

/// What is wrong in a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineFault {
    /// Column of its first character, from 1.
    pub column: u32,
    /// How many characters it covers.
    pub length: u32,
    /// What is wrong, with the name of what is not known.
    pub message: String,
}

impl LineFault {
    /// Its place in a file where the line has this number.
    pub(crate) fn span(&self, line: u32) -> Span {
        Span {
            line,
            column: self.column,
            length: self.length,
        }
    }

    /// Whether a word is not known, whatever stands after it.
    pub(crate) fn names_unknown(&self) -> bool {
        self.message.starts_with("unknown")
    }
}

/// A character and where it stands in the line; what comes from a macro stands where the macro does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glyph {
    pub character: char,
    pub column: u32,
}

/// Longest line after the replacement of macros.
const MAX_LENGTH: usize = 4096;

/// Macros that stand for each other end here.
const MAX_NESTING: u32 = 10;

/// Where a comment stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Comment {
    /// Index of its first character.
    pub start: usize,
    /// Index after its last one.
    pub end: usize,
}

/// The comments of a line: `( )`, `(* *)` and `;` [004:60] [004:123] [004:129]. None begins in a text in quotes. One in
/// brackets ends at the end of its line where no bracket closes it (public).
pub(crate) fn comments(line: &[char]) -> Vec<Comment> {
    let mut found = Vec::new();
    let mut quote = None;
    let mut at = 0;
    while let Some(character) = line.get(at) {
        match (quote, *character) {
            (Some(open), close) if open == close => quote = None,
            (Some(_), '\\') => at += 1,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(*character),
            (None, ';') => {
                found.push(Comment {
                    start: at,
                    end: line.len(),
                });
                break;
            }
            (None, '(') => {
                let comment = bracketed(line, at);
                found.push(comment);
                at = comment.end;
                continue;
            }
            (None, _) => {}
        }
        at += 1;
    }
    found
}

fn bracketed(line: &[char], start: usize) -> Comment {
    let rest = line.get(start + 1..).unwrap_or_default();
    let inner = match rest.first() {
        // The star that opens is not the one that closes.
        Some('*') => rest
            .iter()
            .zip(rest.iter().skip(1))
            .skip(1)
            .position(|pair| pair == (&'*', &')'))
            .map(|place| place + 3),
        _ => rest.iter().position(|c| *c == ')').map(|place| place + 1),
    };
    Comment {
        start,
        end: inner.map_or(line.len(), |length| start + 1 + length),
    }
}

/// The characters of a line without its comments, each of which parts words as a blank does.
pub(crate) fn glyphs(line: &str) -> Vec<Glyph> {
    let characters: Vec<char> = line.chars().collect();
    without(&characters, &comments(&characters))
}

/// The characters of a line without these comments, which are in their order.
pub(crate) fn without(characters: &[char], comments: &[Comment]) -> Vec<Glyph> {
    let mut result = Vec::with_capacity(characters.len());
    let mut at = 0;
    for comment in comments {
        append(&mut result, characters, at..comment.start);
        result.push(Glyph {
            character: ' ',
            column: column(comment.start),
        });
        at = comment.end;
    }
    append(&mut result, characters, at..characters.len());
    result
}

/// The text of each comment with its column.
pub(crate) fn said(characters: &[char], comments: &[Comment]) -> Vec<(u32, String)> {
    let text = |comment: &Comment| {
        let own = characters.get(comment.start..comment.end)?;
        Some((column(comment.start), own.iter().collect()))
    };
    comments.iter().filter_map(text).collect()
}

/// Where a command stands in a line outside of other comments and quotes, in characters.
pub(crate) fn command(line: &str, from: usize, command: &str) -> Option<usize> {
    if !line.contains('#') {
        return None;
    }
    let characters: Vec<char> = line.chars().collect();
    let comments = comments(&characters);
    let is_code = |at: usize| {
        !comments
            .iter()
            .any(|comment| (comment.start..comment.end).contains(&at))
    };
    let is_here = |at: usize| {
        let there = characters.get(at..).unwrap_or_default();
        there.len() >= command.len()
            && there
                .iter()
                .zip(command.chars())
                .all(|(a, b)| a.eq_ignore_ascii_case(&b))
    };
    (from..characters.len()).find(|at| is_here(*at) && is_code(*at))
}

/// Blanks in place of the characters of a range.
pub(crate) fn blank(line: &mut String, from: usize, to: usize) {
    let blanked = |(at, character)| if (from..to).contains(&at) { ' ' } else { character };
    *line = line.chars().enumerate().map(blanked).collect();
}

fn append(to: &mut Vec<Glyph>, characters: &[char], range: std::ops::Range<usize>) {
    let first = range.start;
    for (i, character) in characters.get(range).unwrap_or_default().iter().enumerate() {
        to.push(Glyph {
            character: *character,
            column: column(first + i),
        });
    }
}

/// Column from 1 of a character by its index from 0.
fn column(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX).saturating_add(1)
}

/// Names in quotes that stand for a text [004:123]. Capital and small letters differ (public).
#[derive(Clone, Debug)]
pub(crate) struct Macros(BTreeMap<String, String>);

/// Most macros of a program.
const MAX_MACROS: usize = 10_000;

impl Default for Macros {
    /// Synchronisation types, whose names the listings of Fig. 23 and 24 use without defining them [004:144]: they stand for
    /// their values unless the program defines them (inferred).
    fn default() -> Macros {
        let types = Synchronisation::all().map(|kind| (kind.name().to_owned(), kind.bits().to_string()));
        Macros(types.collect())
    }
}

impl Macros {
    /// Gives a name its text.
    pub fn define(&mut self, name: &str, text: &str) -> Result<(), String> {
        if self.0.len() >= MAX_MACROS && !self.0.contains_key(name) {
            return Err(format!(
                "\"{name}\" is more than the {MAX_MACROS} macros of a program"
            ));
        }
        self.0.insert(name.to_owned(), text.to_owned());
        Ok(())
    }

    /// The first macro of a line that has no text, with its index.
    pub fn first_unknown(&self, line: &[Glyph]) -> Result<Option<(usize, String)>, LineFault> {
        let mut at = 0;
        while let Some(glyph) = line.get(at) {
            if glyph.character != '"' {
                at += 1;
                continue;
            }
            let (name, end) = quoted(line, at)?;
            if !self.0.contains_key(&name) {
                return Ok(Some((at, name)));
            }
            at = end;
        }
        Ok(None)
    }

    /// The line with the text of each macro in its place.
    pub fn expand(&self, line: &[Glyph]) -> Result<Vec<Glyph>, LineFault> {
        let mut result = Vec::with_capacity(line.len());
        self.expand_into(&mut result, line, 0)?;
        Ok(result)
    }

    fn expand_into(&self, to: &mut Vec<Glyph>, line: &[Glyph], depth: u32) -> Result<(), LineFault> {
        let mut at = 0;
        while let Some(glyph) = line.get(at) {
            if to.len() >= MAX_LENGTH {
                return Err(fault_at(
                    glyph.column,
                    1,
                    "the macros make the line too long".into(),
                ));
            }
            if glyph.character != '"' {
                to.push(*glyph);
                at += 1;
                continue;
            }
            let (name, end) = quoted(line, at)?;
            let length = name.chars().count() as u32 + 2;
            let text = self
                .0
                .get(&name)
                .ok_or_else(|| unknown_macro(glyph.column, &name))?;
            if depth >= MAX_NESTING {
                return Err(fault_at(
                    glyph.column,
                    length,
                    format!("macro \"{name}\" is nested too deep"),
                ));
            }
            let inner: Vec<Glyph> = text
                .chars()
                .map(|character| Glyph {
                    character,
                    column: glyph.column,
                })
                .collect();
            self.expand_into(to, &inner, depth + 1)?;
            at = end;
        }
        Ok(())
    }
}

/// The text in the quotes that open at an index, and the index after the closing ones. `\"` is a quote within (public).
pub(crate) fn quoted(line: &[Glyph], start: usize) -> Result<(String, usize), LineFault> {
    let mut text = String::new();
    let mut at = start + 1;
    while let Some(glyph) = line.get(at) {
        match glyph.character {
            '"' => return Ok((text, at + 1)),
            '\\' if line.get(at + 1).is_some_and(|next| next.character == '"') => {
                text.push('"');
                at += 1;
            }
            other => text.push(other),
        }
        at += 1;
    }
    let column = line.get(start).map_or(1, |glyph| glyph.column);
    Err(fault_at(column, 1, "quote \" is not closed".into()))
}

/// A macro that stands at a column and has no text.
pub(crate) fn unknown_macro(column: u32, name: &str) -> LineFault {
    let length = u32::try_from(name.chars().count()).unwrap_or(u32::MAX);
    fault_at(
        column,
        length.saturating_add(2),
        format!("unknown macro \"{name}\""),
    )
}

pub(crate) fn fault_at(column: u32, length: u32, message: String) -> LineFault {
    LineFault {
        column,
        length: length.max(1),
        message,
    }
}
