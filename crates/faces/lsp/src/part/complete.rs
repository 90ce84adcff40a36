//! What may be written next in a program.

use std::collections::BTreeSet;
use std::ops::Range;

use bahn_dialogue::{TemplatePart, Tongue, cycle_template};
use bahn_parameters::conformance::{Kind, find as registered};
use bahn_program::{CYCLES, CycleFunction};

use super::PartProgram;
use super::hover::{cycle_named, m_function};
use super::words::{self, Part};
use crate::language::{Analysis, Completion, CompletionKind, Mention, Thing};
use crate::world::World;

pub(super) fn completions(program: &PartProgram, at: usize, world: &World) -> Vec<Completion> {
    let line = program.text.line_at(at);
    let before = program.text.get(line.start..at);
    if before.contains(';') {
        return Vec::new();
    }
    let code_at = line.start + number_length(before);
    let token_at = before
        .char_indices()
        .rev()
        .take_while(|(_, c)| !c.is_whitespace() && !matches!(c, '/' | '='))
        .last()
        .map_or(at, |(start, _)| line.start + start);
    let writer = Writer {
        program,
        // The rest of a word is replaced, too.
        token: token_at..at + word_rest(program.text.get(at..line.end)),
        code: code_at.min(at)..at,
    };
    let token = program.capitals(&(token_at..at));
    let words_before = program.capitals(&(code_at.min(token_at)..token_at));
    let is_first = words_before.is_empty();
    match (words_before.as_str(), token.as_str()) {
        (front, _)
            if front.ends_with("LBL") || front.contains(" CONTOUR LABEL") || front.ends_with("LABEL") =>
        {
            writer.things(CompletionKind::Label, |thing| match thing {
                Thing::Label(number) => Some(number.to_string()),
                _ => None,
            })
        }
        (front, _) if front.ends_with("PGM") && !front.starts_with("BEGIN") && !front.starts_with("END") => {
            writer.files(world)
        }
        ("TOOL CALL", _) => writer.things(CompletionKind::Value, |thing| match thing {
            Thing::Tool(number) => Some(number.to_string()),
            _ => None,
        }),
        (_, token) if is_letter_and_digits(token, "M") && (!is_first || token.len() > 1) => {
            writer.m_functions()
        }
        (_, token) if last_q(token).is_some() => writer.parameters(token),
        (_, token)
            if program.is_iso() && (token.starts_with('G') || token.starts_with('D') || token.is_empty()) =>
        {
            writer.codes()
        }
        (front, _) if is_first || is_opening(program, front) => {
            let mut all = writer.functions();
            all.extend(writer.cycles());
            if is_first {
                all.extend(writer.m_functions());
            }
            all
        }
        _ => writer.addresses(),
    }
}

/// The length of a block number with the blanks around it.
fn number_length(line: &str) -> usize {
    let trimmed = line.trim_start();
    let after_n = trimmed
        .strip_prefix(['N', 'n'])
        .filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    let digits = after_n.unwrap_or(trimmed);
    let after = digits.trim_start_matches(|c: char| c.is_ascii_digit());
    let is_number = after.len() < digits.len() && after.starts_with(char::is_whitespace);
    let rest = if is_number { after } else { trimmed };
    let rest = rest.trim_start();
    line.len() - rest.strip_prefix('/').map_or(rest, str::trim_start).len()
}

/// The bytes of the word that goes on after the cursor.
fn word_rest(text: &str) -> usize {
    text.chars()
        .take_while(|c| c.is_alphanumeric())
        .map(char::len_utf8)
        .sum()
}

fn is_letter_and_digits(token: &str, letter: &str) -> bool {
    token
        .strip_prefix(letter)
        .is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()))
}

/// Where a Q parameter begins that is being written, `X+Q1`.
fn last_q(token: &str) -> Option<usize> {
    let at = token.rfind('Q')?;
    let digits = token.get(at + 1..)?;
    digits.chars().all(|c| c.is_ascii_digit()).then_some(at)
}

/// Whether words may go on to a function: `CYCL`, `CALL`, `CYCL DEF`.
fn is_opening(program: &PartProgram, front: &str) -> bool {
    let wanted = format!("{front} ");
    let functions = words::of_language(program.is_iso()).filter(|word| word.part == Part::Function);
    front == "CYCL DEF"
        || front == "TCH PROBE"
        || functions.into_iter().any(|word| word.word.starts_with(&wanted))
}

struct Writer<'a> {
    program: &'a PartProgram,
    /// The word at the cursor.
    token: Range<usize>,
    /// The block up to the cursor, without its number.
    code: Range<usize>,
}

