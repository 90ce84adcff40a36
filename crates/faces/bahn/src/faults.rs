//! `bahn faults`: what the control does about each fault, from the table that it acts by.

use bahn_parameters::ControlModel;
use bahn_parameters::fault::{Fault, FaultId};
use bahn_report::text;
use clap::Args;
use serde::Serialize;

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

/// A row of the table.
#[derive(Debug, Serialize)]
struct Row {
    id: &'static str,
    cause: &'static str,
    message: Option<String>,
    letter: &'static str,
    flashes: bool,
    seen: &'static str,
    reaction: &'static str,
    travel: &'static str,
    clearing: &'static str,
    source: &'static str,
}

impl Row {
    fn of(fault: &Fault, model: ControlModel) -> Row {
        Row {
            id: fault.id.name(),
            cause: fault.cause,
            message: fault
                .message
                .map(|message| message.text(model).replace('#', "<AXIS>")),
            letter: fault.letter,
            flashes: fault.flashes(),
            seen: fault.seen.word(),
            reaction: fault.reaction.word(),
            travel: fault.travel.word(),
            clearing: fault.clearing.word(),
            source: fault.source,
        }
    }

    /// The message with its letter.
    fn said(&self) -> String {
        let message = self.message.as_deref().unwrap_or("-");
        match self.letter {
            "" => message.to_owned(),
            letter => format!("{message} {letter}"),
        }
    }
}

pub(crate) fn command(options: &FaultsOptions) -> Result<Outcome, UsageError> {
    let rows: Vec<Row> = FaultId::ALL
        .iter()
        .map(|id| Row::of(id.row(), options.model))
        .collect();
    let text = match options.format {
        TableFormat::Json => text::json(&rows)?,
        TableFormat::Markdown => markdown(&rows),
        TableFormat::Text => rows.iter().map(text).collect(),
    };
    console::print(&text)?;
    Ok(Outcome::Fine)
}

fn text(row: &Row) -> String {
    let flashes = if row.flashes { ", flashing" } else { "" };
    let lines = [
        ("message", format!("{}{flashes}", row.said())),
        ("seen", row.seen.to_owned()),
        ("reaction", row.reaction.to_owned()),
        ("way left", row.travel.to_owned()),
        ("cleared by", row.clearing.to_owned()),
        ("source", row.source.to_owned()),
    ];
    let mut text = format!("{}: {}\n", row.id, row.cause);
    for (label, line) in lines {
        text += &format!("  {label:<11}{line}\n");
    }
    text
}

fn markdown(rows: &[Row]) -> String {
    let mut text = String::from(
        "# What the control does about faults\n\nThe table by which the kernel acts, as `bahn faults` prints it; `bahn torture` holds the running control to it\n\
         (`docs/torture.md`). This file is made of it: `make faults`.\n\n\
         Flashing messages need switching off; v is the speed of the axis, T the contour cycle, a an acceleration.\n\n\
         | fault | cause | message | seen | reaction | way left | cleared by | source |\n|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let flashes = if row.flashes { ", flashing" } else { "" };
        text += &format!(
            "| {} | {} | {}{flashes} | {} | {} | {} | {} | {} |\n",
            row.id,
            row.cause,
            row.said(),
            row.seen,
            row.reaction,
            row.travel,
            row.clearing,
            row.source
        );
    }
    text
}
