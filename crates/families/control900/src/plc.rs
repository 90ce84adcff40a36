//! A cycle of the PLC where the standard answers stand in its place.

use bahn_system900::{ChannelParameter, Memory, Writer};

use crate::answers::{Answers, bit};
use crate::command;
use crate::machine::Machine;

/// A cycle of the PLC: what was caused since the last one is answered.
pub(crate) fn answer(machine: &mut Machine) {
    let Answers { which, modes, starts } = machine.answers;
    (machine.answers.modes, machine.answers.starts) = (0, 0);
    for k in 0..machine.channels.len() {
        let number = k as u8 + 1;
        if which.enable {
            enable(machine, number, k);
        }
        if which.mode && modes & bit(number) != 0 {
            copy(
                machine,
                number,
                ChannelParameter::ModeRequest,
                ChannelParameter::Mode,
            );
        }
        if which.start && starts & bit(number) != 0 {
            answer_start(machine, number);
        }
        let changes = machine
            .channels
            .get_mut(k)
            .map(|channel| std::mem::take(&mut channel.changes_tool));
        if which.tools && changes == Some(true) {
            plc(machine, number, ChannelParameter::StoreTool, 1);
            plc(machine, number, ChannelParameter::TakeTool, 2);
        }
        let waits = machine.channels.get(k).is_some_and(|channel| channel.waits_for_m);
        if which.m && waits {
            plc(machine, number, ChannelParameter::BlockRelease, 1);
        }
    }
}

/// P8700, P8701, P8709.
fn enable(machine: &mut Machine, number: u8, k: usize) {
    let referenced = i64::from(machine.is_referenced(k));
    for (parameter, value) in [
        (ChannelParameter::LoopsEnabled, 1),
        (ChannelParameter::AxesEnabled, 1),
        (ChannelParameter::Referenced, referenced),
    ] {
        if machine.memory.of_channel(number, parameter).whole() != Some(value) {
            plc(machine, number, parameter, value);
        }
    }
}

/// A start is given where nothing is in its way; a stop always.
fn answer_start(machine: &mut Machine, number: u8) {
    let wanted = machine
        .memory
        .of_channel(number, ChannelParameter::StartRequest)
        .whole();
    match wanted {
        Some(1) if !command::may_start(machine, number) => {
            machine.memory.set_channel(number, ChannelParameter::Start, 0)
        }
        _ => copy(
            machine,
            number,
            ChannelParameter::StartRequest,
            ChannelParameter::Start,
        ),
    }
}

fn copy(machine: &mut Machine, number: u8, from: ChannelParameter, to: ChannelParameter) {
    let value = machine.memory.of_channel(number, from).whole().unwrap_or(0);
    plc(machine, number, to, value);
}

/// The PLC writes a parameter of a channel.
fn plc(machine: &mut Machine, number: u8, parameter: ChannelParameter, value: i64) {
    machine.send(number, parameter, value, Writer::Plc);
    if let Some(place) = Memory::channel_place(&machine.memory, number, parameter) {
        command::notice(machine, place);
    }
}
