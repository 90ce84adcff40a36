//! Bits of a value.

/// Whether a bit of a value is set.
pub(crate) fn bit_of(value: f64, bit: u32) -> bool {
    value as u64 >> bit & 1 == 1
}
