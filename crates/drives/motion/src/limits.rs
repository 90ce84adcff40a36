//! What the machine can do.

use bahn_path::{Axis, FeedRate, OverrideLaw, PathElement, PerAxis, Thread};

/// The limits that planning obeys, in the units of the machine parameters. Values that no machine can
/// have (NaN, negative) count as the least one: nothing moves, or moves with the least acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Rapid traverse and greatest feed of each axis, mm/min or degrees/min: MP1010 [000:4836-4841].
    pub max_feed_mm_min: PerAxis<f64>,
    /// Acceleration of each axis, m/s²; 1000 degrees/s² per unit for rotary axes (inferred): MP1060
    /// [000:4790-4797].
    pub acceleration_m_s2: PerAxis<f64>,
    /// Radial acceleration on circles, m/s²: MP1070 [000:5089-5092].
    pub radial_acceleration_m_s2: f64,
    /// Change of direction up to which a corner is passed without a stop, degrees: MP7460
    /// [000:5096-5108].
    pub corner_angle_deg: f64,
    /// Operation with servo lag (MP1390 = 1), in which alone M90 is effective [000:5114].
    pub servo_lag: bool,
    /// Contour cycle: the time from one nominal position to the next, s. 0.003 for TNC 415 and 425,
    /// 0.006 for TNC 407 and 360 [000:4749].
    pub cycle_s: f64,
    /// Time over which the servo spreads a step of velocity at a corner, s:
    /// [`SERVO_WINDOW_S`](crate::SERVO_WINDOW_S).
    pub servo_window_s: f64,
    /// Gear ranges of the spindle, slowest first, for paths that follow it; those without speed are not
    /// used.
    pub spindle: [SpindleGear; GEARS],
    /// Feed override, 0 to 150 % [003:1135-1145].
    pub feed_override_percent: f64,
    /// Override of rapid traverse, 0 to 150 %; more than 100 % is without effect as MP1010 limits.
    pub rapid_override_percent: f64,
}

/// Gear ranges of the spindle at most [000:5522].
pub const GEARS: usize = 8;

/// A gear range of the spindle as paths need it that follow the spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpindleGear {
    /// Greatest speed that is programmed in it, rpm: MP3510; 0 is no gear range.
    pub rated_rpm: f64,
    /// Change of speed in rigid tapping, rpm/s: MP3410.3 in the voltage of the gear; 0 is no ramp.
    pub ramp_rpm_s: f64,
}

impl From<[f64; 2]> for SpindleGear {
    fn from([rated_rpm, ramp_rpm_s]: [f64; 2]) -> SpindleGear {
        SpindleGear {
            rated_rpm,
            ramp_rpm_s,
        }
    }
}

/// Least entry of MP1060 and MP1070, m/s².
const LEAST_ACCELERATION_M_S2: f64 = 0.001;
/// The most that an override potentiometer gives, % [003:1135-1145].
const GREATEST_OVERRIDE_PERCENT: f64 = 150.0;
/// Contour cycle in place of one that is not positive, s.
const LEAST_CYCLE_S: f64 = 0.0001;
/// Speeds below this are standstill, mm/s: a millionth of the least feed that can be programmed.
const STANDSTILL_MM_S: f64 = 1e-9;
/// A joint whose direction changes less than this is no corner, degrees (inferred). It covers the
/// rounding of programmed coordinates, not a change of direction that somebody wants.
const TANGENTIAL_DEG: f64 = 0.01;

/// Least acceleration along a thread, mm/s², for pitches near 0.
const LEAST_RAMP_MM_S2: f64 = 1e-3;
/// Stands for the feed limit 0: slow enough to be standstill, without infinities in the formulas, mm/min.
const NO_FEED_MM_MIN: f64 = 1e-30;
/// Greatest feed limit that counts, mm/min: far above MP1010's 300 000, without infinities.
const FASTEST_MM_MIN: f64 = 1e9;

/// The main axes, the first ones in the order of axes.
pub(crate) const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// What of a movement decides how fast its axes let it be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slowest {
    /// The time, s, that a mm of path takes the axis that needs longest for its share of it.
    pub(crate) time: f64,
    /// The greatest share of an axis in the path.
    pub(crate) share: f64,
}

/// [`Limits`] in the units of the formulas, made once.
#[derive(Clone, Debug)]
pub(crate) struct Dynamics {
    /// Seconds that a mm takes each axis at its rapid traverse MP1010.
    pub(crate) slowness: PerAxis<f64>,
    /// Seconds that a mm takes any axis at least.
    least_slowness: f64,
    /// Acceleration of each axis, MP1060, mm/s².
    pub(crate) acceleration: PerAxis<f64>,
    /// `sqrt(MP1060² + MP1070²)` of each axis, mm/s².
    pub(crate) bound: PerAxis<f64>,
    /// Radial acceleration on arcs, MP1070, mm/s².
    pub(crate) radial: f64,
    /// Cosine of the greatest change of direction that is passed.
    pub(crate) corner_cosine: f64,
    /// Axes run with servo lag, so that M90 acts.
    pub(crate) servo_lag: bool,
    /// Contour cycle, s.
    pub(crate) cycle: f64,
    /// The servo's window, s.
    pub(crate) servo_window: f64,
    /// Effective overrides as factors, 0 to 1.5.
    feed_override: f64,
    rapid_override: f64,
    spindle_override: f64,
    /// Programmed feeds count as rapid traverse.
    pub(crate) all_rapid: bool,
    /// Overrides of feed and rapid traverse, %.
    percent: [f64; 2],
    gears: [SpindleGear; GEARS],
}

