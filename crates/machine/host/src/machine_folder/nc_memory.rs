//! The NC memory: the files in the folder of part programs, its pallet file and its datum tables. The manuals tell
//! what these tables hold [000:15332-15340] [000:15414-15420], not how they look as text: they are written as tool
//! tables are (inferred).
//!
//! Decision: A table of the folder of programs that is faulty or missing keeps no machine off: it is listed at
//! power-on, `bahn machine check` has it as an error, and cycle 7 or module 9090 refuses it, also the one that
//! machine.toml names (also `tnc/src/plc_link.rs`)
//!
//! Decision: Pallet files and datum tables are text as tool tables are, in the folder of the part programs; a column
//! that nobody reads is refused

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bahn_machine::MachineFolder;
use bahn_parameters::{PLC_AXIS_NAMES, ParameterList, PerPlcAxis};
use bahn_plc::{MemoryTable, PalletLine, TableFile, TableKind};
use bahn_tnc::NcFiles;

use super::load::Loader;
use crate::columns::{self, Form, Row, RowFault};
use crate::files;
use bahn_text::{Diagnostic, Span, decode};

/// Lines that MP7226 gives a table at most [000:6892-6896].
pub(super) const LINES_MAX: u16 = 255;

const WRONG: &str = "the table is wrong";

const DATUM_TABLE: Form = Form {
    needed: &["NR"],
    known: Some(&[
        "NR", "X", "Y", "Z", "4", "5", "A", "B", "C", "U", "V", "W", "NAME", "DOC",
    ]),
    example: "NR X Y Z 4 5",
};

/// Axes that the datum tables of later controls name by their letters.
const LETTERS: [&str; 6] = ["A", "B", "C", "U", "V", "W"];

const PALLET_FILE: Form = Form {
    needed: &["NR", "PGM"],
    known: Some(&["NR", "PGM", "DATUM", "DOC"]),
    example: "NR PGM DATUM",
};

/// The axes of a machine in its datum tables.
#[derive(Clone, Copy, Default)]
pub(super) struct DatumAxes {
    /// The letters of axes 4 and 5, which the tables of later controls have as names of their columns.
    letters: PerPlcAxis<Option<char>>,
    /// These have degrees, and so no unit of length.
    turns: PerPlcAxis<bool>,
}

impl DatumAxes {
    /// Those of a list of machine parameters.
    fn of(list: &ParameterList) -> DatumAxes {
        let mut axes = DatumAxes::default();
        for axis in list.axes().iter() {
            let Some(index) = list.axis_index(axis).map(usize::from) else {
                continue;
            };
            if let (Some(letter), Some(turns)) = (axes.letters.get_mut(index), axes.turns.get_mut(index)) {
                (*letter, *turns) = (Some(axis.letter()), axis.is_rotary());
            }
        }
        axes
    }

    /// A machine whose axes 4 and 5 turn.
    pub fn turning() -> DatumAxes {
        DatumAxes {
            letters: PerPlcAxis([Some('X'), Some('Y'), Some('Z'), Some('A'), Some('B')]),
            turns: PerPlcAxis([false, false, false, true, true]),
        }
    }

    /// The column in which the value of an axis stands: that of its number, or of its letter.
    fn column<'r>(letter: Option<char>, name: &'static str, row: &Row<'r>) -> &'static str {
        let by_letter = LETTERS.into_iter().find(|column| column.chars().eq(letter));
        by_letter.filter(|_| row.text(name).is_empty()).unwrap_or(name)
    }
}

