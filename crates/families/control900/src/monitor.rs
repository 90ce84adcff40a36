//! What watches the axes: lag, standstill, voltage, areas [002:7044-7127] [002:7684-7790].
//!
//! Decision: Lag is compared with what a loop of the gain makes of the nominal speed, so that ramps are no fault; within the
//! exact stop it is none at any speed
//!
//! Decision: Area monitoring compares control less reference with its ranges; byte 1 is set within the exact stop

use bahn_kernel::is_within_range;
use bahn_system900::{AxisParameter, ChannelParameter, Memory, Name, Place};

use crate::axis_state::AxisPlace;
use crate::machine::Machine;
use crate::message::Kind;

/// Parameters of an area: channel, reference, control, two ranges.
const AREA_BLOCK: u32 = 5;

/// Watches all axes for a cycle.
pub(crate) fn watch(machine: &mut Machine) {
    let time_s = f64::from(machine.core.timing.contour_us()) * 1e-6;
    for index in 0..machine.places.len() {
        let fault = watch_axis(machine, index, time_s);
        if let (Some(number), Some(place)) = (fault, machine.places.get(index).copied()) {
            show_axis_message(machine, &place, number);
            let logical = Some(place.logical).filter(|logical| *logical > 0);
            machine.raise(number, place.channel + 1, logical, Kind::High);
            // Also while the message is pending: an emergency program moves no axis that has failed.
            if let Some(channel) = machine.channels.get_mut(usize::from(place.channel)) {
                channel.wanted.abort = true;
            }
        }
        watch_areas(machine, index);
    }
}

fn watch_axis(machine: &mut Machine, index: usize, time_s: f64) -> Option<u32> {
    let place = machine.places.get(index)?;
    let unit = machine.core.axes.get_mut(index)?;
    let watch = machine.watches.get_mut(index)?;
    let monitored = machine
        .memory
        .of_axis(place.physical, AxisParameter::VoltageMonitored)
        .whole()
        == Some(1);
    watch.axis(place, unit, time_s, monitored)
}

/// P12188, P12189.
fn watch_areas(machine: &mut Machine, index: usize) {
    let (Some(place), Some(unit)) = (machine.places.get(index), machine.core.axes.get(index)) else {
        return;
    };
    let first = Memory::axis_place(place.physical, AxisParameter::Areas).and_then(Place::q);
    let result = Memory::axis_place(place.physical, AxisParameter::AreaResult).and_then(Place::q);
    let (Some(first), Some(result)) = (first, result) else {
        return;
    };
    for area in 0..2 {
        let at = first + area * AREA_BLOCK;
        let memory = &machine.memory;
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
            own if own == -f64::from(internal(AxisParameter::ActualPosition)) => Some(unit.servo.actual_mm()),
            pointer => pointed(memory, channel, pointer),
        };
        let (Some(reference), Some(control)) = (reference, pointed(memory, channel, control)) else {
            continue;
        };
        let distance = control - reference;
        let [fine, _] = place.block.exact_stop_mm;
        let within = |offset: u32| number(offset).is_some_and(|range| is_within_range(distance, range));
        let bytes = [distance.abs() <= fine, within(3), within(4), false].map(u8::from);
        machine
            .memory
            .store_bits(Place::Q(result + area), i32::from_le_bytes(bytes));
    }
}

/// P12197 to P12199.
fn show_axis_message(machine: &mut Machine, place: &AxisPlace, number: u32) {
    if let Some(first) = Memory::axis_place(place.physical, AxisParameter::Message).and_then(Place::q) {
        let values = [
            f64::from(number),
            f64::from(place.channel + 1),
            f64::from(place.logical),
        ];
        for (at, value) in (first..).zip(values) {
            machine.memory.store(Place::Q(at), Some(value), 0);
        }
    }
}

/// A parameter by which messages are ordered was written [002:3330-3420].
pub(crate) fn order_message(machine: &mut Machine, number: u8, parameter: ChannelParameter) {
    let what = machine.memory.of_channel(number, parameter).whole().unwrap_or(0);
    let axis = machine
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
        machine.raise(what, number, axis, kind);
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
