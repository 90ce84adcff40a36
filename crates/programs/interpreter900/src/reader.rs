//! The reader: hands out the path of a program, and goes back in it.
//!
//! Decision: Coordinates of the path are those of the axes, P12151: zero points change within a program, the path does not
//!
//! Decision: [`Reader::goto`] goes on with all that is in force, as a branch of the control does. A run that goes back finds
//! the parameters again that its own look-ahead has written; what others wrote stays

use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_din::system900::Block;
use bahn_path::{Axis, BlockRef, ElementSource, LiveData, Position, Step};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, ProgramError, Reader, Warning};
use bahn_system900::Memory;
use bahn_text::Files;

use crate::axes::ChannelAxes;
use crate::contour::Contour;
use crate::file::FilesOfRun;
use crate::item::Item;
use crate::refusal::Refusal;
use crate::run::{Ended, Frame, Run};
use crate::shown::Shown;
use crate::writes::Journal;

/// Executes a program of a channel and the cycles that it calls.
///
/// The parameters belong to the control: they are [given](Reader900::give_memory) while the reader reads, and
/// [taken](Reader900::take_memory) again. Without them the next step is [`Step::Starved`].
#[derive(Clone)]
pub struct Reader900 {
    pub(crate) channel: u8,
    pub(crate) memory: Option<Box<Memory>>,
    pub(crate) axes: ChannelAxes,
    pub(crate) files: FilesOfRun,
    /// The block that is executed: its room is used again.
    pub(crate) block: Block,
    pub(crate) run: Run,
    pub(crate) shown: Shown,
    /// The block that the look-ahead has shown.
    pub(crate) shown_read: u64,
    /// States before blocks whose elements were handed out, when they are kept, with the length of the journal.
    kept: Option<VecDeque<(Mark, Run, usize)>>,
    pub(crate) journal: Journal,
    /// Work that may still be done before [`Step::Starved`]; `None` for any amount.
    work: Option<u32>,
    interrupt: Option<Arc<AtomicBool>>,
}

/// What a block costs whose state is kept.
const STATE_COST: u32 = 4;

impl Reader900 {
    /// Prepares the run of a program in a channel, 1 to 8, from where its axes stand; `name` is its path, `beside` finds
    /// its cycles, `Z6.900`.
    pub fn new(
        name: &str,
        bytes: &[u8],
        channel: u8,
        position: Position,
        beside: Arc<dyn Files>,
    ) -> Reader900 {
        let program = Program::from_bytes(name, bytes.to_vec());
        Reader900::of_program(Arc::new(program), channel, position, beside)
    }

    /// The same for a program that is there already.
    pub fn of_program(
        program: Arc<Program>,
        channel: u8,
        position: Position,
        beside: Arc<dyn Files>,
    ) -> Reader900 {
        Reader900 {
            channel: channel.max(1),
            memory: None,
            axes: ChannelAxes::default(),
            files: FilesOfRun::new(program, beside),
            block: Block::default(),
            run: Run::at(position),
            shown: Shown::default(),
            shown_read: 0,
            kept: None,
            journal: Journal::new(),
            work: None,
            interrupt: None,
        }
    }

    /// The reader as one of these programs; `None` for a program in another language.
    pub fn of(reader: &dyn Reader) -> Option<&Reader900> {
        (reader as &dyn Any).downcast_ref()
    }

    /// The same, to give it the memory.
    pub fn of_mut(reader: &mut dyn Reader) -> Option<&mut Reader900> {
        (reader as &mut dyn Any).downcast_mut()
    }

    /// Gives it the parameters to read with.
    pub fn give_memory(&mut self, memory: impl Into<Box<Memory>>) {
        self.memory = Some(memory.into());
    }

    /// Takes the parameters back; `None` when it has none.
    pub fn take_memory(&mut self) -> Option<Box<Memory>> {
        self.show_read();
        self.memory.take()
    }

    /// The parameters, while it has them.
    pub fn memory(&self) -> Option<&Memory> {
        self.memory.as_deref()
    }

