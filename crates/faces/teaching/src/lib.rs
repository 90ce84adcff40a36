//! What a machine has for teachers and trainees, and for all who look back.
//!
//! - [`lesson`]: exercises, each a fault, a task and checks;
//! - [`drawer`]: everything of a machine that can be broken, and how it is repaired;
//! - [`timeline`]: any moment since power-on can be gone back to, and from there another way.
//!
//! ```no_run
//! use bahn_host::{AnyPlant, LoadedMachine};
//! use bahn_screen::texts::Language;
//! use bahn_teaching::{drawer, lesson};
//!
//! fn choice(machine: &LoadedMachine, plant: &AnyPlant) -> Vec<String> {
//!     let lessons = lesson::list(machine, plant, Language::English);
//!     let broken = drawer::of(plant, machine.parameters.model(), Language::English);
//!     let titles = lessons.into_iter().map(|(_, title)| title);
//!     titles.chain(broken.into_iter().map(|thing| thing.words)).collect()
//! }
//! ```
//!
//! A lesson runs on whatever is [`lesson::Driven`].

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

pub mod drawer;
pub mod lesson;
pub mod timeline;
