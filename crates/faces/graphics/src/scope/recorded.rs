//! A curve that was recorded.

use bahn_host::oscilloscope::Curve;

/// Fewer samples are never shown [000:18787-18789].
pub(super) const FEWEST: usize = 64;

/// A curve that was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// What of which axis.
    pub curve: Curve,
    /// In the unit of its signal.
    pub samples: Vec<f64>,
}
