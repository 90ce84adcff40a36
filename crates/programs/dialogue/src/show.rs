//! What the editor shows of its state.

use bahn_program::{Block, Operation, Program};

use crate::cycles::PARAMETER;
use crate::dialogue::Dialogue;
use crate::editor::{Editor, Open};
use crate::entry::Entry;
use crate::field::Field;
use crate::highlight::Highlight;
use crate::line::{Line, WordPlace, written};
use crate::prompt::text_of;
use crate::reading::line_of_block;
use crate::soft_keys::ROW;
use crate::typing::Typing;
use crate::view::{List, Question, Row, ShownWord, View};

impl Editor {
    /// What is to be shown, with so many blocks before and after the cursor.
    pub fn view(&self, before: u32, after: u32) -> View {
        let (words, rows) = match &self.open {
            Open::Dialogue(dialogue) => self.with_dialogue(dialogue, before, after),
            Open::Highlight(highlight) => {
                let words = self.words(&highlight.line, Some(highlight.place));
                (words, self.rows(before, after, Some(highlight)))
            }
            Open::Entry(entry) => self.with_entry(entry, before, after),
            _ => {
                let line = self.line_of(self.cursor).filter(|_| !self.is_iso());
                let words = line.map_or_else(Vec::new, |line| self.words(&line, None));
                (words, self.rows(before, after, None))
            }
        };
        let keys = self.soft_keys();
        let shown = keys.chunks(ROW).nth(self.soft_row).unwrap_or_default();
        let mut soft_keys: [String; ROW] = Default::default();
        for (key, (label, _)) in soft_keys.iter_mut().zip(shown) {
            key.clone_from(label);
        }
        View {
            rows,
            words,
            question: self.question(),
            list: self.list(),
            message: self.message,
            soft_keys,
            soft_row: (self.soft_row, keys.len().div_ceil(ROW)),
        }
    }

    fn with_dialogue(&self, dialogue: &Dialogue, before: u32, after: u32) -> (Vec<ShownWord>, Vec<Row>) {
        let mut rows = self.rows(before, after, None);
        let current = dialogue.lines.get(dialogue.line);
        let at = dialogue
            .current()
            .and_then(|field| field.words.len().checked_sub(1));
        let place = at.map(|last| (dialogue.field, dialogue.typing.word.unwrap_or(last)));
        let words = current.map_or_else(Vec::new, |line| self.words(line, place.map(Some)));
        let mut open: Vec<Row> = dialogue
            .lines
            .iter()
            .take(dialogue.reached + 1)
            .enumerate()
            .map(|(index, line)| Row {
                number: dialogue.replaces,
                label: dialogue
                    .replaces
                    .map_or_else(String::new, |block| self.program.shown_number(block)),
                text: self.shown(&line.text()),
                current: index == dialogue.line,
                marked: false,
            })
            .collect();
        if let Some(position) = rows.iter().position(|row| row.current) {
            for row in &mut rows {
                row.current = false;
            }
            match dialogue.replaces {
                Some(_) => rows.splice(position..=position, open),
                None => rows.splice(position + 1..position + 1, std::mem::take(&mut open)),
            };
        }
        (words, rows)
    }

    fn with_entry(&self, entry: &Entry, before: u32, after: u32) -> (Vec<ShownWord>, Vec<Row>) {
        let mut rows = self.rows(before, after, None);
        let text = self.shown(&entry.text);
        if let Some(position) = rows.iter().position(|row| row.current) {
            match (entry.replaces, rows.get_mut(position)) {
                (Some(_), Some(row)) => row.text = text,
                (_, row) => {
                    if let Some(row) = row {
                        row.current = false;
                    }
                    let new = Row {
                        number: None,
                        label: String::new(),
                        text,
                        current: true,
                        marked: false,
                    };
                    rows.insert(position + 1, new);
                }
            }
        }
        let highlighted = entry.current().map(|(at, _)| at);
        let mut shown = 0;
        let mut words: Vec<_> = (0..)
            .zip(entry.words())
            .map(|(at, word)| {
                let from = std::mem::replace(&mut shown, word.span.end);
                ShownWord {
                    text: self.shown(entry.text.get(from..word.span.end).unwrap_or_default()),
                    highlighted: highlighted == Some(at),
                }
            })
            .collect();
        // A blank after the last word, before the next one.
        if let Some(rest) = entry.text.get(shown..).filter(|rest| !rest.is_empty()) {
            words.push(ShownWord {
                text: rest.to_owned(),
                highlighted: false,
            });
        }
        (words, rows)
    }

    fn rows(&self, before: u32, after: u32, highlight: Option<&Highlight>) -> Vec<Row> {
        let first = self.cursor.saturating_sub(before);
        let last = self.cursor.saturating_add(after).min(self.last());
        let marked = self.marked().unwrap_or(0..0);
        let chunks = first / Program::CHUNK_SIZE..=last / Program::CHUNK_SIZE;
        let mut rows = Vec::new();
        for chunk in chunks.map(|chunk| self.program.decode(chunk)) {
            for (number, block) in (chunk.first_block..).zip(&chunk.blocks) {
                if !(first..=last).contains(&number) {
                    continue;
                }
                let text = match highlight.filter(|highlight| highlight.block == number) {
                    Some(highlight) => highlight.line.text(),
                    None => self.block_shown(block),
                };
                rows.push(Row {
                    number: Some(number),
                    label: self.program.shown_number(number),
                    text: self.shown(&text),
                    current: number == self.cursor,
                    marked: marked.contains(&number),
                });
            }
        }
        rows
    }

