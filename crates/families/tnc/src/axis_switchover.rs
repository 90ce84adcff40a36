//! Axis IV of a TNC 151/155 in the place of the internal axis X, Y or Z, by markers of the PLC: what programs interpolate as one
//! of these moves the machine axis IV [001:2456-2467].
//!
//! Decision: M2590 and M2591 assign axis IV only where the PLC program names one of them: 0/0 in a program that knows nothing of
//! them would put axis IV for X on every machine
//!
//! Decision: Axis IV and the internal axis change places: the letter of axis IV moves the other one meanwhile. Keys, markers,
//! limits and speeds stay with the machine axis, the workpiece datum stays with the letter. They change where both stand in
//! their loops and no program is on its way, or it waits at the strobe of an M function or at a programmed stop

use bahn_exchange::{Bit, Image, signal};
use bahn_kernel::{AxisId, AxisUnit, PerChannel};
use bahn_parameters::ControlModel;
use bahn_path::Axis;
use bahn_plc::{PlcProgram, Subject, accesses};

use crate::channel::Channel;
use crate::hand_over;
use crate::machine::MachineSide;

/// M2590 and M2591: which internal axis is switched to axis IV.
const MARKERS: [Bit; 2] = [
    signal::DEFINE_AXIS_TO_SWITCHED_TO_AXIS_4_TNC355,
    signal::DEFINE_AXIS_TO_SWITCHED_TO_AXIS_4_TNC355_M2591,
];
/// Index of axis IV.
const AXIS_IV: u8 = 3;

/// Whether the PLC program of the machine assigns axis IV.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisSwitchover {
    assigns: bool,
}

impl AxisSwitchover {
    /// Of a control with a PLC program; those after the TNC 151/155 do not know the markers.
    pub fn new(model: ControlModel, plc: &PlcProgram) -> AxisSwitchover {
        let old = model.limits().has_old_numbers();
        let names = |subject: &Subject| matches!(subject, Subject::Bit { bit, indexed: false } if MARKERS.contains(bit));
        let mut code = plc.code.iter();
        let assigns = old && code.any(|line| accesses(&line.op).iter().any(|(subject, _)| names(subject)));
        AxisSwitchover { assigns }
    }

    /// Follows the markers, outside the cycle, once the PLC has written them.
    pub fn follow(self, channels: &mut PerChannel<Channel>, machine: &mut MachineSide) {
        if !self.assigns || machine.plc.scans == 0 {
            return;
        }
        let internal = internal_axis(machine.memory.first().nc());
        let changed = || changed(machine, internal);
        if changed().next().is_none() {
            return;
        }
        let changed: Vec<_> = changed().collect();
        if !hand_over::rests(channels.first())
            || !changed.iter().all(|(id, _)| machine.core.axes.may_leave(*id))
        {
            return;
        }
        for (id, letter) in changed {
            machine.core.axes.rename(id, letter);
        }
        channels.first_mut().take_axes(machine);
    }
}

/// The internal axis that the markers name; `None` where all stay what they are [001:2462-2467].
fn internal_axis(nc: &Image) -> Option<Axis> {
    match MARKERS.map(|marker| nc.bit(marker)) {
        [false, false] => Some(Axis::X),
        [false, true] => Some(Axis::Y),
        [true, false] => Some(Axis::Z),
        [true, true] => None,
    }
}

/// The axes whose letters change when axis IV is an internal one, or none, and these letters. A machine without axis IV has
/// nothing to assign.
fn changed(machine: &MachineSide, internal: Option<Axis>) -> impl Iterator<Item = (AxisId, Axis)> {
    let own = machine.core.axes.owned(0);
    let letter = |unit: &AxisUnit| unit.parameters.letter.unwrap_or(unit.axis);
    let fourth = own.clone().find(|unit| unit.parameters.index == AXIS_IV);
    let places = internal.zip(fourth.map(letter));
    own.filter_map(move |unit| {
        let wanted = match (places, letter(unit)) {
            (Some((internal, fourth)), letter) if letter == internal => fourth,
            (Some((internal, fourth)), letter) if letter == fourth => internal,
            (_, letter) => letter,
        };
        (unit.axis != wanted).then_some((unit.id, wanted))
    })
}
