//! Digitizing: what a surface is scanned with, and what came of it.

use crate::Axis;

/// A point of the scanned space: tip of the stylus in X, Y, Z from the workpiece datum, mm.
pub type ScanPoint = [f64; 3];

/// A digitizing cycle: TCH PROBE 5 with 6 or 7 [003:6587-6822].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanJob {
    /// Axis of the probe.
    pub tool_axis: Axis,
    /// Least point of the range.
    pub min: ScanPoint,
    /// Greatest point of the range.
    pub max: ScanPoint,
    /// Datum shift: what is written counts from there.
    pub shift: ScanPoint,
    /// Height in the axis of the probe at which it cannot collide, mm.
    pub clearance_mm: f64,
    /// How the range is scanned.
    pub pattern: ScanPattern,
    /// TRAVEL: farthest way off the surface and back, mm.
    pub travel_mm: f64,
    /// L.SPAC: from line to line, mm; of contour lines with its sign.
    pub spacing_mm: f64,
    /// P.P.INT: greatest distance of two points, mm.
    pub interval_mm: f64,
    /// Radius of the ball of the stylus, mm.
    pub stylus_radius_mm: f64,
    /// The program is in inches.
    pub inch: bool,
    /// Machine parameters.
    pub rules: ScanRules,
}

/// How a range is scanned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScanPattern {
    /// Cycle 6: to and fro in lines along an axis.
    Meander {
        /// LINE DIRECTION.
        line: Axis,
    },
    /// Cycle 7: round the model, level by level.
    ContourLines {
        /// STARTING POINT; the axis of the probe does not count.
        start: ScanPoint,
        /// Axis and sign in which the model is approached.
        approach: (Axis, f64),
        /// Axis and sign in which the orbit begins.
        direction: (Axis, f64),
        /// An orbit takes no longer, s; 0 for no limit.
        time_limit_s: f64,
    },
}

/// How the stylus is moved: MP6120 to MP6270 [000:7734-7799].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanRules {
    /// MP6120: to the first contact, mm/min.
    pub probing_mm_min: f64,
    /// MP6150: positioning, mm/min.
    pub rapid_mm_min: f64,
    /// MP6210: oscillations of the stylus, 1/s.
    pub oscillations_hz: f64,
    /// MP6220: traverse that lubricates the axis of the probe at the end of a line, mm; 0 for none.
    pub lubrication_mm: f64,
    /// MP6221: time after which it is lubricated, min.
    pub lubrication_min: f64,
    /// MP6230: feed in the normal direction, mm/min.
    pub normal_mm_min: f64,
    /// MP6240: how far the stylus may be deflected, mm.
    pub deflection_mm: f64,
    /// MP6260: M90 in every block.
    pub m90: bool,
    /// MP6270: step of the output, mm.
    pub step_mm: f64,
}

impl Default for ScanRules {
    /// The values with which optimizing begins [000:7835-7839]; feeds of a test run (inferred).
    fn default() -> ScanRules {
        ScanRules {
            probing_mm_min: 100.0,
            rapid_mm_min: 2000.0,
            oscillations_hz: 5.0,
            lubrication_mm: 0.0,
            lubrication_min: 0.0,
            normal_mm_min: 30.0,
            deflection_mm: 5.0,
            m90: false,
            step_mm: 0.001,
        }
    }
}

impl ScanJob {
    /// Place of the axis of the probe in a point.
    pub fn tool_place(&self) -> usize {
        self.tool_axis.index().min(2)
    }

    /// Where the scan begins: at clearance height above MIN, or above the starting point.
    pub fn begin(&self) -> ScanPoint {
        let mut at = match self.pattern {
            ScanPattern::Meander { .. } => self.min,
            ScanPattern::ContourLines { start, .. } => start,
        };
        if let Some(height) = at.get_mut(self.tool_place()) {
            *height = self.clearance_mm;
        }
        at
    }

    /// The scanning feed that oscillations and point interval allow, mm/min [000:7738-7746].
    pub fn feed_mm_min(&self) -> f64 {
        self.interval_mm * self.rules.oscillations_hz * 60.0
    }
}

/// What a scan has come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scanned {
    /// Where the tip stands.
    pub at: ScanPoint,
    /// Why it was broken off.
    pub fault: Option<ScanFault>,
}

/// Why a scan was broken off [003:8036-8096].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScanFault {
    /// The stylus was deflected before anything was to be touched.
    AlreadyInContact,
    /// Nothing was touched within the range, or something before it.
    Inaccessible,
    /// The surface leaves the range.
    RangeExceeded,
    /// An orbit took too long.
    TimeLimit,
    /// The stylus did not become free.
    CannotRetract,
    /// The probe is not ready.
    NotReady,
    /// There is no room for more points.
    MemoryFull,
}
