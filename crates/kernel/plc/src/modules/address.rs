//! Addresses of the word memory.

use bahn_exchange::{Number, Size};

/// The word memory in bytes.
pub(super) const BYTES: i32 = 1024;

/// The operand at an address; `None` outside the memory and where no operand of the size begins.
pub(super) fn operand(size: Size, address: i32) -> Option<Number> {
    Number::new(size, u16::try_from(address).ok()?)
}

/// Whether a block lies inside an area that ends before `end`.
pub(super) fn fits(first: i32, length: i32, end: i32) -> bool {
    first >= 0 && length >= 0 && i64::from(first) + i64::from(length) <= i64::from(end)
}
