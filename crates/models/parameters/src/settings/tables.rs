//! Settings of the tables in the NC memory: how many lines they have, and which columns the control shows.

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
    /// Types of files that are disabled, and such that are protected from editing: MP7224 [000:6857-6880].
    pub types: FileTypes,
}

/// What MP7224 says of the types of files, a bit for each of [`FILE_TYPES`] [000:6857-6880].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FileTypes {
    disabled: u8,
    protected: u8,
}

/// The endings of files in the order of the bits of MP7224 [000:6838-6847].
pub const FILE_TYPES: [&str; 8] = ["H", "I", "T", "D", "P", "A", "HLP", "PNT"];

impl FileTypes {
    /// Files with this ending are not to be seen: MP7224.0.
    pub fn is_disabled(self, ending: &str) -> bool {
        has(self.disabled, ending)
    }

    /// Files with this ending are not to be changed: MP7224.1.
    pub fn is_protected(self, ending: &str) -> bool {
        has(self.protected, ending)
    }
}

fn has(bits: u8, ending: &str) -> bool {
    let bit = FILE_TYPES.iter().position(|own| own.eq_ignore_ascii_case(ending));
    bit.is_some_and(|bit| bits >> bit & 1 == 1)
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
        let types = |index| self.get_new(7224, index).unwrap_or_default() as u8;
        TableParameters {
            pallet_lines: self.get_new(7226, 0).map(|lines| lines as u16),
            datum_lines: self.get_new(7226, 1).map(|lines| lines as u16),
            tool_columns: std::array::from_fn(|index| place(7266, index)),
            pocket_columns: std::array::from_fn(|index| place(7267, index)),
            types: FileTypes {
                disabled: types(0),
                protected: types(1),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::ControlModel;

    /// A bit for each type, in the order of the endings [000:6838-6847].
    #[test]
    fn types_of_files_have_their_bits() {
        for (bit, ending) in FILE_TYPES.into_iter().enumerate() {
            let mut list = ParameterList::reference(ControlModel::Tnc415b);
            list.set(7224, 0, f64::from(1_u8 << bit)).unwrap();
            list.set(7224, 1, f64::from(!(1_u8 << bit))).unwrap();
            let types = list.table_parameters().types;
            for own in FILE_TYPES {
                assert_eq!(types.is_disabled(own), own == ending);
                assert_eq!(types.is_protected(&own.to_lowercase()), own != ending);
            }
            assert!(!types.is_disabled("TCH") && !types.is_protected("TCH"));
        }
    }

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
