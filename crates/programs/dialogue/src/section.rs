//! What is done with blocks that stand in the program: highlighted words, deleting, sections, finding.
//!
//! Decision: After the last word of a block RIGHT asks for its comment on controls with an alpha keyboard; `;` asks
//! for it while a block is open, and is a block of its own while nothing is
//!
//! Decision: END in a cycle writes the blocks so far; DEL on a block of a cycle that is not its last is KEY
//! NON-FUNCTIONAL

use std::ops::Range;

use bahn_parameters::MessageId::{self, KeyNonFunctional};
use bahn_program::{Block, Chunk, Edit, Operation, Program};

use crate::dialogue::Dialogue;
use crate::editor::{Editor, Open};
use crate::highlight::Highlight;
use crate::line::{Line, written};
use crate::reading::line_of_block;
use crate::soft_keys::Function;
use crate::{Key, KeyGroup, Reaction};

/// Most characters of a text to find.
const FIND_MAX: usize = 80;

impl Editor {
    /// A key while a word is highlighted.
    pub(crate) fn highlight_key(
        &mut self,
        mut highlight: Box<Highlight>,
        key: Key,
    ) -> Result<Reaction, MessageId> {
        let text = highlight.ask().is_some_and(|ask| ask.is_text());
        let changed = highlight.is_changed();
        match key {
            Key::Del if changed => highlight.forget(),
            Key::Del => return self.delete(),
            Key::Up | Key::Down | Key::Left | Key::Right | Key::End | Key::Ent => {
                return self.leave_word(highlight, key);
            }
            Key::Goto if !changed => return self.program_key(key),
            Key::Capture => {
                let wanted = highlight.wants_position();
                self.open = Open::Highlight(highlight);
                return self
                    .may_edit()
                    .and(wanted.map(Reaction::Position).ok_or(KeyNonFunctional));
            }
            _ if !changed && !text && opens_block(&highlight, key) => return self.program_key(key),
            _ => {
                let done = self.may_edit().and_then(|()| match key {
                    Key::NoEnt => highlight.remove(),
                    _ => highlight.key(key, &self.setting),
                });
                if done.is_ok() && key == Key::NoEnt {
                    return self.leave_word(highlight, Key::NoEnt);
                }
                self.open = Open::Highlight(highlight);
                return done.map(|()| Reaction::Shown);
            }
        }
        self.open = Open::Highlight(highlight);
        Ok(Reaction::Shown)
    }

    /// Confirms the value of a word and goes on.
    fn leave_word(&mut self, mut highlight: Box<Highlight>, key: Key) -> Result<Reaction, MessageId> {
        let block = highlight.block;
        let before = highlight.place;
        highlight.settle();
        // The last word was added and got no value: the highlight is left of it already.
        let went = highlight.place < before;
        let confirmed = self.confirm(&highlight);
        let reaction = match confirmed {
            Ok(reaction) => reaction,
            Err(message) => {
                if key == Key::NoEnt {
                    highlight.forget();
                }
                self.open = Open::Highlight(highlight);
                return Err(message);
            }
        };
        match key {
            Key::Left | Key::Right => {
                let by = if key == Key::Left { -1 } else { 1 };
                let beside = match went && by < 0 {
                    true => Some(highlight.place),
                    false => highlight.beside(by),
                };
                // After the last word comes the comment, where the program may be changed.
                let may_comment = self.setting.model.has_windows() && self.may_edit().is_ok();
                let comment = by > 0 && beside.is_none() && may_comment;
                let leaves = by < 0 && (beside.is_none() || highlight.line.is_text());
                let done = leaves || (comment && self.open_comment(block).is_ok());
                if !done {
                    self.highlight(block, beside.unwrap_or(highlight.place))?;
                }
            }
            Key::NoEnt => {
                let line = self.line_of(block).ok_or(KeyNonFunctional)?;
                let places = line.places();
                let after = places.iter().find(|place| **place >= highlight.place);
                self.highlight(block, after.or(places.last()).copied().flatten())?;
            }
            Key::Up | Key::Down => self.same_word(&highlight, key == Key::Down)?,
            Key::Ent => {
                if let Err(message) = self.may_edit() {
                    self.open = Open::Highlight(highlight);
                    return Err(message);
                }
                let line = self.line_of(block).ok_or(KeyNonFunctional)?;
                let field = highlight.place.map_or(0, |(field, _)| field);
                match Dialogue::of_line(line, block, field, &self.setting) {
                    Some(dialogue) => self.show(Open::Dialogue(Box::new(dialogue)))?,
                    // Nothing is asked from here on.
                    None => Reaction::Shown,
                };
            }
            _ => {}
        }
        Ok(reaction)
    }

