//! From the part program to the interpolator: an element source that keeps a checkpoint for each block and
//! refuses what leaves the traverse range.
//!
//! Decision: A block that would leave the traverse range is refused before it moves
//!
//! Decision: A block outside the traverse range is judged when everything before it is executed: a function may
//! change the range
//!
//! Decision: A block that moves an axis which the channel does not have is WRONG AXIS PROGRAMMED where it stands,
//! when everything before it is executed

use std::collections::VecDeque;

use bahn_parameters::MessageId;
use bahn_path::{
    Axis, AxisSet, Barrier, BlockRef, Curve, Direction, ElementSource, Function, LiveData, PathElement,
    PerAxis, Position, Step,
};
use bahn_reader::{Cause, Message, ProgramError, Reader};

use crate::kinematics::{Box2, Chain};

/// Work of the reader in one preparation at most, as [`Reader::allow`] counts it: some ms.
const WORK: u32 = 4096;
/// Work of the reader beside the control at most before the feeder is back: a command waits so long for it.
const WORK_BESIDE: u32 = 1024;
/// Steps that are read ahead beside the control at most.
const AHEAD: usize = 1024;

/// Why a run cannot go on.
#[derive(Clone, Debug, PartialEq)]
pub enum RunFault {
    /// The program is wrong.
    Program(Box<ProgramError>),
    /// A block would leave the traverse range [000:3522].
    Limit {
        /// The axis that would leave its range.
        axis: Axis,
        /// At which of its limits.
        direction: Direction,
        /// Program and number of the block.
        block: BlockRef,
        /// Its place in the order of execution.
        sequence: u64,
    },
    /// A block would move an axis that the channel does not have: it has gone to another one, or never was there, or a
    /// master or the PLC moves it.
    Absent {
        /// The axis that is missing.
        axis: Axis,
        /// Program and number of the block.
        block: BlockRef,
        /// Its place in the order of execution.
        sequence: u64,
    },
}

/// An error of a block of a program that is read; `None` while it is read elsewhere.
pub fn program_error(
    message: MessageId,
    detail: String,
    block: BlockRef,
    run: Option<&dyn Reader>,
) -> ProgramError {
    let program = run.and_then(|run| run.program(block.program));
    ProgramError {
        message: Message::Control(message),
        program: program.map_or_else(String::new, |program| program.name().to_owned()),
        block,
        detail,
        cause: Cause::default(),
    }
}

/// Steps of the reader that were read beside the control and nobody has taken yet.
#[derive(Clone, Default)]
struct Ahead {
    /// It is read beside the control alone: what is not read yet is waited for.
    on: bool,
    steps: VecDeque<Step<Box<ProgramError>>>,
    /// After the last step nothing is to be read before it is answered.
    dammed: bool,
}

impl Ahead {
    fn clear(&mut self) {
        self.steps.clear();
        self.dammed = false;
    }
}

/// Feeds the interpolator from a program.
#[derive(Clone)]
pub struct Feeder {
    reader: Box<dyn Reader>,
    /// What the reader was read ahead by, beside the control.
    ahead: Ahead,
    /// Kinematics with the offsets as of the last element handed out.
    chain: Chain,
    limits: Box2,
    /// The axes that there are.
    axes: AxisSet,
    /// How far M118 lets the handwheel lead them beside the path.
    beside: Position,
    fault: Option<RunFault>,
    /// Elements that were given back: they come next.
    found: VecDeque<PathElement>,
    /// An element outside the limits, and whether all before it is executed: a function before it may
    /// change traverse range or datum. It comes before those that were given back.
    refused: Option<(PathElement, bool)>,
    /// Elements read from the reader.
    read: u64,
    /// Executed elements for whoever wants to see the path.
    tap: Option<Vec<PathElement>>,
    /// What was handed out from this sequence on is not executed.
    dropped_from: Option<u64>,
}

