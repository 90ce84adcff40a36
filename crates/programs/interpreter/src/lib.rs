//! Runs part programs: turns the blocks of a [`Program`] into path elements, one when it is asked for.
//!
//! The face of this room:
//! - [`Interpreter`]: an [`ElementSource`] over a main program and the programs it calls;
//! - [`Settings`]: control model, machine parameters, tools and options of a run;
//! - [`ProgramError`] and [`Warning`]: what is wrong, with the block that causes it;
//! - [`Programs`]: where called programs come from;
//! - [`rehearse`]: all faults of a program, found without moving anything; [`examine`]: with those that reading finds;
//! - [`Checkpoint`]: the whole state of a run, to go back to.
//!
//! ```
//! use std::sync::Arc;
//! use bahn_interpreter::{Interpreter, NoPrograms, Settings};
//! use bahn_path::{Axis, ElementSource, Step};
//! use bahn_program::Program;
//! let text = "BEGIN PGM 1 MM\nLBL 1\nL IX+10 R0 F500\nCALL LBL 1 REP 2\nEND PGM 1 MM\n";
//! let program = Arc::new(Program::from_bytes("1.H", text.into()));
//! let mut run = Interpreter::new(program, Settings::default(), Arc::new(NoPrograms));
//! let mut ends = Vec::new();
//! while let Step::Element(element) = run.next() {
//!     ends.push(element.end[Axis::X]);
//! }
//! assert_eq!(ends, [10.0, 20.0, 30.0]);
//! ```
//!
//! What is executed here, and what the user is told, `availability` asks of the registry of the control models.
//! A block is executed by `execute`, positioning blocks by `positioning` and `path_functions`, cycles in `cycles`.
//! Movements then pass the stages of `contour` (rounding, radius compensation) into the queue of finished
//! steps.
//! All state that changes is in `run`, in parts: `modal` data, `numbers` (Q parameters and units), the `pen` with
//! contour stages and queue, `tools`, `flow`, what is `reported`. A block gets those it may touch as a `context`; only
//! `execute` sees the whole.
//! Nothing here knows of time or of the machine's axes.
//!
//! Decision: After an internal stop the block begins anew from where the axes stand; its incremental coordinates
//! count from where it began
//!
//! Decision: On a machine a digitized program replaces none: ENTRY VALUE INCORRECT at its block; it is written in one
//! step when the range is scanned, and a scan that is broken off leaves nothing (also `host/src/tnc/digitizing.rs`)

mod absent;
mod arc;
mod availability;
mod blank;
mod block_functions;
mod checkpoints;
mod code;
mod context;
mod contour;
mod cycles;
mod deferred;
mod definition;
mod digitize;
mod drip_feed;
mod error;
mod examination;
mod execute;
mod flow;
mod functions;
mod going_back;
mod growing;
mod modal;
mod normals;
mod numbers;
mod oem;
mod oem_calls;
mod output;
mod outside;
mod path_functions;
mod pen;
mod positioning;
mod probe;
mod q_parameters;
mod reader;
mod recording;
mod rehearsal;
mod reported;
mod run;
mod settings;
mod status;
mod superimposing;
mod surface_feed;
mod tilting;
mod tool_measuring;
mod tools;
mod transferred;
mod unrolled;
mod voltage;
mod work;
mod working_plane;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_parameters::MessageId;
use bahn_path::{Axis, Barrier, BlockRef, ElementSource, LiveData, Position, ScanJob, Step};
use bahn_program::{Block, InForce, Operation, Program};

