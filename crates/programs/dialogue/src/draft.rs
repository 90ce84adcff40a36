//! What is still open, to be kept and taken up again.

use std::fmt::{self, Display};
use std::str::FromStr;

use bahn_program::CycleFunction;

use crate::Word;
use crate::blocks::block_row;
use crate::dialogue::{Dialogue, Source};
use crate::editor::{Editor, Open};
use crate::entry::{Entry, Place};
use crate::highlight::Highlight;
use crate::typing::{Fresh, Typing};

/// What a draft of DIN/ISO makes: its text is its only word.
const ISO: &str = "ISO";

/// Most words of a draft; more were never entered.
const WORDS_MAX: usize = 10_000;

/// An unfinished block, as plain data. As text it is one line for each word, so that it can be kept anywhere.
///
/// ```
/// # use std::sync::Arc;
/// # use bahn_dialogue::{Draft, Editor, Key, Setting};
/// # use bahn_parameters::{ControlModel, ParameterList};
/// # use bahn_program::Program;
/// # let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc360));
/// # let program = Arc::new(Program::from_bytes("7.H", b"BEGIN PGM 7 MM\nEND PGM 7 MM\n".to_vec()));
/// let mut editor = Editor::new(Arc::clone(&program), setting.clone());
/// for key in [Key::L, Key::X, Key::Digit1, Key::Digit5] {
///     editor.key(key);
/// }
/// let kept = editor.draft().unwrap().to_string();
///
/// let mut again = Editor::new(program, setting);
/// assert!(again.restore(&kept.parse::<Draft>().unwrap()));
/// assert_eq!(again.view(3, 3), editor.view(3, 3));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Draft {
    /// The block at the cursor.
    pub block: u32,
    /// What is being made: `L`, `CYCL DEF 4`, `TCH PROBE 0`; empty where the block at the cursor is changed.
    pub source: String,
    /// A value in the block at the cursor is overwritten, no dialogue is open.
    pub highlighted: bool,
    /// The question: line and field.
    pub question: (usize, usize),
    /// The last line that was asked for.
    pub reached: usize,
    /// The word that is being entered, and what the next digit does with its value: 0 goes on with it, 1 takes its
    /// place, 2 likewise and negative.
    pub typing: Option<(usize, u8)>,
    /// `I` was pressed before an axis.
    pub incremental: bool,
    /// The answers: line, field and word.
    pub words: Vec<(usize, usize, Word)>,
}

impl Editor {
    /// What is open as far as it was entered; none where nothing would be lost.
    pub fn draft(&self) -> Option<Draft> {
        match &self.open {
            Open::Dialogue(dialogue) => Some(self.of_dialogue(dialogue)),
            Open::Highlight(highlight) if highlight.is_changed() => Some(self.of_highlight(highlight)),
            Open::Entry(entry) if entry.is_changed() => Some(self.of_entry(entry)),
            _ => None,
        }
    }

    fn of_dialogue(&self, dialogue: &Dialogue) -> Draft {
        let mut draft = Draft {
            block: self.cursor,
            source: match dialogue.source {
                _ if dialogue.replaces.is_some() => String::new(),
                source => source.name(),
            },
            question: (dialogue.line, dialogue.field),
            reached: dialogue.reached,
            ..Draft::default()
        };
        draft.set_typing(dialogue.typing);
        for (number, line) in dialogue.lines.iter().enumerate() {
            draft.add(number, line);
        }
        draft
    }

    fn of_highlight(&self, highlight: &Highlight) -> Draft {
        let mut draft = Draft {
            block: self.cursor,
            highlighted: true,
            question: highlight.place.unwrap_or_default(),
            ..Draft::default()
        };
        draft.set_typing(highlight.typing);
        draft.add(0, &highlight.line);
        draft
    }

    fn of_entry(&self, entry: &Entry) -> Draft {
        let (question, typing) = match entry.place {
            Place::At(at) => ((at, 0), None),
            Place::Word(word) => ((0, 0), Some((word, 1))),
            Place::Signed(word) => ((0, 0), Some((word, 2))),
        };
        let word = Word {
            incremental: false,
            address: String::new(),
            value: entry.text.clone(),
        };
        Draft {
            block: self.cursor,
            source: ISO.to_owned(),
            highlighted: entry.replaces.is_some(),
            question,
            typing,
            words: vec![(0, 0, word)],
            ..Draft::default()
        }
    }

    fn entry_of_draft(&self, draft: &Draft) -> Option<Open> {
        let (_, _, word) = draft.words.first()?;
        let place = match draft.typing {
            None => Place::At(draft.question.0),
            Some((word, 2)) => Place::Signed(word),
            Some((word, _)) => Place::Word(word),
        };
        let entry = match draft.highlighted {
            true => self.entry_of(draft.block, Place::At(0)).ok()?,
            false if draft.block < self.last() => Entry::new(self.program.language()),
            false => return None,
        };
        let entry = entry.with(word.value.clone(), place)?;
        Some(Open::Entry(Box::new(entry)))
    }

    /// Takes a draft up again; whether it belongs to the program as it is. Where it does not, nothing changes.
    pub fn restore(&mut self, draft: &Draft) -> bool {
        let Some(open) = self.taken_up(draft) else {
            return false;
        };
        self.cursor = draft.block;
        self.soft_row = 0;
        self.open = open;
        true
    }

