//! How fast a rotating tool turns and moves while the tool probe measures it [000:7985-8021].
//!
//! Decision: With MP6507 = 2 the probing feed is the tolerance in each turn, too, so that it falls below the constant
//! of the manual where a small tool would turn faster than 1000 rpm: the measuring error keeps to its limit. A radius
//! of 30 mm is one of the first step of MP6507 = 1

use bahn_parameters::machining::{ToolProbeParameters, ToolProbeTolerance};

/// Speeds are not higher, rpm [000:7985].
const SPEED_MAX_RPM: f64 = 1000.0;

/// The speed for a radius in mm, rpm: `n = MP6570 / (2 π r 10^-3)` [000:7985-7992].
pub fn speed_rpm(parameters: &ToolProbeParameters, radius_mm: f64) -> f64 {
    let speed = parameters.surface_m_min / (std::f64::consts::TAU * radius_mm * 1e-3);
    speed.min(SPEED_MAX_RPM)
}

/// The measuring error that is permitted for a radius, mm [000:8007-8019].
fn tolerance_mm(parameters: &ToolProbeParameters, radius_mm: f64) -> f64 {
    const STEP_MM: f64 = 30.0;
    const REFERENCE_MM: f64 = 5.0;
    parameters.error_mm
        * match parameters.tolerance {
            ToolProbeTolerance::Constant => 1.0,
            // A radius of 30 mm is still one of the first step (inferred: `up to`).
            ToolProbeTolerance::Stepped => (radius_mm / STEP_MM).ceil().max(1.0),
            ToolProbeTolerance::ConstantFeed => radius_mm / REFERENCE_MM,
        }
}

/// The probing feed, mm/min: the tolerance in each turn [000:7993-8005].
pub fn feed_mm_min(parameters: &ToolProbeParameters, radius_mm: f64) -> f64 {
    tolerance_mm(parameters, radius_mm) * speed_rpm(parameters, radius_mm)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_parameters::{ControlModel, ParameterList};

    /// r 10, MP6570 40: 40 / (2 π 0.01) = 636.6 rpm; with MP6510 0.005 3.18 mm/min (MP6507 = 0), 6.37 mm/min (2).
    #[test]
    fn speed_and_feed_of_a_rotating_tool() {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for (number, value) in [(6570, 40.0), (6510, 0.005), (6507, 0.0)] {
            list.set(number, 0, value).unwrap();
        }
        let near =
            |value: f64, expected: f64| assert!((value - expected).abs() < 0.002 * expected, "{value}");
        near(speed_rpm(&list.tool_probe(), 10.0), 636.6);
        near(feed_mm_min(&list.tool_probe(), 10.0), 3.18);
        // Radius 5: 1273 rpm are limited to 1000.
        assert_eq!(speed_rpm(&list.tool_probe(), 5.0), 1000.0);
        list.set(6507, 0, 1.0).unwrap();
        let steps = [1.0, 30.0, 30.1, 60.0, 89.0, 120.0];
        let steps = steps.map(|radius| (tolerance_mm(&list.tool_probe(), radius) / 0.005).round());
        assert_eq!(steps, [1.0, 1.0, 2.0, 2.0, 3.0, 4.0]);
        list.set(6507, 0, 2.0).unwrap();
        near(feed_mm_min(&list.tool_probe(), 10.0), 6.37);
        // v = MP6570 · MP6510 / (10 π 10^-3), whatever the radius.
        let constant = 40.0 * 0.005 / (10.0 * std::f64::consts::PI * 1e-3);
        near(feed_mm_min(&list.tool_probe(), 80.0), constant);
    }
}
