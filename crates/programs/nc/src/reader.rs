//! A DIN 66025 program that is read block by block.
//!
//! Decision: A run begins with no block of a subroutine (`%L`), where no caller is to go back to: WRONG PROGRAM DATA.
//! A number is looked for in subroutines only where no program of the file has it (also `program/src/program.rs`)
//!
//! Decision: The programs of a file run one after the other, as on the channel; M17 and M29 end subroutines and go to
//! no PLC
//!
//! Decision: G41 and G42 are refused on a machine: the tool in its spindle has a radius, which these programs do not
//! know

use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_din::{BlockFault, Command, Decoder, Motion, Unit};
use bahn_parameters::MessageId;
use bahn_path::{
    Axis, Barrier, BlockRef, Curve, ElementSource, FeedRate, LiveData, PathElement, Position, Step, Switch,
};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, ProgramError, Reader, Start, Warning, synchronisation_point};
use bahn_text::Files;

use crate::functions::{self, Ordered, Refusal};
use crate::onward;
use crate::texts::Texts;
use crate::variables::Model;

/// Executes the programs of a file one after the other.
#[derive(Clone)]
pub struct NcReader {
    start: Start,
    texts: Texts,
    file: Arc<bahn_din::Program>,
    beside: Arc<dyn Files>,
    run: Run,
    /// States before blocks whose elements were handed out, when they are kept.
    kept: Option<VecDeque<(Mark, Run)>>,
    /// Work that may still be done before [`Step::Starved`]; `None` for any amount.
    work: Option<u32>,
    interrupt: Option<Arc<AtomicBool>>,
}

/// All that changes while it runs: a state to go back to is a copy.
#[derive(Clone)]
struct Run {
    /// Or why there is nothing to go on with, until a run begins elsewhere.
    decoder: Result<Decoder, Box<ProgramError>>,
    /// Which of the programs of the file it is.
    program: usize,
    /// How many blocks were executed so far.
    sequence: u64,
    /// End of the last element that was handed out.
    position: Position,
    /// `#VECTOR LIMIT`: the greatest velocity of the path, mm/min.
    limit_mm_min: f64,
    queue: VecDeque<Item>,
    waiting: Option<Barrier>,
    /// The block that has stopped the run last, and its function.
    stopped: Option<(BlockRef, &'static str)>,
    ended: Option<Ended>,
}

#[derive(Clone)]
enum Item {
    Element(PathElement),
    Barrier(Barrier),
}

#[derive(Clone)]
enum Ended {
    Finished,
    Failed(Box<ProgramError>),
}

/// Why a file cannot be run.
const NO_PROGRAM: &str = "the file has no program, only subroutines";

/// What a block costs whose state is kept.
const STATE_COST: u32 = 4;

impl Run {
    /// Before the first block of a program.
    fn at(position: Position, decoder: Result<Decoder, Box<ProgramError>>) -> Run {
        Run {
            decoder,
            program: 0,
            sequence: 0,
            position,
            limit_mm_min: f64::INFINITY,
            queue: VecDeque::new(),
            waiting: None,
            stopped: None,
            ended: None,
        }
    }
}

impl NcReader {
    /// Prepares the run of the programs of a file; `name` is its path, `beside` finds the subroutines beside it.
    pub fn new(name: &str, bytes: &[u8], start: Start, beside: Arc<dyn Files>) -> NcReader {
        let file = Arc::new(bahn_din::Program::from_bytes(name, bytes));
        let texts = Texts::new(name, bytes);
        let decoder = match file.mains().next() {
            Some(main) => Ok(Decoder::new(file.clone(), main, start.position, beside.clone())),
            None => Err(texts.failure(Refusal::of_data(NO_PROGRAM), BlockRef::default())),
        };
        NcReader {
            run: Run::at(start.position, decoder),
            start,
            texts,
            file,
            beside,
            kept: None,
            work: None,
            interrupt: None,
        }
    }

    /// The reader as one of these programs; `None` for a program in another language.
    pub fn of(reader: &dyn Reader) -> Option<&NcReader> {
        (reader as &dyn Any).downcast_ref()
    }

    /// What stops the run in a block that is a stop: M0; `None` for a tool change.
    pub fn stop_function(&self, block: BlockRef) -> Option<&'static str> {
        let stopped = self.run.stopped.filter(|(at, _)| *at == block);
        stopped.map(|(_, function)| function)
    }

