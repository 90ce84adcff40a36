//! The loop of an axis is closed and opened, and its feed enable given and withdrawn [000:5352-5369] [000:5403-5421].

use crate::axis::{AxisUnit, Mover};

/// Closes the loop of an axis when that is wanted and nothing is wrong with it, or opens it. `keeps`: as long as the loop is
/// open the nominal position stays, and the axis goes back to it [001:495-499].
pub fn hold(unit: &mut AxisUnit, wanted: bool, runs: bool, keeps: bool) {
    let sound = unit.servo.fault().is_none_or(|fault| !fault.opens_loop());
    if wanted && sound && !unit.servo.closed() {
        // A clamped axis goes back to its nominal position. One that was moved meanwhile has lost its place in a program
        // that runs, which the standstill monitoring says: values are transferred by hand only [000:5423-5434]. Else the
        // path goes on from there: nothing goes back.
        let moved = (unit.servo.actual_mm() - unit.nominal).abs() > unit.parameters.monitoring.standstill_mm;
        if moved && unit.keeps_nominal {
            unit.servo.close();
            unit.go_back();
            return;
        }
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
        unit.keeps_nominal = keeps;
    } else if !wanted {
        unit.keeps_nominal &= keeps;
    }
}

/// Gives the feed enable to an axis, or withdraws it.
pub fn enable(unit: &mut AxisUnit, enabled: bool) {
    let dead = !(enabled || unit.parameters.motion.ramps_without_enable);
    if unit.enabled && dead && !(unit.stands() && unit.servo.in_position()) {
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
