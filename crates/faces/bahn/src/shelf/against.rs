//! Another run that the programs are compared with: with other parameters or tools, or of an earlier day.

use std::fs;
use std::path::Path;

use bahn_host::tool_table;
use bahn_path::Position;
use bahn_report::shelf::{self, COLUMNS, Rows};
use bahn_report::test_run::Bench;

use crate::settings::Equipment;
use crate::test_run::{TestOptions, bench};
use crate::{UsageError, files};

/// What the programs are compared with.
pub(super) enum Other {
    /// Another run of each.
    Bench(Box<Bench>),
    /// The rows of an earlier report by path.
    Report(Rows),
}

/// Reads what `--against` names.
///
/// The workpiece lies where it lies in the run that is compared.
pub(super) fn load(path: &Path, options: &TestOptions, datum: &Position) -> Result<Other, UsageError> {
    let other = |equipment: Equipment| {
        let equipment = Equipment {
            datum: *datum,
            ..equipment
        };
        let bench = bench(options, equipment, COLUMNS)?;
        Ok(Other::Bench(Box::new(bench)))
    };
    if path.is_dir() {
        return other(Equipment::of_folder("--against", path)?);
    }
    if let Err(error) = fs::metadata(path) {
        return Err(files::cannot("read", path, &error).into());
    }
    let bytes = files::read_program(path)?
        .ok_or_else(|| UsageError::new(format!("{}: {}", path.display(), files::TOO_LARGE)))?;
    let text = bahn_text::decode(&bytes);
    let earlier = shelf::read(&text);
    if let Some(rows) = earlier.map_err(|error| UsageError::new(format!("{}: {error}", path.display())))? {
        return Ok(Other::Report(rows));
    }
    let mut machine = options.machine.clone();
    if tool_table::parse(&text).is_ok() {
        machine.tools = Some(path.to_owned());
    } else {
        machine.parameters = Some(path.to_owned());
    }
    let equipment = Equipment::of(options.model, &machine).map_err(|error| {
        UsageError::new(format!(
            "--against takes a parameter list, a tool table, a folder of a machine or an earlier report; {error}"
        ))
    })?;
    other(equipment)
}
