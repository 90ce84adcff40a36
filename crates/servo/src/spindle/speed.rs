//! From the programmed speed to the voltage [000:5520-5610].

use bahn_parameters::{Gear, SpindleParameters, SpindlePolarity};

use super::Rotation;

/// Shortest lead of the spindle's switching off before the depth, s [000:6072-6077].
const TAPPING_LEAD_MIN_S: f64 = 0.030;

/// The gear range for a programmed speed in rpm, 0 to 7: the smallest that reaches it. `None` for a speed
/// that the spindle does not have, also 0 where MP3120 does not permit it: WRONG RPM.
pub(super) fn gear_for(parameters: &SpindleParameters, rpm: f64) -> Option<u8> {
    let zero_refused = rpm == 0.0 && !parameters.zero_permitted;
    if rpm.is_nan() || rpm < 0.0 || zero_refused {
        return None;
    }
    let reaches = |gear: &Gear| gear.rated_rpm > 0.0 && rpm <= gear.rated_rpm;
    let index = parameters.gears.iter().position(reaches)?;
    u8::try_from(index).ok()
}

/// The speed that runs for a programmed one, rpm: times the override within MP3310, at most MP3515.
pub(super) fn nominal_rpm(
    parameters: &SpindleParameters,
    gear: &Gear,
    rpm: f64,
    override_percent: f64,
) -> f64 {
    let [min, max] = parameters.override_percent;
    let percent = override_percent.max(min).min(max);
    (rpm * percent / 100.0).min(gear.max_rpm)
}

/// The amount of the voltage for a speed, V: that of the gear in proportion, at least MP3240.1 where the
/// spindle shall turn at all.
pub(super) fn volts(parameters: &SpindleParameters, gear: &Gear, rpm: f64) -> f64 {
    if rpm <= 0.0 || gear.rated_rpm <= 0.0 {
        return 0.0;
    }
    let volts = rpm * gear.rated_volts / gear.rated_rpm;
    volts.max(parameters.min_volts).min(parameters.max_volts)
}

/// The sign of the voltage for a direction: MP3130, turned round by M2489 [000:5492-5518].
pub(super) fn polarity(parameters: &SpindleParameters, rotation: Rotation, inverted: bool) -> f64 {
    let sign = match (parameters.polarity, rotation) {
        (_, Rotation::M5) => 0.0,
        (SpindlePolarity::M3Positive, Rotation::M3) | (SpindlePolarity::M3Negative, Rotation::M4) => 1.0,
        (SpindlePolarity::M3Positive, Rotation::M4) | (SpindlePolarity::M3Negative, Rotation::M3) => -1.0,
        (SpindlePolarity::BothPositive, _) => 1.0,
        (SpindlePolarity::BothNegative, _) => -1.0,
    };
    if inverted { -sign } else { sign }
}

/// How long before the depth the spindle is switched off in cycle 2, s: the time of its ramp (V/ms) from its
/// voltage, less the run-on MP7120.2, but 30 ms where the ramp lasts longer than that [000:6072-6077].
pub fn tapping_lead_s(volts: f64, ramp_v_ms: f64, run_on_s: f64) -> f64 {
    if ramp_v_ms <= 0.0 {
        return 0.0;
    }
    let ramp_s = volts.abs() / ramp_v_ms * 1e-3;
    ramp_s - run_on_s.min(ramp_s - TAPPING_LEAD_MIN_S).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lead_of_tapping_is_at_least_30_ms() {
        // 1.8 V at 0.05 V/ms: 36 ms; a run-on of 6 ms or more leaves 30 ms [000:6072-6077].
        let lead_ms = |run_on| (tapping_lead_s(1.8, 0.05, run_on) * 1e6).round() / 1e3;
        assert_eq!(lead_ms(0.0), 36.0);
        assert_eq!(lead_ms(0.002), 34.0);
        assert_eq!(lead_ms(0.006), 30.0);
        assert_eq!(lead_ms(5.0), 30.0);
        // A ramp shorter than 30 ms is not delayed.
        assert_eq!((tapping_lead_s(1.0, 0.05, 1.0) * 1e6).round(), 20_000.0);
        assert_eq!(tapping_lead_s(1.8, 0.0, 0.0), 0.0);
    }
}