pub use absent::AbsentAxes;
/// Where called programs come from.
pub use bahn_reader::{NoPrograms, Programs};
pub use checkpoints::Checkpoint;
pub use drip_feed::{DripFeed, DripFeedLine, DripFeedState, Refused};
pub use error::{Cause, Message, ProgramError, Warning, WarningKind};
pub use examination::{Complete, Examination, Found, examine};
pub use q_parameters::Q_VALUE_MAX;
pub use rehearsal::{Rehearsal, rehearse};
pub use settings::{
    BasicRotation, ContourPocketRules, DatumTable, MFunctionRules, MachineTexts, NO_DATUM_TABLE, ProbeRules,
    Rules, Settings, TappingRules, ToolState, ToolTable, tool_key,
};
pub use status::Status;
pub use work::{Done, Work};

use crate::checkpoints::{Ended, Kept, acts};
use crate::code::{Code, Fetched};
use crate::contour::Contour;
use crate::cycles::Halt;
use crate::error::Fault;
use crate::execute::execute;
use crate::flow::Flow;
use crate::output::{Item, Output};
use crate::run::Run;
use crate::work::{Effort, Pending};

/// Runs a program and hands out its path element by element.
///
/// ```
/// use std::sync::Arc;
/// use bahn_interpreter::{Interpreter, NoPrograms, Settings};
/// use bahn_path::{Axis, ElementSource, Step};
/// use bahn_program::Program;
///
/// let text = "0 BEGIN PGM 1 MM\n1 L X+10 Y+5 R0 F100\n2 L IX+20\n3 END PGM 1 MM\n";
/// let program = Arc::new(Program::from_bytes("1.H", text.into()));
/// let mut run = Interpreter::new(program, Settings::default(), Arc::new(NoPrograms));
/// let mut ends = Vec::new();
/// while let Step::Element(element) = run.next() {
///     ends.push(element.end[Axis::X]);
/// }
/// assert_eq!(ends, [10.0, 30.0]);
/// ```
#[derive(Clone)]
pub struct Interpreter {
    settings: Settings,
    /// Where called programs come from.
    programs: Arc<dyn Programs>,
    code: Code,
    run: Run,
    ended: Option<Ended>,
    waiting: Option<Barrier>,
    interrupt: Option<Arc<AtomicBool>>,
    /// States before blocks, kept for whoever asked for them.
    kept: Option<Kept>,
    effort: Effort,
    /// Cycles of the machine builder that were looked for: a run keeps what it found.
    oem_cycles: BTreeMap<u16, Option<oem::Cycle>>,
    /// A main program that is still being transferred has no block to go on with.
    starved: bool,
    /// End of the last element that was handed out.
    position: Position,
}

/// Blocks without a step between two looks at the interrupt flag.
const INTERRUPT_PERIOD: u64 = 1 << 14;

/// What a block costs whose state is kept: the copy takes most of its time.
pub const STATE_COST: u32 = 16;

impl Interpreter {
    /// Prepares the run of a main program.
    pub fn new(main: Arc<Program>, settings: Settings, programs: Arc<dyn Programs>) -> Interpreter {
        let run = Run::new(&settings, main.unit());
        let (position, model) = (settings.start, settings.model);
        let input_step_mm = settings.rules.input_step_mm;
        let mut interpreter = Interpreter {
            settings,
            programs,
            code: Code::new(main, model, input_step_mm),
            run,
            ended: None,
            waiting: None,
            interrupt: None,
            kept: None,
            effort: Effort::default(),
            oem_cycles: BTreeMap::new(),
            starved: false,
            position,
        };
        interpreter.look_at_feeds(0);
        interpreter
    }

    /// Warns when the feeds of a program in inches speak against what F is taken to count.
    fn look_at_feeds(&mut self, program: u16) {
        let reading = self.settings.inch_feed();
        let doubt = self
            .code
            .program(program)
            .and_then(|program| program.feed_doubt(reading));
        if let Some(doubt) = doubt {
            let block = BlockRef {
                program,
                block: doubt.block,
            };
            let feed_mm_min = doubt.feed_mm_min.round() as u32;
            self.run
                .reported
                .warn(block, WarningKind::InchFeed { reading, feed_mm_min });
        }
    }

