//! What the operator's panel shows, as data, and the words for it: what the panel and the rooms that it is made of share.
//!
//! - [`Screen`] is all that is to be seen at one moment;
//! - [`texts`] has the words in the languages of the panel: English in the sources, the others in `texts/*.tsv`;
//! - [`colours`] are those that machine parameters give the screen;
//! - [`programs`] is the memory of the part programs, as the panel lists, reads and writes it; [`frames`] the first and
//!   last block of a program.
//!
//! ```
//! use bahn_screen::texts::{Language, translate};
//!
//! assert_eq!(translate(Language::German, "LIMIT SWITCH X+"), "ENDSCHALTER X+");
//! ```
//!
//! Nothing here takes a key or decides what is shown.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

pub mod colours;
pub mod frames;
pub mod programs;
mod screen;
pub mod texts;

pub use screen::{
    AxisLine, BranchLine, CheckLine, Dialogue, GraphicsLine, GraphicsView, Heading, Layout, LessonLine,
    LessonState, Line, Look, MachineState, Mark, MarkKind, MessageLine, PlcLine, Screen, SoftKeys, Star,
    Status, TimeLine, TimeMark, Window, WindowKind,
};
