//! The main spindle: speed, gear, ramps, orientation [000:5438-5945].
//!
//! Decision: A spindle turns when it is faster than its loop is at the edge of the window MP3420; slower it stands,
//! and an orientation goes the way that is asked

mod encoder;
mod lead;
mod movement;
mod orientation;
mod pace;
mod rotation;
pub mod settings;
mod speed;
mod speed_code;

use settings::{Gear, SpindleSettings};

use crate::characteristic::KV_PER_MIN;
use crate::fault::{Fault, GrossFault};
use crate::plant::Encoder;
use crate::timing::{OUTPUT_VOLTS, Timing};
use encoder::SpindleEncoder;
use lead::Lead;
use movement::Movement;
use orientation::{Dynamics, Orientation, Phase};

pub use rotation::Rotation;
pub use speed_code::SpeedCode;

/// Time in position before the offset is adjusted after an orientation, s [000:5716].
const OFFSET_WAIT_S: f64 = 2.0;
/// Interval of the adjustments after that, s [000:719].
const OFFSET_INTERVAL_S: f64 = 1.0;
/// One adjustment, V: 0.152 mV [000:719].
const OFFSET_STEP_VOLTS: f64 = OUTPUT_VOLTS / 65_536.0;

/// Slope of the spindle's voltage: MP3410.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ramp {
    /// M03, M04, M05: MP3410.0.
    Normal,
    /// Tapping with a floating holder: MP3410.2.
    Tapping,
    /// As flat as a feed ramp that the spindle has to follow, V/ms [000:6070].
    Volts(f64),
}

/// How an orientation turns [000:16120-16160].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// In the direction of M03, or of M04.
    In(Rotation),
    /// In the direction in which the angle is nearer.
    Shortest,
}

/// What the spindle does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// It turns at the programmed speed, or stands after M05.
    Speed(Rotation),
    /// Voltage MP3240.2 while the gear changes.
    Jog(Rotation),
    /// Speed MP3520.0 while M2501 is set.
    Turn(Rotation),
    Orientation(Orientation),
    /// The angles that [`Spindle::lead`] gives.
    Lead,
}

/// The spindle with analogue output: speed in, voltage out; with an encoder also its angle.
///
/// In each servo step [`Spindle::measure`] takes the encoder in and [`Spindle::step`] gives the voltage.
/// Angles are degrees, positive in the direction of M03. Nothing here allocates.
#[derive(Clone, Debug)]
pub struct Spindle {
    settings: SpindleSettings,
    timing: Timing,
    encoder: SpindleEncoder,
    mode: Mode,
    gear: u8,
    programmed_rpm: f64,
    override_percent: f64,
    ramp: Ramp,
    inverted: bool,
    enabled: bool,
    opens: bool,
    lead: Lead,
    movement: Movement,
    /// So far it may turn beside what it is led, degrees.
    beside_max_deg: Option<f64>,
    /// The nominal value on its ramp, before offset and converter.
    ramp_volts: f64,
    goal_volts: f64,
    offset_volts: f64,
    volts: f64,
    /// The voltage is where it goes to and nothing has been asked since: it stays.
    settled: bool,
    fault: Option<Fault>,
}

impl Spindle {
    /// A spindle that is off, in the lowest gear range.
    pub fn new(settings: SpindleSettings, timing: Timing) -> Spindle {
        Spindle {
            settings,
            timing,
            encoder: SpindleEncoder::default(),
            mode: Mode::Speed(Rotation::M5),
            gear: 0,
            programmed_rpm: 0.0,
            override_percent: 100.0,
            ramp: Ramp::Normal,
            inverted: false,
            enabled: true,
            opens: false,
            lead: Lead::new(&settings, &timing),
            movement: Movement::default(),
            beside_max_deg: None,
            ramp_volts: 0.0,
            goal_volts: 0.0,
            offset_volts: 0.0,
            volts: 0.0,
            settled: false,
            fault: None,
        }
    }

    /// Takes changed settings over (those that the PLC may change).
    pub fn configure(&mut self, settings: SpindleSettings) {
        self.settled = false;
        self.settings = settings;
        self.lead.configure(&settings, &self.timing);
    }

    /// The gear range for a programmed speed in rpm, 0 to 7: the smallest that reaches it. `None` for a speed
    /// that the spindle does not have, also 0 where MP3120 does not permit it: WRONG RPM [000:5653].
    pub fn gear_for(&self, rpm: f64) -> Option<u8> {
        speed::gear_for(&self.settings, rpm)
    }

