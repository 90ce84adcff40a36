//! A feed axis: amplifier and motor, guideway, play, ends of travel, encoder.

use crate::clock::Span;
use crate::current_drive::CurrentDrive;
use crate::deviation::Deviation;
use crate::encoder::{Counter, EncoderFault};
use crate::mechanics::AxisPlace;
use crate::noise::Noise;
use crate::reader::{Coil, Contact, Section};
use bahn_servo::{INPUTS, OUTPUTS};

/// How a drive can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveFault {
    /// The drive gives no force.
    Dead,
    /// The drive runs with 10 V whatever the control puts out: the tachometer is lost.
    Runaway,
    /// The drive turns the other way: its wires are exchanged.
    Reversed,
    /// The drive turns with a part of the speed only, [`DriveFault::SLOW`].
    Slow,
}

impl DriveFault {
    /// What is left of the speed of a slow drive.
    pub const SLOW: f64 = 0.3;
}

/// The true state of an axis, which no control sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisState {
    /// Letter of the axis.
    pub letter: char,
    /// Position of the table, mm or degrees.
    pub position: f64,
    /// Position of the motor behind the play, mm or degrees.
    pub motor_position: f64,
    /// Speed of the motor, mm/min or degrees/min.
    pub speed_per_min: f64,
    /// Nominal voltage from the control, V.
    pub volts: f64,
    /// The drive is enabled and has voltage.
    pub powered: bool,
    /// The clamp of the axis is closed.
    pub clamped: bool,
    /// Force of the motor in the last step, N or Nm.
    pub force: f64,
    /// The place of its nominal value output.
    pub output: usize,
    /// Without power friction and brake brake it at least so, mm/s² or degrees/s²; less than 0 when it falls.
    pub braking: f64,
    /// So much at most the motor accelerates it, mm/s² or degrees/s².
    pub motor: f64,
    /// So much its weight, and what pushes it, accelerate it, mm/s² or degrees/s².
    pub weight: f64,
}

/// A switch that is closed within a range of the travel.
#[derive(Clone, Debug)]
struct Cam {
    from: f64,
    to: f64,
    contact: Option<Contact>,
}

impl Cam {
    fn holds(&self, position: f64) -> bool {
        (self.from..=self.to).contains(&position)
    }
}

/// A simulated axis; the module describes its physics.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    pub letter: char,
    pub output: usize,
    enable: Option<Coil>,
    ready: Option<Contact>,
    /// Speed per volt, units/s; the offset of the amplifier and its noise, V.
    gain: f64,
    pub offset: f64,
    noise_volts: f64,
    noise: Noise,
    /// Speed controller: share of the speed error taken away per step, divided by the step; the same
    /// for the integral part; the mean of the speed over a step lies `early` before its end.
    rate: f64,
    integral_rate: f64,
    early: f64,
    /// Accelerations by motor, friction, weight and brake, units/s².
    motor_max: f64,
    friction: f64,
    stiction: f64,
    weight: f64,
    brake: f64,
    /// Acceleration of 1 N (1 Nm).
    per_force: f64,
    play: f64,
    travel: [f64; 2],
    /// The reference end position; and what chooses one of the pulses of a rotary encoder: its contact is open around that
    /// one alone.
    reference_cams: [Option<Cam>; 2],
    /// Limit switches below and above, open when actuated.
    limits: [Option<Cam>; 2],
    on_motor: bool,
    /// A drive without speed controller of its own.
    current: Option<Box<CurrentDrive>>,
    /// Where the motor was at power-on.
    motor_start: f64,
    deviation: Option<Box<Deviation>>,
    pub counter: Option<Counter>,

    pub volts: f64,
    pub powered: bool,
    pub clamped: bool,
    fault: Option<DriveFault>,
    /// What the motor's encoder had counted when it failed.
    motor_lost: Option<i64>,
    /// The brake does not hold.
    pub brake_lost: bool,
    /// Something holds it that nobody knows of.
    pub jammed: bool,
    /// Acceleration by the motor in the last step.
    driven: f64,
    /// Acceleration by a force from outside.
    push: f64,
    speed: f64,
    integral: f64,
    motor: f64,
    pub table: f64,
    /// Where the encoder says that it is.
    seen: f64,
}

