//! A list of machine parameters, read for all questions about it.

use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use bahn_parameters::{ControlModel, Definition, ListError, ListText, ParameterError};

use crate::language::{Fault, Mention, Place, Related, Severity};
use crate::text::Text;
use crate::world::World;

/// A list as the editor has it.
pub(crate) struct ParameterText {
    pub(super) text: Arc<Text>,
    pub(super) model: ControlModel,
    pub(super) list: ListText,
    /// Bytes of a mark in front, which the list does not count.
    pub(super) front: usize,
    pub(super) mentions: OnceLock<Vec<Mention>>,
}

impl ParameterText {
    pub(crate) fn new(path: &Path, text: Arc<Text>, world: &World) -> ParameterText {
        let bytes = text.text.as_bytes();
        let set = world.settings.model.or_else(|| world.files.model_of(path));
        let model = set.or_else(|| ControlModel::named_in(bytes)).unwrap_or_default();
        ParameterText {
            model,
            list: ListText::from_bytes(model, bytes),
            front: if text.text.starts_with('\u{feff}') { 3 } else { 0 },
            text,
            mentions: OnceLock::new(),
        }
    }

    /// The bytes of a line of the list, which counts lines by LF from 1.
    pub(super) fn line(&self, number: usize) -> Range<usize> {
        let mut start = 0;
        for (at, line) in self.text.text.split_inclusive('\n').enumerate() {
            if at + 1 == number {
                return start..start + line.trim_end_matches(['\r', '\n']).len();
            }
            start += line.len();
        }
        start..start
    }

    /// Where the entries stand: definition and bytes of line, number and value.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let mut starts = vec![0];
        starts.extend(self.text.text.match_indices('\n').map(|(at, _)| at + 1));
        let entries = self.list.entries().iter().filter_map(|entry| {
            let definition = Definition::named(self.model, entry.id).ok()?;
            let start = *starts.get(entry.line.checked_sub(1)?)?;
            let end = starts.get(entry.line).copied().unwrap_or(self.text.text.len());
            let text = self.text.get(start..end).trim_end_matches(['\r', '\n']);
            let blanks = text.len() - text.trim_start().len();
            let name = text.trim_start();
            let length = name
                .find(|c: char| !c.is_ascii_alphanumeric() && c != '.')
                .unwrap_or(name.len());
            let value = entry.value_at();
            Some(Entry {
                definition,
                number: entry.value,
                line: start..start + text.len(),
                name: start + blanks..start + blanks + length,
                value: value.start + self.front..value.end + self.front,
            })
        });
        entries.collect()
    }

    pub(super) fn fault(&self, fault: &ListError) -> Fault {
        let number = fault.error.number();
        let mut related = Vec::new();
        if let ParameterError::DoublyDefined { first_line, .. } = fault.error {
            related.push(Related {
                path: None,
                place: Place::Here(self.line(first_line)),
                message: "it is defined here first".to_owned(),
            });
        }
        Fault {
            range: self
                .text
                .characters(self.line(fault.line), fault.column, fault.length),
            severity: Severity::Error,
            code: number.to_string(),
            message: format!("{}: {}", fault.error.control_text(), fault.error),
            related,
        }
    }

    /// Parameters that the control would miss, in one fault: a list of changes lacks most of them.
    pub(super) fn missing(&self) -> Option<Fault> {
        let all = self.list.all_faults();
        let missing: Vec<String> = all
            .iter()
            .filter_map(|fault| match fault.error {
                ParameterError::NotDefined(id) => Some(id.to_string()),
                _ => None,
            })
            .collect();
        const NAMED: usize = 8;
        let named = missing
            .get(..missing.len().min(NAMED))
            .unwrap_or_default()
            .join(" ");
        let more = if missing.len() > NAMED { " ..." } else { "" };
        (!missing.is_empty()).then(|| Fault {
            range: self.line(1),
            severity: Severity::Warning,
            code: "5".to_owned(),
            message: format!(
                "MP not defined: {} of the {} ({named}{more}); a whole list must have them",
                missing.len(),
                self.model.name()
            ),
            related: Vec::new(),
        })
    }
}

/// An entry of the list at its place.
pub(super) struct Entry {
    pub(super) definition: &'static Definition,
    pub(super) number: f64,
    pub(super) line: Range<usize>,
    pub(super) name: Range<usize>,
    pub(super) value: Range<usize>,
}
