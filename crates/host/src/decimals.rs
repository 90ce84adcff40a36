//! Values of signals as text.

use bahn_control::{AxisSignal, Signal};

/// A value with as many decimals as its signal is good for.
pub fn decimals(signal: &Signal, value: f64) -> Decimals {
    let places = match signal {
        Signal::Axis(_, AxisSignal::Actual | AxisSignal::Nominal | AxisSignal::Lag) => 5,
        Signal::Axis(_, AxisSignal::Volts) | Signal::SpindleVolts | Signal::SpindleAngle => 4,
        Signal::Axis(..) | Signal::PathSpeed | Signal::SpindleRpm => 3,
        Signal::Block | Signal::Bit(_) | Signal::Number(_) => 0,
    };
    Decimals { value, places }
}

/// A number with its decimals, never -0.
#[derive(Clone, Copy, Debug)]
pub struct Decimals {
    value: f64,
    places: usize,
}

impl std::fmt::Display for Decimals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let scale = 10f64.powi(i32::try_from(self.places).unwrap_or(0));
        let rounded = (self.value * scale).round() / scale + 0.0;
        write!(f, "{rounded:.*}", self.places)
    }
}
