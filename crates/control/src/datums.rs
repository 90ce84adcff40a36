//! Datum tables and what module 9090 selects: the selected table is that of `CYCL DEF 7.1 #n` and of modules
//! 9092 to 9094 [000:15328-15545].

use std::sync::Arc;

use bahn_interpreter::DatumTable;
use bahn_parameters::ParameterList;
use bahn_path::{Axis, Position};
use bahn_plc::{MemoryTable, TableFile, TableKind};

use crate::command::Command;
use crate::control::Control;
use crate::markers::AXES;
use crate::plc_link::{PalletRequest, PlcLink};
use crate::setup::WrittenElement;
use crate::tables::differences;

/// The lines of a datum table as shifts of the axes that a list of machine parameters has [000:15414-15420].
pub fn datum_shifts(table: &MemoryTable, list: &ParameterList) -> DatumTable {
    let axes: Vec<(Axis, usize)> = list
        .axes()
        .iter()
        .filter_map(|axis| Some((axis, usize::from(list.axis_index(axis)?))))
        .filter(|(_, element)| *element < AXES)
        .collect();
    let mut shifts = DatumTable::new();
    let mut line = table.next_line(0);
    while let Some(number) = line {
        let mut datum = Position::UNKNOWN;
        for (axis, element) in &axes {
            datum[*axis] = table.value(number, *element).unwrap_or_default();
        }
        shifts.insert(number, datum);
        line = number.checked_add(1).and_then(|next| table.next_line(next));
    }
    shifts
}

impl Control {
    /// The datum tables at power-on, with what was written before. Elements whose file has changed since are as
    /// it says.
    pub(crate) fn set_up_datums(&mut self, written: &[(String, WrittenElement)]) {
        self.loaded_datums.tables = self.link.files.datum_tables.clone();
        for (name, element) in written {
            if let Some(table) = self.link.files.datum_tables.get_mut(name)
                && table.value(element.line, element.element) == Some(element.file)
            {
                table.set_value(element.line, element.element, element.value);
            }
        }
    }

    /// Module 9090: program and datum table are selected, and are so after power-off.
    pub(crate) fn select_pallet(&mut self, request: PalletRequest) {
        if !self.execute(Command::Select(request.program)) {
            return;
        }
        self.link.pallet.line = Some(request.line);
        if request.datum_table.is_some() {
            self.link.pallet.datum_table = request.datum_table;
        }
        self.unsaved = true;
    }

    /// What module 9094 wrote into datum tables.
    pub(crate) fn written_datums(&self) -> Vec<(String, WrittenElement)> {
        let loaded = self.loaded_datums.tables.iter();
        let changed = loaded.filter_map(|(name, loaded)| {
            let table = self.link.files.datum_tables.get(name)?;
            Some(differences(loaded, table).map(|element| (name.clone(), element)))
        });
        changed.flatten().collect()
    }

    /// The datums of `CYCL DEF 7.1 #n`.
    pub(crate) fn datum_table(&self) -> Option<Arc<DatumTable>> {
        let table = self.link.files.datum_tables.get(self.link.datum_table_name()?)?;
        Some(Arc::new(datum_shifts(table, self.link.list())))
    }

    /// Module 9094 wrote. A shift that is in force stays until the next cycle 7 (inferred).
    pub(crate) fn datums_written(&mut self) {
        self.loaded_datums.changed = true;
    }

    /// The run learns what was written.
    pub(crate) fn take_datums(&mut self) {
        if !std::mem::take(&mut self.loaded_datums.changed) {
            return;
        }
        let table = self.datum_table();
        if let Some(feeder) = &mut self.run.feeder {
            feeder.interpreter_mut().set_datum_table(table);
        }
    }
}

impl PlcLink {
    /// The datum table with M status.
    pub fn datum_table_name(&self) -> Option<&String> {
        self.pallet
            .datum_table
            .as_ref()
            .or(self.files.datum_table.as_ref())
    }

    /// The tables that modules 9092 to 9094 see.
    pub fn selected_table(&mut self, kind: TableKind) -> Option<&mut MemoryTable> {
        if kind != TableKind::Datum {
            return self.files.tables.get_mut(&kind);
        }
        let name = self.datum_table_name()?.clone();
        self.files.datum_tables.get_mut(&name)
    }
}
