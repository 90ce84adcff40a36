//! Loops and feed enable: whether an axis may move at all.

use bahn_exchange::{Image, signal};
use bahn_kernel::{AxisId, AxisUnit, Mover, OwnAxes};
use bahn_parameters::fault::FaultId;

use crate::markers::{MONITORING_OFF, OPEN_LOOP};
use crate::message::{Message, Messages};
use crate::spindle::SpindleUnit;
use bahn_path::BlockRef;

/// What lets the axes of a channel move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Permission {
    /// The loops were closed since the control voltage came on.
    pub loops_closed: bool,
    /// Feed enable for all axes.
    pub feed_enable: bool,
    /// The monitoring is switched off.
    pub monitoring_off: bool,
    /// A program runs, and is not stopped.
    pub runs: bool,
}

/// Opens and closes the loop of each axis as the PLC asks for, and gives the feed enable
/// [000:5352-5369] [000:5403-5421].
pub(crate) fn follow(axes: &mut OwnAxes, nc: &Image, permission: Permission) {
    let all_open = nc.bit(signal::NC_STOP_AND_OPEN_LOOPS);
    let by_axis = nc.number(signal::FEED_ENABLE_AXES);
    for unit in axes.iter_mut().filter(|unit| unit.parameters.controlled) {
        let open = OPEN_LOOP.get(unit.index).is_some_and(|marker| nc.bit(*marker));
        let closed = permission.loops_closed && !open && !all_open;
        hold(unit, closed, permission.runs);
        enable(unit, permission.feed_enable || by_axis >> unit.index & 1 != 0);
        let suppressed = MONITORING_OFF
            .get(unit.index)
            .is_some_and(|marker| nc.bit(*marker));
        unit.servo
            .set_monitored(!(suppressed || permission.monitoring_off));
    }
}

/// Closes the loop of an axis when that is wanted and nothing is wrong with it, or opens it.
fn hold(unit: &mut AxisUnit, wanted: bool, runs: bool) {
    let sound = unit.servo.fault().is_none_or(|fault| !fault.opens_loop());
    if wanted && sound && !unit.servo.closed() {
        // A clamped axis goes back to its nominal position. One that was moved meanwhile has lost its place in a program
        // that runs, which the standstill monitoring says: values are transferred by hand only [000:5423-5434]. Else the
        // path goes on from there: nothing goes back.
        let moved = (unit.servo.actual_mm() - unit.nominal).abs() > unit.parameters.monitoring.standstill_mm;
        let lost = moved && runs && unit.mover == Mover::Path;
        if moved && !lost {
            let left_at = unit.left_at;
            unit.transfer();
            unit.left_at = left_at;
        }
        match lost {
            true => unit.servo.close_again(),
            false => unit.servo.close(),
        }
    } else if !wanted && unit.servo.closed() {
        unit.servo.open();
        unit.way_back.end();
        unit.stand(unit.nominal);
    }
}

/// Gives the feed enable to an axis, or withdraws it.
fn enable(unit: &mut AxisUnit, enabled: bool) {
    if unit.enabled && !enabled && !(unit.stands() && unit.servo.in_position()) {
        // The voltage is 0 at once, without a ramp [000:5352]. An axis that stands is held in its
        // loop (inferred).
        unit.halted = true;
        unit.stand(unit.nominal);
    } else if unit.halted && enabled {
        // An axis of a path goes back to it; by hand it stands where it stopped.
        unit.halted = false;
        if unit.mover != Mover::Path {
            unit.transfer();
        } else if unit.servo.closed() {
            unit.go_back();
        }
    }
    unit.enabled = enabled;
    unit.servo.set_enabled(!unit.halted);
}

/// Faults of the loops and of the spindle's encoder: message and machine stop [000:5162]. Whether one is new that
/// stops the channel.
pub(crate) fn show_faults(
    axes: &OwnAxes,
    spindle: &SpindleUnit,
    messages: &mut Messages,
    block: Option<BlockRef>,
) -> bool {
    let of_axes = axes.iter().map(|unit| (unit.id, unit.servo.fault()));
    let of_spindle = std::iter::once((AxisId::SPINDLE, spindle.fault()));
    let mut found = false;
    for (id, fault) in of_axes.chain(of_spindle) {
        let Some(fault) = fault else { continue };
        let row = FaultId::from(fault).row();
        let Some(text) = row.message else { continue };
        let message = Message::axis(text, id, Some(row.letter).filter(|letter| !letter.is_empty()));
        if !messages.contains(&message) {
            found |= row.reaction.stops();
            messages.show(message, block);
        }
    }
    found
}
