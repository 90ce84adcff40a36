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
//! - [`backup`] is a machine as one text;
//! - [`dnc`] is the drip feed: programs that are executed while they are transferred;
//! - [`FileType`] is what the interfaces know of a file: its extension and its code letter;
//! - [`HardCopy`] speaks to the printer of a TNC 155;
//! - [`store`] is the file service that all protocols share.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

pub mod backup;
pub mod dnc;
mod file_type;
mod hard_copy;
pub mod store;

pub use file_type::FileType;
pub use hard_copy::HardCopy;
