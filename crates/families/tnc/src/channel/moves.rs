//! What moves the axes of a channel in a contour cycle: what its operating mode says, then the PLC.

use bahn_kernel::{Now, Operation, reference};
use bahn_servo::{HandwheelInputs, Measured};

use super::Channel;
use crate::command::Mode;
use crate::desk::reference_cams;
use crate::machine::MachineSide;

/// Finds the nominal positions of its axes for the end of the contour cycle. NC start is kept as long as the
/// operating mode waits for axes to come to a standstill.
pub fn move_axes(channel: &mut Channel, machine: &mut MachineSide, measured: &Measured) {
    let now = channel.now(machine);
    let mut axes = machine.core.axes.of(channel.number);
    let cams = reference_cams(machine.memory.of(channel.number).nc());
    reference::count_display_axes(&mut axes, &cams);
    let superimposes = channel.datums.chain.superimposed.is_on();
    let exchange = machine.memory.of_mut(channel.number);
    channel
        .desk
        .count_handwheel(superimposes, &measured.operator.handwheel, &axes, exchange);
    channel.desk.follow_stop(&now, channel.touch.is_chosen());
    let automatic = channel.desk.mode().is_automatic();
    let operation = match channel.run.core.taps_rigidly() {
        true => Operation::RigidTapping,
        false if automatic && !channel.desk.runs_reference() => Operation::Automatic,
        false => Operation::Manual,
    };
    let ready = axes.choose_methods(operation);
    // What the mode before moved comes to a standstill first.
    let waits = automatic && !ready && !channel.run.is_active();
    if !waits {
        move_by_mode(channel, &now, machine, measured);
    }
    move_for_plc(channel, &now, machine);
    machine.core.axes.of(channel.number).slow_down(now.time_s);
    if !waits {
        channel.desk.forget_start();
    }
}

fn move_by_mode(channel: &mut Channel, now: &Now, machine: &mut MachineSide, measured: &Measured) {
    let handwheel = &measured.operator.handwheel;
    match channel.desk.mode() {
        Mode::Manual | Mode::Handwheel => {
            if channel.touch.is_chosen() {
                if probe_by_hand(channel, machine, measured) {
                    return;
                }
            } else {
                output_entered(channel, now, machine);
            }
            move_manually(channel, handwheel, now, machine);
        }
        Mode::Reference => {
            let mut axes = machine.core.axes.of(channel.number);
            let nc = machine.memory.of(channel.number).nc();
            channel.desk.move_reference(&mut axes, nc, now);
        }
        Mode::Mdi | Mode::SingleBlock | Mode::FullSequence => {
            let nc = machine.memory.of(channel.number).nc();
            let by_hand = channel.run.is_operated_manually(nc) || channel.desk.manual.is_led();
            if by_hand && !channel.run.core.track.path.is_coupled() {
                move_manually(channel, handwheel, now, machine);
            } else {
                if now.stop {
                    channel.stop();
                } else if now.start {
                    let (run, mut site, _) = channel.parts(machine);
                    run.start(&mut site);
                }
                let (run, mut site, _) = channel.parts(machine);
                run.moves(&mut site, measured);
            }
            if channel.run.core.restores() {
                let (run, mut site, _) = channel.parts(machine);
                run.move_back(&mut site);
            }
        }
    }
}

fn output_entered(channel: &mut Channel, now: &Now, machine: &mut MachineSide) {
    let (mut manual, model) = (channel.desk.manual, machine.model);
    let (_, mut site, _) = channel.parts(machine);
    manual.output_entered(model, now, &mut site);
    channel.desk.manual = manual;
}

/// A function of the TOUCH PROBE menu is chosen: whether it moves the axes.
fn probe_by_hand(channel: &mut Channel, machine: &mut MachineSide, measured: &Measured) -> bool {
    let mut touch = channel.touch;
    let (run, mut site, basis) = channel.parts(machine);
    let settings = basis.list.probe();
    let (moves, kept) = touch.moves(&mut run.probe, &settings, measured, &mut site);
    channel.touch = touch;
    machine.unsaved |= kept;
    moves
}

fn move_manually(channel: &mut Channel, handwheel: &HandwheelInputs, now: &Now, machine: &mut MachineSide) {
    let mut axes = machine.core.axes.of(channel.number);
    let nc = machine.memory.of(channel.number).nc();
    let block = channel.run.running_block();
    let messages = machine.messages.of_channel(channel.number);
    channel
        .desk
        .move_by_hand(handwheel, &mut axes, nc, messages, block, now);
}

/// Moves what the PLC commands.
fn move_for_plc(channel: &mut Channel, now: &Now, machine: &mut MachineSide) {
    let run = [channel.run.is_active(), channel.run.core.restores()];
    let exchange = machine.memory.of_mut(channel.number);
    let mut axes = machine.core.axes.of(channel.number);
    channel.positioning.moves(&mut axes, exchange, now, run);
    if channel.number == 0 {
        // Modules know the axes of the first channel.
        let statuses = &mut machine.link.plc_axes;
        channel.positioning.move_plc_axes(&mut axes, statuses, now);
    }
    channel.positioning.move_rotation(&mut axes, exchange.nc(), now);
}
