//! The protocol with block check characters: FE1, FE2, and EXT with MP5030 = 1 [000:17351-17512].
//!
//! `link`: one end of the line; `reading` and `writing`: the control; `peripheral`: the device, and a control that obeys, in the `terms`
//! of a device;
//! `directory`: the escape sequence of FE1.
//!
//! Blocks have no numbers. A block that is repeated although it was right would be there twice, so nothing is repeated but
//! for NAK, and a lost answer ends the transfer.

mod directory;
mod link;
mod peripheral;
mod reading;
mod terms;
mod writing;

pub use directory::DirectoryRequest;
pub use peripheral::Peripheral;
pub use reading::{Reading, Want};
pub use terms::Rights;
pub use writing::Writing;

/// Bytes of a sector of the disk [inferred from 790 kByte for about 25,000 blocks, 000:16925].
pub(crate) const SECTOR: u64 = 512;
/// Sectors of a disk: 790 kByte [000:16925].
pub(crate) const SECTORS: u64 = 790 * 1024 / SECTOR;
