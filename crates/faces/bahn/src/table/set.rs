//! `bahn table set`: changes a line of a table.
//!
//! Decision: `bahn table set` changes one line, checks the whole and replaces the file in one step; a machine reads
//! its tables at power-on

use std::io::Write;
use std::path::Path;

use bahn_host::{LineChange, LoadedMachine, TableForm, canonical};
use bahn_machine::MachineFolder;

use super::options::SetOptions;
use super::source::{self, Source};
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, diagnostics};

/// Changes, adds or removes a line; the file is replaced when the new table has no fault.
pub(super) fn command(options: &SetOptions) -> Result<Outcome, UsageError> {
    let path = &options.table;
    let source = source::read(path, options.kind)?;
    if let Some(why) = refused(path, source.kind) {
        return Err(UsageError::new(format!("{} {why}", path.display())));
    }
    if let Err(faults) = source.kind.check(&source.text) {
        source.print(&faults);
        return Ok(Outcome::ProgramError);
    }
    let (text, done) = changed(&source, options)?;
    if let Err(faults) = source.kind.check(&text) {
        let said = faults
            .first()
            .map(|fault| fault.message.clone())
            .unwrap_or_default();
        return Err(UsageError::new(format!(
            "{}: {said}; nothing was changed",
            path.display()
        )));
    }
    let mut file = NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    file.finish()?;
    diagnostics::print_text(&format!(
        "{}: {} {} {done}",
        path.display(),
        source.kind.name(),
        options.line
    ));
    Ok(Outcome::Fine)
}

/// The new text, and what was done.
fn changed(source: &Source, options: &SetOptions) -> Result<(String, &'static str), UsageError> {
    let wrong = |message: String| UsageError::new(format!("{}: {message}", source.path.display()));
    if options.delete {
        let text = bahn_host::delete_line(&source.text, source.kind, &options.line);
        return Ok((text.map_err(wrong)?, "is removed"));
    }
    let mut values = Vec::new();
    for value in &options.values {
        let (name, value) = value
            .split_once('=')
            .ok_or_else(|| wrong(format!("`{value}` is no COLUMN=VALUE")))?;
        values.push((canonical(&name.trim().to_uppercase()).to_owned(), value.trim()));
    }
    let values: Vec<(&str, &str)> = values
        .iter()
        .map(|(name, value)| (name.as_str(), *value))
        .collect();
    let (text, change) =
        bahn_host::set_line(&source.text, source.kind, &options.line, &values).map_err(wrong)?;
    Ok(match change {
        LineChange::Changed => (text, "is changed"),
        LineChange::Added => (text, "is added"),
    })
}

/// Why a table is not changed: the machine in whose folder it lies protects it, or is switched on and would not see what
/// is changed. A machine with faults protects nothing.
fn refused(path: &Path, kind: TableForm) -> Option<&'static str> {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut folders = path.ancestors().skip(1).take(2);
    let root = folders.find(|folder| folder.join(MachineFolder::FILE).exists())?;
    let machine = LoadedMachine::load(root).ok()?.ok()?;
    let types = machine.parameters.table_parameters().types;
    if types.is_disabled(kind.protected_with()) {
        return Some("is disabled (MP7224.0)");
    }
    if types.is_protected(kind.protected_with()) {
        return Some("is protected (MP7224.1)");
    }
    machine
        .is_switched_on()
        .then_some("belongs to a machine that is switched on, which reads its tables at power-on")
}