    /// The program in which a block stands, from this block on with new modal data, where the path is (inferred), and
    /// which of the file it is.
    fn beginning_at(&self, block: u32) -> Result<(usize, Decoder), Refusal> {
        let line = self.texts.line(block);
        // Block 0 is the begin that no such program writes.
        if block > 0 && self.file.is_in_subroutine(line) {
            return Err(Refusal::of_data("the block stands in a subroutine"));
        }
        let mains = || self.file.mains().enumerate();
        let main = mains().take_while(|(_, main)| main.line <= line).last();
        let Some((program, main)) = main.or_else(|| mains().next()) else {
            return Err(Refusal::of_data(NO_PROGRAM));
        };
        let file = Arc::clone(&self.file);
        let mut decoder = Decoder::new(file, main, self.run.position, Arc::clone(&self.beside));
        decoder.goto(line);
        Ok((program, decoder))
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

    /// Executes the next block. One that fails leaves everything as it was before it; where no state before it is kept,
    /// nothing goes on after it.
    fn step(&mut self) {
        let at = self.at();
        let mark = Mark {
            sequence: self.run.sequence + 1,
            at,
        };
        let before = self.kept.is_some().then(|| self.run.clone());
        match (self.execute(at), before) {
            (Ok(()), Some(before)) if !self.run.queue.is_empty() => {
                if let Some(kept) = &mut self.kept {
                    kept.push_back((mark, before));
                }
            }
            (Ok(()), _) => {}
            (Err(error), before) => {
                match before {
                    Some(before) => self.run = before,
                    None => self.run.decoder = Err(error.clone()),
                }
                self.run.ended = Some(Ended::Failed(error));
            }
        }
    }

    fn execute(&mut self, at: BlockRef) -> Result<(), Box<ProgramError>> {
        let decoder = self.run.decoder.as_mut().map_err(|error| error.clone())?;
        let mut model = Model::of(self.start.model);
        let unit = match decoder.next(&mut model) {
            bahn_din::Step::Unit(unit) => unit,
            bahn_din::Step::Fault(fault) => {
                return Err(self.texts.failure(of_text(&fault, &model), at));
            }
            bahn_din::Step::End => {
                self.end();
                return Ok(());
            }
        };
        self.texts.take(decoder.files());
        if !is_end_of_text(&unit) {
            self.run.sequence += 1;
        }
        self.take(&unit, at)
            .map_err(|refusal| self.texts.failure(refusal, at))?;
        if unit.ends {
            self.end();
        }
        Ok(())
    }

    /// A program of the file is over; the next one begins, with new modal data, where the path is (inferred).
    fn end(&mut self) {
        let next = self.run.program + 1;
        match (self.file.mains().nth(next), &mut self.run.decoder) {
            (Some(main), Ok(decoder)) => {
                decoder.begin_program(main);
                self.run.program = next;
                self.run.limit_mm_min = f64::INFINITY;
            }
            _ => self.run.ended = Some(Ended::Finished),
        }
    }

    /// Makes elements of a block.
    fn take(&mut self, unit: &Unit, at: BlockRef) -> Result<(), Refusal> {
        let Ordered { mut functions, stops } = functions::of_block(unit, &self.start)?;
        let mut waits = false;
        for command in &unit.commands {
            match command {
                Command::ExplicitSynchronisation => functions.push(synchronisation_point()),
                Command::Flush { wait } => waits |= self.flush(*wait)?,
                Command::VectorLimit {
                    velocity_mm_min,
                    acceleration_mm_s2: None,
                    deceleration_mm_s2: None,
                } => self.run.limit_mm_min = velocity_mm_min.unwrap_or(f64::INFINITY),
                Command::RadiusCompensation(Switch::Off) | Command::Spindle(_) => {}
                other => return Err(Refusal::of_channel(named(other))),
            }
        }
        let functions = (!functions.is_empty()).then(|| functions.into_boxed_slice());
        if let Some(mut element) = self.motion(unit, at)? {
            element.functions = functions;
            element.dwell_s = unit.dwell_s;
            self.run.queue.push_back(Item::Element(element));
        } else if functions.is_some() || unit.dwell_s > 0.0 {
            let ends = [self.run.position; 2];
            let mut element = PathElement::new(at, self.run.sequence, Curve::Hold, ends, FeedRate::Rapid);
            element.functions = functions;
            element.dwell_s = unit.dwell_s;
            self.run.queue.push_back(Item::Element(element));
        }
        if let Some(stop) = stops {
            self.run.stopped = stop.map(|function| (at, function));
            self.run
                .queue
                .push_back(Item::Barrier(Barrier::Stop { block: at }));
        } else if waits {
            self.run
                .queue
                .push_back(Item::Barrier(Barrier::Acknowledge { block: at }));
        }
        Ok(())
    }

    /// The motion of a block, from where the axes stand.
    fn motion(&self, unit: &Unit, at: BlockRef) -> Result<Option<PathElement>, Refusal> {
        let Some(motion) = &unit.motion else {
            return Ok(None);
        };
        let Motion {
            begin, start, end, ..
        } = motion;
        let curve = match &motion.curve {
            Curve::Arc(arc) => onward::rest(arc, begin, start, end).map_err(|detail| Refusal {
                message: MessageId::CircleEndPosIncorrect,
                detail: detail.to_owned(),
            })?,
            other => *other,
        };
        if curve.length(start, end) == 0.0 && curve.rotary_length(start, end) == 0.0 {
            return Ok(None);
        }
        let feed = motion.feed().up_to(self.run.limit_mm_min);
        let element = PathElement::new(at, self.run.sequence, curve, [*start, *end], feed);
        if let Some(axis) = self.start.absent.iter().find(|axis| element.moves(*axis)) {
            return Err(Refusal {
                message: MessageId::WrongAxisProgrammed,
                detail: format!("no program of this machine moves {axis}"),
            });
        }
        Ok(Some(element))
    }

    /// `#FLUSH`: nothing goes out ahead across it [004:126]. Without functions that go out ahead there is nothing to do.
    /// Whether the path waits there.
    fn flush(&self, wait: bool) -> Result<bool, Refusal> {
        match wait || !self.start.functions.lead() {
            true => Ok(wait),
            false => Err(Refusal::of_channel(
                "#FLUSH without WAIT, on a machine with functions that go out ahead",
            )),
        }
    }
}

/// The end of the text, which is no block.
fn is_end_of_text(unit: &Unit) -> bool {
    unit.ends && unit.functions.is_empty() && unit.motion.is_none()
}

/// A block that cannot be read or executed, by its text or because it wants a variable of a channel.
fn of_text(fault: &BlockFault, model: &Model) -> Refusal {
    Refusal {
        message: match model.refused {
            true => MessageId::BlockNotSupported,
            false => MessageId::WrongProgramData,
        },
        detail: fault.message.clone(),
    }
}

/// What a command is called that only a channel of the TF5200 executes.
fn named(command: &Command) -> &'static str {
    match command {
        Command::ExplicitSynchronisation => "#EXPL SYN",
        Command::Flush { .. } => "#FLUSH",
        Command::MicroJoint { .. } => "#CHANNEL SET [M_PRE_OUTPUT ..]: this control has no Micro Joints",
        Command::VectorLimit { .. } => {
            "#VECTOR LIMIT with ACC or DEC: machine parameters limit acceleration here"
        }
        Command::EdgeBanding(_) => "G107 and G108: this control measures no edge banding",
        Command::RadiusCompensation(_) => "G41 and G42: no tool has a radius in these programs",
        Command::Independent(_) => "INDP: axes of this control move on their own by the PLC",
        Command::Spindle(_) => "POS",
    }
}

