//! What a write does: keys of the operator, modes, start and stop, answers of the PLC [002:3606-3816].
//!
//! Decision: A change to HAND breaks the program off, whose place is kept for a restart [002:4156-4193]
//!
//! Decision: A System 900 starts no program under a message that breaks it off: who starts acknowledges first
//!
//! Decision: Of P8706 counts the write of a value other than 0; while nothing waits it does nothing

use bahn_system900::{
    AxisParameter, ChannelParameter, Channels, Event, Meaning, Place, Together, Writer,
    acknowledges_with_mode,
};

use crate::answers::bit;
use crate::channel::{Channel, Mode};
use crate::machine::Machine;
use crate::message::Kind;
use crate::{branch, hand, monitor, positions};

/// Values of P8682 [002:3613-3619].
const KEY_STOP: i64 = 1;
const KEY_START: i64 = 2;

/// A parameter was written by somebody else than the control.
pub(crate) fn notice(machine: &mut Machine, place: Place) {
    match machine.memory.meaning(place) {
        Meaning::OfChannel(number, parameter) => notice_channel(machine, number, parameter),
        Meaning::OfAxis(physical, parameter) => notice_axis(machine, physical, parameter),
        Meaning::Override(number) => machine.memory.show_override(number),
        Meaning::Locks => follow_locks(machine),
        Meaning::Nothing => {}
    }
}

/// Locks follow their switches, and the modes of the channels.
pub(crate) fn follow_locks(machine: &mut Machine) {
    let automatic = |channel: &&Channel| channel.mode != Mode::Hand;
    let channels = machine.channels.iter().filter(automatic);
    let automatic = channels.fold(0u8, |all, channel| all | bit(channel.number));
    machine.memory.update_locks(Channels::from_bits(automatic));
}

fn notice_axis(machine: &mut Machine, physical: u8, parameter: AxisParameter) {
    match parameter {
        AxisParameter::GoRelative | AxisParameter::GoAbsolute => hand::position(machine, physical, parameter),
        AxisParameter::Reference => hand::begin_seek(machine, physical),
        AxisParameter::GoEmergency => positions::go_emergency(machine, physical),
        AxisParameter::GoFixed => positions::go_fixed(machine, physical),
        _ => {}
    }
}

fn notice_channel(machine: &mut Machine, number: u8, parameter: ChannelParameter) {
    let value = machine.memory.of_channel(number, parameter).whole();
    let is_set = value.is_some_and(|value| value != 0);
    match parameter {
        ChannelParameter::StartKey => press(machine, number, value.unwrap_or(0)),
        ChannelParameter::ModeRequest => ask_mode(machine, number, value.unwrap_or(0)),
        ChannelParameter::StartRequest => machine.answers.ask_start(number),
        ChannelParameter::Mode => take_mode(machine, number, value.unwrap_or(0)),
        ChannelParameter::Start => take_start(machine, number, value == Some(1)),
        ChannelParameter::Abort if value == Some(1) => {
            together(machine, number, Together::Abort, |machine, k| {
                if let Some(channel) = machine.channels.get_mut(k) {
                    channel.wanted.abort = true;
                }
            })
        }
        ChannelParameter::BlockRelease if is_set => release(machine, number),
        ChannelParameter::BlockFeed => take_block_feed(machine, number),
        ChannelParameter::MeasuringKey if value == Some(1) => branch::measure(machine, number),
        ChannelParameter::MeasuringRelease if is_set => branch::release_measuring(machine, number),
        ChannelParameter::EndWay if value == Some(1) => branch::end_the_way(machine, number),
        ChannelParameter::Acknowledge if is_set => acknowledge(machine, number),
        ChannelParameter::SystemMessage
        | ChannelParameter::HighMessage
        | ChannelParameter::LowMessage
        | ChannelParameter::DisplayMessage => monitor::order_message(machine, number, parameter),
        ChannelParameter::TakeTool | ChannelParameter::OffsetCommand | ChannelParameter::StoreTool => {
            let k = usize::from(number) - 1;
            let in_hand = machine
                .channels
                .get(k)
                .is_some_and(|channel| channel.mode == Mode::Hand);
            machine.memory.command_tool(number, parameter, in_hand);
        }
        ChannelParameter::ManualM => manual_m(machine, number),
        ChannelParameter::Emergency if value == Some(1) => call(machine, number, 0),
        ChannelParameter::Emergency2 if value == Some(1) => call(machine, number, 1),
        ChannelParameter::Emergency3 if value == Some(1) => call(machine, number, 2),
        ChannelParameter::Emergency4 if value == Some(1) => call(machine, number, 3),
        ChannelParameter::AutomaticLocks => follow_locks(machine),
        ChannelParameter::ManualMove => hand::begin_by_hand(machine, number),
        ChannelParameter::NextStep if value == Some(1) => hand::next_step(machine, number),
        _ => {}
    }
}

