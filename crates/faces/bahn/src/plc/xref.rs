//! `bahn plc xref`: where operands and labels are used.

use bahn_report::plc::Reference;

use super::options::XrefOptions;
use super::source::Source;
use crate::options::Format;
use crate::{Outcome, UsageError, console};

/// Prints the cross-reference of a program.
pub(super) fn command(options: &XrefOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let Some(program) = source.program() else {
        return Ok(Outcome::ProgramError);
    };
    let mut reference = Reference::of(&program);
    if !options.only.is_empty() {
        reference.only(&options.only);
    }
    match options.format {
        Format::Json => console::print_json(&reference)?,
        Format::Text => console::print(&reference.text())?,
    }
    Ok(Outcome::Fine)
}
