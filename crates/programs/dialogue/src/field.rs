//! The words of a block as the dialogue asks for them: what a question takes, and how its answer is written.

use std::borrow::Cow;

use bahn_parameters::Limits;
use bahn_path::Axis;
use bahn_program::Sign;

use crate::{Key, Wanted};

/// Stands before the line of a datum table.
pub(crate) const TABLE_LINE: &str = "#";
/// Axes of a corner, in their sequence.
const CORNER: [&str; 3] = ["X", "Y", "Z"];
/// Most dialogue texts of a cycle: its name and 14 parameters [000:17742].
const DIALOG_TEXTS_MAX: usize = 15;

/// A word of a block in its parts, as it is being entered.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Word {
    /// The word is written with `I`: an incremental coordinate.
    pub incremental: bool,
    /// `X`, `PR`, `F`; empty where the value stands by itself.
    pub address: String,
    /// The value as far as it was entered: `-12.`, `Q5`, `MAX`; without `+`.
    pub value: String,
}

/// The sign of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Signs {
    /// The sign is always written.
    Always,
    /// Only `-` is written.
    Minus,
    /// The number has no sign.
    None,
}

/// How many axes a question takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Most {
    /// Those of a straight line of the model.
    Line,
    /// Those of a circle or helix of the model.
    Circle,
    /// A fixed number of axes.
    Count(u8),
    /// X, Y and Z of a corner: numbers without axis keys are for them in this sequence [003:6611].
    Corner,
}

impl Most {
    fn of(self, limits: &Limits) -> usize {
        usize::from(match self {
            Most::Line => limits.line_axes_max,
            Most::Circle => limits.circle_axes_max.max(limits.helix_axes_max),
            Most::Count(count) => count,
            Most::Corner => CORNER.len() as u8,
        })
    }
}

/// One of several answers, with the key that gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Choice {
    pub(crate) value: &'static str,
    pub(crate) key: Option<Key>,
}

/// What a question takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ask {
    /// A number or Q parameter.
    Number { signs: Signs, incremental: bool },
    /// A whole number; with `q` a Q parameter, too.
    Integer { q: bool },
    /// How often a section is repeated; listings show it twice.
    Repeat,
    /// Axes with a value each.
    Coordinates {
        /// Before the axis letter.
        prefix: &'static str,
        signs: Signs,
        incremental: bool,
        most: Most,
        /// A line of a datum table may stand in their place, after `#` [000:6898-6904].
        table: bool,
    },
    /// Axes without values, so many at most.
    Axes(u8),
    /// An axis with a direction.
    Direction,
    /// One of a few words; ENT alone takes the last.
    Choice(&'static [Choice]),
    /// A feed; with `max` ENT alone is rapid traverse.
    Feed { max: bool },
    /// The number of an M function.
    M,
    /// Whole numbers, one after the other.
    Labels,
    /// Numbers of dialogue texts, one after the other.
    Texts,
    /// Numbers and Q parameters, one after the other.
    Items,
    /// The name of a program.
    Name,
    /// Text of any kind.
    Text,
}

/// Whether a question is to be answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    /// The block cannot stand without.
    Required,
    /// NO ENT passes it over.
    Optional,
    /// It is not asked; where such a word stands it can be changed.
    Unasked,
}

/// A place for words in a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slot {
    /// Text before its words, where there are any.
    pub(crate) glue: &'static str,
    /// Address of its words, where they have one and the same.
    pub(crate) address: &'static str,
    pub(crate) ask: Ask,
    /// Id of the prompt.
    pub(crate) prompt: &'static str,
    pub(crate) need: Need,
    /// That of its numbers.
    pub(crate) sign: Sign,
    /// Name of the word in the registry of the control models, where not all of them have it.
    pub(crate) of: &'static str,
}

/// A slot with the words that stand in it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    pub(crate) slot: Slot,
    /// [`Slot::glue`], or what stands there in a block that was read.
    pub(crate) glue: Cow<'static, str>,
    pub(crate) words: Vec<Word>,
}

