//! One block as the dialogue sees it: a head and fields.

use bahn_program::{Block, FormatOptions, Language, Sign};

use crate::blocks::block_row;
use crate::field::{Ask, Field, Need, Slot, Word};
use crate::{Key, Setting};

/// A block with its fields.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    /// The block begins with `/`: an optional block.
    skip: bool,
    head: String,
    fields: Vec<Field>,
    /// The comment after the block, the field after all others.
    comment: Field,
}

/// What stands after a block of any kind. It is never asked for, but can be entered.
const COMMENT: Slot = Slot {
    glue: " ; ",
    address: "",
    ask: Ask::Text,
    prompt: "comment",
    need: Need::Unasked,
    sign: Sign::Signed,
    of: "",
};

/// A field of a line and a word in it; the head of the block without.
pub(crate) type WordPlace = Option<(usize, usize)>;

impl Line {
    pub(crate) fn new(head: &str, fields: Vec<Field>) -> Line {
        Line {
            skip: false,
            head: head.to_owned(),
            fields,
            comment: Field::new(COMMENT),
        }
    }

    /// The lines of a block of the table.
    pub(crate) fn of_row(id: &str) -> Vec<Line> {
        let lines = block_row(id).map_or(&[][..], |row| row.lines);
        lines
            .iter()
            .map(|line| {
                let fields = line.slots.iter().copied().map(Field::new);
                Line::new(line.head, fields.collect())
            })
            .collect()
    }

    /// Reads head and words; whether that is all there is.
    pub(crate) fn read(&mut self, text: &str) -> bool {
        if self.fields.is_empty() {
            // The names of cycles are decoration.
            self.head = text.to_owned();
            return true;
        }
        let Some(mut rest) = text.strip_prefix(self.head.as_str()) else {
            return false;
        };
        for field in &mut self.fields {
            match field.read(rest) {
                Some(length) => rest = rest.get(length..).unwrap_or_default(),
                None if field.slot.need == Need::Required => return false,
                None => {}
            }
        }
        rest.is_empty()
    }

    /// What the block does and nothing else, as listings show it; none if it cannot be read.
    pub(crate) fn canonical(&self, language: &dyn Language) -> Option<String> {
        let read = language.parse_block(&self.bare_text());
        read.faults.is_empty().then(|| written(&read.block, language))
    }

    /// The same words, optional and with the comment as a block is.
    pub(crate) fn like(mut self, block: &Block) -> Line {
        self.skip = block.skip;
        let comment = block.comment.iter().map(|text| Word {
            value: text.to_string(),
            ..Word::default()
        });
        self.comment.words = comment.collect();
        self
    }

    /// Makes the block optional, or not so any more.
    pub(crate) fn toggle_skip(&mut self) {
        self.skip = !self.skip;
    }

    pub(crate) fn head(&self) -> &str {
        &self.head
    }

    pub(crate) fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// All fields and the comment.
    fn all_fields(&self) -> impl Iterator<Item = &Field> {
        self.fields.iter().chain(std::iter::once(&self.comment))
    }

    /// Where the comment stands among the fields; a line that is itself a comment has none.
    pub(crate) fn comment_field(&self) -> Option<usize> {
        let is_comment = self.is_text() && self.bare_text().trim_start().starts_with(';');
        (!is_comment).then_some(self.fields.len())
    }

    /// All words with their places, those of the comment last.
    pub(crate) fn words(&self) -> impl Iterator<Item = ((usize, usize), &Word)> {
        let fields = self.all_fields().enumerate();
        fields.flat_map(|(field, it)| {
            let words = it.words.iter().enumerate();
            words.map(move |(number, word)| ((field, number), word))
        })
    }

    pub(crate) fn field(&self, index: usize) -> Option<&Field> {
        self.all_fields().nth(index)
    }

    pub(crate) fn field_mut(&mut self, index: usize) -> Option<&mut Field> {
        let comment = std::iter::once(&mut self.comment);
        self.fields.iter_mut().chain(comment).nth(index)
    }

    /// Head and words, without `/` and comment.
    pub(crate) fn bare_text(&self) -> String {
        let words = self.fields.iter().map(Field::text);
        self.head
            .chars()
            .chain(words.collect::<String>().chars())
            .collect()
    }

    /// The block with everything.
    pub(crate) fn text(&self) -> String {
        self.dressed(self.bare_text())
    }

    /// [`Line::text`], with something where answers are missing.
    pub(crate) fn text_to_check(&self) -> String {
        let words = self.fields.iter().map(Field::text_to_check);
        self.head
            .chars()
            .chain(words.collect::<String>().chars())
            .collect()
    }

    fn dressed(&self, text: String) -> String {
        let skip = if self.skip { "/ " } else { "" };
        format!("{skip}{text}{}", self.comment.text())
    }

    /// Whether it is only text.
    pub(crate) fn is_text(&self) -> bool {
        matches!(self.fields.as_slice(), [only] if only.slot.prompt == "text")
    }

    /// Whether an answer is text, in whatever spelling.
    pub(crate) fn has_text(&self) -> bool {
        self.fields.iter().any(|field| field.slot.ask == Ask::Text)
    }