impl Writer<'_> {
    /// Things of one kind that the program names.
    fn things(&self, kind: CompletionKind, name: impl Fn(&Thing) -> Option<String>) -> Vec<Completion> {
        let mut names = BTreeSet::new();
        // What stands at the cursor is only being written.
        let others = |mention: &&Mention| mention.range.start != self.token.start;
        for mention in self.program.mentions().iter().filter(others) {
            if let Some(name) = name(&mention.thing) {
                names.insert((name.len(), name));
            }
        }
        let items = names
            .into_iter()
            .map(|(_, name)| self.item(&self.token, name.clone(), name, kind));
        items.collect()
    }

    fn parameters(&self, token: &str) -> Vec<Completion> {
        let at = self.token.start + last_q(token).unwrap_or_default();
        let writer = Writer {
            program: self.program,
            token: at..self.token.end,
            code: self.code.clone(),
        };
        writer.things(CompletionKind::Parameter, |thing| match thing {
            Thing::Q(number) => Some(format!("Q{number}")),
            _ => None,
        })
    }

    fn files(&self, world: &World) -> Vec<Completion> {
        let Some(folder) = self.program.path.parent() else {
            return Vec::new();
        };
        let own = self
            .program
            .path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy();
        let names = world.files.names(folder);
        let programs = names
            .iter()
            .filter(|name| bahn_program::language_of(name).is_some() && **name != own);
        programs
            .filter_map(|name| name.rsplit_once('.'))
            .map(|(stem, ending)| {
                let mut item = self.item(
                    &self.token,
                    stem.to_owned(),
                    stem.to_owned(),
                    CompletionKind::File,
                );
                item.detail = format!("{stem}.{ending}");
                item
            })
            .collect()
    }

    fn m_functions(&self) -> Vec<Completion> {
        let functions = words::of_language(self.program.is_iso()).filter(|word| word.part == Part::M);
        let known =
            functions.filter(|word| registered(self.program.model, Kind::MFunction, word.word).is_some());
        known
            .map(|word| {
                let mut item = self.item(
                    &self.token,
                    word.word.into(),
                    word.word.into(),
                    CompletionKind::Function,
                );
                item.detail = word.title.to_owned();
                item.documentation = m_function(self.program, &word.word[1..]).unwrap_or_default();
                item
            })
            .collect()
    }

    /// Functions that open a block.
    fn functions(&self) -> Vec<Completion> {
        let all = words::of_language(self.program.is_iso()).filter(|word| word.part == Part::Function);
        all.filter(|word| !word.snippet.is_empty())
            .map(|word| {
                let mut item = self.item(
                    &self.code,
                    word.word.into(),
                    word.snippet.into(),
                    CompletionKind::Word,
                );
                item.detail = word.title.to_owned();
                item.documentation = word.rule.to_owned();
                item
            })
            .collect()
    }

    /// Cycles with all of their blocks and prompts.
    fn cycles(&self) -> Vec<Completion> {
        let known = CYCLES.iter().filter_map(|cycle| {
            let word = match cycle.function {
                CycleFunction::Definition => "CYCL DEF",
                CycleFunction::Probe => "TCH PROBE",
            };
            let name = format!("{word} {}", cycle.number);
            registered(self.program.model, Kind::Cycle, &name)?;
            let snippet = cycle_snippet(&cycle_template(cycle.function, cycle.number));
            let mut item = self.item(
                &self.code,
                format!("{name} {}", cycle.name),
                snippet,
                CompletionKind::Cycle,
            );
            item.detail = cycle.name.to_owned();
            Some(item)
        });
        known.collect()
    }

    /// G and D functions; cycles ask for their P words.
    fn codes(&self) -> Vec<Completion> {
        let all = words::of_language(true).filter(|word| !matches!(word.part, Part::Address | Part::M));
        all.map(|word| {
            let cycle = (word.part == Part::Cycle)
                .then(|| cycle_named(word.title))
                .flatten();
            let (title, snippet) = match cycle {
                Some((function, number)) => {
                    let template = cycle_template(function, number);
                    let name = bahn_program::cycle(function, number).map_or("", |cycle| cycle.name);
                    (name, iso_snippet(word.word, &template))
                }
                None if word.part == Part::Calculation => {
                    let plain = words::find(false, Part::Function, word.title);
                    (plain.map_or("", |plain| plain.title), word.word.to_owned())
                }
                None if word.snippet.is_empty() => (word.title, word.word.to_owned()),
                None => (word.title, word.snippet.to_owned()),
            };
            let kind = if cycle.is_some() {
                CompletionKind::Cycle
            } else {
                CompletionKind::Word
            };
            let mut item = self.item(&self.token, word.word.to_owned(), snippet, kind);
            item.detail = title.to_owned();
            item.documentation = word.rule.to_owned();
            item
        })
        .collect()
    }

    /// Words after the function.
    fn addresses(&self) -> Vec<Completion> {
        let all = words::of_language(self.program.is_iso()).filter(|word| word.part == Part::Address);
        let mut all: Vec<Completion> = all
            .filter(|word| !word.word.ends_with(" ADDRESS"))
            .map(|word| {
                let snippet = match word.snippet {
                    "" => format!("{}$0", word.word),
                    snippet => snippet.to_owned(),
                };
                let mut item = self.item(&self.token, word.word.into(), snippet, CompletionKind::Word);
                item.detail = word.title.to_owned();
                item.documentation = word.rule.to_owned();
                item
            })
            .collect();
        all.extend(self.m_functions());
        all
    }

    fn item(&self, range: &Range<usize>, label: String, snippet: String, kind: CompletionKind) -> Completion {
        Completion {
            label,
            detail: String::new(),
            documentation: String::new(),
            kind,
            range: range.clone(),
            snippet,
        }
    }
}

