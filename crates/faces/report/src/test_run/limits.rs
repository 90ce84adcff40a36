//! From a list of machine parameters to the limits of motion.

use bahn_motion::{Limits, SERVO_WINDOW_S};
use bahn_parameters::ParameterList;
use bahn_path::PerAxis;

/// What a path is planned with on a machine of these parameters, at an override of feed and rapid traverse, %.
pub fn limits(list: &ParameterList, override_percent: f64) -> Limits {
    Limits {
        max_feed_mm_min: PerAxis::from_fn(|axis| list.rapid_traverse_mm_min(axis)),
        acceleration_m_s2: PerAxis::from_fn(|axis| list.acceleration_m_s2(axis)),
        radial_acceleration_m_s2: list.radial_acceleration_m_s2(),
        corner_angle_deg: list.corner_angle_deg(),
        servo_lag: !list.feed_precontrol(),
        cycle_s: f64::from(list.model().limits().contour_cycle_us) * 1e-6,
        servo_window_s: SERVO_WINDOW_S,
        spindle: list.spindle_parameters().rigid_ramps().map(Into::into),
        feed_override_percent: override_percent,
        rapid_override_percent: override_percent,
    }
}
