//! What the control says of itself: positions, states and the block that is executed, in each interpolation cycle.
//!
//! Decision: When a program does not run any more, at its end, at a stop, in single block, P8684 and P8704 become 0: the next start is
//! asked for and given anew

use bahn_kernel::{AxisUnit, RunState};
use bahn_path::{Curve, Direction, FeedRate};
use bahn_system900::{AxisParameter, ChannelParameter, Event, Memory, Place, Writer};

use crate::axis_state::AxisPlace;
use crate::machine::Machine;

/// Decimals of speeds and voltages.
const DECIMALS: u8 = 3;

/// What is known at power-on.
pub(crate) fn show_at_start(machine: &mut Machine) {
    for number in 1..=machine.memory.channels() {
        let (count, last) = machine
            .memory
            .axes_of(number)
            .fold((0, 0), |(count, last), (logical, _)| {
                (count + 1, i64::from(logical).max(last))
            });
        for (parameter, value) in [
            (ChannelParameter::ChannelNumber, i64::from(number)),
            (ChannelParameter::AxisCount, count),
            (ChannelParameter::LastAxis, last),
            (ChannelParameter::ProgramState, 0),
            (ChannelParameter::Mode, 1),
            (ChannelParameter::ModeRequest, 1),
        ] {
            machine.memory.set_channel(number, parameter, value);
        }
    }
}

/// Stores what a cycle has changed.
pub(crate) fn show(machine: &mut Machine) {
    let decimals = machine.memory.position_decimals(1);
    for (place, unit) in machine.places.iter().zip(machine.core.axes.iter()) {
        show_axis(&mut machine.memory, place, unit, decimals);
    }
    for k in 0..machine.channels.len() {
        show_channel(machine, k);
        show_block(machine, k);
    }
}

/// Shows what is in force in the block that a channel executes, when it is another one.
fn show_block(machine: &mut Machine, k: usize) {
    let language = machine.language;
    let Some(channel) = machine.channels.get_mut(k) else {
        return;
    };
    let executed = channel.run.element().map(|element| element.sequence);
    if executed.is_none() || executed == channel.shown_sequence {
        return;
    }
    channel.shown_sequence = executed;
    if let (Some(sequence), Some(language), Some(feeder)) = (executed, language, &channel.feeder) {
        (language.show)(feeder.reader(), sequence, &mut machine.memory);
    }
}

/// P8685, which the PLC is told of when it changes.
fn show_state(machine: &mut Machine, k: usize) -> i64 {
    let Some(channel) = machine.channels.get(k) else {
        return 0;
    };
    let (number, progress) = (channel.number, channel.run.progress());
    let state = match progress.state() {
        _ if !progress.is_on_its_way() => 0,
        RunState::Idle | RunState::Running => 2,
        RunState::Interrupted | RunState::Stopped | RunState::BlockEnd => 1,
    };
    let before = machine.memory.of_channel(number, ChannelParameter::ProgramState);
    if before.whole() != Some(state) {
        machine.send(number, ChannelParameter::ProgramState, state, Writer::Control);
    }
    // A program that does not run any more waits for another start.
    if state != 2 && before.whole() == Some(2) {
        for parameter in [ChannelParameter::StartRequest, ChannelParameter::Start] {
            machine.memory.set_channel(number, parameter, 0);
        }
    }
    state
}

