//! What keys do with the words of a field.
//!
//! Decision: The corners of BLK FORM are entered like those of RANGE: numbers without axis keys are for X, Y and Z
//!
//! Decision: I stands before the axis key; after a value it is for the next axis, or for this one if none follows. A
//! sign before new digits is theirs

use bahn_parameters::MessageId::{self, EntryValueIncorrect, KeyNonFunctional};

use crate::field::{Ask, Choice, Field, Signs, TABLE_LINE, Word, is_address};
use crate::{Key, Setting};
use bahn_program::m_words;

/// Most characters of a number, with sign and point.
const NUMBER_MAX: usize = 14;
/// Most digits after `Q`.
const Q_DIGITS_MAX: usize = 4;
/// Most digits of an M function.
const M_DIGITS_MAX: usize = 3;
/// Most characters of a text.
const TEXT_MAX: usize = 240;
/// What a text cannot hold: it would end the block, or join the next.
const NO_TEXT: &[char] = &['~', '\n', '\r', '\u{c}', '\u{feff}'];

/// What the first digit does with the value that stands there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Fresh {
    /// It goes on with it.
    #[default]
    No,
    /// It takes its place.
    Yes,
    /// It takes its place, negative: the sign was keyed first.
    Negative,
}

/// The word that is being entered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Typing {
    /// Which word of the field.
    pub(crate) word: Option<usize>,
    /// The first digit takes the place of the value.
    pub(crate) fresh: Fresh,
    /// `I` was pressed before the axis.
    pub(crate) incremental: bool,
    /// The word has the axis whose turn it was: ENT goes on to the next one.
    pub(crate) in_turn: bool,
}

impl Typing {
    /// Begins to overwrite a word.
    pub(crate) fn over(word: usize) -> Typing {
        Typing {
            word: Some(word),
            fresh: Fresh::Yes,
            ..Typing::default()
        }
    }

    /// What a key enters into a field.
    pub(crate) fn key(&mut self, field: &mut Field, key: Key, setting: &Setting) -> Result<(), MessageId> {
        let ask = field.slot.ask;
        if ask.is_text() {
            let character = key.character().ok_or(KeyNonFunctional)?;
            return self.character(field, character, setting);
        }
        if let Ask::Choice(choices) = ask {
            return self.choose(field, choices, key);
        }
        if ask == Ask::M && self.m_word(field, key) {
            return Ok(());
        }
        if let Some(axis) = setting.axis(key) {
            return self.axis(field, axis.letter(), setting);
        }
        match key {
            Key::Q if ask == Ask::M => self.m_parameter(field),
            Key::Sign => self.sign(field),
            Key::Q if ask.takes_q() => {
                let fresh = self.fresh;
                let word = self.begun(field)?;
                let negative = match fresh {
                    Fresh::No => word.value.starts_with('-'),
                    fresh => fresh == Fresh::Negative,
                };
                word.value = if negative { "-Q" } else { "Q" }.to_owned();
                self.fresh = Fresh::No;
                Ok(())
            }
            Key::I if ask.takes_incremental() => {
                self.make_incremental(field);
                Ok(())
            }
            Key::Point if ask.has_decimals() || ask == Ask::M => self.digit(field, '.'),
            _ => {
                let digit = key.digit().and(key.character()).ok_or(KeyNonFunctional)?;
                self.digit(field, digit)
            }
        }
    }

    /// Begins a word that belongs to the M function that is entered, by its letter; whether there is one.
    fn m_word(&mut self, field: &mut Field, key: Key) -> bool {
        let word = self.word.and_then(|word| field.words.get_mut(word));
        let (Some(word), Some(letter)) = (word, key.character()) else {
            return false;
        };
        let mut words = word.value.split(' ');
        let code = words
            .next()
            .and_then(|code| code.parse().ok())
            .unwrap_or_default();
        let rest = m_words(code)
            .find(|(known, _)| *known == letter)
            .map(|(_, rest)| rest);
        let twice = words.any(|word| word.starts_with(letter));
        let Some(rest) = rest.filter(|_| !twice) else {
            return false;
        };
        word.value = format!("{} {letter}{rest}", word.value);
        self.fresh = Fresh::No;
        true
    }

    /// A Q parameter as the value of such a word.
    fn m_parameter(&mut self, field: &mut Field) -> Result<(), MessageId> {
        let word = self.word.and_then(|word| field.words.get_mut(word));
        let word = word.ok_or(KeyNonFunctional)?;
        let last = word.value.rsplit_once(' ').map(|(_, last)| last);
        let begun = last.is_some_and(|last| last.trim_start_matches(is_address).is_empty());
        begun.then(|| word.value.push('Q')).ok_or(KeyNonFunctional)
    }