    /// Which axes of the path are which of the channel, once it has read a block.
    pub fn axes(&self) -> &ChannelAxes {
        &self.axes
    }

    /// A parameter was written from outside: what is taken from parameters is taken anew at the next block.
    pub fn note_write(&mut self) {
        self.run.is_stale = true;
    }

    /// The block that stands in force as a stop, M0.
    pub fn is_stop(&self, block: BlockRef) -> bool {
        self.run.stopped == Some(block)
    }

    /// A branch is taken: the run goes back to the block of this sequence, and on at a block of its program, from where the
    /// axes stand. It keeps what was in force before that block.
    pub fn branch(&mut self, sequence: u64, target: u32, position: &Position) {
        self.go_back(&|mark| mark.sequence == sequence);
        self.relocate(position);
        self.jump(target);
    }

    /// The program starts at a block of this number, 0 for its first one, whatever P8801 says: an emergency program has a
    /// start block of its own [002:4303-4314].
    pub fn start_at(&mut self, number: u32) {
        self.run.start = Some(number);
    }

    /// Goes on at a block of the file that is executed.
    fn jump(&mut self, block: u32) {
        if let Some(frame) = self.run.frames.last_mut()
            && let Some(file) = self.files.get(frame.file)
        {
            (frame.line, frame.block) = (file.text.line_of(block.max(1)), block.max(1));
        }
        (self.run.ended, self.run.waiting, self.run.skip) = (None, None, None);
    }

    /// The journal of writes, where states are kept.
    pub(crate) fn journal(kept: bool, journal: &mut Journal) -> Option<&mut Journal> {
        kept.then_some(journal)
    }

    pub(crate) fn keeps(&self) -> bool {
        self.kept.is_some()
    }

    fn spend(&mut self) -> bool {
        let cost = if self.kept.is_some() { STATE_COST } else { 1 };
        match &mut self.work {
            Some(0) => false,
            Some(work) => {
                *work = work.saturating_sub(cost);
                true
            }
            None => true,
        }
    }

    fn is_interrupted(&self) -> bool {
        let flag = self.interrupt.as_ref();
        flag.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Executes the next block. One that fails leaves everything as it was before it, where states are kept.
    fn step(&mut self) {
        let before = self.kept.is_some().then(|| self.run.clone());
        let written = self.journal.len();
        match (self.execute(), before) {
            (Ok(()), Some(before)) => {
                if !self.run.queue.is_empty() || self.run.contour.holds() {
                    self.note_block();
                }
                if (!self.run.queue.is_empty() || self.run.contour.holds())
                    && let Some(kept) = &mut self.kept
                {
                    let mark = Mark {
                        sequence: self.run.sequence,
                        at: self.run.at,
                    };
                    kept.push_back((mark, before, written));
                }
            }
            (Ok(()), None) => {}
            (Err(refusal), before) => {
                let error = self.failure(refusal);
                if let Some(before) = before {
                    self.run = before;
                    self.unwrite(written);
                }
                self.run.ended = Some(Ended::Failed(error));
            }
        }
    }

    /// Puts parameters back that were written since.
    fn unwrite(&mut self, length: usize) {
        while self.journal.len() > length {
            if let (Some((place, cell)), Some(memory)) = (self.journal.pop(), &mut self.memory) {
                memory.restore(place, cell);
            }
        }
    }

    fn failure(&self, refusal: Refusal) -> Box<ProgramError> {
        let block = refusal.block().unwrap_or(self.run.at);
        let file = self.files.get(block.program.into());
        let (message, cause) = refusal.said();
        Box::new(ProgramError {
            message,
            program: file.map_or_else(String::new, |file| file.text.name().to_owned()),
            block,
            detail: String::new(),
            cause,
        })
    }
}

impl ElementSource for Reader900 {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Box<ProgramError>> {
        loop {
            if let Some(barrier) = self.run.waiting {
                return Step::Barrier(barrier);
            }
            match self.run.queue.pop_front() {
                Some(Item::Element(element)) => {
                    self.run.position = element.end;
                    return Step::Element(element);
                }
                Some(Item::Barrier(barrier)) => {
                    self.run.waiting = Some(barrier);
                    return Step::Barrier(barrier);
                }
                None => {}
            }
            match &self.run.ended {
                Some(Ended::Finished) => return Step::End,
                Some(Ended::Failed(error)) => return Step::Error(error.clone()),
                None => {}
            }
            if self.memory.is_none() || self.is_interrupted() || !self.spend() {
                return Step::Starved;
            }
            self.step();
        }
    }

