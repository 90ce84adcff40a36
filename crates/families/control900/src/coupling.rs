//! Couplings: a slave follows its master through the gantry of the kernel [002:6520-6573].
//!
//! Decision: A slave comes to its synchronous place with the speed of slope 1, without a ramp
//!
//! Decision: A coupling begins when both stand and nothing moves the slave; one whose master is a slave does not begin

use bahn_kernel::{AxisUnit, Coupling, Mover};
use bahn_servo::Gantry;
use bahn_servo::settings::CouplingSettings;
use bahn_system900::CouplingBlock;

use crate::machine::Machine;
use crate::message::Kind;

/// Couplings.
const COUPLINGS: u8 = 8;

/// Follows the orders P11495 for a cycle, and watches what is coupled.
pub(crate) fn follow(machine: &mut Machine) {
    for number in 1..=COUPLINGS {
        let Some(block) = machine.memory.coupling(number) else {
            continue;
        };
        let place_of = |physical: u8| machine.places.iter().position(|place| place.physical == physical);
        let (Some(master), Some(slave)) = (place_of(block.master), place_of(block.slave)) else {
            continue;
        };
        let state = follow_one(machine, &block, master, slave);
        machine.memory.show_coupling(number, state);
        watch(machine, &block, slave);
    }
}

/// Couples two axes, or parts them; what P11496 says.
fn follow_one(machine: &mut Machine, block: &CouplingBlock, master: usize, slave: usize) -> u8 {
    let timing = machine.core.timing;
    let speed = machine.places.get(slave).map_or(0.0, |place| {
        let [slope, _] = place.block.slopes_mm_min;
        slope
    });
    let may_lead = machine
        .core
        .axes
        .get(master)
        .is_some_and(|unit| unit.coupling.is_none() && unit.stands());
    let leads_at = machine.core.axes.get(master).map(|unit| unit.nominal);
    let (Some(leads_at), Some(unit)) = (leads_at, machine.core.axes.get_mut(slave)) else {
        return 0;
    };
    let is_coupled = unit
        .coupling
        .as_ref()
        .is_some_and(|coupling| coupling.master == master);
    match block.order {
        0 if is_coupled => part(unit),
        1 | 2 if !is_coupled && may_lead && may_follow(unit) => {
            let mut gantry = Gantry::new(CouplingSettings::default(), speed, timing).with_ratio(block.ratio);
            gantry.relate(leads_at, unit.nominal);
            if block.order == 2 {
                let [of_master, of_slave] = block.synchronous_mm;
                gantry.synchronise(of_master, of_slave);
            }
            unit.coupling = Some(Coupling {
                master,
                gantry,
                switched_on: true,
                shows_own: true,
            });
        }
        _ => {}
    }
    match &unit.coupling {
        Some(coupling) if coupling.master == master => {
            1 + u8::from(block.order == 2 && coupling.gantry.synchronized())
        }
        _ => 0,
    }
}

/// Nothing moves it, and its loop is closed.
fn may_follow(unit: &AxisUnit) -> bool {
    unit.coupling.is_none()
        && matches!(unit.mover, Mover::None | Mover::Path)
        && unit.stands()
        && unit.servo.closed()
}

/// The slave goes on by itself, from where it is to be.
fn part(unit: &mut AxisUnit) {
    unit.coupling = None;
    unit.mover = Mover::None;
    unit.ptp = bahn_motion::PointToPoint::moving(unit.nominal, unit.speed);
}

/// The error is too great for too long: both stop.
fn watch(machine: &mut Machine, block: &CouplingBlock, slave: usize) {
    let time_s = f64::from(machine.core.timing.contour_us()) * 1e-6;
    let error = machine
        .core
        .axes
        .get(slave)
        .and_then(|unit| unit.coupling.as_ref());
    let error = error.map(|coupling| coupling.gantry.difference_mm().abs());
    let is_beyond = error
        .zip(block.error_mm)
        .is_some_and(|(error, limit)| error > limit);
    let Some(watch) = machine.watches.get_mut(slave) else {
        return;
    };
    watch.apart_s = if is_beyond { watch.apart_s + time_s } else { 0.0 };
    if watch.apart_s > block.time_s {
        watch.apart_s = 0.0;
        for place in machine.places.clone() {
            if place.physical == block.master || place.physical == block.slave {
                let axis = Some(place.logical).filter(|logical| *logical > 0);
                machine.say(0, place.channel + 1, axis, Kind::High, "coupling error".into());
            }
        }
    }
}
