//! DIN/ISO at the editor: blocks are text, entered word by word; their numbers are the control's [000:6885].
//!
//! Whatever is said of words, labels and limits while a block is entered, is said with the messages of the control; a
//! word that no block can have is refused as soon as the next one begins.
//!
//! Decision: Blocks of DIN/ISO are entered as text and stand in the program as listings show them; keys of contour,
//! tools and labels write the G function that does the same, soft keys the letters; a word that no block can have is
//! refused when the next one begins, the rest at END, ENT or `*`
//!
//! Decision: New blocks of DIN/ISO get numbers in steps of MP7220, closer between two blocks that leave less room;
//! without room all get new ones; RENUMBER N does it at any time

use std::sync::Arc;

use bahn_parameters::MessageId::{
    self, AxisDoubleProgrammed, BlockNotKnown, EntryValueIncorrect, KeyNonFunctional,
};
use bahn_path::Axis;
use bahn_program::{BlockError, Edit, Program, WordKind, WordSpan};

use crate::editor::{Editor, Open};
use crate::entry::{Entry, Place};
use crate::line::written;
use crate::{Key, Reaction, Wanted};

/// The words that keys without a character write: those of the contour and of tools and cycles the G functions that do
/// the same *(inferred)*, so that a keyboard without letters has them.
const WRITTEN: &[(Key, &str)] = &[
    (Key::Cr, "G02"),
    (Key::Ct, "G06"),
    (Key::Cc, "G29"),
    (Key::Rnd, "G25 R"),
    (Key::Chf, "G24 R"),
    (Key::ToolDef, "G99 T"),
    (Key::ToolCall, "T"),
    (Key::Rl, "G41"),
    (Key::Rr, "G42"),
    (Key::RPlus, "G43"),
    (Key::RMinus, "G44"),
    (Key::CyclDef, "G"),
    (Key::CyclCall, "G79"),
    (Key::LblSet, "G98 L"),
    (Key::LblCall, "L"),
    (Key::PgmCall, "%"),
    (Key::Stop, "G38"),
    (Key::TouchProbe, "G55"),
    (Key::BlkForm, "G30"),
];

/// What the prompt for a word is, by its address, where a function in the block has it mean that.
const PROMPTS: &[(&str, &str, &str)] = &[
    ("R", "G24", "chamfer"),
    ("R", "G25", "rounding"),
    ("R", "G99", "tool_radius"),
    ("R", "G1", "polar_radius"),
    ("R", "", "circle_radius"),
    ("H", "", "polar_angle"),
    ("L", "G99", "tool_length"),
    ("L", "", "label"),
    ("F", "", "feed"),
    ("M", "", "m"),
    ("S", "", "speed"),
    ("T", "", "tool_number"),
    ("DL", "", "delta_length"),
    ("DR", "", "delta_radius"),
    ("%", "", "program"),
    (";", "", "comment"),
    ("P", "", "parameters"),
    ("Q", "", "parameters"),
    ("I", "", "coordinates"),
    ("J", "", "coordinates"),
    ("K", "", "coordinates"),
];

/// What a key writes into a block.
fn written_by(key: Key, editor: &Editor) -> Option<String> {
    let axis = match key {
        Key::Iv | Key::V => editor.setting.axis(key),
        _ => None,
    };
    let row = WRITTEN.iter().find(|(of, _)| *of == key);
    axis.map(|axis| axis.to_string())
        .or_else(|| row.map(|(_, text)| (*text).to_owned()))
        .or_else(|| key.character().map(String::from))
}

impl Editor {
    /// Whether blocks are entered as text, with numbers of their own.
    pub(crate) fn is_iso(&self) -> bool {
        self.program.language().has_numbers()
    }

    /// A key while nothing is open that begins a block or goes into one.
    pub(crate) fn iso_key(&mut self, key: Key) -> Result<Reaction, MessageId> {
        if key == Key::Right {
            let entry = self.entry_of(self.cursor, Place::Word(0))?;
            return self.show(Open::Entry(Box::new(entry)));
        }
        if key == Key::Sign {
            return Err(KeyNonFunctional);
        }
        let text = written_by(key, self).ok_or(KeyNonFunctional)?;
        self.iso_text(&text)
    }