    /// `I` stands before the axis key [003:2585-2587]: after a value it is for the axis that comes next.
    fn make_incremental(&mut self, field: &mut Field) {
        let axes = matches!(field.slot.ask, Ask::Coordinates { .. });
        match self.word.and_then(|word| field.words.get_mut(word)) {
            Some(word) if word.address == TABLE_LINE => {}
            Some(word) if !axes || word.value.is_empty() || self.fresh != Fresh::No => {
                word.incremental = !word.incremental
            }
            _ => self.incremental = !self.incremental,
        }
    }

    /// No axis came after `I`: it was meant for the word that is entered.
    pub(crate) fn settle(&mut self, field: &mut Field) {
        if let Some(word) = self.word.and_then(|word| field.words.get_mut(word))
            && std::mem::take(&mut self.incremental)
        {
            word.incremental = !word.incremental;
        }
    }

    /// A character of a text.
    pub(crate) fn character(
        &mut self,
        field: &mut Field,
        character: char,
        setting: &Setting,
    ) -> Result<(), MessageId> {
        let most = match field.slot.ask {
            Ask::Name => usize::from(setting.model.limits().program_name_max),
            Ask::Text => TEXT_MAX,
            _ => return Err(KeyNonFunctional),
        };
        if NO_TEXT.contains(&character) || (field.slot.ask == Ask::Name && character == ';') {
            return Err(EntryValueIncorrect);
        }
        // A name is entered anew, other text goes on.
        let anew = std::mem::take(&mut self.fresh) == Fresh::Yes && field.slot.ask == Ask::Name;
        let word = self.begun(field)?;
        if anew {
            word.value.clear();
        }
        if word.value.chars().count() >= most {
            return Err(EntryValueIncorrect);
        }
        word.value.push(character);
        Ok(())
    }

