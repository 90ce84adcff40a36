//! How a listing is written.

/// How a listing is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FormatOptions {
    /// Decimal comma instead of the point, as MP7280 chooses it [003:7317-7323].
    pub decimal_comma: bool,
    /// Step of the block numbers of ISO programs, MP7220; 0 writes none [000:6885].
    pub iso_step: u8,
}
