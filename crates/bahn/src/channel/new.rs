//! `bahn channel new`: a list to start from.

use std::io::Write;

use bahn_technology::list::template;

use super::options::NewOptions;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, console, diagnostics};

/// Writes the template to standard output or to a file.
pub(super) fn command(options: &NewOptions) -> Result<Outcome, UsageError> {
    let text = template();
    let Some(path) = &options.output else {
        console::print(&text)?;
        return Ok(Outcome::Fine);
    };
    if path.is_file() && !options.force {
        return Err(UsageError::new(format!(
            "{} is there already; --force replaces it",
            path.display()
        )));
    }
    let mut file = NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    file.finish()?;
    diagnostics::print_text(&format!("{}: a list without entries", path.display()));
    Ok(Outcome::Fine)
}
