//! What NC and PLC exchange: the operands of the PLC and the two images of them.
//!
//! The face of this room is small:
//! - [`Bit`] and [`Number`] are addresses of operands (`M2045`, `W260`), with the ranges that a PLC program
//!   may name; [`Image`] is the memory behind them;
//! - [`Operand`], [`Content`] and [`Assignment`] are operands and values as people write them (`M100=1`);
//! - [`Exchange`] holds the two images, one of the NC and one of the PLC, and swaps what changed at the
//!   start and at the end of a PLC scan;
//! - [`signal`] names every fixed marker and word, with who sets and resets it;
//! - [`Retention`] keeps the markers and bytes that survive power-off in a journal.
//!
//! ```
//! use bahn_exchange::{Exchange, Operand, signal};
//! let mut exchange = Exchange::default();
//! // The NC sets a strobe; the PLC sees it with its next scan, and acknowledges.
//! exchange.nc_set(signal::M_FUNCTION_STROBE, true);
//! exchange.begin_scan();
//! let strobe: Operand = "M2045".parse()?;
//! assert_eq!(strobe.read(exchange.plc()).to_string(), "1");
//! exchange.plc_mut().set_bit(signal::M_FUNCTION_ACK, true);
//! exchange.end_scan();
//! assert!(exchange.nc().bit(signal::M_FUNCTION_ACK));
//! # Ok::<(), String>(())
//! ```
//!
//! Nothing here knows who writes the operands, or why. Citations like `[000:11556]` name the manual and
//! the line of its text: `000` is the technical manual of the TNC 407/415/425.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:11556] look like links"
)]

mod address;
mod exchanging;
mod image;
mod operand;
mod retention;
pub mod signal;

pub use address::{Bit, BitArea, BitRange, ByteRange, NoSuchOperand, Number, Size};
pub use exchanging::Exchange;
pub use image::{CELLS, Image, STRING_LENGTH, STRINGS};
pub use operand::{Assignment, Content, Operand, parts};
pub use retention::{
    Damage, JOURNAL_LENGTH, Loss, MemoryStorage, Retention, RetentionError, RetentionStorage, image_of,
    retained_memory,
};
