//! The lines of a DIN 66025 text and their words, whatever the dialect.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_din::{Span, SpanKind};
use bahn_text::{Diagnostic, Files, NamedFile};

use crate::language::{Mention, Thing, Token, led_to, mentions_of};
use crate::text::Text;
use crate::world::World;

/// A text with the words of its lines.
pub(crate) struct Marked {
    pub(crate) text: Arc<Text>,
    /// The bytes of each line, from line 1 on.
    lines: Vec<Range<usize>>,
    words: fn(&str) -> Vec<Span>,
}

impl Marked {
    /// A text whose lines are these in their order.
    pub(crate) fn new<'a>(
        text: Arc<Text>,
        lines: impl Iterator<Item = &'a str>,
        words: fn(&str) -> Vec<Span>,
    ) -> Marked {
        let mut from = 0;
        let lines = lines.map(|line| {
            // Each line stands after the one before it.
            let found = text.text.get(from..).and_then(|rest| rest.find(line));
            let start = from + found.unwrap_or_default();
            from = start + line.len();
            start..from
        });
        Marked {
            lines: lines.collect(),
            text,
            words,
        }
    }

    /// The bytes of all lines.
    pub(crate) fn lines(&self) -> &[Range<usize>] {
        &self.lines
    }

    /// The bytes of a line, from 1.
    pub(crate) fn line(&self, number: u32) -> Range<usize> {
        let end = self.text.text.len();
        let index = (number as usize).checked_sub(1);
        let line = index.and_then(|index| self.lines.get(index).cloned());
        line.unwrap_or(end..end)
    }

    pub(crate) fn words_of(&self, line: Range<usize>) -> Vec<(Range<usize>, SpanKind)> {
        let spans = (self.words)(self.text.get(line.clone()));
        let bytes = |span: &Span| {
            self.text
                .characters(line.clone(), span.column as usize, span.length as usize)
        };
        spans.iter().map(|span| (bytes(span), span.kind)).collect()
    }

    /// The word at a place.
    pub(crate) fn word_at(&self, at: usize) -> Option<(Range<usize>, SpanKind)> {
        let words = self.words_of(self.text.line_at(at));
        let inside = words.iter().find(|(range, _)| range.contains(&at));
        inside
            .or_else(|| words.iter().find(|(range, _)| range.end == at))
            .cloned()
    }

    /// The bytes of a place in the program.
    pub(crate) fn bytes(&self, span: bahn_text::Span) -> Range<usize> {
        let line = self.line(span.line);
        self.text
            .characters(line, span.column as usize, span.length as usize)
    }

    /// A fault of the program at its place in the text.
    pub(crate) fn placed(&self, fault: Diagnostic) -> Diagnostic {
        let place = self.bytes(fault.span);
        Diagnostic {
            span: self.text.span(&place),
            ..fault
        }
    }

    /// A fault of a file of another name that this one calls, where it does so first.
    pub(crate) fn placed_elsewhere(
        &self,
        fault: Diagnostic,
        name: String,
        mentions: &[Mention],
    ) -> Diagnostic {
        let file = Thing::File(name);
        let call = mentions_of(mentions, &file).next();
        let place = call.map_or_else(|| self.line(1), |call| call.range.clone());
        led_to(fault, self.text.span(&place))
    }

    /// All words by kind.
    pub(crate) fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        let token = |kind: SpanKind| match kind {
            SpanKind::Comment => Token::Comment,
            SpanKind::Head | SpanKind::Function | SpanKind::Command => Token::Keyword,
            SpanKind::Number => Token::Label,
            SpanKind::Address => Token::Parameter,
            SpanKind::Value => Token::Number,
            SpanKind::Variable => Token::Variable,
            SpanKind::Text => Token::Text,
            SpanKind::Calculation => Token::Function,
        };
        let words = self.lines.iter().flat_map(|line| self.words_of(line.clone()));
        words.map(|(range, kind)| (range, token(kind))).collect()
    }

    /// Numbers of lines, from 1, as people read them: twelve at most.
    pub(crate) fn line_numbers(&self, places: impl Iterator<Item = usize>) -> String {
        let number = |at: usize| (self.text.lines.line_of(at) + 1).to_string();
        let lines: Vec<String> = places.take(12).map(number).collect();
        lines.join(", ")
    }
}

/// Files beside a program or below, as the editor shows them, else from the disk.
pub(crate) struct Beside {
    folder: PathBuf,
    world: World,
}

impl Beside {
    /// The folder of a program.
    pub(crate) fn of(program: &Path, world: &World) -> Beside {
        Beside {
            folder: program.parent().unwrap_or(Path::new("")).to_owned(),
            world: world.clone(),
        }
    }
}

impl Files for Beside {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let path = self.world.below(&self.folder, name)?;
        let bytes = self.world.read(&path)?;
        let name = path.strip_prefix(&self.folder).ok()?.to_str()?.to_owned();
        Some(NamedFile { name, bytes })
    }
}