/// Does something for a channel and all that its networks do it with.
fn together(machine: &mut Machine, number: u8, what: Together, mut act: impl FnMut(&mut Machine, usize)) {
    let channels = bahn_system900::together(&machine.memory, number, what).bits();
    for k in (0..machine.channels.len()).filter(|k| channels >> k & 1 != 0) {
        act(machine, k);
    }
}

/// P8682: the keys of the operator write P8684; STOP stops the whole network.
fn press(machine: &mut Machine, number: u8, key: i64) {
    match key {
        KEY_START => request_start(machine, number, 1),
        KEY_STOP => together(machine, number, Together::Stop, |machine, k| {
            request_start(machine, k as u8 + 1, 0)
        }),
        _ => {}
    }
}

fn request_start(machine: &mut Machine, number: u8, start: i64) {
    machine.send(number, ChannelParameter::StartRequest, start, Writer::Control);
    machine.answers.ask_start(number);
}

/// P8683: the mode is asked for in the whole network.
fn ask_mode(machine: &mut Machine, number: u8, mode: i64) {
    together(machine, number, Together::Mode, |machine, k| {
        let number = k as u8 + 1;
        let asked = machine.memory.of_channel(number, ChannelParameter::ModeRequest);
        if asked.whole() != Some(mode) {
            machine.send(number, ChannelParameter::ModeRequest, mode, Writer::Control);
        }
        machine.answers.ask_mode(number);
        if Mode::of(mode) == Some(Mode::Hand) && acknowledges_with_mode(&machine.memory, number) {
            acknowledge(machine, number);
        }
    });
}

/// P8703: the channel goes over to a mode.
fn take_mode(machine: &mut Machine, number: u8, mode: i64) {
    let Some(mode) = Mode::of(mode) else { return };
    let k = usize::from(number) - 1;
    let Some(channel) = machine.channels.get_mut(k) else {
        return;
    };
    let before = std::mem::replace(&mut channel.mode, mode);
    match (before, mode) {
        (Mode::Hand, Mode::Hand) => {}
        // Definitions of M functions take effect with the change from HAND to AUTO [002:2088-2089].
        (Mode::Hand, _) => channel.m.read(&machine.memory, number),
        (_, Mode::Hand) => {
            channel.wanted.abort = true;
            // The mirrors of axes end with it [002:4762-4782].
            machine
                .memory
                .set_channel(number, ChannelParameter::AxisMirror, 0);
        }
        _ => {}
    }
    machine
        .memory
        .set_channel(number, ChannelParameter::Mode, mode.number());
    follow_locks(machine);
}

/// P8704: start, where nothing is in its way, or stop.
fn take_start(machine: &mut Machine, number: u8, start: bool) {
    let k = usize::from(number) - 1;
    let may = may_start(machine, number);
    let Some(channel) = machine.channels.get_mut(k) else {
        return;
    };
    match start {
        true if may => {
            channel.wanted.start = true;
            if !channel.run.progress().is_on_its_way() {
                channel.runs = None;
            }
        }
        true => machine.memory.set_channel(number, ChannelParameter::Start, 0),
        false => channel.wanted.stop = true,
    }
}

