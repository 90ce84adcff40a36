//! What watches the axes: lag, standstill, voltage, areas [002:7044-7127] [002:7684-7790].
//!
//! Decision: Lag is compared with what a loop of the gain makes of the nominal speed, so that ramps are no fault; within the
//! exact stop it is none at any speed
//!
//! Decision: Area monitoring compares control less reference with its ranges; byte 1 is set within the exact stop

use bahn_kernel::{AxisUnit, LagRule, LagWatch, is_within_range};
use bahn_system900::{AxisParameter, ChannelParameter, Connection, Memory, Name, Place};

use crate::machine::Machine;
use crate::message::Kind;
use crate::units::AxisPlace;

/// Numbers of the messages [002:7044-7127] [002:6893-6903].
const LAG: u32 = 2001;
const VOLTAGE: u32 = 2002;
const BARRED: u32 = 2020;
const STANDSTILL: u32 = 2022;
/// Parameters of an area: channel, reference, control, two ranges.
const AREA_BLOCK: u32 = 5;

/// What watches an axis.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Watch {
    lag: LagWatch,
    /// The nominal position stands, the axis is not within its exact stop, since so long, s.
    restless_s: f64,
}

impl Machine {
    /// Watches all axes for a cycle.
    pub(crate) fn watch(&mut self) {
        let time_s = f64::from(self.core.timing.contour_us()) * 1e-6;
        for index in 0..self.places.len() {
            let fault = self.watch_axis(index, time_s);
            if let (Some(number), Some(place)) = (fault, self.places.get(index).copied()) {
                self.show_axis_message(&place, number);
                let logical = Some(place.logical).filter(|logical| *logical > 0);
                self.raise(number, place.channel + 1, logical, Kind::High);
            }
            self.watch_areas(index);
        }
    }

    fn watch_axis(&mut self, index: usize, time_s: f64) -> Option<u32> {
        let place = self.places.get(index)?;
        let unit = self.core.axes.get_mut(index)?;
        let watch = self.watches.get_mut(index)?;
        let monitored = self
            .memory
            .of_axis(place.physical, AxisParameter::VoltageMonitored)
            .whole()
            == Some(1);
        watch.axis(place, unit, time_s, monitored)
    }

    /// P12188, P12189.
    fn watch_areas(&mut self, index: usize) {
        let (Some(place), Some(unit)) = (self.places.get(index), self.core.axes.get(index)) else {
            return;
        };
        let first = Memory::axis_place(place.physical, AxisParameter::Areas).and_then(Place::q);
        let result = Memory::axis_place(place.physical, AxisParameter::AreaResult).and_then(Place::q);
        let (Some(first), Some(result)) = (first, result) else {
            return;
        };
        for area in 0..2 {
            let at = first + area * AREA_BLOCK;
            let memory = &self.memory;
            let number = |offset: u32| memory.system_cell(at + offset).number();
            let Some(control) = number(2).filter(|pointer| *pointer != 0.0) else {
                continue;
            };
            let channel = number(0).unwrap_or(0.0) as u8;
            let reference = match number(1).unwrap_or(0.0) {
                0.0 => Some(unit.servo.actual_mm()),
                own if own == -f64::from(internal(AxisParameter::MachinePosition)) => {
                    Some(unit.servo.actual_mm())
                }
                own if own == -f64::from(internal(AxisParameter::ActualPosition)) => {
                    Some(unit.servo.actual_mm())
                }
                pointer => pointed(memory, channel, pointer),
            };
            let (Some(reference), Some(control)) = (reference, pointed(memory, channel, control)) else {
                continue;
            };
            let distance = control - reference;
            let [fine, _] = place.block.exact_stop_mm;
            let within = |offset: u32| number(offset).is_some_and(|range| is_within_range(distance, range));
            let bytes = [distance.abs() <= fine, within(3), within(4), false].map(u8::from);
            self.memory
                .store_bits(Place::Q(result + area), i32::from_le_bytes(bytes));
        }
    }

    /// P12197 to P12199.
    fn show_axis_message(&mut self, place: &AxisPlace, number: u32) {
        if let Some(first) = Memory::axis_place(place.physical, AxisParameter::Message).and_then(Place::q) {
            let values = [
                f64::from(number),
                f64::from(place.channel + 1),
                f64::from(place.logical),
            ];
            for (at, value) in (first..).zip(values) {
                self.memory.store(Place::Q(at), Some(value), 0);
            }
        }
    }

    /// All axes of a channel are referenced.
    pub(crate) fn is_referenced(&self, k: usize) -> bool {
        self.core.axes.owned(k).all(|unit| unit.referenced)
    }

    /// A parameter by which messages are ordered was written [002:3330-3420].
    pub(crate) fn order_message(&mut self, number: u8, parameter: ChannelParameter) {
        let what = self.memory.of_channel(number, parameter).whole().unwrap_or(0);
        let axis = self
            .memory
            .of_channel(number, ChannelParameter::MessageAxis)
            .whole();
        let axis = axis
            .and_then(|axis| u8::try_from(axis).ok())
            .filter(|axis| *axis > 0);
        let kind = match parameter {
            ChannelParameter::SystemMessage => Kind::System,
            ChannelParameter::HighMessage => Kind::High,
            ChannelParameter::LowMessage => Kind::Low,
            _ => Kind::Display,
        };
        if let Some(what) = u32::try_from(what).ok().filter(|what| *what > 0) {
            self.raise(what, number, axis, kind);
        }
    }
}

impl Watch {
    /// The number of the message that an axis deserves.
    fn axis(&mut self, place: &AxisPlace, unit: &mut AxisUnit, time_s: f64, monitored: bool) -> Option<u32> {
        let block = &place.block;
        if !unit.servo.closed() {
            *self = Watch::default();
            return None;
        }
        if block.connection == Connection::Barred && !unit.stands() {
            return Some(BARRED);
        }
        let lag_mm = unit.servo.lag_mm();
        let [least_mm, _] = block.exact_stop_mm;
        if let Some(limit_s) = block.lag_s {
            let rule = LagRule {
                gain_s: block.gain_s,
                feed_forward: block.feed_forward,
                part: block.lag_part,
                least_mm,
                time_s: limit_s,
            };
            if self.lag.passes(&rule, unit.speed, lag_mm, time_s) {
                return Some(LAG);
            }
        }
        let restless = unit.stands() && lag_mm.abs() > least_mm;
        self.restless_s = if restless { self.restless_s + time_s } else { 0.0 };
        if self.restless_s > block.standstill_s {
            return Some(STANDSTILL);
        }
        let limit = block.volts_limit.filter(|_| monitored);
        limit.filter(|limit| unit.servo.volts().abs() >= *limit).map(|_| {
            unit.servo.open();
            VOLTAGE
        })
    }
}

/// The number by which a reference means the own axis: as of physical axis 1.
fn internal(parameter: AxisParameter) -> u32 {
    Memory::axis_place(1, parameter).and_then(Place::q).unwrap_or(0)
}

/// What a pointer means: a system parameter, or one of a channel.
fn pointed(memory: &Memory, channel: u8, pointer: f64) -> Option<f64> {
    let number = pointer.abs() as u32;
    let name = match channel {
        0 => Name::Q(number),
        channel => Name::P(channel, number),
    };
    memory.cell(name).ok()?.number()
}
