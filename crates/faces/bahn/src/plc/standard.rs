//! `bahn plc standard`: the PLC program that a control is delivered with.

use std::io::Write;

use bahn_plc::standard_program;

use super::options::StandardOptions;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, console};

/// Prints the standard program of a model, or writes it to a file.
pub(super) fn command(options: &StandardOptions) -> Result<Outcome, UsageError> {
    let model = options.model;
    let text = standard_program(model).ok_or_else(|| {
        UsageError::new(format!(
            "the {} has no standard PLC program; those of TNC 151 and TNC 155 have one",
            model.name()
        ))
    })?;
    match &options.output {
        None => console::print(text)?,
        Some(path) => {
            let mut file = NewFile::create(path)?;
            file.write_all(text.as_bytes())
                .map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
        }
    }
    Ok(Outcome::Fine)
}
