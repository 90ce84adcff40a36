//! Rehearses a program: executes it without geometry and goes on after each fault, to find all of them.
//!
//! A fault leaves things in doubt: without the TOOL CALL that could not be read there is no tool either. What
//! is only such a consequence is not reported, so that one mistake is one error. The same holds for what a
//! Q parameter decides that the program itself never set.
//!
//! Decision: `check` executes programs without geometry and goes on after errors; what an earlier error or a Q
//! parameter that the program never set leaves in doubt is no error of its own

use std::collections::HashSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_parameters::MessageId;
use bahn_path::{BlockRef, LiveData, Touch};
use bahn_program::{Compensation, Feed, MotionKind, Operation, Program, Value, each_parameter};
use bahn_reader::Programs;

use crate::contour::Contour;
use crate::error::{Cause, Fault, Message, ProgramError, Warning, WarningKind};
use crate::output::{Item, Output};
use crate::q_parameters::preassigned;
use crate::settings::Settings;
use crate::{Ended, Interpreter};

/// Blocks that are executed at most, beside those of the program: loops end there.
const BLOCKS_MAX: u64 = 1_000_000;
/// Stands for the feed of a block that cannot be read.
const ASSUMED_FEED_MM_MIN: f64 = 100.0;
/// Errors and warnings that are kept, each.
const FOUND_MAX: usize = 1000;

/// What a rehearsal has found.
#[derive(Debug, Default)]
pub struct Rehearsal {
    /// The errors in the order of execution, each block once; at most a thousand.
    pub errors: Vec<ProgramError>,
    /// The warnings; at most a thousand.
    pub warnings: Vec<Warning>,
    /// The programs of the run by their number.
    pub programs: Vec<Arc<Program>>,
    /// The end was reached.
    pub complete: bool,
    /// The Q parameters at the end, by their number; none where the program set none, or from such a one.
    pub q_values: Vec<Option<f64>>,
}

/// Rehearses a program with those that it calls.
///
/// Labels, calls, modal data and all values are as in a run; cycles and contours are looked at but not
/// machined. Loops are followed for a million blocks, or until `interrupt` is set.
///
/// ```
/// use std::sync::Arc;
/// use std::sync::atomic::AtomicBool;
/// use bahn_interpreter::{NoPrograms, Settings, rehearse};
/// use bahn_program::Program;
///
/// let text = "BEGIN PGM 1 MM\nL X+5 Y+0 RL F100\nL X+9\nC X+5 Y+5 DR+\nEND PGM 1 MM\n";
/// let program = Arc::new(Program::from_bytes("1.H", text.into()));
/// let found = rehearse(program, Settings::default(), Arc::new(NoPrograms), &AtomicBool::new(false));
/// // No tool is called before RL; no CC is programmed before C.
/// let blocks: Vec<u32> = found.errors.iter().map(|error| error.block.block).collect();
/// assert_eq!(blocks, [1, 3]);
/// ```
pub fn rehearse(
    main: Arc<Program>,
    settings: Settings,
    programs: Arc<dyn Programs>,
    interrupt: &AtomicBool,
) -> Rehearsal {
    let settings = Settings {
        machine: false,
        // Loops are bounded here.
        max_blocks_without_motion: u64::MAX,
        ..settings
    };
    let blocks_max = BLOCKS_MAX.saturating_add(u64::from(main.block_count()));
    let mut rehearser = Rehearser::new(Interpreter::new(main, settings, programs));
    for count in 0..blocks_max {
        if rehearser.found.errors.len() >= FOUND_MAX {
            // It is no program at all.
            break;
        }
        if rehearser.run.ended.is_some() {
            rehearser.found.complete = true;
            break;
        }
        const LOOK_PERIOD: u64 = 1 << 12;
        if count % LOOK_PERIOD == 0 && interrupt.load(std::sync::atomic::Ordering::Relaxed) {
            break;
        }
        rehearser.block();
    }
    rehearser.finish()
}

/// Things that may be missing because of an earlier fault, as a set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Doubts(u16);

impl Doubts {
    const NONE: Doubts = Doubts(0);
    const TOOL: Doubts = Doubts(1);
    const TOOL_DATA: Doubts = Doubts(1 << 1);
    const POLE: Doubts = Doubts(1 << 2);
    const FEED: Doubts = Doubts(1 << 3);
    const POSITION: Doubts = Doubts(1 << 4);
    const COMPENSATION: Doubts = Doubts(1 << 5);
    const CYCLE: Doubts = Doubts(1 << 6);
    const BLANK: Doubts = Doubts(1 << 7);
    const FLOW: Doubts = Doubts(1 << 8);
    const ALL: Doubts = Doubts(u16::MAX);

    const fn and(self, other: Doubts) -> Doubts {
        Doubts(self.0 | other.0)
    }