impl Ask {
    /// What stands between several words.
    fn separator(self) -> &'static str {
        match self {
            Ask::Labels | Ask::Items | Ask::Texts => "/",
            _ => " ",
        }
    }

    /// Most words that it takes.
    pub(crate) fn most(self, limits: &Limits) -> usize {
        match self {
            Ask::Coordinates { most, .. } => most.of(limits),
            Ask::Axes(count) => usize::from(count),
            Ask::Labels => usize::from(limits.contour_labels_max),
            Ask::Items => usize::from(limits.print_items_max),
            Ask::Texts => DIALOG_TEXTS_MAX,
            _ => 1,
        }
    }

    /// Whether ENT after one word asks for the next.
    pub(crate) fn is_list(self) -> bool {
        matches!(self, Ask::Labels | Ask::Items | Ask::Texts)
    }

    /// Whether letters write text.
    pub(crate) fn is_text(self) -> bool {
        matches!(self, Ask::Name | Ask::Text)
    }

    pub(crate) fn signs(self) -> Signs {
        match self {
            Ask::Number { signs, .. } | Ask::Coordinates { signs, .. } => signs,
            Ask::Items => Signs::Minus,
            _ => Signs::None,
        }
    }

    /// Whether a Q parameter may stand for the value.
    pub(crate) fn takes_q(self) -> bool {
        match self {
            Ask::Number { .. } | Ask::Coordinates { .. } | Ask::Feed { .. } | Ask::Items | Ask::Repeat => {
                true
            }
            Ask::Integer { q } => q,
            _ => false,
        }
    }

    pub(crate) fn takes_incremental(self) -> bool {
        match self {
            Ask::Number { incremental, .. } | Ask::Coordinates { incremental, .. } => incremental,
            _ => false,
        }
    }

    /// Whether the value has decimals.
    pub(crate) fn has_decimals(self) -> bool {
        matches!(
            self,
            Ask::Number { .. } | Ask::Coordinates { .. } | Ask::Feed { .. } | Ask::Items
        )
    }

    /// Whether its values are numbers.
    pub(crate) fn is_number(self) -> bool {
        self.has_decimals()
            || matches!(
                self,
                Ask::Integer { .. } | Ask::Repeat | Ask::Labels | Ask::Texts | Ask::M
            )
    }

    /// Whether digits write a value without an axis before.
    pub(crate) fn begins_with_value(self) -> bool {
        !matches!(
            self,
            Ask::Coordinates { .. } | Ask::Axes(_) | Ask::Direction | Ask::Choice(_)
        )
    }

    /// An answer in the place of one that is still missing, so that the rest can be checked.
    fn neutral(self) -> &'static str {
        match self {
            Ask::Choice(choices) => choices.last().map_or("", |choice| choice.value),
            Ask::Coordinates { .. } => "X+1",
            Ask::Axes(_) => "X",
            Ask::Direction => "X+",
            _ => "1",
        }
    }

    /// Whether the value of a word is whole.
    fn is_whole(self, word: &Word) -> bool {
        let value = word.value.as_str();
        match self {
            Ask::Axes(_) => true,
            Ask::Direction => !value.is_empty(),
            Ask::Choice(choices) => choices.iter().any(|choice| choice.value == value),
            Ask::Feed { .. } if value == "MAX" => true,
            Ask::Name | Ask::Text => !value.trim().is_empty(),
            Ask::M => {
                let mut words = value.split(' ');
                let code = words
                    .next()
                    .is_some_and(|code| value_length(code) == Some(code.len()));
                code && words.all(|word| {
                    let number = word.trim_start_matches(is_address);
                    value_length(number) == Some(number.len())
                })
            }
            _ => value_length(value) == Some(value.len()),
        }
    }

    /// Reads one word at the front of a text; the word and its length.
    fn scan(self, address: &str, text: &str) -> Option<(Word, usize)> {
        let mut rest = Rest { text, at: 0 };
        let mut word = Word::default();
        match self {
            Ask::Name | Ask::Text => {
                word.value = text.to_owned();
                rest.at = text.len();
            }
            Ask::Axes(_) | Ask::Direction => {
                let axis = rest.axis()?;
                word.address = axis.to_string();
                if self == Ask::Direction {
                    word.value = rest.one_of(&["+", "-"])?.to_owned();
                }
            }
            Ask::Choice(choices) => {
                rest.literal(address)?;
                word.address = address.to_owned();
                let found = choices.iter().find(|choice| {
                    let mut after = rest.clone();
                    after.literal(choice.value).is_some() && after.ends_word()
                })?;
                rest.literal(found.value)?;
                word.value = found.value.to_owned();
            }
            Ask::Coordinates { table: true, .. } if text.starts_with(TABLE_LINE) => {
                rest.literal(TABLE_LINE)?;
                // Listings set the number off.
                while rest.literal(":").or_else(|| rest.literal(" ")).is_some() {}
                word.address = TABLE_LINE.to_owned();
                word.value = rest.value()?.to_owned();
            }
            Ask::Coordinates { prefix, .. } => {
                word.incremental = rest.literal("I").is_some();
                rest.literal(prefix)?;
                let axis = rest.axis()?;
                word.address = format!("{prefix}{axis}");
                word.value = rest.value()?.to_owned();
            }
            _ => {
                word.incremental = self.takes_incremental() && rest.literal("I").is_some();
                rest.literal(address)?;
                word.address = address.to_owned();
                if !address.is_empty() {
                    let _ = rest.literal(" ");
                }
                let max = matches!(self, Ask::Feed { .. }) && rest.literal("MAX").is_some();
                word.value = if max { "MAX" } else { rest.value()? }.to_owned();
                if self == Ask::M {
                    word.value.push_str(rest.arguments());
                }
            }
        }
        rest.ends_word().then_some((word, rest.at))
    }
}

