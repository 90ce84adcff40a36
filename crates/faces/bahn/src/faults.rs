//! `bahn faults`: what the control does about each fault, from the table that it acts by.

use bahn_parameters::ControlModel;
use bahn_report::{faults, text};
use clap::Args;

use crate::conformance::TableFormat;
use crate::options::model_parser;
use crate::{Outcome, UsageError, console};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn faults                     every fault: cause, message, reaction, way that is left, what clears it
  bahn faults --model tnc360      with the message texts of a TNC 360
  bahn faults --format json

JSON: a list of id, cause, message, letter, flashes, seen, reaction, travel, clearing, source.";

/// Options of `bahn faults`.
#[derive(Args, Debug)]
pub(crate) struct FaultsOptions {
    /// Control model whose texts are shown.
    #[arg(long, value_name = "MODEL", default_value_t, ignore_case = true, value_parser = model_parser())]
    pub model: ControlModel,
    /// How the table is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: TableFormat,
}

pub(crate) fn command(options: &FaultsOptions) -> Result<Outcome, UsageError> {
    let rows = faults::rows(options.model);
    let text = match options.format {
        TableFormat::Json => text::json(&rows)?,
        TableFormat::Markdown => faults::markdown(&rows),
        TableFormat::Text => rows.iter().map(faults::text).collect(),
    };
    console::print(&text)?;
    Ok(Outcome::Fine)
}
