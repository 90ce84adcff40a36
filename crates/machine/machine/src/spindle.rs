//! The main spindle: drive, gear ranges, encoder.

use bahn_servo::{Encoder, INPUTS, OUTPUTS};

use crate::axis::DriveFault;
use crate::device::DeviceFault;
use crate::encoder::{Counter, EncoderFault};
use crate::mechanics::SpindlePlace;
use crate::noise::Noise;
use crate::reader::{Coil, Contact, Section};

/// The true state of the spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleState {
    /// Speed of the spindle, rpm; positive for M03 with the polarity of MP3130 = 0.
    pub rpm: f64,
    /// Speed of the motor in front of the gear, rpm.
    pub motor_rpm: f64,
    /// Angle since power-on, degrees, counted on over full turns.
    pub angle_deg: f64,
    /// The engaged gear range from 1; none while the gear is being shifted.
    pub gear: Option<usize>,
    /// Nominal voltage from the control, V.
    pub volts: f64,
    /// The drive is enabled and has voltage.
    pub powered: bool,
}

/// A gear range with its ratio.
#[derive(Clone, Debug)]
struct Gear {
    /// Turns of the motor to a turn of the spindle.
    ratio: f64,
    valve: Option<Coil>,
    engaged: Option<Contact>,
}

/// A simulated spindle; the module describes its physics.
#[derive(Clone, Debug)]
pub(crate) struct Spindle {
    pub output: usize,
    enable: Option<Coil>,
    ready: Option<Contact>,
    at_speed: Option<Contact>,
    tolerance: f64,
    stopped: Option<Contact>,
    standstill: f64,
    /// Motor speed per volt, rpm.
    gain: f64,
    /// Share of the speed error taken away per step, divided by the step.
    rate: f64,
    /// Change of motor speed by the drive and by friction alone, rpm/s.
    acceleration_max: f64,
    coasting: f64,
    gears: Vec<Gear>,
    shift_ms: f64,
    /// The teeth find each other only at these motor speeds, rpm.
    shift_speed: [f64; 2],
    pub counter: Option<Counter>,

    pub volts: f64,
    pub powered: bool,
    pub fault: Option<DriveFault>,
    pub gear_fault: Option<DeviceFault>,
    motor: f64,
    rpm: f64,
    turns: f64,
    engaged: Option<usize>,
    wanted: Option<usize>,
    shifted_ms: f64,
}

impl Spindle {
    /// The spindle as the section `[spindle]` of the machine file describes it; a servo step is `step_s`, s.
    pub fn read(section: Section, step_s: f64, seed: u64) -> Spindle {
        let turn = if section.flag("reversed").unwrap_or(false) {
            -1.0
        } else {
            1.0
        };
        let rpm = section.needed_number("rpm", 1.0..=200_000.0);
        let volts = section.needed_number("volts", 0.1..=10.0);
        let time = section.number("time_constant_ms", 0.0..=100_000.0).unwrap_or(0.0) / 1000.0;
        let mut gears: Vec<Gear> = section.list("gear").into_iter().map(read_gear).collect();
        let several = gears.len() > 1;
        if several && gears.iter().any(|gear| gear.valve.is_none()) {
            section.fault("each of several gears needs its output".to_owned());
        }
        if gears.is_empty() {
            gears.push(Gear {
                ratio: 1.0,
                valve: None,
                engaged: None,
            });
        }
        let start = section.number("start_gear", 1.0..=8.0).unwrap_or(1.0) as usize;
        if start > gears.len() {
            section.fault_at("start_gear", format!("there are {} gears", gears.len()));
        }
        let spindle = Spindle {
            output: section.output("output").unwrap_or(5),
            enable: section.coil("enable"),
            ready: section.contact("ready"),
            at_speed: section.contact("at_speed"),
            tolerance: section.number("tolerance_percent", 0.1..=100.0).unwrap_or(5.0) / 100.0,
            stopped: section.contact("stopped"),
            standstill: section.number("standstill_rpm", 0.001..=1000.0).unwrap_or(1.0),
            gain: turn * rpm / volts,
            rate: (1.0 - (-step_s / time).exp()) / step_s,
            acceleration_max: section
                .number("acceleration_rpm_per_s", 1.0..=1e9)
                .unwrap_or(f64::INFINITY),
            coasting: section.number("coasting_rpm_per_s", 0.0..=1e9).unwrap_or(100.0),
            gears,
            shift_ms: section.number("shift_ms", 0.0..=1e6).unwrap_or(0.0),
            shift_speed: section.range("shift_rpm").unwrap_or([0.0, f64::INFINITY]),
            counter: section
                .section("encoder")
                .and_then(|encoder| read_encoder(encoder, seed)),
            volts: 0.0,
            powered: false,
            fault: None,
            gear_fault: None,
            motor: 0.0,
            rpm: 0.0,
            turns: 0.0,
            engaged: Some(start.saturating_sub(1)),
            wanted: None,
            shifted_ms: 0.0,
        };
        section.finish();
        spindle
    }

    /// Where the spindle stands.
    pub fn place(&self) -> SpindlePlace {
        SpindlePlace {
            turn: self.turns.rem_euclid(1.0),
            gear: self.engaged.map_or(0, |gear| gear + 1),
        }
    }

    /// Whether it can stand there.
    pub fn has(&self, place: &SpindlePlace) -> Result<(), String> {
        let there = (0.0..=1.0).contains(&place.turn) && place.gear <= self.gears.len();
        there.then_some(()).ok_or_else(|| {
            format!(
                "the spindle stands at {} turns in gear {}",
                place.turn, place.gear
            )
        })
    }

