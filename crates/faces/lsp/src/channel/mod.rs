//! Channel parameter lists of a TF5200, `.lis`: what `bahn technology` reads.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_technology::ChannelList;
use bahn_technology::list::{Definition, SynchRow};
use bahn_text::{Diagnostic, Span};

use crate::language::{
    Analysis, Completion, CompletionKind, Examined, Fold, Hover, Mention, Symbol, SymbolKind, Thing, Token,
};
use crate::markdown::Markdown;
use crate::text::Text;
use crate::world::World;

/// A list as the editor has it.
pub(crate) struct ChannelText {
    text: Arc<Text>,
    list: ChannelList,
}

impl ChannelText {
    pub(crate) fn new(text: Arc<Text>) -> ChannelText {
        ChannelText {
            list: ChannelList::from_bytes(text.text.as_bytes()),
            text,
        }
    }

    /// The bytes of the lines, without their ends.
    fn lines(&self) -> Vec<Range<usize>> {
        let mut start = 0;
        let lines = self.text.text.split_inclusive('\n').map(|line| {
            let range = start..start + line.trim_end_matches(['\r', '\n']).len();
            start += line.len();
            range
        });
        lines.collect()
    }

    /// The word of a name, a constant or a number around a place.
    fn word_at(&self, at: usize) -> Range<usize> {
        let line = self.text.line_at(at);
        let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '[' | ']' | '-');
        let before = self.text.get(line.start..at);
        let after = self.text.get(at..line.end);
        let start = before.trim_end_matches(is_part).len();
        let length = after.len() - after.trim_start_matches(is_part).len();
        line.start + start..at + length
    }

    fn fault(&self, lines: &[Range<usize>], fault: &Diagnostic) -> Diagnostic {
        let Span { line, column, length } = fault.span;
        let line = (line as usize).checked_sub(1).and_then(|index| lines.get(index));
        let line = line.cloned().unwrap_or_default();
        let place = self.text.characters(line, column as usize, length as usize);
        Diagnostic {
            span: self.text.span(&place),
            ..fault.clone()
        }
    }

    /// The lines with a parameter: the line, its name, and what it is.
    fn entries(&self) -> Vec<(Range<usize>, Range<usize>, &'static Definition)> {
        let entries = self.lines().into_iter().filter_map(|line| {
            let text = self.text.get(line.clone());
            let start = line.start + text.len() - text.trim_start().len();
            let name = self.word_at(start);
            let definition = Definition::named(self.text.get(name.clone()))?;
            Some((line, name, definition))
        });
        entries.collect()
    }
}

/// Where a comment begins in a line [004:123].
fn comment(line: &str) -> Option<usize> {
    line.find(['#', ';'])
}

fn explained(definition: &Definition) -> String {
    let without = definition.without_effect;
    Markdown::titled(&format!("{}: {}", definition.id, definition.name))
        .paragraph(definition.meaning)
        .fact("Unit", definition.unit)
        .fact("Range", &definition.kind.range())
        .fact("Without an entry", definition.default)
        .fact("Here without effect", without)
        .source(&format!("[{}]", definition.source.replace(';', "] [")))
        .text()
}

fn synchronisation(row: &SynchRow) -> String {
    Markdown::titled(&format!("{} = 0x{:08X}", row.name, row.bits))
        .paragraph(row.meaning)
        .fact("Output", row.output)
        .fact("The path waits", row.wait)
        .source(&format!("[{}]", row.source.replace(';', "] [")))
        .text()
}

impl Analysis for ChannelText {
    fn examine(&self, _: &World, _: &AtomicBool) -> Examined {
        let lines = self.lines();
        let all = self.list.errors().iter().chain(self.list.warnings());
        Examined {
            faults: all.map(|fault| self.fault(&lines, fault)).collect(),
            ..Examined::default()
        }
    }

    fn hover(&self, at: usize, _: Option<&Examined>) -> Option<Hover> {
        let range = self.word_at(at);
        let word = self.text.get(range.clone());
        let text = match SynchRow::find(word) {
            Some(row) => synchronisation(row),
            None => explained(Definition::named(word)?),
        };
        Some(Hover { range, text })
    }

    fn mentions(&self) -> &[Mention] {
        &[]
    }

    fn symbols(&self) -> Vec<Symbol> {
        let symbols = self
            .entries()
            .into_iter()
            .map(|(range, selection, definition)| Symbol {
                name: self.text.get(selection.clone()).to_owned(),
                detail: definition.id.to_owned(),
                kind: SymbolKind::Parameter,
                range,
                selection,
                children: Vec::new(),
            });
        symbols.collect()
    }

    fn folds(&self) -> Vec<Fold> {
        Vec::new()
    }

    /// Names at the begin of a line, synchronisation types after one.
    fn completions(&self, at: usize, _: &World) -> Vec<Completion> {
        let line = self.text.line_at(at);
        let before = self.text.get(line.start..at);
        if comment(before).is_some() {
            return Vec::new();
        }
        let range = self.word_at(at).start..at;
        let proposal = |label: &str, detail: &str, documentation: String, kind| Completion {
            label: label.to_owned(),
            detail: detail.to_owned(),
            documentation,
            kind,
            range: range.clone(),
            snippet: label.to_owned(),
        };
        if before.trim_start().contains(char::is_whitespace) {
            let rows = SynchRow::all().iter();
            return rows
                .map(|row| proposal(row.name, row.output, synchronisation(row), CompletionKind::Value))
                .collect();
        }
        let all = Definition::all().iter();
        all.map(|of| proposal(of.name, of.id, explained(of), CompletionKind::Parameter))
            .collect()
    }

    fn formatted(&self, _: &World) -> Result<String, String> {
        Err("a channel list keeps its form".to_owned())
    }

    fn can_rename(&self, _: &Thing) -> bool {
        false
    }

    fn renamed(&self, _: &Thing, _: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        Err("channel parameters have fixed names".to_owned())
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        let names = self.entries().into_iter();
        let mut tokens: Vec<_> = names.map(|(_, name, _)| (name, Token::Parameter)).collect();
        for line in self.lines() {
            if let Some(at) = comment(self.text.get(line.clone())) {
                tokens.push((line.start + at..line.end, Token::Comment));
            }
        }
        tokens.sort_by_key(|(range, _)| range.start);
        tokens
    }
}
