//! Where a restart at the contour is to begin: what is kept when a program is broken off [002:4159-4171].

use bahn_system900::{ChannelParameter, Memory};

use crate::channel::Channel;

/// P8686: no restart 0, simulation 1, the axes go to the contour 2.
pub(crate) fn show(memory: &mut Memory, number: u8, info: i64) {
    memory.set_channel(number, ChannelParameter::RestartInfo, info);
}

/// A program is broken off: its place is kept, unless a restart has not come to it yet.
pub(crate) fn keep(channel: &mut Channel, memory: &mut Memory, program: i64, block: i64) {
    let number = channel.number;
    let place = channel.place.map_or(0, |(place, _)| place as i64);
    if channel.restart.take().is_some() {
        return show(memory, number, 0);
    }
    for (parameter, value) in [
        (ChannelParameter::AbortProgram, program),
        (ChannelParameter::AbortBlock, block),
        (ChannelParameter::AbortPlace, place),
    ] {
        memory.set_channel(number, parameter, value);
    }
}