    /// Lets a flag end the search for the next step: while it is set, blocks that lead to no step, such as
    /// an endless loop, end with [`Step::Starved`]. The run can go on when it is cleared.
    pub fn set_interrupt(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }

    /// Executed blocks; BEGIN, END, comments and skipped blocks do not count.
    pub fn blocks_executed(&self) -> u64 {
        self.run.pen.sequence
    }

    /// What is to be scanned, and the block that wants it, until it is.
    pub fn scan(&self) -> Option<(BlockRef, &ScanJob)> {
        let scan = self.run.modal.digitizing.scan.as_ref();
        scan.map(|(block, job)| (*block, job))
    }

    /// What is in force after the last block that was read.
    pub fn status(&self) -> Status {
        self.run.modal.status()
    }

    /// The Q parameters by number. Numbers are those of the control model.
    pub fn q_values(&self) -> &[f64] {
        self.run.numbers.q.values()
    }

    /// Position of the tool centre at the end of the last element handed out, workpiece coordinates, mm and
    /// degrees.
    pub fn position(&self) -> Position {
        self.position
    }

    /// A program of the run: 0 is the main program.
    pub fn program(&self, index: u16) -> Option<&Arc<Program>> {
        self.code.program(index)
    }

    /// Takes the warnings that came up since the last call.
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        self.run.reported.take_warnings()
    }

    /// Allows an amount of work, as [`Interpreter::next`] counts it, until the next call: a control has
    /// other things to do, too. When it is done, the next step is [`Step::Starved`]. A block costs 1, each
    /// further element of a block, too; a block whose state is kept costs [`STATE_COST`].
    pub fn allow(&mut self, work: u32) {
        self.effort.work = Some(work);
    }

    /// After an error: the run goes on with the block that failed.
    pub fn retry(&mut self) {
        self.effort.pending = Pending::None;
        self.ended = None;
        self.waiting = None;
    }

    /// The state as of the next block to be executed.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            run: Box::new(self.run.clone()),
            ended: self.ended.clone(),
            waiting: self.waiting,
            position: self.position,
        }
    }

    /// Goes back to a checkpoint of this run.
    pub fn restore(&mut self, checkpoint: &Checkpoint) {
        let reported = std::mem::take(&mut self.run.reported);
        self.effort.pending = Pending::None;
        self.run = (*checkpoint.run).clone();
        self.run.reported = reported;
        self.ended = checkpoint.ended.clone();
        self.waiting = checkpoint.waiting;
        self.position = checkpoint.position;
        if let Some(kept) = &mut self.kept {
            kept.handed(self.run.pen.sequence);
        }
    }

    /// Says where the axes really stand, workpiece coordinates: after a stop inside a block, or after they
    /// were moved. What was on its way is dropped; radius compensation begins anew with the next block, whose
    /// incremental coordinates count from where it would have begun.
    pub fn relocate(&mut self, position: &Position) {
        self.run.pen.contour = Contour::default();
        self.run.pen.out = Output::default();
        let nominal = self.run.modal.nominal;
        self.run.modal.increments_from.get_or_insert(nominal);
        self.run.modal.nominal = *position;
        self.run.modal.actual = *position;
        self.run.modal.last_move = None;
        self.waiting = None;
        self.position = *position;
    }

    /// The axes were moved while the run waited: the PLC positioned them, or corrected the datum. The next
    /// block starts where they stand now, workpiece coordinates. Without effect while a contour is on its
    /// way; axes whose place is unknown stay.
    pub fn stand_at(&mut self, position: &Position) {
        if !self.run.pen.contour.is_empty() || !self.run.pen.out.queue.is_empty() {
            return;
        }
        for axis in Axis::ALL.into_iter().filter(|axis| !position[*axis].is_nan()) {
            for place in [
                &mut self.run.modal.nominal,
                &mut self.run.modal.actual,
                &mut self.position,
            ] {
                place[axis] = position[axis];
            }
        }
        self.run.modal.last_move = None;
    }

    /// Goes on at a block of the main program, with everything else as it is; calls and repeats that are
    /// open are left.
    pub fn goto(&mut self, block: u32) {
        self.run.at = flow::Position::at(0, block);
        self.run.modal.begins_inside = block > 0;
        self.effort.pending = Pending::None;
        self.ended = None;
        self.enter_unit();
    }

    /// The block that is executed next.
    pub fn at(&self) -> BlockRef {
        self.run.at.block_ref()
    }

    /// Executes blocks until a step is finished or the run ends.
    fn advance(&mut self) {
        if self.effort.pending.is_lost() {
            self.give_up_work();
        }
        while self.run.pen.out.queue.is_empty() && self.ended.is_none() && self.effort.pending.is_none() {
            if !self.spend(1) {
                return;
            }
            let at = self.run.at.block_ref();
            if let Err(fault) = self.step() {
                self.fail(fault, at);
            }
            if self.starved {
                return;
            }
            // A contour that was broken off leaves its block where it is.
            let stays = self.run.at.block_ref() == at;
            if (stays || self.run.pen.since_motion.is_multiple_of(INTERRUPT_PERIOD)) && self.is_interrupted()
            {
                return;
            }
        }
    }

    /// Takes work from what is allowed; `false` when nothing is left.
    #[inline]
    fn spend(&mut self, cost: u32) -> bool {
        match &mut self.effort.work {
            Some(0) => return false,
            Some(work) => *work = work.saturating_sub(cost),
            None => {}
        }
        true
    }

    fn is_interrupted(&self) -> bool {
        self.interrupt
            .as_ref()
            .is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Executes the next block.
    #[inline]
    fn step(&mut self) -> Result<(), Fault> {
        if self.run.tools.comes_back.is_some() {
            self.come_back();
            return Ok(());
        }
        let at = self.run.at.block_ref();
        if self.code.is_growing() && self.must_wait(at) {
            return Ok(());
        }
        let Some(Fetched { block, next, rounded }) = self.code.block(at.program, at.block) else {
            return self.end_of_program();
        };
        let in_force = self.run.modal.in_force;
        self.run.pen.line_follows = next.is_some_and(|next| is_line(next, &block.operation, &in_force));
        if block.skip && self.settings.skip_blocks {
            self.run.at.block += 1;
            return Ok(());
        }
        self.run.pen.join_follows = next.is_some_and(|next| {
            let mut parts = next.operation.parts().iter();
            parts.any(|part| matches!(part, Operation::Rounding { .. } | Operation::Chamfer { .. }))
        });
        if let Some(kept) = &mut self.kept
            && self.run.pen.recording.is_none()
            && acts(&block.operation)
        {
            kept.keep(&mut self.run, self.position);
            self.effort.work = self.effort.work.map(|work| work.saturating_sub(STATE_COST - 1));
        }
        self.run.pen.block = at;
        if rounded {
            self.run.tell_rounded(&self.settings)?;
        }
        if !matches!(
            block.operation,
            Operation::Begin(_) | Operation::End(_) | Operation::Comment(_)
        ) {
            self.run.pen.sequence += 1;
            self.run.pen.since_motion += 1;
            if self.run.pen.since_motion > self.settings.max_blocks_without_motion {
                let blocks = self.settings.max_blocks_without_motion;
                return Err(Fault::new(
                    MessageId::EndlessLoop,
                    format!("{blocks} blocks without a movement"),
                ));
            }
        }
        let label = if let Operation::Label(label) = block.operation {
            label
        } else {
            0
        };
        for part in block.operation.parts() {
            oem::permit(self.run.oem.last(), part, &self.settings)?;
        }
        let flow = execute(&mut self.run, &block.operation, &self.settings)?;
        for part in block.operation.parts() {
            transferred::permit(&self.run, part, &self.settings)?;
        }
        if label != 0 {
            self.check_label(label, at)?;
        }
        if flow == Flow::Next {
            self.run.at.block += 1;
            return Ok(());
        }
        self.follow(flow)
    }

    fn follow(&mut self, flow: Flow) -> Result<(), Fault> {
        let limits = self.settings.model.limits();
        match flow {
            Flow::Next => self.run.at.block += 1,
            Flow::Jump(label) => self.run.at.block = self.label(label)?,
            Flow::Call(label) => {
                let target = self.label(label)?;
                self.run.at.call(label, target, limits)?;
            }
            Flow::Repeat(label, count) => {
                let target = self.label(label)?;
                self.run.at.repeat(target, count)?;
            }
            Flow::Return => self.run.at.return_from_label(),
            Flow::CallProgram(name) => self.call_program(&name)?,
            Flow::OemDefinition(number, sub) => self.oem_definition(number, sub)?,
            Flow::OemCall(number) => self.oem_call(number)?,
            Flow::Dialog => self.dialog()?,
            Flow::Scan => self.begin_scan()?,
            Flow::EndOfProgram => return self.end_of_program(),
            Flow::EndOfRun => return self.end_of_run(),
            Flow::ContourCycle if self.run.pen.rehearsal => self.rehearse_contours()?,
            Flow::ContourCycle => match self.contour_cycle() {
                Err(Halt::Fault(fault)) => return Err(fault),
                // Its block is executed anew when the run goes on.
                Ok(()) | Err(Halt::Interrupted) => {}
            },
        }
        Ok(())
    }

    /// A label may be set once in a program [003:7881-7883].
    fn check_label(&self, label: u16, at: BlockRef) -> Result<(), Fault> {
        if self.settings.transferred && at.program == 0 {
            // Nobody knows what was erased.
            return Ok(());
        }
        let repeated = self
            .code
            .program(at.program)
            .map_or(&[][..], |program| program.repeated_labels());
        if repeated.contains(&(label, at.block)) {
            return Err(Fault::new(
                MessageId::LabelNumberAllocated,
                format!("LBL {label} is set twice"),
            ));
        }
        Ok(())
    }

    /// The block of a label in the running program.
    pub(crate) fn label(&self, label: u16) -> Result<u32, Fault> {
        if label == 0 {
            return Err(MessageId::JumpToLabelZeroNotPermitted.into());
        }
        if let Some(ahead) = self.label_ahead(label) {
            return ahead;
        }
        let program = self.run.at.program;
        let Some(loaded) = self.code.program(program) else {
            return Err(MessageId::LabelNumberNotAllocated.into());
        };
        if let Some(&(_, block)) = loaded
            .repeated_labels()
            .iter()
            .find(|(number, _)| *number == label)
        {
            let detail = format!("LBL {label} is set twice");
            return Err(Fault::new(MessageId::LabelNumberAllocated, detail).at(BlockRef { program, block }));
        }
        loaded.label(label).ok_or_else(|| {
            Fault::new(
                MessageId::LabelNumberNotAllocated,
                format!("there is no LBL {label}"),
            )
        })
    }

    fn call_program(&mut self, name: &str) -> Result<(), Fault> {
        let caller = self.run.at.program;
        let found = self.code.open(name, caller, &*self.programs);
        let found = found.map_err(|reason| Fault::new(MessageId::ProgramNotFound, reason))?;
        let Some(index) = found else {
            return Err(Fault::new(
                MessageId::ProgramNotFound,
                format!("there is no program {name}"),
            ));
        };
        self.enter_program(index)
    }

    /// On a machine no program is overwritten (inferred: no manual says what becomes of one that has the name).
    fn begin_scan(&mut self) -> Result<(), Fault> {
        self.run.at.block += 1;
        let Some(job) = self.run.modal.digitizing.wanted.take() else {
            return Ok(());
        };
        if self.settings.machine {
            let (name, caller) = (
                job.program.as_str(),
                self.code.name_of(self.run.pen.block.program),
            );
            if !matches!(self.programs.open(name, &caller), Ok(None)) {
                let detail = format!("PGM NAME: there is a program {name} already");
                return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
            }
        }
        self.run.begin_scan(job, &self.settings)
    }

    pub(crate) fn enter_program(&mut self, index: u16) -> Result<(), Fault> {
        self.run.at.call_program(index, self.settings.model.limits())?;
        self.enter_unit();
        if self.code.is_new(index) {
            self.look_at_feeds(index);
        }
        Ok(())
    }

    /// Each program has its own unit; Q113 keeps that of the main program (inferred).
    fn enter_unit(&mut self) {
        if let Some(program) = self.code.program(self.run.at.program) {
            self.run.numbers.enter(program.unit());
        }
    }

    fn end_of_program(&mut self) -> Result<(), Fault> {
        if self.run.at.return_from_program()? {
            oem::leave(&mut self.run, &self.settings);
            self.enter_unit();
            return Ok(());
        }
        self.end_of_run()
    }

    fn end_of_run(&mut self) -> Result<(), Fault> {
        if self.run.modal.blank_min.is_some() {
            self.run
                .reported
                .warn(self.run.pen.block, WarningKind::BlankIncomplete);
        }
        self.run.pen.finish_contour()?;
        self.ended = Some(Ended::Finished);
        Ok(())
    }

    fn fail(&mut self, fault: Fault, at: BlockRef) {
        let block = fault.block.unwrap_or(at);
        if fault.ahead && block != at {
            // Found by looking ahead: the path ends before the element that causes it.
            self.run.pen.contour = Contour::default();
        } else {
            // What was complete before the block still counts; a second fault on the way changes nothing.
            let _ = self.run.pen.finish_contour();
        }
        let program = self
            .code
            .program(block.program)
            .map(|p| p.name().to_owned())
            .unwrap_or_default();
        self.ended = Some(Ended::Failed(Box::new(ProgramError {
            message: fault.message,
            program,
            block,
            detail: fault.detail,
            cause: fault.cause,
        })));
    }
}

