//! What holds the loops and lets the axes move: P8700, P8701, P8702, P8891, clamps [002:3752-3767].
//!
//! Decision: A System 900 whose loops are released, P8700, stops its program; START leads the axes back first

use bahn_kernel::AxisUnit;
use bahn_path::{Direction, PathElement};
use bahn_system900::{AxisParameter, ChannelParameter, Memory};

use crate::axis_state::AxisPlace;
use crate::machine::Machine;

/// Absolute axes are where they were at power-off [002:7012-7022].
pub(crate) fn take_positions(machine: &mut Machine) {
    let places = machine.places.iter();
    for (unit, place) in machine.core.axes.iter_mut().zip(places) {
        if place.block.is_absolute {
            let kept = machine
                .memory
                .of_axis(place.physical, AxisParameter::ActualPosition);
            let count = unit.servo.count();
            unit.set_datum(count, kept.number().unwrap_or(0.0));
            unit.referenced = true;
        }
        unit.transfer();
    }
}

/// Takes the enables of the PLC, opens and closes the loops as they say.
pub(crate) fn follow_enables(machine: &mut Machine) {
    for channel in &mut machine.channels {
        let is_set = |parameter| {
            let cell = machine.memory.of_channel(channel.number, parameter);
            cell.whole().unwrap_or(0) != 0
        };
        channel.loops_enabled = is_set(ChannelParameter::LoopsEnabled);
        channel.axes_enabled = is_set(ChannelParameter::AxesEnabled);
        channel.safety_stop = is_set(ChannelParameter::SafetyStop);
        let number = machine
            .memory
            .of_channel(channel.number, ChannelParameter::PathOverride)
            .whole();
        let number = number
            .and_then(|number| u8::try_from(number).ok())
            .filter(|number| *number > 0);
        channel.override_percent = machine.memory.override_percent(number.unwrap_or(1));
    }
    let closed = machine.core.loops_closed;
    let places = machine.places.iter();
    for (unit, place) in machine.core.axes.iter_mut().zip(places) {
        let Some(channel) = machine.channels.get(unit.channel) else {
            continue;
        };
        let free = follows(&machine.memory, place.physical);
        hold(unit, closed && channel.loops_enabled && !free);
        if unit.enabled != channel.axes_enabled {
            unit.enabled = channel.axes_enabled;
            unit.servo.set_enabled(channel.axes_enabled);
            match channel.axes_enabled {
                true => unit.go_back(),
                false => unit.stand(unit.nominal),
            }
        }
    }
    for k in 0..machine.channels.len() {
        let slope = path_slope_mm_min(machine, k);
        if let Some(channel) = machine.channels.get_mut(k) {
            channel.slope_mm_min = slope;
        }
    }
    // A path whose axes are no longer held stops; START leads them back to where it was left.
    for channel in machine
        .channels
        .iter_mut()
        .filter(|channel| !channel.loops_enabled)
    {
        channel.wanted.stop = true;
    }
    for channel in machine
        .channels
        .iter_mut()
        .filter(|channel| !channel.axes_enabled)
    {
        // Without dynamics: the path stands where it is.
        channel.run.track.halt();
    }
}

/// What P8891 holds up of the path of a channel [002:4765-4770].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Locked {
    /// The block that is executed moves a locked axis.
    pub now: bool,
    /// The next one does: its place in the order of execution.
    pub next: Option<u64>,
}

/// P8891: moves of locked axes are due.
pub(crate) fn locked(machine: &Machine, k: usize) -> Locked {
    let Some(channel) = machine.channels.get(k) else {
        return Locked::default();
    };
    let lock = machine
        .memory
        .of_channel(channel.number, ChannelParameter::AxisLock);
    let bits = lock.bits().unwrap_or(0);
    let is_locked = |element: &&PathElement| {
        let own = machine.places.iter().zip(machine.core.axes.iter());
        let mut own = own.filter(|(place, _)| usize::from(place.channel) == k);
        own.any(|(place, unit)| {
            let way = element.end[unit.axis] - element.start[unit.axis];
            let direction = if way < 0.0 {
                Direction::Minus
            } else {
                Direction::Plus
            };
            let is_moved = element.moves_axis(unit.axis);
            let by_direction = || is_locked(&machine.memory, place.physical, direction);
            is_moved && (bits >> unit.index & 1 != 0 || by_direction())
        })
    };
    let next = channel.run.track.path.next_element().filter(is_locked);
    Locked {
        now: channel.run.element().filter(is_locked).is_some(),
        next: next.map(|element| element.sequence),
    }
}

/// P12137: a direction of an axis is locked [002:8248-8255].
pub(crate) fn is_locked(memory: &Memory, physical: u8, direction: Direction) -> bool {
    let bits = memory
        .of_axis(physical, AxisParameter::DirectionLock)
        .bits()
        .unwrap_or(0);
    let [plus, minus, ..] = bits.to_le_bytes();
    match direction {
        Direction::Plus => plus == 1,
        Direction::Minus => minus == 1,
    }
}

/// P12136: how fast an axis may be now, mm/min; infinite without a slope [002:8237-8246].
pub(crate) fn slope_mm_min(memory: &Memory, place: &AxisPlace) -> f64 {
    let bits = memory
        .of_axis(place.physical, AxisParameter::SlopeActs)
        .bits()
        .unwrap_or(0);
    let acting = bits.to_le_bytes().into_iter().zip(place.block.slopes_mm_min);
    acting
        .filter(|(byte, _)| *byte == 1)
        .fold(f64::INFINITY, |least, (_, slope)| least.min(slope))
}

/// How fast the slopes of the axes that a block moves let the path of a channel be, mm/min.
pub(crate) fn path_slope_mm_min(machine: &Machine, k: usize) -> f64 {
    let Some(element) = machine.channels.get(k).and_then(|channel| channel.run.element()) else {
        return f64::INFINITY;
    };
    let own = machine.places.iter().zip(machine.core.axes.iter());
    let moved = own.filter(|(place, unit)| usize::from(place.channel) == k && element.moves_axis(unit.axis));
    moved.fold(f64::INFINITY, |least, (place, _)| {
        least.min(slope_mm_min(&machine.memory, place))
    })
}

/// P12140, P12141: the nominal position is where the axis is [002:8272-8282].
fn follows(memory: &Memory, physical: u8) -> bool {
    let first = |parameter| {
        let bits = memory.of_axis(physical, parameter).bits().unwrap_or(0);
        bits & 0xFF
    };
    let [with, without, ..] = memory
        .of_axis(physical, AxisParameter::FollowsActual)
        .bits()
        .unwrap_or(0)
        .to_le_bytes();
    first(AxisParameter::Clamped) == 1 || with == 1 || without == 1
}

/// Closes the loop of an axis, or opens it.
fn hold(unit: &mut AxisUnit, closed: bool) {
    match (closed, unit.servo.closed()) {
        (true, false) => {
            unit.transfer();
            unit.servo.close();
        }
        (false, true) => {
            unit.servo.open();
            unit.transfer();
        }
        (false, false) => unit.transfer(),
        (true, true) => {}
    }
}
