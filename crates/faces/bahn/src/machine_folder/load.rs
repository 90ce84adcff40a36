//! Loading the machine of a folder.

use std::path::Path;

use bahn_host::LoadedMachine;

use crate::UsageError;

/// Loads the machine of a folder; the inner `Err` holds every fault of every file.
///
/// # Errors
/// When there is no such machine.
pub(crate) fn load(folder: &Path) -> Result<Result<LoadedMachine, Vec<bahn_text::Diagnostic>>, UsageError> {
    LoadedMachine::load(folder)
        .map_err(|error| UsageError::new(format!("{error}; `bahn machine new` makes one")))
}

/// The same for a panel, where a list of machine parameters that is empty or has faults is entered.
///
/// # Errors
/// As [`load`].
pub(crate) fn load_to_enter(
    folder: &Path,
) -> Result<Result<LoadedMachine, Vec<bahn_text::Diagnostic>>, UsageError> {
    LoadedMachine::load_to_enter(folder)
        .map_err(|error| UsageError::new(format!("{error}; `bahn machine new` makes one")))
}

/// The same with another tool table of the folder, when one is named.
///
/// # Errors
/// As [`load`].
pub(crate) fn load_with_tools(
    folder: &Path,
    tools: Option<&str>,
) -> Result<Result<LoadedMachine, Vec<bahn_text::Diagnostic>>, UsageError> {
    let Some(tools) = tools else { return load(folder) };
    LoadedMachine::load_with_tools(folder, tools).map_err(|error| UsageError::new(error.to_string()))
}