    /// The word that is being entered; begins one where a value stands by itself.
    fn begun<'f>(&mut self, field: &'f mut Field) -> Result<&'f mut Word, MessageId> {
        let count = field.words.len();
        let index = match self.word.filter(|word| *word < count) {
            Some(word) => word,
            None if let Some(letter) = field.in_turn() => {
                field.words.push(Word {
                    incremental: std::mem::take(&mut self.incremental),
                    address: letter.to_owned(),
                    value: String::new(),
                });
                (self.fresh, self.in_turn) = (Fresh::No, true);
                count
            }
            None if !field.slot.ask.begins_with_value() => return Err(KeyNonFunctional),
            None if field.slot.ask.is_list() || count == 0 => {
                let incremental = std::mem::take(&mut self.incremental);
                field.words.push(Word {
                    incremental,
                    address: field.slot.address.to_owned(),
                    value: String::new(),
                });
                self.fresh = Fresh::No;
                count
            }
            None => {
                self.fresh = Fresh::Yes;
                count - 1
            }
        };
        self.word = Some(index);
        field.words.get_mut(index).ok_or(KeyNonFunctional)
    }

    /// Begins a word of the field's address, with no value yet.
    pub(crate) fn begin(&mut self, field: &mut Field) {
        self.take(field, "");
        self.fresh = Fresh::No;
    }

    fn digit(&mut self, field: &mut Field, digit: char) -> Result<(), MessageId> {
        let m = field.slot.ask == Ask::M;
        let word = self.begun(field)?;
        let whole = word.address == TABLE_LINE;
        match std::mem::take(&mut self.fresh) {
            Fresh::No if word.value != "MAX" => {}
            Fresh::Negative => word.value = "-".to_owned(),
            _ => word.value.clear(),
        }
        // Words that belong to an M function stand after it, each with its letter.
        let (after_m, number) = match word.value.rsplit_once(' ').filter(|_| m) {
            Some((_, last)) => (true, last.trim_start_matches(is_address)),
            None => (false, word.value.trim_start_matches('-')),
        };
        let full = match number.strip_prefix('Q') {
            Some(_) if digit == '.' => return Err(KeyNonFunctional),
            Some(digits) => digits.len() >= Q_DIGITS_MAX,
            None if digit == '.' && (number.contains('.') || whole || m != after_m) => {
                return Err(KeyNonFunctional);
            }
            None if m && !after_m => number.len() >= M_DIGITS_MAX,
            None => number.len() >= NUMBER_MAX,
        };
        if full {
            return Err(EntryValueIncorrect);
        }
        word.value.push(digit);
        Ok(())
    }

    /// The sign may be keyed before, during or after the number [003:1742].
    fn sign(&mut self, field: &mut Field) -> Result<(), MessageId> {
        if field.slot.ask == Ask::Direction {
            let word = field.words.last_mut().ok_or(KeyNonFunctional)?;
            word.value = if word.value == "+" { "-" } else { "+" }.to_owned();
            return Ok(());
        }
        if field.slot.ask.signs() == Signs::None {
            return Err(KeyNonFunctional);
        }
        let word = self.begun(field)?;
        if word.address == TABLE_LINE {
            return Err(KeyNonFunctional);
        }
        word.value = match word.value.strip_prefix('-') {
            Some(number) => number.to_owned(),
            None => format!("-{}", word.value),
        };
        self.fresh = match self.fresh {
            Fresh::No => Fresh::No,
            Fresh::Yes => Fresh::Negative,
            Fresh::Negative => Fresh::Yes,
        };
        Ok(())
    }

    /// An axis key: its word is entered next.
    fn axis(&mut self, field: &mut Field, letter: char, setting: &Setting) -> Result<(), MessageId> {
        let most = field.slot.ask.most(setting.model.limits());
        self.in_turn = false;
        let mut word = Word {
            incremental: std::mem::take(&mut self.incremental),
            address: letter.to_string(),
            value: String::new(),
        };
        match field.slot.ask {
            Ask::Coordinates { prefix, .. } => {
                word.address.insert_str(0, prefix);
                // An axis without a value was a wrong key.
                if let Some(open) = self.word.take()
                    && field.words.get(open).is_some_and(|open| open.value.is_empty())
                {
                    field.words.remove(open);
                }
                if let Some(known) = field.words.iter().position(|known| known.address == word.address) {
                    if let Some(known) = field.words.get_mut(known).filter(|_| word.incremental) {
                        known.incremental = true;
                    }
                    *self = Typing::over(known);
                    return Ok(());
                }
            }
            Ask::Axes(_) if field.words.contains(&word) => return Ok(()),
            Ask::Axes(1) => field.words.clear(),
            Ask::Axes(_) => {}
            Ask::Direction => {
                word.value.push('+');
                field.words.clear();
            }
            _ => return Err(KeyNonFunctional),
        }
        if field.words.len() >= most {
            return Err(KeyNonFunctional);
        }
        field.words.push(word);
        self.word = matches!(field.slot.ask, Ask::Coordinates { .. }).then(|| field.words.len() - 1);
        self.fresh = Fresh::No;
        Ok(())
    }

    fn choose(&mut self, field: &mut Field, choices: &[Choice], key: Key) -> Result<(), MessageId> {
        let of_key = choices.iter().find(|choice| choice.key == Some(key));
        let chosen = field.words.first().map(|word| word.value.as_str());
        let of_sign = choices
            .iter()
            .find(|choice| key == Key::Sign && choice.value.len() == 1 && Some(choice.value) != chosen);
        let choice = of_key.or(of_sign).ok_or(KeyNonFunctional)?;
        self.take(field, choice.value);
        Ok(())
    }

    /// Takes an answer as it is; of coordinates the address.
    pub(crate) fn take(&mut self, field: &mut Field, value: &str) {
        if let Ask::Coordinates { .. } = field.slot.ask {
            field.words = vec![Word {
                address: value.to_owned(),
                ..Word::default()
            }];
            (self.word, self.fresh) = (Some(0), Fresh::No);
            return;
        }
        field.words = vec![Word {
            incremental: false,
            address: field.slot.address.to_owned(),
            value: value.to_owned(),
        }];
        *self = Typing::over(0);
    }

    /// CE: erases what was entered wrongly; of a text the last character. An axis stays until CE is pressed again.
    pub(crate) fn clear(&mut self, field: &mut Field) {
        self.incremental = false;
        let last = field.words.len().saturating_sub(1);
        let index = self.word.unwrap_or(last);
        let Some(word) = field.words.get_mut(index) else {
            return;
        };
        let was_empty = word.value.is_empty();
        match field.slot.ask.is_text() {
            true => drop(word.value.pop()),
            false => word.value.clear(),
        }
        let keeps_axis = matches!(field.slot.ask, Ask::Coordinates { .. }) && !was_empty;
        if word.value.is_empty() && !keeps_axis {
            field.words.remove(index);
            *self = Typing::default();
        } else {
            self.word = Some(index);
            self.fresh = Fresh::No;
        }
    }
}
