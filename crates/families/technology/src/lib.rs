//! Technology functions: M, H and S from the program to the PLC, and the path that waits where it must [004].
//!
//! - [`ChannelSettings`]: what a channel parameter list says of each function, with [`Synch`] its synchronisation;
//! - [`ChannelList`]: such a list as text, with its errors by line and column;
//! - [`Run`]: programs in turn on one channel, with a [`Script`] of what the PLC does;
//! - [`PlcMemory`]: a PLC beside the run, which reads and answers in a window of [`WINDOW_BYTES`];
//! - [`NcPrograms`]: the programs of such a run from `.nc` files;
//! - [`Report`]: what came of it, as JSON: events, waits, the end of the path.
//!
//! ```
//! use std::sync::Arc;
//! use bahn_din::Program;
//! use bahn_motion::{Limits, SERVO_WINDOW_S};
//! use bahn_path::{PerAxis, Position};
//! use bahn_technology::{ChannelList, EventKind, NcPrograms, Run, Script};
//! use bahn_text::MemoryFiles;
//!
//! // M25 is output before the motion of its block, which waits for the PLC.
//! let list = ChannelList::from_bytes(b"m_synch[25] MVS_SVS\n");
//! let script: Script = "M25 ack 0.5\n".parse()?;
//! let program = Program::from_bytes("glue.nc", b"N10 G01 F1000 X10\nN20 X20 M25\nM30\n");
//! let report = Run {
//!     programs: &NcPrograms::new(&[Arc::new(program)], Arc::new(MemoryFiles::default()))?,
//!     settings: list.settings(),
//!     limits: &Limits {
//!         max_feed_mm_min: PerAxis::splat(10_000.0),
//!         acceleration_m_s2: PerAxis::splat(1.0),
//!         radial_acceleration_m_s2: 1.0,
//!         corner_angle_deg: 10.0,
//!         servo_lag: true,
//!         cycle_s: 0.003,
//!         servo_window_s: SERVO_WINDOW_S,
//!         spindle: Default::default(),
//!         feed_override_percent: 100.0,
//!         rapid_override_percent: 100.0,
//!     },
//!     start: Position::UNKNOWN,
//!     from: None,
//!     bounds: Default::default(),
//!     script: Some(&script),
//! }
//! .execute();
//! let output = report.events.iter().find(|event| event.kind == EventKind::Output);
//! assert_eq!(output.unwrap().position.0[bahn_path::Axis::X], 10.0);
//! assert_eq!(report.waits[0].function, "M25");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bounds;
mod channel;
pub mod list;
mod nc;
mod plc;
mod report;
mod run;
mod settings;
mod synch;

/// When a function goes out and where the path waits for it.
pub use bahn_path::Synchronisation;
pub use bounds::Bounds;
pub use list::ChannelList;
pub use nc::NcPrograms;
pub use plc::{PlcMemory, Script, WINDOW_BYTES};
pub use report::{
    Coordinates, Event, EventKind, Fault, ProgramEnd, Report, Sample, Skipped, ToGo, Value, Wait, Warning,
};
pub use run::{Blocks, Run, Sequence};
pub use settings::{
    ChannelSettings, EdgeBanding, FUNCTIONS, FunctionSettings, FunctionTable, MicroJoint, PreOutput,
    SpindleFunction, SpindleSettings,
};
pub use synch::{Synch, SynchError};
