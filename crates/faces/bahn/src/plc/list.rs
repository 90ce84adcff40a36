//! `bahn plc list`: the program as formatted listing.

use bahn_report::plc::Listing;

use super::options::ListOptions;
use super::source::Source;
use crate::options::Format;
use crate::{Outcome, UsageError, console};

/// Prints all files of a program with line numbers, commands and comments in columns. Errors and warnings
/// stand below their lines.
pub(super) fn command(options: &ListOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let compilation = &source.compilation;
    let files = Listing::of(compilation);
    match options.format {
        Format::Json => console::print_json(&files)?,
        Format::Text => {
            let files: Vec<String> = files.iter().map(Listing::text).collect();
            console::print(&files.join("\n"))?;
        }
    }
    Ok(if compilation.errors.is_empty() {
        Outcome::Fine
    } else {
        Outcome::ProgramError
    })
}
