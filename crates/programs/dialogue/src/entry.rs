//! A block of DIN/ISO while it is entered: its text, and which part of it the next key changes.

use bahn_parameters::MessageId::{self, KeyNonFunctional};
use bahn_path::Axis;
use bahn_program::{Language, WordKind, WordSpan};

/// What the next key changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// This word is highlighted: a digit takes the place of its value, a letter begins a word after it.
    Word(usize),
    /// The same, and the sign of the value was turned already: the first digit leaves it.
    Signed(usize),
    /// Characters come in before this byte.
    At(usize),
}

/// What no block can hold.
const NOT_IN_A_BLOCK: &[char] = &['~', '\n', '\r', '\t', '\u{c}', '\u{feff}'];

/// Whether after a text any character is taken: in a comment, the name of a program, a formula.
fn is_free(before: &str) -> bool {
    before.contains([';', '%', '=']) || before.contains(NAME)
}

/// After this stands the name of a program that is a cycle.
const NAME: &str = "G39 P";

/// A block that is entered.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// The block whose place it takes; none for a new one.
    pub(crate) replaces: Option<u32>,
    /// What stands there, without the number.
    pub(crate) text: String,
    pub(crate) place: Place,
    original: String,
    language: &'static dyn Language,
}

impl Entry {
    /// A new block, after that at the cursor.
    pub(crate) fn new(language: &'static dyn Language) -> Entry {
        Entry {
            replaces: None,
            text: String::new(),
            place: Place::At(0),
            original: String::new(),
            language,
        }
    }

    /// A block that stands there.
    pub(crate) fn of_block(block: u32, text: String, place: Place, language: &'static dyn Language) -> Entry {
        Entry {
            replaces: Some(block),
            original: text.clone(),
            text,
            place,
            language,
        }
    }

    /// With another text, which was entered before; `None` where the place does not exist in it.
    pub(crate) fn with(mut self, text: String, place: Place) -> Option<Entry> {
        self.text = text;
        self.place = place;
        let there = match place {
            Place::Word(at) | Place::Signed(at) => at < self.words().len(),
            Place::At(at) => self.text.is_char_boundary(at),
        };
        let whole = !self.text.contains(NOT_IN_A_BLOCK);
        (there && whole).then_some(self)
    }

    /// Whether something would be lost.
    pub(crate) fn is_changed(&self) -> bool {
        self.replaces.is_none() || self.text != self.original
    }

    /// The words of the text.
    pub(crate) fn words(&self) -> Vec<WordSpan> {
        self.language.parse_block(&self.text).words
    }

    /// The word that is highlighted, or in or after which the next character comes.
    pub(crate) fn current(&self) -> Option<(usize, WordSpan)> {
        let words = self.words();
        let at = match self.place {
            Place::Word(at) | Place::Signed(at) => Some(at),
            Place::At(at) => words
                .iter()
                .position(|word| word.span.start < at && at <= word.span.end),
        }?;
        words.into_iter().nth(at).map(|word| (at, word))
    }

    fn part(&self, range: std::ops::Range<usize>) -> &str {
        self.text.get(range).unwrap_or_default()
    }

    /// The current word's address and value.
    pub(crate) fn current_word(&self) -> Option<(&str, &str)> {
        let (_, word) = self.current()?;
        Some((
            self.part(word.span.start..word.value.start),
            self.part(word.value.start..word.span.end),
        ))
    }

    /// What stands at the place takes any character: a comment, the name of a program, a formula.
    fn is_free(&self) -> bool {
        let before = match self.current() {
            Some((_, word)) if !matches!(self.place, Place::At(_)) => self.part(0..word.value.start),
            _ => match self.place {
                Place::At(at) => self.part(0..at),
                _ => "",
            },
        };
        is_free(before)
    }

    fn is_comment(&self) -> bool {
        match self.place {
            Place::At(at) => self.part(0..at).contains(';'),
            _ => self
                .current()
                .is_some_and(|(_, word)| word.kind == WordKind::Comment),
        }
    }

    /// Whether a character ends the block: `*`, but in a comment and in a formula.
    pub(crate) fn ends_with(&self, character: char) -> bool {
        character == '*' && !self.is_comment() && !self.text.contains('=')
    }

