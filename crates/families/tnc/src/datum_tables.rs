//! What the PLC wrote into datum tables with module 9094, and keeps over power-off [000:15328-15545].
//!
//! Decision: What module 9094 writes into a datum table is kept beside it under its name; a shift that is in force
//! stays until the next cycle 7

use std::collections::BTreeMap;

use bahn_plc::{MemoryTable, TableFile};

use crate::plc_link::{PlcLink, WrittenElement, differences};

/// The datum tables as their files say: what differs from them was written.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadedDatums {
    tables: BTreeMap<String, MemoryTable>,
    /// Blocks that are read from now on find other datums.
    pub changed: bool,
}

impl LoadedDatums {
    /// The datum tables at power-on, with what was written before. Elements whose file has changed since are as
    /// it says.
    pub fn set_up(link: &mut PlcLink, written: &[(String, WrittenElement)]) -> LoadedDatums {
        let tables = link.files.datum_tables.clone();
        for (name, element) in written {
            if let Some(table) = link.files.datum_tables.get_mut(name)
                && table.value(element.line, element.element) == Some(element.file)
            {
                table.set_value(element.line, element.element, element.value);
            }
        }
        LoadedDatums {
            tables,
            changed: false,
        }
    }

    /// The file of the datum table with M status says something else from now on.
    pub fn take(&mut self, link: &PlcLink, line: i32, element: usize, value: f64) {
        let table = link.datum_table_name().and_then(|name| self.tables.get_mut(name));
        if let Some(table) = table {
            table.set_value(line, element, value);
        }
    }

    /// What module 9094 wrote into datum tables.
    pub fn written(&self, link: &PlcLink) -> Vec<(String, WrittenElement)> {
        let changed = self.tables.iter().filter_map(|(name, loaded)| {
            let table = link.files.datum_tables.get(name)?;
            Some(differences(loaded, table).map(|element| (name.clone(), element)))
        });
        changed.flatten().collect()
    }
}
