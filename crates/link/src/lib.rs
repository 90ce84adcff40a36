//! Data interfaces: the control speaks with the devices of its time and with clients of today, and plays such a device for
//! a real control.
//!
//! - [`FileType`] is what the interfaces know of a file: its extension and its code letter;
//! - [`store`] is the file service that all protocols share;
//! - [`lsv2`] are the telegrams of LSV/2.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

mod file_type;
pub mod lsv2;
pub mod store;

pub use file_type::FileType;