    /// Whether a character would begin a word.
    pub(crate) fn begins_word(&self, character: char) -> bool {
        !self.is_free()
            && character.is_ascii_alphabetic()
            && match self.place {
                Place::At(at) => {
                    let before = self.part(0..at);
                    before.ends_with(' ') || self.parts(before, character.to_ascii_uppercase())
                }
                _ => !self.takes_parameter(character),
            }
    }

    /// `Q` takes the place of the highlighted word's value.
    fn takes_parameter(&self, character: char) -> bool {
        let address = |(_, word): (usize, WordSpan)| word.kind == WordKind::Address;
        character.eq_ignore_ascii_case(&'Q') && self.current().is_some_and(address)
    }

    /// Whether a character that follows others does not belong to their word.
    fn parts(&self, before: &str, character: char) -> bool {
        let address = self.current_word().map_or("", |(address, _)| address);
        let one_axis = match address.as_bytes() {
            [letter] => before.ends_with(address) && Axis::from_letter(*letter).is_some(),
            _ => false,
        };
        match (before.chars().last(), character) {
            (None | Some(' '), _) => false,
            (_, ';' | '%') => true,
            (Some('+' | '-'), 'Q') => false,
            // `FQ5` and `P01 Q5`: the parameter is the value of the word.
            (Some(last), 'Q') => last.is_ascii_digit(),
            (Some(last), 'A'..='Z') => last.is_ascii_digit() || "+-".contains(last) || one_axis,
            // `P01`, then its value.
            (Some(last), '0'..='9') => {
                address.len() == 3 && address.starts_with('P') && before.ends_with(address) && last != ' '
            }
            _ => false,
        }
    }

    /// A character is typed.
    pub(crate) fn character(&mut self, character: char) -> Result<(), MessageId> {
        let comment = self.is_comment();
        if NOT_IN_A_BLOCK.contains(&character)
            || character.is_control()
            || !(comment || (character.is_ascii() && character != '*') || self.text.contains('='))
        {
            return Err(KeyNonFunctional);
        }
        let character = match comment {
            true => character,
            false => character.to_ascii_uppercase(),
        };
        let at = match (self.place, self.current()) {
            (Place::At(at), _) => at,
            (place, Some((_, word))) => self.over(word, place, character)?,
            (_, None) => return Err(KeyNonFunctional),
        };
        let free = is_free(self.part(0..at));
        self.place = Place::At(at);
        let before = self.part(0..at);
        let blank = !free && self.parts(before, character);
        if character == ' ' && !free && (before.is_empty() || before.ends_with(' ')) {
            return Ok(());
        }
        let mut new = String::new();
        if blank {
            new.push(' ');
        }
        new.push(character);
        if character == ';' && !free {
            new.push(' ');
        }
        self.text.insert_str(at, &new);
        self.place = Place::At(at + new.len());
        Ok(())
    }

    /// Makes room at a highlighted word; where characters come in then.
    fn over(&mut self, word: WordSpan, place: Place, character: char) -> Result<usize, MessageId> {
        if word.kind == WordKind::Comment {
            // Its `;` stays.
            self.text.replace_range(word.span.start.., "; ");
            return Ok(self.text.len());
        }
        if self.part(word.span.clone()).starts_with('%') {
            self.text.truncate(word.value.start);
            return Ok(self.text.len());
        }
        let of_value = character.is_ascii_digit() || "+-.,".contains(character);
        if !(of_value || self.takes_parameter(character)) {
            // A word of its own, after this one.
            let at = word.span.end;
            if character != ' ' {
                self.text.insert(at, ' ');
            }
            return Ok(at + usize::from(character != ' '));
        }
        if word.value.start == word.span.start && word.kind != WordKind::Value {
            return Err(KeyNonFunctional);
        }
        let keeps = usize::from(matches!(place, Place::Signed(_)));
        let value = self.part(word.value.start..word.span.end);
        let blanks = value.len() - value.trim_start().len();
        let start = word.value.start + blanks + keeps;
        if start <= word.span.end {
            self.text.replace_range(start..word.span.end, "");
        }
        Ok(start.min(self.text.len()))
    }