/// A text that is read.
#[derive(Clone)]
struct Rest<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Rest<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn literal(&mut self, literal: &str) -> Option<()> {
        self.rest().starts_with(literal).then(|| self.at += literal.len())
    }

    fn one_of(&mut self, literals: &[&'static str]) -> Option<&'static str> {
        let found = literals
            .iter()
            .find(|literal| self.rest().starts_with(**literal))?;
        self.at += found.len();
        Some(found)
    }

    fn axis(&mut self) -> Option<Axis> {
        let axis = Axis::from_letter(*self.rest().as_bytes().first()?)?;
        self.at += 1;
        Some(axis)
    }

    /// A number or Q parameter without its `+`.
    fn value(&mut self) -> Option<&'a str> {
        let _ = self.literal("+");
        let length = value_length(self.rest())?;
        let value = self.rest().get(..length);
        self.at += length;
        value
    }

    /// The words after an M function that belong to it.
    fn arguments(&mut self) -> &'a str {
        let rest = self.rest();
        let length = rest.find(" M").unwrap_or(rest.len());
        self.at += length;
        rest.get(..length).unwrap_or_default()
    }

    fn ends_word(&self) -> bool {
        matches!(self.rest().as_bytes().first(), None | Some(b' ' | b'/'))
    }
}

/// Bytes of the number or Q parameter at the front of a text, with its `-`.
fn value_length(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let sign = usize::from(bytes.first() == Some(&b'-'));
    let q = usize::from(bytes.get(sign) == Some(&b'Q'));
    let mut at = sign + q;
    let mut digits = 0;
    let mut points = 0;
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'0'..=b'9' => digits += 1,
            b'.' if q == 0 && points == 0 => points += 1,
            _ => break,
        }
        at += 1;
    }
    (digits > 0).then_some(at)
}

/// A number or Q parameter in its shortest form.
fn settled(value: &str) -> String {
    let (sign, magnitude) = match value.strip_prefix('-') {
        Some(magnitude) => ("-", magnitude),
        None => ("", value),
    };
    let (q, number) = match magnitude.strip_prefix('Q') {
        Some(number) => ("Q", number),
        None => ("", magnitude),
    };
    let (whole, decimals) = number.split_once('.').unwrap_or((number, ""));
    let whole = match whole.trim_start_matches('0') {
        "" => "0",
        whole => whole,
    };
    match decimals.trim_end_matches('0') {
        "" if whole == "0" && q.is_empty() => "0".to_owned(),
        "" => format!("{sign}{q}{whole}"),
        decimals => format!("{sign}{q}{whole}.{decimals}"),
    }
}

/// Part of the address of a word that belongs to an M function: `T`, `TIME`.
pub(crate) fn is_address(character: char) -> bool {
    character.is_ascii_alphabetic() && character != 'Q'
}

/// A word that belongs to an M function, with its number in the shortest form.
fn settled_word(word: &str) -> String {
    let number = word.trim_start_matches(is_address);
    let address = word.strip_suffix(number).unwrap_or_default();
    match value_length(number) == Some(number.len()) {
        true => format!("{address}{}", settled(number)),
        false => word.to_owned(),
    }
}

impl Field {
    pub(crate) fn new(slot: Slot) -> Field {
        Field {
            slot,
            glue: slot.glue.into(),
            words: Vec::new(),
        }
    }

    /// The address of its words, or the name that stands before them.
    pub(crate) fn address(&self) -> &str {
        match self.slot.address {
            "" => self.glue.trim(),
            address => address,
        }
    }

