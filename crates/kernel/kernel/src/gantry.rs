//! Synchronized axes: slaves that follow their masters [000:4451-4539].

use bahn_servo::{Gantry, Timing};

use crate::axis::{AxisUnit, Coupling};

/// Couples the slaves among the axes (MP850) to their masters. A slave whose master does not exist stays an
/// axis of its own (inferred).
pub fn couple(mut axes: Vec<AxisUnit>, timing: Timing) -> Vec<AxisUnit> {
    for place in 0..axes.len() {
        let wanted = axes.get(place).and_then(|unit| {
            let master = unit.parameters.synchronization.master?;
            Some((unit.channel, usize::from(master)))
        });
        let Some(wanted) = wanted else { continue };
        let master = axes.iter().position(|unit| (unit.channel, unit.index) == wanted);
        let Some(master) = master.filter(|master| *master != place) else {
            continue;
        };
        let parameters = axes.get(master).map(|unit| unit.parameters);
        let (Some(of_master), Some(unit)) = (parameters, axes.get_mut(place)) else {
            continue;
        };
        if of_master.synchronization.master.is_some() {
            continue;
        }
        let parameters = unit.parameters.as_slave_of(&of_master);
        let gantry = Gantry::new(
            parameters.synchronization.coupling,
            of_master.reference.feed_mm_min,
            timing,
        );
        unit.set_parameters(parameters);
        unit.coupling = Some(Coupling {
            master,
            gantry,
            switched_on: false,
            shows_own: false,
        });
    }
    axes
}

/// The slave at a place with its master.
fn pair(axes: &mut [AxisUnit], slave: usize) -> Option<(&mut AxisUnit, &mut AxisUnit)> {
    let master = axes.get(slave)?.coupling.as_ref()?.master;
    let [master, slave] = axes.get_disjoint_mut([master, slave]).ok()?;
    Some((master, slave))
}

/// The loops were closed: with the first time the relation of masters and slaves is what it shall be, unless
/// reference marks say better (MP860) [000:4492-4502].
pub fn switch_on(axes: &mut [AxisUnit]) {
    for place in 0..axes.len() {
        if let Some((master, slave)) = pair(axes, place)
            && let Some(coupling) = &mut slave.coupling
            && !std::mem::replace(&mut coupling.switched_on, true)
        {
            coupling.gantry.switch_on(&master.servo, &slave.servo);
        }
    }
}

/// The nominal positions of the slaves for the end of the contour cycle.
pub fn command(axes: &mut [AxisUnit]) {
    for place in 0..axes.len() {
        let Some((master, slave)) = pair(axes, place) else {
            continue;
        };
        let Some(coupling) = &mut slave.coupling else {
            continue;
        };
        let wanted = master.nominal + master.way_back.beside();
        coupling.gantry.command(wanted, &master.servo, &mut slave.servo);
        // The nominal display of the slave is the master's nominal value [000:4519-4539].
        let shown = match coupling.shows_own {
            true => coupling.gantry.wanted(master.nominal),
            false => master.nominal,
        };
        slave.follow_master(shown, master.speed);
    }
}

/// A position of an axis was shifted: the slaves know.
pub fn shifted(axes: &mut [AxisUnit], place: usize, shift_mm: f64) {
    for unit in 0..axes.len() {
        let Some(coupling) = axes.get_mut(unit).and_then(|unit| unit.coupling.as_mut()) else {
            continue;
        };
        if unit == place {
            coupling.gantry.shift(0.0, shift_mm);
        } else if coupling.master == place {
            coupling.gantry.shift(shift_mm, 0.0);
        }
    }
}

/// How far the slaves of a master are in its reference run.
pub struct Slaves {
    /// All have crossed their marks, those that need one.
    pub found: bool,
    /// All are beside their master.
    pub synchronous: bool,
}

/// Goes on with the reference run of the slaves of a master, while marks count and a slave is not on its
/// cam. A slave without marks (MP860 = 0) gets the position of its master; others cross their mark and drive
/// out what offset is left [000:4492-4504].
pub fn reference(
    axes: &mut [AxisUnit],
    master: usize,
    marks_count: bool,
    on_cam: impl Fn(&AxisUnit) -> bool,
) -> Slaves {
    let mut slaves = Slaves {
        found: true,
        synchronous: true,
    };
    for place in 0..axes.len() {
        let Some(slave) = axes.get_mut(place) else {
            continue;
        };
        if slave.coupling.as_ref().is_none_or(|of| of.master != master) {
            continue;
        }
        if !slave.referenced && slave.parameters.synchronization.coupling.from_reference_marks {
            let counts = marks_count && !on_cam(slave);
            let mark = slave.servo.take_mark().filter(|_| counts);
            if let Some((count, position_mm)) = mark.and_then(|mark| slave.located(mark)) {
                slave.referenced = true;
                let shift = slave.set_datum(count, position_mm);
                shifted(axes, place, shift);
            }
        }
        synchronize(axes, place);
        if let Some(slave) = axes.get(place) {
            slaves.found &=
                slave.referenced || !slave.parameters.synchronization.coupling.from_reference_marks;
            let beside = slave.coupling.as_ref().is_none_or(|of| of.gantry.synchronized());
            slaves.synchronous &= beside;
        }
    }
    slaves
}

/// Once the master is referenced: takes its position over, or drives out what offset is left.
fn synchronize(axes: &mut [AxisUnit], place: usize) {
    let Some((master, slave)) = pair(axes, place) else {
        return;
    };
    let from_marks = slave.parameters.synchronization.coupling.from_reference_marks;
    if !master.referenced {
        return;
    }
    if from_marks {
        if slave.referenced
            && let Some(coupling) = &mut slave.coupling
        {
            coupling.gantry.referenced(0.0, 0.0);
        }
    } else if !slave.referenced {
        slave.referenced = true;
        let shift = slave.set_datum(slave.servo.count(), master.servo.actual_mm());
        shifted(axes, place, shift);
    }
}