    /// A block as the screen shows it: cycles as the manual prints them.
    pub(crate) fn block_shown(&self, block: &Block) -> String {
        let language = self.program.language();
        let line = match block.operation {
            Operation::Cycle(_) | Operation::Probe(_) => line_of_block(block, language),
            _ => None,
        };
        line.map_or_else(|| written(block, language), |line| line.text())
    }

    /// The words of a line; the place is that of the highlighted one.
    fn words(&self, line: &Line, place: Option<WordPlace>) -> Vec<ShownWord> {
        let parts = line.parts().into_iter();
        parts
            .map(|(at, text)| ShownWord {
                text: self.shown(&text),
                highlighted: place == Some(at),
            })
            .collect()
    }

    /// A number that is being entered, with point or comma.
    fn shown(&self, text: &str) -> String {
        match self.setting.decimal_comma {
            true => with_comma(text),
            false => text.to_owned(),
        }
    }

    /// The open question, which [`Editor::view`] has, too.
    pub fn question(&self) -> Option<Question> {
        let tongue = self.setting.tongue;
        let (id, entered) = match &self.open {
            Open::Nothing => return None,
            Open::Highlight(highlight) => {
                let (_, field) = self.asked()?;
                let word = highlight.line.word(highlight.place)?;
                let word = field.written(word);
                (self.prompt_of(field), self.entered(&word, highlight.typing))
            }
            Open::Dialogue(dialogue) => {
                let (_, field) = self.asked()?;
                let words = field.text();
                (
                    self.prompt_of(field),
                    self.entered(words.trim_start(), dialogue.typing),
                )
            }
            Open::Menu(menu) => (menu.prompt(), menu.typed.clone()),
            Open::Entry(entry) => {
                let word = entry
                    .current_word()
                    .map(|(address, value)| format!("{address}{value}"));
                (self.iso_prompt(entry), self.shown(&word.unwrap_or_default()))
            }
            Open::Goto(digits) => ("goto", digits.clone()),
            Open::Find(text) => ("find", text.clone()),
        };
        Some(Question {
            id,
            about: self.about(),
            prompt: self
                .builder_text()
                .unwrap_or_else(|| text_of(id, tongue))
                .to_owned(),
            entered,
        })
    }

    /// The line and the field whose words are asked for: of a dialogue, or where a word is highlighted, as the dialogue
    /// would ask for it.
    fn asked(&self) -> Option<(&Line, &Field)> {
        let (line, field) = match &self.open {
            Open::Dialogue(dialogue) => (dialogue.lines.get(dialogue.line)?, dialogue.field),
            Open::Highlight(highlight) => (&highlight.line, highlight.place?.0),
            _ => return None,
        };
        Some((line, line.field(field)?))
    }

    /// What was entered, and `I` where it waits for its axis.
    fn entered(&self, words: &str, typing: Typing) -> String {
        let words = self.shown(words);
        match typing.incremental {
            false => words,
            true if words.is_empty() => "I".to_owned(),
            true => format!("{words} I"),
        }
    }

    /// The prompt of a field. That for the feed does not always offer F MAX [003:2156].
    fn prompt_of(&self, field: &Field) -> &'static str {
        match field.slot.prompt {
            "feed_max" if self.setting.rapid() != "MAX" => "feed",
            prompt => prompt,
        }
    }

    /// The machine builder's text for the parameter of his cycle that is asked for.
    fn builder_text(&self) -> Option<&str> {
        let (line, field) = self.asked()?;
        if field.slot.prompt != PARAMETER {
            return None;
        }
        let head = line.head().strip_prefix("CYCL DEF ")?;
        let cycle = self
            .setting
            .builder_cycle(head.split('.').next()?.parse().ok()?)?;
        let number: u16 = field
            .glue
            .trim()
            .strip_prefix('Q')?
            .strip_suffix('=')?
            .parse()
            .ok()?;
        let parameter = cycle.parameters.iter().find(|(of, _)| *of == number)?;
        Some(parameter.1.as_str()).filter(|text| !text.is_empty())
    }

    /// What is being made.
    fn about(&self) -> String {
        match &self.open {
            Open::Dialogue(dialogue) => match dialogue.replaces {
                Some(_) => dialogue
                    .lines
                    .first()
                    .map_or_else(String::new, |line| line.head().to_owned()),
                None => dialogue.source.name(),
            },
            Open::Highlight(highlight) => highlight.line.head().to_owned(),
            Open::Entry(_) => self.program.language().name().to_owned(),
            _ => String::new(),
        }
    }

    fn list(&self) -> Option<List> {
        let Open::Menu(menu) = &self.open else { return None };
        Some(List {
            lines: menu.items.iter().map(|item| item.text.clone()).collect(),
            at: menu.at,
        })
    }
}

/// Points between digits as commas; the number of a cycle block keeps its point.
fn with_comma(text: &str) -> String {
    let (head, words) =
        match text.starts_with("CYCL DEF") || text.starts_with("TCH PROBE") || text.starts_with("BLK FORM") {
            true => text.split_at(text.match_indices(' ').nth(2).map_or(text.len(), |(at, _)| at)),
            false => text.split_at(0),
        };
    let mut shown = head.to_owned();
    let bytes = words.as_bytes();
    for (at, character) in words.char_indices() {
        let digit = |index: Option<usize>| {
            index
                .and_then(|index| bytes.get(index))
                .is_some_and(u8::is_ascii_digit)
        };
        let decimal = character == '.' && digit(at.checked_sub(1));
        shown.push(if decimal { ',' } else { character });
    }
    shown
}
