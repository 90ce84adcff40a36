//! What the loop of a spindle is told of it, in physical units; the numbers beside a field are those of a TNC.

/// Gear ranges of a spindle.
pub const GEARS: usize = 8;

/// Voltages, gears, ramps and orientation of a spindle, as machine parameters say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleSettings {
    /// Speed 0 may be programmed: MP3120 = 0 (old MP190 = 0) [000:5566] [001:1573-1575].
    pub zero_permitted: bool,
    /// Polarity of the voltage: MP3130 (old MP172) [000:5502-5506].
    pub polarity: SpindlePolarity,
    /// The encoder counts negative with M03: MP3140 (old MP239) [000:5508-5511].
    pub counts_negative: bool,
    /// Check of the encoder's signal amplitude, letter A: MP31 bit 5; old: none [000:3310-3318].
    pub check_amplitude: bool,
    /// Check of the encoder's edge separation, letter B: MP32 bit 5; old: none [000:3320-3328].
    pub check_edges: bool,
    /// The gear ranges, speeds ascending; those that are not used have rated speed 0 [000:5522-5564].
    pub gears: [Gear; GEARS],
    /// Least voltage, V: MP3240.1, 0 to 9.999 (old MP184) [000:5565].
    pub min_volts: f64,
    /// Greatest voltage, V: 10 (old MP87) [000:5258] [001:1502-1536].
    pub max_volts: f64,
    /// Voltage in which the spindle jogs while the gear changes, V: MP3240.2, 0 to 9.999 (old MP70)
    /// [000:5636-5641].
    pub jog_volts: f64,
    /// Least and greatest override, %: MP3310.1 and .0, 0 to 150 (old MP89, MP88) [000:5585-5589].
    pub override_percent: [f64; 2],
    /// Ramps; a ramp of 0 V/ms is none.
    pub ramps: SpindleRamps,
    /// Speeds, window and reference mark of the oriented stop.
    pub orientation: OrientationSettings,
    /// Rigid tapping: how the tool axis follows the angle of the spindle.
    pub lead: LeadSettings,
}

/// How the angle of a spindle is led in rigid tapping [000:6120-6141].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeadSettings {
    /// Rigid tapping: run-in of the spindle, degrees/min: MP7130, 0.001 to 10; old: none, 0.
    pub run_in_deg_min: f64,
    /// Rigid tapping: transient response on acceleration: MP7140, 0.001 to 1; old: none, 0.
    pub transient: f64,
}

/// Polarity of the spindle's voltage: MP3130 (old MP172) [000:5502-5506].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindlePolarity {
    /// 0: M03 positive, M04 negative.
    M3Positive,
    /// 1: M03 negative, M04 positive.
    M3Negative,
    /// 2: M03 and M04 positive.
    BothPositive,
    /// 3: M03 and M04 negative.
    BothNegative,
}

/// Limits of the S code: MP3020, five digits `mmMMs` [000:5718-5745].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpeedCodes {
    /// Least code, 0 to 99.
    pub min: u8,
    /// Greatest code, 0 to 99.
    pub max: u8,
    /// Step of the codes, 1 to 9.
    pub step: u8,
}

/// A gear range [000:5522-5564].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gear {
    /// Speed at override 100 %, rpm: MP3510 (old MP78-85).
    pub rated_rpm: f64,
    /// Voltage at that speed, V: MP3210, 0 to 9.999 (old MP86, one for all).
    pub rated_volts: f64,
    /// Highest speed, which the override does not pass, rpm: MP3515 (old: the speed at MP87 volts). 0 stands
    /// for the rated speed (inferred).
    pub max_rpm: f64,
    /// kv of the orientation, (1000 degrees/min)/degree: MP3440, 0.1 to 10 (old MP238)
    /// [000:5913-5931].
    pub kv: f64,
}

/// Ramps of the spindle's voltage, V/ms: MP3410, 0 to 1.9999; on the TNC 151/155 all are MP168
/// [000:5534] [001:1567-1570].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleRamps {
    /// M03, M04, M05: MP3410.0.
    pub normal_v_ms: f64,
    /// Oriented stop: MP3410.1.
    pub orientation_v_ms: f64,
    /// Tapping with a floating holder: MP3410.2.
    pub tapping_v_ms: f64,
    /// Rigid tapping: MP3410.3.
    pub rigid_v_ms: f64,
}

/// Orientation of the spindle [000:5851-5939].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientationSettings {
    /// Positioning window, degrees: MP3420 increments of 360/4096 degree (old MP246).
    pub window_deg: f64,
    /// Position of the reference mark, degrees: MP3430, 0 to 360 (old MP240).
    pub reference_deg: f64,
    /// Speed while M2501 turns the spindle, rpm: MP3520.0 (old MP258).
    pub jog_rpm: f64,
    /// Speed of the orientation, rpm: MP3520.1 (old MP248).
    pub speed_rpm: f64,
}