fn show_channel(machine: &mut Machine, k: usize) {
    let referenced = machine.is_referenced(k);
    let [program, _] = machine.start_of(k);
    let executed = machine.channels.get(k).and_then(|channel| channel.run.element());
    let executed = executed.map(|element| element.block);
    let shown = machine.channels.get(k).and_then(|channel| channel.shown);
    let block = match (executed, shown) {
        (Some(executed), Some((shown, number))) if executed == shown => number,
        (Some(executed), _) => machine.block_number(k, executed),
        (None, _) => 0,
    };
    let state = show_state(machine, k);
    let begins = executed.filter(|executed| shown.is_none_or(|(shown, _)| shown != *executed));
    if let Some(channel) = machine.channels.get_mut(k) {
        channel.shown = executed.map(|executed| (executed, block));
    }
    if let Some(begins) = begins {
        let name = machine.program_name(k, begins);
        machine.record(Event::Block(k as u8 + 1, name, block));
    }
    let Some(channel) = machine.channels.get(k) else {
        return;
    };
    let (number, memory) = (channel.number, &mut machine.memory);
    memory.show_tool(number);
    memory.set_channel(number, ChannelParameter::AllReferenced, i64::from(referenced));
    let mut speed = channel.run.track.speed_mm_s() * 60.0;
    if state == 0 {
        speed = 0.0;
    }
    if let Some(place) = memory.channel_place(number, ChannelParameter::ActualFeed) {
        memory.store(place, Some(speed), DECIMALS);
    }
    let Some(element) = channel.run.element() else {
        return;
    };
    memory.set_channel(number, ChannelParameter::ActualProgram, program);
    memory.set_channel(number, ChannelParameter::ActualBlock, block.into());
    let interpolation = match (&element.curve, element.feed) {
        (Curve::Arc(arc), _) if arc.sweep_deg < 0.0 => 2,
        (Curve::Arc(_), _) => 3,
        (_, FeedRate::Rapid) => 0,
        _ => 1,
    };
    memory.set_channel(number, ChannelParameter::Interpolation, interpolation);
    if let (FeedRate::Programmed(feed), Some(place)) = (
        element.feed,
        memory.channel_place(number, ChannelParameter::ProgrammedFeed),
    ) {
        memory.store(place, Some(feed), DECIMALS);
    }
    // Where the block leads the axes.
    let decimals = memory.position_decimals(number);
    let own = machine.places.iter().zip(machine.core.axes.iter());
    for (place, unit) in own.filter(|(place, _)| usize::from(place.channel) == k) {
        let end = element.end[unit.axis];
        if !unit.is_plc_axis() && end.is_finite() {
            show_programmed(memory, place, end, decimals);
        }
    }
}

/// P12150 to P12187 of an axis, and P7000.. of its channel.
fn show_axis(memory: &mut Memory, place: &AxisPlace, unit: &AxisUnit, decimals: u8) {
    let physical = place.physical;
    let actual = unit.shown(unit.servo.actual_mm());
    let nominal = unit.shown(unit.nominal);
    let speed = unit.speed * 60.0;
    let actual_speed = unit.servo.actual_velocity_mm_min();
    for (parameter, value, decimals) in [
        (AxisParameter::MachinePosition, actual, decimals),
        (AxisParameter::NominalPosition, nominal, decimals),
        (AxisParameter::ActualPosition, actual, decimals),
        (AxisParameter::Lag, unit.servo.lag_mm(), decimals),
        (AxisParameter::NominalSpeed, speed, DECIMALS),
        (AxisParameter::ActualSpeed, actual_speed, DECIMALS),
        (AxisParameter::Voltage, unit.servo.volts(), DECIMALS),
        (AxisParameter::AxisSpeed, actual_speed, DECIMALS),
    ] {
        memory.set_axis(physical, parameter, value, decimals);
    }
    let [fine, _] = place.block.exact_stop_mm;
    let moving = !unit.stands() || unit.servo.lag_mm().abs() > fine;
    let instruction = [
        moving && unit.direction == Direction::Plus,
        moving && unit.direction == Direction::Minus,
        moving,
    ];
    let limit = [unit.limited(), None].into_iter().flatten().next();
    let at_limit = limit.map_or([false; 2], |[least, greatest]| {
        [unit.nominal >= greatest, unit.nominal <= least]
    });
    bits(
        memory,
        physical,
        AxisParameter::ReferenceState,
        &[unit.referenced],
    );
    bits(memory, physical, AxisParameter::AtLimit, &at_limit);
    bits(memory, physical, AxisParameter::Driven, &[moving]);
    bits(memory, physical, AxisParameter::Driving, &instruction);
    show_display(memory, place, nominal, decimals);
}

