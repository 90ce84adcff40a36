//! `bahn channel check`: all faults of lists.

use std::path::Path;

use bahn_technology::ChannelList;

use super::faults::{Report, faults};
use super::options::CheckOptions;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, files};

/// Checks lists and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let mut outcome = Outcome::Fine;
    let mut lists: Vec<(&Path, ChannelList)> = Vec::new();
    for path in &options.files {
        match files::read_table(path) {
            Ok(bytes) => lists.push((path, ChannelList::from_bytes(&bytes))),
            // The other files are checked all the same.
            Err(error) => {
                diagnostics::print_usage_error(&error.to_string());
                outcome = Outcome::WrongUse;
            }
        }
    }
    match options.format {
        Format::Text => lists.iter().for_each(|(path, list)| print(path, list)),
        Format::Json => print_json(options, &lists)?,
    }
    let has_errors = lists.iter().any(|(_, list)| !list.errors().is_empty());
    Ok(if outcome == Outcome::Fine && has_errors {
        Outcome::ProgramError
    } else {
        outcome
    })
}

fn print(path: &Path, list: &ChannelList) {
    diagnostics::print_faults(&faults(list, path));
    let count = |number: usize, what: &str| match number {
        1 => format!("1 {what}"),
        _ => format!("{number} {what}s"),
    };
    diagnostics::print_text(&format!(
        "{}: {}, {}, {}",
        path.display(),
        count(list.entries(), "parameter"),
        count(list.errors().len(), "error"),
        count(list.warnings().len(), "warning"),
    ));
}

/// One list is one object; several are an array of them.
fn print_json(options: &CheckOptions, lists: &[(&Path, ChannelList)]) -> Result<(), UsageError> {
    if let ([_], [(_, list)]) = (options.files.as_slice(), lists) {
        return console::print_json(&Report::new(list));
    }
    let named = lists
        .iter()
        .map(|(path, list)| Report::new(list).of_file(path.display().to_string()));
    let reports: Vec<Report> = named.collect();
    if !reports.is_empty() {
        console::print_json(&reports)?;
    }
    Ok(())
}