impl Cam {
    /// Reads `[axis.X.reference_cam]` and `pulse_inhibit`; `None` without one.
    fn of_reference(axis: &Section) -> [Option<Cam>; 2] {
        [("reference_cam", "range"), ("pulse_inhibit", "open")].map(|(name, key)| {
            let section = axis.section(name)?;
            let [from, to] = section.range(key).unwrap_or([0.0, 1.0]);
            let contact = section.contact("input");
            section.finish();
            Some(Cam { from, to, contact })
        })
    }

    /// `[axis.X.limit_minus]` or `limit_plus`: pressed from a place on to the end.
    fn of_limit(axis: &Section, key: &'static str) -> Option<Cam> {
        let section = axis.section(key)?;
        let at = section.needed_number("at", -1e6..=1e6);
        let contact = section.contact("input");
        section.finish();
        let (from, to) = if key == "limit_minus" {
            (f64::NEG_INFINITY, at)
        } else {
            (at, f64::INFINITY)
        };
        Some(Cam { from, to, contact })
    }
}

/// The letters of axes, without blanks; a machine with a System 900 has up to 32 axes, and S is the spindle of events.
const LETTERS: [&str; 2] = ["XYZABCUVW", "XYZABCUVWDEFGHIJKLMNOPQRT"];

/// Those that axes may have, on a machine with a System 900 or another one.
pub(crate) fn axis_letters(numbered: bool) -> &'static str {
    let [few, many] = LETTERS;
    if numbered { many } else { few }
}

/// The letter of `[axis.X]`.
fn letter(name: &str, section: &Section) -> Option<char> {
    let known = axis_letters(section.reader.numbered);
    let letter = known
        .chars()
        .find(|letter| name.len() == 1 && name.starts_with(*letter));
    if letter.is_none() {
        let known: Vec<String> = known.chars().map(String::from).collect();
        section.fault(format!("`{name}` is no axis: {}", known.join(" ")));
    }
    letter
}

/// Whether an axis turns: A, B and C do, and on a machine with a System 900 what says so.
fn turns(letter: char, section: &Section) -> bool {
    let usual = matches!(letter, 'A' | 'B' | 'C');
    match section.reader.numbered {
        true => section.flag("turns").unwrap_or(usual),
        false => usual,
    }
}

/// The place of the nominal value output of an axis.
fn output(section: &Section) -> usize {
    section.output("output").unwrap_or_else(|| {
        if !section.has("output") {
            section.fault(format!("[{}] needs output", section.name));
        }
        0
    })
}

/// The speed controller of an amplifier; see the fields of [`Axis`].
struct Amplifier {
    gain: f64,
    rate: f64,
    integral_rate: f64,
    early: f64,
}

impl Amplifier {
    /// Reads its keys; a drive that is `torque` only has none.
    fn read(section: &Section, torque: bool, step_s: f64) -> Amplifier {
        if torque {
            // The mean of a speed that rises evenly lies half a step before its end.
            return Amplifier {
                gain: 0.0,
                rate: 0.0,
                integral_rate: 0.0,
                early: 0.5,
            };
        }
        // A spindle that is an axis turns with millions of degrees in a minute.
        let most = if section.reader.numbered { 1e8 } else { 1e6 };
        let speed = section.needed_number("speed", 1.0..=most) / 60.0;
        let volts = section.needed_number("volts", 0.1..=10.0);
        let turn = if section.flag("reversed").unwrap_or(false) {
            -1.0
        } else {
            1.0
        };
        let time = section.number("time_constant_ms", 0.0..=10_000.0).unwrap_or(0.0) / 1000.0;
        let reset = section.number("reset_ms", 0.0..=100_000.0).unwrap_or(0.0) / 1000.0;
        let kept = (-step_s / time).exp();
        Amplifier {
            gain: turn * speed / volts,
            rate: (1.0 - kept) / step_s,
            integral_rate: if reset > 0.0 {
                step_s / reset.max(step_s)
            } else {
                0.0
            },
            early: time / step_s - kept / (1.0 - kept),
        }
    }
}