/// Reads a datum table. A later control writes a column for each axis it can have: those that this machine has not are 0.
pub(super) fn datum_table(text: &str, axes: &DatumAxes, most: u16) -> Result<MemoryTable, Vec<Diagnostic>> {
    let mut lines: BTreeMap<i32, PerPlcAxis<f64>> = BTreeMap::new();
    columns::read(text, &DATUM_TABLE, |row| {
        let mut values = PerPlcAxis::splat(0.0);
        let columns = TableKind::Datum.columns().iter().flatten();
        let names = axes.letters.into_iter().zip(PLC_AXIS_NAMES);
        let names = names.map(|(letter, name)| DatumAxes::column(letter, name, row));
        for (((value, name), turns), column) in values.iter_mut().zip(names).zip(axes.turns).zip(columns) {
            let unit = if turns { 1.0 } else { row.unit_mm };
            *value = row.number(name)? * unit;
            if !(column.min..=column.max).contains(value) {
                return Err(row.fault(name, &format!("{} is too large", row.text(name))));
            }
        }
        let has = |letter: &str| axes.letters.into_iter().any(|own| letter.chars().eq(own));
        for letter in LETTERS.into_iter().filter(|letter| !has(letter)) {
            if row.number(letter)? != 0.0 {
                return Err(row.fault(letter, &format!("the machine has no axis {letter}")));
            }
        }
        insert(&mut lines, row, values, most)
    })?;
    let mut table = MemoryTable::with_lines(TableKind::Datum, lines.keys().copied());
    for (line, values) in lines {
        for (element, value) in values.into_iter().enumerate() {
            table.set_value(line, element, value);
        }
    }
    Ok(table)
}

/// Reads a pallet file of so many lines at most.
pub(super) fn pallet_file(text: &str, most: u16) -> Result<BTreeMap<i32, PalletLine>, Vec<Diagnostic>> {
    let mut lines = BTreeMap::new();
    columns::read(text, &PALLET_FILE, |row| {
        let name = |column: &str| {
            let name = row.text(column).to_uppercase();
            (!matches!(name.as_str(), "" | "-")).then_some(name)
        };
        let line = PalletLine {
            program: name("PGM").ok_or_else(|| row.fault("PGM", "the name of the program is missing"))?,
            datum_table: name("DATUM"),
        };
        insert(&mut lines, row, line, most)
    })?;
    Ok(lines)
}

/// A line of a table by its number.
fn insert<T>(lines: &mut BTreeMap<i32, T>, row: &Row<'_>, line: T, most: u16) -> Result<(), RowFault> {
    let text = row.text("NR");
    let last = i32::from(most) - 1;
    let number = text.parse().ok().filter(|number| (0..=last).contains(number));
    let number = number.ok_or_else(|| match most {
        0 => row.fault("NR", "this table has no lines (MP7226 = 0)"),
        _ => row.fault("NR", &format!("`{text}` is no line from 0 to {last}")),
    })?;
    match lines.insert(number, line) {
        Some(_) => Err(row.fault("NR", &format!("line {number} is there twice"))),
        None => Ok(()),
    }
}

