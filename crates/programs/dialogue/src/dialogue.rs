//! The open dialogue: questions one after the other, block by block.
//!
//! Decision: N after L opens LN; LBL SET and NO ENT open a dialogue block in programs 99999968 to 99999999 only; a
//! soft key makes a block optional

use bahn_parameters::MessageId::{self, EntryValueIncorrect, KeyNonFunctional};
use bahn_program::CycleFunction;

use crate::blocks::{BlockRow, DIALOG_CALL, NORMALS, block_row};
use crate::check::Context;
use crate::cycles::{cycle_line, cycle_lines, repeats};
use crate::field::{Ask, Field, Need, TABLE_LINE};
use crate::line::Line;
use crate::typing::Typing;
use crate::{Key, OEM_CYCLES, Setting, Wanted, Word};

/// Number of the program of a cycle of the machine builder less its own [000:17728-17730].
const BUILDER_PROGRAMS: u32 = 99_999_900;

/// Most blocks of one cycle.
const LINES_MAX: usize = 64;

/// What a dialogue makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    /// A row of the table of blocks.
    Row(&'static BlockRow),
    /// A cycle or probe function.
    Cycle(CycleFunction, u16),
}

impl Source {
    /// `L`, `CYCL DEF 4`, `TCH PROBE 0`.
    pub(crate) fn name(self) -> String {
        match self {
            Source::Row(row) => row.id.to_owned(),
            Source::Cycle(CycleFunction::Definition, number) => format!("CYCL DEF {number}"),
            Source::Cycle(CycleFunction::Probe, number) => format!("TCH PROBE {number}"),
        }
    }
}

/// What becomes of a dialogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The dialogue stays open.
    Stay,
    /// Its blocks are complete.
    Finish,
    /// The dialogue is closed without a block.
    Drop,
}

/// An open dialogue: the block that is asked for, and how far it is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dialogue {
    pub(crate) source: Source,
    /// The block that is changed; a new one without.
    pub(crate) replaces: Option<u32>,
    pub(crate) lines: Vec<Line>,
    /// Lines that the dialogue needs; more repeat the last.
    base: usize,
    /// The line of the block that is asked for, from 0.
    pub(crate) line: usize,
    pub(crate) field: usize,
    /// The last line that was asked for.
    pub(crate) reached: usize,
    pub(crate) typing: Typing,
}

impl Dialogue {
    /// A dialogue for a new block.
    pub(crate) fn new(source: Source, setting: &Setting) -> Dialogue {
        let mut lines = match source {
            Source::Row(row) => Line::of_row(row.id),
            Source::Cycle(function, number) => cycle_lines(function, number, setting),
        };
        lines.iter_mut().for_each(|line| line.fit(setting));
        let mut dialogue = Dialogue {
            source,
            replaces: None,
            base: lines.len(),
            lines,
            line: 0,
            field: 0,
            reached: 0,
            typing: Typing::default(),
        };
        dialogue.go_on(0, 0);
        dialogue
    }

    /// The dialogue of a row by its id.
    pub(crate) fn of_id(id: &str, setting: &Setting) -> Option<Dialogue> {
        Some(Dialogue::new(Source::Row(block_row(id)?), setting))
    }

    /// The dialogue of a block that stands in the program, from a field on.
    pub(crate) fn of_line(mut line: Line, block: u32, field: usize, setting: &Setting) -> Option<Dialogue> {
        line.fit(setting);
        let source = Source::Row(block_row("TEXT")?);
        let mut dialogue = Dialogue {
            source,
            replaces: Some(block),
            lines: vec![line],
            base: 1,
            line: 0,
            field: 0,
            reached: 0,
            typing: Typing::default(),
        };
        dialogue.go_on(0, field).then_some(dialogue)
    }

    /// Goes to a question, or to the next that is asked after it; whether there is one.
    fn go_on(&mut self, line: usize, field: usize) -> bool {
        let mut from = field;
        for (index, candidate) in self.lines.iter().enumerate().skip(line) {
            let asked = |field: &Field| field.slot.need != Need::Unasked;
            if let Some(found) = candidate.fields().iter().skip(from).position(asked) {
                (self.line, self.field) = (index, from + found);
                self.reached = self.reached.max(index);
                self.typing = Typing::default();
                return true;
            }
            from = 0;
        }
        false
    }