    /// Begins a block with some text.
    pub(crate) fn iso_text(&mut self, text: &str) -> Result<Reaction, MessageId> {
        self.may_insert()?;
        let mut entry = Entry::new(self.program.language());
        for character in text.chars() {
            entry.character(character)?;
        }
        self.show(Open::Entry(Box::new(entry)))
    }

    /// A block that stands there, to be changed; BEGIN and END are the control's.
    pub(crate) fn entry_of(&self, block: u32, place: Place) -> Result<Entry, MessageId> {
        if block == 0 || block >= self.last() {
            return Err(KeyNonFunctional);
        }
        let language = self.program.language();
        let text = self.iso_block(block);
        let place = match place {
            Place::Word(_) if language.parse_block(&text).words.is_empty() => Place::At(0),
            place => place,
        };
        Ok(Entry::of_block(block, text, place, language))
    }

    /// A block as it is entered: without number and `*`.
    fn iso_block(&self, number: u32) -> String {
        let chunk = self.program.decode(number / Program::CHUNK_SIZE);
        let block = chunk.blocks.get((number % Program::CHUNK_SIZE) as usize);
        let text = block.map_or_else(String::new, |block| written(block, self.program.language()));
        text.trim_end().trim_end_matches('*').trim_end().to_owned()
    }

    /// A key while a block is entered.
    pub(crate) fn entry_key(&mut self, mut entry: Box<Entry>, key: Key) -> Result<Reaction, MessageId> {
        match key {
            Key::Ent | Key::End => return self.finish_entry(entry),
            Key::Del if entry.is_changed() => return Ok(Reaction::Shown),
            Key::Del => return self.delete(),
            Key::Goto if !entry.is_changed() => return self.program_key(key),
            Key::Up | Key::Down if entry.replaces.is_some() => {
                return self.same_address(entry, key == Key::Down);
            }
            _ => {}
        }
        let done = self.within(&mut entry, key);
        let leaves = done == Ok(None);
        if !leaves {
            self.open = Open::Entry(entry);
        }
        done.map(|reaction| reaction.unwrap_or(Reaction::Shown))
    }

    /// A key that goes on with the block; `None` leaves it.
    fn within(&mut self, entry: &mut Entry, key: Key) -> Result<Option<Reaction>, MessageId> {
        match key {
            Key::Left | Key::Right => {
                let went = entry.go(key == Key::Right);
                return match (went, key, entry.is_changed()) {
                    (false, Key::Left, false) => Ok(None),
                    (false, ..) => Err(KeyNonFunctional),
                    (true, ..) => Ok(Some(Reaction::Shown)),
                };
            }
            Key::Capture => {
                let wanted = entry.axis().map(Wanted::Axis).ok_or(KeyNonFunctional)?;
                return self.may_edit().map(|()| Some(Reaction::Position(wanted)));
            }
            _ => self.may_edit()?,
        }
        match key {
            Key::Ce => entry.erase()?,
            Key::NoEnt => entry.remove()?,
            Key::Sign => entry.sign()?,
            _ => {
                let text = written_by(key, self).ok_or(KeyNonFunctional)?;
                for character in text.chars() {
                    self.write(entry, character)?;
                }
            }
        }
        Ok(Some(Reaction::Shown))
    }

    /// A character while a block is entered, or one that begins a block.
    pub(crate) fn iso_character(&mut self, character: char) -> Result<Reaction, MessageId> {
        let mut text = [0; 4];
        let text = character.encode_utf8(&mut text);
        match std::mem::replace(&mut self.open, Open::Nothing) {
            Open::Entry(entry) if character == '\n' => self.finish_entry(entry),
            Open::Entry(mut entry) => {
                if entry.ends_with(character) {
                    return self.finish_entry(entry);
                }
                let done = self.may_edit().and_then(|()| self.write(&mut entry, character));
                self.open = Open::Entry(entry);
                done.map(|()| Reaction::Shown)
            }
            open => {
                self.open = open;
                match character {
                    ' ' | '\n' | '*' => Ok(Reaction::Shown),
                    _ => self.iso_text(text),
                }
            }
        }
    }

