//! What differs between control models, as data: limits and functions, machine parameters, messages.
//!
//! The face of this room is small:
//! - [`ControlModel`]: which control is meant;
//! - [`MessageId`]: the control's messages with text, cause, remedy and source.

mod message;
mod model;

pub use message::MessageId;
pub use model::{ControlModel, UnknownModel};
