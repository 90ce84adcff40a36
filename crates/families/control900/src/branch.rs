//! M functions with branch: what is left of the way is given up when the PLC confirms, and the program goes on elsewhere
//! [002:5484-5491].

use bahn_system900::{AxisParameter, Memory};

use crate::machine::Machine;

/// A branch that was not confirmed is over with its block.
pub(crate) fn follow_branches(machine: &mut Machine) {
    for channel in &mut machine.channels {
        let executed = channel.run.element().map(|element| element.sequence);
        let is_over = |sequence: u64| executed.is_none_or(|executed| executed > sequence);
        channel.branch = channel.branch.filter(|branch| !is_over(branch.sequence));
    }
}

/// A confirmed branch whose axes stand: the program goes on at its target, outside the cycle.
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
        feeder.return_to(branch.sequence, &here, &chain, limits);
        match language {
            Some(language) => (language.branch)(feeder.reader_mut(), branch.sequence, branch.target, &path),
            None => feeder.reader_mut().goto(branch.target),
        }
    }
    machine.take_memory(k);
    store_measured(machine, k);
}

/// P12153: where the axes were when the way was given up, as they are displayed.
fn store_measured(machine: &mut Machine, k: usize) {
    let decimals = machine.memory.position_decimals(k as u8 + 1);
    for place in machine
        .places
        .iter()
        .filter(|place| usize::from(place.channel) == k && place.logical > 0)
    {
        let own = |parameter| Memory::own_place(place.channel + 1, place.logical, parameter);
        let display = machine.memory.at(own(AxisParameter::DisplayPosition)).number();
        machine
            .memory
            .store(own(AxisParameter::MeasuredPosition), display, decimals);
    }
}