impl Feeder {
    /// A feeder of a program, with the kinematics as the axes stand, the software limits and the axes that there are.
    pub fn new(mut reader: Box<dyn Reader>, chain: Chain, (limits, axes): (Box2, AxisSet)) -> Feeder {
        reader.keep_checkpoints();
        Feeder {
            reader,
            ahead: Ahead::default(),
            chain,
            limits,
            axes,
            beside: Position::ZERO,
            fault: None,
            found: VecDeque::new(),
            refused: None,
            read: 0,
            tap: None,
            dropped_from: None,
        }
    }

    /// The program that is read.
    pub fn reader(&self) -> &dyn Reader {
        &*self.reader
    }

    /// The same, to be changed.
    pub fn reader_mut(&mut self) -> &mut dyn Reader {
        &mut *self.reader
    }

    /// A long computation of it is done, or to be done, beside.
    fn is_computing(&self) -> bool {
        self.reader.is_computing()
    }

    /// The program is read beside the control from now on, by [`Feeder::read_ahead`], or no more.
    pub fn read_beside(&mut self, on: bool) {
        self.ahead.on = on;
        if on {
            self.ahead.steps.reserve(AHEAD);
        }
    }

    /// There is something to be read, and not much of it is there.
    pub fn wants_reading(&self) -> bool {
        let ahead = &self.ahead;
        ahead.on && !ahead.dammed && ahead.steps.len() <= AHEAD / 2 && !self.is_computing()
    }

    /// Reads ahead what one preparation may need, beside the control.
    pub fn read_ahead(&mut self) {
        self.reader.allow(WORK_BESIDE);
        while !self.ahead.dammed && self.ahead.steps.len() < AHEAD {
            let step = self.reader.next();
            match step {
                Step::Starved => return,
                Step::Element(_) => {}
                Step::Barrier(_) | Step::End | Step::Error(_) => self.ahead.dammed = true,
            }
            self.ahead.steps.push_back(step);
        }
    }

    /// The place in the order of execution of the block that comes next.
    pub fn next_sequence(&self) -> u64 {
        let refused = self.refused.as_ref().map(|(element, _)| element);
        let read = self.ahead.steps.front().and_then(|step| match step {
            Step::Element(element) => Some(element),
            _ => None,
        });
        let next = refused.or(self.found.front()).or(read);
        next.map_or(self.reader.blocks_executed() + 1, |element| element.sequence)
    }

    /// The program that is executed is in inches.
    pub fn inch(&self) -> bool {
        self.reader.is_in_inches()
    }

    /// Datum, machine zero in workpiece coordinates, traverse range and axes as they are now.
    pub fn set_datum(&mut self, datum: Position, machine_zero: Position, (limits, axes): (Box2, AxisSet)) {
        (self.limits, self.axes) = (limits, axes);
        self.chain.offsets.datum = datum;
        self.reader.set_machine_zero(&machine_zero);
    }

    /// These axes may come to the channel before a block moves them.
    pub fn expect_axes(&mut self, axes: AxisSet) {
        self.axes = axes;
    }

    /// Goes back before a block that was read ahead and is not executed: what was read from there on is read again, with the
    /// kinematics and offsets of where the path stands.
    pub fn read_again_from(&mut self, sequence: u64, chain: &Chain) {
        self.reader.go_back(&|mark| mark.sequence == sequence);
        self.ahead.clear();
        self.found.clear();
        self.refused = None;
        self.fault = None;
        self.chain.clone_from(chain);
        if let Some(tap) = &mut self.tap {
            tap.retain(|element| element.sequence < sequence);
            self.dropped_from = Some(sequence);
        }
    }

    /// All that was read was handed out: the reader is where the path is.
    pub fn is_drained(&self) -> bool {
        self.ahead.steps.is_empty() && self.found.is_empty() && self.refused.is_none()
    }

    /// Gives elements back, to come again before all others.
    pub fn put_back(&mut self, elements: impl DoubleEndedIterator<Item = PathElement>) {
        let refused = self.refused.take().map(|(element, _)| element);
        for element in refused.into_iter().chain(elements.rev()) {
            self.found.push_front(element);
        }
    }

    /// Elements that were read so far.
    pub fn elements_read(&self) -> u64 {
        self.read
    }

    /// Keeps a copy of every element that is handed out.
    pub fn set_tap(&mut self, on: bool) {
        self.tap = on.then(Vec::new);
    }