    /// Sets programmed speed, rpm, and gear range, 0 to 7.
    pub fn set_speed(&mut self, rpm: f64, gear: u8) {
        self.settled = false;
        self.programmed_rpm = if rpm.is_finite() { rpm.max(0.0) } else { 0.0 };
        self.gear = gear;
    }

    /// Sets the override, %: limited by MP3310, its effect by MP3515.
    pub fn set_override(&mut self, percent: f64) {
        self.settled &= self.override_percent == percent;
        self.override_percent = percent;
    }

    /// Switches the spindle on or off: M2485 to M2487. It ends jog and orientation.
    pub fn rotate(&mut self, rotation: Rotation) {
        self.go_over(Mode::Speed(rotation));
    }

    /// Chooses the ramp of M03, M04 and M05.
    pub fn set_ramp(&mut self, ramp: Ramp) {
        self.ramp = ramp;
    }

    /// Jogs for a gear change, M2490 left (as M04, inferred) and M2491 right; `M5` stands still
    /// [000:5636-5641].
    pub fn jog(&mut self, rotation: Rotation) {
        self.go_over(Mode::Jog(rotation));
    }

    /// Turns at MP3520.0 while M2501 is set, in the direction of M2656; `M5` when it is reset
    /// [000:5888-5895].
    pub fn turn(&mut self, rotation: Rotation) {
        self.go_over(Mode::Turn(rotation));
    }

    fn go_over(&mut self, mode: Mode) {
        self.settled = false;
        self.mode = mode;
    }

    /// Turns the polarity of the voltage round: M2489 [000:5492].
    pub fn set_inverted(&mut self, inverted: bool) {
        self.settled &= self.inverted == inverted;
        self.inverted = inverted;
    }

    /// Gives or withdraws the spindle enable; without it the output is 0 V at once: M2608 [000:5500].
    pub fn set_enabled(&mut self, enabled: bool) {
        self.settled &= self.enabled == enabled;
        self.enabled = enabled;
    }

    /// Whether it has the spindle enable.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Orients the spindle: to an angle in degrees, at a speed in rpm (0 is MP3520.1).
    ///
    /// A turning spindle keeps its direction, slows down along MP3410.1 and stops at the angle. A standing
    /// one goes the way said, and the shorter one when it is within the window MP3420 already
    /// [000:5867-5873] [000:16120-16160].
    pub fn orient(&mut self, angle_deg: f64, rpm: f64, way: Way) {
        let turning = self.turning();
        let direction = match way {
            _ if turning != 0.0 => turning.signum(),
            Way::In(rotation) => rotation.sign(),
            Way::Shortest => 0.0,
        };
        let orientation = Orientation {
            angle_deg: if angle_deg.is_finite() { angle_deg } else { 0.0 },
            rpm: if rpm > 0.0 {
                rpm
            } else {
                self.settings.orientation.speed_rpm
            },
            direction,
            phase: Phase::Approach,
            reached: false,
            steps: 0,
        };
        self.go_over(Mode::Orientation(orientation));
        if turning == 0.0 {
            self.enter_loop(orientation, 0.0);
        }
    }

    /// Turns a spindle that stands by a distance in degrees from where it is held, at MP3520.1; the reference mark need not
    /// be known. `false` for one that turns.
    pub fn turn_by(&mut self, turn_deg: f64) -> bool {
        if self.turning() != 0.0 || !turn_deg.is_finite() {
            return false;
        }
        let target_deg = self.held_deg() + turn_deg;
        self.go_over(Mode::Orientation(Orientation {
            angle_deg: target_deg,
            rpm: self.settings.orientation.speed_rpm,
            direction: turn_deg.signum(),
            phase: Phase::Controlled { target_deg },
            reached: false,
            steps: 0,
        }));
        true
    }

    /// How it turns, degrees/min, positive as M03; 0 for a spindle that stands. What a loop does to hold it in its place
    /// is no turning, nor is a speed with which a loop still comes to a standstill within the window (inferred).
    fn turning(&self) -> f64 {
        let settings = &self.settings.orientation;
        let slow = self.dynamics(settings.speed_rpm).velocity(settings.window_deg);
        match self.mode {
            Mode::Lead => self.lead.profile_deg_min(),
            Mode::Orientation(orientation) if orientation.reached => 0.0,
            _ => Some(self.encoder.rpm() * 360.0)
                .filter(|speed| speed.abs() > slow)
                .unwrap_or(0.0),
        }
    }

