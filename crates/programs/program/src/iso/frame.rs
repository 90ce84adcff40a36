//! `%NAME G71 *` at both ends of a program, and `%NAME`, which calls one.

use bahn_parameters::MessageId::{EntryValueIncorrect, UnexpectedText};

use super::code::without_end;
use crate::parse::cursor::{Cursor, Parsed};
use crate::text::{to_words, trim};
use crate::{Header, Operation, Unit};

/// Whether a text that begins with `%` frames a program: it has a unit or no name.
#[inline]
pub(super) fn frame_words(text: &[u8]) -> bool {
    let (code, _) = super::code::split(text);
    header(code.get(1..).unwrap_or_default()).is_some()
}

/// `%NAME G71` with the unit frames a program; without it `%NAME` calls one.
pub(super) fn frame_or_call(c: &mut Cursor, may_begin: bool) -> Parsed<Operation> {
    let start = c.position();
    c.advance(1);
    let length = c.rest().len();
    let text = without_end(c.rest());
    if let Some(header) = header(text) {
        c.advance(length);
        let header = Box::new(header);
        return Ok(match may_begin {
            true => Operation::Begin(header),
            false => Operation::End(header),
        });
    }
    let name = to_words(text);
    c.advance(length);
    if name.is_empty() {
        return c.fault_from(start, EntryValueIncorrect, "the name of the program is missing");
    }
    Ok(Operation::CallProgram(name))
}

/// A `%` after other words.
#[cold]
pub(super) fn misplaced<T>(c: &mut Cursor) -> Parsed<T> {
    let start = c.position();
    c.advance(c.rest().len());
    c.fault_from(start, UnexpectedText, "a program is called in a block of its own")
}

/// Name, unit and protection after `%`; `None` if that is the name of a program to call.
fn header(text: &[u8]) -> Option<Header> {
    let mut name = trim(without_end(text));
    let mut header = Header {
        name: "".into(),
        unit: None,
        protected: false,
    };
    while let Some((before, last)) = last_word(name) {
        match last {
            b"G70" | b"g70" if header.unit.is_none() => header.unit = Some(Unit::Inch),
            b"G71" | b"g71" if header.unit.is_none() => header.unit = Some(Unit::Mm),
            b"G50" | b"g50" if !header.protected => header.protected = true,
            _ => break,
        }
        name = before;
    }
    header.name = to_words(name);
    let frames = header.unit.is_some() || header.protected || header.name.is_empty();
    frames.then_some(header)
}

/// The last word of a text and what stands before it.
fn last_word(text: &[u8]) -> Option<(&[u8], &[u8])> {
    let text = trim(text);
    if text.is_empty() {
        return None;
    }
    let start = text
        .iter()
        .rposition(|&b| crate::text::is_blank(b))
        .map_or(0, |blank| blank + 1);
    let (before, last) = text.split_at_checked(start)?;
    Some((trim(before), last))
}
