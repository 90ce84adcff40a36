//! The axes as the control moves them, for whoever watches it.

use bahn_kernel::Mover;
use bahn_path::Axis;
use bahn_system900::AxisBlock;

use crate::control::Control900;

/// An axis as it is after a cycle; positions in machine coordinates, mm or degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisView {
    /// Its physical number, from 1 on.
    pub physical: u8,
    /// Its channel, from 1 on.
    pub channel: u8,
    /// Its place on the path of the channel; `None` of an axis that no program moves.
    pub on_path: Option<Axis>,
    /// A path moves it now.
    pub is_led: bool,
    /// Its position loop is closed.
    pub closed: bool,
    /// The axes of its channel are enabled.
    pub enabled: bool,
    /// Its reference point is known.
    pub referenced: bool,
    /// Where it is commanded to be.
    pub nominal: f64,
    /// Speed that is commanded, mm/s, with its sign.
    pub speed_mm_s: f64,
    /// Where its encoder is.
    pub actual: f64,
    /// Nominal less actual position.
    pub lag: f64,
    /// What its loop gives out, V.
    pub volts: f64,
    /// The settings of its block.
    pub settings: AxisBlock,
}

impl Control900 {
    /// All axes that are connected.
    pub fn axes(&self) -> impl Iterator<Item = AxisView> {
        let machine = self.machine();
        let all = machine.places.iter().zip(machine.core.axes.iter());
        all.map(|(place, unit)| AxisView {
            physical: place.physical,
            channel: place.channel + 1,
            on_path: (!unit.is_plc_axis()).then_some(unit.axis),
            is_led: unit.mover == Mover::Path,
            closed: unit.servo.closed(),
            enabled: unit.enabled,
            referenced: unit.referenced,
            nominal: unit.nominal,
            speed_mm_s: unit.speed,
            actual: unit.servo.actual_mm(),
            lag: unit.servo.lag_mm(),
            volts: unit.servo.volts(),
            settings: place.block,
        })
    }
}
