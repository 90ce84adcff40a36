//! Loops and feed enable: whether an axis may move at all.
//!
//! Decision: Withdrawn feed enable is 0 V until it is back; the lag that was left is driven out on a path, by hand
//! the axis stands where it stopped; an axis that stands is held in its loop
//!
//! Decision: On TNC 151/155 an axis whose loop the PLC had open goes back to its nominal value on the ramp of rapid traverse,
//! unless the PLC has the actual value taken over (M2552 ff.), which it may in every operating mode
//!
//! Decision: TNC 151/155: without feed release a movement comes down on the ramp of MP54 and goes on by itself when the
//! release is back, a thread and a probing too; what is turned at the handwheel meanwhile moves nothing
//!
//! Decision: An axis of a running program whose loop was open, and which was moved farther than MP1110 meanwhile, is
//! monitored as at standstill when its loop closes (GROSS POSITIONING ERROR D); by hand and interrupted its actual
//! value is transferred

use bahn_exchange::{Image, signal};
use bahn_kernel::{AxisId, OwnAxes, loops};
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
    /// An axis whose loop the PLC has open keeps its nominal value.
    pub keeps: bool,
}

/// Opens and closes the loop of each axis as the PLC asks for, and gives the feed enable
/// [000:5352-5369] [000:5403-5421].
pub(crate) fn follow(axes: &mut OwnAxes, nc: &Image, permission: Permission) {
    let all_open = nc.bit(signal::NC_STOP_AND_OPEN_LOOPS);
    let by_axis = nc.number(signal::FEED_ENABLE_AXES);
    for unit in axes.iter_mut().filter(|unit| unit.parameters.controlled) {
        let open = OPEN_LOOP.get(unit.index).is_some_and(|marker| nc.bit(*marker));
        let closed = permission.loops_closed && !open && !all_open;
        loops::hold(
            unit,
            closed,
            permission.runs,
            permission.keeps && permission.loops_closed && !all_open,
        );
        loops::enable(unit, permission.feed_enable || by_axis >> unit.index & 1 != 0);
        let suppressed = MONITORING_OFF
            .get(unit.index)
            .is_some_and(|marker| nc.bit(*marker));
        unit.servo
            .set_monitored(!(suppressed || permission.monitoring_off));
    }
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
    let of_spindle = std::iter::once((AxisId::SPINDLE, spindle.drive.fault()));
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