    /// The question before; whether there is one.
    fn go_back(&mut self) -> bool {
        let places = self.lines.iter().enumerate().flat_map(|(index, line)| {
            let asked = line.fields().iter().enumerate();
            let asked = asked.filter(|(_, field)| field.slot.need != Need::Unasked);
            asked.map(move |(field, _)| (index, field))
        });
        let before = places.take_while(|place| *place < (self.line, self.field)).last();
        let Some((line, field)) = before else {
            return false;
        };
        (self.line, self.field) = (line, field);
        self.typing = Typing::default();
        true
    }

    /// The field of the question.
    pub(crate) fn current(&self) -> Option<&Field> {
        self.lines.get(self.line)?.field(self.field)
    }

    fn parts(&mut self) -> Option<(&mut Field, &mut Typing)> {
        let field = self.lines.get_mut(self.line)?.field_mut(self.field)?;
        Some((field, &mut self.typing))
    }

    /// What a key does.
    pub(crate) fn key(&mut self, key: Key, context: Context<'_>) -> Result<Step, MessageId> {
        match key {
            Key::Ent => self.enter(context),
            Key::NoEnt => self.skip(context),
            Key::End => self.end(context),
            Key::Del => Ok(Step::Drop),
            Key::Right => self.forward(context),
            Key::Left => {
                self.confirm(context)?;
                self.go_back().then_some(Step::Stay).ok_or(KeyNonFunctional)
            }
            Key::Ce => {
                if let Some((field, typing)) = self.parts() {
                    typing.clear(field);
                }
                Ok(Step::Stay)
            }
            _ => self.other(key, context.setting),
        }
    }

    fn other(&mut self, key: Key, setting: &Setting) -> Result<Step, MessageId> {
        if let Some(other) = self.other_block(key, setting) {
            *self = other;
            if matches!(key, Key::P | Key::N) {
                return Ok(Step::Stay);
            }
        }
        let (field, typing) = self.parts().ok_or(KeyNonFunctional)?;
        typing.key(field, key, setting)?;
        Ok(Step::Stay)
    }

    /// The block that a key makes of one in which nothing is entered yet: P the polar one, N after L that with surface
    /// normals, and a number without an axis after L is a chamfer [003:2685].
    fn other_block(&self, key: Key, setting: &Setting) -> Option<Dialogue> {
        let Source::Row(row) = self.source else {
            return None;
        };
        let untouched = self.replaces.is_none() && self.field == 0 && self.lines.iter().all(Line::is_empty);
        let chamfer = row.id == "L" && (key.digit().is_some() || key == Key::Point || key == Key::Q);
        match key {
            _ if !untouched || self.typing != Typing::default() => None,
            Key::P if self.is_text() => None,
            Key::P => Dialogue::of_id(row.polar, setting),
            Key::N if row.id == "L" && setting.has(NORMALS) => Dialogue::of_id("LN", setting),
            _ if chamfer => Dialogue::of_id("CHF", setting),
            _ => None,
        }
    }

    fn is_text(&self) -> bool {
        self.current().is_some_and(|field| field.slot.ask.is_text())
    }

    /// Takes an answer by soft key.
    pub(crate) fn take(&mut self, value: &str, setting: &Setting) -> Result<(), MessageId> {
        let (field, typing) = self.parts().ok_or(KeyNonFunctional)?;
        if field.slot.ask.is_text() {
            let mut characters = value.chars();
            return characters.try_for_each(|character| typing.character(field, character, setting));
        }
        typing.take(field, value);
        Ok(())
    }

    /// The position that may be captured for the question.
    pub(crate) fn wants_position(&self) -> Option<Wanted> {
        let field = self.current()?;
        match field.slot.ask {
            Ask::Number { .. } => Some(Wanted::ToolAxis),
            _ => field.wants_position(self.typing.word?),
        }
    }