    /// Writes a character, unless a word before it is not allowed in a block.
    fn write(&self, entry: &mut Entry, character: char) -> Result<(), MessageId> {
        if entry.text.chars().count() >= self.characters_max() {
            return Err(EntryValueIncorrect);
        }
        // Whether a G function of the machine builder has parameters Q is seen by them.
        let begins = entry.begins_word(character) && !character.eq_ignore_ascii_case(&'Q');
        let at_end = matches!(entry.place, Place::At(at) if at >= entry.text.trim_end().len());
        if begins
            && at_end
            && let Some((message, column)) = self.certain(&entry.text)
        {
            entry.show(column);
            return Err(message);
        }
        entry.character(character)
    }

    /// Characters of a block, without its number.
    fn characters_max(&self) -> usize {
        let max = self
            .program
            .language()
            .characters_max(self.setting.model.limits());
        max.map_or(usize::MAX, |max| max as usize)
    }

    /// What is wrong with the words of a text, whatever comes after them, and where.
    fn certain(&self, text: &str) -> Option<(MessageId, u32)> {
        let read = self.program.language().parse_block(text);
        let last = read.words.last()?.span.start;
        let before = text.get(..last).unwrap_or_default().chars().count() as u32;
        let stays = |fault: &&BlockError| {
            // An end point that is missing may still come.
            if fault.message == MessageId::AngleReferenceMissing {
                return false;
            }
            fault.column + fault.length <= before + 1
                || (fault.column > before && matches!(fault.message, BlockNotKnown | AxisDoubleProgrammed))
        };
        if let Some(fault) = read.faults.iter().find(stays) {
            return Some((fault.message, fault.column));
        }
        let mut operation = read.block.operation;
        let checked = match read.faults.is_empty() {
            true => self.context(None).check_operation(&mut operation, false),
            false => Ok(()),
        };
        checked.err().map(|message| (message, before + 1))
    }

    /// END, ENT and `*` close the block, which stands in the program then.
    fn finish_entry(&mut self, mut entry: Box<Entry>) -> Result<Reaction, MessageId> {
        let finished = self.finished(&mut entry);
        if finished.is_err() {
            self.open = Open::Entry(entry);
        }
        finished
    }

    fn finished(&mut self, entry: &mut Entry) -> Result<Reaction, MessageId> {
        let text = entry.text.trim();
        match entry.replaces {
            Some(_) if !entry.is_changed() => return Ok(Reaction::Shown),
            None if text.is_empty() => return Ok(Reaction::Shown),
            Some(_) if text.is_empty() => return Err(EntryValueIncorrect),
            _ => {}
        }
        self.may_edit()?;
        let language = self.program.language();
        let read = language.parse_block(text);
        if let Some(fault) = read.faults.first() {
            entry.show(fault.column);
            return Err(fault.message);
        }
        let mut operation = read.block.operation.clone();
        self.context(entry.replaces)
            .check_operation(&mut operation, true)?;
        let number = self.entered_number(text, &read.words, entry.replaces)?;
        let body = written(&read.block, language);
        if body.chars().count() > self.characters_max() {
            return Err(EntryValueIncorrect);
        }
        match entry.replaces {
            Some(block) => {
                let old = self.program.own_number(block);
                let text = with_number(number.or(old), &body);
                if number.is_none_or(|number| Some(number) == old) {
                    return self.replace(block, &text);
                }
                self.apply(&Edit::Replace { block, text: &text })?;
                Ok(Reaction::Edited)
            }
            None => match number {
                Some(_) => self.insert_blocks(&with_number(number, &body)),
                None => self.insert(&[body]),
            },
        }
    }

