//! How large the arcs are that M112 puts at corners.

use bahn_path::{AxisSet, PerAxis};

/// Override that the feed counts with, 150 %.
pub(super) const OVERRIDE: f64 = 1.5;

/// What M112 asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CornerArcs {
    /// T: how far the arc may pass the corner, mm; infinite without.
    pub tolerance_mm: f64,
    /// A: change of direction above which the arc is no larger than the feed needs, degrees.
    pub angle_deg: f64,
    /// Acceleration of each axis, m/s², where the radial acceleration does not allow less.
    pub acceleration_m_s2: PerAxis<f64>,
    /// M124 T: points that are nearer than this to the one before are left out, mm; 0 none.
    pub spacing_mm: f64,
}

impl CornerArcs {
    /// The radius between two lines that meet at an angle, mm: the smallest of three. The arc keeps to the
    /// tolerance; it takes no more than half of the shorter line; and beyond the limit angle it is no
    /// larger than the feed needs.
    ///
    /// `axes` are those the arc is interpolated with, `included_deg` is the angle between the lines, `shorter_mm` the
    /// length of the shorter one.
    pub fn radius_mm(
        &self,
        axes: AxisSet,
        included_deg: f64,
        shorter_mm: f64,
        feed_mm_min: Option<f64>,
    ) -> f64 {
        let half = (0.5 * included_deg).to_radians();
        let by_tolerance = self.tolerance_mm * half.sin() / (1.0 - half.sin());
        let by_length = 0.5 * shorter_mm * half.tan();
        let least = by_tolerance.min(by_length);
        match feed_mm_min {
            Some(feed) if 180.0 - included_deg > self.angle_deg => {
                let speed_m_s = feed * OVERRIDE / 60_000.0;
                let accelerations = axes.iter().map(|axis| self.acceleration_m_s2[axis]);
                let slowest = accelerations.fold(f64::INFINITY, f64::min);
                least.min(speed_m_s * speed_m_s / slowest * 1000.0)
            }
            _ => least,
        }
    }
}
