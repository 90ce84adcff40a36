//! Monitoring of lag, voltage, movement and standstill [000:5160-5300].
//!
//! Decision: Without feed enable the limits of servo lag hold, also with pre-control, until the lag is run down
//!
//! Decision: After POSITIONING ERROR, MP1150 later, the actual position becomes the nominal one once and the drive
//! gets 0 V until CE; the position monitoring goes on from there, so that an axis that runs or sinks farther than
//! MP1720 is GROSS POSITIONING ERROR A, as one without feed enable. Movement and standstill monitoring begin anew
//! with CE: they would take the run-on of a sound drive for a fault

use crate::settings::AxisSettings;

use crate::fault::{Fault, GrossFault};
use crate::method::Method;
use crate::timing::{OUTPUT_VOLTS, Timing};

/// Time over which the distance is compared with the calculated one, s (inferred: "several servo cycles"
/// [000:5270]).
pub(crate) const MOVEMENT_WINDOW_S: f64 = 0.1;
/// Part of the calculated distance by which the distance may differ (inferred): a drive that accelerates after its
/// nominal value stays below it.
pub(crate) const MOVEMENT_TOLERANCE: f64 = 0.5;

/// What a servo step shows.
pub(crate) struct Sample {
    pub actual_mm: f64,
    pub lag_mm: f64,
    /// Nominal distance of the step.
    pub distance_mm: f64,
    /// The nominal position stands.
    pub standing: bool,
    /// The positioning window was reached.
    pub in_position: bool,
    /// Velocity of the nominal value.
    pub velocity_mm_min: f64,
    /// Nominal value before it is limited.
    pub volts: f64,
    /// The drive gets the nominal value.
    pub enabled: bool,
}

/// Where the axis is between two standstills.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// It stands within the positioning window.
    Rest,
    /// Has begun to move from here.
    Start { origin_mm: f64, direction: f64 },
    /// It moves towards its nominal position.
    Travel { direction: f64 },
    /// Nominal position reached; the axis comes from the side on which its lag was.
    Arrival { side: f64 },
}

#[derive(Clone, Debug)]
pub(crate) struct Monitor {
    limits: Method,
    phase: Phase,
    window_steps: u32,
    steps: u32,
    calculated_mm: f64,
    origin_mm: f64,
    /// Where the nominal position was when the drive lost its voltage.
    left_mm: Option<f64>,
}

impl Monitor {
    pub(crate) fn new(timing: &Timing) -> Monitor {
        Monitor {
            limits: Method::Lag,
            phase: Phase::Arrival { side: 0.0 },
            window_steps: timing.steps_of(MOVEMENT_WINDOW_S).max(1),
            steps: 0,
            calculated_mm: 0.0,
            origin_mm: 0.0,
            left_mm: None,
        }
    }

    /// The actual position became the nominal one.
    pub(crate) fn transfer(&mut self) {
        self.left_mm = None;
    }

    /// Begins anew, as when the loop is closed.
    pub(crate) fn reset(&mut self) {
        self.phase = Phase::Arrival { side: 0.0 };
        self.steps = 0;
        self.left_mm = None;
    }

    /// The axis has reached its window before.
    pub(crate) fn rest(&mut self) {
        self.phase = Phase::Rest;
    }

    pub(crate) fn shift(&mut self, way: f64) {
        self.origin_mm += way;
        if let Some(left) = &mut self.left_mm {
            *left += way;
        }
        if let Phase::Start { origin_mm, .. } = &mut self.phase {
            *origin_mm += way;
        }
    }

