//! Lists of machine parameters.

mod complete;
mod hover;

use std::ops::Range;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use bahn_parameters::{ControlModel, Definition, ListError, ListText, ParameterError, chapters};

use crate::language::{
    Analysis, Completion, Examined, Fault, Fold, Hover, Mention, Place, Related, Role, Severity, Symbol,
    SymbolKind, Thing, Token,
};
use crate::text::Text;
use crate::world::World;

/// A list as the editor has it.
pub(crate) struct ParameterText {
    text: Arc<Text>,
    model: ControlModel,
    list: ListText,
    /// Bytes of a mark in front, which the list does not count.
    front: usize,
    mentions: OnceLock<Vec<Mention>>,
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
    fn line(&self, number: usize) -> Range<usize> {
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
    fn entries(&self) -> Vec<Entry> {
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

    fn fault(&self, fault: &ListError) -> Fault {
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
    fn missing(&self) -> Option<Fault> {
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
struct Entry {
    definition: &'static Definition,
    number: f64,
    line: Range<usize>,
    name: Range<usize>,
    value: Range<usize>,
}

impl Analysis for ParameterText {
    fn examine(&self, _: &World, _: &AtomicBool) -> Examined {
        let mut faults: Vec<Fault> = self.list.faults().iter().map(|fault| self.fault(fault)).collect();
        let missing = self.missing();
        if faults.is_empty() && missing.is_none() {
            let entries = self.entries();
            let found = self.list.inconsistencies();
            faults.extend(found.iter().map(|found| {
                Fault {
                    range: entries
                        .iter()
                        .find(|entry| entry.definition.id == found.id)
                        .map_or_else(|| self.line(1), |entry| entry.value.clone()),
                    severity: match found.impossible {
                        true => Severity::Error,
                        false => Severity::Warning,
                    },
                    code: found.id.to_string(),
                    message: format!(
                        "{}: {} ({})",
                        found.rule,
                        found.detail,
                        chapters(found.source).join("; ")
                    ),
                    related: Vec::new(),
                }
            }));
        }
        faults.extend(missing);
        Examined {
            faults,
            not_listed: self.list.not_listed(),
            ..Examined::default()
        }
    }

    fn hover(&self, at: usize, _: Option<&Examined>) -> Option<Hover> {
        hover::hover(self, at)
    }

    fn mentions(&self) -> &[Mention] {
        self.mentions.get_or_init(|| {
            let entries = self.entries().into_iter();
            let mention = |entry: Entry| Mention {
                thing: Thing::MachineParameter(entry.definition.id.to_string()),
                range: entry.name,
                role: Role::Sets,
            };
            entries.map(mention).collect()
        })
    }

    fn symbols(&self) -> Vec<Symbol> {
        let mut groups: Vec<Symbol> = Vec::new();
        for entry in self.entries() {
            let group = entry.definition.group().unwrap_or("Machine parameters");
            let axis = match entry.definition.axis {
                "" => String::new(),
                axis => format!(", {axis}"),
            };
            let symbol = Symbol {
                name: format!("{} {}{axis}", entry.definition.id, entry.definition.name),
                detail: self.text.get(entry.value.clone()).to_owned(),
                kind: SymbolKind::Parameter,
                range: entry.line.clone(),
                selection: entry.name,
                children: Vec::new(),
            };
            match groups.last_mut().filter(|last| last.name == group) {
                Some(last) => {
                    last.range.end = entry.line.end;
                    last.children.push(symbol);
                }
                None => groups.push(Symbol {
                    name: group.to_owned(),
                    detail: String::new(),
                    kind: SymbolKind::Section,
                    range: entry.line.clone(),
                    selection: entry.line,
                    children: vec![symbol],
                }),
            }
        }
        groups
    }

    fn folds(&self) -> Vec<Fold> {
        let groups = self.symbols().into_iter().map(|group| Fold {
            first: self.text.lines.line_of(group.range.start),
            last: self.text.lines.line_of(group.range.end),
            is_comment: false,
        });
        groups.collect()
    }

    fn completions(&self, at: usize, _: &World) -> Vec<Completion> {
        complete::completions(self, at)
    }

    /// Entries in columns with their values in the best format; comments and order stay.
    fn formatted(&self, _: &World) -> Result<String, String> {
        let mut formatted = String::new();
        let mut from = 0;
        for entry in self.entries() {
            formatted += self.text.get(from..entry.line.start);
            let value = entry.definition.format_value(entry.number);
            let behind = self.text.get(entry.value.end..entry.line.end).trim();
            formatted += format!("{:<9}: {value:<12} {behind}", entry.definition.id.to_string()).trim_end();
            from = entry.line.end;
        }
        Ok(formatted + self.text.get(from..self.text.text.len()))
    }

    fn can_rename(&self, _: &Thing) -> bool {
        false
    }

    fn renamed(&self, _: &Thing, _: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        Err("machine parameters have fixed numbers".to_owned())
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        let entries = self.entries();
        let mut tokens: Vec<_> = entries
            .iter()
            .flat_map(|entry| {
                [
                    (entry.name.clone(), Token::Parameter),
                    (entry.value.clone(), Token::Number),
                ]
            })
            .collect();
        let mut start = 0;
        for line in self.text.text.split_inclusive('\n') {
            let code = line.trim_end_matches(['\r', '\n']);
            let is_comment = code.trim_start().starts_with('*');
            if let Some(at) = code.find(';').or(is_comment.then_some(0)) {
                tokens.push((start + at..start + code.len(), Token::Comment));
            }
            start += line.len();
        }
        tokens.sort_by_key(|(range, _)| range.start);
        tokens
    }
}
