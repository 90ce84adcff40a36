//! Lists of machine parameters.

mod complete;
mod hover;
mod parameter_text;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use bahn_text::Diagnostic;

use crate::language::{
    Analysis, Completion, Examined, Fold, Hover, Mention, Role, Symbol, SymbolKind, Thing, Token,
};
use crate::world::World;

use parameter_text::Entry;
pub(crate) use parameter_text::ParameterText;

impl Analysis for ParameterText {
    fn examine(&self, _: &World, _: &AtomicBool) -> Examined {
        let read = self.list.faults().iter();
        let mut faults: Vec<Diagnostic> = read
            .map(|fault| fault.diagnostic(&self.list, &self.path))
            .collect();
        let missing = self.missing();
        if faults.is_empty() && missing.is_none() {
            let found = self.list.inconsistencies();
            faults.extend(found.iter().map(|found| found.diagnostic(&self.list, &self.path)));
        }
        let mut faults: Vec<Diagnostic> = faults.into_iter().map(|fault| self.placed(fault)).collect();
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
            let after = self.text.get(entry.value.end..entry.line.end).trim();
            formatted += format!("{:<9}: {value:<12} {after}", entry.definition.id.to_string()).trim_end();
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