impl Dynamics {
    pub(crate) fn new(limits: &Limits) -> Dynamics {
        let acceleration = limits.acceleration_m_s2.map(mm_s2);
        let radial = mm_s2(limits.radial_acceleration_m_s2);
        let corner = limits.corner_angle_deg.clamp(TANGENTIAL_DEG, 180.0);
        Dynamics {
            slowness: limits.max_feed_mm_min.map(slowness),
            least_slowness: 0.0,
            acceleration,
            bound: acceleration.map(|a| a.hypot(radial)),
            radial,
            corner_cosine: if corner.is_nan() { TANGENTIAL_DEG } else { corner }
                .to_radians()
                .cos(),
            servo_lag: limits.servo_lag,
            cycle: limits.cycle_s.clamp(LEAST_CYCLE_S, 1.0).max(LEAST_CYCLE_S),
            servo_window: limits.servo_window_s.clamp(LEAST_CYCLE_S, 1.0).max(LEAST_CYCLE_S),
            feed_override: factor(limits.feed_override_percent),
            rapid_override: factor(limits.rapid_override_percent).min(1.0),
            spindle_override: 1.0,
            all_rapid: false,
            percent: [limits.feed_override_percent, limits.rapid_override_percent],
            gears: limits.spindle,
        }
    }

    /// Other overrides, %: feed, rapid traverse, spindle.
    pub(crate) fn set_overrides(&mut self, [feed, rapid, spindle]: [f64; 3]) {
        self.percent = [feed, rapid];
        (self.feed_override, self.spindle_override) = (factor(feed), factor(spindle));
        self.rapid_override = factor(rapid).min(1.0);
    }

    /// How fast the spindle lets an element that follows it accelerate, mm/s²; infinite for others.
    #[inline]
    pub(crate) fn spindle_acceleration(&self, element: &PathElement) -> f64 {
        match (&element.override_law, element.feed) {
            (OverrideLaw::Spindle(thread), FeedRate::Programmed(feed)) => self.ramp(thread, feed),
            _ => f64::INFINITY,
        }
    }

    /// The ramp of the smallest gear range that has the speed, along the path, mm/s².
    fn ramp(&self, thread: &Thread, feed_mm_min: f64) -> f64 {
        let rpm = feed_mm_min / thread.pitch_mm;
        let gear = self.gears.iter().find(|gear| gear.rated_rpm >= rpm);
        match gear {
            Some(gear) if gear.ramp_rpm_s > 0.0 => {
                (gear.ramp_rpm_s * thread.pitch_mm / 60.0).max(LEAST_RAMP_MM_S2)
            }
            _ => f64::INFINITY,
        }
    }

    /// No axis is faster than this, mm/min.
    pub(crate) fn set_rapid_limit(&mut self, limit_mm_min: f64) {
        self.least_slowness = slowness(limit_mm_min);
    }

    /// Greatest path speed, mm/s, of a movement: the programmed feed with its override, and no axis
    /// faster than it can be.
    #[inline]
    pub(crate) fn speed(&self, feed: FeedRate, law: OverrideLaw, slowest: Slowest) -> f64 {
        let slowest = slowest.time.max(slowest.share * self.least_slowness);
        let feed = match law {
            OverrideLaw::Free if self.all_rapid => FeedRate::Rapid,
            _ => feed,
        };
        let speed = match feed {
            FeedRate::Rapid => self.rapid(law) / slowest,
            FeedRate::Programmed(feed) => {
                let speed = feed / 60.0 * self.feed(law);
                // The comparison is false for NaN, which stays and is standstill below.
                if speed * slowest > 1.0 {
                    1.0 / slowest
                } else {
                    speed
                }
            }
        };
        if speed > STANDSTILL_MM_S { speed } else { 0.0 }
    }

    /// The effective override of a programmed feed as a factor [000:6094-6098] [003:5106].
    #[inline]
    fn feed(&self, law: OverrideLaw) -> f64 {
        match law {
            OverrideLaw::Free => self.feed_override,
            OverrideLaw::Spindle(_) => self.spindle_override,
            OverrideLaw::Tapping { .. } | OverrideLaw::Disabled => bounded(self.percent[0], law),
        }
    }

    /// That of rapid traverse: more than 100 % is without effect.
    #[inline]
    fn rapid(&self, law: OverrideLaw) -> f64 {
        match law {
            OverrideLaw::Free | OverrideLaw::Spindle(_) => self.rapid_override,
            OverrideLaw::Tapping { .. } | OverrideLaw::Disabled => bounded(self.percent[1], law).min(1.0),
        }
    }
}

/// Time that an axis takes for a mm at a feed, s/mm.
fn slowness(feed_mm_min: f64) -> f64 {
    60.0 / feed_mm_min
        .clamp(NO_FEED_MM_MIN, FASTEST_MM_MIN)
        .max(NO_FEED_MM_MIN)
}

/// An override as a factor where not every one is effective.
fn bounded(percent: f64, law: OverrideLaw) -> f64 {
    match law {
        OverrideLaw::Tapping {
            from_percent,
            to_percent,
        } => factor(percent.max(from_percent).min(to_percent)),
        OverrideLaw::Free | OverrideLaw::Spindle(_) => factor(percent),
        OverrideLaw::Disabled => 1.0,
    }
}

/// An override as a factor.
fn factor(percent: f64) -> f64 {
    percent.clamp(0.0, GREATEST_OVERRIDE_PERCENT) / 100.0
}

pub(crate) fn mm_s2(m_s2: f64) -> f64 {
    1000.0 * m_s2.max(LEAST_ACCELERATION_M_S2).min(f64::from(u16::MAX))
}
