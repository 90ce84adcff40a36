//! Any text is a tool table, a datum table, a pallet file, or faults with their lines; any text is a compensation
//! table, an assignment, correction tables, or an error with its line.
//!
//! ```text
//! cargo +nightly fuzz run read_tables
//! ```

#![no_main]

use bahn_tnc::{CompensationAssignment, CompensationTable, CorrectionTables};
use bahn_fuzz as _;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let lines = text.lines().count();
    let [datums, pallets] = bahn::check_nc_tables(text);
    let results = [bahn::check_tool_table(text), datums, pallets];
    for faults in results.into_iter().filter_map(Result::err) {
        assert!(!faults.is_empty() && faults.iter().all(|line| *line as usize <= lines));
    }
    let errors = [
        CompensationTable::read(text).err(),
        CompensationAssignment::read(text).err(),
        CorrectionTables::read(text).err(),
    ];
    assert!(
        errors
            .into_iter()
            .flatten()
            .all(|error| error.line <= lines.max(1))
    );
});
