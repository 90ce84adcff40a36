//! How near points are one.

/// Points nearer together than this are one point, mm: a thousandth of the finest input resolution
/// (0.001 mm), and far more than rounding does to coordinates of 100 m.
pub const RESOLUTION_MM: f64 = 1e-6;
