//! The operating panel: screen, keys and dialogues of the control as data, for any front end.
//!
//! - [`Station`] is a machine that is on, with its panel: an [`Input`] is what the operator does, a [`Screen`] what he
//!   sees, [`Station::cycle`] a contour cycle of the machine;
//! - [`Live`] is a station on a thread of its own, by the clock on the wall, which any number of viewers watch;
//! - `console` says who has the keys, `page` what takes them and shows itself, `pages` are the operating modes, menus and
//!   tables; each is given a `site`, what it may touch;
//! - texts are in English in the sources, `texts/*.tsv` have the other languages.
//!
//! Nothing here knows sockets, pixels or terminals.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod console;
mod entry;
mod frames;
mod inhibit;
mod input;
mod live;
mod numbers;
mod page;
mod pages;
mod programs;
mod screen;
mod settings;
mod site;
mod station;
mod status;
mod texts;

pub use bahn_dialogue::{Key, KeyGroup};
pub use input::{Input, InputText, Refusal};
pub use live::{Link, Live, Seen};
pub use screen::{
    AxisLine, Dialogue, Heading, Line, MachineState, Mark, MessageLine, PlcLine, Screen, SoftKeys, Star,
    Status, Window, WindowKind,
};
pub use settings::PositionType;
pub use station::{EMERGENCY_STOP, Station, load};