    /// SIGN turns the sign of a value, else it is a character.
    pub(crate) fn sign(&mut self) -> Result<(), MessageId> {
        let Some((index, word)) = self.current().filter(|_| !self.is_free()) else {
            return self.character('-');
        };
        if word.kind != WordKind::Address {
            return self.character('-');
        }
        let value = self.part(word.value.start..word.span.end);
        let start = word.value.start + value.len() - value.trim_start().len();
        let (old, new) = match self.part(start..word.span.end).chars().next() {
            Some('-') => (1, "+"),
            Some('+') => (1, "-"),
            _ => (0, "-"),
        };
        self.text.replace_range(start..start + old, new);
        self.place = match self.place {
            Place::At(at) => Place::At(at + new.len() - old),
            _ => Place::Signed(index),
        };
        Ok(())
    }

    /// CE: the value of the highlighted word, or the character before the place.
    pub(crate) fn erase(&mut self) -> Result<(), MessageId> {
        match (self.place, self.current()) {
            (Place::At(at), _) => {
                let last = self.part(0..at).chars().last().ok_or(KeyNonFunctional)?;
                let from = at - last.len_utf8();
                self.text.replace_range(from..at, "");
                self.place = Place::At(from);
            }
            (_, Some((_, word))) if !word.value.is_empty() && word.value.start > word.span.start => {
                self.text.replace_range(word.value.start..word.span.end, "");
                self.place = Place::At(word.value.start);
            }
            _ => return Err(KeyNonFunctional),
        }
        Ok(())
    }

    /// NO ENT takes the current word out.
    pub(crate) fn remove(&mut self) -> Result<(), MessageId> {
        let (index, word) = self.current().ok_or(KeyNonFunctional)?;
        let rest = self.part(word.span.end..self.text.len());
        let end = word.span.end + rest.len() - rest.trim_start().len();
        self.text.replace_range(word.span.start..end, "");
        let left = self.text.trim_end().len();
        self.text.truncate(left);
        let count = self.words().len();
        self.place = match (self.place, count.checked_sub(1)) {
            (Place::At(_), _) | (_, None) => Place::At(word.span.start.min(left)),
            (_, Some(last)) => Place::Word(index.min(last)),
        };
        Ok(())
    }

    /// LEFT and RIGHT go from word to word, and after the last one; `false` where there is nothing more.
    pub(crate) fn go(&mut self, right: bool) -> bool {
        let words = self.words();
        let next = match (self.place, right) {
            (Place::Word(at) | Place::Signed(at), true) => Some(at + 1),
            (Place::Word(at) | Place::Signed(at), false) => at.checked_sub(1),
            (Place::At(at), true) if at < self.text.len() => {
                let after = words.iter().position(|word| word.span.start >= at);
                Some(after.unwrap_or(words.len()))
            }
            (Place::At(_), true) => None,
            (Place::At(at), false) => words.iter().rposition(|word| word.span.start < at),
        };
        let Some(next) = next else { return false };
        self.place = match next < words.len() {
            true => Place::Word(next),
            false => {
                // What comes next is a word of its own.
                let length = self.text.trim_end().len();
                self.text.truncate(length);
                Place::At(length)
            }
        };
        true
    }

    /// The coordinate whose actual position may be captured.
    pub(crate) fn axis(&self) -> Option<Axis> {
        match self.current_word()?.0.as_bytes() {
            [letter] => Axis::from_letter(*letter),
            _ => None,
        }
    }

    /// Takes the value of a position.
    pub(crate) fn capture(&mut self, value: &str) -> Result<(), MessageId> {
        let (_, word) = self.current().ok_or(KeyNonFunctional)?;
        let sign = if value.starts_with('-') { "" } else { "+" };
        let value = format!("{sign}{value}");
        self.text.replace_range(word.value.start..word.span.end, &value);
        self.place = Place::At(word.value.start + value.len());
        Ok(())
    }

    /// The word at a column of the text, in characters counted from 1, is highlighted.
    pub(crate) fn show(&mut self, column: u32) {
        let mut characters = self.text.char_indices();
        let byte = characters.nth(column.saturating_sub(1) as usize);
        let byte = byte.map_or(self.text.len(), |(byte, _)| byte);
        let words = self.words();
        let place = words.iter().rposition(|word| word.span.start <= byte);
        if let Some(place) = place {
            self.place = Place::Word(place);
        }
    }
}
