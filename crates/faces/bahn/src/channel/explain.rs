//! `bahn channel explain`: what a parameter, a type or a value means.

use bahn_report::technology::rows;
use bahn_technology::list::{Definition, SynchRow, find};

use super::options::ExplainOptions;
use crate::options::Format;
use crate::style::Style;
use crate::{Outcome, UsageError, console};

/// Explains what is wanted, or lists everything.
pub(super) fn command(options: &ExplainOptions) -> Result<Outcome, UsageError> {
    let (parameters, types) = match &options.wanted {
        None => (
            Definition::all().iter().collect(),
            SynchRow::all().iter().collect(),
        ),
        Some(wanted) => find(wanted.trim()).ok_or_else(|| {
            UsageError::new(format!(
                "nothing here is called `{}`; `bahn channel explain` lists all parameters and types",
                wanted.trim()
            ))
        })?,
    };
    match options.format {
        Format::Json => {
            console::print_json(&rows::items(&parameters, &types))?;
        }
        Format::Text if options.wanted.is_none() => console::print(&rows::overview(&parameters, &types))?,
        Format::Text => {
            let style = Style::of_output();
            let text = rows::text(&parameters, &types, |heading| style.bold(heading));
            console::print_bytes(text.as_bytes())?;
        }
    }
    Ok(Outcome::Fine)
}
