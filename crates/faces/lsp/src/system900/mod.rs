//! Programs and cycles of a System 900, `.900`.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use bahn_din::SpanKind;
use bahn_din::system900::{
    Meaning, Part, Program, Word, WordKind, examine, g_function, m_function, meanings, words,
};

use crate::din::{Beside, Marked};
use crate::language::{
    Analysis, Completion, CompletionKind, Elsewhere, Examined, Fold, Hover, Mention, Role, Symbol,
    SymbolKind, Thing, Token, mention_at, mentions_of,
};
use crate::markdown::Markdown;
use crate::text::Text;
use crate::world::World;

/// A program as the editor has it.
pub(crate) struct System900Program {
    path: PathBuf,
    program: Arc<Program>,
    marked: Marked,
    mentions: OnceLock<Vec<Mention>>,
}

impl System900Program {
    pub(crate) fn new(path: &Path, text: Arc<Text>) -> System900Program {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let program = Arc::new(Program::from_bytes(&name, text.text.as_bytes()));
        let lines = (1..=program.line_count()).map(|number| program.line(number));
        System900Program {
            path: path.to_owned(),
            marked: Marked::new(text, lines, words),
            program,
            mentions: OnceLock::new(),
        }
    }

    fn find_mentions(&self) -> Vec<Mention> {
        let mut found = Vec::new();
        for (number, line) in (1..).zip(self.marked.lines()) {
            let start = found.len();
            self.marked_mentions(line, &mut found);
            for word in self.program.words_read(number) {
                found.extend(self.called(&word));
            }
            if let Some(own) = found.get_mut(start..) {
                own.sort_by_key(|mention| mention.range.start);
            }
        }
        found
    }

    /// The number of the block and its parameters.
    fn marked_mentions(&self, line: &Range<usize>, found: &mut Vec<Mention>) {
        for (range, kind) in self.marked.words_of(line.clone()) {
            let word = self.marked.text.get(range.clone());
            let digits = word.get(1..).unwrap_or_default().trim();
            let (thing, role) = match kind {
                SpanKind::Number => (digits.parse().ok().map(Thing::Block), Role::Sets),
                SpanKind::Variable => {
                    let number: Option<u16> = digits.parse().ok();
                    let after = self.marked.text.get(range.end..line.end).trim_start();
                    let role = if after.starts_with(':') {
                        Role::Sets
                    } else {
                        Role::Uses
                    };
                    (number.map(|number| Thing::Variable(format!("P{number}"))), role)
                }
                _ => continue,
            };
            found.extend(thing.map(|thing| Mention { range, thing, role }));
        }
    }

    /// The block or the cycle that a word leads to.
    fn called(&self, word: &Word) -> Option<Mention> {
        let range = self.marked.bytes(word.span);
        let text = self.marked.text.get(range.clone());
        let after_point = |at: Option<usize>| at.map_or(range.start, |at| range.start + at + 1);
        let (range, thing) = match word.kind {
            WordKind::Jump(condition) => (
                after_point(text.rfind('.'))..range.end,
                Thing::Block(condition.target),
            ),
            WordKind::M(function) => {
                let target = function.target?;
                let start = after_point(text.find('.'));
                let rest = self.marked.text.get(start..range.end);
                (
                    start..start + rest.find('.').unwrap_or(rest.len()),
                    Thing::Block(target),
                )
            }
            WordKind::G(number) if g_function(number)?.part == Part::MakerCycle => {
                (range, Thing::File(format!("Z{number}.900")))
            }
            _ => return None,
        };
        Some(Mention {
            range,
            thing,
            role: Role::Uses,
        })
    }

    /// The comments that stand alone in their lines: what parts a program.
    fn sections(&self) -> Vec<(Range<usize>, String)> {
        let lines = self.marked.lines().iter();
        let alone = lines.filter_map(|line| {
            let mut words = self.marked.words_of(line.clone()).into_iter();
            let (range, kind) = words.next()?;
            let is_alone = kind == SpanKind::Comment && words.next().is_none();
            let title = self
                .marked
                .text
                .get(range.clone())
                .trim_matches(['{', '}', ';', ' ', '\t']);
            (is_alone && !title.is_empty()).then(|| (range, title.to_owned()))
        });
        alone.collect()
    }
}

/// What a word of the table means.
fn explained(row: &Meaning) -> String {
    Markdown::titled(&format!("{}: {}", row.word, row.title))
        .paragraph(row.rule)
        .fact("Unit", row.unit)
        .source(row.source)
        .text()
}

/// The row of a word.
fn meaning(text: &str, kind: SpanKind) -> Option<&'static Meaning> {
    let letter = text.get(..1)?.to_ascii_uppercase();
    let number = text.get(1..).unwrap_or_default().split('.').next()?.parse().ok();
    match (kind, letter.as_str()) {
        (SpanKind::Function, "G") => g_function(number?),
        (SpanKind::Function, _) => m_function(number?),
        _ => {
            let own = meanings().iter().filter(|row| row.part == Part::Address);
            let is_address = matches!(kind, SpanKind::Address | SpanKind::Number | SpanKind::Variable);
            // Letters that are no other address name axes, as X does.
            let mut own = own.filter(|row| is_address && (row.word == letter || row.word == "X"));
            own.clone().find(|row| row.word == letter).or_else(|| own.next())
        }
    }
}

