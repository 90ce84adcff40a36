//! An ideal machine under an axis: the drive follows its voltage at once.
#![allow(dead_code, reason = "not every test uses every helper")]
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

use bahn_parameters::{ControlModel, ParameterList};
use bahn_servo::settings::AxisSettings;
use bahn_servo::{Axis, Encoder, Method, Timing};

/// Mechanics without errors, and a drive without offset.
const NO_ERRORS: [&str; 5] = ["710.0=0", "711.0=0", "715.0=0", "720.0=0", "1080.0=0"];

/// The settings of the X axis of a model's reference list, without errors, with some parameters changed.
pub fn settings(model: ControlModel, assignments: &[&str]) -> AxisSettings {
    let mut list = ParameterList::reference(model);
    for assignment in NO_ERRORS.iter().chain(assignments) {
        list.assign(assignment).unwrap();
    }
    list.axis_parameters(0).settings()
}

/// An axis on its machine: a drive whose speed is its voltage, and an encoder that counts the way.
#[derive(Clone)]
pub struct Bench {
    pub axis: Axis,
    pub timing: Timing,
    pub encoder: Encoder,
    /// Position of the table, mm.
    pub table_mm: f64,
    /// Offset of the drive, V.
    pub offset_volts: f64,
    /// Time constant of the drive, s; 0 is the ideal one.
    pub drive_s: f64,
    /// Velocity of the table, mm/min.
    pub velocity_mm_min: f64,
    /// The table does not move.
    pub blocked: bool,
    /// mm/min for 1 V.
    pub mm_min_per_volt: f64,
    /// Counting steps for 1 mm.
    pub steps_per_mm: f64,
}

impl Bench {
    pub fn new(model: ControlModel, assignments: &[&str]) -> Bench {
        let settings = settings(model, assignments);
        let timing = model.timing();
        let polarity = if settings.output.polarity_negative {
            -1.0
        } else {
            1.0
        };
        let direction = if settings.encoder.counts_negative {
            -1.0
        } else {
            1.0
        };
        let mut axis = Axis::new(settings, timing);
        axis.measure(Encoder::default());
        axis.close();
        Bench {
            axis,
            timing,
            encoder: Encoder::default(),
            table_mm: 0.0,
            offset_volts: 0.0,
            drive_s: 0.0,
            velocity_mm_min: 0.0,
            blocked: false,
            mm_min_per_volt: polarity * settings.motion.rapid_mm_min / settings.output.rapid_volts,
            steps_per_mm: direction * Encoder::STEPS as f64 / (settings.encoder.signal_period_um * 1e-3),
        }
    }

    pub fn with_precontrol(model: ControlModel, assignments: &[&str]) -> Bench {
        let mut bench = Bench::new(model, assignments);
        bench.axis.set_method(Method::Precontrol);
        bench
    }

    /// A contour cycle towards a position; `each` sees the axis after every servo step.
    pub fn cycle_with(&mut self, nominal_mm: f64, mut each: impl FnMut(&Axis, f64)) {
        self.axis.command(nominal_mm);
        for _ in 0..self.timing.steps() {
            self.encoder.count = (self.table_mm * self.steps_per_mm).round() as i64;
            self.axis.measure(self.encoder);
            let volts = self.axis.step();
            each(&self.axis, self.table_mm);
            if !self.blocked {
                let nominal = (volts + self.offset_volts) * self.mm_min_per_volt;
                let step_s = f64::from(self.timing.step_us()) * 1e-6;
                let follows = if self.drive_s > 0.0 {
                    1.0 - (-step_s / self.drive_s).exp()
                } else {
                    1.0
                };
                self.velocity_mm_min += (nominal - self.velocity_mm_min) * follows;
                self.table_mm += self.velocity_mm_min * step_s / 60.0;
            }
        }
    }

    pub fn cycle(&mut self, nominal_mm: f64) {
        self.cycle_with(nominal_mm, |_, _| {});
    }

    /// Moves at a constant feed from the present target for a time, s.
    pub fn run(&mut self, feed_mm_min: f64, seconds: f64) {
        let cycle_min = f64::from(self.timing.contour_us()) / 60e6;
        let start = self.axis.target_mm();
        for cycle in 1..=self.cycles(seconds) {
            self.cycle(start + feed_mm_min * cycle_min * f64::from(cycle));
        }
    }

    /// Positions over a way with a trapezoidal velocity profile, as the path planning would.
    pub fn position(&mut self, distance_mm: f64, feed_mm_min: f64, acceleration_m_s2: f64) {
        let start = self.axis.target_mm();
        let acceleration = acceleration_m_s2 * 1e3;
        let speed = (feed_mm_min / 60.0).min((acceleration * distance_mm.abs()).sqrt());
        let (ramp_s, whole_s) = (
            speed / acceleration,
            distance_mm.abs() / speed + speed / acceleration,
        );
        for cycle in 1..=self.cycles(whole_s) + 1 {
            let time = (f64::from(cycle) * f64::from(self.timing.contour_us()) * 1e-6).min(whole_s);
            let left = whole_s - time;
            let way = if time < ramp_s {
                acceleration * time * time / 2.0
            } else if left < ramp_s {
                distance_mm.abs() - acceleration * left * left / 2.0
            } else {
                speed * (time - ramp_s / 2.0)
            };
            self.cycle(start + way.copysign(distance_mm));
        }
        self.cycle(start + distance_mm);
    }

    /// Stands for a time, s.
    pub fn stand(&mut self, seconds: f64) {
        self.run(0.0, seconds);
    }

    /// Contour cycles of a time in s.
    pub fn cycles(&self, seconds: f64) -> u32 {
        (seconds * 1e6 / f64::from(self.timing.contour_us())).round() as u32
    }
}
