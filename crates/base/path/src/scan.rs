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
    /// TRAVEL: greatest distance off the surface and back, mm.
    pub travel_mm: f64,
    /// L.SPAC: from line to line, mm; of contour lines with its sign.
    pub spacing_mm: f64,
    /// P.P.INT: greatest distance of two points, mm.
    pub interval_mm: f64,
    /// Radius of the ball of the stylus, mm.
    pub stylus_radius_mm: f64,
    /// How far the ball of the stylus stands beside the axis of the spindle: the tip is the axes and this.
    pub beside: ScanPoint,
    /// The program is in inches.
    pub inch: bool,
    /// The program that takes the points.
    pub program: ScanName,
    /// The machine parameters of scanning.
    pub rules: ScanRules,
}

/// The name of a digitized program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScanName {
    text: [u8; ScanName::MAX],
    length: u8,
}

impl ScanName {
    /// Longest name of a digitized program (inferred).
    pub const MAX: usize = 16;

    /// A name of ASCII letters, digits, `_` and `-`, as it fits on every medium; with or without `.H`.
    pub fn new(name: &str) -> Option<ScanName> {
        let stem = name.strip_suffix(".H").unwrap_or(name);
        let fits = |letter: u8| letter.is_ascii_alphanumeric() || matches!(letter, b'_' | b'-');
        if stem.is_empty() || stem.len() > ScanName::MAX || !stem.bytes().all(fits) {
            return None;
        }
        let mut made = ScanName::default();
        for (to, from) in made.text.iter_mut().zip(stem.bytes()) {
            *to = from;
        }
        made.length = stem.len() as u8;
        Some(made)
    }

    /// The name of the file with the points.
    pub fn as_str(&self) -> &str {
        let used = self.text.get(..usize::from(self.length));
        used.and_then(|text| std::str::from_utf8(text).ok())
            .unwrap_or_default()
    }
}

/// How a range is scanned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScanPattern {
    /// Cycle 6: to and fro in lines along an axis.
    Meander {
        /// The axis along which lines run, LINE DIRECTION.
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
    /// Feed for positioning, MP6150, mm/min.
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
    /// A probe that measures how far it is deflected (MP6200 = 1); then the feeds of positioning and of the first
    /// contact are MP6361 and MP6350.
    pub measuring: Option<MeasuringRules>,
}

/// A measuring probe: MP6310 to MP6390 [000:7882-7958].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuringRules {
    /// MP6310: how far the stylus is deflected while it scans, mm.
    pub depth_mm: f64,
    /// MP6320: whether the probe counts against the machine axes X, Y, Z.
    pub reversed: [bool; 3],
    /// MP6322: which axis of the probe belongs to the machine axes X, Y, Z.
    pub axes: [usize; 3],
    /// MP6330: how far it may be deflected, mm.
    pub limit_mm: f64,
    /// MP6360: along the surface, mm/min (inferred: no manual says with which feed it scans).
    pub feed_mm_min: f64,
    /// MP6362: the feed falls where the deflection is not what it is to be.
    pub slows: bool,
    /// MP6390: half of the side of the square in which a contour line ends, mm.
    pub window_mm: f64,
}

impl MeasuringRules {
    /// A deflection along the axes of the machine.
    pub fn along_axes(&self, probe: &ScanPoint) -> ScanPoint {
        deflection_along_axes(probe, self.axes, self.reversed)
    }
}

/// A deflection of a measuring probe along the axes of the machine, mm: which axis of the probe belongs to each (MP6322), and
/// whether that counts against it (MP6320).
pub fn deflection_along_axes(probe: &ScanPoint, axes: [usize; 3], reversed: [bool; 3]) -> ScanPoint {
    std::array::from_fn(|k| {
        let place = axes.get(k).copied().unwrap_or(k);
        let value = probe.get(place).copied().unwrap_or(0.0);
        if reversed.get(k) == Some(&true) {
            -value
        } else {
            value
        }
    })
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
            measuring: None,
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
    /// A measuring probe was deflected farther than MP6330.
    DeflectionExceedsMax,
    /// The probe is not ready.
    NotReady,
    /// There is no room for more points.
    MemoryFull,
}
