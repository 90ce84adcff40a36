//! `bahn channel new`: a list to start from.

use bahn_technology::list::template;

use super::options::NewOptions;
use crate::{Outcome, UsageError, diagnostics, files};

/// Writes the template to standard output or to a file.
pub(super) fn command(options: &NewOptions) -> Result<Outcome, UsageError> {
    let written = files::write_or_print(&template(), options.output.as_deref(), options.force)?;
    if let Some(path) = options.output.as_ref().filter(|_| written) {
        diagnostics::print_text(&format!("{}: a list without entries", path.display()));
    }
    Ok(Outcome::Fine)
}
