//! Things with two states: pumps, clamps, doors, tool clamps, valves.

use bahn_servo::{INPUTS, OUTPUTS};

use crate::axis::axis_letters;
use crate::circuit::Circuit;
use crate::mechanics::DevicePlace;
use crate::reader::{Coil, Contact, Section};

/// How such a thing can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviceFault {
    /// It stays where it is.
    Jammed,
    /// It moves, but none of its switches closes.
    NoFeedback,
    /// It moves, and its second switch stays closed all the time.
    Permanent,
    /// It moves slowly, [`DeviceFault::SLOW`] times as long.
    Slow,
}

impl DeviceFault {
    /// So many times as long a slow thing moves.
    pub const SLOW: f64 = 8.0;
}

/// The true state of such a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceState<'a> {
    /// Its name in the description.
    pub name: &'a str,
    /// 0 is the first of its states, 1 the second, between them it moves.
    pub position: f64,
    /// The name of the state that it has reached.
    pub state: Option<&'a str>,
    /// The names of both.
    pub states: [&'a str; 2],
    /// It is moved by hand, not by the PLC.
    pub by_hand: bool,
}

/// A device; the module describes its behaviour.
#[derive(Clone, Debug)]
pub(crate) struct Device {
    pub name: String,
    pub states: [String; 2],
    output: Option<Coil>,
    /// A second output that moves it back; without one a spring does.
    output_back: Option<Coil>,
    /// What switches a contactor in place of an output.
    circuit: Option<Circuit>,
    inputs: [Option<Contact>; 2],
    /// Share of the travel in a millisecond, forth and back.
    speed: [f64; 2],
    /// The axis that it clamps in its second state.
    pub clamps: Option<char>,
    pub fault: Option<DeviceFault>,
    position: f64,
    forth: bool,
}

/// The axis that it clamps; that there is one is looked at when all axes are known.
fn clamps(section: &Section) -> Option<char> {
    let known = axis_letters(section.reader.numbered);
    let words: Vec<String> = known.chars().map(String::from).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let index = section.word("clamps", &words)?;
    known.chars().nth(index)
}

impl Device {
    /// A device as the section `[device.NAME]` of the machine file describes it.
    pub fn read(name: String, section: Section) -> Device {
        let states = section.texts("states");
        let states = match states.as_slice() {
            [] => ["off".to_owned(), "on".to_owned()],
            [(_, first), (_, second)] if first != second => [(*first).to_owned(), (*second).to_owned()],
            _ => {
                section.fault_at("states", "states are two different words".to_owned());
                ["off".to_owned(), "on".to_owned()]
            }
        };
        let words = [states[0].as_str(), states[1].as_str()];
        let start = section.word("start", &words) == Some(1);
        let per_ms = |key| match section.number(key, 0.0..=1e7).unwrap_or(0.0) {
            time if time < 1.0 => 1.0,
            time => 1.0 / time,
        };
        let device = Device {
            name,
            output: section.coil("output"),
            output_back: section.coil("output_back"),
            circuit: Circuit::read(&section),
            inputs: [section.contact("input_first"), section.contact("input_second")],
            speed: [per_ms("back_ms"), per_ms("forth_ms")],
            clamps: clamps(&section),
            fault: None,
            position: if start { 1.0 } else { 0.0 },
            forth: start,
            states,
        };
        if device.output_back.is_some() && device.output.is_none() {
            section.fault_at("output_back", "output_back goes with output".to_owned());
        }
        if device.circuit.is_some() && device.output.is_some() {
            section.fault_at("on", "a thing has an output or on, not both".to_owned());
        }
        section.finish();
        device
    }

    /// Whether the operator moves it, not the PLC.
    pub fn by_hand(&self) -> bool {
        self.output.is_none() && self.circuit.is_none()
    }

    /// Moves it by hand to one of its states.
    pub fn switch(&mut self, forth: bool) {
        self.forth = forth;
    }

    /// Lets a millisecond pass; whether it has moved.
    pub fn advance(&mut self, outputs: &[bool; OUTPUTS]) -> bool {
        if let Some(output) = self.output {
            match self.output_back.map(|back| back.is_on(outputs)) {
                None => self.forth = output.is_on(outputs),
                Some(back) if back != output.is_on(outputs) => self.forth = !back,
                Some(_) => {}
            }
        }
        if let Some(circuit) = &self.circuit {
            self.forth = circuit.is_on(self.is_forth(), outputs);
        }
        if self.fault == Some(DeviceFault::Jammed) {
            return false;
        }
        let [mut back, mut forth] = self.speed;
        if self.fault == Some(DeviceFault::Slow) {
            (back, forth) = (back / DeviceFault::SLOW, forth / DeviceFault::SLOW);
        }
        let before = self.position;
        self.position = if self.forth {
            (before + forth).min(1.0)
        } else {
            (before - back).max(0.0)
        };
        self.position != before
    }

    /// Position and direction of the device.
    pub fn place(&self) -> DevicePlace {
        DevicePlace {
            name: self.name.clone(),
            position: self.position,
            forth: self.forth,
        }
    }

    /// Is there at power-on.
    pub fn stand_at(&mut self, place: &DevicePlace) {
        (self.position, self.forth) = (place.position, place.forth);
    }

    /// Something holds it in its first state.
    pub fn hold_back(&mut self) {
        self.position = 0.0;
    }

    /// It has arrived in its second state.
    pub fn is_forth(&self) -> bool {
        self.position >= 1.0 - END
    }

    /// It has arrived in its first state.
    pub fn is_back(&self) -> bool {
        self.position <= END
    }

    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        let seen = self.fault != Some(DeviceFault::NoFeedback);
        let stays = self.fault == Some(DeviceFault::Permanent);
        for (contact, reached) in self.inputs.iter().zip([self.is_back(), self.is_forth() || stays]) {
            if let Some(contact) = contact {
                contact.set(inputs, reached && seen);
            }
        }
    }

    pub fn state(&self) -> DeviceState<'_> {
        let state = match (self.is_back(), self.is_forth()) {
            (true, _) => Some(self.states[0].as_str()),
            (_, true) => Some(self.states[1].as_str()),
            _ => None,
        };
        DeviceState {
            name: &self.name,
            position: self.position,
            state,
            states: [&self.states[0], &self.states[1]],
            by_hand: self.by_hand(),
        }
    }
}

/// So near the end counts as there: the steps of the travel do not add up to 1 exactly.
const END: f64 = 1e-9;
