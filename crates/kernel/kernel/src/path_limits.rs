//! The limits of a path: those of its axes, through the kinematics, and those of the list of machine parameters.

use bahn_motion::Limits;
use bahn_parameters::ParameterList;
use bahn_path::PerAxis;

use crate::axis::AxisUnit;
use crate::kinematics::{Kinematics, along_path};

/// The limits of a path: those of the axes, through the kinematics.
pub fn path_limits<'a>(
    parameters: &ParameterList,
    axes: impl Iterator<Item = &'a AxisUnit> + Clone,
    kinematics: &dyn Kinematics,
) -> Limits {
    let shares = kinematics.shares();
    let of = |value: fn(&AxisUnit) -> f64, otherwise: f64| {
        let limits = PerAxis::from_fn(|axis| {
            let mut axes = axes.clone();
            axes.find(|unit| unit.axis == axis).map_or(otherwise, value)
        });
        along_path(&shares, &limits)
    };
    Limits {
        max_feed_mm_min: of(|unit| unit.parameters.motion.rapid_mm_min, 0.0),
        acceleration_m_s2: of(|unit| unit.parameters.motion.acceleration_m_s2, 1.0),
        radial_acceleration_m_s2: parameters.radial_acceleration_m_s2(),
        corner_angle_deg: parameters.corner_angle_deg(),
        servo_lag: !parameters.feed_precontrol(),
        cycle_s: f64::from(parameters.model().timing().contour_us()) * 1e-6,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: parameters.spindle_parameters().rigid_ramps().map(Into::into),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    }
}