/// A prompt as the proposal of a place.
fn place(number: usize, prompt: Option<&bahn_dialogue::Prompt>) -> String {
    let text = prompt.map_or("value", |prompt| prompt.text(Tongue::English));
    let text = text.replace('\\', "\\\\").replace('$', "\\$").replace('}', "\\}");
    format!("${{{number}:{text}}}")
}

/// The blocks of a cycle; what may be missing is.
fn cycle_snippet(template: &[Vec<TemplatePart>]) -> String {
    let mut number = 0;
    let mut blocks = Vec::new();
    for parts in template {
        let mut block = String::new();
        let mut text: &str = "";
        for part in parts {
            match part {
                TemplatePart::Text(own) => {
                    block += text;
                    text = own;
                }
                TemplatePart::Ask { prompt, optional } => {
                    // The head of a block stays, whatever may be missing after it.
                    let is_head = block.is_empty();
                    if !*optional {
                        number += 1;
                        block += text;
                        block += &place(number, *prompt);
                    } else if is_head {
                        block += text;
                    }
                    text = "";
                }
            }
        }
        block += text;
        blocks.push(block);
    }
    blocks.join("\n")
}

/// `G83 P01 ... P02 ...`: what the blocks ask for, in their order, without the sense of rotation.
fn iso_snippet(code: &str, template: &[Vec<TemplatePart>]) -> String {
    let prompts = template.iter().flatten().filter_map(|part| match part {
        TemplatePart::Ask {
            prompt,
            optional: false,
        } => Some(*prompt),
        _ => None,
    });
    let asked: Vec<_> = prompts
        .filter(|prompt| prompt.is_none_or(|prompt| prompt.id() != "cycle DR"))
        .enumerate()
        .map(|(index, prompt)| format!(" P{:02} {}", index + 1, place(index + 1, prompt)))
        .collect();
    let by_parameters = !matches!(code, "G04" | "G28" | "G36" | "G54" | "G72" | "G73");
    match by_parameters {
        true => format!("{code}{}", asked.concat()),
        false => code.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn block_numbers_stand_before_the_code() {
        for (line, length) in [
            ("12 L X", 3),
            ("  N10 G", 6),
            ("L X", 0),
            ("/ 12 L", 2),
            ("12 / L", 5),
            ("12", 0),
            ("Nx", 0),
        ] {
            assert_eq!(number_length(line), length, "{line}");
        }
    }

    #[test]
    fn snippets_hold_all_blocks_and_prompts() {
        let pecking = cycle_snippet(&cycle_template(CycleFunction::Definition, 1));
        let lines: Vec<&str> = pecking.lines().collect();
        assert_eq!(lines.len(), 6);
        assert_eq!(lines[0], "CYCL DEF 1.0 PECKING");
        assert_eq!(lines[1], "CYCL DEF 1.1 SET UP ${1:SETUP CLEARANCE?}");
        assert!(lines[5].starts_with("CYCL DEF 1.5 F${5:"), "{pecking}");
        let iso = iso_snippet("G83", &cycle_template(CycleFunction::Definition, 1));
        assert!(
            iso.starts_with("G83 P01 ${1:SETUP CLEARANCE?} P02 ") && iso.contains(" P05 "),
            "{iso}"
        );
    }
}
