//! A block, from its text to elements.
//!
//! Decision: A block acts in this order: parameters, G functions, speeds, tool, M functions before the path, the movement
//! with its drilling, M functions after the path, then barriers, cycles, loops and the end

use bahn_din::system900::{Block, Condition, Relation, WordKind};
use bahn_path::{Barrier, BlockRef};
use bahn_system900::{Memory, Name};

use crate::axes::ChannelAxes;
use crate::corner::Insert;
use crate::drilling::Drill;
use crate::functions::{self, Then};
use crate::g_functions::{self, Once};
use crate::motion::{self, Movement};
use crate::plain;
use crate::reader::Reader900;
use crate::refusal::{Refusal, wrong};
use crate::run::Extra;
use crate::speeds;
use crate::words::{Words, value_of};
use crate::writes::{self, Ordered};

impl Reader900 {
    /// Executes the next block; lines without one are passed.
    pub(crate) fn execute(&mut self) -> Result<(), Refusal> {
        let Some(mut memory) = self.memory.take() else {
            return Ok(());
        };
        let done = self.execute_with(&mut memory);
        self.memory = Some(memory);
        done
    }

    fn execute_with(&mut self, memory: &mut Memory) -> Result<(), Refusal> {
        if !self.run.has_begun {
            self.begin(memory)?;
        }
        if let Some(line) = self.run.skip.take()
            && memory.path_data(self.channel).condition()
        {
            self.go_to_line(line);
        }
        let Some(frame) = self.run.frames.last_mut() else {
            return self.run.finish();
        };
        let Some(file) = self.files.get(frame.file) else {
            return wrong("a cycle is gone");
        };
        let line = frame.line;
        if line > file.words.line_count() {
            self.run.frames.pop();
            return match self.run.frames.is_empty() {
                true => self.run.finish(),
                false => Ok(()),
            };
        }
        frame.line += 1;
        let number = frame.block;
        let read = file.words.block_into(line, &mut self.block);
        frame.block = file.block_after(line, number, read.is_some());
        let Some(read) = read else {
            return Ok(());
        };
        self.run.at = BlockRef {
            program: u16::try_from(frame.file).unwrap_or(u16::MAX),
            block: number,
        };
        self.run.count()?;
        read.map_err(|faults| {
            let first = faults.into_iter().next();
            Refusal::Wrong(first.map_or_else(String::new, |fault| fault.message))
        })?;
        if self.block.may_be_skipped && memory.path_data(self.channel).skips() {
            return Ok(());
        }
        if self.run.is_stale {
            self.run.modal.refresh(memory, self.channel, &self.axes)?;
            self.run.is_stale = false;
        }
        if plain::execute(&self.block, &mut self.run, &self.axes)? {
            return Ok(());
        }
        let block = std::mem::take(&mut self.block);
        let done = self.execute_block(&block, line, memory);
        self.block = block;
        done
    }

    fn execute_block(&mut self, block: &Block, line: u32, memory: &mut Memory) -> Result<(), Refusal> {
        let jump = block.words.iter().find_map(|word| match word.kind {
            WordKind::Jump(condition) => Some(condition),
            _ => None,
        });
        match jump {
            Some(condition) => self.jump_if(condition, memory),
            None => self.take(block, line, memory),
        }
    }

    /// Finds the axes, the zero point, and the block to start at, P8801.
    fn begin(&mut self, memory: &mut Memory) -> Result<(), Refusal> {
        self.axes = ChannelAxes::of(memory, self.channel).map_err(Refusal::Wrong)?;
        self.run.has_begun = true;
        let data = memory.path_data(self.channel);
        self.run.modal.zero_point = data.first_zero_point();
        let said = self.run.start.map(f64::from);
        let start = said.or(data.start_block());
        let start = start.filter(|block| *block > 0.0 && !self.run.is_placed);
        self.run.modal.refresh(memory, self.channel, &self.axes)?;
        self.run.is_stale = false;
        if let Some(number) = start {
            let line = self.line_of(number as u32);
            let Some(line) = line else {
                return wrong(format!("start block: no block has the number N{number}"));
            };
            self.go_to_line(line);
        }
        Ok(())
    }

