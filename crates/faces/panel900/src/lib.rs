//! The operator's panel of a System 900 as data.
//!
//! - [`Station900`] is a machine that is on, with its panel: keys in, a `Screen` out, a cycle at a time; a
//!   [`Live`](bahn_live::Live) lets it run in real time;
//! - [`Service900`] is that machine as a page and a terminal reach it;
//! - `console` has the entry line and says which page is shown, `pages` are positions, programs, parameters, zero points,
//!   tools and messages;
//! - `keys` is the table of the keys with what each writes, `status`, `blocks` and `why` are what stands around the pages.
//!
//! ```no_run
//! use bahn_host::{Machine900, PowerOn900};
//! use bahn_live::Input;
//! use bahn_panel900::Station900;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let machine = Machine900::load("machines/portal900".as_ref())?.map_err(|faults| faults[0].clone())?;
//! let mut station = Station900::switched_on(machine, PowerOn900::fresh);
//! station.take(&Input::Machine("REFERENCE".to_owned(), bahn_host::KeyAction::Tap))?;
//! # Ok(())
//! # }
//! ```
//!
//! All that an operator does is a write of a parameter, so locks and key switches hold him back here as everywhere, and what
//! they say is what the panel says. What a TNC's panel has and this one has not is refused in words: the way back to earlier
//! moments, lessons, data interfaces.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [002:403] look like links"
)]

mod blocks;
mod console;
mod keys;
mod pages;
mod service;
mod sight;
mod state;
mod station;
mod status;
mod why;

pub use service::Service900;
pub use station::Station900;
