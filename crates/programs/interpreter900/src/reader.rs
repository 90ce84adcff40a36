//! A part program of a System 900 that is read block by block.
//!
//! Decision: A program that executes many blocks without a movement, a dwell or a wait is ended: it would never come back
//!
//! Decision: In a test run nobody executes the path: real-time parameters are written and conditions of the PLC looked at
//! where the reader comes to them

use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_path::{BlockRef, ElementSource, LiveData, Position, Step};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, ProgramError, Reader, Warning};
use bahn_system900::{Memory, PathParameter};
use bahn_text::Files;

use crate::block::{Next, Work};
use crate::modal::Modal;
use crate::refusal::Refusal;
use crate::run::{ChannelAxes, Ended, Item, Level, NESTING_MAX, Run, Then};
use crate::texts::Texts;

/// Blocks without movement after which a program is ended, as a loop that never waits (inferred).
const IDLE_MAX: u32 = 100_000;
/// What a block costs whose state is kept.
const STATE_COST: u32 = 4;

/// Executes the program of a channel.
#[derive(Clone)]
pub struct Reader900 {
    channel: u8,
    texts: Texts,
    /// The parameters, while the control has given them.
    memory: Option<Memory>,
    /// Known with the first memory.
    begun: Option<Begun>,
    /// States before blocks whose elements were handed out, when they are kept.
    kept: Option<VecDeque<(Mark, Run)>>,
    /// Work that may still be done before [`Step::Starved`]; `None` for any amount.
    work: Option<u32>,
    interrupt: Option<Arc<AtomicBool>>,
    /// Where the axes stand before the first block.
    position: Position,
}

/// A run that has begun.
#[derive(Clone)]
struct Begun {
    axes: ChannelAxes,
    run: Run,
}

impl Reader900 {
    /// Prepares the run of a program in a channel, from 1; `files` finds the cycles beside it. It begins when it gets the
    /// [memory](Reader900::give_memory), at the block of P8801 where that is loaded.
    pub fn new(name: &str, bytes: &[u8], channel: u8, files: Arc<dyn Files>) -> Reader900 {
        Reader900 {
            channel,
            texts: Texts::new(name, bytes, files),
            memory: None,
            begun: None,
            kept: None,
            work: None,
            interrupt: None,
            position: Position::ZERO,
        }
    }

    /// The reader as one of these programs; `None` for a program in another language.
    pub fn of(reader: &dyn Reader) -> Option<&Reader900> {
        (reader as &dyn Any).downcast_ref()
    }

    /// The same to be changed.
    pub fn of_mut(reader: &mut dyn Reader) -> Option<&mut Reader900> {
        (reader as &mut dyn Any).downcast_mut()
    }

    /// Lends the parameters, without which nothing is read.
    pub fn give_memory(&mut self, memory: Memory) {
        if self.begun.is_none() {
            self.begun = Some(self.begin(&memory));
        }
        self.memory = Some(memory);
    }

    /// Gives the parameters back as they are now.
    pub fn take_memory(&mut self) -> Option<Memory> {
        self.memory.take()
    }

    /// The parameters, where they are lent.
    pub fn memory(&self) -> Option<&Memory> {
        self.memory.as_ref()
    }

    fn begin(&self, memory: &Memory) -> Begun {
        let mut run = Run::at(Modal::at_start(memory, self.channel), self.position);
        let first = memory.path(self.channel, PathParameter::FirstBlock).whole();
        let first = first
            .and_then(|number| u32::try_from(number).ok())
            .filter(|number| *number > 0);
        if let (Some(number), Some(level)) = (first, run.levels.last_mut()) {
            let line = self.texts.program(0).and_then(|program| program.line_of(number));
            match line {
                Some(line) => level.line = line,
                None => {
                    let refusal = Refusal::of(format!(
                        "the program has no block N{number}, with which P8801 begins"
                    ));
                    run.ended = Some(Ended::Failed(self.texts.failure(refusal, BlockRef::default())));
                }
            }
        }
        Begun {
            axes: ChannelAxes::of(memory, self.channel),
            run,
        }
    }

    fn run(&self) -> Option<&Run> {
        self.begun.as_ref().map(|begun| &begun.run)
    }

    fn run_mut(&mut self) -> Option<&mut Run> {
        self.begun.as_mut().map(|begun| &mut begun.run)
    }