    /// The line of a block number in the file that is executed.
    fn line_of(&self, number: u32) -> Option<u32> {
        let frame = self.run.frames.last()?;
        self.files.get(frame.file)?.words.line_of(number)
    }

    fn go_to(&mut self, number: u32) -> Result<(), Refusal> {
        match self.line_of(number) {
            Some(line) => {
                self.go_to_line(line);
                Ok(())
            }
            None => wrong(format!("no block has the number N{number}")),
        }
    }

    /// Goes on at a line of the file that is executed.
    fn go_to_line(&mut self, line: u32) {
        if let Some(frame) = self.run.frames.last_mut()
            && let Some(file) = self.files.get(frame.file)
        {
            (frame.line, frame.block) = (line, file.block_of(line));
        }
    }

    fn jump_if(&mut self, condition: Condition, memory: &Memory) -> Result<(), Refusal> {
        let name = Name::P(self.channel, condition.parameter.number().into());
        // A cleared parameter is neither less nor equal nor greater (inferred).
        let Some(own) = memory.cell(name)?.number() else {
            return Ok(());
        };
        let with = value_of(condition.with, memory, self.channel)?;
        let jumps = match condition.relation {
            Relation::Less => own < with,
            Relation::Equal => own == with,
            Relation::Greater => own > with,
        };
        match jumps {
            true => self.go_to(condition.target),
            false => Ok(()),
        }
    }

    fn take(&mut self, block: &Block, line: u32, memory: &mut Memory) -> Result<(), Refusal> {
        let (channel, keeps) = (self.channel, self.keeps());
        let mut ordered = Ordered::default();
        let journal = Reader900::journal(keeps, &mut self.journal);
        if writes::take(block, memory, channel, journal, &mut ordered)? {
            self.run.modal.refresh(memory, channel, &self.axes)?;
        }
        let has = |number: u16| block.words.iter().any(|word| word.kind == WordKind::G(number));
        let is_polar = !has(11) && (self.run.modal.is_polar || has(10));
        let polar = is_polar.then(|| memory.path_data(channel).polar_letters());
        let words = Words::of(block, memory, channel, &self.axes, polar)?;
        let once = g_functions::take(&words, &mut self.run.modal, memory, channel, &self.axes)?;
        if let Some(feed) = words.feed {
            self.run.modal.feed = feed;
        }
        speeds::take(&words, once, &mut self.run.modal, memory, channel, &mut ordered)?;
        let journal = Reader900::journal(keeps, &mut self.journal);
        if functions::take_tool(&words, &self.run.modal, memory, channel, journal, &mut ordered)? {
            self.run.modal.refresh(memory, channel, &self.axes)?;
        }
        let then = self.take_m(&words, memory, &mut ordered)?;
        let waits = ordered.waits;
        let moved = self.movement(&words, once, ordered, memory)?;
        if then.is_cut && (!moved || once.drills.or(self.run.modal.drilling).is_some()) {
            return wrong("M26 stands in a block that moves, and drills nothing");
        }
        self.drilling(once, moved, then, line, memory, waits)
    }

    fn take_m(&mut self, words: &Words, memory: &Memory, ordered: &mut Ordered) -> Result<Then, Refusal> {
        if words.m.is_empty() {
            return Ok(Then::default());
        }
        let changes = words.m.iter().any(|word| word.number == 6);
        let has_tool_cycle = changes && self.files.cycle(6).is_some();
        let frame = self.run.frames.last();
        let file = frame.and_then(|frame| self.files.get(frame.file));
        let block_of = |number: u32| {
            let file = file?;
            Some(file.block_of(file.words.line_of(number)?))
        };
        functions::take_m(words, memory, self.channel, ordered, has_tool_cycle, block_of)
    }

