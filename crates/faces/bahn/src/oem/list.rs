//! `bahn oem list`: the cycles of a machine.

use std::fmt::Write as _;

use bahn_host::oem_cycles::{self, OemCycle};
use serde::Serialize;

use super::options::ListOptions;
use crate::options::Format;
use crate::{Outcome, UsageError, console};

#[derive(Debug, Serialize)]
struct Item {
    number: u32,
    file: String,
    memory: &'static str,
    hidden: bool,
    acts: Option<&'static str>,
    name: String,
    parameters: Vec<Parameter>,
    inhibit: Option<String>,
    faults: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Parameter {
    q: u32,
    dialogue: u32,
    text: String,
}

pub(super) fn command(options: &ListOptions) -> Result<Outcome, UsageError> {
    let Some(machine) = super::machine(&options.machine)? else {
        return Ok(Outcome::ProgramError);
    };
    let cycles = oem_cycles::find(&machine.programs(0), &machine.plc_dialogues, &machine.parameters)?;
    let items: Vec<Item> = cycles.iter().map(item).collect();
    match options.format {
        Format::Json => console::print_json(&items)?,
        Format::Text if items.is_empty() => console::print("no cycles of the machine builder\n")?,
        Format::Text => console::print(&items.iter().map(text).collect::<String>())?,
    }
    Ok(match items.iter().any(|item| !item.faults.is_empty()) {
        true => Outcome::ProgramError,
        false => Outcome::Fine,
    })
}

fn item(cycle: &OemCycle) -> Item {
    let dialog = cycle.dialog.as_ref();
    let parameters = dialog.map_or(&[][..], |dialog| &dialog.parameters).iter();
    Item {
        number: cycle.number,
        file: cycle.path.display().to_string(),
        memory: if cycle.in_eprom { "EPROM" } else { "program memory" },
        hidden: cycle.is_hidden,
        acts: dialog.map(|dialog| {
            if dialog.at_call {
                "at_call"
            } else {
                "at_definition"
            }
        }),
        name: dialog.map_or_else(String::new, |dialog| dialog.name.text.clone()),
        parameters: parameters
            .map(|(q, text)| Parameter {
                q: *q,
                dialogue: text.number,
                text: text.text.clone(),
            })
            .collect(),
        inhibit: cycle.in_eprom.then(|| format!("M{}", cycle.inhibit())),
        faults: cycle.faults(cycle.in_eprom),
    }
}

fn text(item: &Item) -> String {
    let acts = match item.acts {
        Some("at_call") => ", acts at the cycle call",
        Some(_) => ", acts at its definition",
        None => "",
    };
    let inhibit = item
        .inhibit
        .as_ref()
        .map_or_else(String::new, |marker| format!(", inhibited by {marker}"));
    let hidden = if item.hidden { ", hidden" } else { "" };
    let mut text = format!(
        "{} {}: {}{acts}{inhibit}{hidden}\n",
        item.number, item.name, item.memory
    );
    for Parameter { q, text: own, .. } in &item.parameters {
        // Writing into a string never fails.
        let _ = writeln!(text, "   Q{q:<3} {own}");
    }
    for fault in &item.faults {
        let _ = writeln!(text, "   {}: {fault}", item.file);
    }
    text
}
