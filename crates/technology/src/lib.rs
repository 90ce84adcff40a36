//! Technology functions: M, H and S from the program to the PLC, and the path that waits where it must [004].
//!
//! - [`ChannelSettings`]: what a channel parameter list says of each function, with [`Synch`] its synchronisation;
//! - [`ChannelList`]: such a list as text, with its errors by line and column;
//! - [`Run`]: programs in turn on one channel, with a [`Script`] of what the PLC does;
//! - [`NcPrograms`]: the programs of such a run from `.nc` files;
//! - [`Report`]: what came of it, as JSON: events, waits, the end of the path.

mod channel;
pub mod list;
mod nc;
mod plc;
mod report;
mod run;
mod settings;
mod synch;

pub use list::{ChannelList, ListFault};
pub use nc::NcPrograms;
pub use plc::{Script, ScriptError};
pub use report::{
    Coordinates, Event, EventKind, Fault, ProgramEnd, Report, Sample, ToGo, Value, Wait, Warning,
};
pub use run::{Blocks, Programs, Run};
pub use settings::{
    ChannelSettings, EdgeBanding, FUNCTIONS, FunctionSettings, FunctionTable, INTERNAL_M, MicroJoint,
    PreOutput, SPINDLES, SpindleFunction, SpindleSettings,
};
pub use synch::{Synch, SynchError, SynchType};
