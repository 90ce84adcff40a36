//! What the loops of an axis are told of their machine, in physical units.
//!
//! Whoever has machine parameters makes these settings of them; the numbers beside a field are those of a TNC. mm stands for
//! mm or degrees, mm/min for mm/min or degrees/min, as the axis is.

/// The settings of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSettings {
    /// Signal period and checks of the encoder.
    pub encoder: EncoderSettings,
    /// Which marks the encoder has, and their spacing.
    pub marks: MarkSettings,
    /// Sign and scale of the voltage to the drive.
    pub output: OutputSettings,
    /// Rapid traverse and acceleration.
    pub motion: MotionSettings,
    /// Operation with servo lag.
    pub lag: LagSettings,
    /// Operation with feed pre-control.
    pub precontrol: PrecontrolSettings,
    /// Monitoring that both kinds of operation share.
    pub monitoring: MonitoringSettings,
    /// Compensation of the mechanics' errors.
    pub compensation: CompensationSettings,
    /// Digital speed controller, where the axis has one.
    pub digital: Option<SpeedLoopSettings>,
}

/// How a slave follows its master [000:4455-4535].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CouplingSettings {
    /// Greatest difference to the master, mm, `None` without monitoring: MP855.
    pub difference_mm: Option<f64>,
    /// The relation is that of the reference marks, not that at switch-on: MP860 = 1.
    pub from_reference_marks: bool,
}

/// How fast an axis may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSettings {
    /// Rapid traverse, mm/min: MP1010 [000:4836-4841].
    pub rapid_mm_min: f64,
    /// Acceleration, m/s², for a rotary axis 1000 degrees/s²: MP1060 [000:4790-4797].
    pub acceleration_m_s2: f64,
}

/// The reference marks of a measuring system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkSettings {
    /// How the mark is found: MP1350 [000:4656-4667].
    pub kind: MarkKind,
    /// Spacing of distance-coded marks, mm.
    pub spacing_mm: f64,
}

/// Measuring system of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderSettings {
    /// Signal period, µm or 1/1000 degree: MP330, 0.1 to 1000 (old: 20 or 10 by MP12+, 20-fold or 10-fold
    /// evaluation to 1 µm) [000:3188-3236] [001:1616-1625].
    pub signal_period_um: f64,
    /// The input takes square-wave signals, which are evaluated fourfold [000:3206-3214].
    pub square_wave: bool,
    /// Factor of the external interpolation electronics: MP340, TNC 407 only; 1 elsewhere and for 0
    /// [000:3238-3250].
    pub interpolation: u8,
    /// The signals count negative: MP210 (old MP20+) [000:3256-3265].
    pub counts_negative: bool,
    /// Check of the absolute position of distance-coded marks, error letter C: MP30 [000:3301-3308].
    pub check_distance_code: bool,
    /// Check of the signal amplitude, letter A: MP31 (old: MP76 bits 1 to 4 switch it off)
    /// [000:3310-3318] [001:1338-1380].
    pub check_amplitude: bool,
    /// Check of the edge separation, letter B: MP32 (old: as the amplitude) [000:3320-3328].
    pub check_edges: bool,
}

/// Nominal value output of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputSettings {
    /// Positive traverse needs a negative voltage: MP1040 (old MP24+) [000:3267-3276].
    pub polarity_negative: bool,
    /// Voltage at rapid traverse, V: MP1050, 1 to 9, commissioning 9 (old MP52) [000:4842-4847].
    pub rapid_volts: f64,
    /// Integral factor at standstill: MP1080, 0 to 65 535, 0 with backlash (old MP28+) [000:5039-5072].
    pub integral_factor: f64,
}

/// Operation with servo lag. Lag = feed / kv below the kink, above it the slope is kv times the factor
/// [000:4799-4809] [000:4898-4925].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LagSettings {
    /// kv, (m/min)/mm: MP1810, 0.1 to 20, commissioning 1 (old MP177+) [000:4824-4829].
    pub kv: f64,
    /// kv after M105, (m/min)/mm: MP1815, old: as `kv` [000:4830-4835].
    pub kv_m105: f64,
    /// Factor for kv above the kink: MP1820, 0.001 to 1 (old MP176) [000:4909-4916].
    pub kink_factor: f64,
    /// Kink, % of rapid traverse: MP1830, 0 to 100 (old MP181) [000:4918-4925].
    pub kink_percent: f64,
    /// Part of the speed of the nominal position that is put out in advance, 0 to 1: so much smaller is the lag. 0 on a TNC.
    pub feed_forward: f64,
    /// Lag at which POSITIONING ERROR comes, mm: MP1710, 0 to 300, recommended 1.2 times the lag at rapid
    /// traverse (old MP175) [000:5208-5215].
    pub monitoring_mm: f64,
    /// Lag at which GROSS POSITIONING ERROR A comes, mm: MP1720, 0 to 300, recommended 1.4 times it (old
    /// MP174) [000:5217-5224].
    pub emergency_mm: f64,
}

impl LagSettings {
    /// The speed that the lag gives, with what of the speed of the nominal position is put out in advance, mm/min.
    #[inline]
    pub(crate) fn in_advance(&self, control: f64, profile: f64) -> f64 {
        match self.feed_forward {
            0.0 => control,
            part => control + part * profile,
        }
    }
}

