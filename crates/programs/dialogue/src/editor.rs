//! The editor: a program, a cursor, and what is open.

use std::sync::Arc;

use bahn_parameters::MessageId::{
    self, EntryValueIncorrect, FurtherProgramEntryImpossible, KeyNonFunctional, ProtectedPgm,
};
use bahn_program::{Edit, Program};

use crate::blocks::BLOCKS;
use crate::check::Context;
use crate::dialogue::{Dialogue, Source, Step};
use crate::entry::Entry;
use crate::field::Ask;
use crate::highlight::Highlight;
use crate::history::History;
use crate::line::{Line, WordPlace, written};
use crate::menu::{Choice, Menu, MenuKind};
use crate::reading::line_of_block;
use crate::soft_keys::{self, Labelled, Soft};
use crate::{Key, KeyGroup, Reaction, Setting, Wanted};

/// The key of a comment.
const COMMENT: &str = ";";

/// What the keys go to.
#[derive(Clone, Debug)]
pub(crate) enum Open {
    Nothing,
    Dialogue(Box<Dialogue>),
    Highlight(Box<Highlight>),
    Menu(Box<Menu>),
    /// A block of DIN/ISO as text.
    Entry(Box<Entry>),
    /// GOTO with the digits so far.
    Goto(String),
    /// The text to find so far.
    Find(String),
}

/// Programming by dialogue: takes keys, changes a program, says what is to be shown.
///
/// While nothing is open, arrows and GOTO go from block to block, a key of a block opens its dialogue after the cursor,
/// CYCL DEF, TOUCH PROBE and Q open lists, DEL deletes the block, the cycle from its last block, or the marked section.
///
/// In a dialogue ENT takes the answer and goes on, NO ENT passes over the question, END makes the block of what is there,
/// DEL drops it, CE erases the value, LEFT and RIGHT go to other questions. Nothing stands in the program before the
/// last answer: a cycle is one edit.
///
/// RIGHT highlights a word of the block at the cursor. Digits overwrite it; LEFT, RIGHT, END, UP and DOWN confirm, the
/// latter two find the same word in other blocks. NO ENT deletes the word, ENT opens the dialogue from there.
///
/// The comment of a block stands after its last word: RIGHT goes there on controls with an alpha keyboard, `;` while
/// the block is open, and a soft key. `;` while nothing is open begins a comment in a block of its own.
///
/// Blocks of DIN/ISO are text: keys write their letters, those of the contour the G functions that do the same. END, ENT
/// and `*` close a block, which has its number from the control [000:6885]; a fault highlights its word. RIGHT goes into a
/// block word by word as above.
///
/// A program is never changed in its place: whoever holds an older version keeps it.
///
/// ```
/// use std::sync::Arc;
/// use bahn_dialogue::{Editor, Key, Reaction, Setting};
/// use bahn_parameters::{ControlModel, ParameterList};
/// use bahn_program::Program;
///
/// let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc360));
/// let program = Program::from_bytes("7.H", b"0 BEGIN PGM 7 MM\n1 END PGM 7 MM\n".to_vec());
/// let mut editor = Editor::new(Arc::new(program), setting);
/// for name in "L X 1 0 Y SIGN 5 POINT 5 ENT RL ENT 2 0 0 ENT".split(' ') {
///     editor.key(Key::from_name(name).unwrap());
/// }
/// assert_eq!(editor.view(2, 2).question.unwrap().prompt, "MISCELLANEOUS FUNCTION M?");
/// assert_eq!(editor.key(Key::NoEnt), Reaction::Edited);
/// assert_eq!(editor.program().text_of(1), "L X+10 Y-5.5 RL F200");
/// ```
#[derive(Clone, Debug)]
pub struct Editor {
    pub(crate) program: Arc<Program>,
    pub(crate) setting: Setting,
    pub(crate) cursor: u32,
    pub(crate) open: Open,
    pub(crate) message: Option<MessageId>,
    pub(crate) soft_row: usize,
    pub(crate) mark: Option<u32>,
    pub(crate) clipboard: Vec<String>,
    pub(crate) sought: String,
    pub(crate) history: History,
}

impl Editor {
    /// An editor at the beginning of a program.
    pub fn new(program: Arc<Program>, setting: Setting) -> Editor {
        Editor {
            program,
            setting,
            cursor: 0,
            open: Open::Nothing,
            message: None,
            soft_row: 0,
            mark: None,
            clipboard: Vec::new(),
            sought: String::new(),
            history: History::default(),
        }
    }

