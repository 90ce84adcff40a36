//! Tables from files, and what kind they are.

use std::path::{Path, PathBuf};

use bahn_host::{FileFault, LoadedMachine, Marked, Severity, TableFault, TableForm, TextTable, decode};
use bahn_machine::MachineFolder;

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
    let table = TextTable::read(&text).map_err(|fault| at(&fault.to_string()))?;
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
    /// Prints the faults of the table with their lines.
    pub fn print(&self, faults: &[TableFault]) {
        for fault in faults {
            diagnostics::print_fault(&self.fault(fault));
        }
    }

    /// A fault with its place in the file.
    fn fault(&self, fault: &TableFault) -> FileFault {
        let line = fault.line.max(1);
        let shown = self.text.lines().nth(line as usize - 1).unwrap_or_default();
        let row = self.table.rows.iter().find(|row| row.line == line);
        let cells = row.into_iter().flat_map(|row| &row.cells);
        let length = cells
            .filter(|cell| cell.column == fault.column)
            .map(|cell| cell.text.chars().count())
            .next();
        let length = u32::try_from(length.unwrap_or(1)).unwrap_or(1).max(1);
        FileFault {
            severity: Severity::Error,
            title: format!("the {} table is wrong", self.kind.name()),
            path: self.path.clone(),
            marked: Marked {
                line,
                text: shown.to_owned(),
                columns: (fault.column > 0).then_some((fault.column, length)),
            },
            label: fault.message.clone(),
            help: None,
            opened: None,
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
