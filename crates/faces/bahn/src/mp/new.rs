//! `bahn mp new`: a complete list to start from.

use std::io::Write;

use bahn_parameters::{ControlModel, ListText, ParameterList};

use super::options::NewOptions;
use super::source;
use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, console, diagnostics};
use bahn_report::count;

/// Writes a list to standard output or to a file.
pub(super) fn command(options: &NewOptions) -> Result<Outcome, UsageError> {
    let text = text(options)?;
    let bytes = text.to_bytes();
    match &options.output {
        None => console::print_bytes(&bytes)?,
        Some(path) => {
            let mut file = NewFile::create(path)?;
            file.write_all(&bytes)
                .map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
            let entries = count(text.entries().len(), "parameter");
            diagnostics::print_text(&format!("{}: {}, {entries}", path.display(), text.model()));
        }
    }
    Ok(Outcome::Fine)
}

fn text(options: &NewOptions) -> Result<ListText, UsageError> {
    if let Some(path) = &options.from {
        let mut text = source::read(path, options.model)?;
        // A list with faults would get a second line for what cannot be read.
        source::values(path, &text)?;
        text.complete();
        return Ok(text);
    }
    let model = options.model.unwrap_or_default();
    let reference = ParameterList::reference_text(model);
    let mut text = if options.smallest {
        ListText::from_bytes(
            model,
            heading(model, "as the control makes it by itself").as_bytes(),
        )
    } else {
        // The first line names the model that was asked for: the TNC 151 and 155 share their list.
        let rest = reference.split_once('\n').map_or("", |(_, rest)| rest);
        ListText::from_bytes(model, (heading(model, "reference list") + rest).as_bytes())
    };
    if !options.reference_only {
        text.complete();
    }
    Ok(text)
}

fn heading(model: ControlModel, kind: &str) -> String {
    format!("; Machine parameters, {model}: {kind}.\n")
}