/// What acts on an axis between two ticks, and stays as it is meanwhile.
pub(crate) struct Load {
    /// At the drive, without noise, V.
    volts: f64,
    /// Accelerations by weight and push, by friction, and by what holds it where it stands, units/s².
    outside: f64,
    friction: f64,
    stiction: f64,
    /// The clamp holds the table.
    fixed: bool,
    half_play: f64,
}

/// The travel of an axis that has no ends.
const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
/// Speeds below this count as standing, units/s.
const STANDING: f64 = 1e-12;
/// So far beyond its play a motor may stand, mm or degrees: places are rounded.
const PLACE_WINDOW: f64 = 1e-6;

/// Its drive whose current the control gives, where it has one.
fn current_drive(section: &Section, turns: bool, step_s: f64) -> Option<Box<CurrentDrive>> {
    section.section("current_drive").map(|table| {
        let drive = CurrentDrive::read(&table, turns, step_s);
        table.finish();
        Box::new(drive)
    })
}

impl Axis {
    /// An axis as the section `[axis.X]` of the machine file describes it; `None` where its name is no axis.
    pub fn read(name: &str, section: Section, step_s: f64, seed: u64) -> Option<Axis> {
        let letter = letter(name, &section)?;
        let part = u64::from(u32::from(letter));
        // N and kg give m/s², Nm and kg m² give radians/s².
        let turns = turns(letter, &section);
        let unit = if turns {
            180.0 / std::f64::consts::PI
        } else {
            1000.0
        };
        let travel = section.range("travel").unwrap_or(ENDLESS);
        let start = section.number("start", -1e6..=1e6).unwrap_or(0.0);
        if !(travel[0]..=travel[1]).contains(&start) {
            section.fault_at("start", "start lies outside travel".to_owned());
        }
        let current = current_drive(&section, turns, step_s);
        let amplifier = Amplifier::read(&section, current.is_some(), step_s);
        let rotor = current.as_ref().map_or(0.0, |drive| drive.mass);
        let mass = section.number("mass", 0.001..=1e6).unwrap_or(1.0) + rotor;
        let load = section.number("load", 0.0..=1e6).unwrap_or(0.0);
        let per_force = unit / (mass + load);
        let force = |key| section.number(key, 0.0..=1e9).unwrap_or(0.0) * per_force;
        let friction = force("friction");
        let mut deviation = None;
        let mut axis = Axis {
            letter,
            output: output(&section),
            enable: section.coil("enable"),
            ready: section.contact("ready"),
            gain: amplifier.gain,
            offset: section.number("offset_mv", -1000.0..=1000.0).unwrap_or(0.0) / 1000.0,
            noise_volts: section.number("noise_mv", 0.0..=1000.0).unwrap_or(0.0) / 1000.0,
            noise: Noise::new(seed, part),
            // The controller was tuned without the load: with it, it is slower.
            rate: amplifier.rate * mass / (mass + load),
            integral_rate: amplifier.integral_rate,
            early: amplifier.early,
            motor_max: section
                .number("force", 0.001..=1e9)
                .map_or(f64::INFINITY, |force| force * per_force),
            friction,
            stiction: force("stiction").max(friction),
            weight: section.number("weight", -1e9..=1e9).unwrap_or(0.0) * per_force,
            brake: force("brake"),
            per_force,
            play: section.number("backlash", 0.0..=100.0).unwrap_or(0.0),
            travel,
            reference_cams: Cam::of_reference(&section),
            limits: ["limit_minus", "limit_plus"].map(|key| Cam::of_limit(&section, key)),
            on_motor: section
                .section("encoder")
                .is_some_and(|encoder| encoder.word("on", &["table", "motor"]) == Some(1)),
            counter: section.section("encoder").and_then(|encoder| {
                encoder.word("on", &["table", "motor"]);
                let counter = Counter::read(&encoder, travel, start, Noise::new(seed, part + 1000));
                deviation = Deviation::read(&encoder, step_s);
                encoder.finish();
                counter
            }),
            deviation,
            current,
            motor_start: start,
            volts: 0.0,
            powered: false,
            clamped: false,
            fault: None,
            motor_lost: None,
            brake_lost: false,
            jammed: false,
            driven: 0.0,
            push: 0.0,
            speed: 0.0,
            integral: 0.0,
            motor: start,
            table: start,
            seen: start,
        };
        section.finish();
        axis.set_zero();
        Some(axis)
    }

