//! What the control does at a moment, in numbers.

use bahn_panel::Station;
use bahn_path::Axis;
use bahn_tnc::{AxisState, Control, Mode, RunState, Shown};
use serde::{Serialize, Serializer};

use crate::error::ServiceError;
use crate::service::MachineService;

/// The state of the control: lengths in mm, angles in degrees, speeds in mm/min and rpm, times in s. As JSON it is what
/// docs/panel-api.md calls the snapshot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct State {
    /// Time since power-on, s.
    #[serde(rename = "t")]
    pub time_s: f64,
    /// Operating mode of the first channel.
    #[serde(serialize_with = "mode")]
    pub mode: Mode,
    /// State of the first channel's run.
    #[serde(serialize_with = "run")]
    pub run: RunState,
    /// The run has come to the end of its program.
    pub ended: bool,
    /// A fault has broken the run off.
    #[serde(skip)]
    pub broken: bool,
    /// The program that was chosen.
    pub program: Option<String>,
    /// Number of the block that is executed, as the program has it.
    pub block: Option<u32>,
    /// The block that is executed: it may be of a program that was called.
    #[serde(skip)]
    pub running: Option<RunningBlock>,
    /// The axes in the order of their indices.
    pub axes: Vec<AxisPosition>,
    /// Speed along the path now, mm/min.
    #[serde(rename = "feed")]
    pub feed_mm_min: f64,
    /// Programmed feed, mm/min; `None` while a block moves in rapid traverse.
    #[serde(rename = "programmed_feed")]
    pub programmed_feed_mm_min: Option<f64>,
    /// Feed override in force, %.
    #[serde(rename = "feed_override")]
    pub feed_override_percent: f64,
    /// Spindle override in force, %.
    #[serde(rename = "spindle_override")]
    pub spindle_override_percent: f64,
    /// The spindle of the first channel.
    pub spindle: SpindleState,
    /// Number of the tool in the spindle.
    pub tool: u32,
    /// What is known of that tool.
    #[serde(skip)]
    pub tool_shape: Tool,
    /// Messages that are shown, the oldest first.
    pub messages: Vec<Message>,
    /// The handshake that the run waits for.
    pub waiting: Option<String>,
    /// Nominal processing time of the PLC, %: latest and longest scan.
    pub plc_percent: [f64; 2],
}

/// The block that is executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunningBlock {
    /// Name of its program; `None` when nobody knows it.
    pub program: Option<String>,
    /// Its place in the program, from 0.
    pub index: u32,
}

/// An axis, mm or degrees.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AxisPosition {
    /// Letter by which programs name the axis.
    pub letter: char,
    /// Actual position from the workpiece datum.
    pub actual: f64,
    /// Nominal position from the workpiece datum.
    pub nominal: f64,
    /// Actual position from the machine datum.
    pub machine: f64,
    /// Nominal minus actual position.
    pub lag: f64,
    /// Distance to the end of the block that is executed.
    pub distance_to_go: f64,
    /// It has crossed its reference mark.
    pub referenced: bool,
    /// Its position loop is closed.
    pub closed: bool,
    /// The PLC has enabled its feed.
    pub enabled: bool,
    /// It is within its positioning window.
    pub in_position: bool,
}

/// Speeds, voltage and gear range of a spindle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpindleState {
    /// Speed of the S word, rpm.
    pub programmed_rpm: f64,
    /// Actual speed, rpm, negative as M04.
    pub actual_rpm: f64,
    /// Nominal voltage at the output, V.
    pub volts: f64,
    /// Gear range, 1 to 8.
    pub gear: u8,
}

/// The tool in the spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tool {
    /// Its axis, when a run has chosen one.
    pub axis: Option<Axis>,
    /// Length in the tool axis, mm.
    pub length_mm: f64,
    /// Radius in the working plane, mm.
    pub radius_mm: f64,
}

/// A message of the control.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Message {
    /// Its text as the screen shows it.
    pub text: String,
    /// Only power-off clears it.
    pub flashing: bool,
    /// When it came up, s since power-on.
    #[serde(rename = "t")]
    pub time_s: f64,
    /// Number of the block that was executed, or that it refuses.
    pub block: Option<u32>,
    /// Its row in the table of faults.
    #[serde(skip)]
    pub fault: u32,
}

impl MachineService {
    /// The state of the control.
    ///
    /// # Errors
    /// When the machine has ended, or too many wait.
    pub fn state(&self) -> Result<State, ServiceError> {
        self.look(of)
    }
}

fn of(station: &Station) -> State {
    let control = station.control();
    let snapshot = control.snapshot();
    State {
        time_s: seconds(snapshot.time_us),
        mode: snapshot.mode,
        run: snapshot.run,
        ended: snapshot.ended,
        broken: control.is_broken(),
        program: snapshot.program,
        block: snapshot.block.map(|block| control.first().number_of(block)),
        running: snapshot.block.map(|block| RunningBlock {
            program: control
                .reader()
                .and_then(|run| run.program(block.program))
                .map(|program| program.name().to_owned()),
            index: block.block,
        }),
        axes: snapshot.axes.iter().map(axis).collect(),
        feed_mm_min: snapshot.feed_mm_min,
        programmed_feed_mm_min: snapshot.programmed_feed_mm_min,
        feed_override_percent: snapshot.feed_override_percent,
        spindle_override_percent: snapshot.spindle_override_percent,
        spindle: SpindleState {
            programmed_rpm: snapshot.spindle.programmed_rpm,
            actual_rpm: snapshot.spindle.actual_rpm,
            volts: snapshot.spindle.volts,
            gear: snapshot.spindle.gear,
        },
        tool: snapshot.tool,
        tool_shape: tool(station, snapshot.tool),
        messages: snapshot
            .messages
            .iter()
            .map(|shown| message(control, shown))
            .collect(),
        waiting: snapshot.waiting.map(|waiting| waiting.to_string()),
        plc_percent: snapshot.plc_percent,
    }
}

fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}

fn axis(axis: &AxisState) -> AxisPosition {
    AxisPosition {
        letter: axis.letter,
        actual: axis.actual,
        nominal: axis.nominal,
        machine: axis.machine,
        lag: axis.lag,
        distance_to_go: axis.distance_to_go,
        referenced: axis.referenced,
        closed: axis.closed,
        enabled: axis.enabled,
        in_position: axis.in_position,
    }
}

fn message(control: &Control, shown: &Shown) -> Message {
    Message {
        text: control.shown_text(shown),
        flashing: shown.flashing,
        time_s: seconds(shown.time_us),
        block: shown.block.map(|block| control.first().number_of(block)),
        fault: shown.fault() as u32,
    }
}

fn tool(station: &Station, number: u32) -> Tool {
    let in_force = station.control().first().in_force();
    let tools = station.machine().tools.as_ref();
    let shape = tools.and_then(|tools| tools.get(&number)).map(|tool| tool.shape);
    Tool {
        axis: in_force.map(|in_force| in_force.tool_axis),
        length_mm: shape.map_or(0.0, |shape| shape.length),
        radius_mm: shape.map_or(0.0, |shape| shape.radius),
    }
}

fn mode<S: Serializer>(mode: &Mode, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(mode.name())
}

fn run<S: Serializer>(state: &RunState, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(match state {
        RunState::Idle => "idle",
        RunState::Running => "running",
        RunState::Interrupted => "interrupted",
        RunState::Stopped => "stopped",
        RunState::BlockEnd => "block_end",
    })
}
