//! Axes that turn: spindles, as P11650 or the PLC by P12134 orders them.

use bahn_kernel::{AxisUnit, Mover};
use bahn_motion::Aim;
use bahn_system900::{AxisParameter, Memory, SpindleBlock};

use crate::axis_state::Hand;
use crate::machine::Machine;

/// Degrees per minute of one rpm.
const DEG_MIN_PER_RPM: f64 = 360.0;
/// The override of spindles where none is named.
const SPINDLE_OVERRIDE: f64 = 2.0;
/// Spindles.
const SPINDLES: u8 = 8;

/// Turns them for a cycle.
pub(crate) fn turn(machine: &mut Machine) {
    turn_spindles(machine);
    turn_by_plc(machine);
}

/// P11640: spindles turn as they are ordered [002:6575-6627].
fn turn_spindles(machine: &mut Machine) {
    for number in 1..=SPINDLES {
        let Some(spindle) = machine.memory.spindle(number) else {
            continue;
        };
        let time_s = f64::from(machine.core.timing.contour_us()) * 1e-6;
        let axes = machine
            .places
            .iter()
            .zip(&mut machine.hands)
            .zip(machine.core.axes.iter_mut());
        for ((_, hand), unit) in axes.filter(|((place, _), _)| place.physical == spindle.axis) {
            let state = lead(&spindle, hand, unit, time_s);
            let rpm = unit.servo.actual_velocity_mm_min() / DEG_MIN_PER_RPM;
            machine.memory.show_spindle(number, rpm / spindle.unit_rpm, state);
        }
    }
}

/// P12134: axes turn as the PLC says, with P12124 and the override P12129 [002:8199-8228].
///
/// Decision: P12134 of a System 900 leaves an axis alone that turns as a spindle by P11650
fn turn_by_plc(machine: &mut Machine) {
    let time_s = f64::from(machine.core.timing.contour_us()) * 1e-6;
    let axes = machine
        .places
        .iter()
        .zip(&mut machine.hands)
        .zip(machine.core.axes.iter_mut());
    for ((place, hand), unit) in axes {
        let memory = &mut machine.memory;
        let bits = memory.of_axis(place.physical, AxisParameter::Turn).bits();
        let order = match bits.unwrap_or(0).to_le_bytes() {
            [1, ..] => 1,
            [_, 1, ..] => -1,
            _ => 0,
        };
        if hand.turns != hand.turns_by_plc || order == 0 && !hand.turns_by_plc {
            continue;
        }
        let number = |parameter| {
            let cell = memory.of_axis(place.physical, parameter);
            cell.number().filter(|number| *number > 0.0)
        };
        let speed = number(AxisParameter::TurnSpeed).unwrap_or(place.block.max_mm_min);
        let percent = number(AxisParameter::TurnOverride).unwrap_or(SPINDLE_OVERRIDE);
        let spindle = SpindleBlock {
            number: 0,
            axis: place.physical,
            max_rpm: f64::INFINITY,
            rpm: speed * memory.override_percent(percent as u8) / 100.0 / DEG_MIN_PER_RPM,
            unit_rpm: 1.0,
            order,
            position_deg: 0.0,
            tolerance_percent: None,
        };
        let reached = lead(&spindle, hand, unit, time_s);
        hand.turns_by_plc = hand.turns;
        if let Some(of) = Memory::axis_place(place.physical, AxisParameter::TurnReached) {
            memory.store_bits(of, reached.into());
        }
        let actual = if hand.turns {
            unit.servo.actual_velocity_mm_min()
        } else {
            0.0
        };
        memory.set_axis(place.physical, AxisParameter::TurnSpeedActual, actual, 3);
    }
}

/// A spindle for a cycle; what P11651 says.
fn lead(spindle: &SpindleBlock, hand: &mut Hand, unit: &mut AxisUnit, time_s: f64) -> u8 {
    let may = unit.can_be_driven() && matches!(unit.mover, Mover::None | Mover::Rotation);
    if !may || spindle.order == 0 && !hand.turns {
        return 0;
    }
    hand.turns = true;
    unit.mover = Mover::Rotation;
    let greatest = unit.parameters.motion.rapid_mm_min / DEG_MIN_PER_RPM;
    let rpm = spindle.rpm.min(spindle.max_rpm).min(greatest);
    match spindle.order {
        0 => {
            unit.come_to_rest(time_s);
            hand.turns = unit.mover == Mover::Rotation;
            0
        }
        order @ (1 | -1) => {
            let wanted = order as f64 * rpm * DEG_MIN_PER_RPM;
            unit.drive(time_s, Aim::Feed(wanted), wanted.abs());
            let actual = unit.servo.actual_velocity_mm_min();
            let near = match spindle.tolerance_percent {
                Some(percent) => (actual - wanted).abs() <= wanted.abs() * percent / 100.0,
                None => unit.speed * 60.0 == wanted,
            };
            u8::from(near && rpm > 0.0)
        }
        _ => {
            let turns = ((unit.nominal - spindle.position_deg) / 360.0).round();
            let target = spindle.position_deg + turns * 360.0;
            unit.drive(time_s, Aim::Position(target), rpm.max(1.0) * DEG_MIN_PER_RPM);
            if unit.ptp.is_at(target) && unit.servo.in_position() {
                2
            } else {
                0
            }
        }
    }
}