    /// The encoder counts from where it says that the axis is at power-on.
    fn set_zero(&mut self) {
        let measured = self.measured(self.motor, self.table);
        self.seen = measured;
        if let Some(counter) = self.counter.as_mut().filter(|_| self.deviation.is_some()) {
            counter.begin(measured);
        }
    }

    /// Positions of table and motor.
    pub fn place(&self) -> AxisPlace {
        AxisPlace {
            letter: self.letter,
            table: self.table,
            motor: self.motor,
        }
    }

    /// Whether it can stand there.
    pub fn has(&self, place: &AxisPlace) -> Result<(), String> {
        let [from, to] = self.travel;
        let there = (from..=to).contains(&place.table)
            && place.table.is_finite()
            && (place.motor - place.table).abs() <= self.play / 2.0 + PLACE_WINDOW;
        there.then_some(()).ok_or_else(|| {
            format!(
                "{} stands at {}, its motor at {}",
                self.letter, place.table, place.motor
            )
        })
    }

    /// Stands there at power-on: incremental encoders count from 0 again.
    pub fn stand_at(&mut self, place: &AxisPlace) {
        (self.table, self.motor, self.motor_start) = (place.table, place.motor, place.motor);
        self.seen = self.measured(self.motor, self.table);
        if let Some(counter) = &mut self.counter {
            counter.begin(self.seen);
        }
    }

    /// Lets the drive have voltage or not, as enable output and control voltage say. A drive that goes on without them
    /// brakes on order of the control; when that is not ready nothing brakes it, and its brake must hold it (inferred)
    /// [000:18508-18521]. Whether its power is about to end by itself.
    pub fn set_power(&mut self, voltage: bool, control_ready: bool, outputs: &[bool; OUTPUTS]) -> bool {
        let enabled = self.enable.is_none_or(|enable| enable.is_on(outputs));
        let mut on = voltage && enabled;
        let mut runs_out = false;
        if let Some(drive) = &mut self.current {
            let held = drive.holds(on, control_ready);
            runs_out = held && !on;
            on = held;
        }
        self.powered = on && self.fault != Some(DriveFault::Dead);
        if !self.powered {
            self.integral = 0.0;
            if let Some(drive) = &mut self.current {
                drive.rest();
            }
        }
        runs_out
    }

    /// Makes the drive fail or repairs it.
    pub fn set_drive_fault(&mut self, fault: Option<DriveFault>) {
        self.fault = fault;
        self.powered &= fault != Some(DriveFault::Dead);
    }

    /// Pushes the axis with a force, N or Nm.
    pub fn push(&mut self, force: f64) {
        self.push = force * self.per_force;
    }

    /// Makes the encoder fail or repairs it. `false` when the axis has none.
    pub fn set_encoder_fault(&mut self, fault: Option<EncoderFault>) -> bool {
        let position = self.seen;
        self.counter
            .as_mut()
            .map(|counter| counter.set_fault(fault, position))
            .is_some()
    }

