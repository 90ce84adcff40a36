//! Technology functions: M, H and S from the program to the PLC, and the path that waits where it must [004].
//!
//! - [`ChannelSettings`]: what a channel parameter list says of each function, with [`Synch`] its synchronisation;
//! - [`ChannelList`]: such a list as text, with its errors by line and column.

pub mod list;
mod settings;
mod synch;

pub use list::{ChannelList, ListFault};
pub use settings::{
    ChannelSettings, EdgeBanding, FUNCTIONS, FunctionSettings, FunctionTable, INTERNAL_M, MicroJoint,
    PreOutput, SPINDLES, SpindleFunction, SpindleSettings,
};
pub use synch::{Synch, SynchError, SynchType};