    /// Leads the spindle to an angle on the scale of [`Spindle::turned_deg`] for the end of the contour cycle
    /// that begins; once in each of them, before its first servo step. The angles bring their own ramps. It
    /// stays led, and stands at the last one, until something else is asked of it.
    pub fn lead(&mut self, angle_deg: f64) {
        if self.mode != Mode::Lead {
            // What holds it is asked of the mode that ends.
            let held_deg = self.held_deg();
            let gear = self.gear();
            let held_rpm = if gear.rated_volts > 0.0 {
                self.physical_sign() * self.ramp_volts / gear.rated_volts * gear.rated_rpm
            } else {
                0.0
            };
            self.go_over(Mode::Lead);
            self.lead.begin(held_deg, held_rpm * 360.0);
        }
        if angle_deg.is_finite() {
            self.lead.command(angle_deg);
        }
    }

    /// A spindle that is led stands somewhere else than it was led to: it is led from there.
    pub fn lead_from_here(&mut self) {
        if self.mode == Mode::Lead {
            let held = self.lead.velocity_deg_min();
            self.lead.begin(self.encoder.turned_deg(), held);
        }
    }

    /// Monitors a spindle that is led: it may turn so far beside what it is told, degrees. `None` where it need not follow.
    pub fn monitor_movement(&mut self, most_deg: Option<f64>) {
        self.beside_max_deg = most_deg;
    }

    /// The angle where the loop holds the spindle, on the scale of [`Spindle::turned_deg`]; without a loop
    /// where it is.
    pub fn held_deg(&self) -> f64 {
        match self.mode {
            Mode::Lead => self.lead.target_deg(),
            Mode::Orientation(Orientation {
                phase: Phase::Controlled { target_deg },
                ..
            }) => target_deg,
            _ => self.encoder.turned_deg(),
        }
    }

    /// Whether the loop of an orientation opens as soon as the window is reached: M2499 [000:5875].
    pub fn set_opens(&mut self, opens: bool) {
        self.opens = opens;
    }

    /// Asks for the reference mark again: M2615 [000:5881].
    pub fn forget_mark(&mut self) {
        self.encoder.forget_mark();
    }

    /// Takes an encoder reading; once in each servo step, before [`Spindle::step`].
    pub fn measure(&mut self, encoder: Encoder) {
        let fault = self.encoder.read(encoder, &self.settings, &self.timing);
        self.fault = self.fault.or(fault.map(Fault::MeasuringSystem));
    }

    /// One servo step: the voltage for output S, V.
    pub fn step(&mut self) -> f64 {
        if self.settled {
            return self.volts;
        }
        if let Mode::Orientation(orientation) = self.mode {
            self.advance(orientation);
        }
        if self.mode == Mode::Lead {
            let slope = self.slope();
            let encoder = &self.encoder;
            self.lead
                .step(encoder.turned_deg(), encoder.rpm(), slope, &self.timing);
        }
        self.monitor();
        self.goal_volts = self.goal();
        let ramps = &self.settings.ramps;
        let ramp = match (self.mode, self.ramp) {
            (Mode::Lead, _) => 0.0,
            (Mode::Orientation(_) | Mode::Turn(_), _) => ramps.orientation_v_ms,
            (_, Ramp::Normal) => ramps.normal_v_ms,
            (_, Ramp::Tapping) => ramps.tapping_v_ms,
            (_, Ramp::Volts(volts)) => volts,
        };
        if !self.enabled {
            self.goal_volts = 0.0;
            self.ramp_volts = 0.0;
        } else if ramp > 0.0 {
            let part = ramp * f64::from(self.timing.step_us()) * 1e-3;
            self.ramp_volts += (self.goal_volts - self.ramp_volts).clamp(-part, part);
        } else {
            self.ramp_volts = self.goal_volts;
        }
        let offset = if self.enabled && self.is_controlled() {
            self.offset_volts
        } else {
            0.0
        };
        self.volts = self.timing.convert(self.ramp_volts + offset);
        let by_speed = matches!(self.mode, Mode::Speed(_) | Mode::Jog(_));
        self.settled = by_speed && !self.on_ramp();
        self.volts
    }

    /// Movement monitoring while it is led: where it turns farther beside that than it may, that is a gross positioning error.
    fn monitor(&mut self) {
        let actual = self.encoder.rpm() * 360.0;
        let most = self
            .beside_max_deg
            .filter(|_| self.mode == Mode::Lead && self.enabled);
        let Some(most) = most else {
            self.movement.begin(actual);
            return;
        };
        let ramp = self.deceleration(self.settings.ramps.rigid_v_ms);
        let commanded = self.lead.velocity_deg_min();
        if self.movement.step(commanded, actual, ramp, &self.timing) > most {
            self.fault = self.fault.or(Some(Fault::Gross(GrossFault::Movement)));
        }
    }