    /// The program as it is now, without what is still being entered.
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// The program as its file is to be: where the file has block numbers they are written anew, since the control
    /// generates them [003:1774].
    pub fn numbered(&self) -> Arc<Program> {
        let has_numbers = self
            .program
            .text_of(0)
            .starts_with(|first: char| first.is_ascii_digit());
        let new = match has_numbers {
            true => self.program.edit(&Edit::Renumber { step: 1 }).ok(),
            false => None,
        };
        new.map_or_else(|| Arc::clone(&self.program), Arc::new)
    }

    /// The block at the cursor.
    pub fn cursor(&self) -> u32 {
        self.cursor
    }

    /// What the editor knows of its control and machine.
    pub fn setting(&self) -> &Setting {
        &self.setting
    }

    /// The language of the dialogue, the axes or limits have changed; what is open stays.
    pub fn set_setting(&mut self, setting: Setting) {
        self.setting = setting;
    }

    /// Goes to a block, if nothing is open.
    pub fn go_to(&mut self, block: u32) -> bool {
        let free = matches!(self.open, Open::Nothing);
        if free {
            self.cursor = block.min(self.last());
        }
        free
    }

    /// Whether a dialogue, a list or a value is open.
    pub fn is_open(&self) -> bool {
        match &self.open {
            Open::Nothing => false,
            Open::Highlight(highlight) => highlight.is_changed(),
            Open::Entry(entry) => entry.is_changed(),
            _ => true,
        }
    }

    /// The message in the header.
    pub fn message(&self) -> Option<MessageId> {
        self.message
    }

    /// What a key does.
    pub fn key(&mut self, key: Key) -> Reaction {
        let others = matches!(key, Key::Graphics | Key::Magn | Key::Start);
        if key.group() == KeyGroup::Mode || (key.group() == KeyGroup::Files && key != Key::PgmCall) || others
        {
            return Reaction::Passed;
        }
        if key == Key::Ce && self.message.take().is_some() && !self.is_open() {
            return Reaction::Shown;
        }
        let done = match key {
            Key::SkLeft | Key::SkRight => self.other_soft_row(key == Key::SkRight),
            _ => match key.soft_key() {
                Some(number) => self.soft_key(number),
                None => self.other_key(key),
            },
        };
        self.reaction(done)
    }

    /// Characters of a text that is being entered; elsewhere the keys of those characters.
    pub fn type_text(&mut self, text: &str) -> Reaction {
        let mut last = Reaction::Shown;
        for character in text.chars() {
            if matches!(self.open, Open::Entry(_)) || (self.is_iso() && matches!(self.open, Open::Nothing)) {
                let done = self.iso_character(character);
                last = self.reaction(done);
                continue;
            }
            let mut text = [0; 4];
            let text = character.encode_utf8(&mut text);
            let taken = match &mut self.open {
                Open::Dialogue(dialogue) if dialogue.current().is_some_and(|it| it.slot.ask.is_text()) => {
                    Some(dialogue.take(text, &self.setting))
                }
                Open::Highlight(highlight) if highlight.ask().is_some_and(|ask| ask.is_text()) => {
                    Some(highlight.take(text, &self.setting))
                }
                Open::Find(sought) => {
                    sought.push(character);
                    Some(Ok(()))
                }
                _ => None,
            };
            last = match taken {
                Some(done) => self.reaction(done.map(|()| Reaction::Shown)),
                None if text == COMMENT => {
                    let done = match self.open {
                        Open::Nothing => self.new_comment(),
                        _ => self.comment(),
                    };
                    self.reaction(done)
                }
                None => match Key::of_character(character) {
                    Some(key) => self.key(key),
                    None => self.reaction(Err(KeyNonFunctional)),
                },
            };
        }
        last
    }

    pub(crate) fn reaction(&mut self, done: Result<Reaction, MessageId>) -> Reaction {
        match done {
            Ok(reaction) => {
                self.message = None;
                reaction
            }
            Err(message) => {
                self.message = Some(message);
                Reaction::Refused(message)
            }
        }
    }

    pub(crate) fn last(&self) -> u32 {
        self.program.block_count().saturating_sub(1)
    }

    fn other_key(&mut self, key: Key) -> Result<Reaction, MessageId> {
        let before = self.spot();
        let done = self.open_key(key);
        if self.spot() != before {
            self.soft_row = 0;
        }
        done
    }

