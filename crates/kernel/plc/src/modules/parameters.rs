//! Modules 9031 to 9033: machine parameters [000:14851-14897][000:10084-10088].

use bahn_parameters::{Change, Definition};

use super::{Call, Outcome};
use crate::{ParameterFault, ParameterFileFault, PlcError};

/// 9031: overwrites a machine parameter in the run-time memory. The page is lost; the arguments are in the
/// order of 9032 with the value after them (inferred).
pub(super) fn overwrite(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [number, index, value] = call.arguments()?;
    let code = overwrite_code(call, number, index, value);
    call.code(code)
}

fn overwrite_code(call: &mut Call<'_>, number: i32, index: i32, value: i32) -> i32 {
    const NOT_MODIFIABLE: i32 = 1;
    const OUT_OF_RANGE: i32 = 2;
    const NOT_SAVED: i32 = 3;
    const NOT_FROM_SUBMIT: i32 = 4;
    const WITHOUT_STROBE: i32 = 5;
    if !call.from_submit {
        return NOT_FROM_SUBMIT;
    }
    if call.runs_without_strobe() {
        return WITHOUT_STROBE;
    }
    let Some(definition) = definition(call, number, index) else {
        return NOT_MODIFIABLE;
    };
    let modifiable = match definition.change {
        Change::List => false,
        Change::PlcEdit => !call.nc.program_running(),
        Change::PlcRun => true,
    };
    if !modifiable {
        return NOT_MODIFIABLE;
    }
    let Ok(value) = definition.check(f64::from(value) / shift(definition)) else {
        return OUT_OF_RANGE;
    };
    let (number, index) = (definition.id.number, definition.id.index.unwrap_or(0));
    match call.nc.change_parameter(number, index, value) {
        Ok(()) => 0,
        Err(_) => NOT_SAVED,
    }
}

/// 9032: reads the editable list; the result is the value, or the code of an error [000:14851-14882].
pub(super) fn read(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const NOT_FROM_SUBMIT: i32 = 6;
    let [number, index] = call.arguments()?;
    if !call.from_submit {
        return call.code(NOT_FROM_SUBMIT);
    }
    let value = definition(call, number, index)
        .ok_or(ParameterFault::NoSuchNumber)
        .and_then(|definition| {
            let (number, index) = (definition.id.number, definition.id.index.unwrap_or(0));
            let value = call.nc.editable_parameter(number, index)?;
            Ok((value * shift(definition)).round() as i32)
        });
    match value {
        Ok(value) => {
            call.result(value)?;
            Ok(Outcome::Done)
        }
        Err(fault) => call.code(match fault {
            ParameterFault::NoSuchNumber => 1,
            ParameterFault::NoSeparator => 2,
            ParameterFault::OutOfRange => 3,
            ParameterFault::NotInFile => 4,
            ParameterFault::NoFile => 5,
        }),
    }
}

/// 9033: selects a list of machine parameters; the control restarts when it was not selected already.
/// Arguments and codes are lost: one string number, one code, 4 and 5 as those of 9031 (inferred)
/// [000:14884-14897].
pub(super) fn select_file(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    const WRONG_NAME: i32 = 1;
    const NOT_FOUND: i32 = 2;
    const FAULTY: i32 = 3;
    const NOT_FROM_SUBMIT: i32 = 4;
    const WITHOUT_STROBE: i32 = 5;
    let [string] = call.arguments()?;
    let name = call.text(string).and_then(|text| file_name(&text));
    let code = if !call.from_submit {
        NOT_FROM_SUBMIT
    } else if call.runs_without_strobe() {
        WITHOUT_STROBE
    } else if let Some(name) = name {
        match call.nc.select_parameter_file(&name) {
            Ok(()) => 0,
            Err(ParameterFileFault::NotFound) => NOT_FOUND,
            Err(ParameterFileFault::Faulty) => FAULTY,
        }
    } else {
        WRONG_NAME
    };
    call.code(code)
}

/// A name with extension and nothing else, no lower-case letters [000:14894-14896].
fn file_name(text: &[u8]) -> Option<String> {
    let text = std::str::from_utf8(text).ok()?;
    let (name, extension) = text.split_once('.')?;
    let plain = |part: &str| {
        !part.is_empty()
            && part
                .bytes()
                .all(|c| c.is_ascii_graphic() && c != b'.' && !c.is_ascii_lowercase())
    };
    (plain(name) && plain(extension)).then(|| text.to_owned())
}

/// A parameter that the model has; one with one value only has index 0.
fn definition(call: &Call<'_>, number: i32, index: i32) -> Option<&'static Definition> {
    let (number, index) = (u16::try_from(number).ok()?, u8::try_from(index).ok()?);
    Definition::find(call.nc.parameters().model(), number, index)
}

/// Values are whole numbers, shifted by the decimal places of the parameter [000:14856-14858].
fn shift(definition: &Definition) -> f64 {
    10_f64.powi(definition.decimals.into())
}
