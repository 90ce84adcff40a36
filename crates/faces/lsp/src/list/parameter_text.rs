//! A list of machine parameters, read for all questions about it.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use bahn_parameters::{ControlModel, Definition, ListText, ParameterError};
use bahn_text::{Diagnostic, Span, without_mark};

use crate::language::Mention;
use crate::text::Text;
use crate::world::World;

/// A list as the editor has it.
pub(crate) struct ParameterText {
    pub(super) text: Arc<Text>,
    pub(super) model: ControlModel,
    pub(super) path: PathBuf,
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
            path: path.to_owned(),
            list: ListText::from_bytes(model, bytes),
            front: text.text.len() - without_mark(&text.text).len(),
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

    /// A fault of the list at its place in the document.
    pub(super) fn placed(&self, fault: Diagnostic) -> Diagnostic {
        let bytes = |span: Span| {
            let line = self.line(span.line as usize);
            match span.columns() {
                Some((column, length)) => self.text.characters(line, column as usize, length as usize),
                None => line,
            }
        };
        let span = |span: Span| self.text.span(&bytes(span));
        let mut placed = fault;
        placed.span = span(placed.span);
        for related in &mut placed.related {
            related.span = span(related.span);
        }
        placed
    }

    /// Parameters that the control would miss, in one fault: a list of changes lacks most of them.
    pub(super) fn missing(&self) -> Option<Diagnostic> {
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
        (!missing.is_empty()).then(|| {
            let message = format!(
                "MP not defined: {} of the {} ({named}{more}); a whole list must have them",
                missing.len(),
                self.model.name()
            );
            Diagnostic::warning(self.text.span(&self.line(1)), message).with_code("5")
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
