//! Cycles of the machine builder that are not as they should be: a machine that has them can be switched on, and says so, as
//! `bahn oem list` does.

use std::path::Path;

use bahn_parameters::ParameterList;
use bahn_text::{Diagnostic, Span};

use crate::oem_cycles;

/// What is wrong with the cycles of a folder of part programs, whose texts are dialogues, each in its file.
pub(super) fn warnings(programs: &Path, dialogues: &[String], list: &ParameterList) -> Vec<Diagnostic> {
    // A folder that cannot be read has no cycles: whoever opens a program says why.
    let cycles = oem_cycles::find(programs, dialogues, list).unwrap_or_default();
    let faults = cycles.iter().flat_map(|cycle| {
        let faults = cycle.faults(cycle.in_eprom).into_iter();
        faults.map(|fault| {
            let message = format!("cycle {} of the machine builder: {fault}", cycle.number);
            Diagnostic::warning(Span::FILE, message).at(&cycle.path, "")
        })
    });
    faults.collect()
}