    fn any_of(self, other: Doubts) -> bool {
        self.0 & other.0 != 0
    }

    const fn without(self, other: Doubts) -> Doubts {
        Doubts(self.0 & !other.0)
    }
}

/// What is needed of a block once it is executed.
struct Effect {
    /// What it sets, and leaves in doubt when it fails.
    sets: Doubts,
    /// What is certain when it succeeds.
    settles: Doubts,
    /// It depends on a Q parameter of unknown value.
    unknown: bool,
}

struct Rehearser {
    run: Interpreter,
    found: Rehearsal,
    doubts: Doubts,
    /// Q parameters whose value the program did not set, or set from such a one.
    unknown_q: Vec<bool>,
    /// Blocks with an error.
    reported: HashSet<BlockRef>,
    warned: HashSet<(BlockRef, WarningKind)>,
}

impl Rehearser {
    fn new(mut run: Interpreter) -> Rehearser {
        run.run.pen.rehearsal = true;
        // Those of the control are known, but not what PLC [003:7587] and probe leave.
        let known = |number: usize| number >= usize::from(preassigned::TOOL_RADIUS);
        let touched = |number: usize| number >= usize::from(preassigned::TOUCH) && number < 123;
        let mut unknown_q: Vec<bool> = (0..run.run.numbers.q.values().len())
            .map(|number| !known(number) || touched(number))
            .collect();
        for &(number, _) in &run.settings.q_values {
            if let Some(unknown) = unknown_q.get_mut(usize::from(number)) {
                *unknown = false;
            }
        }
        Rehearser {
            run,
            found: Rehearsal::default(),
            doubts: Doubts::NONE,
            unknown_q,
            reported: HashSet::new(),
            warned: HashSet::new(),
        }
    }

    /// Executes the next block and notes what is wrong with it.
    fn block(&mut self) {
        let at = self.run.run.at.block_ref();
        let skips = self.run.settings.skip_blocks;
        let operation = self
            .run
            .code
            .block(at.program, at.block)
            .filter(|fetched| !(fetched.block.skip && skips))
            .map(|fetched| fetched.block.operation.clone());
        let effect = operation.as_ref().map(|operation| self.effect(operation));
        let result = self.run.step().and_then(|()| self.touch());
        self.run.run.pen.out = Output::default();
        let Some((operation, effect)) = operation.zip(effect) else {
            if result.is_err() {
                // After the last block: an open subprogram.
                self.fault(result, at, Doubts::NONE, false);
            }
            return;
        };
        self.propagate(&operation, effect.unknown || result.is_err());
        match result {
            Ok(()) if effect.unknown => self.doubts = self.doubts.and(effect.sets),
            Ok(()) => self.doubts = self.doubts.without(effect.settles),
            Err(_) => {
                self.fault(result, at, effect.sets, effect.unknown);
                self.recover(at, &operation);
            }
        }
        self.take_warnings();
    }

    /// A probe touches where the block says it will.
    fn touch(&mut self) -> Result<(), Fault> {
        let to = self.run.run.pen.out.queue.iter().find_map(|item| match item {
            Item::Barrier(bahn_path::Barrier::Probe { to, .. }) => Some(*to),
            _ => None,
        });
        let Some(position) = to else { return Ok(()) };
        let live = LiveData {
            touch: Some(Touch { position }),
            ..LiveData::default()
        };
        self.run.run.finish_probing(&live, &self.run.settings)
    }

    fn effect(&self, operation: &Operation) -> Effect {
        Effect {
            sets: sets(operation),
            settles: settles(operation),
            unknown: self.operands_unknown(operation),
        }
    }

    fn is_unknown(&self, number: u16) -> bool {
        self.unknown_q.get(usize::from(number)).copied().unwrap_or(false)
    }

    /// Whether a block reads a Q parameter of unknown value; what it calculates is not read.
    fn operands_unknown(&self, operation: &Operation) -> bool {
        let unknown_value =
            |value: &Value| matches!(value, Value::Q { number, .. } if self.is_unknown(*number));
        let each_unknown = |operation: &Operation| {
            let mut unknown = false;
            each_parameter(operation, &mut |number| unknown |= self.is_unknown(number));
            unknown
        };
        match operation {
            Operation::Calculate { a, b, .. } => unknown_value(a) || unknown_value(b),
            Operation::Formula { expression, .. } => each_unknown(&Operation::Formula {
                // A parameter that is never unknown: only the operands count.
                target: preassigned::UNIT,
                expression: expression.clone(),
            }),
            _ => each_unknown(operation),
        }
    }

    /// A result is as little known as what it is calculated from, or not at all when that failed.
    fn propagate(&mut self, operation: &Operation, unknown: bool) {
        let (Operation::Calculate { target, .. } | Operation::Formula { target, .. }) = operation else {
            return;
        };
        if let Some(slot) = self.unknown_q.get_mut(usize::from(*target)) {
            *slot = unknown;
        }
    }

