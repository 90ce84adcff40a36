//! The loop of a spindle, and what a path asks of it: to be oriented, to lead a thread, to turn on another ramp.

use bahn_parameters::spindle::{FreeOutput, SpindleOutput, SpindleParameters, TappingParameters};
use bahn_servo::spindle_settings::{
    GEARS, Gear, LeadSettings, OrientationSettings, SpeedCodes, SpindlePolarity, SpindleRamps,
    SpindleSettings,
};
use bahn_servo::{Fault, Measured, Ramp, Spindle, Timing, Way};

/// Degrees per second of one rpm.
const DEG_S_PER_RPM: f64 = 6.0;

/// Where a spindle is connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpindleWiring {
    /// Place of its analogue output among the machine's, from 0.
    pub output: usize,
    /// Place of its encoder among the machine's inputs, from 0.
    pub input: usize,
}

impl Default for SpindleWiring {
    /// Output S [000:3393-3406] and encoder input X6 [000:3376].
    fn default() -> SpindleWiring {
        SpindleWiring { output: 5, input: 5 }
    }
}

/// A spindle with its position loop, and what threads want of it.
#[derive(Clone, Debug)]
pub struct SpindleLoop {
    /// Where it is connected.
    pub wiring: SpindleWiring,
    /// What the machine builder says of it.
    pub parameters: SpindleParameters,
    /// Its speed and position loop, which gives the voltage to the drive.
    pub servo: Spindle,
    /// The path of a thread leads it.
    led: bool,
}

impl SpindleLoop {
    /// A spindle that stands.
    pub fn new(wiring: SpindleWiring, parameters: SpindleParameters, timing: Timing) -> SpindleLoop {
        SpindleLoop {
            wiring,
            servo: Spindle::new(parameters.settings, timing),
            parameters,
            led: false,
        }
    }

    /// In the place of a spindle where no path leads one.
    pub fn none(timing: Timing) -> SpindleLoop {
        let parameters = SpindleParameters {
            output: SpindleOutput::None,
            controlled: false,
            input: 0,
            free_output: FreeOutput::None,
            codes: SpeedCodes {
                min: 0,
                max: 0,
                step: 1,
            },
            axes_run_on: true,
            comparator_rpm: None,
            settings: SpindleSettings {
                zero_permitted: true,
                polarity: SpindlePolarity::M3Positive,
                counts_negative: false,
                check_amplitude: false,
                check_edges: false,
                gears: [Gear::default(); GEARS],
                min_volts: 0.0,
                max_volts: 0.0,
                jog_volts: 0.0,
                override_percent: [0.0, 100.0],
                ramps: SpindleRamps {
                    normal_v_ms: 0.0,
                    orientation_v_ms: 0.0,
                    tapping_v_ms: 0.0,
                    rigid_v_ms: 0.0,
                },
                orientation: OrientationSettings {
                    window_deg: 1.0,
                    reference_deg: 0.0,
                    jog_rpm: 0.0,
                    speed_rpm: 0.0,
                },
                lead: LeadSettings {
                    run_in_deg_min: 0.0,
                    transient: 0.0,
                },
            },
            tapping: TappingParameters {
                override_percent: [100.0; 2],
                reversal_dwell_s: 0.0,
                coded_lead_s: 0.0,
                run_on_s: 0.0,
                window_mm: 0.0,
                orientation: false,
            },
        };
        SpindleLoop::new(SpindleWiring::default(), parameters, timing)
    }

    /// Takes changed machine parameters over.
    pub fn set_parameters(&mut self, parameters: SpindleParameters) {
        self.servo.configure(parameters.settings);
        self.parameters = parameters;
    }

    /// The path of a thread leads it.
    pub fn is_led(&self) -> bool {
        self.led
    }

    /// Its speed, rpm, negative as M04.
    pub fn actual_rpm(&self) -> f64 {
        self.servo.actual_rpm()
    }

    /// Reads its encoder, once in each servo step.
    pub fn measure(&mut self, measured: &Measured) {
        self.servo.measure(measured.encoder(self.wiring.input));
    }

    /// A fault of its encoder, or of its movement in a thread.
    pub fn fault(&self) -> Option<Fault> {
        self.servo.fault()
    }

    /// It can be led by a path: analogue output and an encoder [000:6056] [000:5444-5472].
    pub fn can_be_led(&self) -> bool {
        matches!(self.parameters.output, SpindleOutput::Analogue { .. }) && self.parameters.controlled
    }

    /// Orients for a thread or the tool probe: from standstill by the shorter way [000:623].
    pub fn orient_shortest(&mut self, angle_deg: f64) {
        self.servo.orient(angle_deg, 0.0, Way::Shortest);
    }

    /// An orientation is on its way, or holds the spindle: nothing has ended it since it was asked for.
    pub fn holds_orientation(&self) -> bool {
        self.servo.orienting() || self.servo.in_position()
    }

    /// Leads it for a contour cycle along a thread; `None` when the thread is over: it stays where it is.
    pub fn lead(&mut self, angle_deg: Option<f64>) {
        self.led = angle_deg.is_some();
        if let Some(angle) = angle_deg {
            self.servo.lead(angle);
        }
    }

    /// A thread goes on from where it stands.
    pub fn lead_from_here(&mut self) {
        self.servo.lead_from_here();
    }

    /// In a thread it may turn so far beside what it is led, degrees; `None` where nothing follows it.
    pub fn monitor_movement(&mut self, most_deg: Option<f64>) {
        self.servo.monitor_movement(most_deg);
    }

    /// The ramp of M03, M04 and M05 while cycle 2 taps, `None` otherwise: MP3410.2, or flatter, so that it stands
    /// with a feed that takes `braking_s` to brake [000:6068-6079].
    pub fn set_tapping(&mut self, braking_s: Option<f64>) {
        self.servo.set_ramp(match braking_s {
            None => Ramp::Normal,
            Some(braking) => {
                let flat = self.servo.programmed_volts() / (braking * 1000.0);
                let own = self.parameters.settings.ramps.tapping_v_ms;
                if flat > 0.0 && (own == 0.0 || flat < own) {
                    Ramp::Volts(flat)
                } else {
                    Ramp::Tapping
                }
            }
        });
    }

    /// Angle with all turns, degrees: where it is held, and where it will be after a time, s.
    pub fn angles_deg(&self, after_s: f64) -> [f64; 2] {
        let will_be = self.servo.turned_deg() + self.servo.actual_rpm() * DEG_S_PER_RPM * after_s;
        [self.servo.held_deg(), will_be]
    }

    /// It stands in the window of its orientation.
    pub fn is_oriented(&self) -> bool {
        let missing = (self.servo.held_deg() - self.servo.turned_deg()).abs();
        self.servo.in_position() && missing <= self.parameters.settings.orientation.window_deg
    }

    /// The part of the programmed speed that override and limits leave, %.
    pub fn effective_percent(&self) -> f64 {
        100.0 * self.servo.effective_override()
    }

    /// The PLC gives the spindle enable: M2608 [000:5500].
    pub fn is_enabled(&self) -> bool {
        self.servo.is_enabled()
    }

    /// Positioning window of the tool axis in a thread, mm: MP7150.
    pub fn thread_window_mm(&self) -> f64 {
        self.parameters.tapping.window_mm
    }

    /// Angle of the spindle, degrees, once its reference mark was crossed.
    pub fn angle_deg(&self) -> Option<f64> {
        self.servo.angle_deg()
    }

    /// Angle since power-on with all turns, degrees.
    pub fn turned_deg(&self) -> f64 {
        self.servo.turned_deg()
    }
}
