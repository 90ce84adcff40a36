//! A machine that is on with its panel, as it runs in real time, whatever the family of its control is.
//!
//! - [`Runs`] is what a station must be able to do for it: take an [`Input`], spend a cycle, show a screen;
//! - [`Live`] is a station on a thread of its own, [`Link`] is where any thread gives inputs and sees screens;
//! - [`Passing`] is how time passes there, [`Steps`] are contour cycles that somebody asks for;
//! - [`InputText`] is how an input is written, [`Refusal`] why it is not done.
//!
//! ```
//! use bahn_live::{Input, InputText, Key};
//!
//! let input = Input::try_from(InputText { key: Some("ENT".to_owned()), ..InputText::default() })?;
//! assert_eq!(input, Input::Key(Key::Ent));
//! # Ok::<(), bahn_live::Refusal>(())
//! ```
//!
//! What a key means, and what the screen shows, a station says.

#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod input;
mod live;
mod news;
mod passing;
mod steps;

pub use bahn_dialogue::Key;
pub use input::{EMERGENCY_STOP, Input, InputText, Refusal};
pub use live::{Link, Live, Runs, Seen};
pub use news::TransferNews;
pub use passing::Passing;
pub use steps::{Stepped, Steps, StepsEnd, Ticket};
