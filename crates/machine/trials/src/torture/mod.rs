//! The fault campaign: the programs of a machine run while random things happen to it, and every contour cycle is held
//! to rules.
//!
//! A seed says everything: the program, the moment of its undisturbed run, and what happens from there on ([`Plan`]). A
//! [`Campaign`] knows a machine; each of its [`Worker`]s, one for a thread, tries seeds one after another, and tells
//! what came of each as a [`Trial`]. Of a seed that breaks a [`Rule`] it finds the few happenings that do it.
//!
//! - `campaign`, `plan` with its `dice`, `catalogue`, `rule`, `shrink`, `contour` are the same for every family of controls;
//! - `family` is what one says of its machine: `tnc` and `system900` say what can happen to it, and judge its cycles.

mod campaign;
mod catalogue;
mod contour;
mod dice;
mod family;
mod plan;
mod rule;
mod shrink;
mod system900;
mod tnc;
mod trial;

pub use campaign::{Campaign, LeftOut, Worker};
pub use catalogue::Kind;
pub use plan::{Happening, Plan};
pub use rule::{Rule, Violation};
pub use trial::Trial;
