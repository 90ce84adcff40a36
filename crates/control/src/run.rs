//! Program run: MDI, single block, full sequence; start, stop, internal stop, end.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_interpreter::{Rules, Settings};
use bahn_motion::{Drive, FunctionOutput, State, Stop};
use bahn_parameters::MessageId;
use bahn_path::{Axis, AxisSet, Barrier, LiveData, PathElement, Position};
use bahn_program::Program;

use crate::axes::Mover;
use crate::command::Mode;
use crate::control::Control;
use crate::feeder::{Box2, Feeder, RunFault};
use crate::message::Message;
use crate::panel::Direction;

/// Elements that one call of prepare reads at most.
const BUDGET: usize = 256;
/// Outputs of functions that wait at most.
const OUTPUTS: usize = 64;

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
#[derive(Default)]
pub(crate) struct ProgramRun {
    /// Name of the program that runs in single block and full sequence.
    pub selected: Option<String>,
    /// Block at which the next run starts.
    pub start_block: u32,
    /// Blocks of MDI.
    pub mdi: Option<String>,
    pub state: RunState,
    pub feeder: Option<Feeder>,
    /// NC start was given: the run begins with the next preparation.
    begin_wanted: bool,
    /// After an internal stop: the block that starts anew, by its sequence.
    resume_from: Option<u64>,
    /// Functions on the path that wait for the axes to be in position.
    waiting: VecDeque<FunctionOutput>,
    /// A function of the gate waits for the spindle.
    last: Option<Position>,
    /// Datum or correction changed while the run has elements on their way.
    pub datum_changed: bool,
    /// The element to whose end the jump of the path is evened out, and what is left of it.
    blend: Blend,
    /// The control is to be restarted (module 9033).
    pub restart_wanted: bool,
    /// The program that runs came to its end since it was started (M2061).
    pub ended: bool,
    /// Keep the executed elements.
    pub tap: bool,
    /// Return to the contour.
    pub restore: Option<crate::restore::Restore>,
    /// The path speed, mm/s.
    pub speed: f64,
    /// Feed without override of the element that is executed, mm/min; `None` for rapid traverse.
    pub programmed_feed: Option<f64>,
}

/// The way between where the path says the axes are and where they are, after a change of the datum: each
/// axis makes it up on the next element that moves it.
#[derive(Clone, Copy, Debug, Default)]
struct Blend {
    rest: [f64; Axis::COUNT],
    sequence: u64,
    active: bool,
}

impl ProgramRun {
    /// A run was started and not ended or broken off.
    pub fn is_active(&self) -> bool {
        self.state != RunState::Idle || self.begin_wanted
    }

    /// Blocks are executed now.
    pub fn is_running(&self) -> bool {
        self.state == RunState::Running || self.begin_wanted
    }

    /// The next start begins anew, not with the block of an interruption.
    pub fn forget_interruption(&mut self) {
        self.resume_from = None;
    }

    pub fn restoring(&self) -> Option<&crate::restore::Restore> {
        self.restore.as_ref()
    }
}