/// P12154 = P12151 - P12157, and the positions by logical axes.
fn show_display(memory: &mut Memory, place: &AxisPlace, nominal: f64, decimals: u8) {
    let (channel, logical) = (place.channel + 1, place.logical);
    if logical == 0 {
        return;
    }
    let own = |parameter| Memory::own_place(channel, logical, parameter);
    let shift = memory
        .at(own(AxisParameter::DisplayShift))
        .number()
        .unwrap_or(0.0);
    let display = nominal - shift;
    memory.store(own(AxisParameter::DisplayPosition), Some(display), decimals);
    let programmed = memory.at(own(AxisParameter::ProgrammedPosition)).number();
    let delta = programmed.map(|programmed| programmed - display);
    memory.store(own(AxisParameter::DeltaPosition), delta, decimals);
    let measured = memory.at(own(AxisParameter::MeasuredPosition)).number();
    let at = u32::from(logical) - 1;
    for (parameter, value) in [
        (ChannelParameter::MeasuredPositions, measured),
        (ChannelParameter::DisplayPositions, Some(display)),
        (ChannelParameter::ProgrammedPositions, programmed),
        (ChannelParameter::DeltaPositions, delta),
        (ChannelParameter::DisplayShifts, Some(shift)),
    ] {
        if let Some(place) = memory.channel_place_at(channel, parameter, at) {
            memory.store(place, value, decimals);
        }
    }
}

/// P12155: where the block leads an axis, in the coordinates of the display.
fn show_programmed(memory: &mut Memory, place: &AxisPlace, end: f64, decimals: u8) {
    let own = |parameter| Memory::own_place(place.channel + 1, place.logical, parameter);
    let shift = memory
        .at(own(AxisParameter::DisplayShift))
        .number()
        .unwrap_or(0.0);
    memory.store(
        own(AxisParameter::ProgrammedPosition),
        Some(end - shift),
        decimals,
    );
}

/// A byte for each statement.
fn bits(memory: &mut Memory, physical: u8, parameter: AxisParameter, set: &[bool]) {
    let mut bytes = [0; 4];
    for (byte, set) in bytes.iter_mut().zip(set) {
        *byte = u8::from(*set);
    }
    if let Some(place) = Memory::axis_place(physical, parameter) {
        memory.store_bits(place, i32::from_le_bytes(bytes));
    }
}

/// What a parameter holds, not rounded to its decimals where the control itself computes it.
pub(crate) fn exact(machine: &Machine, place: Place) -> Option<f64> {
    let own = |parameter: AxisParameter| {
        let mut axes = machine.places.iter().zip(machine.core.axes.iter());
        axes.find(|(of, _)| Memory::axis_place(of.physical, parameter) == Some(place))
            .map(|(_, unit)| unit)
    };
    let of = |parameter, value: fn(&AxisUnit) -> f64| own(parameter).map(value);
    of(AxisParameter::MachinePosition, |unit| {
        unit.shown(unit.servo.actual_mm())
    })
    .or_else(|| of(AxisParameter::NominalPosition, |unit| unit.shown(unit.nominal)))
    .or_else(|| {
        of(AxisParameter::ActualPosition, |unit| {
            unit.shown(unit.servo.actual_mm())
        })
    })
    .or_else(|| of(AxisParameter::Lag, |unit| unit.servo.lag_mm()))
    .or_else(|| of(AxisParameter::NominalSpeed, |unit| unit.speed * 60.0))
    .or_else(|| of(AxisParameter::Voltage, |unit| unit.servo.volts()))
    .or_else(|| machine.memory.at(place).number())
}
