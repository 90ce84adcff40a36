//! What the control does about each fault, from the table that it acts by.

use bahn_parameters::ControlModel;
use bahn_parameters::fault::{Fault, FaultId};
use serde::Serialize;

/// A row of the table.
#[derive(Debug, Serialize)]
pub struct Row {
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

/// All rows, with the texts of a model.
pub fn rows(model: ControlModel) -> Vec<Row> {
    let ids = FaultId::ALL.iter();
    ids.map(|id| Row::of(id.row(), model)).collect()
}

/// A row for people.
pub fn text(row: &Row) -> String {
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

/// As the document has them.
pub fn markdown(rows: &[Row]) -> String {
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
