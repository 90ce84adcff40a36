//! Program run: MDI, single block, full sequence; start, stop, internal stop, end.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_interpreter::{Rules, Settings, Status};
use bahn_motion::FunctionOutput;
use bahn_parameters::MessageId;
use bahn_path::{Axis, LiveData, Position};
use bahn_program::Program;
use bahn_servo::Rotation;

use crate::axes::{AxisUnit, Mover};
use crate::block_time::BlockTime;
use crate::command::Mode;
use crate::control::Control;
use crate::feeder::{Box2, Feeder};
use crate::life::Wear;
use crate::message::Message;
use crate::probing::Probing;
use crate::q_transfer::QTransfer;
use crate::restore::Restore;

/// Elements that one call of prepare reads at most.
const BUDGET: usize = 256;
/// Blocks that take no time after which a program is taken for an endless loop (inferred): at 4 ms for a
/// block the control would have stood for 400 s.
const BLOCKS_WITHOUT_MOTION: u64 = 100_000;
/// Outputs of functions that wait at most.
pub(crate) const OUTPUTS: usize = 64;

/// What the run does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunState {
    /// Nothing was started, or it was broken off or ended.
    #[default]
    Idle,
    /// Blocks are executed.
    Running,
    /// An external stop: `*` flashes. NC start goes on [000:6581-6587].
    Interrupted,
    /// A programmed stop (STOP, M0, M6): NC start goes on.
    Stopped,
    /// Single block: NC start executes the next one.
    BlockEnd,
}

/// A run.
#[derive(Clone, Default)]
pub(crate) struct ProgramRun {
    /// Name of the program that runs in single block and full sequence.
    pub selected: Option<String>,
    /// Block at which the next run starts.
    pub start_block: u32,
    /// Blocks of MDI.
    pub mdi: Option<String>,
    pub state: RunState,
    /// A fault has interrupted it: it is not on its way, and the next start tries the block again.
    pub broken: bool,
    pub feeder: Option<Feeder>,
    /// NC start was given: the run begins with the next preparation.
    pub begin_wanted: bool,
    /// The run has ended: its Q parameters are to be kept.
    q_due: bool,
    /// The program whose run was interrupted, while blocks of MDI run.
    aside: Option<(Option<Feeder>, Option<Resume>)>,
    /// Blocks of MDI have run: back to the program.
    mdi_over: bool,
    /// After an internal stop or a fault: where the next start goes on.
    pub resume_from: Option<Resume>,
    /// Functions on the path that wait for the axes to be in position.
    pub waiting: VecDeque<FunctionOutput>,
    /// Position of the path in the last cycle.
    pub last: Option<Position>,
    /// The source goes on with this at the next preparation.
    pub answer: Option<LiveData>,
    /// A probing movement.
    pub probing: Option<Probing>,
    /// Q100 to Q107 as the PLC wrote them.
    pub q_transfer: QTransfer,
    /// The control is to be restarted (module 9033).
    pub restart_wanted: bool,
    /// The program that runs came to its end since it was started (M2061).
    pub ended: bool,
    /// Keep the executed elements.
    pub tap: bool,
    /// Long computations are done beside.
    pub defers: bool,
    /// Block processing time that is simulated.
    pub block_time: BlockTime,
    /// What the last run left in force.
    pub status: Status,
    /// Return to the contour.
    pub restore: Option<Restore>,
    /// The path speed, mm/s.
    pub speed: f64,
}

/// Where a run goes on that was broken off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resume {
    /// At a block, by its place in the order of execution.
    Block(u64),
    /// At the block that could not be executed.
    Fault,
}

impl ProgramRun {
    /// A run was started and not ended or broken off.
    pub fn is_active(&self) -> bool {
        self.state != RunState::Idle && !self.broken || self.begin_wanted
    }

    /// Blocks are executed now.
    pub fn is_running(&self) -> bool {
        self.state == RunState::Running || self.begin_wanted
    }

    /// The next start begins anew, not with the block of an interruption.
    pub fn forget_interruption(&mut self) {
        self.resume_from = None;
        self.leave_fault();
    }

    /// Nothing is interrupted any more by a fault.
    pub fn leave_fault(&mut self) {
        if std::mem::take(&mut self.broken) {
            self.state = RunState::Idle;
        }
    }

