//! The state of the control for a display, a report or a test.

use bahn_kernel::reference::{backs_off, is_asked};
use bahn_kernel::{AxisUnit, RunState, path_positions};
use bahn_path::{BlockRef, Position};

use crate::channel::Channel;
use crate::command::Mode;
use crate::desk::reference_cams;
use crate::handshake::Waiting;
use crate::machine::MachineSide;
use crate::message::Shown;
use crate::run::ProgramRun;
use crate::spindle::SpindleState;

/// The state of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisState {
    /// Letter by which programs name the axis.
    pub letter: char,
    /// Axis index of markers and machine parameters.
    pub index: usize,
    /// Actual position from the workpiece datum, with the tool length in the tool axis, mm or degrees.
    pub actual: f64,
    /// Nominal position from the workpiece datum, mm or degrees.
    pub nominal: f64,
    /// Length of the tool in `actual` and `nominal`, mm; 0 beside the tool axis.
    pub tool_length_mm: f64,
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
    /// The prompt of the reference run names it: it has not passed its mark, and shall.
    pub mark_wanted: bool,
    /// It stands on its cam and is backed off it before it approaches its mark.
    pub backs_off: bool,
    /// The loop is closed.
    pub closed: bool,
    /// The feed is enabled.
    pub enabled: bool,
    /// It is in position after a movement, as M2008 ff. say.
    pub in_position: bool,
}

/// The state of the control.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Time since power-on, µs.
    pub time_us: u64,
    /// Operating mode of the channel.
    pub mode: Mode,
    /// State of the channel's run.
    pub run: RunState,
    /// The run came to its end.
    pub ended: bool,
    /// Program of the automatic modes.
    pub program: Option<String>,
    /// Block that is executed.
    pub block: Option<BlockRef>,
    /// Axes in the order of their indices.
    pub axes: Vec<AxisState>,
    /// Speed along the path now, mm/min.
    pub feed_mm_min: f64,
    /// Programmed feed, mm/min, between blocks that which was programmed last; `None` while a block moves in rapid traverse.
    pub programmed_feed_mm_min: Option<f64>,
    /// Feed override in force, %.
    pub feed_override_percent: f64,
    /// Spindle override in force, %.
    pub spindle_override_percent: f64,
    /// State of the spindle of the channel.
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

impl AxisState {
    /// The state of an axis of a channel whose path is at an actual and a nominal position. The nominal value of a slave is
    /// that of its master [000:4523].
    fn of(
        unit: &AxisUnit,
        at: &[Position; 2],
        run: &ProgramRun,
        channel: &Channel,
        machine: &MachineSide,
    ) -> AxisState {
        let [actual, nominal] = at;
        let leads = machine.core.axes.master(unit).unwrap_or(unit);
        let offsets = &channel.chain().offsets;
        let nc = machine.memory.of(channel.number()).nc();
        AxisState {
            letter: unit.axis.letter(),
            index: unit.index,
            actual: unit.shown(actual[unit.axis]),
            nominal: unit.shown(nominal[leads.axis]),
            tool_length_mm: match offsets.tool_axis == unit.axis {
                true => offsets.tool_length,
                false => 0.0,
            },
            machine: unit.shown(unit.servo.actual_mm()),
            lag: unit.lag_mm(),
            max_lag: unit.max_lag,
            distance_to_go: run.distance_to_go(unit, channel.chain()),
            referenced: unit.referenced,
            mark_wanted: is_asked(unit),
            backs_off: backs_off(unit, &reference_cams(nc)),
            closed: unit.servo.closed(),
            enabled: unit.enabled,
            in_position: unit.in_position,
        }
    }
}

impl Snapshot {
    /// The state of a channel, in the memory of an earlier one.
    pub(crate) fn of(channel: &Channel, machine: &MachineSide, earlier: Option<Snapshot>) -> Snapshot {
        let time = machine.plc.machine.time();
        let (run, desk) = (&channel.run, channel.desk());
        let (mut axes, mut messages, mut program) = match earlier {
            Some(earlier) => (earlier.axes, earlier.messages, earlier.program),
            None => Default::default(),
        };
        axes.clear();
        let units = machine.core.axes.owned(channel.number());
        let at = path_positions(units.clone(), channel.chain());
        axes.extend(units.map(|unit| AxisState::of(unit, &at, run, channel, machine)));
        if messages != machine.messages.shown() {
            messages = machine.messages.shown().to_vec();
        }
        if program != run.selection.program {
            program.clone_from(&run.selection.program);
        }
        Snapshot {
            time_us: machine.messages.time_us(),
            mode: desk.mode(),
            run: run.progress().state(),
            ended: run.progress().has_ended(),
            program,
            block: run.core.track.path.element().map(|element| element.block),
            axes,
            feed_mm_min: run.core.track.speed_mm_s() * 60.0,
            programmed_feed_mm_min: run.core.track.programmed_feed(),
            feed_override_percent: desk.feed_percent(),
            spindle_override_percent: desk.spindle_percent(),
            spindle: machine.spindles.of(channel.number()).state(),
            tool: channel.tools.number,
            messages,
            waiting: channel
                .handshakes
                .waiting(machine.memory.of(channel.number()).nc()),
            plc_percent: [time.current_percent(), time.maximum_percent()],
        }
    }
}