    fn taken_up(&self, draft: &Draft) -> Option<Open> {
        let (line, field) = draft.question;
        let word = |(_, field, word): &(usize, usize, Word)| (*field, word.clone());
        if self.program.is_protected() || draft.block > self.last() {
            return None;
        }
        if self.is_iso() || draft.source == ISO {
            return (self.is_iso() && draft.source == ISO)
                .then(|| self.entry_of_draft(draft))
                .flatten();
        }
        if draft.highlighted {
            let known = self.line_of(draft.block)?;
            let mut highlight = Highlight::new(draft.block, known, None);
            for index in 0..=highlight.line.fields().len() {
                let words = draft.words.iter().map(word).filter(|(field, _)| *field == index);
                highlight.line.field_mut(index)?.words = words.map(|(_, word)| word).collect();
            }
            let place = Some((line, field));
            highlight.line.word(place)?;
            highlight.place = place;
            highlight.typing = draft.typing();
            return Some(Open::Highlight(Box::new(highlight)));
        }
        let mut dialogue = match draft.source.as_str() {
            "" => Dialogue::of_line(self.line_of(draft.block)?, draft.block, 0, &self.setting)?,
            _ if draft.block >= self.last() => return None,
            source => Dialogue::new(source_of(source)?, &self.setting),
        };
        dialogue.clear();
        for (line, field, word) in &draft.words {
            if !dialogue.answer(*line, *field, word.clone(), &self.setting) {
                return None;
            }
        }
        // The question may be that of a block to which nothing was said yet, but none after the last one asked for.
        if line > draft.reached || !dialogue.reach(draft.reached, &self.setting) {
            return None;
        }
        (dialogue.line, dialogue.field, dialogue.reached) = (line, field, draft.reached);
        dialogue.typing = draft.typing();
        let words = dialogue.current()?.words.len();
        let whole =
            dialogue.typing.word.is_none_or(|word| word < words) && draft.reached < dialogue.lines.len();
        whole.then(|| Open::Dialogue(Box::new(dialogue)))
    }
}

/// What a draft makes.
fn source_of(text: &str) -> Option<Source> {
    let cycle = |prefix: &str, function| {
        let number = text.strip_prefix(prefix)?.parse::<u16>().ok()?;
        Some(Source::Cycle(function, number))
    };
    cycle("CYCL DEF ", CycleFunction::Definition)
        .or_else(|| cycle("TCH PROBE ", CycleFunction::Probe))
        .or_else(|| block_row(text).map(Source::Row))
}

impl Draft {
    fn add(&mut self, number: usize, line: &crate::line::Line) {
        let words = line.words();
        self.words
            .extend(words.map(|((field, _), word)| (number, field, word.clone())));
    }

    fn set_typing(&mut self, typing: Typing) {
        self.typing = typing.word.map(|word| {
            let fresh = match typing.fresh {
                Fresh::No if typing.in_turn => 3,
                Fresh::No => 0,
                Fresh::Yes => 1,
                Fresh::Negative => 2,
            };
            (word, fresh)
        });
        self.incremental = typing.incremental;
    }

    fn typing(&self) -> Typing {
        Typing {
            word: self.typing.map(|(word, _)| word),
            fresh: match self.typing {
                None | Some((_, 0 | 3)) => Fresh::No,
                Some((_, 2)) => Fresh::Negative,
                Some(_) => Fresh::Yes,
            },
            incremental: self.incremental,
            in_turn: matches!(self.typing, Some((_, 3))),
        }
    }
}

impl Display for Draft {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, field) = self.question;
        let typing = match self.typing {
            Some((word, fresh)) => format!("{word} {fresh}"),
            None => "-".to_owned(),
        };
        writeln!(f, "block {}", self.block)?;
        writeln!(f, "source {}", self.source)?;
        writeln!(f, "highlighted {}", u8::from(self.highlighted))?;
        writeln!(f, "question {line} {field} {}", self.reached)?;
        writeln!(f, "typing {typing}")?;
        writeln!(f, "incremental {}", u8::from(self.incremental))?;
        for (line, field, word) in &self.words {
            let incremental = u8::from(word.incremental);
            writeln!(
                f,
                "word {line} {field} {incremental}\t{}\t{}",
                word.address, word.value
            )?;
        }
        Ok(())
    }
}

/// A text that is no draft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoDraft;

impl Display for NoDraft {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("this is no draft of a block")
    }
}

impl std::error::Error for NoDraft {}

impl FromStr for Draft {
    type Err = NoDraft;

    fn from_str(text: &str) -> Result<Draft, NoDraft> {
        let mut draft = Draft::default();
        let mut known = false;
        for line in text.lines() {
            let (name, value) = line.split_once(' ').ok_or(NoDraft)?;
            known |= name == "block";
            draft.set(name, value).ok_or(NoDraft)?;
            if draft.words.len() > WORDS_MAX {
                return Err(NoDraft);
            }
        }
        if known { Ok(draft) } else { Err(NoDraft) }
    }
}

impl Draft {
    /// Takes one line of the text.
    fn set(&mut self, name: &str, value: &str) -> Option<()> {
        let mut numbers = value.split([' ', '\t']);
        let mut number = || numbers.next()?.parse::<usize>().ok();
        match name {
            "block" => self.block = u32::try_from(number()?).ok()?,
            "source" => self.source = value.to_owned(),
            "highlighted" => self.highlighted = number()? == 1,
            "question" => {
                self.question = (number()?, number()?);
                self.reached = number()?;
            }
            "typing" if value == "-" => self.typing = None,
            "typing" => self.typing = Some((number()?, u8::try_from(number()?).ok()?)),
            "incremental" => self.incremental = number()? == 1,
            "word" => {
                let (line, field, incremental) = (number()?, number()?, number()? == 1);
                let mut texts = value.splitn(3, '\t').skip(1);
                let word = Word {
                    incremental,
                    address: texts.next()?.to_owned(),
                    value: texts.next()?.to_owned(),
                };
                self.words.push((line, field, word));
            }
            _ => return None,
        }
        Some(())
    }
}
