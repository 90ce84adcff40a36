//! What lies in blocks before the one that is decoded and still has its effect.

use bahn_kernel::gates::VectorLimit;

/// What lies in blocks before the one that is decoded and still has its effect.
#[derive(Debug, Default)]
pub(super) struct Decoding {
    /// Count of executed blocks, over all programs.
    pub(super) units: u64,
    /// Decoding goes on when the channel has run empty.
    pub(super) holds: bool,
    /// The end of the program is decoded.
    pub(super) ended: bool,
    pub(super) limit: Option<VectorLimit>,
    pub(super) radius_compensation: bool,
    pub(super) edge: Option<Edge>,
}

impl Decoding {
    /// Another program begins: what is modal ends.
    pub(super) fn begin(&mut self) {
        *self = Decoding {
            units: self.units,
            ..Decoding::default()
        };
    }
}

/// Edge banding between G108 and G107: the distance to where the path has passed the probe, mm.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edge {
    pub(super) probed: Option<f64>,
}
