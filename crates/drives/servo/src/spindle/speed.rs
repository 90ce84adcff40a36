//! From the programmed speed to the voltage [000:5520-5610].

use super::rotation::Rotation;
use super::settings::{Gear, SpindlePolarity, SpindleSettings};

/// The gear range for a programmed speed in rpm, 0 to 7: the smallest that reaches it. `None` for a speed
/// that the spindle does not have, also 0 where MP3120 does not permit it: WRONG RPM.
pub(super) fn gear_for(settings: &SpindleSettings, rpm: f64) -> Option<u8> {
    let zero_refused = rpm == 0.0 && !settings.zero_permitted;
    if rpm.is_nan() || rpm < 0.0 || zero_refused {
        return None;
    }
    let reaches = |gear: &Gear| gear.rated_rpm > 0.0 && rpm <= gear.rated_rpm;
    let index = settings.gears.iter().position(reaches)?;
    u8::try_from(index).ok()
}

/// The speed that runs for a programmed one, rpm: times the override within MP3310, at most MP3515.
pub(super) fn nominal_rpm(settings: &SpindleSettings, gear: &Gear, rpm: f64, override_percent: f64) -> f64 {
    let [min, max] = settings.override_percent;
    let percent = override_percent.max(min).min(max);
    (rpm * percent / 100.0).min(gear.max_rpm)
}

/// The amount of the voltage for a speed, V: that of the gear in proportion, at least MP3240.1 where the
/// spindle shall turn at all.
pub(super) fn volts(settings: &SpindleSettings, gear: &Gear, rpm: f64) -> f64 {
    if rpm <= 0.0 || gear.rated_rpm <= 0.0 {
        return 0.0;
    }
    let volts = rpm * gear.rated_volts / gear.rated_rpm;
    volts.max(settings.min_volts).min(settings.max_volts)
}

/// The sign of the voltage for a direction: MP3130, turned round by M2489 [000:5492-5518].
pub(super) fn polarity(settings: &SpindleSettings, rotation: Rotation, inverted: bool) -> f64 {
    let sign = match (settings.polarity, rotation) {
        (_, Rotation::M5) => 0.0,
        (SpindlePolarity::M3Positive, Rotation::M3) | (SpindlePolarity::M3Negative, Rotation::M4) => 1.0,
        (SpindlePolarity::M3Positive, Rotation::M4) | (SpindlePolarity::M3Negative, Rotation::M3) => -1.0,
        (SpindlePolarity::BothPositive, _) => 1.0,
        (SpindlePolarity::BothNegative, _) => -1.0,
    };
    if inverted { -sign } else { sign }
}
