//! The kernel of the control: axes, operating modes, program run, PLC, messages.
//!
//! - [`Setup`] is what a control is made of, [`Control`] the control itself: [`Control::cycle`] spends one
//!   contour cycle on a machine ([`bahn_servo::Plant`]), [`Control::prepare`] plans ahead;
//! - [`Command`] is what an operator asks for, [`Snapshot`] what he sees, [`Message`] what the control says;
//! - [`Signal`] names what can be recorded.
//! - [`Control::hand_over_reading`] lets part programs be read on another thread ([`ReadAhead`]), [`Control::take_work`] long
//!   computations be done there ([`Work`]).
//!
//! - [`Control::with_channels`] puts several channels on one machine, [`ChannelSetup`] each of them: with its axes
//!   ([`AxisId`]), its [`Kinematics`] and its [`Window`] into the memory of the PLC; a [`ChannelView`] shows it, and by a
//!   [`HandOver`] the PLC gives an axis to another one.
//!
//! ```
//! # use std::sync::Arc;
//! # use bahn_tnc::{Command, Control, Mode, NcFiles, Programs, Remembered, Setup};
//! # use bahn_parameters::{ControlModel, ParameterList};
//! # use bahn_plc::{Compilation, MemoryFiles, Options};
//! # use bahn_servo::IdealAxes;
//! # struct Empty;
//! # impl Programs for Empty {
//! #     fn open(&self, _: &str, _: &str) -> Result<Option<Arc<bahn_program::Program>>, String> {
//! #         Ok(None)
//! #     }
//! # }
//! # let files = MemoryFiles::from([("MAIN.PLC", "L I10\n= M2448\nEM\n")]);
//! # let plc = Compilation::compile(&files, "MAIN.PLC", Options::default()).program.unwrap();
//! let mut control = Control::new(Setup {
//!     parameters: ParameterList::reference(ControlModel::Tnc415b),
//!     plc: Arc::new(plc),
//!     programs: Arc::new(Empty),
//!     # plc_messages: Vec::new(),
//!     # plc_dialogues: Vec::new(),
//!     # tools: None,
//!     # checking: Default::default(),
//!     # inch_feed: None,
//!     # functions: Default::default(),
//!     # files: NcFiles::default(),
//!     # remembered: Remembered::default(),
//!     # exchange: Default::default(),
//!     // .. messages, tools, what was remembered
//! });
//! let mut plant = IdealAxes::default();
//! assert!(control.command(Command::Mode(Mode::Handwheel)));
//! for _ in 0..100 {
//!     control.prepare();
//!     control.cycle(&mut plant);
//! }
//! // A contour cycle of a TNC 415 takes 3 ms.
//! assert_eq!((control.time_us(), control.mode()), (300_000, Mode::Handwheel));
//! ```
//!
//! Time is a count of microseconds; there is no wall clock, no thread and no randomness here, so the same
//! setup, machine and commands give the same bits. `control` orders what happens, `machine` is what the channels
//! share, `channel` one of them.
//!
//! Citations like `[000:7188]` name the manual and the line of its text: `000` is the technical manual of
//! the TNC 407/415/425, `003` the user's manual of the TNC 360.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

mod alteration;
mod axis_switchover;
mod beside;
mod channel;
mod command;
mod compensation;
mod control;
mod cycle;
mod datum_tables;
mod datums;
mod demands;
mod desk;
mod dnc;
mod hand_over;
mod handshake;
mod handwheel;
mod inserted_call;
mod key_code;
mod language;
mod life;
mod loops;
mod machine;
mod magazine;
mod manual;
mod manual_probing;
mod marker_codes;
mod markers;
mod message;
mod oscilloscope;
mod overrides;
mod panel;
mod plane_command;
mod plc_link;
mod positioning;
mod probe_command;
mod probing;
mod programs;
mod q_transfer;
mod reach;
mod renewal;
mod replacement;
mod run;
mod run_command;
mod scanning;
mod screen_command;
mod setup;
mod signal;
mod site;
mod snapshot;
mod source;
mod spindle;
mod status;
mod strobe_form;
mod strobes;
mod tables;
mod test_command;
mod test_run;
mod tnc;
mod tool;
mod tool_contacts;
mod tool_measuring;
mod tools;
mod upkeep;
mod view;
mod watch;
mod window;
mod without_plc;

pub use bahn_interpreter::{Done, Work};
pub use bahn_interpreter::{DripFeedLine, DripFeedState};
pub use bahn_kernel::AxisId;
pub use bahn_kernel::RunState;
pub use bahn_kernel::SpindleWiring;
pub use bahn_kernel::{Cartesian, Kinematics, Offsets, Shares};
pub use bahn_kernel::{ServoSampler, ServoSignal, ServoView};
pub use bahn_parameters::compensation::{
    CompensationAssignment, CompensationError, CompensationTable, CorrectionTables,
};
pub use bahn_path::Switch;
pub use bahn_plc::{DataLineEvent, DataLineOrder, HostEvent, LineEvent, LineSetup, OrderedLines};
/// Where the programs of a control come from.
pub use bahn_reader::Programs;
pub use beside::ReadAhead;
pub use command::{Command, CommandError, Mode};
pub use control::Control;
pub use dnc::Dnc;
pub use hand_over::HandOver;
pub use handshake::{Handshake, Transfer, Waiting};
pub use handwheel::HANDWHEEL_STEPS;
pub use key_code::KeyCode;
pub use message::{HandOverError, Message, Shown};
pub use oscilloscope::OscilloscopeKeys;
pub use plane_command::PlaneCommand;
pub use plc_link::{NcFiles, Pocket, WrittenElement, datum_shifts};
pub use probe_command::{ProbeCommand, ProbeFunction};
pub use renewal::{CompensationFiles, Renewed};
pub use scanning::{Digitized, DigitizedNews};
pub use screen_command::ScreenCommand;
pub use setup::{
    AxisLimit, Calibration, ChannelError, ChannelSetup, Checking, Position0, ProbeMemory, Remembered,
    SelectedLine, Setup, ToolProbeCalibration,
};
pub use signal::{AxisSignal, ProbeSignal, Signal, SignalError, split_channel};
pub use snapshot::{AxisState, Snapshot};
pub use spindle::SpindleState;
pub use test_command::TestCommand;
pub use test_run::{TestReport, TestState};
pub use tool::{Edges, MovedTool, Tool, ToolLife};
pub use view::{ChannelView, InForce};
pub use watch::{AxisFollowing, AxisWatch};
pub use window::Window;