impl Control {
    /// NC start in an automatic mode.
    pub(crate) fn start_run(&mut self) {
        if self.run.restore.is_some() {
            return;
        }
        match self.run.state {
            RunState::Idle => self.run.begin_wanted = true,
            RunState::Interrupted => {
                self.return_to_path();
                self.run.state = RunState::Running;
            }
            RunState::BlockEnd => {
                self.path.go_on();
                self.run.state = RunState::Running;
            }
            RunState::Stopped => {
                let live = LiveData {
                    touch: None,
                    q_values: Vec::new(),
                };
                if let Some(feeder) = &mut self.run.feeder {
                    self.path.resume(feeder, live);
                }
                self.run.state = RunState::Running;
            }
            RunState::Running => {}
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
        if self.run.state == RunState::Idle && self.run.restore.is_none() {
            return false;
        }
        self.run.resume_from = self.path.clear().map(|cut| cut.sequence).or(self
            .run
            .feeder
            .as_ref()
            .map(|feeder| feeder.interpreter().blocks_executed()));
        self.break_off();
        true
    }

    /// Ends what is on its way for the run.
    fn break_off(&mut self) {
        self.run.state = RunState::Idle;
        self.run.waiting.clear();
        self.run.restore = None;
        self.run.speed = 0.0;
        self.handshakes.abort(&mut self.exchange);
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
        if std::mem::take(&mut self.run.begin_wanted) {
            self.begin_run();
        }
        if self.run.waiting.capacity() == 0 {
            self.run.waiting.reserve(OUTPUTS);
        }
        if let Some(feeder) = &mut self.run.feeder
            && self.run.state != RunState::Idle
        {
            if let Some(element) = self.path.element() {
                feeder.forget_before(element.sequence);
            }
            self.path.prepare(feeder, BUDGET);
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

    fn begin_run(&mut self) {
        let machine = self.machine_position();
        let limits = self.traverse_box();
        self.put(bahn_exchange::signal::PROGRAM_END_EXECUTED, false);
        self.run.ended = false;
        self.run.last = None;
        self.run.blend = Blend::default();
        if let (Some(sequence), Some(feeder)) = (self.run.resume_from.take(), &mut self.run.feeder) {
            feeder.return_to(sequence, &machine, self.offsets, limits);
        } else {
            match self.open_program() {
                Ok(program) => {
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
        let mut feeder = self.new_feeder_from(program, block, machine, limits);
        feeder.set_tap(self.run.tap);
        feeder
    }

    /// A feeder of a program from a block on.
    pub(crate) fn new_feeder_from(
        &self,
        program: Arc<Program>,
        block: u32,
        machine: &Position,
        limits: Box2,
    ) -> Feeder {
        let mut rules = Rules::of(self.link.list());
        rules.machine_zero = Axis::ALL.map(|axis| -self.offsets.datum[axis]).into();
        let settings = Settings {
            model: self.model,
            rules,
            tools: self.tools.shapes(),
            q_values: self.q.clone(),
            start: self.offsets.to_path(machine),
            tool_length_mm: Some(self.offsets.tool_length),
            ..Settings::default()
        };
        let programs = Arc::clone(&self.programs);
        let mut feeder = Feeder::new(program, settings, programs, self.offsets, limits);
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

    /// Moves the axes along the path for a cycle.
    pub(crate) fn move_path(&mut self) {
        if self.stop_given() {
            self.stop_run();
        } else if self.start_pressed && self.mode.is_automatic() {
            self.start_run();
        }
        if self.run.state == RunState::Idle || self.run.restore.is_some() {
            return;
        }
        if !self.path_axes_able() {
            // Without feed enable the axes stand at once [000:5352].
            self.path.halt();
            return;
        }
        let percent = self.feed_override.percent();
        let settled = self.path_in_position();
        let drive = Drive {
            feed_override_percent: percent,
            rapid_override_percent: percent,
            hold: self.run.state != RunState::Running,
            single_block: self.mode == Mode::SingleBlock,
            in_position: settled,
            clamped: self.clamped_axes(),
            clamping: self.clamping_axes(),
        };
        let cycle = self.path.cycle(&drive);
        self.run.speed = cycle.speed_mm_s;
        self.follow_path(&cycle.position);
        while let Some(output) = self.path.next_output() {
            if self.run.waiting.len() < OUTPUTS {
                self.run.waiting.push_back(output);
            }
        }
        self.output_functions(settled);
        match cycle.state {
            State::Gate(_) => {
                if self.run.waiting.is_empty() && self.handshakes.is_idle() {
                    self.path.release();
                }
            }
            State::Clamped => self.ask_to_unclamp(drive.clamped),
            State::BlockEnd if settled && self.run.state == RunState::Running => {
                self.run.state = RunState::BlockEnd;
            }
            State::Stopped if settled && self.run.waiting.is_empty() && self.handshakes.is_idle() => {
                self.take_stop();
            }
            _ => {}
        }
    }

    /// The axes that the current element moves are held in their loops and have feed enable. An element
    /// that waits for a clamped axis may do so.
    fn path_axes_able(&self) -> bool {
        let Some(element) = self.path.element() else {
            return true;
        };
        let stands = self.path.speed_mm_s() == 0.0;
        self.axes
            .iter()
            .filter(|unit| moves(element, unit.axis))
            .all(|unit| unit.enabled && (unit.servo.closed() || stands))
    }

    /// Axes whose loop is open: no block may move them.
    fn clamped_axes(&self) -> AxisSet {
        let open = self
            .axes
            .iter()
            .filter(|unit| unit.parameters.controlled && !unit.servo.closed());
        open.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
    }

    /// Axes that the PLC wants to clamp after their block (M2492 ff.), and whose loop is still closed.
    fn clamping_axes(&self) -> AxisSet {
        let nc = self.exchange.nc();
        let wanted = self.axes.iter().filter(|unit| {
            let marker = crate::markers::WAIT_OPEN_LOOP.get(unit.index);
            unit.servo.closed() && marker.is_some_and(|marker| nc.bit(*marker))
        });
        wanted.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
    }

    /// A block wants a clamped axis: its marker M2008 ff. falls, and the PLC unclamps it [000:5407].
    fn ask_to_unclamp(&mut self, clamped: AxisSet) {
        let Some(element) = self.path.element() else {
            return;
        };
        for unit in &mut self.axes {
            if clamped.contains(unit.axis) && moves(element, unit.axis) {
                unit.in_position = false;
            }
        }
    }

    fn path_in_position(&self) -> bool {
        self.axes
            .iter()
            .filter(|unit| unit.mover == Mover::Path && unit.servo.closed())
            .all(|unit| unit.stands() && unit.servo.in_position())
    }

    /// The nominal positions of the axes from that of the path.
    fn follow_path(&mut self, position: &Position) {
        let time = self.cycle_s();
        let moved = self.run.last != Some(*position);
        self.run.last = Some(*position);
        if self.run.datum_changed {
            self.run.datum_changed = false;
            self.begin_blend(position);
        }
        let fraction = self.blend_fraction();
        let element = self.path.element();
        for unit in &mut self.axes {
            let value = position[unit.axis];
            if value.is_nan() || !matches!(unit.mover, Mover::None | Mover::Path) || unit.is_plc_axis() {
                continue;
            }
            if !moved {
                unit.follow(unit.nominal, time);
                continue;
            }
            unit.mover = Mover::Path;
            let mut target = value + self.offsets.of(unit.axis);
            if self.run.blend.active
                && let Some(rest) = self.run.blend.rest.get(unit.axis.index())
            {
                let moves = element.is_some_and(|element| moves(element, unit.axis));
                target += if moves { rest * fraction } else { *rest };
            }
            unit.follow(target, time);
        }
    }

    /// The datum changed under the path: from now on the nominal position of the path differs from where
    /// the axes stand.
    fn begin_blend(&mut self, position: &Position) {
        let mut blend = Blend {
            active: true,
            sequence: self.path.element().map_or(0, |element| element.sequence),
            ..Blend::default()
        };
        for unit in &self.axes {
            let value = position[unit.axis] + self.offsets.of(unit.axis);
            if let Some(rest) = blend.rest.get_mut(unit.axis.index())
                && value.is_finite()
            {
                *rest = unit.nominal - value;
            }
        }
        self.run.blend = blend;
        if let Some(feeder) = &mut self.run.feeder {
            feeder.set_datum(self.offsets.datum);
        }
    }

    /// What is left of the jump on the current element, 1 at its start and 0 at its end; the axes that an
    /// element moved have made it up after it.
    fn blend_fraction(&mut self) -> f64 {
        if !self.run.blend.active {
            return 0.0;
        }
        let Some(element) = self.path.element() else {
            return 1.0;
        };
        let length = element.length();
        if element.sequence != self.run.blend.sequence {
            self.run.blend.sequence = element.sequence;
        }
        let fraction = if length > 0.0 {
            (self.path.rest_mm() / length).clamp(0.0, 1.0)
        } else {
            1.0
        };
        if fraction == 0.0 {
            for axis in Axis::ALL {
                if moves(element, axis)
                    && let Some(rest) = self.run.blend.rest.get_mut(axis.index())
                {
                    *rest = 0.0;
                }
            }
            self.run.blend.active = self.run.blend.rest.iter().any(|rest| *rest != 0.0);
        }
        fraction
    }

    /// Outputs the functions of the path in their order, once the axes are in position.
    fn output_functions(&mut self, settled: bool) {
        while let Some(output) = self.run.waiting.front().copied() {
            if output.waits && !settled {
                return;
            }
            self.run.waiting.pop_front();
            self.unsaved |= path_changes_tool(self.path.functions(&output));
            let Control {
                path,
                spindle,
                tools,
                offsets,
                handshakes,
                exchange,
                run,
                ..
            } = self;
            let mut target = crate::functions::Target {
                spindle,
                tools,
                offsets,
                handshakes,
                exchange,
                inch: run.feeder.as_ref().is_some_and(Feeder::inch),
            };
            for function in path.functions(&output) {
                target.output(&function.function);
            }
        }
    }

    /// The path came to what the source said after it.
    fn take_stop(&mut self) {
        match self.path.take_stop() {
            None => {}
            Some(Stop::Barrier(Barrier::Stop { .. })) => {
                if self.run.state == RunState::Running {
                    self.run.state = RunState::Stopped;
                }
            }
            Some(Stop::Barrier(Barrier::Acknowledge { .. })) => {
                if let Some(feeder) = &mut self.run.feeder {
                    self.path.resume(feeder, LiveData::default());
                }
            }
            Some(Stop::Barrier(Barrier::Probe { .. })) => {
                self.show(Message::Plain(MessageId::ProbeSystemNotReady), false);
                self.abort_run();
            }
            Some(Stop::End) => self.end_run(),
            Some(Stop::Error(fault)) => {
                let message = match fault {
                    RunFault::Program(error) => Message::Program(error),
                    RunFault::Limit { axis, direction, .. } => self.limit_message(axis, direction),
                };
                self.show(message, false);
                self.abort_run();
            }
        }
    }

    fn limit_message(&mut self, axis: Axis, direction: Direction) -> Message {
        let index = self
            .axes
            .iter_mut()
            .find(|unit| unit.axis == axis)
            .map_or(0, |unit| {
                unit.at_limit = Some(direction);
                unit.index
            });
        Message::limit(index, direction)
    }

    /// A fault ends the run; the next start begins with the block that was not executed.
    fn abort_run(&mut self) {
        let sequence = self
            .run
            .feeder
            .as_ref()
            .map(|feeder| feeder.interpreter().blocks_executed());
        self.path.clear();
        self.run.resume_from = sequence;
        self.break_off();
    }

    /// END PGM, M2 or M30.
    fn end_run(&mut self) {
        self.q = self.q_values();
        self.path.clear();
        self.break_off();
        self.run.resume_from = None;
        self.run.start_block = 0;
        self.run.ended = true;
        if self.mode != Mode::Mdi {
            self.put(bahn_exchange::signal::PROGRAM_END_EXECUTED, true);
        }
        let clearing = self.link.list().program_end_clearing();
        if clearing.q_parameters && clearing.at_program_end {
            self.q.clear();
        }
    }

    /// Q parameters that are not 0, by number.
    pub(crate) fn q_values(&self) -> Vec<(u16, f64)> {
        let Some(feeder) = &self.run.feeder else {
            return self.q.clone();
        };
        (0u16..)
            .zip(feeder.interpreter().q_values())
            .filter(|(_, value)| **value != 0.0)
            .map(|(number, value)| (number, *value))
            .collect()
    }

    /// The PLC writes a Q parameter.
    pub(crate) fn set_q(&mut self, number: u16, value: f64) {
        match &mut self.run.feeder {
            Some(feeder) => feeder.interpreter_mut().set_q(number, value),
            None => {
                self.q.retain(|(known, _)| *known != number);
                self.q.push((number, value));
            }
        }
    }

    /// Selects a program.
    pub(crate) fn select(&mut self, name: String) -> bool {
        if self.run.is_active() {
            return false;
        }
        self.q = self.q_values();
        if self.link.list().program_end_clearing().q_parameters {
            self.q.clear();
        }
        self.run.selected = Some(name);
        self.run.start_block = 0;
        self.run.feeder = None;
        self.run.resume_from = None;
        true
    }

    /// The rest of the way of an axis in the block that is executed, mm or degrees.
    pub(crate) fn distance_to_go(&self, unit: &crate::axes::AxisUnit) -> f64 {
        match self.path.element() {
            Some(element) if self.run.is_active() => {
                let end = element.end[unit.axis] + self.offsets.of(unit.axis);
                if end.is_finite() { end - unit.nominal } else { 0.0 }
            }
            _ => 0.0,
        }
    }
}

/// Whether a tool is called.
fn path_changes_tool<'a>(mut functions: impl Iterator<Item = &'a bahn_path::TechnologyFunction>) -> bool {
    functions.any(|output| matches!(output.function, bahn_path::Function::Tool(_)))
}

/// Whether an element moves an axis.
pub(crate) fn moves(element: &PathElement, axis: Axis) -> bool {
    let (from, to) = (element.start[axis], element.end[axis]);
    match &element.curve {
        bahn_path::Curve::Hold => false,
        bahn_path::Curve::Line => to.is_finite() && from != to,
        bahn_path::Curve::Arc(arc) => {
            to.is_finite() && (from != to || axis == arc.plane.first || axis == arc.plane.second)
        }
    }
}