    /// The number that was entered before the words: between those of the blocks around.
    fn entered_number(
        &self,
        text: &str,
        words: &[WordSpan],
        replaces: Option<u32>,
    ) -> Result<Option<u32>, MessageId> {
        let Some(word) = words.iter().find(|word| word.kind == WordKind::Number) else {
            return Ok(None);
        };
        let digits = text.get(word.value.clone()).unwrap_or_default();
        let number: u32 = digits.parse().map_err(|_| EntryValueIncorrect)?;
        let (before, after) = match replaces {
            Some(block) => (block.saturating_sub(1), block + 1),
            None => (self.cursor, self.cursor + 1),
        };
        let above = self
            .program
            .own_number(before)
            .is_none_or(|before| before < number);
        let below = self.program.own_number(after).is_none_or(|after| number < after);
        match number > 0 && above && below {
            true => Ok(Some(number)),
            false => Err(EntryValueIncorrect),
        }
    }

    /// Puts blocks after the cursor with the numbers of the control: in steps of MP7220, closer where there is less
    /// room; without room all blocks get new ones *(inferred)*.
    pub(crate) fn insert_numbered(&mut self, texts: &[String]) -> Result<Reaction, MessageId> {
        let step = self.setting.iso_step;
        let numbered_before = self.cursor == 0 || self.program.own_number(self.cursor).is_some();
        if step == 0 || !numbered_before {
            return self.insert_blocks(&texts.join("\n"));
        }
        let before = self.program.own_number(self.cursor).unwrap_or(0);
        let after = self.program.own_number(self.cursor + 1).unwrap_or(u32::MAX);
        let count = texts.len() as u32;
        let room = after.saturating_sub(before);
        let apart = match count.saturating_mul(step) < room {
            true => step,
            false => room / count.saturating_add(1),
        };
        let numbers = (1..).map(|place: u32| before.saturating_add(place.saturating_mul(apart.max(1))));
        let numbered = numbers
            .zip(texts)
            .map(|(number, text)| with_number(Some(number), text));
        let text = numbered.collect::<Vec<_>>().join("\n");
        if apart > 0 {
            return self.insert_blocks(&text);
        }
        let old = self.program.block_count();
        let insert = Edit::Insert {
            before: self.cursor + 1,
            text: &text,
        };
        self.apply_all(&[insert, Edit::Renumber { step }])?;
        self.cursor += self.program.block_count().saturating_sub(old);
        Ok(Reaction::Edited)
    }

    /// All blocks get new numbers: the soft key.
    pub(crate) fn renumber(&mut self) -> Result<Reaction, MessageId> {
        self.may_edit()?;
        let step = self.setting.iso_step;
        let before = Arc::clone(&self.program);
        let new = before
            .edit(&Edit::Renumber { step })
            .map_err(|error| error.message())?;
        if new.to_bytes() == before.to_bytes() {
            return Ok(Reaction::Shown);
        }
        self.apply(&Edit::Renumber { step })?;
        Ok(Reaction::Edited)
    }

    /// Finds the same word in other blocks, as in plain language [003:1744-1758].
    fn same_address(&mut self, mut entry: Box<Entry>, down: bool) -> Result<Reaction, MessageId> {
        let Some(block) = entry.replaces else {
            return Err(KeyNonFunctional);
        };
        let sought = entry.current().map(|(_, word)| {
            let text = entry.text.get(word.span.clone()).unwrap_or_default();
            name_of(text, &word)
        });
        let done = match self.finished(&mut entry) {
            Ok(done) => done,
            Err(message) => {
                self.open = Open::Entry(entry);
                return Err(message);
            }
        };
        let language = self.program.language();
        let found = sought.and_then(|sought| {
            self.search(block, down, |other| {
                let text = written(other, language);
                let words = language.parse_block(&text).words;
                let same = |word: &WordSpan| {
                    name_of(text.get(word.span.clone()).unwrap_or_default(), word) == sought
                };
                words.iter().position(same)
            })
        });
        let found = found.filter(|(block, _)| *block > 0 && *block < self.last());
        let (block, place) = found.map_or((block, entry.place), |(block, word)| (block, Place::Word(word)));
        self.cursor = block;
        let entry = self.entry_of(block, place)?;
        let text = entry.text.clone();
        let entry = match entry.with(text, place) {
            Some(entry) => entry,
            None => self.entry_of(block, Place::Word(0))?,
        };
        self.open = Open::Entry(Box::new(entry));
        Ok(done)
    }

