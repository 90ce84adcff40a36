//! Settings of the tables in the NC memory: how many lines they have, and which columns the control shows.

use super::bit_of;
use crate::ParameterList;

/// Tables of the NC memory [000:6884-6905] [000:9103-9149].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableParameters {
    /// Lines that a pallet file has at most: MP7226.0, 0 to 255 [000:6892]; `None` where nothing limits them.
    pub pallet_lines: Option<u16>,
    /// Lines that a datum table has at most: MP7226.1, 0 to 255 [000:6895]; `None` where nothing limits them.
    pub datum_lines: Option<u16>,
    /// Where each element of the tool table is shown, in the order of [`TOOL_ELEMENTS`]; 0 is not shown: MP7266
    /// [000:9114-9139].
    pub tool_columns: [u8; 22],
    /// Where each element of the pocket table is shown, in the order of [`POCKET_ELEMENTS`]; 0 is not shown: MP7267
    /// [000:9141-9149].
    pub pocket_columns: [u8; 5],
    /// Tool tables, datum tables, pallet files are protected from editing: MP7224.1 bits 2, 3, 4 [000:6870-6880].
    pub protected: [bool; 3],
}

/// The elements of the tool table in the order of MP7266 [000:9118-9139].
pub const TOOL_ELEMENTS: [&str; 22] = [
    "NAME", "L", "R", "R2", "DL", "DR", "DR2", "TL", "RT", "TIME1", "TIME2", "CUR.TIME", "DOC", "CUT",
    "LTOL", "RTOL", "DIRECT", "PLC", "L-OFFS", "R-OFFS", "LBREAK", "RBREAK",
];

/// The elements of the pocket table in the order of MP7267 [000:9145-9149].
pub const POCKET_ELEMENTS: [&str; 5] = ["T", "ST", "F", "L", "PLC"];

/// The elements of a table that the control shows, in its order: the names whose place is not 0, by their places; two with the same place in the order of the parameters (inferred).
pub fn shown_elements(places: &[u8], names: &[&'static str]) -> Vec<&'static str> {
    let mut shown: Vec<(u8, &'static str)> = places.iter().copied().zip(names.iter().copied()).collect();
    shown.retain(|(place, _)| *place > 0);
    shown.sort_by_key(|(place, _)| *place);
    shown.into_iter().map(|(_, name)| name).collect()
}

impl ParameterList {
    /// Settings of the tables in the NC memory.
    pub fn table_parameters(&self) -> TableParameters {
        let place = |number: u16, index: usize| {
            let index = u8::try_from(index).unwrap_or(u8::MAX);
            self.get_new(number, index).unwrap_or_default() as u8
        };
        let protected = self.get_new(7224, 1).unwrap_or_default();
        TableParameters {
            pallet_lines: self.get_new(7226, 0).map(|lines| lines as u16),
            datum_lines: self.get_new(7226, 1).map(|lines| lines as u16),
            tool_columns: std::array::from_fn(|index| place(7266, index)),
            pocket_columns: std::array::from_fn(|index| place(7267, index)),
            protected: [2, 3, 4].map(|bit| bit_of(protected, bit)),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::ControlModel;

    #[test]
    fn columns_are_shown_by_their_places() {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for index in 0..22 {
            list.set(7266, index, 0.0).unwrap();
        }
        for (index, place) in [(0, 3.0), (1, 1.0), (2, 2.0), (12, 99.0), (4, 3.0)] {
            list.set(7266, index, place).unwrap();
        }
        for (index, place) in [(0, 1.0), (1, 0.0), (2, 3.0), (3, 2.0), (4, 0.0)] {
            list.set(7267, index, place).unwrap();
        }
        for (index, lines) in [(0, 20.0), (1, 255.0)] {
            list.set(7226, index, lines).unwrap();
        }
        let tables = list.table_parameters();
        assert_eq!(
            shown_elements(&tables.tool_columns, &TOOL_ELEMENTS),
            ["L", "R", "NAME", "DL", "DOC"]
        );
        assert_eq!(
            shown_elements(&tables.pocket_columns, &POCKET_ELEMENTS),
            ["T", "L", "F"]
        );
        assert_eq!((tables.pallet_lines, tables.datum_lines), (Some(20), Some(255)));
        let old = ParameterList::reference(ControlModel::Tnc155).table_parameters();
        assert_eq!(
            (
                old.pallet_lines,
                shown_elements(&old.tool_columns, &TOOL_ELEMENTS).len()
            ),
            (None, 0)
        );
    }
}