    pub(crate) fn check(
        &mut self,
        sample: &Sample,
        method: Method,
        settings: &AxisSettings,
        timing: &Timing,
    ) -> Option<Fault> {
        if !sample.enabled {
            // With 0 V nothing is pre-controlled: the axis runs on by as much as its drive needs to stop, from where it was
            // held last, also after POSITIONING ERROR, where one transfer of the actual value follows MP1150 [000:5240-5242]
            // and the position monitoring goes on [000:5192-5206] (inferred).
            let left = *self.left_mm.get_or_insert(sample.actual_mm + sample.lag_mm);
            self.reset();
            (self.limits, self.left_mm) = (Method::Lag, Some(left));
            return self.deviation(left - sample.actual_mm, method, settings);
        }
        self.left_mm = None;
        let deviation = self.deviation(sample.lag_mm, method, settings);
        let voltage = (method == Method::Precontrol && sample.volts.abs() > OUTPUT_VOLTS)
            .then_some(Fault::Gross(GrossFault::Voltage));
        let gross = |fault: bool, gross| fault.then_some(Fault::Gross(gross));
        let standstill = gross(self.moves_at_standstill(sample, settings), GrossFault::Standstill);
        let movement = gross(
            self.moves_otherwise(sample, settings, timing),
            GrossFault::Movement,
        );
        // Of several faults the gross one counts.
        match deviation {
            Some(Fault::Gross(_)) => deviation,
            _ => voltage.or(standstill).or(movement).or(deviation),
        }
    }

    /// The lag against the limits of the method. After a change from lag to pre-control, and after the feed enable
    /// was withdrawn, those of the lag hold until it is run down (inferred).
    fn deviation(&mut self, lag_mm: f64, method: Method, settings: &AxisSettings) -> Option<Fault> {
        let (lag, precontrol) = (&settings.lag, &settings.precontrol);
        let amount = lag_mm.abs();
        if method == Method::Lag || amount <= precontrol.monitoring_mm {
            self.limits = method;
        }
        let (limit, emergency) = match self.limits {
            Method::Lag => (lag.monitoring_mm, lag.emergency_mm),
            Method::Precontrol => (precontrol.monitoring_mm, precontrol.emergency_mm),
        };
        if amount > emergency {
            Some(Fault::Gross(GrossFault::Deviation))
        } else {
            (amount > limit).then_some(Fault::Positioning)
        }
    }

    /// Moves out of its place, over its target or backwards at the start by more than MP1110.
    fn moves_at_standstill(&mut self, sample: &Sample, settings: &AxisSettings) -> bool {
        let limit = settings.monitoring.standstill_mm;
        if sample.standing {
            let side = match self.phase {
                Phase::Rest => return sample.lag_mm.abs() > limit,
                Phase::Arrival { side } => side,
                Phase::Start { direction, .. } | Phase::Travel { direction } => {
                    if sample.lag_mm.abs() > settings.monitoring.window_mm {
                        sample.lag_mm.signum()
                    } else {
                        direction
                    }
                }
            };
            self.phase = if sample.in_position {
                Phase::Rest
            } else {
                Phase::Arrival { side }
            };
            return -side * sample.lag_mm > limit;
        }
        let direction = if sample.distance_mm < 0.0 { -1.0 } else { 1.0 };
        match self.phase {
            Phase::Rest => {
                self.phase = Phase::Start {
                    origin_mm: sample.actual_mm,
                    direction,
                };
                false
            }
            Phase::Start {
                origin_mm,
                direction: begun,
            } => {
                let way = begun * (sample.actual_mm - origin_mm);
                if direction != begun || way > limit {
                    self.phase = Phase::Travel { direction };
                }
                direction == begun && way < -limit
            }
            Phase::Arrival { .. } | Phase::Travel { .. } => {
                self.phase = Phase::Travel { direction };
                false
            }
        }
    }

    /// Moves otherwise than the voltage says, while that is at least MP1140.
    fn moves_otherwise(&mut self, sample: &Sample, settings: &AxisSettings, timing: &Timing) -> bool {
        let threshold = settings.monitoring.movement_volts;
        if threshold >= OUTPUT_VOLTS || sample.volts.abs() < threshold {
            self.steps = 0;
            return false;
        }
        if self.steps == 0 {
            self.origin_mm = sample.actual_mm;
            self.calculated_mm = 0.0;
        }
        let moved = sample.actual_mm - self.origin_mm;
        let differs = (self.calculated_mm - moved).abs() > self.calculated_mm.abs() * MOVEMENT_TOLERANCE;
        let complete = self.steps == self.window_steps;
        if complete {
            self.steps = 1;
            self.origin_mm = sample.actual_mm;
            self.calculated_mm = 0.0;
        } else {
            self.steps += 1;
        }
        self.calculated_mm += sample.velocity_mm_min * timing.step_min();
        complete && differs
    }
}