impl Analysis for System900Program {
    fn examine(&self, world: &World, _: &AtomicBool) -> Examined {
        if self.marked.text.text.trim().is_empty() {
            return Examined::default();
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let found = examine(&self.program, &Beside::of(&self.path, world));
        let faults = found.into_iter().map(|found| {
            let name = found.program.name().to_string();
            let fault = found
                .program
                .diagnostic(found.severity, &found.fault, &folder.join(&name));
            match found.program.name() == self.program.name() {
                true => self.marked.placed(fault),
                false => self.marked.placed_elsewhere(fault, name, self.mentions()),
            }
        });
        Examined {
            faults: faults.collect(),
            complete: true,
            ..Examined::default()
        }
    }

    fn hover(&self, at: usize, _: Option<&Examined>) -> Option<Hover> {
        let mention = mention_at(self.mentions(), at);
        let mention = mention.filter(|mention| !matches!(mention.thing, Thing::File(_)));
        let Some(mention) = mention else {
            let (range, kind) = self.marked.word_at(at)?;
            let row = meaning(self.marked.text.get(range.clone()), kind)?;
            return Some(Hover {
                range,
                text: explained(row),
            });
        };
        let lines = |role: Role| {
            let places = mentions_of(self.mentions(), &mention.thing).filter(|other| other.role == role);
            self.marked.line_numbers(places.map(|other| other.range.start))
        };
        let (title, labels) = match &mention.thing {
            Thing::Block(number) => (format!("N{number}: Block"), ["Stands in line", "Jumps in lines"]),
            Thing::Variable(name) => (
                format!("{name}: Parameter"),
                ["Written in lines", "Read in lines"],
            ),
            _ => return None,
        };
        let text = Markdown::titled(&title)
            .fact(labels[0], &lines(Role::Sets))
            .fact(labels[1], &lines(Role::Uses));
        Some(Hover {
            range: mention.range.clone(),
            text: text.text(),
        })
    }

    fn mentions(&self) -> &[Mention] {
        self.mentions.get_or_init(|| self.find_mentions())
    }

    fn elsewhere(&self, thing: &Thing, world: &World) -> Option<Elsewhere> {
        let Thing::File(name) = thing else { return None };
        let path = world.below(self.path.parent()?, name)?;
        world.read(&path).map(|_| Elsewhere::front(path))
    }

    fn symbols(&self) -> Vec<Symbol> {
        let sections = self.sections();
        let end = self.marked.text.text.len();
        let ends: Vec<usize> = sections
            .iter()
            .skip(1)
            .map(|(next, _)| next.start)
            .chain([end])
            .collect();
        let symbols = sections
            .into_iter()
            .zip(ends)
            .map(|((selection, name), end)| Symbol {
                name,
                detail: String::new(),
                kind: SymbolKind::Section,
                range: selection.start..end.max(selection.end),
                selection,
                children: Vec::new(),
            });
        symbols.collect()
    }

    fn folds(&self) -> Vec<Fold> {
        let text = &self.marked.text;
        let folds = self.symbols().into_iter().map(|symbol| {
            let own = text.get(symbol.range.clone()).trim_end();
            Fold {
                first: text.lines.line_of(symbol.range.start),
                last: text.lines.line_of(symbol.range.start + own.len()),
                is_comment: false,
            }
        });
        folds.collect()
    }

    fn completions(&self, at: usize, _: &World) -> Vec<Completion> {
        let text = &self.marked.text;
        let line = text.line_at(at);
        let words = self.marked.words_of(line.clone());
        let in_comment = |(range, kind): &(Range<usize>, SpanKind)| {
            *kind == SpanKind::Comment && range.start < at && at <= range.end
        };
        if words.iter().any(in_comment) {
            return Vec::new();
        }
        let before = text.get(line.start..at);
        let start = before
            .rfind(char::is_whitespace)
            .map_or(line.start, |blank| line.start + blank + 1);
        let single = meanings()
            .iter()
            .filter(|row| !row.word.contains(['-', ' ', '/']));
        let items = single.map(|row| Completion {
            label: row.word.to_owned(),
            detail: row.title.to_owned(),
            documentation: row.rule.to_owned(),
            kind: CompletionKind::Word,
            range: start..at,
            snippet: row.word.to_owned(),
        });
        items.collect()
    }

    fn formatted(&self, _: &World) -> Result<String, String> {
        Ok(self.program.listing())
    }

    fn can_rename(&self, _: &Thing) -> bool {
        false
    }

    fn renamed(&self, _: &Thing, _: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        Err("nothing in these programs has a name of its own".to_owned())
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        self.marked.tokens()
    }
}
