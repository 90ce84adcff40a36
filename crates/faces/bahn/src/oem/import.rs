//! `bahn oem import`: what is in the S records of an EPROM.

use std::io::Write as _;

use bahn_host::eprom::LoadList;
use bahn_host::files::{self, NewFile};
use bahn_host::s_records::Image;
use bahn_text::{Diagnostic, Span, decode};

use super::options::ImportOptions;
use crate::{Outcome, UsageError, console, diagnostics};

/// Verifies the records, and shows or writes their files.
pub(super) fn command(options: &ImportOptions) -> Result<Outcome, UsageError> {
    let text = decode(&files::read_description(&options.records)?);
    let read = Image::from_records(&text).and_then(|image| {
        LoadList::of_image(&image).map_err(|message| Diagnostic::error(Span::FILE, message))
    });
    let (list, contents) = match read {
        Ok(read) => read,
        Err(fault) => {
            let fault = fault.under("these are no records of an EPROM");
            diagnostics::print_fault(&fault.in_text(options.records.as_path(), &text));
            return Ok(Outcome::ProgramError);
        }
    };
    let mut shown = format!("IDENT {}\n", list.ident);
    if list.is_large {
        shown.push_str("SIZE 2MB\n");
    }
    for (file, content) in list.files.iter().zip(&contents) {
        let main = if file.is_main { "/M" } else { "" };
        shown.push_str(&format!("LOAD {}{main}, {} bytes\n", file.name, content.len()));
    }
    if let Some(folder) = &options.to {
        let paths: Vec<_> = list.files.iter().map(|file| folder.join(&file.name)).collect();
        if let Some(there) = paths.iter().find(|path| path.exists() && !options.force) {
            let text = format!("{} is there; --force replaces it", there.display());
            return Err(UsageError::new(text));
        }
        for (path, content) in paths.iter().zip(&contents) {
            let mut file = NewFile::create(path)?;
            let written = file.write_all(content);
            written.map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
        }
    }
    console::print(&shown)?;
    Ok(Outcome::Fine)
}
