//! Technology functions: M, H and S from the program to the PLC, and the path that waits where it must [004].
//!
//! - [`ChannelSettings`]: what a channel parameter list says of each function, with [`Synch`] its synchronisation.

mod settings;
mod synch;

pub use settings::{
    ChannelSettings, EdgeBanding, FUNCTIONS, FunctionSettings, FunctionTable, INTERNAL_M, MicroJoint,
    PreOutput, SPINDLES, SpindleFunction, SpindleSettings,
};
pub use synch::{Synch, SynchError, SynchType};