    /// The axis that a number without one is for, where a corner is asked for.
    pub(crate) fn in_turn(&self) -> Option<&'static str> {
        let Ask::Coordinates {
            most: Most::Corner, ..
        } = self.slot.ask
        else {
            return None;
        };
        let is_free = |letter: &&str| self.words.iter().all(|word| word.address != *letter);
        CORNER.into_iter().find(is_free)
    }

    /// What stands between its words.
    pub(crate) fn separator(&self) -> &'static str {
        self.slot.ask.separator()
    }

    /// A word as the block shows it.
    pub(crate) fn written(&self, word: &Word) -> String {
        let incremental = if word.incremental { "I" } else { "" };
        let signed = self.slot.ask.signs() == Signs::Always && word.address != TABLE_LINE;
        let plus = signed && !word.value.starts_with('-');
        let plus = if plus { "+" } else { "" };
        let value = &word.value;
        let left = match self.slot.ask {
            Ask::Repeat => format!("/{value}"),
            _ => String::new(),
        };
        format!("{incremental}{}{plus}{value}{left}", word.address)
    }

    /// Its words with what stands before them; empty without words.
    pub(crate) fn text(&self) -> String {
        let words: Vec<_> = self.words.iter().map(|word| self.written(word)).collect();
        if words.is_empty() {
            return String::new();
        }
        format!("{}{}", self.glue, words.join(self.separator()))
    }

    /// [`Field::text`], with something in the place of an answer that is missing.
    pub(crate) fn text_to_check(&self) -> String {
        if self.words.is_empty() && self.slot.need == Need::Required {
            return format!("{}{}{}", self.glue, self.slot.address, self.slot.ask.neutral());
        }
        self.text()
    }

    /// The position that may be captured for a word.
    pub(crate) fn wants_position(&self, word: usize) -> Option<Wanted> {
        let word = self.words.get(word)?;
        match self.slot.ask {
            Ask::Coordinates { .. } => Axis::from_letter(word.address.bytes().last()?).map(Wanted::Axis),
            Ask::Number { .. } => Some(Wanted::ToolAxis),
            _ => None,
        }
    }

    /// Whether all values are whole.
    pub(crate) fn is_whole(&self) -> bool {
        self.words.iter().all(|word| self.slot.ask.is_whole(word))
    }

    /// Reads its words at the front of a text; their length.
    pub(crate) fn read(&mut self, text: &str) -> Option<usize> {
        let glue = self.glue.len();
        if text.starts_with(self.glue.as_ref())
            && let Some(length) = self.read_words(text.get(glue..)?)
        {
            return Some(glue + length);
        }
        // The words before a value vary with the language of the control, and listings have a colon after some.
        if glue < 2 || !self.glue.ends_with(' ') {
            return None;
        }
        for begin in text.match_indices(' ').map(|(at, _)| at + 1) {
            if let Some(length) = self.read_words(text.get(begin..)?) {
                let found = text.get(..begin)?;
                if found.replace(':', "") != self.glue.replace(':', "") {
                    self.glue = found.to_owned().into();
                }
                return Some(begin + length);
            }
        }
        None
    }

    /// Its numbers without what does not count: `.50` is `0.5`.
    pub(crate) fn settle(&mut self) {
        for word in &mut self.words {
            if self.slot.ask == Ask::M {
                let parts: Vec<String> = word.value.split(' ').map(settled_word).collect();
                word.value = parts.join(" ");
            } else if !self.slot.ask.is_text() && value_length(&word.value) == Some(word.value.len()) {
                word.value = settled(&word.value);
            }
        }
    }

    fn read_words(&mut self, text: &str) -> Option<usize> {
        let Slot { ask, address, .. } = self.slot;
        let (first, mut length) = ask.scan(address, text)?;
        let mut words = vec![first];
        let several = ask.is_list() || matches!(ask, Ask::Coordinates { .. } | Ask::Axes(_) | Ask::M);
        while several
            && let Some(rest) = text.get(length..)
            && let Some(after) = rest.strip_prefix(ask.separator())
            && let Some((word, more)) = ask.scan(address, after)
        {
            words.push(word);
            length += rest.len() - after.len() + more;
        }
        if ask == Ask::Repeat
            && let Some(left) = text.get(length..).filter(|rest| rest.starts_with('/'))
        {
            length += left.find(' ').unwrap_or(left.len());
        }
        self.words = words;
        Some(length)
    }
}
