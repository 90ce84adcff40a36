//! What the PLC and the operating mode demand of a program run in a contour cycle.
//!
//! Decision: Transfers that the PLC does not take hold the path; none is dropped

use bahn_exchange::{Image, signal};
use bahn_kernel::{Demands, OwnAxes};
use bahn_path::AxisSet;

use crate::command::Mode;
use crate::markers::WAIT_OPEN_LOOP;
use crate::site::Site;

/// What is demanded; `stop_before`: the block before which another tool is taken, `worn`: the run stops after its block,
/// `by_hand`: the operator moves axes while it is interrupted.
pub(crate) fn of(site: &Site, stop_before: Option<u64>, worn: bool, by_hand: bool) -> Demands {
    let nc = site.exchange.nc();
    Demands {
        single_block: site.mode == Mode::SingleBlock || worn,
        read_in_inhibited: site.handshakes.inhibit_read_in(),
        // Functions at which the axes do not stop (MP7440 bit 2) may come faster than the PLC takes them.
        crowded: site.handshakes.is_crowded(),
        positions: site.positioning.is_on(),
        by_hand,
        drives_stopped: !site.now.ready || nc.bit(signal::NC_STOP_AND_OPEN_LOOPS) || site.messages.is_fatal(),
        spindle_open: nc.bit(signal::OPEN_SPINDLE_LOOP),
        stop_before,
        clamping: clamping_axes(&site.axes, nc),
    }
}

/// Axes that the PLC wants to clamp after their block (M2492 ff.), and whose loop is still closed.
fn clamping_axes(axes: &OwnAxes, nc: &Image) -> AxisSet {
    let wanted = axes.iter().filter(|unit| {
        let marker = WAIT_OPEN_LOOP.get(unit.index);
        unit.servo.closed() && marker.is_some_and(|marker| nc.bit(*marker))
    });
    wanted.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
}