    /// Takes work from what is allowed; `false` when nothing is left.
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

    /// Executes the next block. One that fails leaves everything as it was before it, where that is kept.
    fn step(&mut self) {
        let at = self.at();
        let Some(before) = self.run().map(|run| run.sequence) else {
            return;
        };
        let mark = Mark {
            sequence: before + 1,
            at,
        };
        let kept = self.kept.is_some().then(|| self.run().cloned()).flatten();
        let done = self.execute(at);
        let failed = done.err().map(|refusal| self.texts.failure(refusal, at));
        let Some(Begun { run, .. }) = &mut self.begun else {
            return;
        };
        match (failed, kept) {
            (None, Some(before)) if !run.queue.is_empty() => {
                if let Some(kept) = &mut self.kept {
                    kept.push_back((mark, before));
                }
            }
            (None, _) => {}
            (Some(error), before) => {
                if let Some(before) = before {
                    *run = before;
                }
                run.ended = Some(Ended::Failed(error));
            }
        }
    }

    /// The line that is executed next, and its block; nothing at the end of a program or cycle, which is then left.
    fn execute(&mut self, at: BlockRef) -> Result<(), Refusal> {
        let Some(Begun { axes, run }) = &mut self.begun else {
            return Ok(());
        };
        let Some(memory) = &mut self.memory else {
            return Ok(());
        };
        let Some(level) = run.levels.last().copied() else {
            run.ended = Some(Ended::Finished);
            return Ok(());
        };
        let Some(program) = self.texts.program(level.program).map(Arc::clone) else {
            return Ok(());
        };
        if level.line > program.line_count() {
            leave(run);
            return Ok(());
        }
        let block = match program.block(level.line) {
            None => {
                advance(run);
                return Ok(());
            }
            Some(Ok(block)) => block,
            Some(Err(faults)) => {
                let words = faults.into_iter().next().map(|fault| fault.message);
                return Err(Refusal::of(words.unwrap_or_default()));
            }
        };
        run.sequence += 1;
        run.idle += 1;
        if run.idle > IDLE_MAX {
            return Err(Refusal::of(format!(
                "{IDLE_MAX} blocks without a movement or a wait: the program is in a loop"
            )));
        }
        let mut work = Work {
            memory,
            channel: self.channel,
            axes,
            at: level.caller.unwrap_or(at),
            run,
            texts: &mut self.texts,
        };
        let next = work.block(&block)?;
        self.go_on(next, level)
    }

    fn go_on(&mut self, next: Next, level: Level) -> Result<(), Refusal> {
        let at = self.texts.block(level.program, level.line);
        let Some(Begun { run, .. }) = &mut self.begun else {
            return Ok(());
        };
        match next {
            Next::Line => advance(run),
            Next::End => run.levels.clear(),
            Next::Number(number) => {
                let program = self.texts.program(level.program);
                let line = program.and_then(|program| program.line_of(number));
                let missing = || Refusal::of(format!("no block has the number N{number}"));
                let line = line.ok_or_else(missing)?;
                if let Some(own) = run.levels.last_mut() {
                    own.line = line;
                }
            }
            Next::Cycle(number) => {
                if run.levels.len() > NESTING_MAX {
                    return Err(Refusal::of(format!(
                        "more than {NESTING_MAX} cycles call each other"
                    )));
                }
                let missing =
                    || Refusal::of(format!("the cycle Z{number}.900 does not lie beside the program"));
                let program = self.texts.cycle(number).ok_or_else(missing)?;
                advance(run);
                run.levels.push(Level {
                    program,
                    line: 1,
                    caller: level.caller.or(Some(at)),
                });
            }
        }
        Ok(())
    }

    /// The barrier is passed.
    fn pass(&mut self, then: Then) {
        let condition = self
            .memory
            .as_ref()
            .map(|memory| memory.path(self.channel, PathParameter::SkipCondition));
        let (Then::SkipTo(number), Some(1)) = (then, condition.and_then(|cell| cell.whole())) else {
            return;
        };
        let Some(Begun { run, .. }) = &mut self.begun else {
            return;
        };
        if let Some(level) = run.levels.last_mut() {
            let program = self.texts.program(level.program);
            // The text was checked: its targets are there.
            if let Some(line) = program.and_then(|program| program.line_of(number)) {
                level.line = line;
            }
        }
    }
}

