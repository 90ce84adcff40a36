//! Typed getters: the settings that other rooms use, the same for every control model.
//!
//! The TNC 151/155 have numbers of their own (MP0 to MP263); each getter names both. An axis that the
//! machine does not have answers too, so that a test run need not refuse a program for another machine:
//! a parallel axis answers like the main axis of its direction, a rotary axis like the machine's first
//! rotary axis, otherwise like the 4th axis (inferred).

mod axes;
mod axis_parameters;
mod axis_reader;
mod bits;
mod characteristics;
mod interfaces;
mod machining;
mod operation;
mod plc_parameters;
mod spindle;
mod spindle_parameters;
mod swivels;
mod tables;
mod tool_probe;

pub use axis_parameters::{
    AxisParameters, InhibitedMark, Modulo, MotionParameters, ReferenceParameters, Synchronization,
    TravelParameters, WiringParameters,
};
pub use characteristics::Characteristics;
pub use interfaces::{ControlCharacters, DripFeedMemory, InterfaceParameters, TransferFormat};
pub use machining::{
    ContourPocket, Decimal, DigitizingSettings, GraphicsSettings, MFunctions, MeasuringProbe, ProbeSettings,
    ProbeTurn, ProgramEndClearing, ScaledAxes,
};
pub use operation::{
    DatumParameters, Handwheel, HandwheelParameters, OperationParameters, OverrideParameters, OverrideSteps,
    RestartParameters, SpindleDisplay, Station, ToolOutput, ToolOutputKind, ToolParameters, UserParameter,
    UserText,
};
pub use plc_parameters::{MonitoringInput, PlcParameters, StrobeTimes};
pub use spindle::Tapping;
pub use spindle_parameters::{FreeOutput, GearSignal, SpindleOutput, SpindleParameters, TappingParameters};
pub use tables::{FILE_TYPES, FileTypes, POCKET_ELEMENTS, TOOL_ELEMENTS, TableParameters, shown_elements};
pub use tool_probe::{ProbeOrientation, ToolProbeParameters, ToolProbeTolerance};

use crate::ParameterList;

pub(crate) use bits::bit_of;

impl ParameterList {
    /// Whether the list has the numbers of the TNC 151/155.
    pub(crate) fn has_old_numbers(&self) -> bool {
        self.model().limits().has_old_numbers()
    }

    /// A value under the number of the new or the old list. Every model has every parameter asked for
    /// with this function; a test proves it.
    fn value(&self, new: (u16, u8), old: (u16, u8)) -> f64 {
        let (number, index) = if self.has_old_numbers() { old } else { new };
        self.get(number, index).unwrap_or_default()
    }

    /// Whether a bit of a bit-coded parameter is set.
    fn bit(&self, new: (u16, u8), old: (u16, u8), bit: u32) -> bool {
        bit_of(self.value(new, old), bit)
    }
}
