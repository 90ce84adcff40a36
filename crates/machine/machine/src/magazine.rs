//! A tool magazine with a double arm: a chain of pockets, a shuttle between chain and arm, an arm with two grippers.
//!
//! Shuttle and arm are things with two states (`[device.NAME]`), with outputs, switches, times and faults of their own;
//! here is what they do with the tools. The shuttle takes the tool of the pocket at the change position to the arm and
//! back. The arm grips the tools of shuttle and spindle, draws them out, turns them by half a turn and pushes them in.

use bahn_servo::{INPUTS, OUTPUTS};

use crate::device::{Device, DeviceFault};
use crate::mechanics::MagazinePlace;
use crate::reader::{Coil, Contact, Section};

/// Pockets of a magazine at most [000:10398].
const POCKETS_MAX: usize = 254;
/// A pocket is at the change position when the chain stands so near, in pockets.
const POSITION_WINDOW: f64 = 0.2;

/// The arm turns by half a turn.
const HALF_TURN_DEG: f64 = 180.0;

/// Where the tools of a magazine are.
#[derive(Clone, Debug, PartialEq)]
pub struct MagazineState<'a> {
    /// The pocket that is nearest to the change position, from 1.
    pub pocket: usize,
    /// The tool in each pocket, from pocket 1 on; 0 is none.
    pub pockets: &'a [u32],
    /// The tool in the shuttle.
    pub shuttle: u32,
    /// The tools in the grippers: at the side of the shuttle, at the side of the spindle.
    pub arm: [u32; 2],
    /// The tool in the spindle.
    pub spindle: u32,
    /// How far the arm has turned, degrees: 0 to 180 and back.
    pub arm_deg: f64,
}

/// What moves the tools: places in the list of things.
#[derive(Clone, Copy, Debug)]
struct Parts {
    clamp: usize,
    shuttle: usize,
    grip: usize,
    draw: usize,
    turn: usize,
}

impl Parts {
    /// Where shuttle, draw and turn are.
    fn places(self, devices: &[Device]) -> [Place; 3] {
        [self.shuttle, self.draw, self.turn].map(|at| Place::of(devices.get(at)))
    }
}

/// See the module. 0 is no tool.
#[derive(Clone, Debug)]
pub(crate) struct Magazine {
    pockets: Vec<u32>,
    shuttle: u32,
    arm: [u32; 2],
    spindle: u32,
    /// Where the chain stands, in pockets: 0 is pocket 1 at the change position.
    position: f64,
    /// Travel in a millisecond, pockets.
    speed: f64,
    forward: Option<Coil>,
    backward: Option<Coil>,
    in_position: Option<Contact>,
    code: Vec<Contact>,
    shuttle_full: Option<Contact>,
    spindle_full: Option<Contact>,
    parts: Parts,
    pub fault: Option<DeviceFault>,
    /// Its arm has drawn a tool since power-on.
    pub has_changed: bool,
    /// Where the parts were a tick ago: shuttle, draw, turn.
    before: [Place; 3],
}

/// The end where a thing with two states is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Back,
    Between,
    Forth,
}

impl Place {
    fn of(device: Option<&Device>) -> Place {
        match device {
            Some(device) if device.is_forth() => Place::Forth,
            Some(device) if device.is_back() => Place::Back,
            _ => Place::Between,
        }
    }
}

