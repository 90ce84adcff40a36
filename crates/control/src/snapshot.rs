//! The state of the control for a display, a report or a test.

use bahn_path::BlockRef;

use crate::axes::AxisUnit;
use crate::command::Mode;
use crate::control::Control;
use crate::handshake::Waiting;
use crate::message::Shown;
use crate::run::RunState;
use crate::spindle::SpindleState;

/// The state of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisState {
    /// Its letter.
    pub letter: char,
    /// Axis index of markers and machine parameters.
    pub index: usize,
    /// Actual position from the workpiece datum, with the tool length in the tool axis, mm or degrees.
    pub actual: f64,
    /// Nominal position from the workpiece datum, mm or degrees.
    pub nominal: f64,
    /// Actual position from the machine datum (REF), mm or degrees.
    pub machine: f64,
    /// Servo lag, mm or degrees.
    pub lag: f64,
    /// Largest servo lag since power-on, mm or degrees.
    pub max_lag: f64,
    /// Distance to go in the block, mm or degrees.
    pub distance_to_go: f64,
    /// The reference mark was passed.
    pub referenced: bool,
    /// The loop is closed.
    pub closed: bool,
    /// The feed is enabled.
    pub enabled: bool,
    /// In position.
    pub in_position: bool,
}

/// The state of the control.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Time since power-on, µs.
    pub time_us: u64,
    /// Operating mode.
    pub mode: Mode,
    /// State of the run.
    pub run: RunState,
    /// The run came to its end.
    pub ended: bool,
    /// Program of the automatic modes.
    pub program: Option<String>,
    /// Block that is executed.
    pub block: Option<BlockRef>,
    /// Axes in the order of their indices.
    pub axes: Vec<AxisState>,
    /// Path speed, mm/min.
    pub feed_mm_min: f64,
    /// Programmed feed, mm/min; `None` for rapid traverse.
    pub programmed_feed_mm_min: Option<f64>,
    /// Feed override in force, %.
    pub feed_override_percent: f64,
    /// Spindle override in force, %.
    pub spindle_override_percent: f64,
    /// Spindle.
    pub spindle: SpindleState,
    /// Tool in the spindle.
    pub tool: u32,
    /// Messages that are shown, the oldest first.
    pub messages: Vec<Shown>,
    /// Handshake that the run waits for.
    pub waiting: Option<Waiting>,
    /// Nominal processing time of the PLC, %: latest and longest scan.
    pub plc_percent: [f64; 2],
}

impl Control {
    /// The state as of now.
    pub fn snapshot(&self) -> Snapshot {
        self.snapshot_in(Vec::new(), Vec::new(), None)
    }

    /// The state as of now, in the memory of an earlier one: it does not allocate unless another program or
    /// message is shown.
    pub fn snapshot_again(&self, earlier: Snapshot) -> Snapshot {
        self.snapshot_in(earlier.axes, earlier.messages, earlier.program)
    }

    fn snapshot_in(
        &self,
        mut axes: Vec<AxisState>,
        mut messages: Vec<Shown>,
        mut program: Option<String>,
    ) -> Snapshot {
        let time = self.plc.machine.time();
        axes.clear();
        axes.extend(self.axes.iter().map(|unit| self.axis_state(unit)));
        if messages != self.messages.shown() {
            messages = self.messages.shown().to_vec();
        }
        if program != self.run.selected {
            program.clone_from(&self.run.selected);
        }
        Snapshot {
            time_us: self.now_us,
            mode: self.mode,
            run: self.run.state,
            ended: self.run.ended,
            program,
            block: self.path.element().map(|element| element.block),
            axes,
            feed_mm_min: self.run.speed * 60.0,
            programmed_feed_mm_min: self.programmed_feed(),
            feed_override_percent: self.feed_override.percent(),
            spindle_override_percent: self.spindle_override.percent(),
            spindle: self.spindle.state(),
            tool: self.tools.number,
            messages,
            waiting: self.handshakes.waiting(self.exchange.nc()),
            plc_percent: [time.current_percent(), time.maximum_percent()],
        }
    }

    fn axis_state(&self, unit: &AxisUnit) -> AxisState {
        let offset = self.offsets.of(unit.axis);
        AxisState {
            letter: unit.axis.letter(),
            index: unit.index,
            actual: unit.shown(unit.servo.actual_mm() - offset),
            nominal: unit.shown(unit.nominal - offset),
            machine: unit.shown(unit.servo.actual_mm()),
            lag: unit.lag_mm(),
            max_lag: unit.max_lag,
            distance_to_go: self.distance_to_go(unit),
            referenced: unit.referenced,
            closed: unit.servo.closed(),
            enabled: unit.enabled,
            in_position: unit.in_position,
        }
    }

    /// The messages that came up since the last call, in their order.
    pub fn take_messages(&mut self) -> Vec<Shown> {
        self.messages.take_news()
    }

    /// The text of a message as this control shows it.
    pub fn message_text(&self, message: &crate::message::Message) -> String {
        message.text(self.model, &self.letters, self.link.messages())
    }

    /// Keeps the path elements of runs that begin from now on, for [`Control::take_path`].
    pub fn keep_path(&mut self, keep: bool) {
        self.run.tap = keep;
    }

    /// Of what [`Control::take_path`] has handed out so far, the elements from a sequence on are not executed: the tool
    /// is replaced before them. To be asked for before it.
    pub fn take_dropped_path(&mut self) -> Option<u64> {
        self.run
            .feeder
            .as_mut()
            .and_then(crate::feeder::Feeder::take_dropped)
    }

    /// The path elements that were prepared since the last call, in workpiece coordinates.
    pub fn take_path(&mut self) -> Vec<bahn_path::PathElement> {
        self.run
            .feeder
            .as_mut()
            .map(crate::feeder::Feeder::take_tap)
            .unwrap_or_default()
    }

    /// The interpreter's warnings since the last call.
    pub fn take_warnings(&mut self) -> Vec<bahn_interpreter::Warning> {
        match &mut self.run.feeder {
            Some(feeder) => feeder.interpreter_mut().take_warnings(),
            None => Vec::new(),
        }
    }
}
