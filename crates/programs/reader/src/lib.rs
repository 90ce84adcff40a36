//! What a contouring control feeds from: a program that is read block by block, whatever language it is in.
//!
//! The face of this room:
//! - [`Reader`]: an [`ElementSource`](bahn_path::ElementSource) that can go back to a block, go on at one, and say
//!   which block it is at;
//! - [`Mark`]: a state before a block to which it can go back;
//! - [`Start`]: what a program finds on a machine when it begins; [`MachineRules`]: what machine parameters rule there,
//!   and with them where functions go out;
//! - [`Programs`]: where programs come from, by their names; [`Shelf`] finds them in [`Folders`];
//! - [`ProgramError`] and [`Warning`]: what is wrong, with the block that causes it.
//!
//! What only some languages have (Q parameters, a tool table, cycles of the machine builder) is not asked here: whoever
//! needs it asks for the reader of that language, see [`Reader`].
//!
//! ```
//! use bahn_path::{ElementSource, LiveData, Step};
//! use bahn_reader::{ProgramError, Reader};
//!
//! /// Length of the path of a program, mm, when nothing stops it.
//! fn length(mut program: Box<dyn Reader>) -> Result<f64, Box<ProgramError>> {
//!     let mut length = 0.0;
//!     loop {
//!         match program.next() {
//!             Step::Element(element) => length += element.length(),
//!             Step::Barrier(_) => program.resume(LiveData::default()),
//!             Step::Starved | Step::End => return Ok(length),
//!             Step::Error(error) => return Err(error),
//!         }
//!     }
//! }
//! ```

mod error;
mod programs;
mod reader;
mod shelf;
mod start;

pub use error::{Cause, Message, ProgramError, Warning, WarningKind};
pub use programs::{NoPrograms, Programs};
pub use reader::{Mark, Reader};
pub use shelf::{EPROM, Folders, Shelf, called};
pub use start::{MachineRules, Start, synchronisation_point};