    /// Takes the value of a position.
    pub(crate) fn capture(&mut self, value: String) -> Result<(), MessageId> {
        let (field, typing) = self.parts().ok_or(KeyNonFunctional)?;
        let index = typing.word.unwrap_or(0);
        if matches!(field.slot.ask, Ask::Number { .. }) && field.words.is_empty() {
            typing.take(field, "");
        }
        let word = field.words.get_mut(index).ok_or(KeyNonFunctional)?;
        (word.value, word.incremental) = (value, false);
        *typing = Typing::over(index);
        Ok(())
    }

    /// Goes to the comment after the block.
    pub(crate) fn comment(&mut self, context: Context<'_>) -> Result<(), MessageId> {
        self.confirm(context)?;
        let line = self.lines.get(self.line).ok_or(KeyNonFunctional)?;
        self.field = line.comment_field().ok_or(KeyNonFunctional)?;
        self.typing = Typing::default();
        Ok(())
    }

    /// Checks the answer of the question.
    fn confirm(&mut self, context: Context<'_>) -> Result<(), MessageId> {
        let (field, typing) = self.parts().ok_or(KeyNonFunctional)?;
        if field.words.is_empty() {
            return Ok(());
        }
        typing.settle(field);
        field.settle();
        let line = self.lines.get(self.line).ok_or(KeyNonFunctional)?;
        let others = self.lines.iter().enumerate();
        let others = others.filter(|(index, _)| *index != self.line);
        context.check(line, others.map(|(_, line)| line))
    }

    fn enter(&mut self, context: Context<'_>) -> Result<Step, MessageId> {
        let before = self.clone();
        let (field, typing) = self.parts().ok_or(KeyNonFunctional)?;
        if field.words.is_empty() {
            match field.slot.ask {
                Ask::Choice(choices) => {
                    let last = choices.last().ok_or(KeyNonFunctional)?;
                    typing.take(field, last.value);
                }
                // Where F MAX is no word the question does not offer it.
                Ask::Feed { max: true } if context.setting.rapid() == "MAX" => typing.take(field, "MAX"),
                _ if field.slot.need == Need::Required => return Err(EntryValueIncorrect),
                _ => {}
            }
        }
        if typing.in_turn && field.in_turn().is_some() {
            typing.settle(field);
            *typing = Typing::default();
            return Ok(Step::Stay);
        }
        let list = field.slot.ask.is_list() && typing.word.is_some();
        let more = list && field.words.len() < field.slot.ask.most(context.setting.model.limits());
        if let Err(message) = self.confirm(context) {
            // An answer that ENT alone gave does not stay.
            *self = before;
            return Err(message);
        }
        if more {
            self.typing = Typing::default();
            return Ok(Step::Stay);
        }
        self.next(context)
    }

    fn skip(&mut self, context: Context<'_>) -> Result<Step, MessageId> {
        if let Some(other) = self.dialog_block(context) {
            *self = other;
            return Ok(Step::Stay);
        }
        let (field, typing) = self.parts().ok_or(KeyNonFunctional)?;
        let answer = match field.slot.ask {
            Ask::Choice(choices) => choices.iter().find(|choice| choice.key == Some(Key::NoEnt)),
            _ => None,
        };
        match field.slot.need {
            _ if answer.is_some() => {
                typing.take(field, answer.map_or("", |answer| answer.value));
                self.next(context)
            }
            Need::Required => Err(KeyNonFunctional),
            _ => {
                field.words.clear();
                *typing = Typing::default();
                self.next(context)
            }
        }
    }

    /// LBL SET and NO ENT in the program of a cycle of the machine builder: its dialogue block [000:17732-17744].
    fn dialog_block(&self, context: Context<'_>) -> Option<Dialogue> {
        let Source::Row(row) = self.source else {
            return None;
        };
        let untouched = self.replaces.is_none() && self.lines.iter().all(Line::is_empty);
        let here = row.id == "LBL" && untouched && context.setting.has(DIALOG_CALL);
        let number = context.program.name().split('.').next()?.parse::<u32>().ok()?;
        let cycle = number.checked_sub(BUILDER_PROGRAMS)?.try_into().ok()?;
        (here && OEM_CYCLES.contains(&cycle))
            .then(|| Dialogue::of_id("DLG", context.setting))
            .flatten()
    }