    /// Some steps of the simulation, between which nobody acts. At which of their ticks no limit switch is actuated: the first
    /// one is the lowest bit.
    pub fn run(&mut self, span: Span, step_s: f64) -> u32 {
        if self.lies_still() {
            self.driven = 0.0;
            self.speed = 0.0;
            return if self.limits_clear() { u32::MAX } else { 0 };
        }
        let load = self.load();
        self.advance(&load, span, step_s)
    }

    /// What acts on it as long as nobody acts.
    pub fn load(&self) -> Load {
        let held = if self.powered { 0.0 } else { self.held() };
        Load {
            volts: self.volts_at_drive(),
            outside: self.push - self.weight,
            friction: self.friction + held,
            stiction: self.stiction + held,
            fixed: self.clamped || self.jammed,
            half_play: self.play / 2.0,
        }
    }

    /// It stands without power and nothing moves it: a step leaves everything as it is.
    fn lies_still(&self) -> bool {
        let stands = !self.powered && self.speed == 0.0 && self.deviation.is_none();
        let held = |axis: &Axis| (axis.push - axis.weight).abs() <= axis.stiction + axis.held();
        stands && (self.clamped || self.jammed || held(self))
    }

    /// [`Axis::run`] under a load.
    pub fn advance(&mut self, load: &Load, span: Span, step_s: f64) -> u32 {
        // Local, so that they are registers of the host from step to step.
        let (mut speed, mut motor, mut table) = (self.speed, self.motor, self.table);
        let [first, last] = self.travel;
        let (mut clear, mut tick, mut until) = (0, 1, span.first);
        for _ in 0..span.steps {
            let mut acceleration = load.outside;
            self.driven = 0.0;
            if self.powered {
                self.driven = self.drive(load.volts, speed);
                acceleration += self.driven;
            }
            let before = speed;
            speed = if load.fixed {
                0.0
            } else {
                rubbed(before, acceleration, load.friction, load.stiction, step_s)
            };
            motor += (speed + (before - speed) * self.early) * step_s;
            // The hard stops.
            if motor < first {
                (motor, speed) = (first, speed.max(0.0));
            } else if motor > last {
                (motor, speed) = (last, speed.min(0.0));
            }
            table = within(table, motor - load.half_play, motor + load.half_play);
            table = within(table, first, last);
            if let Some(deviation) = &mut self.deviation {
                deviation.advance();
            }
            self.seen = self.measured(motor, table);
            if let Some(counter) = &mut self.counter {
                counter.move_to(self.seen);
            }
            until -= 1;
            if until == 0 {
                clear |= if self.is_clear_at(table) { tick } else { 0 };
                (tick, until) = (tick << 1, span.each);
            }
        }
        (self.speed, self.motor, self.table) = (speed, motor, table);
        clear
    }

    /// The acceleration by the motor in a step, with its nominal voltage, V, at a speed.
    #[inline(always)]
    fn drive(&mut self, volts: f64, speed: f64) -> f64 {
        let mut volts = volts;
        if self.noise_volts > 0.0 {
            volts += self.noise.next() * self.noise_volts;
        }
        match &mut self.current {
            None => self.motor_acceleration(volts, speed),
            Some(drive) => drive.force(volts) * self.per_force,
        }
    }

    /// The acceleration by which the brake holds.
    fn held(&self) -> f64 {
        if self.brake_lost { 0.0 } else { self.brake }
    }

    /// What the drive makes of its nominal voltage, V, without noise.
    fn volts_at_drive(&self) -> f64 {
        let volts = self.volts + self.offset;
        match self.fault {
            Some(DriveFault::Runaway) => 10.0,
            Some(DriveFault::Reversed) => -volts,
            Some(DriveFault::Slow) => volts * DriveFault::SLOW,
            _ => volts,
        }
    }

    /// The speed controller of the amplifier: proportional and integral, its force limited. The integral
    /// part waits while the force is at its limit.
    #[inline(always)]
    fn motor_acceleration(&mut self, volts: f64, speed: f64) -> f64 {
        let error = volts * self.gain - speed;
        let wanted = (error + self.integral) * self.rate;
        let given = within(wanted, -self.motor_max, self.motor_max);
        if given == wanted {
            self.integral += error * self.integral_rate;
        }
        given
    }