    /// Notes a fault unless it is the consequence of something in doubt.
    fn fault(&mut self, result: Result<(), Fault>, at: BlockRef, sets: Doubts, unknown: bool) {
        let Err(fault) = result else { return };
        let consequence = unknown || self.doubts.any_of(needs(&fault));
        let block = fault.block.unwrap_or(at);
        self.doubts = self.doubts.and(sets).and(missing(&fault));
        // FN14 is what the program is meant to say.
        let says = matches!(fault.message, Message::Numbered(_));
        if consequence || says || self.found.errors.len() >= FOUND_MAX || !self.reported.insert(block) {
            return;
        }
        let program = self.run.program(block.program);
        self.found.errors.push(ProgramError {
            message: fault.message,
            program: program
                .map(|program| program.name().to_owned())
                .unwrap_or_default(),
            block,
            detail: fault.detail,
            cause: fault.cause,
        });
    }

    /// Goes on after a block that failed, as if it had done what can be done of it.
    fn recover(&mut self, at: BlockRef, operation: &Operation) {
        let run = &mut self.run.run;
        run.pen.contour = Contour::default();
        run.pen.recording = None;
        run.probing = None;
        if run.at.block_ref() == at {
            run.at.block += 1;
        }
        let Operation::Motion(motion) = operation else {
            if sets(operation).any_of(Doubts::FEED) {
                // Nobody knows which; with any feed the blocks after it can be looked at.
                run.modal.feed_mm_min.get_or_insert(ASSUMED_FEED_MM_MIN);
            }
            return;
        };
        if let Some(Feed::Value(Value::Number(feed))) = motion.feed {
            run.modal.feed_mm_min = Some(feed);
        }
        if motion.compensation == Some(Compensation::Off) {
            run.modal.compensation = Compensation::Off;
        }
        for (axis, word) in motion.coordinates.iter() {
            if let Value::Number(number) = word.value
                && !word.incremental
            {
                let value = number * run.numbers.axis_unit(axis);
                run.modal.nominal[axis] = value;
                run.modal.actual[axis] = value;
            }
        }
    }

    fn take_warnings(&mut self) {
        for warning in self.run.take_warnings() {
            if matches!(warning.kind, WarningKind::ToolNotDefined { .. }) {
                self.doubts = self.doubts.and(Doubts::TOOL_DATA);
            }
            // Its corners stand there, the other way round.
            let mut errors = self.found.errors.iter();
            if warning.kind == WarningKind::BlankIncomplete
                && errors.any(|error| error.cause == Cause::NoBlankMin)
            {
                continue;
            }
            let new = self.found.warnings.len() < FOUND_MAX
                && self.warned.insert((warning.block, warning.kind.clone()));
            if new {
                self.found.warnings.push(warning);
            }
        }
    }

    fn finish(mut self) -> Rehearsal {
        self.take_warnings();
        if let Some(Ended::Failed(error)) = self.run.ended.take() {
            self.found.errors.push(*error);
        }
        let values = self.run.run.numbers.q.values().iter().zip(&self.unknown_q);
        self.found.q_values = values
            .map(|(value, unknown)| (!unknown).then_some(*value))
            .collect();
        self.found.programs = (0..=u16::MAX)
            .map_while(|index| self.run.program(index).cloned())
            .collect();
        self.found
    }
}

/// What a block sets, and leaves in doubt when it fails or cannot be read.
fn sets(operation: &Operation) -> Doubts {
    match operation {
        Operation::ToolCall { .. } => Doubts::TOOL,
        Operation::ToolDefinition { .. } => Doubts::TOOL_DATA,
        Operation::CircleCentre(_) => Doubts::POLE,
        Operation::Motion(motion) => {
            let feed = matches!(motion.feed, Some(Feed::Value(_)));
            let moved = Doubts::POSITION.and(Doubts::COMPENSATION);
            if feed { moved.and(Doubts::FEED) } else { moved }
        }
        Operation::Rounding { .. } | Operation::Chamfer { .. } => Doubts::COMPENSATION,
        Operation::BlankMin(..) => Doubts::BLANK,
        Operation::Cycle(_) => Doubts::CYCLE,
        Operation::CycleCall(_) | Operation::Probe(_) => Doubts::POSITION,
        Operation::CallLabel { .. } | Operation::CallProgram(_) | Operation::Jump { .. } => {
            Doubts::ALL.without(Doubts::FLOW)
        }
        Operation::Invalid(invalid) => meant(&invalid.text),
        Operation::Modal(block) => {
            let each = block.operations.iter().map(sets);
            each.fold(Doubts::NONE, Doubts::and)
        }
        _ => Doubts::NONE,
    }
}