    pub fn restoring(&self) -> Option<&Restore> {
        self.restore.as_ref()
    }
}

impl Control {
    /// NC start in an automatic mode.
    pub(crate) fn start_run(&mut self) {
        if self.run.restore.is_some() || self.is_positioning() {
            return;
        }
        if self.has_lost_spindle() {
            self.show(Message::Plain(MessageId::KeyNonFunctional), false);
            return;
        }
        match self.run.state {
            RunState::Idle => self.run.begin_wanted = true,
            _ if self.run.broken => self.run.begin_wanted = true,
            RunState::Running => {}
            state => {
                match state {
                    RunState::BlockEnd => self.path.go_on(),
                    RunState::Stopped => self.run.answer = Some(self.run.q_transfer.answer()),
                    _ if self.path.is_coupled() => {
                        // Led out of a thread by hand.
                        self.path.go_on();
                        self.put(bahn_exchange::signal::MANUAL_OPERATION_PRESSED, false);
                    }
                    _ => {}
                }
                self.run.state = RunState::Running;
                self.return_to_path();
                if self.run.restore.is_none() {
                    self.regain_path();
                }
            }
        }
    }

    /// NC stop, or anything that stops like it.
    pub(crate) fn stop_run(&mut self) {
        self.run.begin_wanted = false;
        if self.run.state == RunState::Running {
            self.run.state = RunState::Interrupted;
        }
        self.manual.stop();
        if self.reference.is_running() && self.mode != Mode::Reference {
            self.reference.abort();
        }
    }

    /// INTERNAL STOP: the interrupted run is broken off; the next start begins with its block.
    pub(crate) fn internal_stop(&mut self) -> bool {
        if self.run.state == RunState::Running || self.run.begin_wanted || !self.path_stands() {
            return false;
        }
        if self.is_in_thread() {
            return false;
        }
        if self.run.broken {
            self.run.leave_fault();
            return true;
        }
        if self.run.state == RunState::Idle && self.run.restore.is_none() {
            return false;
        }
        let cut = self.path.clear().map(|cut| cut.sequence);
        let next = self
            .run
            .feeder
            .as_ref()
            .map(|feeder| feeder.interpreter().blocks_executed() + 1);
        self.run.resume_from = match self.run.probing {
            // The block that probes is executed as far as its path goes.
            Some(_) => next.map(|next| next - 1),
            None => cut.or(next),
        }
        .map(Resume::Block);
        self.break_off();
        true
    }

    /// Ends what is on its way for the run.
    fn break_off(&mut self) {
        self.run.state = RunState::Idle;
        self.run.broken = false;
        self.run.mdi_over = self.mode == Mode::Mdi;
        self.run.waiting.clear();
        self.run.answer = None;
        self.run.restore = None;
        self.run.speed = 0.0;
        if let Some(feeder) = &mut self.run.feeder {
            feeder.interpreter_mut().give_up_work();
        }
        self.end_probing();
        self.handshakes.abort(&mut self.exchange);
        self.tools.take_back(&mut self.offsets);
        for index in 0..crate::markers::AXES {
            self.end_positioning(index);
        }
        for unit in self.axes.iter_mut().filter(|unit| unit.mover == Mover::Path) {
            unit.mover = Mover::None;
        }
        self.put(bahn_exchange::signal::MANUAL_OPERATION_PRESSED, false);
        self.put(bahn_exchange::signal::BLOCK_SCAN_ACTIVE, false);
    }

    /// No axis moves along the path.
    pub(crate) fn path_stands(&self) -> bool {
        self.path.speed_mm_s() == 0.0
            && self
                .axes
                .iter()
                .filter(|unit| unit.mover == Mover::Path)
                .all(|unit| unit.stands())
    }

