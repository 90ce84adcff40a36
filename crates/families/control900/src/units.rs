//! The axes of the kernel, built of the blocks of physical axes.
//!
//! Decision: A path accelerates with P12009 also in rapid traverse, which the manual leaves to P12008

use bahn_kernel::{AxisId, AxisUnit, OwnAxes};
use bahn_motion::Limits;
use bahn_path::{Axis, PerAxis};
use bahn_servo::{IdealAxes, IdealDrive, Timing};
use bahn_system900::{AxisBlock, Connection, LOGICAL_AXES, Memory, slots};

use crate::axis_parameters::axis_parameters;
use crate::axis_state::AxisPlace;

/// The longest interpolation cycle, ms.
const CYCLE_MAX_MS: f64 = 4.0;
/// A servo step, µs.
const STEP_US: u32 = 1000;
/// Bits of the voltage converter for 10 V (inferred).
const OUTPUT_BITS: u8 = 15;
/// The number of a physical axis from which the kernel counts one further: it leaves a place to the spindle of messages.
const AFTER_SPINDLE: u8 = 5;
/// Direction changes up to which a path does not stop at a corner, degrees: the angle between its sides is 90 at least
/// [002:4475-4548].
const CORNER_DEG: f64 = 90.0;
/// Radial acceleration where nothing limits a circle, m/s² (inferred).
const RADIAL_M_S2: f64 = 1000.0;

/// Cycles of a control.
pub(crate) fn timing(memory: &Memory) -> Timing {
    let ms = memory.cycle_ms().unwrap_or(CYCLE_MAX_MS).clamp(1.0, CYCLE_MAX_MS);
    let contour_us = (ms * 1e3).round() as u32;
    Timing::new(contour_us, contour_us / STEP_US, OUTPUT_BITS)
}

/// The interpolation cycle of a control with these parameters, µs.
pub fn cycle_us(memory: &Memory) -> u32 {
    timing(memory).contour_us()
}

/// The number of a physical axis in the kernel.
fn id(physical: u8) -> Option<AxisId> {
    let number = physical.checked_sub(1)?;
    AxisId::new(number + u8::from(number >= AFTER_SPINDLE))
}

/// All axes that are connected, with the lowest channel that names each.
pub(crate) fn build(memory: &Memory, timing: Timing) -> (Vec<AxisUnit>, Vec<AxisPlace>) {
    let (mut units, mut places) = (Vec::new(), Vec::new());
    let mut add = |physical: u8, channel: u8, logical: u8, slot: Option<Axis>| {
        let known = places.iter().any(|place: &AxisPlace| place.physical == physical);
        let block = AxisBlock::of(memory, physical);
        if known || block.connection == Connection::None {
            return;
        }
        let parameters = axis_parameters(&block, logical, physical, slot);
        let Some(mut unit) =
            id(physical).and_then(|id| AxisUnit::new(id, (usize::from(channel), 0), parameters, timing))
        else {
            return;
        };
        let [least, greatest] = block.limits_mm;
        unit.limits = [
            least.unwrap_or(f64::NEG_INFINITY),
            greatest.unwrap_or(f64::INFINITY),
        ];
        unit.enabled = true;
        units.push(unit);
        places.push(AxisPlace {
            physical,
            channel,
            logical,
            block,
        });
    };
    for channel in 1..=memory.channels() {
        let slots = slots(memory, channel);
        for (logical, physical) in memory.axes_of(channel) {
            let slot = slots.get(usize::from(logical) - 1).copied().flatten();
            add(physical, channel - 1, logical, slot);
        }
    }
    // Others are axes of the first channel that no program knows: spindles.
    for physical in 1..=LOGICAL_AXES as u8 {
        add(physical, 0, 0, None);
    }
    (units, places)
}

/// What a path of a channel may ask of the axes that it has now.
pub(crate) fn limits(axes: &OwnAxes, places: &[AxisPlace], timing: Timing) -> Limits {
    let of = |axis: Axis| {
        let mut own = axes
            .places()
            .filter_map(|place| Some((axes.get(place)?, places.get(place)?)));
        own.find(|(unit, _)| unit.axis == axis && !unit.is_plc_axis())
            .map(|(_, place)| place.block)
    };
    limits_of(of, timing)
}

/// What a path of a channel, from 1 on, may ask of its axes: for whoever plans it without a control.
pub fn path_limits(memory: &Memory, channel: u8) -> Limits {
    let slots = slots(memory, channel);
    let of = |axis: Axis| {
        let mut axes = memory.axes_of(channel);
        let own = axes.find(|(logical, _)| slots.get(usize::from(*logical) - 1) == Some(&Some(axis)));
        own.map(|(_, physical)| AxisBlock::of(memory, physical))
    };
    limits_of(of, timing(memory))
}

fn limits_of(of: impl Fn(Axis) -> Option<AxisBlock>, timing: Timing) -> Limits {
    let speed = |block: AxisBlock| block.path_mm_min;
    let acceleration = |block: AxisBlock| block.max_mm_min / 60.0 / block.ramps_s[1] * 1e-3;
    Limits {
        max_feed_mm_min: PerAxis::from_fn(|axis| of(axis).map_or(0.0, speed)),
        acceleration_m_s2: PerAxis::from_fn(|axis| of(axis).map_or(1.0, acceleration)),
        radial_acceleration_m_s2: RADIAL_M_S2,
        corner_angle_deg: CORNER_DEG,
        servo_lag: true,
        cycle_s: f64::from(timing.contour_us()) * 1e-6,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: Default::default(),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    }
}

/// A machine of which nothing is known but its parameters: physical axis n moves without delay at the voltage of its output
/// through P12027 of P12004, as its encoder counts; all stand at 0 at power-on.
pub fn ideal_machine(memory: &Memory) -> IdealAxes {
    let mut ideal = IdealAxes::default();
    for physical in 1..=LOGICAL_AXES as u8 {
        let block = AxisBlock::of(memory, physical);
        let Some(drive) = ideal.drives.get_mut(usize::from(physical) - 1) else {
            continue;
        };
        let sign = if block.counts_negative == block.is_inverted {
            1.0
        } else {
            -1.0
        };
        let steps_s = block.max_mm_min / 60.0 * block.increments_mm;
        *drive = (block.connection != Connection::None).then_some(IdealDrive {
            output: usize::from(block.output) - 1,
            steps_s_volt: sign * steps_s / block.max_volts,
            is_dead: false,
        });
    }
    ideal
}