    /// The position where the encoder sits, with motor and table at these.
    #[inline(always)]
    fn measured(&self, motor: f64, table: f64) -> f64 {
        let truth = if self.on_motor { motor } else { table };
        match &self.deviation {
            None => truth,
            Some(deviation) => deviation.seen(truth),
        }
    }

    /// What the motor's encoder has counted, where the control reads it.
    pub fn motor_count(&self) -> Option<i64> {
        let drive = self.current.as_ref()?;
        Some(match self.motor_lost {
            Some(seen) => seen,
            None => drive.count(self.motor - self.motor_start),
        })
    }

    /// The motor's encoder counts nothing from now on; `false` where the control reads none.
    pub fn lose_motor(&mut self) -> bool {
        self.motor_lost = self.motor_count();
        self.motor_lost.is_some()
    }

    /// The motor's encoder counts again: what it lost stays lost.
    pub fn find_motor(&mut self) {
        if let (Some(seen), Some(drive)) = (self.motor_lost.take(), &self.current) {
            self.motor_start = self.motor - drive.travel(seen);
        }
    }

    /// The control reads the motor's encoder.
    pub fn has_motor_encoder(&self) -> bool {
        self.current.is_some()
    }

    /// What the control reads of the encoder; `again` without time having passed.
    #[inline]
    pub fn read_encoder(&mut self, again: bool, read: &mut bahn_servo::Encoder) {
        if let Some(counter) = &mut self.counter {
            counter.read_at(self.seen, self.speed, again, read);
        }
    }

    /// No limit switch is actuated.
    pub fn limits_clear(&self) -> bool {
        self.is_clear_at(self.table)
    }

    /// No limit switch is actuated with the table there.
    #[inline]
    fn is_clear_at(&self, table: f64) -> bool {
        !self.limits.iter().flatten().any(|cam| cam.holds(table))
    }

    /// Sets reference cam, pulse inhibit, limit switches and ready contact. Limit switches open when actuated.
    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        let [end, inhibit] = &self.reference_cams;
        let openers = self.limits.iter().chain([inhibit]).flatten();
        let cams = end.iter().map(|cam| (cam, true));
        for (cam, closes) in cams.chain(openers.map(|cam| (cam, false))) {
            if let Some(contact) = cam.contact {
                contact.set(inputs, cam.holds(self.table) == closes);
            }
        }
        if let Some(ready) = self.ready {
            ready.set(inputs, self.fault != Some(DriveFault::Dead));
        }
    }

    pub fn state(&self) -> AxisState {
        AxisState {
            letter: self.letter,
            position: self.table,
            motor_position: self.motor,
            speed_per_min: self.speed * 60.0,
            volts: self.volts,
            powered: self.powered,
            clamped: self.clamped || self.jammed,
            force: self.driven / self.per_force,
            output: self.output,
            braking: self.friction + self.held() - self.weight.abs() - self.push.abs(),
            motor: self.motor_max,
            weight: self.weight.abs() + self.push.abs(),
        }
    }
}

/// As `clamp` of ends that are in order.
#[inline(always)]
fn within(value: f64, first: f64, last: f64) -> f64 {
    let value = if value < first { first } else { value };
    if value > last { last } else { value }
}

/// The speed after a step with dry friction: what stands stays until stiction is overcome, and what
/// comes to rest stops before it turns round.
#[inline]
fn rubbed(speed: f64, acceleration: f64, friction: f64, stiction: f64, step_s: f64) -> f64 {
    if speed.abs() < STANDING {
        if acceleration.abs() <= stiction {
            return 0.0;
        }
        return (acceleration - friction.copysign(acceleration)) * step_s;
    }
    let after = speed + (acceleration - friction.copysign(speed)) * step_s;
    if after * speed < 0.0 && acceleration.abs() <= stiction {
        return 0.0;
    }
    after
}
