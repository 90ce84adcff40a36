//! `bahn table convert`: a table in another format.

use bahn_host::PlainTable;

use super::options::{ConvertOptions, WriteFormat};
use super::source;
use crate::{Outcome, UsageError, diagnostics, files};

/// Writes a table to standard output or to a file.
pub(super) fn command(options: &ConvertOptions) -> Result<Outcome, UsageError> {
    let source = source::read(&options.table, options.kind)?;
    if let Err(faults) = source.kind.check(&source.text) {
        source.print(&faults);
        return Ok(Outcome::ProgramError);
    }
    let mut table = PlainTable::new(source.kind, &source.table);
    if options.all_columns {
        table.complete();
    }
    let by_ending = options.output.as_deref().map(files::extension);
    let format = options.to.unwrap_or(match by_ending.as_deref() {
        Some("tsv") => WriteFormat::Tsv,
        Some("csv") => WriteFormat::Csv,
        _ => WriteFormat::Control,
    });
    let named = options.output.as_ref().unwrap_or(&options.table);
    let name = named.file_stem().unwrap_or_default().to_string_lossy();
    let text = match format {
        WriteFormat::Control => table.of_control(&name),
        WriteFormat::Tsv => table.separated('\t'),
        WriteFormat::Csv => table.separated(','),
    };
    let written = files::write_or_print(&text, options.output.as_deref(), options.force)?;
    if let Some(path) = options.output.as_ref().filter(|_| written) {
        diagnostics::print_text(&format!("{}: {} lines", path.display(), table.rows.len()));
    }
    Ok(Outcome::Fine)
}