/// Whether a block certainly moves on a straight line.
#[inline]
fn is_line(block: &Block, before: &Operation, in_force: &InForce) -> bool {
    let Operation::Motion(motion) = &block.operation else {
        return false;
    };
    in_force.line_follows(before, motion) && !motion.coordinates.is_empty() && !block.skip
}

impl ElementSource for Interpreter {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Self::Error> {
        if let Some(barrier) = self.waiting {
            return Step::Barrier(barrier);
        }
        if self.run.pen.out.queue.is_empty() {
            self.advance();
        } else if !self.spend(1) {
            return Step::Starved;
        }
        match self.run.pen.out.queue.pop_front() {
            Some(Item::Element(element)) => {
                self.position = element.end;
                if let Some(kept) = &mut self.kept {
                    kept.handed(element.sequence);
                }
                Step::Element(element)
            }
            Some(Item::Barrier(barrier)) => {
                self.waiting = Some(barrier);
                Step::Barrier(barrier)
            }
            None => match &self.ended {
                Some(Ended::Failed(error)) => Step::Error(error.clone()),
                Some(Ended::Finished) => Step::End,
                None => Step::Starved,
            },
        }
    }

    fn resume(&mut self, live: LiveData) {
        let Some(barrier) = self.waiting.take() else {
            return;
        };
        for &(number, value) in &live.q_values {
            self.run.numbers.q.preassign(number, value);
        }
        let (block, over) = match barrier {
            Barrier::Probe { block, .. } => (block, self.run.finish_probing(&live, &self.settings)),
            Barrier::Scan { block, .. } => (block, self.run.finish_scan(live.scan, &self.settings)),
            Barrier::MeasureTool(_) => return self.run.take_measured(live.tool_differences_mm),
            _ => return,
        };
        if let Err(fault) = over {
            self.fail(fault, block);
        }
    }
}