impl Magazine {
    /// Reads `[magazine]`; the things that it names are those of the machine.
    pub fn read(section: Section, devices: &[Device]) -> Magazine {
        let count = section.needed_number("pockets", 1.0..=POCKETS_MAX as f64) as usize;
        let part = |key: &'static str, usual: &str| {
            let name = section.text(key).unwrap_or(usual);
            let place = devices.iter().position(|device| device.name == name);
            if place.is_none() {
                section.fault(format!(
                    "[magazine] needs {key}, the name of a thing: there is no `{name}`"
                ));
            }
            place.unwrap_or_default()
        };
        let parts = Parts {
            clamp: part("clamp", "tool_clamp"),
            shuttle: part("shuttle", "shuttle"),
            grip: part("grip", "arm_grip"),
            draw: part("draw", "arm_draw"),
            turn: part("turn", "arm_turn"),
        };
        let magazine = Magazine {
            pockets: vec![0; count],
            shuttle: 0,
            arm: [0; 2],
            spindle: 0,
            position: 0.0,
            speed: 1.0 / section.number("pocket_ms", 1.0..=1e6).unwrap_or(500.0),
            forward: section.coil("forward"),
            backward: section.coil("backward"),
            in_position: section.contact("in_position"),
            code: [
                "code_1", "code_2", "code_4", "code_8", "code_16", "code_32", "code_64", "code_128",
            ]
            .into_iter()
            .filter_map(|key| section.contact(key))
            .collect(),
            shuttle_full: section.contact("shuttle_full"),
            spindle_full: section.contact("spindle_full"),
            before: parts.places(devices),
            parts,
            fault: None,
            has_changed: false,
        };
        section.finish();
        magazine
    }

    /// The tools lie so at power-on: pocket and tool, and the tool in the spindle, which has left its pocket.
    pub fn load(&mut self, tools: impl Iterator<Item = (u16, u32)>, spindle: u32) {
        self.pockets.fill(0);
        for (pocket, tool) in tools.filter(|(_, tool)| *tool != spindle) {
            let place = usize::from(pocket).checked_sub(1);
            if let Some(slot) = place.and_then(|place| self.pockets.get_mut(place)) {
                *slot = tool;
            }
        }
        (self.spindle, self.shuttle, self.arm) = (spindle, 0, [0; 2]);
    }

    /// Pockets of the chain.
    pub fn count(&self) -> usize {
        self.pockets.len()
    }

    /// Where chain and tools are.
    pub fn place(&self) -> MagazinePlace {
        MagazinePlace {
            position: self.position,
            pockets: self.pockets.clone(),
            shuttle: self.shuttle,
            arm: self.arm,
            spindle: self.spindle,
            has_changed: self.has_changed,
        }
    }

    /// Chain and tools are there at power-on, after the things that move them.
    pub fn stand_at(&mut self, place: &MagazinePlace, devices: &[Device]) {
        self.position = place.position;
        self.pockets.clone_from(&place.pockets);
        (self.shuttle, self.arm, self.spindle) = (place.shuttle, place.arm, place.spindle);
        self.has_changed = place.has_changed;
        self.before = self.parts.places(devices);
    }

    /// A tool is put into the spindle by hand; 0 takes it out.
    pub fn insert(&mut self, tool: u32) {
        self.spindle = tool;
    }

    /// The arm, or where it holds none the shuttle, drops its tools.
    pub fn lose(&mut self) {
        match self.arm {
            [0, 0] => self.shuttle = 0,
            _ => self.arm = [0; 2],
        }
    }

    pub fn state(&self, devices: &[Device]) -> MagazineState<'_> {
        let turn = devices.get(self.parts.turn).map(Device::state);
        MagazineState {
            pocket: self.at() + 1,
            pockets: &self.pockets,
            shuttle: self.shuttle,
            arm: self.arm,
            spindle: self.spindle,
            arm_deg: turn.map_or(0.0, |turn| turn.position * HALF_TURN_DEG),
        }
    }

    pub fn tool_in_spindle(&self) -> u32 {
        self.spindle
    }

    /// Lets a millisecond pass, after the things; whether anything has moved.
    pub fn advance(&mut self, outputs: &[bool; OUTPUTS], devices: &mut [Device]) -> bool {
        let at = |place: usize| Place::of(devices.get(place));
        let parts = self.parts;
        let (grips, released) = (at(parts.grip) == Place::Forth, at(parts.clamp) == Place::Forth);
        let now = parts.places(devices);
        let [shuttle_before, draw_before, turn_before] = self.before;
        let [shuttle, draw, turn] = now;
        self.before = now;
        let turned = self.rotate(outputs, shuttle != Place::Between);
        if !turned && now == [shuttle_before, draw_before, turn_before] {
            return false;
        }
        let mut jams = None;
        let arrives = |before: Place, now: Place| before != now && now != Place::Between;
        if arrives(shuttle_before, shuttle) && !self.shuttle_moved(shuttle) {
            jams = Some(parts.shuttle);
        }
        // What is gripped and clamped cannot be drawn: the arm is held until the clamp opens.
        let leaves = draw_before == Place::Back && draw != Place::Back;
        if leaves && grips && !released && self.spindle != 0 {
            if let Some(arm) = devices.get_mut(parts.draw) {
                arm.hold_back();
            }
            self.before[1] = Place::Back;
        }
        if arrives(draw_before, draw) && grips && !self.drawn(draw) {
            jams = Some(parts.draw);
        }
        if arrives(turn_before, turn) && draw == Place::Forth {
            self.arm.swap(0, 1);
        }
        if let Some(device) = jams.and_then(|place| devices.get_mut(place)) {
            device.fault = Some(DeviceFault::Jammed);
        }
        true
    }

    /// The chain turns while one of its outputs is on; a shuttle on its way holds it. At rest an index pin draws
    /// it to the pocket. Whether it has moved.
    fn rotate(&mut self, outputs: &[bool; OUTPUTS], free: bool) -> bool {
        let is_on = |coil: Option<Coil>| coil.is_some_and(|coil| coil.is_on(outputs));
        if !free || self.fault == Some(DeviceFault::Jammed) {
            return false;
        }
        let before = self.position;
        let count = self.pockets.len() as f64;
        match (is_on(self.forward), is_on(self.backward)) {
            (true, false) => self.position += self.speed,
            (false, true) => self.position -= self.speed,
            _ => {
                let off = self.position - self.position.round();
                if off.abs() <= POSITION_WINDOW {
                    self.position -= off.clamp(-self.speed, self.speed);
                }
            }
        }
        self.position = self.position.rem_euclid(count);
        self.position != before
    }

    /// The place of the pocket that is nearest to the change position, from 0.
    fn at(&self) -> usize {
        self.position.round() as usize % self.pockets.len().max(1)
    }

    fn is_in_position(&self) -> bool {
        (self.position - self.position.round()).abs() <= POSITION_WINDOW
    }

    /// The shuttle has arrived; `false` when its tool meets another one.
    fn shuttle_moved(&mut self, place: Place) -> bool {
        let (at, stands) = (self.at(), self.is_in_position());
        let Some(pocket) = self.pockets.get_mut(at).filter(|_| stands) else {
            return self.shuttle == 0;
        };
        let (from, to) = match place {
            Place::Forth => (pocket, &mut self.shuttle),
            _ => (&mut self.shuttle, pocket),
        };
        if *to == 0 {
            *to = std::mem::take(from);
            return true;
        }
        place == Place::Forth || *from == 0
    }

    /// The arm has drawn or pushed in what it grips; `false` when a tool meets another one.
    fn drawn(&mut self, place: Place) -> bool {
        let sides = [&mut self.shuttle, &mut self.spindle];
        let mut fits = true;
        for (side, gripper) in sides.into_iter().zip(&mut self.arm) {
            let (from, to) = match place {
                Place::Forth => (side, gripper),
                _ => (gripper, side),
            };
            match (*from, *to) {
                (0, _) => {}
                (_, 0) => {
                    *to = std::mem::take(from);
                    self.has_changed = true;
                }
                _ => fits = false,
            }
        }
        fits
    }

    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        let seen = self.fault != Some(DeviceFault::NoFeedback);
        let stands = self.is_in_position() && seen;
        let mut say = |contact: &Option<Contact>, on: bool| {
            if let Some(contact) = contact {
                contact.set(inputs, on);
            }
        };
        say(&self.in_position, stands);
        say(&self.shuttle_full, self.shuttle != 0);
        say(&self.spindle_full, self.spindle != 0);
        let number = self.at() + 1;
        for (bit, contact) in self.code.iter().enumerate() {
            contact.set(inputs, stands && number >> bit & 1 == 1);
        }
    }
}
