//! Why a machine stands: what each axis, the program and each handshake wait for, in words, with the marker that is
//! missing, the lines of the PLC program that write it, and what there keeps it from being so.
//!
//! - [`Waits`] follows a control and gives the [`Reason`]s of a moment, what is most urgent first;
//! - [`wiring`] says what is wired to the inputs and outputs of the PLC.
//!
//! ```
//! use bahn_why::{Reason, Urgency, in_words};
//!
//! let reason = Reason {
//!     urgency: Urgency::Waits,
//!     text: "X has no feed enable (M2451)".to_owned(),
//!     marker: Some("M2451".to_owned()),
//!     parameter: None,
//!     lines: vec!["MAIN.PLC:42".to_owned()],
//!     causes: vec!["I24 is 0".to_owned()],
//! };
//! assert_eq!(in_words(&[reason]), ["X has no feed enable (M2451) < I24 is 0"]);
//! ```

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod reason;
mod reasons;
mod trace;
mod waits;
pub mod wiring;

pub use reason::{Reason, Urgency};
pub use waits::{Waits, in_words};