/// The mode is AUTO, the loops are closed, the axes are enabled and referenced, there is a program, and no message holds it back.
pub(crate) fn may_start(machine: &Machine, number: u8) -> bool {
    let Some(channel) = machine.channels.get(usize::from(number) - 1) else {
        return false;
    };
    let is_set = |parameter| machine.memory.of_channel(number, parameter).whole() == Some(1);
    channel.mode != Mode::Hand
        && channel.program.is_some()
        && !machine.messages.break_off(number)
        && is_set(ChannelParameter::LoopsEnabled)
        && is_set(ChannelParameter::AxesEnabled)
        && is_set(ChannelParameter::Referenced)
}

/// P8706: M functions with stop are done; else a branch that waits is confirmed.
fn release(machine: &mut Machine, number: u8) {
    let given = machine.memory.of_channel(number, ChannelParameter::BlockRelease);
    machine.record(Event::Release(number, given));
    let Some(channel) = machine.channels.get_mut(usize::from(number) - 1) else {
        return;
    };
    if std::mem::take(&mut channel.waits_for_m) {
        machine.transfers.acknowledge(number, machine.now_us);
        machine.memory.set_channel(number, ChannelParameter::WaitsForM, 0);
    } else if let Some(branch) = channel.branch.take() {
        channel.jump = Some(branch);
        machine.transfers.branch(number, machine.now_us);
    }
}

/// P8710 to P8713: an emergency program interrupts what runs; the mode is AUTO, sequence, from then on [002:3856-3882].
///
/// Decision: An emergency program of a System 900 that is not there breaks off what runs: who calls it wants something else to happen
fn call(machine: &mut Machine, number: u8, which: usize) {
    let k = usize::from(number) - 1;
    let is_there = |channel: &Channel| channel.emergency.get(which).is_some_and(Option::is_some);
    if !machine.channels.get(k).is_some_and(is_there) {
        let text = format!("emergency program {} is not there", which + 1);
        machine.say(0, number, None, Kind::High, text.into());
        return;
    }
    machine
        .memory
        .set_channel(number, ChannelParameter::ModeRequest, Mode::Sequence.number());
    take_mode(machine, number, Mode::Sequence.number());
    if let Some(channel) = machine.channels.get_mut(k) {
        channel.called = Some(which);
    }
}

/// P8817: the feed of the block that is executed, until its end [002:4294-4296].
fn take_block_feed(machine: &mut Machine, number: u8) {
    let feed = machine
        .memory
        .of_channel(number, ChannelParameter::BlockFeed)
        .number();
    if let Some(channel) = machine.channels.get_mut(usize::from(number) - 1) {
        let executed = channel.run.element().map(|element| element.sequence);
        channel.block_feed = executed.zip(feed.filter(|feed| *feed > 0.0));
    }
}

/// P8690: an M function goes to the PLC in HAND [002:3714-3715].
fn manual_m(machine: &mut Machine, number: u8) {
    let m = machine
        .memory
        .of_channel(number, ChannelParameter::ManualM)
        .whole();
    let in_hand = machine
        .channels
        .get(usize::from(number) - 1)
        .is_some_and(|channel| channel.mode == Mode::Hand);
    let m = m.and_then(|m| u16::try_from(m).ok()).filter(|_| in_hand);
    let Some((_, _, mut site)) = machine.parts(usize::from(number) - 1) else {
        return;
    };
    if let Some(m) = m {
        site.transfer(m, None);
    }
}

/// P8508, or the change to HAND: what is shown is acknowledged.
fn acknowledge(machine: &mut Machine, number: u8) {
    machine.messages.acknowledge(number, machine.now_us);
    machine.core.emergency.clear();
}
