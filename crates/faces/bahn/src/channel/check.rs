//! `bahn channel check`: all faults of lists.

use std::path::Path;

use bahn_technology::ChannelList;
use serde::{Serialize, Serializer};

use super::faults::{Report, faults};
use super::options::CheckOptions;
use crate::options::Format;
use crate::reports::Reports;
use crate::{Outcome, UsageError, console, diagnostics, files};
use bahn_report::count;

/// Checks lists and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    // One list is one object; several are an array of them.
    if let ([path], Format::Json) = (options.files.as_slice(), options.format) {
        let list = read(path)?;
        console::print_json(&Report::new(&faults(&list, path)))?;
        return Ok(match list.errors().is_empty() {
            true => Outcome::Fine,
            false => Outcome::ProgramError,
        });
    }
    let mut lists = Reports::new();
    for path in &options.files {
        lists.add(path, read(path).map(|list| Named { path, list }));
    }
    if options.format == Format::Text {
        lists
            .readable()
            .for_each(|Named { path, list }| print(path, list));
    }
    lists.end(options.format, |named| !named.list.errors().is_empty())
}

fn read(path: &Path) -> Result<ChannelList, UsageError> {
    Ok(ChannelList::from_bytes(&files::read_table(path)?))
}

/// One of several lists.
struct Named<'a> {
    path: &'a Path,
    list: ChannelList,
}

impl Serialize for Named<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let name = self.path.display().to_string();
        Report::new(&faults(&self.list, self.path))
            .of_file(name)
            .serialize(serializer)
    }
}

fn print(path: &Path, list: &ChannelList) {
    diagnostics::print_faults(&faults(list, path));
    diagnostics::print_text(&format!(
        "{}: {}, {}, {}",
        path.display(),
        count(list.entries(), "parameter"),
        count(list.errors().len(), "error"),
        count(list.warnings().len(), "warning"),
    ));
}
