//! `bahn oem export`: S records for an EPROM.

use std::io::Write as _;

use bahn_host::eprom::{self, LoadList};
use bahn_host::files::{self, NewFile};
use bahn_host::s_records::Image;
use bahn_text::{Diagnostic, Span, decode};

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
    let fault = |fault: Diagnostic| {
        let fault = fault.under("the EPROM cannot be written");
        fault.in_text(options.list.as_path(), &text)
    };
    let list = match LoadList::parse(&text) {
        Ok(list) => list,
        Err(faults) => return Ok(print(faults.into_iter().map(fault).collect())),
    };
    let (contents, faults) = eprom::contents(&machine, &list)?;
    if !faults.is_empty() {
        return Ok(print(faults.into_iter().map(fault).collect()));
    }
    let whole = |message: String| fault(Diagnostic::error(Span::FILE, message));
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

fn print(faults: Vec<Diagnostic>) -> Outcome {
    diagnostics::print_faults(&faults);
    Outcome::ProgramError
}
