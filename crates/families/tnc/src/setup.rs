//! What a control is made of: model, machine parameters, PLC program, tools, programs, what it remembers.

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_exchange::Exchange;
use bahn_kernel::{AxisId, Kinematics};
use bahn_parameters::own_functions::OwnFunctions;
use bahn_parameters::{InchFeed, ParameterList, PerPlcAxis};
use bahn_path::{Axis, Position};
use bahn_plc::PlcProgram;

use crate::plc_link::{NcFiles, WrittenElement};
use crate::tool::{MovedTool, Tool};
use crate::window::Window;
use bahn_kernel::SpindleWiring;
use bahn_reader::Programs;

/// How programs are taken that use what is not executed here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Checking {
    /// Refuse what is otherwise accepted with a warning.
    pub strict: bool,
    /// Pass over unknown words and blocks, and functions that would move differently, with a warning.
    pub skip_unknown: bool,
}

/// Everything a [`Control`](crate::Control) starts with.
#[derive(Clone)]
pub struct Setup {
    /// Machine parameters; their model is that of the control. The list must be checked already.
    pub parameters: ParameterList,
    /// The compiled PLC program.
    pub plc: Arc<PlcProgram>,
    /// Texts of the PLC messages 0 to 99.
    pub plc_messages: Vec<String>,
    /// Texts of the PLC dialogues.
    pub plc_dialogues: Vec<String>,
    /// Tools by number; `None` when tools are defined in the programs.
    pub tools: Option<BTreeMap<u32, Tool>>,
    /// How programs are taken that use what is not executed here.
    pub checking: Checking,
    /// What F counts in a program in inches; `None` for what it counts on the model.
    pub inch_feed: Option<InchFeed>,
    /// The M functions that are synchronised otherwise than the control model does.
    pub functions: OwnFunctions,
    /// Where programs come from.
    pub programs: Arc<dyn Programs>,
    /// Files and tables that PLC modules read.
    pub files: NcFiles,
    /// What was remembered over power-off.
    pub remembered: Remembered,
    /// Memory of the PLC with what power-off keeps (see [`bahn_exchange::Retention`]).
    pub exchange: Exchange,
}

/// A channel beside the first one.
#[derive(Clone)]
pub struct ChannelSetup {
    /// Its machine parameters; what they say of the machine as a whole (PLC, EMERGENCY STOP) is not looked at.
    pub parameters: ParameterList,
    /// The number on the machine of each of its axes, by their indices in the list. An axis without number is not
    /// there.
    pub axes: PerPlcAxis<Option<AxisId>>,
    /// Output 1 and encoder input X1 of its list are this one of the machine, from 0.
    pub connectors: u8,
    /// Where its spindle is connected.
    pub spindle: SpindleWiring,
    /// Where its programs come from.
    pub programs: Arc<dyn Programs>,
    /// How its axes stand to its path.
    pub kinematics: Arc<dyn Kinematics>,
    /// Where its markers and words stand in the memory of the PLC.
    pub window: Window,
    /// What was remembered of it over power-off: datums, tool, Q parameters, program.
    pub remembered: Remembered,
}

/// Channels cannot be put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChannelError {
    /// There are more than eight.
    #[error("a control has at most {} channels", ChannelError::CHANNELS_MAX)]
    TooMany,
    /// Two channels name the same axis.
    #[error("axis {} belongs to two channels", .0.number())]
    AxisTwice(AxisId),
}

impl ChannelError {
    /// Channels that a control has at most.
    pub const CHANNELS_MAX: usize = 8;
}

/// AXIS LIMIT: the operator allows an axis less than its traverse range [003:7115-7157].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimit {
    /// Axis whose range is made smaller.
    pub axis: Axis,
    /// Traverse range, 1 to 3.
    pub range: u8,
    /// Least and greatest position from machine zero, mm or degrees.
    pub limits: [f64; 2],
}

/// What survives power-off beside the memory of the PLC.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Remembered {
    /// Machine position of the workpiece datum for each traverse range, mm or degrees.
    pub datums: [Position0; 3],
    /// Tool in the spindle.
    pub tool: u32,
    /// Length of the tool in the spindle, mm.
    pub tool_length: f64,
    /// Axis along which the tool lies; `None` counts as Z.
    pub tool_axis: Option<Axis>,
    /// Where the contact of the tool probe was found.
    pub tool_probe: Option<ToolProbeCalibration>,
    /// Pockets that tools have taken by variable pocket coding [000:9281].
    pub pockets: Vec<MovedTool>,
    /// What the PLC wrote into the tool and pocket table with module 9094.
    pub written: Vec<WrittenElement>,
    /// Q parameters by number.
    pub q: Vec<(u16, f64)>,
    /// Offsets of the axes as adjusted with code number 75 368, V.
    pub offsets_volts: PerPlcAxis<f64>,
    /// AXIS LIMIT of MOD.
    pub axis_limits: Vec<AxisLimit>,
    /// The touch probe: what was calibrated, and the basic rotation.
    pub probe: ProbeMemory,
    /// Name of the list of machine parameters that module 9033 has selected.
    pub parameter_list: Option<String>,
    /// Name of the selected program.
    pub program: Option<String>,
    /// The line of the pallet file that module 9090 has selected.
    pub pallet_line: Option<i32>,
    /// Name of the datum table that module 9090 has selected.
    pub datum_table: Option<String>,
    /// The line of the compensation assignment that module 9095 has selected.
    pub compensation_line: Option<SelectedLine>,
    /// What the PLC wrote with module 9094 into datum tables, by their names.
    pub written_datums: Vec<(String, WrittenElement)>,
}

/// A line of the compensation assignment (.CMA) that module 9095 has selected: it stays the active one after a control
/// reset [000:15555].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SelectedLine {
    /// Line of the assignment, from 0.
    pub line: usize,
    /// The active line that the file named then. When it names another one, that counts.
    pub file: Option<usize>,
}

impl Remembered {
    /// Forgets the pockets when the tool table has changed since: it counts then. Whether they were kept.
    pub fn fit_pockets(&mut self, tools: Option<&BTreeMap<u32, Tool>>) -> bool {
        let pocket = |tool: u32| Some(tools?.get(&tool)?.pocket);
        let fits = self
            .pockets
            .iter()
            .all(|moved| pocket(moved.tool) == Some(moved.table));
        if !fits {
            self.pockets.clear();
        }
        fits
    }
}

/// What TCH PROBE 30 has found: X, Y, Z of the middle of the contact in machine coordinates and its width, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolProbeCalibration {
    /// X, Y, Z of the middle of the contact in machine coordinates, and its width, mm.
    pub found: [f64; 4],
    /// What the list said then, MP6580 and MP6531: when it says something else, it counts again.
    pub list: [f64; 4],
}

/// What the TOUCH PROBE menu keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProbeMemory {
    /// `None` for a probe that was never calibrated.
    pub calibration: Option<Calibration>,
    /// Basic rotation of the workpiece in the working plane, degrees [003:1291].
    pub basic_rotation_deg: f64,
}

/// The effective size of the touch probe [003:1246-1280].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Effective length of the touch probe, mm.
    pub length_mm: f64,
    /// Effective radius of the ball, mm.
    pub radius_mm: f64,
    /// How far the ball stands beside the spindle in both axes of the working plane, mm [000:7654].
    pub offset_mm: [f64; 2],
}

/// A position that is 0 by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position0(pub Position);

impl Default for Position0 {
    fn default() -> Position0 {
        Position0(Position::ZERO)
    }
}
