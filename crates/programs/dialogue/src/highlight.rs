//! A word of a block of the program, highlighted: to overwrite it, delete it or find it elsewhere.
//!
//! Decision: The key of an address adds its word to a highlighted block, or goes to it; a word without a value goes;
//! R is R0

use bahn_parameters::MessageId::{self, KeyNonFunctional};

use crate::check::Context;
use crate::field::{Ask, Need};
use crate::line::{Line, WordPlace};
use crate::typing::{Fresh, Typing};
use crate::{Key, Setting, Wanted};

/// The word of a block that is highlighted, and its comment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Highlight {
    pub(crate) block: u32,
    /// The block as it stands, with what is being entered.
    pub(crate) line: Line,
    pub(crate) place: WordPlace,
    pub(crate) typing: Typing,
    /// The block before something was entered.
    original: Line,
}

impl Highlight {
    pub(crate) fn new(block: u32, line: Line, place: WordPlace) -> Highlight {
        Highlight {
            block,
            original: line.clone(),
            typing: place.map_or_else(Typing::default, |(_, word)| Typing::over(word)),
            line,
            place,
        }
    }

    /// Whether a value was entered and not yet confirmed.
    pub(crate) fn is_changed(&self) -> bool {
        self.line != self.original || self.typing.incremental
    }

    /// The entered value is forgotten.
    pub(crate) fn forget(&mut self) {
        let original = self.original.clone();
        // A word that was added is not there any more.
        let place = match original.word(self.place) {
            None if self.place.is_some() => original.places().last().copied().flatten(),
            _ => self.place,
        };
        *self = Highlight::new(self.block, original, place);
    }

    /// Goes to the comment after the block, or begins one.
    pub(crate) fn comment(&mut self) -> Result<(), MessageId> {
        let index = self.line.comment_field().ok_or(KeyNonFunctional)?;
        let field = self.line.field_mut(index).ok_or(KeyNonFunctional)?;
        self.typing = Typing::over(0);
        if field.words.is_empty() {
            self.typing.begin(field);
        }
        self.place = Some((index, 0));
        Ok(())
    }

    /// The word so many places farther; none beyond the ends.
    pub(crate) fn beside(&self, by: isize) -> Option<WordPlace> {
        let places = self.line.places();
        let at = places.iter().position(|place| *place == self.place)?;
        places.get(at.checked_add_signed(by)?).copied()
    }

    /// What a key enters: a value for the word, else the key of an address adds its word at its place, or goes to it
    /// where it stands [003:1779-1780].
    pub(crate) fn key(&mut self, key: Key, setting: &Setting) -> Result<(), MessageId> {
        let before = (self.line.clone(), self.place, self.typing);
        let entered = self.enter(key, setting);
        if entered.is_err() {
            (self.line, self.place, self.typing) = before;
            return self.add(key, setting).or(entered);
        }
        entered
    }

    /// Adds the word of an address, or goes to it; what was begun of another without a value goes.
    fn add(&mut self, key: Key, setting: &Setting) -> Result<(), MessageId> {
        if self.line.is_text() {
            return Err(KeyNonFunctional);
        }
        let mut line = self.line.clone();
        line.drop_empty();
        let index = line.field_of(key, setting).ok_or(KeyNonFunctional)?;
        let field = line.field_mut(index).ok_or(KeyNonFunctional)?;
        let mut typing = Typing::default();
        match field.slot.ask {
            Ask::Coordinates { .. } | Ask::Axes(_) | Ask::Direction => typing.key(field, key, setting)?,
            Ask::Choice(choices) => {
                let last = choices.last().map_or("", |choice| choice.value);
                // R of RL and RR is R0, D the address of DR, which SIGN turns.
                let kept = !field.words.is_empty() && !field.address().is_empty();
                if typing.key(field, key, setting).is_err() && !kept {
                    typing.take(field, last);
                }
            }
            _ if field.words.is_empty() => typing.begin(field),
            _ => typing = Typing::over(field.words.len() - 1),
        }
        (self.line, self.typing) = (line, typing);
        self.follow(index);
        Ok(())
    }

