//! Modules 9092 to 9094: tool, datum and pocket table [000:15375-15545].

use super::{Call, Outcome};
use crate::{Column, PlcError, TableFile, TableKind};

/// The element of the pocket table that names the tool in the pocket, and what it says of a vacant one [000:15422].
const TOOL_NUMBER: i32 = 0;
const NO_TOOL: i32 = -1;

/// 9092: the first line from a start line on where an element has a value. The line is pulled first. The
/// vacant pocket is looked for as that of tool 0 [000:15379].
pub(super) fn search(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [kind, value, element, start] = call.arguments()?;
    let vacant = TableKind::numbered(kind) == Some(TableKind::Pocket) && element == TOOL_NUMBER && value == 0;
    let found = table(call, kind, start, element).and_then(|(table, column)| {
        let mut line = table.next_line(start);
        while let Some(at) = line {
            let there = read_element(table, at, element, column);
            if there == Some(value) || vacant && there == Some(NO_TOOL) {
                return Ok(at);
            }
            line = at.checked_add(1).and_then(|next| table.next_line(next));
        }
        Err(Fault::ValueNotFound)
    });
    results(call, found, -1)
}

/// 9093: reads an element of a line. The value is pulled first.
pub(super) fn read(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [kind, line, element] = call.arguments()?;
    let value = table(call, kind, line, element)
        .and_then(|(table, column)| read_element(table, line, element, column).ok_or(Fault::WrongElement));
    results(call, value, 0)
}

/// 9094: writes an element of a line; the geometry is initialised anew.
pub(super) fn write(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [kind, line, element, value] = call.arguments()?;
    let written = table(call, kind, line, element).and_then(|(table, column)| {
        let value = f64::from(value) / shift(column);
        if !(column.min..=column.max).contains(&value) {
            return Err(Fault::ValueOutOfRange);
        }
        table.set_value(line, element as usize, value);
        Ok(())
    });
    if written.is_ok() {
        call.nc.initialise_geometry();
    }
    let code = written.err().map_or(0, Fault::code);
    call.code(code)
}

enum Fault {
    NotFromSubmit,
    WrongKind,
    NoFile,
    NoLine,
    WrongElement,
    ValueNotFound,
    ValueOutOfRange,
}

impl Fault {
    fn code(self) -> i32 {
        match self {
            Fault::NotFromSubmit => 1,
            Fault::WrongKind => 2,
            Fault::NoFile => 3,
            Fault::NoLine => 4,
            Fault::WrongElement => 5,
            Fault::ValueNotFound | Fault::ValueOutOfRange => 6,
        }
    }
}

/// The table with M status and its column, when line and element exist. Elements that the manual calls
/// spare do not exist (inferred).
fn table<'c>(
    call: &'c mut Call<'_>,
    kind: i32,
    line: i32,
    element: i32,
) -> Result<(&'c mut dyn TableFile, &'static Column), Fault> {
    if !call.from_submit {
        return Err(Fault::NotFromSubmit);
    }
    let kind = TableKind::numbered(kind).ok_or(Fault::WrongKind)?;
    let table = call.nc.table(kind).ok_or(Fault::NoFile)?;
    if table.next_line(line) != Some(line) {
        return Err(Fault::NoLine);
    }
    let column = kind.column(element).ok_or(Fault::WrongElement)?;
    Ok((table, column))
}

/// Values are whole numbers, shifted by the decimal places of the column [000:15388].
fn read_element(table: &dyn TableFile, line: i32, element: i32, column: &Column) -> Option<i32> {
    let value = table.value(line, usize::try_from(element).ok()?)?;
    Some((value * shift(column)).round() as i32)
}

fn shift(column: &Column) -> f64 {
    10_f64.powi(column.decimals.into())
}

/// Pushes the error number and above it the value, or what stands for it.
fn results(call: &mut Call<'_>, value: Result<i32, Fault>, otherwise: i32) -> Result<Outcome, PlcError> {
    let (value, code) = match value {
        Ok(value) => (value, 0),
        Err(fault) => (otherwise, fault.code()),
    };
    call.result(code)?;
    call.result(value)?;
    Ok(Outcome::of(code == 0))
}