    /// The elements handed out since the last call.
    pub fn take_tap(&mut self) -> Vec<PathElement> {
        self.tap.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Of what was handed out before these: what comes from a sequence on is not executed.
    pub fn take_dropped(&mut self) -> Option<u64> {
        self.dropped_from.take()
    }

    /// What is executed now: nobody goes back after it.
    pub fn forget_before(&mut self, sequence: u64) {
        self.reader.forget_before(sequence);
    }

    /// Allows the work of one preparation: a program that only calculates must not hold the control.
    pub fn allow_work(&mut self) {
        self.reader.allow(WORK);
    }

    /// Goes back to the state before a block, which then starts from where the axes stand.
    pub fn return_to(&mut self, sequence: u64, machine: &Position, chain: &Chain, limits: Box2) {
        if sequence <= self.reader.blocks_executed() {
            self.reader.go_back(&|mark| mark.sequence <= sequence);
        }
        self.begin_again(machine, chain, limits);
    }

    /// The movement that is executed ends where the axes stand; nothing after it was read, and the program goes on there.
    pub fn cut(&mut self, machine: &Position, chain: &Chain, limits: Box2) {
        self.begin_again(machine, chain, limits);
    }

    /// The block to which [`Feeder::return_to`] goes back.
    pub fn block_at(&self, sequence: u64) -> BlockRef {
        match sequence <= self.reader.blocks_executed() {
            true => self.reader.block_at(sequence),
            false => self.reader.at(),
        }
    }

    /// The block to which [`Feeder::retry`] goes back.
    pub fn block_of_fault(&self) -> BlockRef {
        match &self.fault {
            Some(RunFault::Limit { sequence, .. } | RunFault::Absent { sequence, .. }) => {
                self.block_at(*sequence)
            }
            Some(RunFault::Program(error)) => error.block,
            None => self.reader.at(),
        }
    }

    /// Goes back to the block that could not be executed.
    pub fn retry(&mut self, machine: &Position, chain: &Chain, limits: Box2) {
        match self.fault.take() {
            Some(RunFault::Limit { sequence, .. } | RunFault::Absent { sequence, .. }) => {
                return self.return_to(sequence, machine, chain, limits);
            }
            Some(RunFault::Program(error)) if self.reader.at() != error.block => {
                self.reader.go_back(&|mark| mark.at == error.block);
            }
            _ => {}
        }
        self.begin_again(machine, chain, limits);
    }

    fn begin_again(&mut self, machine: &Position, chain: &Chain, limits: Box2) {
        self.ahead.clear();
        self.found.clear();
        self.refused = None;
        self.fault = None;
        self.chain.clone_from(chain);
        self.limits = limits;
        self.beside = Position::ZERO;
        self.reader.retry();
        self.chain.place(self.reader.placement());
        self.reader.relocate(&self.chain.to_path(machine));
    }

    /// The next step of the program.
    fn read(&mut self) -> Step<RunFault> {
        let step = match self.ahead.steps.pop_front() {
            Some(step) => step,
            None if self.ahead.on => self.answer_of_dam(),
            None => self.reader.next(),
        };
        let element = match step {
            Step::Element(element) => element,
            Step::Barrier(barrier) => {
                let Barrier::Scan { block, .. } = barrier else {
                    return Step::Barrier(barrier);
                };
                let fault = self.range_fault(block);
                return fault.map_or(Step::Barrier(barrier), |error| self.fail(error));
            }
            Step::Starved => return Step::Starved,
            Step::End => return Step::End,
            Step::Error(error) => return self.fail(error),
        };
        if let Some(error) = self.range_fault(element.block) {
            return self.fail(error);
        }
        self.read += 1;
        for output in element.functions() {
            self.chain.offsets.take(&output.function);
        }
        if let Some(tap) = &mut self.tap {
            tap.push(element.clone());
        }
        Step::Element(element)
    }

    fn fail(&mut self, error: Box<ProgramError>) -> Step<RunFault> {
        let fault = RunFault::Program(error);
        self.fault = Some(fault.clone());
        Step::Error(fault)
    }

    /// A block that moves the axes beside the path, and whose range reaches beyond the software limits [003:8047-8051].
    fn range_fault(&self, block: BlockRef) -> Option<Box<ProgramError>> {
        let [min, max] = self.reader.range(block)?;
        let [least, greatest] = &self.limits;
        let outside = |axis: &Axis| {
            let offset = self.chain.offsets.of(*axis);
            min[*axis] + offset < least[*axis] || max[*axis] + offset > greatest[*axis]
        };
        let axis = Axis::ALL.into_iter().find(outside)?;
        let why = format!("the range leaves the traverse range of {}", axis.letter());
        let run = Some(&*self.reader);
        Some(Box::new(program_error(
            MessageId::FaultyRangeData,
            why,
            block,
            run,
        )))
    }

    /// After a barrier or the end the reader says the same again; what is not read yet is waited for.
    fn answer_of_dam(&mut self) -> Step<Box<ProgramError>> {
        match self.ahead.dammed {
            true => self.reader.next(),
            false => Step::Starved,
        }
    }

    /// Takes the ranges of M118 in an element.
    fn take_ranges(&mut self, element: &PathElement, range_of: impl Fn(Axis, &Position) -> f64) {
        for output in element.functions() {
            if let Function::Superimpose(range) = &output.function {
                self.beside = PerAxis::from_fn(|axis| range_of(axis, range)).into();
            }
        }
    }

    /// The first axis that would leave its range on an element, or is not there.
    fn outside(&self, element: &PathElement) -> Option<RunFault> {
        // The resolution of positions is no violation.
        const ROUNDING: f64 = 1e-6;
        let mut axes = Axis::ALL.into_iter();
        if let Some(axis) = axes.find(|axis| !self.axes.contains(*axis) && element.moves_axis(*axis)) {
            let (block, sequence) = (element.block, element.sequence);
            return Some(RunFault::Absent {
                axis,
                block,
                sequence,
            });
        }
        let [min, max] = self.chain.bounds(element);
        let [least, greatest] = &self.limits;
        for axis in Axis::ALL {
            let upright = element.placement.is_none() && element.curve == Curve::Line;
            let placed = element.placement.is_some() && !element.moves_axis(axis);
            if placed || upright && element.start[axis] == element.end[axis] {
                continue;
            }
            let beside = self.beside[axis];
            let direction = if max[axis] + beside > greatest[axis] + ROUNDING {
                Direction::Plus
            } else if min[axis] - beside < least[axis] - ROUNDING {
                Direction::Minus
            } else {
                continue;
            };
            return Some(RunFault::Limit {
                axis,
                direction,
                block: element.block,
                sequence: element.sequence,
            });
        }
        None
    }
}

impl ElementSource for Feeder {
    type Error = RunFault;

