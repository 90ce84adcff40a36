//! Tables from files, and what kind they are.

use std::path::{Path, PathBuf};

use bahn_host::{LoadedMachine, TableForm, TextTable};
use bahn_machine::MachineFolder;
use bahn_text::{Diagnostic, decode};

use super::options::KindOption;
use crate::{UsageError, diagnostics, files};

/// A table that was read.
pub(super) struct Source {
    pub path: PathBuf,
    pub text: String,
    pub kind: TableForm,
    /// As it is written.
    pub table: TextTable,
}

impl From<KindOption> for TableForm {
    fn from(kind: KindOption) -> TableForm {
        match kind {
            KindOption::Tool => TableForm::Tool,
            KindOption::Pocket => TableForm::Pocket,
            KindOption::Datum => TableForm::Datum,
            KindOption::Pallet => TableForm::Pallet,
            KindOption::Point => TableForm::Point,
        }
    }
}

/// Reads a table; its kind is looked for where nobody says it.
pub(super) fn read(path: &Path, kind: Option<KindOption>) -> Result<Source, UsageError> {
    let text = decode(&files::read_table(path)?);
    let at = |message: &str| UsageError::new(format!("{}: {message}", path.display()));
    let table = TextTable::read(&text).map_err(|fault| at(&fault.at_line()))?;
    let kind = kind.map(TableForm::from).or_else(|| TableForm::of(path, &table));
    let kind = kind.ok_or_else(|| at("nobody can tell what kind of table this is; say it with --kind"))?;
    Ok(Source {
        path: path.to_owned(),
        text,
        kind,
        table,
    })
}

impl Source {
    /// The faults of the table, printed.
    pub fn print(&self, faults: &[Diagnostic]) {
        let headline = format!("the {} table is wrong", self.kind.name());
        for fault in faults {
            let fault = fault.clone().under(headline.as_str());
            diagnostics::print_fault(&fault.in_text(self.path.as_path(), &self.text));
        }
    }
}

/// The machine of a folder; `None` for a path that is none. Its faults are an error of use.
pub(super) fn machine(path: &Path) -> Result<Option<LoadedMachine>, UsageError> {
    if !path.is_dir() {
        return Ok(None);
    }
    match LoadedMachine::load(path)? {
        Ok(machine) => Ok(Some(machine)),
        Err(faults) => {
            diagnostics::print_faults(&faults);
            Err(UsageError::new(format!("{} has faults", path.display())))
        }
    }
}

/// The file of a table of a machine.
pub(super) fn of_machine(machine: &LoadedMachine, kind: TableForm) -> Result<PathBuf, UsageError> {
    let types = machine.parameters.table_parameters().types;
    if types.is_disabled(kind.protected_with()) {
        return Err(UsageError::new(format!(
            "{}: MP7224.0 disables {} tables, nobody sees them",
            machine.root.display(),
            kind.name()
        )));
    }
    let folder = &machine.folder;
    let in_programs = |name: &Option<String>| {
        let name = name.as_ref()?;
        let found = machine.tables.iter().find(|path| {
            let own = path.file_name().unwrap_or_default().to_string_lossy();
            own.eq_ignore_ascii_case(name)
        });
        found.cloned()
    };
    let path = match kind {
        TableForm::Tool => folder.tools.as_ref().map(|name| machine.root.join(name)),
        TableForm::Pocket => folder.pockets.as_ref().map(|name| machine.root.join(name)),
        TableForm::Datum => in_programs(&folder.datum_table),
        TableForm::Pallet => in_programs(&folder.pallets),
        TableForm::Point => None,
    };
    path.ok_or_else(|| {
        UsageError::new(format!(
            "{} names no {} table in {}",
            machine.root.display(),
            kind.name(),
            MachineFolder::FILE
        ))
    })
}
