//! Parts of the code of a block that all its readers need.

use bahn_parameters::MessageId::{
    AxisDoubleProgrammed, EntryValueIncorrect, UnexpectedText, WrongAxisProgrammed,
};
use bahn_path::{Axis, AxisSet};

use crate::parse::cursor::{Cursor, Parsed};
use crate::text::{is_blank, trim_continuation};
use crate::{Coordinates, Distance, Word};

/// The code of a line without its `*`, and the comment after it with its `;`.
#[inline]
pub(super) fn split(line: &[u8]) -> (&[u8], &[u8]) {
    let length = memchr::memchr(b';', line).unwrap_or(line.len());
    let (code, comment) = line.split_at_checked(length).unwrap_or_default();
    (without_star(code), comment)
}

/// The text without blanks and any `*` at its end.
#[inline]
pub(super) fn without_star(text: &[u8]) -> &[u8] {
    let mut text = trim_end(text);
    while let Some(before) = text.strip_suffix(b"*") {
        text = trim_end(before);
    }
    text
}

/// The text without what a listing does not have at its end: `*`, and `~` of other languages.
pub(super) fn without_end(mut text: &[u8]) -> &[u8] {
    loop {
        let shorter = without_star(trim_continuation(text));
        if shorter.len() == text.len() {
            return text;
        }
        text = shorter;
    }
}

#[inline]
fn trim_end(mut text: &[u8]) -> &[u8] {
    while let [before @ .., last] = text
        && is_blank(*last)
    {
        text = before;
    }
    text
}

/// Whether nothing of the code is left.
#[inline]
pub(super) fn end(c: &mut Cursor) -> bool {
    c.skip_blanks();
    !c.remains(0)
}

/// `G` and its number.
pub(super) fn g_code(c: &mut Cursor) -> Parsed<u16> {
    let start = c.position();
    c.advance(1);
    c.required_integer(start, 999, "the number of the G function is missing")
}

/// How words count after G90 or G91; every other code means G90.
pub(super) fn distance(code: u16) -> Distance {
    match code {
        91 => Distance::Incremental,
        _ => Distance::Absolute,
    }
}

/// The tool axis of G17 to G19.
pub(super) fn plane(c: &mut Cursor, start: usize, code: u16) -> Parsed<Axis> {
    match code {
        17 => Ok(Axis::Z),
        18 => Ok(Axis::Y),
        19 => Ok(Axis::X),
        _ => c.fault_from(
            start,
            WrongAxisProgrammed,
            "G20: the fourth axis is no tool axis here",
        ),
    }
}

/// An axis word; it may be incremental by a G91 of an earlier block where none stands before it.
#[inline]
pub(super) fn coordinate(
    c: &mut Cursor,
    axis: Axis,
    coordinates: &mut Coordinates,
    open: &mut AxisSet,
    distance: Option<Distance>,
) -> Parsed<()> {
    let start = c.position();
    c.advance(1);
    let value = c.required_value(start)?;
    if coordinates.axes().contains(axis) {
        return c.fault_from(
            start,
            AxisDoubleProgrammed,
            "the axis has two values in this block",
        );
    }
    let incremental = distance == Some(Distance::Incremental);
    coordinates.set(axis, Word { value, incremental });
    if distance.is_none() {
        open.insert(axis);
    }
    Ok(())
}

/// Sets what may stand once in a block.
#[inline]
pub(super) fn once<T>(c: &mut Cursor, start: usize, slot: &mut Option<T>, value: T) -> Parsed<()> {
    if slot.is_some() {
        return c.fault_from(start, UnexpectedText, "this stands twice in the block");
    }
    *slot = Some(value);
    Ok(())
}

/// Values after a word must be there.
pub(super) fn missing<T>(c: &mut Cursor, start: usize, what: &'static str) -> Parsed<T> {
    c.fault_from(start, EntryValueIncorrect, what)
}
