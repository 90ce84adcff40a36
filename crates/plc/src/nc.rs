//! What PLC modules need from the control.

use bahn_exchange::{Exchange, signal};
use bahn_parameters::ParameterList;

/// The control as the PLC sees it beside the exchanged operands.
pub trait Nc {
    /// The machine parameters in force. Presets of timers (MP4110) and counters (MP4120) come from here.
    fn parameters(&self) -> &ParameterList;
}

/// A stand-in for the control on a desk: machine parameters from a list, no axes.
#[derive(Clone, Debug)]
pub struct TestNc {
    /// The machine parameters in force.
    pub parameters: ParameterList,
}

impl TestNc {
    /// With the machine parameters of a list.
    pub fn new(parameters: ParameterList) -> TestNc {
        TestNc { parameters }
    }
}

impl Nc for TestNc {
    fn parameters(&self) -> &ParameterList {
        &self.parameters
    }
}

/// Puts the machine parameters that are meant for the PLC into its words and markers: MP4210 (in 1/10 000),
/// MP4220 and MP4310, the last also as markers M2192-M2239 and M3200-M3263 [000:11665-11742]. Parameters
/// that the model does not have leave their operands alone.
pub fn mirror_parameters(parameters: &ParameterList, exchange: &mut Exchange) {
    let numbers = signal::all().iter().filter_map(|signal| match signal.operand {
        signal::SignalOperand::Number(number) => Some((parameter_of(signal.name)?, number)),
        _ => None,
    });
    for ((parameter, index), number) in numbers {
        let Some(value) = parameters.get(parameter, index) else {
            continue;
        };
        let scaled = if parameter == 4210 {
            value * 10_000.0
        } else {
            value
        };
        exchange.nc_set_number(number, scaled.round() as i32);
    }
    let markers = signal::MP4310_0_TO_2_BITS
        .iter()
        .chain(signal::MP4310_3_TO_6_BITS.iter());
    for (position, marker) in markers.enumerate() {
        let index = u8::try_from(position / 16).unwrap_or(u8::MAX);
        if let Some(value) = parameters.get(4310, index) {
            exchange.nc_set(marker, (value as u32) >> (position % 16) & 1 != 0);
        }
    }
}

/// `MP4210_3` names machine parameter 4210.3.
fn parameter_of(name: &str) -> Option<(u16, u8)> {
    let (parameter, index) = name.strip_prefix("MP")?.split_once('_')?;
    Some((parameter.parse().ok()?, index.parse().ok()?))
}