impl ElementSource for NcReader {
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
            if self.is_interrupted() || !self.spend() {
                return Step::Starved;
            }
            self.step();
        }
    }

    fn resume(&mut self, _live: LiveData) {
        self.run.waiting = None;
    }
}

impl Reader for NcReader {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, index: u16) -> Option<&Arc<Program>> {
        self.texts.get(index)
    }

    fn at(&self) -> BlockRef {
        match &self.run.decoder {
            Ok(decoder) => self.texts.block(&decoder.at()),
            Err(error) => error.block,
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
        let begun = self.beginning_at(block);
        let (program, decoder) = match begun {
            Ok((program, decoder)) => (program, Ok(decoder)),
            Err(refusal) => (
                0,
                Err(self.texts.failure(refusal, BlockRef { program: 0, block })),
            ),
        };
        self.run = Run {
            program,
            sequence: self.run.sequence,
            ..Run::at(self.run.position, decoder)
        };
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
        if let Some((_, state)) = found.and_then(|at| kept.swap_remove_back(at)) {
            self.run = state;
        }
        kept.clear();
    }

    fn block_at(&self, sequence: u64) -> BlockRef {
        let mut kept = self.kept.iter().flatten();
        let state = kept.rfind(|(mark, _)| mark.sequence <= sequence);
        state.map_or_else(|| self.at(), |(mark, _)| mark.at)
    }

    fn retry(&mut self) {
        (self.run.ended, self.run.waiting) = (None, None);
    }

    fn relocate(&mut self, position: &Position) {
        self.run.queue.clear();
        self.run.waiting = None;
        self.run.position = *position;
        if let Ok(decoder) = &mut self.run.decoder {
            decoder.relocate(*position);
        }
    }

    fn stand_at(&mut self, position: &Position) {
        if !self.run.queue.is_empty() {
            return;
        }
        for axis in Axis::ALL.into_iter().filter(|axis| !position[*axis].is_nan()) {
            self.run.position[axis] = position[axis];
        }
        if let Ok(decoder) = &mut self.run.decoder {
            decoder.set_position(self.run.position);
        }
    }

    fn set_machine_rules(&mut self, rules: MachineRules) {
        self.start.rules = rules;
    }

    fn allow(&mut self, work: u32) {
        self.work = Some(work);
    }

    fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }
}