    /// What the soft keys belong to.
    fn spot(&self) -> (u8, usize, usize) {
        match &self.open {
            Open::Nothing => (0, 0, 0),
            Open::Dialogue(dialogue) => (1, dialogue.line, dialogue.field),
            Open::Highlight(highlight) => match highlight.place {
                Some((field, _)) => (2, field, highlight.block as usize),
                None => (3, 0, 0),
            },
            Open::Menu(_) => (4, 0, 0),
            Open::Entry(_) => (7, 0, 0),
            Open::Goto(_) => (5, 0, 0),
            Open::Find(_) => (6, 0, 0),
        }
    }

    fn open_key(&mut self, key: Key) -> Result<Reaction, MessageId> {
        match std::mem::replace(&mut self.open, Open::Nothing) {
            Open::Nothing => self.program_key(key),
            Open::Dialogue(dialogue) => self.dialogue_key(dialogue, key),
            Open::Highlight(highlight) => self.highlight_key(highlight, key),
            Open::Menu(menu) => self.menu_key(menu, key),
            Open::Entry(entry) => self.entry_key(entry, key),
            Open::Goto(digits) => self.goto_key(digits, key),
            Open::Find(text) => self.find_key(text, key),
        }
    }

    pub(crate) fn show(&mut self, open: Open) -> Result<Reaction, MessageId> {
        self.open = open;
        Ok(Reaction::Shown)
    }

    /// A key while nothing is open.
    pub(crate) fn program_key(&mut self, key: Key) -> Result<Reaction, MessageId> {
        match key {
            Key::Up => {
                self.cursor = self.cursor.saturating_sub(1);
                return Ok(Reaction::Shown);
            }
            Key::Down => {
                self.cursor = (self.cursor + 1).min(self.last());
                return Ok(Reaction::Shown);
            }
            Key::Right if !self.is_iso() => return self.highlight(self.cursor, None),
            Key::Goto => return self.show(Open::Goto(String::new())),
            Key::Ce => return Ok(Reaction::Shown),
            Key::Del => return self.delete(),
            Key::Capture => {
                self.may_insert()?;
                return Ok(Reaction::Position(Wanted::Block));
            }
            _ if self.is_iso() => return self.iso_key(key),
            _ => {}
        }
        let menu = match key {
            Key::CyclDef => Some(MenuKind::Cycles),
            Key::TouchProbe => Some(MenuKind::Probes),
            Key::Q => Some(MenuKind::Functions),
            _ => None,
        };
        if let Some(kind) = menu {
            self.may_insert()?;
            let menu = Menu::new(kind, &self.setting);
            return self.show(Open::Menu(Box::new(menu)));
        }
        if let Some(row) = BLOCKS.iter().find(|row| row.key == Some(key)) {
            self.may_insert()?;
            return self.show(Open::Dialogue(Box::new(Dialogue::new(
                Source::Row(row),
                &self.setting,
            ))));
        }
        let id = match self.setting.axis(key) {
            Some(_) if self.setting.paraxial_inhibited => return Err(KeyNonFunctional),
            Some(_) => "AXIS",
            // I before the axis key [003:2585-2587].
            None if key == Key::I && !self.setting.paraxial_inhibited => "AXIS",
            None if key.group() == KeyGroup::Letter => "TEXT",
            None => return Err(KeyNonFunctional),
        };
        self.may_insert()?;
        self.new_block(id, key)
    }

    /// Opens a dialogue with the first key in it.
    fn new_block(&mut self, id: &str, key: Key) -> Result<Reaction, MessageId> {
        let mut dialogue = Dialogue::of_id(id, &self.setting).ok_or(KeyNonFunctional)?;
        dialogue.key(key, self.context(None))?;
        self.show(Open::Dialogue(Box::new(dialogue)))
    }

    /// A comment in a block of its own.
    fn new_comment(&mut self) -> Result<Reaction, MessageId> {
        self.may_insert()?;
        let mut dialogue = Dialogue::of_id("TEXT", &self.setting).ok_or(KeyNonFunctional)?;
        dialogue.take(COMMENT, &self.setting)?;
        self.show(Open::Dialogue(Box::new(dialogue)))
    }