    /// The voltage that the ramp goes to.
    fn goal(&self) -> f64 {
        let settings = &self.settings;
        match self.mode {
            Mode::Speed(rotation) => {
                let volts = speed::volts(settings, &self.gear(), self.limited_rpm());
                volts * speed::polarity(settings, rotation, self.inverted)
            }
            Mode::Jog(rotation) => settings.jog_volts * speed::polarity(settings, rotation, self.inverted),
            Mode::Turn(rotation) => self.volts_of(settings.orientation.jog_rpm * 360.0 * rotation.sign()),
            Mode::Lead => self.volts_of(self.lead.velocity_deg_min()),
            Mode::Orientation(orientation) => match orientation.phase {
                Phase::Approach => self.volts_of(orientation.rpm * 360.0 * orientation.direction),
                Phase::Controlled { target_deg } => {
                    let way = target_deg - self.encoder.turned_deg();
                    self.volts_of(self.dynamics(orientation.rpm).velocity(way))
                }
            },
        }
    }

    /// Goes on with an orientation.
    fn advance(&mut self, mut orientation: Orientation) {
        match orientation.phase {
            Phase::Approach => {
                if orientation.direction == 0.0 {
                    // Nothing says the way to the reference mark: as M03 (inferred).
                    orientation.direction = 1.0;
                }
                self.mode = Mode::Orientation(orientation);
                if self.ramp_volts == self.goal() {
                    self.enter_loop(orientation, orientation.rpm * 360.0);
                }
            }
            Phase::Controlled { target_deg } => {
                let lag = target_deg - self.encoder.turned_deg();
                orientation.reached |= lag.abs() <= self.settings.orientation.window_deg;
                if orientation.reached {
                    orientation.steps = orientation.steps.saturating_add(1);
                    self.adjust_offset(lag, orientation.steps);
                }
                self.mode = Mode::Orientation(orientation);
            }
        }
    }

    /// Closes the loop at a speed in degrees/min, if the reference mark is known.
    fn enter_loop(&mut self, mut orientation: Orientation, speed: f64) {
        let Some(angle) = self.angle_deg() else {
            return;
        };
        let dynamics = self.dynamics(orientation.rpm);
        let mut way = dynamics.turn_deg(angle, orientation.angle_deg, speed, orientation.direction);
        let shortest = dynamics.turn_deg(angle, orientation.angle_deg, 0.0, 0.0);
        if speed == 0.0 && shortest.abs() <= self.settings.orientation.window_deg {
            way = shortest;
        }
        orientation.phase = Phase::Controlled {
            target_deg: self.encoder.turned_deg() + way,
        };
        self.mode = Mode::Orientation(orientation);
    }

    /// One adjustment two seconds after the window was reached, then one each second [000:719].
    fn adjust_offset(&mut self, lag_deg: f64, steps: u32) {
        let wait = self.timing.steps_of(OFFSET_WAIT_S);
        let interval = self.timing.steps_of(OFFSET_INTERVAL_S).max(1);
        let due = steps.checked_sub(wait).is_some_and(|since| since % interval == 0);
        let loop_volts = self.volts_of(lag_deg * self.slope());
        if due && !self.opens && loop_volts.abs() > OFFSET_STEP_VOLTS {
            self.offset_volts += OFFSET_STEP_VOLTS.copysign(loop_volts);
        }
    }

    fn gear(&self) -> Gear {
        let gear = self.settings.gears.get(usize::from(self.gear));
        gear.copied().unwrap_or_default()
    }

    fn limited_rpm(&self) -> f64 {
        speed::nominal_rpm(
            &self.settings,
            &self.gear(),
            self.programmed_rpm,
            self.override_percent,
        )
    }

    /// kv of the gear, 1/min.
    fn slope(&self) -> f64 {
        self.gear().kv * KV_PER_MIN
    }

    fn dynamics(&self, rpm: f64) -> Dynamics {
        let deceleration = self.deceleration(self.settings.ramps.orientation_v_ms);
        Dynamics {
            speed: rpm * 360.0,
            slope: self.slope(),
            deceleration: if deceleration > 0.0 {
                deceleration
            } else {
                f64::INFINITY
            },
        }
    }

    /// How fast a ramp, V/ms, changes the speed in the gear, degrees/min²; 0 without a ramp.
    fn deceleration(&self, ramp_v_ms: f64) -> f64 {
        let gear = self.gear();
        ramp_v_ms * 60_000.0 * gear.rated_rpm * 360.0 / gear.rated_volts
    }

    /// Sign of the voltage that turns the spindle as M03.
    fn physical_sign(&self) -> f64 {
        speed::polarity(&self.settings, Rotation::M3, self.inverted)
    }

