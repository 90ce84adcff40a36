//! DIN 66025 programs, `.nc`.

mod marked;
mod words;

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use bahn_din::{Landmark, LandmarkKind, Program, SpanKind};
use bahn_text::Files;

use crate::language::{
    Analysis, Completion, Elsewhere, Examined, Fold, Hover, Mention, Role, Symbol, SymbolKind, Thing, Token,
    mention_at, mentions_of,
};
use crate::markdown::Markdown;
use crate::text::Text;
use crate::world::World;

pub(crate) use marked::{Beside, Marked};

/// A program as the editor has it.
pub(crate) struct DinProgram {
    path: PathBuf,
    text: Arc<Text>,
    program: Arc<Program>,
    marked: Marked,
    mentions: OnceLock<Vec<Mention>>,
}

impl DinProgram {
    pub(crate) fn new(path: &Path, text: Arc<Text>) -> DinProgram {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let program = Arc::new(Program::from_bytes(&name, text.text.as_bytes()));
        let lines = (1..=program.line_count()).map(|number| program.line(number));
        DinProgram {
            path: path.to_owned(),
            marked: Marked::new(text.clone(), lines, bahn_din::words),
            program,
            text,
            mentions: OnceLock::new(),
        }
    }

    fn named(&self, kinds: &[LandmarkKind]) -> Vec<Landmark> {
        let all = self.program.landmarks().into_iter();
        all.filter(|landmark| kinds.contains(&landmark.kind)).collect()
    }

    fn find_mentions(&self) -> Vec<Mention> {
        let subroutines = self.named(&[LandmarkKind::Subroutine]);
        let mut found = Vec::new();
        for line in self.marked.lines() {
            let words = self.marked.words_of(line.clone());
            for (range, kind) in &words {
                let word = self.text.get(range.clone());
                let rest = self.text.get(range.end..line.end);
                let after = rest.trim_start();
                let blanks = rest.len() - after.len();
                match kind {
                    SpanKind::Variable => found.push(Mention {
                        range: range.clone(),
                        thing: Thing::Variable(word.to_ascii_uppercase()),
                        role: if after.starts_with('=') {
                            Role::Sets
                        } else {
                            Role::Uses
                        },
                    }),
                    SpanKind::Head => {
                        let name = word.trim_start_matches('%').trim_start();
                        let subroutine = name
                            .strip_prefix(['L', 'l'])
                            .filter(|rest| rest.starts_with([' ', '\t']));
                        if let Some(name) = subroutine.map(str::trim) {
                            let start = range.start + word.rfind(name).unwrap_or_default();
                            found.push(subroutine_at(start, name, Role::Sets));
                        }
                    }
                    SpanKind::Address if matches!(word, "L" | "l" | "LL" | "ll") => {
                        let name = first_word(after);
                        let start = range.end + blanks;
                        let is_here = subroutines.iter().any(|landmark| landmark.name == name);
                        if is_here {
                            found.push(subroutine_at(start, name, Role::Uses));
                        } else if !name.is_empty() {
                            found.push(Mention {
                                range: start..start + name.len(),
                                thing: Thing::File(name.to_owned()),
                                role: Role::Uses,
                            });
                        }
                    }
                    _ => {}
                }
            }
        }
        found
    }
}

fn subroutine_at(start: usize, name: &str, role: Role) -> Mention {
    Mention {
        range: start..start + name.len(),
        thing: Thing::Subroutine(name.to_owned()),
        role,
    }
}

/// The value of a variable or a parameter after a run; nothing of one whose number is calculated.
fn value(name: &str, examined: &Examined) -> String {
    let digits = name
        .strip_prefix('P')
        .map(|digits| digits.trim_start_matches('0'));
    let name = match digits {
        Some("") => "P0".to_owned(),
        Some(digits) => format!("P{digits}"),
        None => name.to_owned(),
    };
    let ended = if examined.complete {
        ""
    } else {
        " (the run was broken off)"
    };
    match examined.named.get(&name) {
        Some(Some(value)) => format!("{value}{ended}"),
        Some(None) => format!("not known: it follows from what only the channel knows{ended}"),
        None => String::new(),
    }
}

fn first_word(text: &str) -> &str {
    text.split([' ', '\t', ';', '(']).next().unwrap_or_default()
}

