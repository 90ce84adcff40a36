//! What can be held against an axis after every contour cycle: what it is told, what it may, what it has found.

use bahn_kernel::{AxisId, AxisUnit, Mover, Superimposed};
use bahn_parameters::fault::FaultId;
use bahn_path::Axis;

/// An axis as the kernel moves it; positions in machine coordinates, mm or degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisWatch {
    /// Its number on the machine.
    pub id: AxisId,
    /// Its slot in the path of the channel.
    pub axis: Axis,
    /// The place of its nominal value output among those of the machine.
    pub output: usize,
    /// Where it is commanded to be at the end of the contour cycle.
    pub commanded: f64,
    /// How far its loop is commanded beside that: back from where it ran on without feed enable.
    pub beside: f64,
    /// Speed that is commanded, mm/s, with its sign.
    pub speed_mm_s: f64,
    /// Position by its encoder, machine coordinates, mm or degrees.
    pub actual: f64,
    /// Nominal minus actual position, mm or degrees.
    pub lag: f64,
    /// Nominal value that its loop gives out, V.
    pub volts: f64,
    /// What the handwheel adds to its path (M118), and how far it may to either side, mm or degrees.
    pub superimposed: f64,
    /// How far the handwheel may be added to either side, mm or degrees.
    pub superimposable: f64,
    /// The loop is closed.
    pub closed: bool,
    /// The feed is enabled.
    pub enabled: bool,
    /// The enable was withdrawn while it moved: 0 V until it is back.
    pub halted: bool,
    /// The path of a program moves it.
    pub on_path: bool,
    /// It follows a master: no path names it.
    pub slave: bool,
    /// It is moved for itself: neither by its master nor by the PLC (MP60).
    pub free: bool,
    /// With a digital speed controller: so long its torque goes on when the loop is opened, MP1980, s; without feed enable
    /// it is held by torque.
    pub torque_s: Option<f64>,
    /// Its software limits, least and greatest, where they are effective.
    pub limits: Option<[f64; 2]>,
    /// What its monitoring has found.
    pub fault: Option<FaultId>,
    /// The lag beyond which POSITIONING ERROR comes whatever the method is: the greater of MP1710, MP1410.
    pub lag_max: f64,
    /// The lag beyond which GROSS POSITIONING ERROR comes whatever the method is: the greater of MP1720, MP1420.
    pub lag_gross: f64,
    /// Rapid traverse MP1010, mm/s.
    pub rapid_mm_s: f64,
    /// Acceleration MP1060, mm/s².
    pub acceleration_mm_s2: f64,
    /// Amplitude and edges of its encoder are monitored (MP31, MP32).
    pub monitors: [bool; 2],
}

/// How an axis follows what it is told: what [`AxisSignal`](crate::AxisSignal) has of it in every contour cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisFollowing {
    /// Its slot in the path of the channel.
    pub axis: Axis,
    /// Nominal position in machine coordinates, mm or degrees.
    pub nominal: f64,
    /// Actual position in machine coordinates, mm or degrees.
    pub actual: f64,
    /// Nominal minus actual position, mm or degrees.
    pub lag: f64,
    /// Nominal speed, mm/min.
    pub nominal_speed: f64,
}

impl AxisFollowing {
    pub(crate) fn of(unit: &AxisUnit) -> AxisFollowing {
        AxisFollowing {
            axis: unit.axis,
            nominal: unit.servo.nominal_mm(),
            actual: unit.servo.actual_mm(),
            lag: unit.servo.lag_mm(),
            nominal_speed: unit.speed * 60.0,
        }
    }
}

impl AxisWatch {
    pub(crate) fn of(unit: &AxisUnit, superimposed: &Superimposed) -> AxisWatch {
        let parameters = &unit.parameters;
        let (lag, precontrol) = (&parameters.lag, &parameters.precontrol);
        AxisWatch {
            id: unit.id,
            axis: unit.axis,
            output: unit.output(),
            commanded: unit.nominal,
            beside: unit.way_back.beside(),
            speed_mm_s: unit.speed,
            actual: unit.servo.actual_mm(),
            lag: unit.servo.lag_mm(),
            volts: unit.servo.volts(),
            superimposed: superimposed.of(unit.axis),
            superimposable: superimposed.range(unit.axis),
            closed: unit.servo.closed(),
            enabled: unit.enabled,
            halted: unit.halted,
            on_path: unit.mover == Mover::Path,
            slave: unit.coupling.is_some(),
            free: unit.is_free(),
            torque_s: parameters.digital.map(|digital| digital.emergency_stop_s),
            limits: unit.limited(),
            fault: unit.servo.fault().map(FaultId::from),
            lag_max: lag.monitoring_mm.max(precontrol.monitoring_mm),
            lag_gross: lag.emergency_mm.max(precontrol.emergency_mm),
            rapid_mm_s: parameters.motion.rapid_mm_min / 60.0,
            acceleration_mm_s2: parameters.motion.acceleration_m_s2 * 1e3,
            monitors: [parameters.encoder.check_amplitude, parameters.encoder.check_edges],
        }
    }
}