    /// The voltage of a velocity in degrees/min, in the loop: no least voltage, both polarities.
    fn volts_of(&self, deg_min: f64) -> f64 {
        let gear = self.gear();
        if gear.rated_rpm <= 0.0 {
            return 0.0;
        }
        let volts = deg_min / 360.0 * gear.rated_volts / gear.rated_rpm;
        let open = self.opens && self.in_position();
        if open { 0.0 } else { self.physical_sign() * volts }
    }

    /// Whether the position loop is closed.
    fn is_controlled(&self) -> bool {
        let Mode::Orientation(orientation) = self.mode else {
            return self.mode == Mode::Lead;
        };
        matches!(orientation.phase, Phase::Controlled { .. }) && !(self.opens && orientation.reached)
    }

    /// Lag and distance to go of an orientation in its loop, degrees; `None` with open loop. The nominal value
    /// runs ahead by the lag that belongs to the speed.
    pub fn lag_and_distance_deg(&self) -> Option<[f64; 2]> {
        match self.mode {
            Mode::Orientation(orientation) if self.is_controlled() => {
                let Phase::Controlled { target_deg } = orientation.phase else {
                    return None;
                };
                let way = target_deg - self.encoder.turned_deg();
                let lag = self.dynamics(orientation.rpm).velocity(way) / self.slope();
                Some([lag, way - lag])
            }
            _ => None,
        }
    }

    /// Voltage of the output, V.
    pub fn volts(&self) -> f64 {
        self.volts
    }

    /// The speed that the voltage stands for, rpm; negative as M04.
    pub fn output_rpm(&self) -> f64 {
        let gear = self.gear();
        if gear.rated_volts > 0.0 {
            self.volts / gear.rated_volts * gear.rated_rpm
        } else {
            0.0
        }
    }

    /// Whether the voltage is on a ramp, on its way to its nominal value [000:5536].
    pub fn on_ramp(&self) -> bool {
        self.ramp_volts != self.goal_volts
    }

    /// Whether the output is 0 V: M2005 [000:5532].
    pub fn at_zero(&self) -> bool {
        self.volts == 0.0
    }

    /// Gear range, 0 to 7.
    pub fn gear_range(&self) -> u8 {
        self.gear
    }

    /// Nominal speed with override and limits, rpm: W320.
    pub fn nominal_rpm(&self) -> f64 {
        match self.mode {
            Mode::Speed(Rotation::M5) => 0.0,
            Mode::Speed(_) => self.limited_rpm(),
            Mode::Turn(rotation) => self.settings.orientation.jog_rpm * rotation.sign().abs(),
            Mode::Lead => (self.lead.profile_deg_min() / 360.0).abs(),
            Mode::Jog(_) | Mode::Orientation(_) => 0.0,
        }
    }

    /// Speed over the last contour cycles in which it turned evenly, rpm; negative as M04. W322 is its amount.
    pub fn actual_rpm(&self) -> f64 {
        self.encoder.rpm()
    }

    /// What monitoring has found: amplitude (MP31 bit 5) or edges (MP32 bit 5) of the signals of its encoder
    /// [000:3290-3328], in a thread that it turns otherwise than it is told.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// Angle from the zero of the spindle, 0 up to 360 degrees: the reference mark stands at MP3430. `None`
    /// until it was crossed.
    pub fn angle_deg(&self) -> Option<f64> {
        self.encoder.angle_deg(self.settings.orientation.reference_deg)
    }

    /// Angle since power-on with all turns, degrees: what the tool axis follows in cycles 17 and 18
    /// [000:6122].
    pub fn turned_deg(&self) -> f64 {
        self.encoder.turned_deg()
    }

    /// The part of the programmed speed that runs with override and limits: MP3310, MP3515.
    pub fn effective_override(&self) -> f64 {
        if self.programmed_rpm > 0.0 {
            self.limited_rpm() / self.programmed_rpm
        } else {
            1.0
        }
    }

    /// Voltage of the programmed speed, V.
    pub fn programmed_volts(&self) -> f64 {
        speed::volts(&self.settings, &self.gear(), self.programmed_rpm)
    }

    /// Whether an orientation is going on: M2712, M2127.
    pub fn orienting(&self) -> bool {
        matches!(self.mode, Mode::Orientation(orientation) if !orientation.reached)
    }

    /// Whether the spindle has reached the window of its orientation: M2007.
    pub fn in_position(&self) -> bool {
        matches!(self.mode, Mode::Orientation(orientation) if orientation.reached)
    }
}