impl Analysis for DinProgram {
    fn examine(&self, world: &World, interrupt: &AtomicBool) -> Examined {
        if self.text.text.trim().is_empty() {
            return Examined::default();
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let beside: Arc<dyn Files> = Arc::new(Beside::of(&self.path, world));
        let examined = bahn_din::examine(&self.program, &beside, interrupt);
        let faults = examined.found.into_iter().map(|found| {
            let name = found.program.name().to_string();
            let fault = found.fault.diagnostic(&found.program, &folder.join(&name));
            match found.program.name() == self.program.name() {
                true => self.marked.placed(fault),
                false => self.marked.placed_elsewhere(fault, name, self.mentions()),
            }
        });
        Examined {
            faults: faults.collect(),
            complete: examined.complete,
            named: examined.values,
            ..Examined::default()
        }
    }

    fn hover_waits(&self, at: usize) -> bool {
        let mention = mention_at(self.mentions(), at);
        mention.is_some_and(|mention| matches!(mention.thing, Thing::Variable(_)))
    }

    fn hover(&self, at: usize, examined: Option<&Examined>) -> Option<Hover> {
        if let Some(mention) = mention_at(self.mentions(), at) {
            let lines = |role: Role| {
                let places = mentions_of(self.mentions(), &mention.thing).filter(|other| other.role == role);
                self.marked.line_numbers(places.map(|other| other.range.start))
            };
            let name = self.text.get(mention.range.clone());
            let (title, rule) = match &mention.thing {
                Thing::Variable(name) => words::variable(name),
                Thing::Subroutine(_) => ("Subroutine", ""),
                _ => ("File with a subroutine", ""),
            };
            let value = match (&mention.thing, examined) {
                (Thing::Variable(name), Some(examined)) => value(name, examined),
                _ => String::new(),
            };
            let text = Markdown::titled(&format!("{name}: {title}"))
                .paragraph(rule)
                .fact("At the end of a run", &value)
                .fact("Set in lines", &lines(Role::Sets))
                .fact("Used in lines", &lines(Role::Uses));
            return Some(Hover {
                range: mention.range.clone(),
                text: text.text(),
            });
        }
        let (range, kind) = self.marked.word_at(at)?;
        Some(Hover {
            text: words::meaning(self.text.get(range.clone()), kind)?,
            range,
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
        let heads = self.named(&[LandmarkKind::Program, LandmarkKind::Subroutine]);
        let end = self.text.text.len();
        let ends = heads
            .iter()
            .skip(1)
            .map(|next| self.marked.line(next.line).start)
            .chain([end]);
        heads
            .iter()
            .zip(ends)
            .map(|(head, end)| {
                let line = self.marked.line(head.line);
                let (name, kind) = match head.kind {
                    LandmarkKind::Subroutine => (format!("%L {}", head.name), SymbolKind::Label),
                    _ => (format!("%{}", head.name), SymbolKind::Program),
                };
                Symbol {
                    name,
                    detail: String::new(),
                    kind,
                    range: line.start..end.max(line.end),
                    selection: line,
                    children: Vec::new(),
                }
            })
            .collect()
    }

    fn folds(&self) -> Vec<Fold> {
        let symbols = self.symbols().into_iter();
        let folds = symbols.map(|symbol| {
            let text = self.text.get(symbol.range.clone()).trim_end();
            Fold {
                first: self.text.lines.line_of(symbol.range.start),
                last: self.text.lines.line_of(symbol.range.start + text.len()),
                is_comment: false,
            }
        });
        folds.collect()
    }

    fn completions(&self, at: usize, world: &World) -> Vec<Completion> {
        let line = self.text.line_at(at);
        let before = self.text.get(line.start..at);
        if before.contains([';', '(']) {
            return Vec::new();
        }
        let start = before
            .char_indices()
            .rev()
            .take_while(|(_, c)| !c.is_whitespace() && *c != '=' && *c != '[')
            .last()
            .map_or(at, |(start, _)| line.start + start);
        let names = |wanted: fn(&Thing) -> Option<&str>| {
            let mut names: Vec<&str> = self
                .mentions()
                .iter()
                .filter_map(|mention| wanted(&mention.thing))
                .collect();
            names.sort_unstable();
            names.dedup();
            names
        };
        let variables = names(|thing| match thing {
            Thing::Variable(name) => Some(name),
            _ => None,
        });
        let subroutines = names(|thing| match thing {
            Thing::Subroutine(name) => Some(name),
            _ => None,
        });
        let calls = self.text.get(line.start..start).trim_end();
        if calls == "L" || calls.ends_with(" L") {
            let folder = self
                .path
                .parent()
                .map(|folder| world.files.names(folder))
                .unwrap_or_default();
            let files = folder
                .into_iter()
                .filter(|name| name.to_ascii_lowercase().ends_with(".nc"));
            let all = subroutines.into_iter().map(str::to_owned).chain(files);
            return all
                .map(|name| words::item(start..at, name.clone(), String::new(), name))
                .collect();
        }
        let mut all = words::completions(start..at);
        all.extend(
            variables
                .into_iter()
                .map(|name| words::item(start..at, name.into(), "variable".into(), name.into())),
        );
        all
    }

    fn formatted(&self, _: &World) -> Result<String, String> {
        Ok(self.program.listing())
    }

    fn can_rename(&self, thing: &Thing) -> bool {
        matches!(thing, Thing::Subroutine(_))
    }

    fn renamed(&self, thing: &Thing, new: &str, _: &World) -> Result<Vec<(Range<usize>, String)>, String> {
        let is_name = !new.is_empty()
            && new
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '-'));
        if !is_name {
            return Err("a subroutine is named by letters and digits".to_owned());
        }
        if self.program.subroutine(new).is_some() {
            return Err(format!("subroutine {new} is there already"));
        }
        let places = mentions_of(self.mentions(), thing);
        Ok(places
            .map(|place| (place.range.clone(), new.to_owned()))
            .collect())
    }

    fn tokens(&self) -> Vec<(Range<usize>, Token)> {
        self.marked.tokens()
    }
}