    /// Stands there at power-on.
    pub fn stand_at(&mut self, place: &SpindlePlace) {
        self.turns = place.turn;
        self.engaged = place.gear.checked_sub(1);
        if let Some(counter) = &mut self.counter {
            counter.begin(self.turns);
        }
    }

    pub fn set_power(&mut self, voltage: bool, outputs: &[bool; OUTPUTS]) {
        let enabled = self.enable.is_none_or(|enable| enable.is_on(outputs));
        self.powered = voltage && enabled && self.fault != Some(DriveFault::Dead);
    }

    /// Some steps of the simulation, between which nobody acts.
    pub fn run(&mut self, steps: u32, step_s: f64) {
        let nominal = self.powered.then(|| self.nominal());
        let ratio = self
            .engaged
            .and_then(|gear| self.gears.get(gear))
            .map(|gear| gear.ratio);
        for _ in 0..steps {
            self.step(nominal, ratio, step_s);
        }
    }

    /// One step of the simulation: with a motor speed that the drive aims at, rpm, in a gear.
    #[inline(always)]
    fn step(&mut self, nominal: Option<f64>, ratio: Option<f64>, step_s: f64) {
        self.motor += match nominal {
            Some(nominal) => {
                let wanted = (nominal - self.motor) * self.rate;
                wanted.clamp(-self.acceleration_max, self.acceleration_max) * step_s
            }
            None => slowed(self.motor, self.coasting * step_s),
        };
        match ratio {
            Some(ratio) => self.rpm = self.motor / ratio,
            None => self.rpm += slowed(self.rpm, self.coasting * step_s),
        }
        if self.rpm != 0.0 {
            self.turns += self.rpm / 60.0 * step_s;
            if let Some(counter) = &mut self.counter {
                counter.move_to(self.turns);
            }
        }
    }

    /// The motor speed that the drive aims at, rpm.
    fn nominal(&self) -> f64 {
        match self.fault {
            Some(DriveFault::Runaway) => 10.0 * self.gain,
            Some(DriveFault::Reversed) => -self.volts * self.gain,
            Some(DriveFault::Slow) => self.volts * self.gain * DriveFault::SLOW,
            _ => self.volts * self.gain,
        }
    }

    /// Lets the gear shift for a millisecond; whether it does.
    pub fn shift(&mut self, outputs: &[bool; OUTPUTS]) -> bool {
        if self.gears.len() < 2 || self.gear_fault == Some(DeviceFault::Jammed) {
            return false;
        }
        let opened = |gear: &Gear| gear.valve.is_some_and(|valve| valve.is_on(outputs));
        let mut open = self.gears.iter().enumerate().filter(|(_, gear)| opened(gear));
        let wanted = match (open.next(), open.next()) {
            (Some((index, _)), None) => Some(index),
            _ => None,
        };
        if wanted != self.wanted {
            self.wanted = wanted;
            self.shifted_ms = 0.0;
        }
        if wanted.is_none() || wanted == self.engaged {
            return false;
        }
        self.engaged = None;
        if (self.shift_speed[0]..=self.shift_speed[1]).contains(&self.motor.abs()) {
            self.shifted_ms += 1.0;
        }
        if self.shifted_ms >= self.shift_ms {
            self.engaged = wanted;
        }
        true
    }

    /// Sets the contacts of drive and gear.
    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        let mut set = |contact: Option<Contact>, on| {
            if let Some(contact) = contact {
                contact.set(inputs, on);
            }
        };
        let nominal = match self.fault {
            Some(DriveFault::Slow) => self.volts * self.gain,
            _ => self.nominal(),
        };
        let near = (self.motor - nominal).abs() <= nominal.abs() * self.tolerance;
        set(self.ready, self.fault != Some(DriveFault::Dead));
        set(self.at_speed, self.powered && nominal != 0.0 && near);
        set(self.stopped, self.rpm.abs() < self.standstill);
        let seen = self.gear_fault != Some(DeviceFault::NoFeedback);
        for (index, gear) in self.gears.iter().enumerate() {
            set(gear.engaged, seen && self.engaged == Some(index));
        }
    }

    pub fn read_encoder(&mut self, again: bool, read: &mut Encoder) {
        if let Some(counter) = &mut self.counter {
            counter.read_at(self.turns, 0.0, again, read);
        }
    }

    /// Makes the encoder fail or repairs it. `false` when the spindle has none.
    pub fn set_encoder_fault(&mut self, fault: Option<EncoderFault>) -> bool {
        let turns = self.turns;
        self.counter
            .as_mut()
            .map(|counter| counter.set_fault(fault, turns))
            .is_some()
    }

    pub fn state(&self) -> SpindleState {
        SpindleState {
            rpm: self.rpm,
            motor_rpm: self.motor,
            angle_deg: self.turns * 360.0,
            gear: self.engaged.map(|gear| gear + 1),
            volts: self.volts,
            powered: self.powered,
        }
    }
}

/// The change of a speed that friction takes away.
fn slowed(speed: f64, change: f64) -> f64 {
    -speed.clamp(-change, change)
}

fn read_gear(section: Section) -> Gear {
    let gear = Gear {
        ratio: section.needed_number("ratio", 0.001..=1000.0),
        valve: section.coil("output"),
        engaged: section.contact("input"),
    };
    section.finish();
    gear
}

fn read_encoder(section: Section, seed: u64) -> Option<Counter> {
    let input = section.encoder_input("input");
    let lines = section.needed_number("lines", 1.0..=100_000.0);
    let mark = section.number("mark_deg", 0.0..=360.0).unwrap_or(0.0) / 360.0;
    let reversed = section.flag("reversed").unwrap_or(false);
    section.finish();
    Some(Counter::rotary(
        input.unwrap_or(5),
        lines,
        reversed,
        mark,
        Noise::new(seed, 0),
    ))
}