    /// What a key enters into the word.
    fn enter(&mut self, key: Key, setting: &Setting) -> Result<(), MessageId> {
        let (index, _) = self.place.ok_or(KeyNonFunctional)?;
        let field = self.line.field_mut(index).ok_or(KeyNonFunctional)?;
        match key {
            Key::Ce if field.slot.ask.is_number() => {
                let word = self.typing.word.and_then(|word| field.words.get_mut(word));
                let word = word.ok_or(KeyNonFunctional)?;
                word.value = "0".to_owned();
                self.typing.fresh = Fresh::Yes;
            }
            Key::Ce if field.slot.ask.is_text() => self.typing.clear(field),
            Key::Ce => return Err(KeyNonFunctional),
            _ => self.typing.key(field, key, setting)?,
        }
        self.follow(index);
        Ok(())
    }

    /// Takes an answer by soft key, or characters of a text.
    pub(crate) fn take(&mut self, value: &str, setting: &Setting) -> Result<(), MessageId> {
        let (index, _) = self.place.ok_or(KeyNonFunctional)?;
        let field = self.line.field_mut(index).ok_or(KeyNonFunctional)?;
        if field.slot.ask.is_text() {
            for character in value.chars() {
                self.typing.character(field, character, setting)?;
            }
        } else {
            self.typing.take(field, value);
        }
        self.follow(index);
        Ok(())
    }

    /// The position that may be captured for the word.
    pub(crate) fn wants_position(&self) -> Option<Wanted> {
        let (field, word) = self.place?;
        self.line.field(field)?.wants_position(word)
    }

    /// Takes the value of a position.
    pub(crate) fn capture(&mut self, value: String) -> Result<(), MessageId> {
        let (field, index) = self.place.ok_or(KeyNonFunctional)?;
        let field = self.line.field_mut(field).ok_or(KeyNonFunctional)?;
        let word = field.words.get_mut(index).ok_or(KeyNonFunctional)?;
        (word.value, word.incremental) = (value, false);
        self.typing = Typing::over(index);
        Ok(())
    }

    /// The highlight goes to the word that is entered.
    fn follow(&mut self, field: usize) {
        let last = self
            .line
            .field(field)
            .map_or(0, |field| field.words.len().saturating_sub(1));
        self.place = Some((field, self.typing.word.unwrap_or(last).min(last)));
    }

    /// Takes the word out.
    pub(crate) fn remove(&mut self) -> Result<(), MessageId> {
        let (index, word) = self.place.ok_or(KeyNonFunctional)?;
        let field = self.line.field_mut(index).ok_or(KeyNonFunctional)?;
        let last = field.words.len() < 2;
        if (field.slot.need == Need::Required && last) || field.words.len() <= word {
            return Err(KeyNonFunctional);
        }
        field.words.remove(word);
        Ok(())
    }

    /// What a word highlighted takes instead of digits.
    pub(crate) fn ask(&self) -> Option<Ask> {
        let (field, _) = self.place?;
        Some(self.line.field(field)?.slot.ask)
    }

    /// Numbers in their shortest form; a word that was added without a value goes.
    pub(crate) fn settle(&mut self) {
        if self.is_changed() {
            self.line.drop_empty();
        }
        if self.place.is_some() && self.line.word(self.place).is_none() {
            let places = self.line.places();
            let after = places.iter().find(|place| **place >= self.place);
            self.place = after.or(places.last()).copied().flatten();
            self.typing = self
                .place
                .map_or_else(Typing::default, |(_, word)| Typing::over(word));
        }
        if let Some((index, _)) = self.place
            && let Some(field) = self.line.field_mut(index)
        {
            self.typing.settle(field);
        }
        self.line.settle();
    }

    /// Checks what was entered.
    pub(crate) fn check(&self, context: Context<'_>, others: &[Line]) -> Result<(), MessageId> {
        context.check(&self.line, others)
    }
}
