//! The block of a physical axis as the kernel takes it.
//!
//! Decision: The kernel watches no lag, no voltage and no standstill here: a System 900 has its own limits for them
//! [002:7044-7127]

use bahn_parameters::axis::{
    AxisParameters, InhibitedMark, Modulo, MotionParameters, ReferenceParameters, Synchronization,
    TravelParameters, WiringParameters,
};
use bahn_path::{Axis, Direction};
use bahn_servo::Encoder;
use bahn_servo::settings::{
    CompensationSettings, CouplingSettings, EncoderSettings, LagSettings, MarkKind, MonitoringSettings,
    OutputSettings, PrecontrolSettings,
};
use bahn_system900::AxisBlock;

/// Voltage from which nothing watches a movement, V.
const UNWATCHED_VOLTS: f64 = 10.0;

/// A block as the kernel takes it. An axis without a slot is none of a path.
pub(crate) fn axis_parameters(
    block: &AxisBlock,
    logical: u8,
    physical: u8,
    slot: Option<Axis>,
) -> AxisParameters {
    let acceleration_m_s2 = block.max_mm_min / 60.0 / block.ramps_s[0] * 1e-3;
    let [exact_stop, _] = block.exact_stop_mm;
    AxisParameters {
        index: logical.saturating_sub(1),
        letter: Some(slot.unwrap_or(Axis::X)),
        active: true,
        controlled: true,
        shown: true,
        plc_axis: slot.is_none(),
        wiring: WiringParameters {
            input: physical - 1,
            output: block.output - 1,
        },
        encoder: encoder(block),
        output: OutputSettings {
            polarity_negative: block.is_inverted,
            rapid_volts: block.max_volts,
            integral_factor: 0.0,
        },
        offset_interval_s: 0.0,
        offset_patience_s: None,
        motion: MotionParameters {
            rapid_mm_min: block.max_mm_min,
            manual_mm_min: block.max_mm_min,
            acceleration_m_s2,
            plc_mm_min: block.max_mm_min,
            ramps_without_enable: false,
        },
        lag: lag(block),
        precontrol: precontrol(block),
        precontrol_in_automatic: false,
        precontrol_in_manual: false,
        monitoring: MonitoringSettings {
            window_mm: exact_stop,
            standstill_mm: f64::INFINITY,
            movement_volts: UNWATCHED_VOLTS,
            residual_voltage_s: 0.0,
        },
        compensation: CompensationSettings {
            backlash_mm: block.backlash_mm,
            linear_mm_m: 0.0,
            nonlinear: false,
            reversal_mm: [0.0; 2],
            reversal_step_mm: [0.0; 2],
            stiction_us: 0.0,
            stiction_limit_steps: 0.0,
            stiction_feed_mm_min: 0.0,
        },
        reference: reference(block),
        travel: travel(block),
        synchronization: Synchronization {
            master: None,
            coupling: CouplingSettings::default(),
        },
        digital: None,
    }
}

/// The gain of its loop, (m/min)/mm.
fn kv(block: &AxisBlock) -> f64 {
    block.gain_s * 60.0 * 1e-3
}

fn encoder(block: &AxisBlock) -> EncoderSettings {
    EncoderSettings {
        signal_period_um: Encoder::STEPS as f64 * 1e3 / block.increments_mm,
        square_wave: false,
        interpolation: 1,
        counts_negative: block.counts_negative,
        check_distance_code: false,
        check_amplitude: true,
        check_edges: true,
    }
}

fn lag(block: &AxisBlock) -> LagSettings {
    LagSettings {
        kv: kv(block),
        kv_m105: kv(block),
        kink_factor: 1.0,
        kink_percent: 100.0,
        feed_forward: block.feed_forward,
        monitoring_mm: f64::INFINITY,
        emergency_mm: f64::INFINITY,
    }
}

fn precontrol(block: &AxisBlock) -> PrecontrolSettings {
    PrecontrolSettings {
        kv: kv(block),
        kv_m105: kv(block),
        transient_m_min: 1.0,
        damping: 0.5,
        window_mm_min: f64::INFINITY,
        monitoring_mm: f64::INFINITY,
        emergency_mm: f64::INFINITY,
    }
}

fn reference(block: &AxisBlock) -> ReferenceParameters {
    ReferenceParameters {
        direction: Direction::Plus,
        feed_mm_min: block.max_mm_min,
        leaving_mm_min: block.max_mm_min,
        place: None,
        kind: MarkKind::UnderCam,
        backs_off: false,
        inhibited: InhibitedMark::Zeroes,
        mark_spacing_mm: 1.0,
    }
}

fn travel(block: &AxisBlock) -> TravelParameters {
    TravelParameters {
        ranges_mm: [[f64::NEG_INFINITY, f64::INFINITY]; 3],
        modulo: block.turn_deg.map(|deg| Modulo { deg, signed: false }),
        machine_datum_mm: 0.0,
        m92_mm: 0.0,
        tool_change_mm: None,
        hirth_deg: None,
        datum_inhibited: false,
        lubrication_mm: None,
        display_step_mm: 1e-3,
    }
}