    /// The comment after the block: of a dialogue its question, of a highlighted word or of the block at the cursor
    /// it is highlighted.
    pub(crate) fn comment(&mut self) -> Result<Reaction, MessageId> {
        self.may_edit()?;
        if self.is_iso() {
            return self.iso_comment();
        }
        match std::mem::replace(&mut self.open, Open::Nothing) {
            Open::Dialogue(mut dialogue) => {
                let done = dialogue.comment(self.context(dialogue.replaces));
                self.open = Open::Dialogue(dialogue);
                done.map(|()| Reaction::Shown)
            }
            Open::Highlight(mut highlight) => {
                highlight.settle();
                let done = self.confirm(&highlight);
                if done.is_err() {
                    self.open = Open::Highlight(highlight);
                    return done;
                }
                self.open_comment(highlight.block).and(done)
            }
            Open::Nothing => self.open_comment(self.cursor),
            open => {
                self.open = open;
                Err(KeyNonFunctional)
            }
        }
    }

    /// Highlights the comment of a block; where there is none it is empty, to be entered.
    fn open_comment(&mut self, block: u32) -> Result<Reaction, MessageId> {
        let line = self.line_of(block).ok_or(KeyNonFunctional)?;
        let mut highlight = Highlight::new(block, line, None);
        highlight.comment()?;
        self.cursor = block;
        self.show(Open::Highlight(Box::new(highlight)))
    }

    /// What was entered becomes the block.
    fn confirm(&mut self, highlight: &Highlight) -> Result<Reaction, MessageId> {
        if !highlight.is_changed() {
            return Ok(Reaction::Shown);
        }
        self.may_edit()?;
        let block = highlight.block;
        let cycle = self.cycle_of(block).unwrap_or(block..block);
        let others = cycle.filter(|other| *other != block);
        let others: Vec<Line> = others.filter_map(|other| self.line_of(other)).collect();
        highlight.check(self.context(Some(block)), &others)?;
        let text = self.block_text(&highlight.line)?;
        self.replace(block, &text)
    }

    /// Finds the same word in other blocks [003:1744-1758]; where there is none, the highlight stays.
    fn same_word(&mut self, highlight: &Highlight, down: bool) -> Result<(), MessageId> {
        let name = highlight.line.name_of(highlight.place);
        let language = self.program.language();
        let found = self.search(highlight.block, down, |block| {
            // Nearly all blocks are passed over by a look at their text.
            let address = name.split(' ').next().unwrap_or_default();
            let line = written(block, language)
                .contains(address)
                .then(|| line_of_block(block, language))??;
            line.places()
                .into_iter()
                .find(|place| line.name_of(*place) == name)
        });
        let (block, place) = found.unwrap_or((highlight.block, highlight.place));
        self.highlight(block, place)?;
        Ok(())
    }