/// Operation with feed pre-control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecontrolSettings {
    /// kv, (m/min)/mm: MP1510, 0.1 to 20, commissioning 1 [000:4984-4991]. Old: from MP32+, output steps of
    /// 9 V/3686.4 for each µm of lag: kv = factor / 3.6864 * 9 V / MP52 * rapid traverse in m/min (inferred
    /// from the table [001:1746-1762]).
    pub kv: f64,
    /// kv after M105, (m/min)/mm: MP1515; old: as `kv` [000:4993-5000].
    pub kv_m105: f64,
    /// Transient response, m/min: MP1520, 0.1 to 10, commissioning 0.5; larger is faster (old MP53, the
    /// approach speed 1 µm before the position) [000:4981-4982] [001:1735-1736].
    pub transient_m_min: f64,
    /// Damping of the transient when accelerating: MP1530, 0.01 to 0.999 (old MP64) [000:4977-4979].
    pub damping: f64,
    /// Velocity below which the positioning window is checked, mm/min: MP1525, 0.1 to 10; 0.5 before it
    /// existed [000:5306-5318]. Infinite on the TNC 151/155, of which no manual says so.
    pub window_mm_min: f64,
    /// Deviation at which POSITIONING ERROR comes, mm: MP1410, 0.001 to 30, recommended 0.5 (old MP56)
    /// [000:5244-5249].
    pub monitoring_mm: f64,
    /// Deviation at which GROSS POSITIONING ERROR A comes, mm: MP1420, 0.001 to 30, recommended 10 (old
    /// MP57) [000:5250-5255].
    pub emergency_mm: f64,
}

/// Monitoring that both kinds of operation share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonitoringSettings {
    /// Positioning window, mm: MP1030, 0.0001 to 2, recommended 0.01 (old MP58, IV: MP192)
    /// [000:5302-5318].
    pub window_mm: f64,
    /// Standstill monitoring, letter D, mm: MP1110, 0.001 to 30, recommended 0.2 (old MP169)
    /// [000:5289-5300].
    pub standstill_mm: f64,
    /// Voltage from which movement is monitored, letter C, V: MP1140, 0.03 to 10, recommended 0.5; 10
    /// switches it off (old MP234) [000:5266-5287].
    pub movement_volts: f64,
    /// Time after POSITIONING ERROR in which the residual voltage is switched off, s: MP1150, 0 to 65.535
    /// (old MP185) [000:5240-5242].
    pub residual_voltage_s: f64,
}

/// Compensation of the mechanics' errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensationSettings {
    /// Backlash, mm: MP710, -1 to 1 (old MP36+) [000:3654-3661].
    pub backlash_mm: f64,
    /// Linear error, mm/m: MP720, -1 to 1 (old MP40+); 0 for rotary axes, where it does not act
    /// [000:3736-3749].
    pub linear_mm_m: f64,
    /// The error tables act in place of the linear error: MP730 [000:10124]; not on the TNC 151/155.
    pub nonlinear: bool,
    /// Height of the reversal peaks on circles, mm: MP711, and MP715 after M105 [000:3693-3732].
    pub reversal_mm: [f64; 2],
    /// Their compensation in each cycle of the loop, mm: MP712, and MP716 after M105 [000:3702-3732].
    pub reversal_step_mm: [f64; 2],
    /// Stiction: factor, µs: MP1511, 0 without [000:3935-3985].
    pub stiction_us: f64,
    /// Stiction: limit, counting steps of signal period / 256: MP1512 [000:3935-3985].
    pub stiction_limit_steps: f64,
    /// Stiction: feed up to which it is compensated, mm/min: MP1513 [000:3935-3985].
    pub stiction_feed_mm_min: f64,
}

/// Digital speed controller of the TNC 425 [000:10205-10218] [000:18345-18640].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedLoopSettings {
    /// Monitoring limit, counting steps: MP1910, 1 to 16 777 215.
    pub monitoring_steps: f64,
    /// Integral component: MP1920, 0 to 65 535, recommended 50 to 100.
    pub integral: f64,
    /// Limit of the integral component, s: MP1925, 0 to 65.535, recommended 0.1 to 2.
    pub integral_limit_s: f64,
    /// Proportional component: MP1940, 0 to 65 535, recommended 50 to 200.
    pub proportional: f64,
    /// Acceleration pre-control, V/(m/s²): MP1945, 0 to 9.999.
    pub acceleration_v_m_s2: f64,
    /// The torque signal is negative: MP1950.
    pub polarity_negative: bool,
    /// The position comes from the motor's encoder: MP1951, for trimming only.
    pub motor_encoder: bool,
    /// Grating period of the scale divided by that of the motor's encoder: MP1955, 0.1 to 100.
    pub encoder_ratio: f64,
    /// Height of the reversal peaks, mm: MP1960, -1 to 1.
    pub reversal_mm: f64,
    /// Difference of position and speed encoder that is an error, mm, `None` without: MP1970.
    pub difference_mm: Option<f64>,
    /// Time that the controller stays on in an EMERGENCY STOP, s: MP1980, 0 to 1.9999.
    pub emergency_stop_s: f64,
}

/// How an axis finds its reference mark: MP1350 [000:4656-4667].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// 0: distance-coded marks, the sequence before 1/92.
    DistanceCodedOld,
    /// 1: one mark, which lies before the cam.
    OneMark,
    /// 2: rotary encoder on a ballscrew, one pulse for each turn; the cam chooses the pulse.
    RotaryEncoder,
    /// 3: distance-coded marks, the sequence from 1/92 on.
    DistanceCoded,
    /// TNC 151/155, MP242+ = 0: the mark lies under the closed cam; of several the one whose pulse is not inhibited
    /// [001:957-969].
    UnderCam,
    /// TNC 151/155, MP242+ greater than 0: distance-coded marks, which count while the cam is open [001:977-987].
    DistanceCodedBesideCam,
}

impl MarkKind {
    /// Two neighbouring marks tell where they are.
    pub fn is_coded(self) -> bool {
        matches!(
            self,
            MarkKind::DistanceCodedOld | MarkKind::DistanceCoded | MarkKind::DistanceCodedBesideCam
        )
    }
}