    /// Interprets ahead; begins a run.
    pub(crate) fn prepare_run(&mut self) {
        self.close_run();
        self.take_tool_states();
        self.take_datums();
        if self.run.begin_wanted && self.axes_stand() {
            self.run.begin_wanted = false;
            self.begin_run();
        }
        if self.run.waiting.capacity() == 0 {
            self.run.waiting.reserve(OUTPUTS);
        }
        if !self.run.is_active() && self.handshakes.is_idle() {
            self.call_inserted_tool();
        }
        let limits = self.traverse_box();
        let zero = self.machine_zero();
        let here = self.offsets.to_path(&self.machine_position());
        self.prepare_replacement();
        let wear = self.tools.wear();
        // A block scan reads the blocks itself.
        let scans = self.run.restore.as_ref().is_some_and(Restore::scans);
        if let Some(feeder) = &mut self.run.feeder
            && self.run.state != RunState::Idle
            && !self.run.broken
            && !scans
        {
            if let Some(recalled) = self.path.take_recalled() {
                feeder.put_back(recalled.into_iter());
            }
            feeder.set_datum(self.offsets.datum, zero, limits);
            if let Some(answer) = self.run.answer.take() {
                let probed = answer.touch.is_some();
                if !probed {
                    // The PLC may have moved the axes, or corrected the datum [000:8914].
                    feeder.interpreter_mut().stand_at(&here);
                }
                self.path.resume(feeder, answer);
                if let Some(call) = self.tools.inserted_call.take() {
                    feeder.insert(&call);
                } else if let Wear::Replace(tool) = wear
                    && !probed
                {
                    feeder.replace_tool(self.tools.number, tool);
                }
            }
            if let Some(element) = self.path.element() {
                feeder.forget_before(element.sequence);
            }
            feeder.allow_work();
            let before = feeder.elements_read();
            let allowed = self.run.block_time.allow(self.now_us, BUDGET);
            self.path.prepare(feeder, allowed);
            self.run.block_time.spend(feeder.elements_read() - before);
        }
    }

    /// Module 9150 without a program: the TOOL CALL is executed at once; a wrong one is passed over without a message
    /// [000:16063-16075].
    fn call_inserted_tool(&mut self) {
        let Some(inserted) = self.tools.inserted_call.take() else {
            return;
        };
        let Some(call) = self.tools.tool_call(&inserted, self.offsets.tool_axis) else {
            return;
        };
        let called = inserted.tool.is_some() && call.tool != 0;
        if called && !self.tools.may_be_called(call.tool) {
            return;
        }
        let mut target = crate::functions::Target {
            spindle: &mut self.spindle,
            tools: &mut self.tools,
            offsets: &mut self.offsets,
            handshakes: &mut self.handshakes,
            exchange: &mut self.exchange,
            axes: &mut self.axes,
            inch: false,
        };
        match inserted.tool {
            Some(_) => target.output(&bahn_path::Function::Tool(call)),
            None if inserted.speed.is_some() => target.speed(call.speed_rpm, true),
            None => {}
        }
    }

    /// Where the axes stand, machine coordinates; unknown where there is no axis.
    pub(crate) fn machine_position(&self) -> Position {
        let mut position = Position::UNKNOWN;
        for unit in &self.axes {
            position[unit.axis] = unit.nominal;
        }
        position
    }

    /// The box of the active traverse range.
    pub(crate) fn traverse_box(&self) -> Box2 {
        let mut limits: Box2 = [
            [f64::NEG_INFINITY; Axis::COUNT].into(),
            [f64::INFINITY; Axis::COUNT].into(),
        ];
        for unit in &self.axes {
            if let Some([least, greatest]) = unit.limited() {
                let [min, max] = &mut limits;
                min[unit.axis] = least;
                max[unit.axis] = greatest;
            }
        }
        limits
    }

    /// Nothing moves that a run could take over in the midst of its movement.
    fn axes_stand(&self) -> bool {
        let moves =
            |unit: &AxisUnit| !unit.is_at_rest() && unit.mover != Mover::Rotation && !unit.is_plc_axis();
        !self.axes.iter().any(moves)
    }

    /// What is to be done once a run is over, outside the cycle.
    fn close_run(&mut self) {
        if self.run.q_due {
            self.path.clear();
            self.q = self.q_values();
            self.run.q_due = false;
            for (number, value) in self.run.q_transfer.take_all() {
                self.keep_q(number, value);
            }
            if let Some(feeder) = &self.run.feeder {
                self.run.status = feeder.interpreter().status();
            }
            // A block of MDI is no program that comes to its end (inferred).
            if self.link.list().program_end_clearing().at_program_end && !self.run.mdi_over {
                self.cancel_status();
            }
        }
        if std::mem::take(&mut self.run.mdi_over)
            && let Some((feeder, resume)) = self.run.aside.take()
        {
            self.run.feeder = feeder;
            self.run.resume_from = resume;
        }
    }

