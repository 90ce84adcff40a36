//! Emergency position, basic position, fixed position [002:8094-8197].
//!
//! Decision: Towards its emergency position an axis goes as fast as it can, whatever the override; programs of its channel are
//! broken off, and the axes of P12047 stop

use bahn_kernel::within;
use bahn_system900::AxisParameter;

use crate::axis_state::{Goal, Report};
use crate::hand::{axis_number, report};
use crate::machine::Machine;
use crate::message::Kind;

/// An emergency position is approached [002:8097-8120].
const EMERGENCY: u32 = 2000;

/// Positions of P12132 and P12133, in the order of their bytes: place after P12032, relative or not, and what says that they
/// are reached.
const EMERGENCY_BYTES: [(u32, bool, i32); 4] = [
    (0, false, 1),
    (1, true, 1),
    (2, false, 1 << 16),
    (3, true, 1 << 16),
];
const FIXED: (u32, bool, i32) = (4, false, 1);

/// P12132: byte 1 and 2 emergency position, byte 3 and 4 basic position.
pub(crate) fn go_emergency(machine: &mut Machine, physical: u8) {
    let bits = machine
        .memory
        .of_axis(physical, AxisParameter::GoEmergency)
        .bits()
        .unwrap_or(0);
    let wanted = bits.to_le_bytes().iter().position(|byte| *byte == 1);
    let is_emergency = wanted.is_some_and(|byte| byte < 2);
    let of = wanted.and_then(|byte| EMERGENCY_BYTES.get(byte));
    if is_emergency {
        stop_others(machine, physical);
    }
    go(
        machine,
        physical,
        of,
        AxisParameter::EmergencyReached,
        !is_emergency,
    );
}

/// P12133: byte 1 fixed position.
pub(crate) fn go_fixed(machine: &mut Machine, physical: u8) {
    let bits = machine
        .memory
        .of_axis(physical, AxisParameter::GoFixed)
        .bits()
        .unwrap_or(0);
    let of = (bits & 0xFF == 1).then_some(&FIXED);
    go(machine, physical, of, AxisParameter::FixedReached, true);
}

fn go(
    machine: &mut Machine,
    physical: u8,
    of: Option<&(u32, bool, i32)>,
    reached: AxisParameter,
    overridden: bool,
) {
    report(
        &mut machine.memory,
        physical,
        Report {
            parameter: reached,
            after: 0,
            bits: 0,
        },
    );
    let number = axis_number(&machine.memory, physical, AxisParameter::FixedOverride, 0);
    let percent = machine
        .memory
        .override_percent(number.filter(|number| *number > 0.0).unwrap_or(1.0) as u8);
    let speed = axis_number(&machine.memory, physical, AxisParameter::FixedSpeed, 0);
    let axes = machine
        .places
        .iter()
        .zip(&mut machine.hands)
        .zip(machine.core.axes.iter());
    for ((place, hand), unit) in axes.filter(|((place, _), _)| place.physical == physical) {
        let goal = of.and_then(|(after, relative, bits)| {
            let value = axis_number(
                &machine.memory,
                physical,
                AxisParameter::EmergencyPosition,
                *after,
            )?;
            let wanted = if *relative { unit.nominal + value } else { value };
            let feed = match reached {
                AxisParameter::FixedReached => speed.filter(|speed| *speed > 0.0),
                _ => None,
            };
            let feed = feed.unwrap_or(place.block.max_mm_min);
            Some(Goal {
                position: within(unit, wanted).0,
                feed_mm_min: if overridden { feed * percent / 100.0 } else { feed },
                reports: Some(Report {
                    parameter: reached,
                    after: 0,
                    bits: *bits,
                }),
            })
        });
        hand.goal = goal;
    }
}

/// The program of the channel is broken off; the axes of P12047 stop.
fn stop_others(machine: &mut Machine, physical: u8) {
    let bits = machine
        .memory
        .of_axis(physical, AxisParameter::StopsAxes)
        .bits()
        .unwrap_or(0);
    let Some(own) = machine
        .places
        .iter()
        .find(|place| place.physical == physical)
        .copied()
    else {
        return;
    };
    for (place, hand) in machine.places.iter().zip(&mut machine.hands) {
        let named = bits >> (place.physical - 1) & 1 != 0;
        if named && place.physical != physical {
            (hand.goal, hand.key) = (None, None);
        }
    }
    if let Some(channel) = machine.channels.get_mut(usize::from(own.channel)) {
        channel.wanted.abort = true;
    }
    let axis = Some(own.logical).filter(|logical| *logical > 0);
    machine.raise(EMERGENCY, own.channel + 1, axis, Kind::Display);
}