/// The next line of the program.
fn advance(run: &mut Run) {
    if let Some(level) = run.levels.last_mut() {
        level.line = level.line.saturating_add(1);
    }
}

/// A program or cycle is over.
fn leave(run: &mut Run) {
    run.levels.pop();
    let open = run.levels.len();
    if open == 0 {
        run.ended = Some(Ended::Finished);
    }
}

impl ElementSource for Reader900 {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Box<ProgramError>> {
        loop {
            let Some(run) = self.run_mut() else {
                return Step::Starved;
            };
            if let Some((barrier, _)) = run.waiting {
                return Step::Barrier(barrier);
            }
            match run.queue.pop_front() {
                Some(Item::Element(element)) => return Step::Element(*element),
                Some(Item::Barrier(barrier, then)) => {
                    run.waiting = Some((*barrier, then));
                    return Step::Barrier(*barrier);
                }
                None => {}
            }
            match &run.ended {
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
        let waiting = self.run_mut().and_then(|run| run.waiting.take());
        if let Some((_, then)) = waiting {
            self.pass(then);
        }
    }
}

impl Reader for Reader900 {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, index: u16) -> Option<&Arc<Program>> {
        self.texts.shown(index)
    }

    fn at(&self) -> BlockRef {
        let level = self.run().and_then(|run| run.levels.last());
        level.map_or_else(BlockRef::default, |level| {
            self.texts.block(level.program, level.line)
        })
    }

    fn blocks_executed(&self) -> u64 {
        self.run().map_or(0, |run| run.sequence)
    }

    fn position(&self) -> Position {
        let run = self.run();
        let start = |run: &Run| match run.queue.front() {
            Some(Item::Element(element)) => element.start,
            _ => run.position,
        };
        run.map_or(self.position, start)
    }

    fn take_warnings(&mut self) -> Vec<Warning> {
        Vec::new()
    }

    fn goto(&mut self, block: u32) {
        let line = self.texts.line(BlockRef { program: 0, block });
        let (position, channel) = (Reader::position(self), self.channel);
        let Some(memory) = &self.memory else {
            return;
        };
        let modal = Modal::at_start(memory, channel);
        if let Some(run) = self.run_mut() {
            let sequence = run.sequence;
            *run = Run::at(modal, position);
            run.sequence = sequence;
            if let Some(level) = run.levels.last_mut() {
                level.line = line;
            }
        }
        if let Some(kept) = &mut self.kept {
            kept.clear();
        }
    }

    fn keep_checkpoints(&mut self) {
        self.kept = Some(VecDeque::new());
    }

    fn forget_before(&mut self, sequence: u64) {
        if let Some(kept) = &mut self.kept {
            while kept.get(1).is_some_and(|(next, _)| next.sequence <= sequence) {
                kept.pop_front();
            }
        }
    }

    fn go_back(&mut self, so: &dyn Fn(Mark) -> bool) {
        let Some(kept) = &mut self.kept else { return };
        let found = kept.iter().rposition(|(mark, _)| so(*mark));
        let state = found.and_then(|at| kept.swap_remove_back(at));
        kept.clear();
        if let (Some((_, state)), Some(run)) = (state, self.run_mut()) {
            *run = state;
        }
    }

    fn block_at(&self, sequence: u64) -> BlockRef {
        let mut kept = self.kept.iter().flatten();
        let state = kept.rfind(|(mark, _)| mark.sequence <= sequence);
        state.map_or_else(|| self.at(), |(mark, _)| mark.at)
    }

    fn retry(&mut self) {
        if let Some(run) = self.run_mut() {
            (run.ended, run.waiting) = (None, None);
        }
    }

    fn relocate(&mut self, position: &Position) {
        self.position = *position;
        if let Some(run) = self.run_mut() {
            run.queue.clear();
            run.waiting = None;
            run.position = *position;
        }
    }

    fn stand_at(&mut self, position: &Position) {
        let known = |own: &mut Position| {
            for axis in position.known().iter() {
                own[axis] = position[axis];
            }
        };
        known(&mut self.position);
        if let Some(run) = self.run_mut().filter(|run| run.queue.is_empty()) {
            known(&mut run.position);
        }
    }

    fn set_machine_rules(&mut self, _rules: MachineRules) {}

    fn allow(&mut self, work: u32) {
        self.work = Some(work);
    }

    fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }
}
