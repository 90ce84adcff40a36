//! `bahn oem export`: S records for an EPROM.

use std::io::Write as _;
use std::path::Path;

use bahn_host::eprom::{self, ListFault, LoadList};
use bahn_host::files::{self, NewFile};
use bahn_host::s_records::Image;
use bahn_host::{FileFault, Marked, Severity, decode};

use super::options::ExportOptions;
use crate::{Outcome, UsageError, console, diagnostics};

/// Writes the records, or prints what is wrong.
pub(super) fn command(options: &ExportOptions) -> Result<Outcome, UsageError> {
    let Some(machine) = super::machine(&options.machine)? else {
        return Ok(Outcome::ProgramError);
    };
    if let Some(output) = &options.output {
        crate::files::keep_inputs(&[&options.list], &[("--output", output)])?;
    }
    let text = decode(&files::read_table(&options.list)?);
    let fault = |fault: ListFault| of_list(&options.list, &text, fault);
    let list = match LoadList::parse(&text) {
        Ok(list) => list,
        Err(faults) => return Ok(print(faults.into_iter().map(fault).collect())),
    };
    let (contents, faults) = eprom::contents(&machine, &list)?;
    if !faults.is_empty() {
        return Ok(print(faults.into_iter().map(fault).collect()));
    }
    let whole = |message| {
        fault(ListFault {
            line: 0,
            column: 1,
            message,
        })
    };
    let image = match list.image(&contents) {
        Ok(image) => image,
        Err(message) => return Ok(print(vec![whole(message)])),
    };
    let records = image.to_records();
    // What is written is what was meant.
    if Image::from_records(&records).as_ref() != Ok(&image) {
        return Ok(print(vec![whole(
            "the records do not read back as the image".into(),
        )]));
    }
    match &options.output {
        None => console::print_bytes(records.as_bytes())?,
        Some(path) => {
            let mut file = NewFile::create(path)?;
            let written = file.write_all(records.as_bytes());
            written.map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
            let (count, size) = (list.files.len(), image.bytes.len());
            console::print(&format!("{}: {count} files, {size} bytes\n", path.display()))?;
        }
    }
    Ok(Outcome::Fine)
}

fn of_list(path: &Path, text: &str, fault: ListFault) -> FileFault {
    let line = text
        .lines()
        .nth((fault.line as usize).saturating_sub(1))
        .unwrap_or_default();
    let rest = line
        .chars()
        .skip((fault.column as usize).saturating_sub(1))
        .count();
    let length = u32::try_from(rest).unwrap_or(1).max(1);
    FileFault {
        severity: Severity::Error,
        title: "the EPROM cannot be written".into(),
        path: path.to_owned(),
        marked: Marked {
            line: fault.line,
            text: line.to_owned(),
            columns: (fault.line > 0).then_some((fault.column, length)),
        },
        label: fault.message,
        help: None,
        opened: None,
    }
}

fn print(faults: Vec<FileFault>) -> Outcome {
    diagnostics::print_faults(&faults);
    Outcome::ProgramError
}
