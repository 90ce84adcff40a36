//! A curve that was recorded.

use bahn_host::oscilloscope::Curve;

/// Fewer samples are never shown [000:18787-18789].
pub(super) const FEWEST: usize = 64;

/// A curve that was recorded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Recorded {
    pub curve: Curve,
    pub samples: Vec<f64>,
}