    /// Makes the movement of a block, or what stands in its place. Whether the path moves.
    fn movement(
        &mut self,
        words: &Words,
        once: Once,
        ordered: Ordered,
        memory: &Memory,
    ) -> Result<bool, Refusal> {
        let dwell_s = words.time.filter(|_| once.dwells).unwrap_or(0.0);
        let movement = match once.shifts {
            true => None,
            false => motion::of(words, &mut self.run.modal, once, &self.run.here)?,
        };
        let here = self.run.here;
        let moving = |one: &Movement| one.curve.length(&here, &one.end) > 0.0 || one.end != here;
        let mut extra = Extra {
            functions: ordered.functions,
            dwell_s,
            ..Extra::default()
        };
        if once.corner {
            if !movement.as_ref().is_some_and(moving) {
                return wrong("G12 stands in a block that moves in the plane");
            }
            extra.insert = Some(Insert::of(&memory.path_data(self.channel))?);
        }
        match movement {
            Some(movement) if moving(&movement) => {
                self.run
                    .push(movement.curve, movement.end, movement.feed, extra)?;
                if movement.stops {
                    self.run.hold(Extra::default())?;
                }
                Ok(true)
            }
            moved => {
                if !extra.functions.is_empty() || dwell_s > 0.0 {
                    self.run.hold(extra)?;
                }
                Ok(moved.is_some())
            }
        }
    }

    /// Drilling of the block, and what it does with the run at its end.
    fn drilling(
        &mut self,
        once: Once,
        moved: bool,
        then: Then,
        line: u32,
        memory: &Memory,
        waits: bool,
    ) -> Result<(), Refusal> {
        let data = memory.path_data(self.channel);
        let mut calls = then.calls;
        let drilling = once.drills.or(self.run.modal.drilling);
        let is_due = once.drills.is_some() || once.pattern.is_some() || moved;
        if let Some(word) = drilling.filter(|_| is_due) {
            match (self.files.cycle(word), once.pattern) {
                (None, Some(pattern)) => Drill(&mut self.run).drill_pattern(pattern, word, &data)?,
                (None, None) => Drill(&mut self.run).drill(word, &data)?,
                (Some(_), Some(pattern)) => {
                    return Err(Refusal::NotYet(format!("G{pattern} with the cycle Z{word}.900")));
                }
                (Some(_), None) => calls = Some(word),
            }
        } else if let Some(pattern) = once.pattern {
            return wrong(format!(
                "G{pattern} without drilling: G81, G83, G84 or G85 is not in force"
            ));
        }
        self.finish(then, calls.or(once.cycle), line, waits)
    }

    fn finish(&mut self, then: Then, calls: Option<u16>, line: u32, waits: bool) -> Result<(), Refusal> {
        let block = self.run.at;
        if then.stops {
            self.run.stopped = Some(block);
            self.run.barrier(Barrier::Stop { block })?;
        } else if waits {
            self.run.barrier(Barrier::Acknowledge { block })?;
        }
        if then.ends {
            return self.run.finish();
        }
        if let Some(target) = then.skips_to {
            self.run.skip = self.line_of(target);
        }
        if let Some((target, count)) = then.loops {
            self.repeat(line, target, count)?;
        }
        match calls {
            None => Ok(()),
            Some(number) => match self.files.cycle(number) {
                Some(file) => self.run.call(file),
                None => wrong(format!("the cycle Z{number}.900 does not lie beside the program")),
            },
        }
    }

    /// M24: jumps back so often.
    fn repeat(&mut self, line: u32, target: u32, count: u32) -> Result<(), Refusal> {
        let Some(frame) = self.run.frames.last_mut() else {
            return Ok(());
        };
        let known = frame.loops.iter().position(|(own, _)| *own == line);
        let at = known.unwrap_or_else(|| {
            frame.loops.push((line, count));
            frame.loops.len() - 1
        });
        match frame.loops.get_mut(at) {
            Some((_, left)) if *left > 0 => {
                *left -= 1;
                self.run.modal.loops = Some([count, *left]);
                self.go_to(target)
            }
            _ => {
                frame.loops.remove(at);
                Ok(())
            }
        }
    }
}
