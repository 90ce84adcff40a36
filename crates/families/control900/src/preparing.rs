//! What a channel reads ahead, outside the cycle.

use bahn_kernel::{Feeder, RunFamily};
use bahn_path::Position;

use crate::machine::Machine;
use crate::restart;

/// Reads ahead for a channel, outside the cycle; begins a run that is to begin.
pub(crate) fn prepare(machine: &mut Machine, k: usize) {
    let [_, start_block] = machine.start_of(k);
    let now_us = machine.now_us;
    let Some((run, _, mut site)) = machine.parts(k) else {
        return;
    };
    run.track.reserve();
    if run.takes_begin(|| site.axes.rest()) {
        run.begin();
        run.set_off(&site.acting());
        begin(machine, k, start_block);
        // Who looks at P8686 sees that a restart begins.
        if machine
            .channels
            .get(k)
            .is_some_and(|channel| channel.restart.is_some())
        {
            return;
        }
    }
    if restart::simulate(machine, k) {
        return;
    }
    machine.give_memory(k);
    if let Some((run, Some(feeder), mut site)) = machine.parts(k)
        && run.progress().is_on_its_way()
    {
        let allowed = run.allowed(now_us);
        run.prepare(feeder, allowed, Position::ZERO, &site.acting(), |_, _| {});
    }
    machine.take_memory(k);
}

/// The program of a channel is read from a block on, 0 for its first.
fn begin(machine: &mut Machine, k: usize, block: i64) {
    let within = {
        let axes = machine.core.axes.of(k);
        (axes.traverse_box(), axes.programmable())
    };
    let Some((_, _, mut site)) = machine.parts(k) else {
        return;
    };
    let here = site.acting().here();
    let Some(channel) = machine.channels.get_mut(k) else {
        return;
    };
    (channel.branch, channel.residual, channel.jump) = (None, None, None);
    channel.waits_for_m = false;
    (channel.faulty, channel.shown_sequence, channel.place) = (None, None, None);
    let Some(program) = channel.starting() else {
        return;
    };
    machine.memory.forget_shifts(channel.number);
    let mut feeder = Feeder::new(program.boxed(), channel.chain.clone(), within);
    feeder.set_tap(machine.keeps_path);
    channel.feeder = Some(feeder);
    let from = restart::begin(machine, k, here);
    machine.give_memory(k);
    let language = machine.language;
    if let Some((_, Some(feeder), _)) = machine.parts(k) {
        feeder.reader_mut().relocate(&from);
        if let Some(language) = language {
            (language.start)(feeder.reader_mut(), u32::try_from(block).unwrap_or(0));
        }
    }
    machine.take_memory(k);
}
