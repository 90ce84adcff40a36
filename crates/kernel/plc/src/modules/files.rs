//! Modules 9090 and 9095: pallet programs and axis error compensation [000:15328-15373][000:15547-15585].

use bahn_exchange::signal;

use super::{Call, Outcome};
use crate::{CompensationExcess, CompensationSize, LineFault, PlcError};

/// 9090: selects NC program and datum table of a line of the pallet file.
pub(super) fn execute_pallet_program(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [line] = call.arguments()?;
    let code = pallet(call, line).err().unwrap_or(0);
    call.code(code)
}

fn pallet(call: &mut Call<'_>, line: i32) -> Result<(), i32> {
    const NOT_FROM_SUBMIT: i32 = 1;
    const PROGRAM_STARTED: i32 = 2;
    const WRONG_MODE: i32 = 3;
    const NO_PALLET_FILE: i32 = 4;
    const NO_LINE: i32 = 5;
    const NO_DATUM_TABLE: i32 = 9;
    /// W272: program run single block, program run full sequence.
    const RUN_MODES: [i32; 2] = [4, 5];
    /// Bits of MP7224.0 that disable kinds of files.
    const DATUM_TABLES: u32 = 3;
    const PALLET_FILES: u32 = 4;
    if !call.from_submit {
        return Err(NOT_FROM_SUBMIT);
    }
    if call.nc.program_running() {
        return Err(PROGRAM_STARTED);
    }
    if !RUN_MODES.contains(&call.image.number(signal::OPERATING_MODE)) {
        return Err(WRONG_MODE);
    }
    if disabled(call, PALLET_FILES) {
        return Err(NO_PALLET_FILE);
    }
    let entry = call.nc.pallet_line(line).map_err(|fault| match fault {
        LineFault::NoFile => NO_PALLET_FILE,
        LineFault::NoLine => NO_LINE,
    })?;
    let program = program_name(call, &entry.program)?;
    let datum_table = entry
        .datum_table
        .filter(|_| !disabled(call, DATUM_TABLES))
        .map(|name| {
            if name.contains('.') {
                name
            } else {
                format!("{name}.D")
            }
        });
    if datum_table.as_deref().is_some_and(|name| !call.nc.has_file(name)) {
        return Err(NO_DATUM_TABLE);
    }
    call.nc.select_program(line, &program, datum_table.as_deref());
    Ok(())
}

/// The program that a pallet file names, perhaps without its extension.
fn program_name(call: &Call<'_>, name: &str) -> Result<String, i32> {
    const WRONG_TYPE: i32 = 6;
    const NOT_FOUND: i32 = 7;
    const NOT_CLEAR: i32 = 8;
    /// Characters of a name without extension.
    const NAME_MAX: usize = 8;
    /// Extensions with their bits of MP7224.0.
    const TYPES: [(&str, u32); 2] = [("H", 0), ("I", 1)];
    let exists = |name: &str, bit: u32| !disabled(call, bit) && call.nc.has_file(name);
    if let Some((_, extension)) = name.rsplit_once('.') {
        let (_, bit) = TYPES
            .iter()
            .find(|(known, _)| *known == extension)
            .ok_or(WRONG_TYPE)?;
        return if exists(name, *bit) {
            Ok(name.to_owned())
        } else {
            Err(NOT_FOUND)
        };
    }
    if name.chars().count() > NAME_MAX {
        return Err(WRONG_TYPE);
    }
    let mut found = TYPES
        .iter()
        .map(|(extension, bit)| (format!("{name}.{extension}"), *bit))
        .filter(|(name, bit)| exists(name, *bit))
        .map(|(name, _)| name);
    match (found.next(), found.next()) {
        (None, _) => Err(NOT_FOUND),
        (Some(name), None) => Ok(name),
        (Some(_), Some(_)) => Err(NOT_CLEAR),
    }
}

/// Whether MP7224.0 disables a type of file.
fn disabled(call: &Call<'_>, bit: u32) -> bool {
    call.parameter(7224, 0) as u32 >> bit & 1 != 0
}

/// 9095: activates a line of the assignment of compensation tables.
pub(super) fn select_compensation(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [line] = call.arguments()?;
    let code = compensation(call, line).err().unwrap_or(0);
    call.code(code)
}

/// The last code is printed as 5, which another error has already: it is 8 (inferred).
fn compensation(call: &mut Call<'_>, line: i32) -> Result<(), i32> {
    const NO_LINE: i32 = 1;
    const NO_TABLE: i32 = 2;
    const TABLE_TOO_LONG: i32 = 3;
    const TOO_MANY_POINTS: i32 = 4;
    const TOO_MANY_TABLES: i32 = 5;
    const NO_FILE: i32 = 6;
    const NOT_FROM_SUBMIT: i32 = 7;
    const WITHOUT_STROBE: i32 = 8;
    if !call.from_submit {
        return Err(NOT_FROM_SUBMIT);
    }
    if call.runs_without_strobe() {
        return Err(WITHOUT_STROBE);
    }
    let tables = call.nc.compensation_line(line).map_err(|fault| match fault {
        LineFault::NoFile => NO_FILE,
        LineFault::NoLine => NO_LINE,
    })?;
    let tables: Vec<CompensationSize> = tables.into_iter().collect::<Option<_>>().ok_or(NO_TABLE)?;
    match CompensationExcess::of(&tables) {
        Some(CompensationExcess::PointsOfDependency) => return Err(TABLE_TOO_LONG),
        Some(CompensationExcess::Dependencies) => return Err(TOO_MANY_TABLES),
        Some(CompensationExcess::Points) => return Err(TOO_MANY_POINTS),
        None => {}
    }
    call.nc.activate_compensation(line);
    Ok(())
}