/// How blocks begin and what they would set: for those that cannot be read.
const KEYWORDS: &[(&str, Doubts)] = &[
    ("TOOL CALL", Doubts::TOOL),
    ("TOOL DEF", Doubts::TOOL_DATA),
    ("CC", Doubts::POLE),
    ("CYCL", Doubts::CYCLE.and(Doubts::POSITION)),
    ("BLK", Doubts::BLANK),
    ("LBL", Doubts::FLOW),
    ("END", Doubts::FLOW),
    ("FN", Doubts::NONE),
    ("Q", Doubts::NONE),
    ("M", Doubts::NONE),
    ("STOP", Doubts::NONE),
    ("L", MOTION),
    ("C", MOTION),
    ("X", MOTION),
    ("Y", MOTION),
    ("Z", MOTION),
];

const MOTION: Doubts = Doubts::POSITION.and(Doubts::COMPENSATION).and(Doubts::FEED);

/// What a block that cannot be read was probably meant to set.
fn meant(text: &str) -> Doubts {
    let begins = |word: &str| {
        text.get(..word.len())
            .is_some_and(|front| front.eq_ignore_ascii_case(word))
    };
    let row = KEYWORDS.iter().find(|(word, _)| begins(word));
    row.map_or(Doubts::ALL, |(_, doubts)| *doubts)
}

/// What is certain when a block succeeds.
fn settles(operation: &Operation) -> Doubts {
    match operation {
        Operation::ToolCall { tool: Some(_), .. } => Doubts::TOOL,
        Operation::CircleCentre(_) => Doubts::POLE,
        Operation::BlankMin(..) => Doubts::BLANK,
        Operation::Cycle(block) if block.sub == 0 => Doubts::CYCLE,
        Operation::Motion(motion) => {
            let mut settled = Doubts::NONE;
            if matches!(motion.feed, Some(Feed::Value(_))) {
                settled = settled.and(Doubts::FEED);
            }
            if motion.compensation == Some(Compensation::Off) {
                settled = settled.and(Doubts::COMPENSATION);
            }
            let open = motion.modal.is_some_and(|modal| !modal.open.is_empty());
            let plane =
                motion.coordinates.axes().len() >= 2 && motion.coordinates.incremental().is_empty() && !open;
            if plane && motion.kind == MotionKind::Line {
                settled = settled.and(Doubts::POSITION);
            }
            settled
        }
        Operation::Modal(block) => {
            let each = block.operations.iter().map(settles);
            each.fold(Doubts::NONE, Doubts::and)
        }
        _ => Doubts::NONE,
    }
}

/// What must be certain for a fault to be one of its own block.
fn needs(fault: &Fault) -> Doubts {
    use MessageId::*;
    let contour = Doubts::POSITION.and(Doubts::COMPENSATION);
    let by_message = match fault.message {
        Message::Control(FeedRateIsMissing) => Doubts::FEED,
        Message::Control(CircleEndPosIncorrect) => Doubts::POSITION.and(Doubts::POLE),
        Message::Control(RoundingOffNotDefined | RoundingRadiusTooLarge | ChamferNotPermitted) => contour,
        Message::Control(PathOffsetWronglyStarted | PathOffsetWronglyEnded) => contour,
        Message::Control(ToolRadiusTooLarge) => contour.and(Doubts::TOOL).and(Doubts::TOOL_DATA),
        Message::Control(ToolNotDefined) => Doubts::TOOL_DATA,
        Message::Control(PlaneWronglyDefined) => Doubts::TOOL.and(Doubts::POLE),
        Message::Control(WrongRpm | WrongAxisProgrammed) => Doubts::TOOL,
        Message::Control(ProgramStartUndefined) => Doubts::POSITION,
        Message::Control(BlkFormDefinitionIncorrect) => Doubts::BLANK,
        Message::Control(CyclIncomplete) => Doubts::CYCLE,
        Message::Control(ExcessiveSubprogramming) => Doubts::FLOW,
        _ => Doubts::NONE,
    };
    match fault.cause {
        Cause::NoTool => Doubts::TOOL,
        Cause::NoPole => Doubts::POLE,
        _ => by_message,
    }
}

/// What a fault says is missing: it is said once.
fn missing(fault: &Fault) -> Doubts {
    match (fault.cause, &fault.message) {
        (Cause::NoTool, _) => Doubts::TOOL,
        (Cause::NoPole, _) => Doubts::POLE.and(Doubts::POSITION),
        (Cause::NoCycle, _) => Doubts::CYCLE,
        (Cause::NoToolRadius, _) => Doubts::TOOL_DATA,
        (_, Message::Control(MessageId::FeedRateIsMissing)) => Doubts::FEED,
        (_, Message::Control(MessageId::ToolNotDefined)) => Doubts::TOOL_DATA,
        _ => Doubts::NONE,
    }
}
