//! Tool and pocket table of the machine, in the form of the control.

use std::path::{Path, PathBuf};

use bahn_host::{PlainTable, TableForm, TextTable, files};
use bahn_machine::MachineFolder;
use bahn_store::{Place, StoreError, TNC, View};
use bahn_text::decode;

/// Name, form and file of each table that there is.
pub(crate) struct Files(Vec<(&'static str, TableForm, PathBuf)>);

impl Files {
    /// Those of a machine.
    pub fn of(root: &Path, folder: &MachineFolder) -> Files {
        let named = [
            ("TOOL.T", TableForm::Tool, &folder.tools),
            ("TOOL_P.TCH", TableForm::Pocket, &folder.pockets),
        ];
        let there = named
            .into_iter()
            .filter_map(|(name, form, file)| Some((name, form, root.join(file.as_ref()?))));
        Files(there.collect())
    }

    /// The tables where hosts look for them (public).
    pub fn views(&self) -> Result<Vec<View>, StoreError> {
        let view = |(name, form, source): &(&str, TableForm, PathBuf)| {
            let (form, path) = (*form, source.clone());
            let title = name.split('.').next().unwrap_or(name).to_owned();
            let bytes = move || {
                let table = PlainTable::new(form, &read(&path)?);
                Some(table.of_control(&title).into_bytes())
            };
            Ok(View {
                place: Place::root(TNC).join(name)?,
                source: source.clone(),
                bytes: Box::new(bytes),
            })
        };
        self.0.iter().map(view).collect()
    }
}

fn read(path: &Path) -> Option<TextTable> {
    let text = decode(&files::read_table(path).ok()?);
    TextTable::read(&text).ok()
}

/// A value of a tool table as it is written there, by the number of the tool and the name of the column.
pub(crate) fn tool_value(table: &Path, tool: u32, column: &str) -> Option<String> {
    let table = PlainTable::new(TableForm::Tool, &read(table)?);
    let place = |name: &str| {
        table
            .names
            .iter()
            .position(|known| known.eq_ignore_ascii_case(name))
    };
    let (number, wanted) = (place("T")?, place(column)?);
    let mut rows = table.rows.iter();
    let row = rows.find(|row| {
        row.get(number)
            .is_some_and(|text| text.trim().parse() == Ok(tool))
    })?;
    row.get(wanted).map(|text| text.trim().to_owned())
}
