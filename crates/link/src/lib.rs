//! Data interfaces: the control speaks with the devices of its time and with clients of today, and plays such a device for
//! a real control.
//!
//! ```
//! use bahn_link::FileType;
//!
//! let types: Vec<_> = FileType::all().filter(|kind| kind.code() == 'A').collect();
//! assert_eq!(types.len(), 5); // texts, messages and dialogues share a letter
//! ```
//!
//! - [`dnc`] is the drip feed: programs that are executed while they are transferred;
//! - [`FileType`] is what the interfaces know of a file: its extension and its code letter;
//! - [`store`] is the file service that all protocols share;
//! - [`lsv2`] are the telegrams of LSV/2.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

pub mod dnc;
mod file_type;
pub mod lsv2;
pub mod store;

pub use file_type::FileType;