    fn resume(&mut self, _live: LiveData) {
        if self.run.waiting.take().is_some() {
            self.run.is_stale = true;
        }
    }
}

impl Reader for Reader900 {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, index: u16) -> Option<&Arc<Program>> {
        self.files.get(index.into()).map(|file| &file.text)
    }

    fn at(&self) -> BlockRef {
        let Some(frame) = self.run.frames.last() else {
            return self.run.at;
        };
        BlockRef {
            program: u16::try_from(frame.file).unwrap_or(u16::MAX),
            block: frame.block,
        }
    }

    fn blocks_executed(&self) -> u64 {
        self.run.sequence
    }

    fn position(&self) -> Position {
        self.run.position
    }

    fn take_warnings(&mut self) -> Vec<Warning> {
        Vec::new()
    }

    fn goto(&mut self, block: u32) {
        self.run.frames = vec![Frame::new(0)];
        self.run.queue.clear();
        self.run.contour = Contour::default();
        self.run.here = self.run.position;
        self.run.is_placed = true;
        self.run.is_stale = true;
        self.run.idle = 0;
        self.jump(block);
        if let Some(kept) = &mut self.kept {
            kept.clear();
        }
        self.journal.clear();
    }

    fn keep_checkpoints(&mut self) {
        self.kept = Some(VecDeque::new());
    }

    fn forget_before(&mut self, sequence: u64) {
        let Some(kept) = &mut self.kept else { return };
        while kept.get(1).is_some_and(|(next, ..)| next.sequence <= sequence) {
            kept.pop_front();
        }
        self.shown.forget_before(sequence);
        let first = kept.front().map_or(0, |(_, _, written)| *written);
        if first > 0 {
            self.journal.drain(..first.min(self.journal.len()));
            for (_, _, written) in kept {
                *written -= first;
            }
        }
    }

    fn go_back(&mut self, so: &dyn Fn(Mark) -> bool) {
        let Some(kept) = &mut self.kept else { return };
        let found = kept.iter().rposition(|(mark, ..)| so(*mark));
        let state = found.and_then(|at| kept.swap_remove_back(at));
        kept.clear();
        if let Some((_, state, written)) = state {
            self.run = state;
            self.run.is_stale = true;
            self.shown.go_back(self.run.sequence);
            self.unwrite(written);
        }
        self.journal.clear();
    }

    fn block_at(&self, sequence: u64) -> BlockRef {
        let mut kept = self.kept.iter().flatten();
        let state = kept.rfind(|(mark, ..)| mark.sequence <= sequence);
        state.map_or_else(|| self.at(), |(mark, ..)| mark.at)
    }

    fn retry(&mut self) {
        if self.kept.is_some() {
            self.run.ended = None;
        }
        self.run.waiting = None;
        self.run.is_stale = true;
    }

    fn relocate(&mut self, position: &Position) {
        self.run.queue.clear();
        self.run.contour = Contour::default();
        self.run.waiting = None;
        (self.run.position, self.run.here) = (*position, *position);
    }

    fn stand_at(&mut self, position: &Position) {
        if !self.run.queue.is_empty() || self.run.contour.holds() {
            return;
        }
        for axis in Axis::ALL.into_iter().filter(|axis| !position[*axis].is_nan()) {
            self.run.position[axis] = position[axis];
        }
        self.run.here = self.run.position;
    }

    fn set_machine_rules(&mut self, _rules: MachineRules) {}

    fn allow(&mut self, work: u32) {
        self.work = Some(work);
    }

    fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }
}
