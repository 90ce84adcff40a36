//! Data interfaces: the control speaks with the devices of its time and with clients of today, and plays such a device for
//! a real control.
//!
//! - [`dnc`] is the drip feed: programs that are executed while they are transferred;
//! - [`FileType`] is what the interfaces know of a file: its extension and its code letter.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

pub mod dnc;
mod file_type;

pub use file_type::FileType;