    /// Whether nothing was answered.
    pub(crate) fn is_empty(&self) -> bool {
        self.all_fields().all(|field| field.words.is_empty())
    }

    /// Whether all answers are there that the block needs.
    pub(crate) fn is_complete(&self) -> bool {
        let missing = |field: &Field| field.slot.need == Need::Required && field.words.is_empty();
        !self.fields.iter().any(missing)
    }

    /// Whether there is an answer that the block needs.
    pub(crate) fn has_required(&self) -> bool {
        self.fields.iter().any(|field| field.slot.need == Need::Required)
    }

    /// Numbers in their shortest form.
    pub(crate) fn settle(&mut self) {
        for field in &mut self.fields {
            field.settle();
        }
    }

    /// Forgets the words of all fields.
    pub(crate) fn clear(&mut self) {
        for field in &mut self.fields {
            field.words.clear();
        }
        self.comment.words.clear();
    }

    /// Words that the control does not have are not asked for.
    pub(crate) fn fit(&mut self, setting: &Setting) {
        for field in &mut self.fields {
            if field.slot.need == Need::Optional && !setting.has(field.slot.of) {
                field.slot.need = Need::Unasked;
            }
        }
    }

    /// The block may stay away.
    pub(crate) fn make_optional(&mut self) {
        for field in &mut self.fields {
            field.slot.need = Need::Optional;
        }
    }

    /// The field to which the key of an address belongs: its axis, its answer, or the first letter of its words, the
    /// first that has none before those that have.
    pub(crate) fn field_of(&self, key: Key, setting: &Setting) -> Option<usize> {
        let takes = |field: &Field| match field.slot.ask {
            _ if !setting.has(field.slot.of) && field.words.is_empty() => false,
            Ask::Coordinates { .. } | Ask::Axes(_) | Ask::Direction => setting.axis(key).is_some(),
            Ask::Choice(choices) if field.address().is_empty() => choices.iter().any(|choice| {
                choice.key == Some(key)
                    || key
                        .character()
                        .is_some_and(|letter| choice.value.starts_with(letter))
            }),
            ask => {
                !ask.is_text()
                    && key
                        .character()
                        .is_some_and(|letter| field.address().starts_with(letter))
            }
        };
        let fields = || self.fields.iter().enumerate().filter(|(_, field)| takes(field));
        let empty = fields().find(|(_, field)| field.words.is_empty());
        empty.or_else(|| fields().next()).map(|(index, _)| index)
    }

    /// Words whose value was never entered go.
    pub(crate) fn drop_empty(&mut self) {
        for field in &mut self.fields {
            let valued = |ask: Ask| !matches!(ask, Ask::Axes(_));
            if valued(field.slot.ask) {
                field.words.retain(|word| !word.value.is_empty());
            }
        }
        self.comment.words.retain(|word| !word.value.trim().is_empty());
    }

    /// Places of the head, where there is one, and all words, in order.
    pub(crate) fn places(&self) -> Vec<WordPlace> {
        let words = self.words().map(|(place, _)| Some(place));
        // A block that opens with a word has no head to highlight.
        let head = (!self.head.is_empty() || self.is_empty()).then_some(None);
        head.into_iter().chain(words).collect()
    }

    pub(crate) fn word(&self, place: WordPlace) -> Option<&Word> {
        let (field, word) = place?;
        self.field(field)?.words.get(word)
    }

    /// What a word is found by in other blocks: its address, its name, or the head of the block.
    pub(crate) fn name_of(&self, place: WordPlace) -> String {
        let Some((field, word)) = place else {
            return self.head.clone();
        };
        let Some((field, word)) = self.field(field).and_then(|it| Some((it, it.words.get(word)?))) else {
            return String::new();
        };
        match (word.address.as_str(), field.glue.trim()) {
            ("", "")
                if field.slot.prompt == "compensation" || field.slot.prompt == "paraxial_compensation" =>
            {
                "R".to_owned()
            }
            ("", "") => self.head.clone() + " number",
            ("", name) => name.to_owned(),
            (address, _) => address.to_owned(),
        }
    }

    /// Parts of the text, each with its place: the head, then each word with what stands before it.
    pub(crate) fn parts(&self) -> Vec<(WordPlace, String)> {
        let mut parts = Vec::new();
        let mut before = match self.skip {
            true => format!("/ {}", self.head),
            false => self.head.clone(),
        };
        if !before.is_empty() {
            parts.push((None, before.clone()));
        }
        for (index, field) in self.all_fields().enumerate() {
            for (number, word) in field.words.iter().enumerate() {
                before = match number {
                    0 => field.glue.to_string(),
                    _ => field.separator().to_owned(),
                };
                parts.push((Some((index, number)), before + &field.written(word)));
            }
        }
        parts
    }
}

/// A block as its language writes it.
pub(crate) fn written(block: &Block, language: &dyn Language) -> String {
    let mut text = String::new();
    language.write(block, FormatOptions::default(), &mut text);
    text
}