    /// Looks through the blocks before or after a block, the nearest first.
    pub(crate) fn search<T>(
        &self,
        from: u32,
        down: bool,
        found: impl Fn(&Block) -> Option<T>,
    ) -> Option<(u32, T)> {
        let at = from / Program::CHUNK_SIZE;
        let mut chunk = Chunk::default();
        let count = if down {
            self.program.chunk_count().saturating_sub(at)
        } else {
            at + 1
        };
        for index in 0..count {
            let number = if down { at + index } else { at - index };
            self.program.decode_into(number, &mut chunk);
            let numbered = (chunk.first_block..).zip(&chunk.blocks);
            let mut hits = numbered
                .filter(|(number, _)| if down { *number > from } else { *number < from })
                .filter_map(|(number, block)| Some((number, found(block)?)));
            let hit = if down { hits.next() } else { hits.last() };
            if hit.is_some() {
                return hit;
            }
        }
        None
    }

    /// Deletes the marked section, the block at the cursor, or from its last block the whole cycle [003:1784-1790].
    pub(crate) fn delete(&mut self) -> Result<Reaction, MessageId> {
        self.may_edit()?;
        let blocks = match self.marked() {
            Some(marked) => marked,
            None => self.deletable()?,
        };
        self.take_out(blocks)
    }

    fn deletable(&self) -> Result<Range<u32>, MessageId> {
        let block = self.cursor;
        if block == 0 || block >= self.last() {
            return Err(KeyNonFunctional);
        }
        if self.is_iso() {
            // A cycle is one block.
            return Ok(block..block + 1);
        }
        match self.cycle_of(block) {
            Some(cycle) if block + 1 == cycle.end => Ok(cycle),
            // A cycle without one of its blocks would be none *(inferred)*.
            Some(_) => Err(KeyNonFunctional),
            None => Ok(block..block + 1),
        }
    }

    /// The blocks of the cycle that a block belongs to: numbered one after the other, from 0 or from where they begin.
    pub(crate) fn cycle_of(&self, block: u32) -> Option<Range<u32>> {
        let (kind, number, sub) = self.cycle_block(block)?;
        let (mut first, mut last) = (block, block);
        let mut below = sub;
        while let Some(before) = first.checked_sub(1)
            && below > 0
            && self.cycle_block(before) == Some((kind, number, below - 1))
        {
            (first, below) = (before, below - 1);
        }
        let mut above = sub;
        while let Some(next) = above.checked_add(1)
            && self.cycle_block(last + 1) == Some((kind, number, next))
        {
            (last, above) = (last + 1, next);
        }
        Some(first..last + 1)
    }

    /// Whether a block is one of a probe function, its number and the number of the block in it.
    fn cycle_block(&self, block: u32) -> Option<(bool, u16, u16)> {
        let read = self.program.language().parse_block(&self.program.text_of(block));
        match read.block.operation {
            Operation::Cycle(block) => Some((false, block.number, block.sub)),
            Operation::Probe(block) => Some((true, block.number, block.sub)),
            _ => None,
        }
    }

    fn take_out(&mut self, blocks: Range<u32>) -> Result<Reaction, MessageId> {
        let first = blocks.start;
        self.apply(&Edit::Delete { blocks })?;
        self.cursor = first.saturating_sub(1);
        Ok(Reaction::Edited)
    }

    /// The marked blocks, without BEGIN and END.
    pub(crate) fn marked(&self) -> Option<Range<u32>> {
        let mark = self.mark?;
        let first = mark.min(self.cursor).max(1);
        let end = mark.max(self.cursor).saturating_add(1).min(self.last());
        (first < end).then_some(first..end)
    }