    /// Cancels what MP7300 names [000:6589-6601]. The tool stays in the spindle, without its data.
    fn cancel_status(&mut self) {
        let clearing = self.link.list().program_end_clearing();
        if clearing.q_parameters {
            self.q.clear();
        }
        if clearing.status {
            self.run.status.cancel_programmed();
        }
        if clearing.tool {
            self.run.status.cancel_tool();
            self.tools.forget_length(&mut self.offsets);
        }
    }

    fn begin_run(&mut self) {
        self.run.leave_fault();
        let machine = self.machine_position();
        let limits = self.traverse_box();
        self.put(bahn_exchange::signal::PROGRAM_END_EXECUTED, false);
        self.run.ended = false;
        self.run.last = None;
        self.run.answer = None;
        if self.mode == Mode::Mdi && self.run.aside.is_none() {
            self.run.aside = Some((self.run.feeder.take(), self.run.resume_from.take()));
        }
        if let (Some(resume), Some(feeder)) = (self.run.resume_from.take(), &mut self.run.feeder) {
            match resume {
                Resume::Block(sequence) => feeder.return_to(sequence, &machine, self.offsets, limits),
                Resume::Fault => feeder.retry(&machine, self.offsets, limits),
            }
        } else {
            match self.open_program() {
                Ok(program) => {
                    // Counted from TOOL CALL on [000:9181]; blocks of MDI are no program.
                    self.tools.counts &= self.mode == Mode::Mdi;
                    self.tools.replaces_worn &= self.mode == Mode::Mdi;
                    self.tools.takes_larger &= self.mode == Mode::Mdi;
                    let feeder = self.new_feeder(program, &machine, limits);
                    self.run.feeder = Some(feeder);
                }
                Err(message) => {
                    self.show(message, false);
                    return;
                }
            }
        }
        self.path.set_position(self.offsets.to_path(&machine));
        self.run.state = RunState::Running;
    }

    /// A feeder of a program from the chosen start block on.
    pub(crate) fn new_feeder(&self, program: Arc<Program>, machine: &Position, limits: Box2) -> Feeder {
        let block = if self.mode == Mode::Mdi {
            0
        } else {
            self.run.start_block
        };
        let mut status = self.run.status.clone();
        if status.tool() != Some(self.tools.number) {
            status.cancel_tool();
        }
        let spindle = self.spindle.state();
        let clockwise = match spindle.rotation {
            Rotation::M3 => Some(true),
            Rotation::M4 => Some(false),
            Rotation::M5 => None,
        };
        status.take_spindle(clockwise, spindle.programmed_rpm);
        let mut feeder = self.new_feeder_from(program, block, machine, limits, status);
        feeder.set_tap(self.run.tap);
        feeder
    }

    /// A feeder of a program from a block on, with what is in force before it.
    pub(crate) fn new_feeder_from(
        &self,
        program: Arc<Program>,
        block: u32,
        machine: &Position,
        limits: Box2,
        status: Status,
    ) -> Feeder {
        let mut rules = Rules::of(self.link.list());
        rules.machine_zero = self.machine_zero();
        let settings = Settings {
            model: self.model,
            rules,
            texts: self.link.machine_texts().clone(),
            tools: self.tools.shapes(),
            barred_tools: self.tools.barred(),
            datum_table: self.datum_table(),
            strict: self.checking.strict,
            skip_unknown: self.checking.skip_unknown,
            q_values: self.q.clone(),
            start: self.offsets.to_path(machine),
            tool_length_mm: Some(self.offsets.tool_length),
            status,
            machine: true,
            max_blocks_without_motion: BLOCKS_WITHOUT_MOTION,
            inch_feed: self.inch_feed,
            ..Settings::default()
        };
        let programs = Arc::clone(&self.programs);
        let mut feeder = Feeder::new(program, settings, programs, self.offsets, limits);
        if self.run.defers {
            feeder.interpreter_mut().defer_work();
        }
        if block > 0 {
            feeder.interpreter_mut().goto(block);
        }
        feeder
    }

