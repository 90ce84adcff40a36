//! Channel parameter lists: text with a parameter in each line [004:57] [004:195-234].
//!
//! Reading never fails: what cannot be read is an error with line and column, and does nothing. `table` is what a list
//! may have, as data; `line` and `value` read a line, `field` puts the value in its place, `checks` finds what does
//! not go together, `write` writes lists.
//!
//! Decision: Of two lines of a channel parameter list for the same parameter the later one counts; a remark that says
//! another type than its value is warned of, and the value counts

mod checks;
mod cure;
mod entry;
mod field;
mod line;
mod search;
mod table;
mod value;
mod write;

pub use search::{Found, find};
pub use table::{Definition, Kind, Owner, SynchRow};
pub use write::template;

use std::collections::BTreeMap;

use bahn_text::{Diagnostic, Span};

use crate::settings::ChannelSettings;

use entry::{Entry, Place, Value};

/// What a list says, and what is wrong with it.
///
/// ```
/// use bahn_technology::{ChannelList, Synchronisation};
/// let list = ChannelList::from_bytes(b"# glue\nm_synch[25] 0x2 MVS_SVS\nm_synch[1000] MOS\n");
/// assert_eq!(list.settings().m.get(25).unwrap().synch.unwrap().kind, Synchronisation::MvsSvs);
/// let error = &list.errors()[0];
/// assert_eq!((error.span.line, error.span.column), (3, 9));
/// assert_eq!(error.message, "index 1000 is not within 0 to 999");
/// ```
#[derive(Clone, Debug)]
pub struct ChannelList {
    settings: ChannelSettings,
    lines: Vec<String>,
    entries: Vec<Entry>,
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
}

/// Contour cycle where nobody says which machine the list is for, s: that of a TNC 415 B.
pub(crate) const CYCLE_S: f64 = 0.003;

impl ChannelList {
    /// Reads a list.
    pub fn from_bytes(bytes: &[u8]) -> ChannelList {
        ChannelList::for_cycle(bytes, CYCLE_S)
    }

    /// Reads a list for a channel whose contour cycle takes so long, s: leads by time are at least one.
    pub fn for_cycle(bytes: &[u8], cycle_s: f64) -> ChannelList {
        let text = bahn_text::decode(bytes);
        let mut list = ChannelList {
            settings: ChannelSettings::default(),
            lines: text.lines().map(str::to_owned).collect(),
            entries: Vec::new(),
            errors: Vec::new(),
            warnings: Vec::new(),
        };
        for at in 0..list.lines.len() {
            list.read_line(at);
        }
        list.take_entries();
        let cycle_us = (cycle_s * 1e6).round() as u32;
        let (errors, warnings) = checks::check(&list.settings, &list.entries, cycle_us);
        list.errors.extend(errors);
        list.warnings.extend(warnings);
        checks::drop_process_times(&mut list.settings);
        list.errors.sort();
        list.warnings.sort();
        list
    }

    /// What it sets; lines with errors set nothing.
    pub fn settings(&self) -> &ChannelSettings {
        &self.settings
    }

    /// What keeps it from being used, by line and column.
    pub fn errors(&self) -> &[Diagnostic] {
        &self.errors
    }

    /// What is odd in it, by line and column.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// How many lines say something.
    pub fn entries(&self) -> usize {
        self.entries.len()
    }

    /// The text of a line, from 1 on.
    pub fn line(&self, number: usize) -> &str {
        let at = number.checked_sub(1).and_then(|at| self.lines.get(at));
        at.map_or("", String::as_str)
    }

    fn read_line(&mut self, at: usize) {
        let number = at + 1;
        let Some(text) = self.lines.get(at) else { return };
        let Some(line) = line::split(text) else { return };
        let fault = |(column, length, message): line::Fault| {
            let at = Span::new(number, column, length);
            Diagnostic::error(at, message).with_help(cure::cure(&line))
        };
        let read = line::place(&line).and_then(|place| {
            let read = value::read(place.definition.kind, line.value, line.value_column)?;
            Ok((place, read))
        });
        match read {
            Ok((place, read)) => {
                let entry = Entry {
                    place,
                    value: read.value,
                    name: Span::new(number, line.name_column, line.name.chars().count()),
                    at: Span::new(number, line.value_column, read.length),
                };
                let odd = read.odd.into_iter().map(|message| entry.at_value(message));
                self.warnings.extend(odd);
                self.entries.push(entry);
            }
            Err(found) => self.errors.push(fault(found)),
        }
    }

    /// Puts the values in their places; of two lines for the same the later one counts (inferred).
    fn take_entries(&mut self) {
        let mut lines: BTreeMap<String, u32> = BTreeMap::new();
        for entry in &self.entries {
            let name = entry.place.name();
            if entry.place.is_of_other_channel {
                let message = format!("{name} of another channel has no effect here");
                self.warnings.push(entry.at_name(message));
                continue;
            }
            let acts = field::set(&mut self.settings, &entry.place, &entry.value);
            let why = entry.place.definition.without_effect;
            if !why.is_empty() {
                let message = format!("{name} has no effect here: {why}");
                self.warnings.push(entry.at_name(message));
            } else if !acts {
                self.warnings.push(entry.at_name(without_effect(&entry.place)));
            }
            if let Some(first) = lines.insert(name.clone(), entry.at.line) {
                let message = format!("{name} stands in line {first}, too: this line counts");
                self.warnings.push(entry.at_name(message));
            }
        }
    }
}

/// Why a line does nothing whose parameter does something otherwise.
fn without_effect(place: &Place) -> String {
    let name = place.name();
    match place.definition.name.strip_prefix("spindel[i].") {
        Some(field) if place.indices.is_empty() => {
            format!("{field} without `spindel[i].` before it is of no spindle, and has no effect")
        }
        _ => format!("{name} has no effect here"),
    }
}
