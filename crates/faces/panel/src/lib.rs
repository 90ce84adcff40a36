//! The operating panel: screen, keys and dialogues of the control as data, for any front end.
//!
//! - [`Station`] is a machine that is on, with its panel: an [`Input`] is what the operator does, a [`Screen`] what he
//!   sees, [`Station::cycle`] a contour cycle of the machine;
//! - [`Live`] is a station on a thread of its own, in real time, which any number of viewers watch;
//! - `console` says who has the keys, `page` what takes them and shows itself, `pages` are the operating modes, menus and
//!   tables; each is given a `site`, what it may touch;
//! - [`Picture`] is what the graphics show of the part that a test or a run cuts, to be drawn on any thread, [`BeingCut`] that part itself;
//! - [`Recorder`] and [`Replay`] keep a session and show it again; a [`TimeLine`] leads back to any moment;
//! - [`Reason`]s say what a standing machine waits for; [`Breakable`]s are what a teacher can break, a [`LessonRun`] is an
//!   exercise;
//! - [`SHORTCUTS`] say which key of a real keyboard does what;
//! - [`TransferOrder`]s are what the operator wants of the data interfaces, [`TransferNews`] what happens there;
//! - texts are in English in the sources; the room `screen` has the other languages.
//!
//! ```no_run
//! use bahn_panel::{Input, Key, Station, load};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut station = Station::power_on(load("machines/mill".as_ref())?)?;
//! station.cycle()?;
//! assert_eq!(station.screen().messages[0].text, "POWER INTERRUPTED");
//! station.input(&Input::Key(Key::Ce))?;
//! # Ok(())
//! # }
//! ```
//!
//! Nothing here knows sockets or terminals; pictures are drawn by whoever wants them.

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
mod inhibit;
mod live;
mod page;
mod pages;
mod plc_mode;
mod replay;
mod session;
mod settings;
mod shortcuts;
mod site;
mod station;
mod status;
mod to_enter;
mod transfer;

pub use bahn_dialogue::{Key, KeyGroup};
pub use bahn_graphics::{BeingCut, Picture, PictureError};
pub use bahn_live::{EMERGENCY_STOP, Input, InputText, Refusal, Seen, Stepped, StepsEnd, TransferNews};
pub use bahn_machine::{Button, KeyAction};
pub use bahn_path::Switch;
pub use bahn_screen::texts::{Language, around, filled, language_code, language_of_code, texts_around};
pub use bahn_screen::{
    AxisLine, BranchLine, CheckLine, Dialogue, GraphicsLine, GraphicsView, Heading, Layout, LessonLine,
    LessonState, Line, Look, MachineState, Mark, MarkKind, MessageLine, PlcLine, Screen, SoftKeys, Star,
    Status, TimeLine, TimeMark, Window, WindowKind,
};
pub use bahn_teaching::drawer::{Breakable, Breaking};
pub use bahn_teaching::lesson::{Lesson, LessonRun, check_lesson};
pub use bahn_why::{Reason, Urgency, Waits, in_words};
pub use live::{Link, Live, live_replay};
pub use replay::{Ending, Replay, check_session};
pub use session::{Head, Recorder};
pub use settings::PositionType;
pub use shortcuts::{Press, SHORTCUTS, Shortcut, shortcut};
pub use station::Station;
pub use to_enter::load;
pub use transfer::{TransferAction, TransferFiles, TransferOrder};

/// The examples of `docs/plant.md`.
#[cfg(doctest)]
#[doc = include_str!("../docs/plant.md")]
struct PlantOfYourOwn;