impl Loader<'_> {
    /// Reads the NC memory; the paths of the tables that were read. Names are in capitals, as the control knows no
    /// others.
    pub(super) fn nc_memory(
        &mut self,
        folder: &MachineFolder,
        list: &ParameterList,
        memory: &mut NcFiles,
    ) -> Vec<PathBuf> {
        let mut read = Vec::new();
        let sizes = list.table_parameters();
        let [datum_lines, pallet_lines] =
            [sizes.datum_lines, sizes.pallet_lines].map(|lines| lines.unwrap_or(LINES_MAX));
        let axes = DatumAxes::of(list);
        let of_others = self.faults.len();
        let mut paths = BTreeMap::new();
        let mut twice = BTreeMap::new();
        let entries = std::fs::read_dir(self.root.join(&folder.programs));
        for entry in entries.into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().to_uppercase();
            if entry.path().is_file()
                && let Some(other) = paths.insert(name.clone(), entry.path())
                && name.ends_with(".D")
            {
                let message = format!("the datum table {} has the same name", other.display());
                twice.insert(name, message.clone());
                self.fault_in_table(
                    &entry.path(),
                    WRONG,
                    "",
                    vec![Diagnostic::error(Span::FILE, message)],
                );
            }
        }
        for (name, path) in paths.iter().filter(|(name, _)| name.ends_with(".D")) {
            let before = self.faults.len();
            let table = self.table(path, WRONG, |text| datum_table(text, &axes, datum_lines));
            let first = || self.faults.get(before).map(Diagnostic::at_line);
            match table.ok_or_else(first) {
                Ok(_) if twice.contains_key(name) => {}
                Ok(table) => drop(memory.datum_tables.insert(name.clone(), table)),
                Err(why) => drop(memory.faulty.insert(name.clone(), why.unwrap_or_default())),
            }
            read.push(path.clone());
        }
        if let Some(name) = folder.datum_table.as_ref().map(|name| name.to_uppercase()) {
            if !paths.contains_key(&name) || !name.ends_with(".D") {
                let message = format!("there is no datum table {name} in {}", folder.programs);
                self.fault_at_key("datum_table", &message);
            }
            memory.datum_table = Some(name);
        }
        if let Some(name) = folder.pallets.as_ref().map(|name| name.to_uppercase()) {
            match paths.get(&name).filter(|_| name.ends_with(".P")) {
                Some(path) => {
                    memory.pallet = self.table(path, WRONG, |text| pallet_file(text, pallet_lines));
                    read.push(path.clone());
                }
                None => {
                    let message = format!("there is no pallet file {name} in {}", folder.programs);
                    self.fault_at_key("pallets", &message);
                }
            }
        }
        memory.faulty.extend(twice);
        memory.names = paths.into_keys().collect();
        self.refused.extend(self.faults.split_off(of_others));
        read
    }

    pub(super) fn table<T>(
        &mut self,
        path: &Path,
        title: &str,
        read: impl FnOnce(&str) -> Result<T, Vec<Diagnostic>>,
    ) -> Option<T> {
        let bytes = match files::read_table(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.fault_in_table(
                    path,
                    title,
                    "",
                    vec![Diagnostic::error(Span::FILE, error.to_string())],
                );
                return None;
            }
        };
        let text = decode(&bytes);
        read(&text)
            .map_err(|faults| self.fault_in_table(path, title, &text, faults))
            .ok()
    }

    pub(super) fn fault_in_table(&mut self, path: &Path, title: &str, text: &str, faults: Vec<Diagnostic>) {
        let faults = faults.into_iter();
        self.faults
            .extend(faults.map(|fault| fault.under(title).in_text(path, text)));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_parameters::PLC_AXES;

    const LENGTHS: &DatumAxes = &DatumAxes {
        letters: PerPlcAxis::splat(None),
        turns: PerPlcAxis::splat(false),
    };

    /// Values of a line of a datum table.
    fn line(table: &MemoryTable, number: i32) -> Option<Vec<f64>> {
        (0..PLC_AXES)
            .map(|element| table.value(number, element))
            .collect()
    }

    #[test]
    fn datum_tables_are_read() {
        let text = "NR\tX\tY\tZ\t4\tDOC\n0\t0\t0\t0\t0\tvice\n12\t-1.5\t2,25\t\t90\t\n";
        let table = datum_table(text, LENGTHS, LINES_MAX).unwrap();
        assert_eq!(line(&table, 12), Some(vec![-1.5, 2.25, 0.0, 90.0, 0.0]));
        assert_eq!(
            (line(&table, 0), line(&table, 1)),
            (Some(vec![0.0; PLC_AXES]), None)
        );
        // As a control writes it, in inches: degrees stay.
        let text = "BEGIN ZERO .D INCH\nNR   X      4\n3    +1     -30\n[END]\n";
        let table = datum_table(text, &DatumAxes::turning(), LINES_MAX).unwrap();
        assert_eq!(line(&table, 3), Some(vec![25.4, 0.0, 0.0, -30.0, 0.0]));
    }

    /// As a TNC 426 writes it: a column for each axis that it can have, names at the lines.
    #[test]
    fn tables_of_later_controls_are_read() {
        let text = "BEGIN INCH .D MM\n\
                    NR   X        Y        Z        A        B        C        U        V        W        NAME\n\
                    0    +10      +20.5    +0       +30      +0       +0       +0       +0       +0       VICE\n\
                    1    +1       +2       +3       +4       +5       +0       +0       +0       +0\n\
                    [END]\n";
        let table = datum_table(text, &DatumAxes::turning(), LINES_MAX).unwrap();
        // A table of that name is not in inches; A and B are axes 4 and 5.
        assert_eq!(line(&table, 0), Some(vec![10.0, 20.5, 0.0, 30.0, 0.0]));
        assert_eq!(line(&table, 1), Some(vec![1.0, 2.0, 3.0, 4.0, 5.0]));
        let inches = text.replace(".D MM", ".D [INCH]");
        let table = datum_table(&inches, &DatumAxes::turning(), LINES_MAX).unwrap();
        assert_eq!(
            line(&table, 1),
            Some(vec![25.4, 2.0 * 25.4, 3.0 * 25.4, 4.0, 5.0])
        );
        let faults = datum_table(
            &text.replacen("+0       VICE", "+7       VICE", 1),
            &DatumAxes::turning(),
            LINES_MAX,
        );
        let faults = faults.unwrap_err();
        assert_eq!((faults.len(), faults[0].span.line), (1, 3));
        assert_eq!(faults[0].message, "W: the machine has no axis W");
    }

    #[test]
    fn faults_of_datum_tables_have_their_lines() {
        let found = |text: &str| -> Vec<u32> {
            let faults = datum_table(text, LENGTHS, LINES_MAX).err().unwrap_or_default();
            faults.iter().map(|fault| fault.span.line).collect()
        };
        assert_eq!(
            found("NR X\n0 1\n0 2\n255 1\nx 1\n3 nan\n4 1e9\n5 7\n"),
            [3, 4, 5, 6, 7]
        );
        // A column that nobody reads would be a datum that nobody shifts.
        assert_eq!(found("NR X Q\n0 1 30\n"), [0]);
        assert_eq!(found("NR X B\n0 1 30\n1 1 0\n"), [2]);
        assert_eq!((found("X Y\n0 1\n"), found("")), (vec![0], vec![0]));
    }

    /// MP7226: tables have so many lines, from 0 on [000:6892-6896].
    #[test]
    fn tables_have_as_many_lines_as_the_list_says() {
        assert!(datum_table("NR X\n0 1\n9 1\n", LENGTHS, 10).is_ok());
        let faults = datum_table("NR X\n9 1\n  10 1\n", LENGTHS, 10).unwrap_err();
        assert_eq!(faults.len(), 1);
        assert_eq!((faults[0].span.line, faults[0].span.column), (3, 3));
        assert_eq!(faults[0].message, "NR: `10` is no line from 0 to 9");
        let none = pallet_file("NR PGM\n0 A\n", 0).unwrap_err();
        assert_eq!(none[0].message, "NR: this table has no lines (MP7226 = 0)");
    }

    #[test]
    fn pallet_files_are_read() {
        let text = "NR PGM DATUM\n0 part.h zero\n1 7432 -\n4 B.I\n";
        let lines = pallet_file(text, LINES_MAX).unwrap();
        let lines: Vec<_> = lines
            .iter()
            .map(|(number, line)| (*number, line.program.as_str(), line.datum_table.as_deref()))
            .collect();
        assert_eq!(
            lines,
            [(0, "PART.H", Some("ZERO")), (1, "7432", None), (4, "B.I", None)]
        );
        let faults = pallet_file("NR PGM DATUM\n0 A\n1\n0 B\n", LINES_MAX).unwrap_err();
        assert_eq!(
            faults.iter().map(|fault| fault.span.line).collect::<Vec<_>>(),
            [3, 4]
        );
    }
}
