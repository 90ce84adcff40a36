//! Part-program languages, lowered to one list of canonical operations with their place in the source.
//!
//! The face of this room:
//! - [`Program`]: a version of a file; decodes its blocks a [`Chunk`] at a time;
//! - [`Language`]: what a language has to say, and how one block is read by itself; [`PlainLanguage`] and [`IsoLanguage`];
//!   of [`DinLanguage`] the texts and numbers alone;
//! - [`Edit`]: makes a new version of a program, which shares what stays the same;
//! - [`Program::growing`]: a program that is executed while it is still being transferred;
//! - [`InForce`]: the G functions in force, which fill in what a block leaves to them;
//! - [`Block`] and [`Operation`]: what a block does, the same whatever language or spelling it came from;
//! - [`CYCLES`]: what stands in which block of which cycle;
//! - [`BlockError`]: what is wrong with a block that cannot be read, and where;
//! - [`Program::diagnostics`]: all faults of a program in one pass; [`check_limits`] for one block;
//! - [`FeedDoubt`]: feeds of programs in inches that look ten times off;
//! - [`InputSteps`]: how fine the numbers of a program may be;
//! - [`format_program`]: the normalised listing.
//!
//! ```
//! use bahn_program::{Edit, Language, Operation, PlainLanguage, Program};
//!
//! // One block: what it does, its faults, and where its words stand.
//! let read = PlainLanguage.parse_block("L X+10 Y+5 R0 FMAX M3");
//! assert!(matches!(read.block.operation, Operation::Motion(_)) && read.faults.is_empty());
//! assert_eq!(read.words[1].span, 2..6); // X+10
//!
//! // A program, and its next version.
//! let old = Program::from_bytes("7.H", b"0 BEGIN PGM 7 MM\n1 L X+5\n2 END PGM 7 MM\n".to_vec());
//! let new = old.edit(&Edit::Insert { before: 1, text: "TOOL CALL 1 Z S500" })?;
//! assert_eq!((old.block_count(), new.block_count()), (3, 4));
//! assert_eq!(new.edit(&Edit::Renumber { step: 10 })?.text_of(2), "2 L X+5");
//! # Ok::<(), bahn_program::EditError>(())
//! ```
//!
//! Reading never fails: a block that cannot be read is [`Operation::Invalid`], an error when it is executed.

mod assigned;
mod block_length;
mod bulk;
mod check;
mod cycles;
mod diagnostics;
mod dialect;
mod digitized;
mod din;
mod edit;
mod error;
mod file_types;
mod format;
mod grow;
mod in_force;
mod inch_feed;
mod iso;
mod labels;
mod language;
mod lines;
mod modal;
mod operation;
mod parse;
mod plain;
mod program;
mod rope;
mod rounding;
mod sequence;
mod survey;
mod text;

pub use assigned::{AssignedParameter, assigned_parameters};
pub use check::{LimitFault, Reading, check_limits, each_parameter};
pub use cycles::{CYCLES, Cycle, CycleFunction, CycleParameter, Quantity, Sign, cycle, cycle_parameters};
pub use diagnostics::{Fault, MAX_DIAGNOSTICS, Uncounted};
pub use dialect::DinLanguage;
pub use digitized::DigitizedText;
pub use edit::{Edit, EditError};
pub use error::BlockError;
pub use file_types::{FILE_TYPES, FileType, language_of};
pub use format::{FormatOptions, format_block, format_program};
pub use in_force::InForce;
pub use inch_feed::FeedDoubt;
pub use iso::IsoLanguage;
pub use language::{Landmark, Language, ParsedBlock, WordKind, WordSpan};
pub use lines::{BlockText, Lines, RawBlock};
pub use modal::{Distance, Modality, PathFunction};
pub use operation::*;
pub use parse::m_words;
pub use plain::PlainLanguage;
pub use program::{Chunk, NumberedBlock, Program};
pub use rounding::InputSteps;