    fn forward(&mut self, context: Context<'_>) -> Result<Step, MessageId> {
        let field = self.current().ok_or(KeyNonFunctional)?;
        if field.slot.need == Need::Required && field.words.is_empty() {
            return Err(KeyNonFunctional);
        }
        self.confirm(context)?;
        let (line, field) = (self.line, self.field);
        self.go_on(line, field + 1)
            .then_some(Step::Stay)
            .ok_or(KeyNonFunctional)
    }

    /// Goes to the next question.
    fn next(&mut self, context: Context<'_>) -> Result<Step, MessageId> {
        let (line, field) = (self.line, self.field);
        if self.go_on(line, field + 1) || self.repeat(context.setting) {
            return Ok(Step::Stay);
        }
        self.end(context)
    }

    /// Asks for one more block like the last, where that was answered: a datum shift has one for each axis.
    fn repeat(&mut self, setting: &Setting) -> bool {
        let Some(last) = self.lines.last().filter(|line| !line.is_empty()) else {
            return false;
        };
        let whole = |word: &Word| word.address == TABLE_LINE;
        if last.fields().iter().flat_map(|field| &field.words).any(whole) {
            return false;
        }
        let by_axis = last
            .field(0)
            .is_some_and(|field| matches!(field.slot.ask, Ask::Coordinates { .. }));
        if (by_axis && self.lines.len() > setting.axes.len()) || !self.add_line(setting) {
            return false;
        }
        self.go_on(self.lines.len() - 1, 0)
    }

    /// Ends the blocks with what is there.
    fn end(&mut self, context: Context<'_>) -> Result<Step, MessageId> {
        self.confirm(context)?;
        let lines = self.made();
        let bare = match self.source {
            Source::Row(row) => row.bare || self.replaces.is_some(),
            Source::Cycle(..) => true,
        };
        let empty = lines.iter().all(Line::is_empty) && !bare;
        if lines.is_empty() || empty || !lines.iter().all(Line::is_complete) {
            return Err(EntryValueIncorrect);
        }
        Ok(Step::Finish)
    }

    /// The blocks that were entered so far, without a last one that is still empty.
    pub(crate) fn made(&self) -> &[Line] {
        let mut count = self.reached + 1;
        while count > 1 {
            let last = self.lines.get(count - 1);
            let open = |line: &Line| line.is_empty() && (line.has_required() || count > self.base);
            match last.is_some_and(open) {
                true => count -= 1,
                false => break,
            }
        }
        self.lines.get(..count).unwrap_or_default()
    }

    /// Forgets the answers of all lines.
    pub(crate) fn clear(&mut self) {
        for line in &mut self.lines {
            line.clear();
        }
    }

    /// Adds blocks like the last until there is one of a number; whether there is.
    pub(crate) fn reach(&mut self, line: usize, setting: &Setting) -> bool {
        while line >= self.lines.len() {
            if !self.add_line(setting) {
                return false;
            }
        }
        true
    }

    /// Adds a word to a field; whether there is such a field.
    pub(crate) fn answer(&mut self, line: usize, field: usize, word: Word, setting: &Setting) -> bool {
        if !self.reach(line, setting) {
            return false;
        }
        let Some(field) = self.lines.get_mut(line).and_then(|line| line.field_mut(field)) else {
            return false;
        };
        field.words.push(word);
        true
    }

    /// Adds a block like the last, where the cycle takes more of them.
    fn add_line(&mut self, setting: &Setting) -> bool {
        let Source::Cycle(function, number) = self.source else {
            return false;
        };
        let more =
            self.replaces.is_none() && self.lines.len() < LINES_MAX && repeats(function, number, setting);
        if more {
            let mut line = cycle_line(function, number, self.lines.len() as u16);
            line.make_optional();
            self.lines.push(line);
        }
        more
    }
}