    fn next(&mut self) -> Step<RunFault> {
        if let Some(fault) = &self.fault {
            return Step::Error(fault.clone());
        }
        let (element, last) = match self.refused.take() {
            Some(refused) => refused,
            None => match self.found.pop_front() {
                Some(found) => (found, false),
                None => match self.read() {
                    Step::Element(element) => (element, false),
                    other => return other,
                },
            },
        };
        let before = self.beside;
        self.take_ranges(&element, |axis, range| before[axis].max(range[axis]));
        if element.curve != Curve::Hold
            && let Some(fault) = self.outside(&element)
        {
            if last {
                self.fault = Some(fault.clone());
                return Step::Error(fault);
            }
            let block = element.block;
            self.refused = Some((element, false));
            self.beside = before;
            return Step::Barrier(Barrier::Acknowledge { block });
        }
        // The handwheel goes back on the element that cancels its range.
        self.take_ranges(&element, |axis, range| range[axis]);
        Step::Element(element)
    }

    fn resume(&mut self, live: LiveData) {
        match &mut self.refused {
            Some((_, last)) => {
                *last = true;
                self.reader.take_values(&live);
            }
            None => {
                self.ahead.dammed = false;
                self.reader.resume(live);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]
    use std::sync::Arc;

    use bahn_interpreter::{Interpreter, NoPrograms, Settings};
    use bahn_program::Program;

    use super::*;
    use crate::kinematics::{Cartesian, Offsets};

    fn feeder(blocks: &str) -> Feeder {
        let text = format!("BEGIN PGM 1 MM\n{blocks}\nEND PGM 1 MM\n");
        let program = Arc::new(Program::from_bytes("1.H", text.into()));
        let mut datum = Position::ZERO;
        datum[Axis::X] = 100.0;
        datum[Axis::Z] = -50.0;
        let offsets = Offsets {
            datum,
            tool_axis: Axis::Z,
            tool_length: 0.0,
        };
        let limits = [PerAxis::splat(-200.0).into(), PerAxis::splat(200.0).into()];
        let settings = Settings {
            start: Position::ZERO,
            tool_length_mm: Some(0.0),
            ..Settings::default()
        };
        let chain = Chain::new(Arc::new(Cartesian), offsets);
        let axes = Axis::ALL.into_iter().collect();
        let interpreter = Interpreter::new(program, settings, Arc::new(NoPrograms));
        Feeder::new(Box::new(interpreter), chain, (limits, axes))
    }

    fn end(blocks: &str) -> Step<RunFault> {
        let mut feeder = feeder(blocks);
        loop {
            match feeder.next() {
                Step::Element(_) => {}
                Step::Barrier(_) => feeder.resume(LiveData::default()),
                step => return step,
            }
        }
    }

    /// X datum at machine 100: X+100 is machine 200, the limit; X+100.01 is beyond it.
    #[test]
    fn a_block_beyond_the_limit_is_refused() {
        assert_eq!(end("L X+100 R0 FMAX"), Step::End);
        let limit = |axis, direction| {
            Step::Error(RunFault::Limit {
                axis,
                direction,
                block: BlockRef { program: 0, block: 1 },
                sequence: 1,
            })
        };
        assert_eq!(end("L X+100.01 R0 FMAX"), limit(Axis::X, Direction::Plus));
        assert_eq!(end("L Z-150.5 R0 FMAX"), limit(Axis::Z, Direction::Minus));
    }

    /// The tool lifts the spindle nose by its length: Z datum -50, tool 80 long: Z+170 is machine 200.
    #[test]
    fn the_tool_length_counts() {
        let program = |z: &str| format!("TOOL DEF 1 L+80 R+1\nTOOL CALL 1 Z S1\nL Z{z} R0 FMAX");
        assert_eq!(end(&program("+170")), Step::End);
        assert!(matches!(end(&program("+170.1")), Step::Error(_)));
    }

    /// A circle whose ends are inside bulges over the limit.
    #[test]
    fn arcs_count_with_their_whole_way() {
        let circle = |r: &str| format!("L X+99 Y+0 R0 FMAX\nCC X+99 Y+{r}\nC X+99 Y+0 DR+ R0 F100");
        assert_eq!(end(&circle("1")), Step::End);
        assert!(matches!(end(&circle("1.5")), Step::Error(_)));
    }

    /// After an internal stop in block 3 the run goes on with block 3 from where the axes stand; Q1 is as
    /// of that block.
    #[test]
    fn return_to_a_block() {
        let mut feeder = feeder("FN 0: Q1 = +5\nL X+10 R0 F100\nL X+20\nFN 0: Q1 = +7\nL X+Q1");
        let mut third = None;
        while let Step::Element(element) = feeder.next() {
            if element.block.block == 3 {
                third = Some(element.sequence);
            }
        }
        let mut machine = Position::ZERO;
        machine[Axis::X] = 112.0;
        let (chain, limits) = (feeder.chain.clone(), feeder.limits);
        feeder.return_to(third.unwrap(), &machine, &chain, limits);
        assert_eq!(Interpreter::of(feeder.reader()).unwrap().q_values()[1], 5.0);
        let Step::Element(again) = feeder.next() else {
            panic!("block 3 runs again")
        };
        assert_eq!(
            (again.block.block, again.start[Axis::X], again.end[Axis::X]),
            (3, 12.0, 20.0)
        );
    }
}
