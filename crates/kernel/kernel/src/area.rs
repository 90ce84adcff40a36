//! Monitoring of areas: where a position is, seen from a reference.

/// Whether a distance lies in a range that begins at 0: up to it, or down to a negative one.
///
/// ```
/// use bahn_kernel::is_within_range;
/// assert!(is_within_range(3.0, 5.0) && !is_within_range(-1.0, 5.0));
/// assert!(is_within_range(-3.0, -5.0) && !is_within_range(1.0, -5.0));
/// ```
pub fn is_within_range(distance_mm: f64, range_mm: f64) -> bool {
    let (least, most) = (range_mm.min(0.0), range_mm.max(0.0));
    (least..=most).contains(&distance_mm)
}
