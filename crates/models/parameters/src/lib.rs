//! What differs between control models and between machines, as data.
//!
//! The face of this room is small:
//! - [`ControlModel`]: which control is meant, and its [`Limits`];
//! - [`MessageId`]: the control's messages with text, cause, remedy and source; [`error_text`] for the
//!   numbered ones;
//! - [`Definition`]: what the manual's list says of each machine parameter; [`Advice`]: what it does;
//! - [`chapters`]: the chapters of the manuals that a citation means;
//! - [`ParameterList`]: the machine parameters of one machine, with typed getters that answer for every
//!   model, grouped by who reads them: [`axis`], [`spindle`], [`operation`], [`machining`], [`interfaces`],
//!   [`tables`], [`plc`];
//! - [`PerPlcAxis`]: what there is of each axis of a list, by its index;
//! - [`ListText`]: the text of a list, whose values change in their places;
//! - [`fault`]: what the control does about each fault;
//! - [`conformance`]: what each function of a control does here, and what it does not;
//! - [`technology`]: when M, S and T functions go out, to whom, and where the path waits for them;
//!   [`own_functions`]: those that a machine builder synchronises otherwise;
//! - [`equipment`]: options and software releases, and what takes them;
//! - [`terminals`]: where inputs and outputs of the PLC are, on the control and on its boards.
//!
//! ```
//! use bahn_parameters::{ControlModel, MessageId, ParameterList};
//! let mut list = ParameterList::reference(ControlModel::Tnc415b);
//! list.assign("1060.0=2.5")?;
//! assert_eq!(list.axis_parameters(0).motion.acceleration_m_s2, 2.5);
//! assert!(list.assign("1060.0=far").is_err());
//! assert_eq!(MessageId::WrongRpm.text(ControlModel::Tnc415b), "WRONG SPINDLE SPEED");
//! # Ok::<(), bahn_parameters::ParameterError>(())
//! ```
//!
//! Tables are data: they stand in `data/*.tsv`, `data/reference/*.mp`, `limits/models.rs` and
//! `message/table.rs`, beside their citations. A citation gives manual and line: `000` is the technical
//! manual of the TNC 407/415/425, `001` the interface manual of the TNC 151/155, `003` the user's manual
//! of the TNC 360. A getter says what values mean: numbers with units, or the settings of a loop of `bahn_servo`. Nothing
//! here acts on them.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [003:7868] look like links"
)]

mod adjustment;
mod advice;
mod citation;
pub mod code_numbers;
pub mod compensation;
pub mod conformance;
mod consistency;
mod data_interface;
mod definition;
mod diagnostic;
pub mod equipment;
mod error;
pub mod fault;
mod fn14;
mod limits;
mod list;
mod meaning;
mod message;
mod model;
pub mod own_functions;
mod plc_axes;
mod settings;
pub mod technology;
pub mod terminals;
mod text;

pub use adjustment::Adjustment;
pub use advice::Advice;
pub use citation::{chapters, with_chapters};
pub use consistency::Inconsistency;
pub use definition::{Change, Definition, Format, ParameterId, Reaction};
pub use error::{ListError, ParameterError};
pub use fn14::error_text;
pub use limits::{Blockwise, EmergencyStopTest, InchFeed, Limits, MachineZero, Numbering, OemTexts};
pub use list::ParameterList;
pub use message::{MessageCode, MessageId};
pub use model::{ControlModel, UnknownModel};
pub use plc_axes::{PLC_AXES, PLC_AXIS_NAMES, PerPlcAxis};
pub use text::{Entry, ListText};

/// Of an axis: [`ParameterList::axis_parameters`](crate::ParameterList::axis_parameters).
pub mod axis {
    pub use crate::settings::{
        AxisParameters, InhibitedMark, Modulo, MotionParameters, ReferenceParameters, Synchronization,
        TravelParameters, WiringParameters,
    };
}

/// Of part programs: cycles, M functions, probing, graphics.
pub mod machining {
    pub use crate::settings::{
        ContourPocket, Decimal, DigitizingSettings, GraphicsSettings, MFunctions, MeasuringProbe,
        ProbeOrientation, ProbeSettings, ProbeTurn, ProgramEndClearing, ScaledAxes, ToolProbeParameters,
        ToolProbeTolerance,
    };
}

/// Settings of operation: what [`ParameterList::operation_parameters`](crate::ParameterList::operation_parameters)
/// gives.
pub mod operation {
    pub use crate::settings::{
        DatumParameters, Handwheel, HandwheelParameters, OperationParameters, OverrideParameters,
        OverrideSteps, RestartParameters, SpindleDisplay, Station, ToolOutput, ToolOutputKind,
        ToolParameters, UserParameter, UserText,
    };
}

/// Of the data interfaces: what they can be set to, and
/// [`ParameterList::interface_parameters`](crate::ParameterList::interface_parameters).
pub mod interfaces {
    pub use crate::data_interface::{BAUD_RATES, Mode, rates_exclude_each_other};
    pub use crate::settings::{ControlCharacters, DripFeedMemory, InterfaceParameters, TransferFormat};
}
/// Of tables in the NC memory: [`ParameterList::table_parameters`](crate::ParameterList::table_parameters).
pub mod tables {
    pub use crate::settings::{
        FILE_TYPES, FileTypes, POCKET_ELEMENTS, TOOL_ELEMENTS, TableParameters, shown_elements,
    };
}

/// Of the PLC: [`ParameterList::plc_parameters`](crate::ParameterList::plc_parameters).
pub mod plc {
    pub use crate::settings::{MonitoringInput, PlcParameters, StrobeTimes};
}

/// Of the spindle: [`ParameterList::spindle_parameters`](crate::ParameterList::spindle_parameters).
pub mod spindle {
    pub use crate::settings::{
        Characteristics, FreeOutput, GearSignal, SpindleOutput, SpindleParameters, Tapping, TappingParameters,
    };
}