    /// The program of the mode.
    pub(crate) fn open_program(&self) -> Result<Arc<Program>, Message> {
        if self.mode == Mode::Mdi {
            let blocks = self
                .run
                .mdi
                .as_ref()
                .ok_or(Message::Plain(MessageId::KeyNonFunctional))?;
            let text = format!("BEGIN PGM MDI MM\n{blocks}\nEND PGM MDI MM\n");
            return Ok(Arc::new(Program::from_bytes("$MDI", text.into_bytes())));
        }
        let not_found = Message::Plain(MessageId::ProgramNotFound);
        let name = self.run.selected.as_ref().ok_or(not_found.clone())?;
        match self.programs.open(name, "") {
            Ok(Some(program)) => Ok(program),
            Ok(None) | Err(_) => Err(not_found),
        }
    }

    /// A fault interrupts the run [003:1578]; the next start begins with the block that was not executed.
    pub(crate) fn abort_run(&mut self, resume: Resume) {
        self.path.clear();
        self.run.resume_from = Some(resume);
        self.break_off();
        if self.mode != Mode::Mdi {
            self.run.broken = true;
            self.run.state = RunState::Interrupted;
        }
    }

    /// Machine zero in workpiece coordinates; unknown for axes that have not passed their reference mark
    /// [000:4568-4576].
    fn machine_zero(&self) -> Position {
        let mut zero: Position = Axis::ALL.map(|axis| -self.offsets.datum[axis]).into();
        for unit in self
            .axes
            .iter()
            .filter(|unit| !unit.referenced && !unit.is_plc_axis())
        {
            zero[unit.axis] = f64::NAN;
        }
        zero
    }

    /// What the block at the gate of the path asks for is refused: the run ends before it.
    pub(crate) fn refuse_block(&mut self) {
        match self.path.element().map(|element| element.sequence) {
            Some(sequence) if self.path_stands() && self.run.is_active() => {
                self.abort_run(Resume::Block(sequence));
            }
            _ => self.stop_run(),
        }
    }

    /// END PGM, M2 or M30.
    pub(crate) fn end_run(&mut self) {
        self.run.q_due = true;
        self.break_off();
        self.run.ended = true;
        if self.mode != Mode::Mdi {
            self.run.resume_from = None;
            self.run.start_block = 0;
            self.put(bahn_exchange::signal::PROGRAM_END_EXECUTED, true);
        }
    }

    /// Q parameters that are not 0, by number. Behind the end of a run they are those that its end has left.
    pub(crate) fn q_values(&self) -> Vec<(u16, f64)> {
        let over = self.run.ended && !self.run.q_due;
        let Some(feeder) = self.run.feeder.as_ref().filter(|_| !over) else {
            return self.q.clone();
        };
        (0u16..)
            .zip(feeder.interpreter().q_values())
            .filter(|(_, value)| **value != 0.0)
            .map(|(number, value)| (number, *value))
            .collect()
    }

    /// The PLC writes a Q parameter: for a program that runs with the next M, S or T strobe
    /// [000:11657-11663].
    pub(crate) fn set_q(&mut self, number: u16, value: f64) {
        if self.run.is_active() {
            self.run.q_transfer.write(number, value);
        } else {
            if let Some(feeder) = &mut self.run.feeder {
                feeder.interpreter_mut().set_q(number, value);
            }
            self.keep_q(number, value);
        }
    }

    fn keep_q(&mut self, number: u16, value: f64) {
        self.q.retain(|(known, _)| *known != number);
        self.q.push((number, value));
    }

    /// Selects a program.
    pub(crate) fn select(&mut self, name: String) -> bool {
        if self.run.is_active() {
            return false;
        }
        self.q = self.q_values();
        self.cancel_status();
        self.run.selected = Some(name);
        self.run.start_block = 0;
        self.run.feeder = None;
        self.run.forget_interruption();
        true
    }

    /// The rest of the way of an axis in the block that is executed, mm or degrees.
    pub(crate) fn distance_to_go(&self, unit: &AxisUnit) -> f64 {
        match self.path.element() {
            Some(element) if self.run.is_active() => {
                let end = element.end[unit.axis] + self.offsets.of(unit.axis);
                if end.is_finite() { end - unit.nominal } else { 0.0 }
            }
            _ => 0.0,
        }
    }
}
