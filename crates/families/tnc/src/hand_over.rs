//! An axis goes from one channel to another, on order of the PLC while programs run, or between them.
//!
//! The manuals know one channel; this is how a machine builder would have it *(inferred)*. The PLC sets a marker, at
//! best while both channels stand at the strobe of an M function; the control gives the axis over where nothing
//! that was read ahead can move it, says so by another marker as long as the order stands, and the PLC acknowledges
//! the M functions.
//!
//! Decision: An axis goes to another channel when the PLC orders it by a marker: between programs, or where both
//! stand at the strobe of an M function after which nothing is read, at a programmed stop or at the end; the control
//! answers by a marker as long as the order stands

use bahn_exchange::Bit;
use bahn_kernel::{AxisId, PerChannel, RunState};
use bahn_motion::Stop;
use bahn_path::{Axis, Barrier};

use crate::channel::Channel;
use crate::machine::MachineSide;
use crate::message::{HandOverError, Message};
use crate::status;

/// An axis that goes to another channel when the PLC orders it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HandOver {
    /// The axis that changes its channel.
    pub axis: AxisId,
    /// The channel that gets it, from 0.
    pub to: usize,
    /// Letter by which the channel that gets it programs it.
    pub letter: Axis,
    /// Its index of markers there.
    pub index: usize,
    /// The marker of the first channel's memory by which the PLC orders it.
    pub order: Bit,
    /// The marker by which the control says that the axis has gone; reset with the order.
    pub done: Bit,
}

/// What the PLC orders, and how far it is.
#[derive(Clone, Debug)]
pub(crate) struct Ordered {
    what: HandOver,
    /// A refusal was shown since the order stands.
    reported: bool,
}

impl Ordered {
    pub fn new(what: HandOver) -> Ordered {
        Ordered {
            what,
            reported: false,
        }
    }

    /// Follows the marker of the PLC, outside the cycle.
    pub fn follow(&mut self, channels: &mut PerChannel<Channel>, machine: &mut MachineSide) {
        let HandOver {
            axis, order, done, ..
        } = self.what;
        let memory = machine.memory.first_mut();
        let (ordered, is_done) = (memory.nc().bit(order), memory.nc().bit(done));
        if !ordered {
            self.reported = false;
            if is_done {
                memory.nc_set(done, false);
            }
            return;
        }
        if is_done {
            return;
        }
        match hand_over(&self.what, channels, machine) {
            Ok(()) => machine.memory.first_mut().nc_set(done, true),
            // What follows the M function is not known yet.
            Err(HandOverError::Running) if self.channels(machine).any(|number| reads(channels, number)) => {}
            Err(why) if !self.reported => {
                self.reported = true;
                let message = Message::HandOver {
                    axis: axis.number(),
                    why,
                };
                machine.messages.of_machine().show(message, None);
            }
            Err(_) => {}
        }
    }

    /// The channel that has the axis, and the one that gets it.
    fn channels(&self, machine: &MachineSide) -> impl Iterator<Item = usize> + use<> {
        let mut axes = machine.core.axes.iter();
        let from = axes
            .find(|unit| unit.id == self.what.axis)
            .map(|unit| unit.channel);
        from.into_iter().chain([self.what.to])
    }
}

/// Hands an axis over, outside the cycle.
///
/// # Errors
/// Why it cannot go; nothing has changed then.
pub(crate) fn hand_over(
    what: &HandOver,
    channels: &mut PerChannel<Channel>,
    machine: &mut MachineSide,
) -> Result<(), HandOverError> {
    let unit = machine.core.axes.iter().find(|unit| unit.id == what.axis);
    let unit = unit.ok_or(HandOverError::Unknown)?;
    let (from, before) = (unit.channel, unit.index);
    let to = channels.get(what.to).ok_or(HandOverError::Unknown)?;
    if !rests(to) || !rests(channels.of(from)) {
        return Err(HandOverError::Running);
    }
    if !machine.core.axes.may_leave(what.axis) {
        return Err(HandOverError::Moving);
    }
    if !machine
        .core
        .axes
        .give(what.axis, what.to, what.letter, what.index)
    {
        return Err(HandOverError::Taken);
    }
    status::leave(before, machine.memory.of_mut(from));
    for number in [from, what.to] {
        channels.of_mut(number).take_axes(machine);
    }
    Ok(())
}

/// No program is on its way, or it stands where nothing after it was read: at the strobe of a function, or at a
/// programmed stop.
pub(crate) fn rests(channel: &Channel) -> bool {
    let path = &channel.run.core.track.path;
    let closed = matches!(
        path.stop(),
        Some(Stop::Barrier(Barrier::Acknowledge { .. } | Barrier::Stop { .. }) | Stop::End)
    );
    let stopped = channel.run.progress().state() == RunState::Stopped;
    let at_strobe = channel.handshakes.strobe_is_set() && closed && stands_at_last(channel);
    !channel.run.is_active() || (stopped || at_strobe) && !channel.run.source.is_handed_over()
}

/// The path has nothing more to move before what is not read yet.
fn stands_at_last(channel: &Channel) -> bool {
    let path = &channel.run.core.track.path;
    path.next_element().is_none() && path.speed_mm_s() == 0.0 && path.rest_mm() == 0.0
}

/// What follows is still being read, at the strobe of a function or beside the control.
fn reads(channels: &PerChannel<Channel>, number: usize) -> bool {
    let channel = channels.of(number);
    let open = channel.run.core.track.path.stop().is_none();
    channel.run.source.is_handed_over()
        || channel.handshakes.strobe_is_set() && open && stands_at_last(channel)
}
