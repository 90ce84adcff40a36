//! M functions with branch: what is left of the way is given up when the PLC confirms, and the program goes on elsewhere
//! [002:5484-5491].

use bahn_system900::{AxisParameter, ChannelParameter, Memory};

use crate::channel::Branch;
use crate::machine::Machine;

/// A branch that was not confirmed is over with its block.
pub(crate) fn follow_branches(machine: &mut Machine) {
    for channel in &mut machine.channels {
        let executed = channel.run.element().map(|element| element.sequence);
        let is_over = |sequence: u64| executed.is_none_or(|executed| executed > sequence);
        channel.branch = channel.branch.filter(|branch| !is_over(branch.sequence));
        channel.residual = channel.residual.filter(|sequence| !is_over(*sequence));
    }
}

/// A block with M26 has come to its end before its way was given up.
pub(crate) fn come_to_its_end(machine: &mut Machine, k: usize) {
    if let Some(channel) = machine.channels.get_mut(k) {
        channel.residual = None;
        channel.jump = channel.jump.filter(|jump| jump.target.is_some());
    }
}

/// P8715: the way of a block with M26 is given up where the path can stop; P8695 gets its number [002:3717-3722].
pub(crate) fn end_the_way(machine: &mut Machine, number: u8) {
    let k = usize::from(number) - 1;
    let Some(channel) = machine.channels.get_mut(k) else {
        return;
    };
    let Some(sequence) = channel.residual.take() else {
        return;
    };
    channel.jump = Some(Branch {
        sequence,
        target: None,
    });
    let block = channel.block();
    let block = i64::from(machine.block_number(k, block));
    machine
        .memory
        .set_channel(number, ChannelParameter::ResidualBlock, block);
}

/// A confirmed branch whose axes stand: the program goes on at its target, or after its block, outside the cycle.
pub(crate) fn jump(machine: &mut Machine, k: usize) {
    let Some(channel) = machine.channels.get_mut(k) else {
        return;
    };
    let stands = channel.run.track.stands(&machine.core.axes.of(k));
    let Some(branch) = channel.jump.take_if(|_| stands) else {
        return;
    };
    channel.run.track.path.clear();
    let axes = machine.core.axes.of(k);
    let (here, limits) = (axes.programmed_position(), axes.traverse_box());
    let chain = channel.chain.clone();
    let path = chain.to_path(&here);
    let language = machine.language;
    channel.run.track.path.set_position(path);
    channel.run.track.forget_position();
    machine.give_memory(k);
    if let Some((_, Some(feeder), _)) = machine.parts(k) {
        match (branch.target, language) {
            (None, _) => feeder.cut(&here, &chain, limits),
            (Some(target), language) => {
                feeder.return_to(branch.sequence, &here, &chain, limits);
                match language {
                    Some(language) => (language.branch)(feeder.reader_mut(), branch.sequence, target, &path),
                    None => feeder.reader_mut().goto(target),
                }
            }
        }
    }
    machine.take_memory(k);
    if branch.target.is_some() {
        store_measured(machine, k);
    }
}

/// P8717: a further position may be measured; that none was taken yet is said to the PLC [002:3724-3729].
pub(crate) fn release_measuring(machine: &mut Machine, number: u8) {
    machine
        .memory
        .set_channel(number, ChannelParameter::MeasuredBlock, 0);
    show_measured(machine, usize::from(number) - 1, 0);
}

/// P8716: the measuring key takes the positions where they are released, and ends the way of a block with M26 [002:3892-3901].
pub(crate) fn measure(machine: &mut Machine, number: u8) {
    let k = usize::from(number) - 1;
    end_the_way(machine, number);
    let release = machine
        .memory
        .of_channel(number, ChannelParameter::MeasuringRelease)
        .whole();
    if !matches!(release, Some(1 | 2)) {
        return;
    }
    store_measured(machine, k);
    show_measured(machine, k, 1);
    let block = machine.channels.get(k).map(|channel| channel.block());
    let block = block.map_or(0, |block| i64::from(machine.block_number(k, block)));
    machine
        .memory
        .set_channel(number, ChannelParameter::MeasuredBlock, block);
    if release == Some(1) {
        machine
            .memory
            .set_channel(number, ChannelParameter::MeasuringRelease, 0);
    }
}

/// P12181 of the axes of a channel.
fn show_measured(machine: &mut Machine, k: usize, bits: i32) {
    for place in machine
        .places
        .iter()
        .filter(|place| usize::from(place.channel) == k && place.logical > 0)
    {
        if let Some(of) = Memory::axis_place(place.physical, AxisParameter::Measured) {
            machine.memory.store_bits(of, bits);
        }
    }
}

/// P12153: where the axes are, as they are displayed, or in the machine where P8855 says so.
fn store_measured(machine: &mut Machine, k: usize) {
    let decimals = machine.memory.position_decimals(k as u8 + 1);
    let reference = machine
        .memory
        .of_channel(k as u8 + 1, ChannelParameter::MeasuringReference);
    let in_machine = reference.whole() == Some(1);
    for place in machine
        .places
        .iter()
        .filter(|place| usize::from(place.channel) == k && place.logical > 0)
    {
        let own = |parameter| Memory::own_place(place.channel + 1, place.logical, parameter);
        let measured = match in_machine {
            true => machine
                .memory
                .of_axis(place.physical, AxisParameter::MachinePosition)
                .number(),
            false => machine.memory.at(own(AxisParameter::DisplayPosition)).number(),
        };
        machine
            .memory
            .store(own(AxisParameter::MeasuredPosition), measured, decimals);
    }
}