    pub(crate) fn context(&self, replaces: Option<u32>) -> Context<'_> {
        Context {
            setting: &self.setting,
            program: &self.program,
            replaces,
        }
    }

    pub(crate) fn may_edit(&self) -> Result<(), MessageId> {
        match self.program.is_protected() {
            true => Err(ProtectedPgm),
            false => Ok(()),
        }
    }

    /// Blocks stand after any block but END [003:1768-1774].
    pub(crate) fn may_insert(&self) -> Result<(), MessageId> {
        self.may_edit()?;
        match self.cursor < self.last() {
            true => Ok(()),
            false => Err(KeyNonFunctional),
        }
    }

    fn menu_key(&mut self, mut menu: Box<Menu>, key: Key) -> Result<Reaction, MessageId> {
        let choice = menu.key(key, &self.setting);
        match choice {
            Ok(Choice::Close) => Ok(Reaction::Shown),
            Ok(Choice::Open(dialogue)) => self.show(Open::Dialogue(dialogue)),
            Ok(Choice::Stay) => {
                self.open = Open::Menu(menu);
                Ok(Reaction::Shown)
            }
            Err(message) => {
                self.open = Open::Menu(menu);
                Err(message)
            }
        }
    }

    fn dialogue_key(&mut self, mut dialogue: Box<Dialogue>, key: Key) -> Result<Reaction, MessageId> {
        if key == Key::Capture {
            let wanted = dialogue.wants_position();
            self.open = Open::Dialogue(dialogue);
            return wanted.map(Reaction::Position).ok_or(KeyNonFunctional);
        }
        let step = dialogue.key(key, self.context(dialogue.replaces));
        let done = match step {
            Ok(Step::Drop) => return Ok(Reaction::Shown),
            Ok(Step::Finish) => self.finish(&dialogue),
            Ok(Step::Stay) => Ok(None),
            Err(message) => Err(message),
        };
        match done {
            Ok(Some(edited)) => Ok(edited),
            done => {
                self.open = Open::Dialogue(dialogue);
                done.map(|_| Reaction::Shown)
            }
        }
    }

    /// The blocks of a dialogue become blocks of the program.
    fn finish(&mut self, dialogue: &Dialogue) -> Result<Option<Reaction>, MessageId> {
        let lines = dialogue.made();
        let texts = lines.iter().map(|line| self.block_text(line));
        let texts: Vec<String> = texts.collect::<Result<_, _>>()?;
        if let Some(block) = dialogue.replaces {
            return self.replace(block, &texts.join("\n")).map(Some);
        }
        self.insert(&texts).map(Some)
    }

    /// A line as it is written into the program: as the manual prints it, free text as listings show it.
    pub(crate) fn block_text(&self, line: &Line) -> Result<String, MessageId> {
        let language = self.program.language();
        let text = line.text();
        let read = language.parse_block(&text);
        match read.faults.first() {
            Some(fault) => Err(fault.message),
            None if line.has_text() => Ok(written(&read.block, language)),
            None => Ok(text),
        }
    }

    /// Puts blocks after the cursor, which goes to the last of them.
    pub(crate) fn insert(&mut self, texts: &[String]) -> Result<Reaction, MessageId> {
        match self.is_iso() {
            true => self.insert_numbered(texts),
            false => self.insert_blocks(&texts.join("\n")),
        }
    }

    /// The same with text as it stands.
    pub(crate) fn insert_blocks(&mut self, text: &str) -> Result<Reaction, MessageId> {
        self.may_insert()?;
        let before = self.cursor + 1;
        let old = self.program.block_count();
        self.apply(&Edit::Insert { before, text })?;
        self.cursor += self.program.block_count().saturating_sub(old);
        Ok(Reaction::Edited)
    }

    pub(crate) fn replace(&mut self, block: u32, text: &str) -> Result<Reaction, MessageId> {
        self.may_edit()?;
        let language = self.program.language();
        let old = language.parse_block(&self.program.text_of(block)).block;
        if old == language.parse_block(text).block {
            return Ok(Reaction::Shown);
        }
        self.apply(&Edit::Replace { block, text })?;
        Ok(Reaction::Edited)
    }

    /// A new version of the program; the old one can be had back.
    pub(crate) fn apply(&mut self, edit: &Edit<'_>) -> Result<(), MessageId> {
        self.apply_all(std::slice::from_ref(edit))
    }

    /// The same after several edits, in one step.
    pub(crate) fn apply_all(&mut self, edits: &[Edit<'_>]) -> Result<(), MessageId> {
        let mut new = Arc::clone(&self.program);
        for edit in edits {
            new = Arc::new(new.edit(edit).map_err(|error| error.message())?);
        }
        let full = self.setting.bytes_max < Program::MAX_BYTES
            && new.to_bytes().len() as u64 > self.setting.bytes_max
            && !matches!(edits, [Edit::Delete { .. }]);
        if full {
            return Err(FurtherProgramEntryImpossible);
        }
        self.history.keep(&self.program, self.cursor);
        self.program = new;
        self.mark = None;
        Ok(())
    }

    /// The words of a block; none of BEGIN and END, which are the control's.
    pub(crate) fn line_of(&self, number: u32) -> Option<Line> {
        let chunk = self.program.decode(number / Program::CHUNK_SIZE);
        let block = chunk.blocks.get((number % Program::CHUNK_SIZE) as usize)?;
        line_of_block(block, self.program.language())
    }

    pub(crate) fn highlight(&mut self, block: u32, place: WordPlace) -> Result<Reaction, MessageId> {
        let line = self.line_of(block).ok_or(KeyNonFunctional)?;
        let places = line.places();
        let place = match place {
            // A line of text is entered as a whole.
            None if line.is_text() => Some((0, 0)),
            None => places.first().copied().flatten(),
            place => place,
        };
        self.cursor = block;
        self.show(Open::Highlight(Box::new(Highlight::new(block, line, place))))
    }

    fn goto_key(&mut self, mut digits: String, key: Key) -> Result<Reaction, MessageId> {
        match key {
            Key::Ent => {
                let number = digits
                    .parse::<u32>()
                    .ok()
                    .and_then(|number| self.program.block_of(number));
                let Some(number) = number else {
                    self.open = Open::Goto(digits);
                    return Err(EntryValueIncorrect);
                };
                self.cursor = number;
                return Ok(Reaction::Shown);
            }
            Key::End | Key::NoEnt | Key::Del => return Ok(Reaction::Shown),
            Key::Ce | Key::Goto => digits.clear(),
            _ => {
                let digit = key.digit().and(key.character()).filter(|_| digits.len() < 9);
                let Some(digit) = digit else {
                    self.open = Open::Goto(digits);
                    return Err(KeyNonFunctional);
                };
                digits.push(digit);
            }
        }
        self.open = Open::Goto(digits);
        Ok(Reaction::Shown)
    }

    /// The soft keys of what is open, all rows.
    pub(crate) fn soft_keys(&self) -> Vec<Labelled> {
        let setting = &self.setting;
        match &self.open {
            Open::Nothing => soft_keys::of_program(self.mark.is_some(), self.is_iso(), setting.tongue),
            Open::Entry(_) => soft_keys::characters(soft_keys::ISO_CHARACTERS, setting.tongue),
            Open::Dialogue(dialogue) => soft_keys::of_dialogue(dialogue, setting),
            Open::Highlight(highlight) => match highlight.ask() {
                Some(ask) => {
                    let word = highlight.line.word(highlight.place);
                    soft_keys::answers(ask, word.map_or("", |word| word.address.as_str()), setting)
                }
                None => Vec::new(),
            },
            Open::Find(_) => soft_keys::answers(Ask::Text, "", setting),
            Open::Menu(_) | Open::Goto(_) => Vec::new(),
        }
    }

    fn other_soft_row(&mut self, right: bool) -> Result<Reaction, MessageId> {
        let rows = self.soft_keys().len().div_ceil(soft_keys::ROW).max(1);
        let step = if right { 1 } else { rows - 1 };
        self.soft_row = (self.soft_row + step) % rows;
        Ok(Reaction::Shown)
    }

    fn soft_key(&mut self, number: usize) -> Result<Reaction, MessageId> {
        let keys = self.soft_keys();
        let (_, soft) = keys
            .get(self.soft_row * soft_keys::ROW + number)
            .ok_or(KeyNonFunctional)?;
        match soft {
            Soft::Function(function) => self.function(*function),
            Soft::Answer(value) if matches!(self.open, Open::Entry(_)) => {
                let mut last = Reaction::Shown;
                for character in value.chars() {
                    last = self.iso_character(character)?;
                }
                Ok(last)
            }
            Soft::Answer(value) => {
                match &mut self.open {
                    Open::Dialogue(dialogue) => dialogue.take(value, &self.setting)?,
                    Open::Highlight(_) if self.program.is_protected() => return Err(ProtectedPgm),
                    Open::Highlight(highlight) => highlight.take(value, &self.setting)?,
                    Open::Find(text) => text.push_str(value),
                    _ => return Err(KeyNonFunctional),
                }
                Ok(Reaction::Shown)
            }
        }
    }
}