    /// The comment after the block at the cursor, or after that which is entered.
    pub(crate) fn iso_comment(&mut self) -> Result<Reaction, MessageId> {
        let mut entry = match std::mem::replace(&mut self.open, Open::Nothing) {
            Open::Entry(entry) => entry,
            _ => Box::new(self.entry_of(self.cursor, Place::Word(0))?),
        };
        let words = entry.words();
        match words.iter().position(|word| word.kind == WordKind::Comment) {
            Some(place) => entry.place = Place::Word(place),
            None => {
                let length = entry.text.trim_end().len();
                entry.text.truncate(length);
                entry.text.push_str(if length == 0 { "; " } else { " ; " });
                entry.place = Place::At(entry.text.len());
            }
        }
        self.show(Open::Entry(entry))
    }

    /// The `/` of the block at the cursor is set or taken away.
    pub(crate) fn iso_skip(&mut self) -> Result<Reaction, MessageId> {
        let entry = self.entry_of(self.cursor, Place::At(0))?;
        let text = match entry.text.strip_prefix('/') {
            Some(text) => text.trim_start().to_owned(),
            None => format!("/ {} *", entry.text),
        };
        let number = self.program.own_number(self.cursor);
        self.replace(self.cursor, &with_number(number, &text))
    }

    /// Blocks as text without numbers.
    pub(crate) fn iso_section(&self, blocks: std::ops::Range<u32>) -> Vec<String> {
        blocks
            .map(|block| format!("{} *", self.iso_block(block)))
            .collect()
    }

    /// A block with the positions of axes, on a straight line as L has it.
    pub(crate) fn iso_position(&mut self, position: &[(Axis, String)]) -> Result<Reaction, MessageId> {
        let signed = |value: &String| {
            if value.starts_with('-') {
                value.clone()
            } else {
                format!("+{value}")
            }
        };
        let words = position
            .iter()
            .map(|(axis, value)| format!(" {axis}{}", signed(value)));
        let text = format!("G01 G90{} *", words.collect::<String>());
        let mut operation = self.program.language().parse_block(&text).block.operation;
        self.context(None).check_operation(&mut operation, true)?;
        self.insert(&[text])
    }

    /// The prompt of the word that is entered.
    pub(crate) fn iso_prompt(&self, entry: &Entry) -> &'static str {
        let Some((address, _)) = entry.current_word() else {
            return "iso";
        };
        if let [letter] = address.as_bytes()
            && Axis::from_letter(*letter).is_some()
        {
            return "coordinates";
        }
        let address = match address.as_bytes() {
            [b'P', b'0'..=b'9', ..] => "P",
            [b';', ..] => ";",
            _ => address,
        };
        let in_block = |function: &str| {
            let mut words = entry.text.split(' ');
            words.any(|word| word.starts_with(function) && word.len() == 3)
        };
        let row = PROMPTS
            .iter()
            .find(|(of, function, _)| *of == address && (function.is_empty() || in_block(function)));
        row.map_or("iso", |(_, _, prompt)| prompt)
    }
}

/// What a word is found by: the address of a value, else the whole word.
fn name_of(text: &str, word: &WordSpan) -> String {
    match word.kind {
        WordKind::Address => text
            .get(..word.value.start - word.span.start)
            .unwrap_or(text)
            .to_owned(),
        WordKind::Comment => ";".to_owned(),
        _ => text.to_owned(),
    }
}

/// A block with its number.
fn with_number(number: Option<u32>, body: &str) -> String {
    match number {
        Some(number) => format!("N{number} {body}"),
        None => body.to_owned(),
    }
}