    /// A function of the soft keys.
    pub(crate) fn function(&mut self, function: Function) -> Result<Reaction, MessageId> {
        match function {
            Function::Mark => self.mark = Some(self.cursor),
            Function::Unmark => self.mark = None,
            Function::Copy => {
                self.clipboard = self.section()?;
                self.mark = None;
            }
            Function::Cut => {
                self.may_edit()?;
                let section = self.section()?;
                let edited = self.delete()?;
                self.clipboard = section;
                return Ok(edited);
            }
            Function::Paste => {
                let texts = self.clipboard.clone();
                return match texts.is_empty() {
                    true => Err(KeyNonFunctional),
                    false => self.insert(&texts),
                };
            }
            Function::Find => return self.show(Open::Find(String::new())),
            Function::Text if self.is_iso() => return self.iso_text(""),
            Function::Text => {
                self.may_insert()?;
                let dialogue = Dialogue::of_id("TEXT", &self.setting).ok_or(KeyNonFunctional)?;
                return self.show(Open::Dialogue(Box::new(dialogue)));
            }
            Function::Comment => return self.comment(),
            Function::Number => return self.renumber(),
            Function::Skip if self.is_iso() => return self.iso_skip(),
            Function::Skip => {
                let mut line = self.line_of(self.cursor).ok_or(KeyNonFunctional)?;
                line.toggle_skip();
                return self.replace(self.cursor, &line.text());
            }
            Function::Undo | Function::Redo => {
                let version = match function {
                    Function::Undo => self.history.undo(&self.program, self.cursor),
                    _ => self.history.redo(&self.program, self.cursor),
                };
                (self.program, self.cursor) = version.ok_or(KeyNonFunctional)?;
                self.mark = None;
                return Ok(Reaction::Edited);
            }
        }
        Ok(Reaction::Shown)
    }

    /// The marked blocks, or what DEL would delete, as text without numbers.
    fn section(&self) -> Result<Vec<String>, MessageId> {
        let blocks = match self.marked() {
            Some(marked) => marked,
            None => self.deletable()?,
        };
        if self.is_iso() {
            return Ok(self.iso_section(blocks));
        }
        let lines = blocks.filter_map(|block| self.line_of(block));
        Ok(lines.map(|line| line.text()).collect())
    }

    /// A key while a text to find is entered.
    pub(crate) fn find_key(&mut self, mut text: String, key: Key) -> Result<Reaction, MessageId> {
        let character = key.character().filter(|_| text.len() < FIND_MAX);
        match key {
            Key::Ent => {
                if text.is_empty() {
                    text.clone_from(&self.sought);
                }
                return self.find(text);
            }
            Key::End | Key::NoEnt | Key::Del => return Ok(Reaction::Shown),
            Key::Ce => drop(text.pop()),
            _ => match character {
                Some(character) => text.push(character),
                None => {
                    self.open = Open::Find(text);
                    return Err(KeyNonFunctional);
                }
            },
        }
        self.open = Open::Find(text);
        Ok(Reaction::Shown)
    }

    /// Goes to the next block that shows a text, after the end the first.
    fn find(&mut self, text: String) -> Result<Reaction, MessageId> {
        let wanted = text.to_uppercase();
        self.sought = text;
        let holds = |block: &Block| {
            self.block_shown(block)
                .to_uppercase()
                .contains(&wanted)
                .then_some(())
        };
        let found = match wanted.is_empty() {
            true => None,
            false => {
                let after = self.search(self.cursor, true, holds);
                // The first block comes after none.
                let first = || {
                    self.program
                        .decode(0)
                        .blocks
                        .first()
                        .and_then(holds)
                        .map(|()| (0, ()))
                };
                after.or_else(first).or_else(|| self.search(0, true, holds))
            }
        };
        let (block, ()) = found.ok_or(MessageId::EntryValueIncorrect)?;
        self.cursor = block;
        Ok(Reaction::Shown)
    }
}

/// Whether a key opens the dialogue of a new block while a word is highlighted, instead of entering it.
fn opens_block(highlight: &Highlight, key: Key) -> bool {
    let opens = match key.group() {
        KeyGroup::Contour | KeyGroup::Cycle | KeyGroup::Files => true,
        KeyGroup::Tool | KeyGroup::Graphics => matches!(key, Key::ToolDef | Key::ToolCall | Key::BlkForm),
        _ => false,
    };
    let enters = highlight
        .ask()
        .is_some_and(|ask| matches!(ask, crate::field::Ask::Coordinates { .. }));
    opens && !(enters && key == Key::C)
}
