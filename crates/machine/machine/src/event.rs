//! What an operator, a script or a test does to the machine, as text.

use bahn_path::Switch;
use bahn_servo::ANALOGUE_INPUTS;
use bahn_servo::{HandwheelKey, INPUTS, WHEELS};

use crate::axis::DriveFault;
use crate::chain::{ContactFault, RelayFault};
use crate::device::DeviceFault;
use crate::encoder::EncoderFault;
use crate::reader::INPUT_LETTERS;

/// What can be done to a machine. The text form is in the table of [`Event::HELP`].
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A key of the machine operating panel.
    Key(String, KeyAction),
    /// The feed-rate override potentiometer, %.
    FeedOverride(f64),
    /// The spindle override potentiometer, %.
    SpindleOverride(f64),
    /// A wheel of the handwheel, from 1, is turned by so many counting steps.
    Handwheel(usize, i64),
    /// A key of the handwheel.
    HandwheelKey(HandwheelKey, KeyAction),
    /// A step switch at the handwheel adapter, 1 or 2, is turned to a position, from 1.
    HandwheelSwitch(usize, u8),
    /// The handwheel is plugged in, or out.
    HandwheelPlug(Put),
    /// A thing is moved by hand to one of its states.
    Switch(String, String),
    /// The EMERGENCY STOP button is pressed or released.
    EmergencyStop(Button),
    /// The supply of the control voltage comes or goes.
    Voltage(Switch),
    /// The touch probe is put into the spindle or taken out.
    Probe(Put),
    /// A hand pushes the stylus of the touch probe along an axis X, Y or Z of the machine with a force, N, until the next such
    /// event.
    Stylus(char, f64),
    /// A tool is put into the spindle by hand; 0 takes it out.
    Tool(u32),
    /// A voltage at an analogue input, V.
    Analogue(usize, f64),
    /// A temperature at a Pt 100 input, degrees Celsius.
    Temperature(usize, f64),
    /// An axis is pushed with a force, N or Nm, until the next such event.
    Force(char, f64),
    /// A fault is injected.
    Fault(Fault),
    /// Something is repaired: an axis letter, `S`, the name of a thing, an input, `relay`, `battery`, `memory`, or `all`.
    Repair(String),
}

/// Where a thing is put that can be in its place or out of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Put {
    /// Into its place.
    In,
    /// Out of it.
    Out,
}

/// How a button or key stands that stays where it is put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// It is down.
    Pressed,
    /// It is up.
    Released,
}

impl Button {
    /// Whether it is down.
    pub fn is_pressed(self) -> bool {
        self == Button::Pressed
    }
}

/// What is done with a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyAction {
    /// The key is pressed and held.
    Press,
    /// The key is released.
    Release,
    /// The key is pressed for [`KeyAction::TAP_MS`].
    Tap,
}

impl KeyAction {
    /// So long lasts a tap, ms: several PLC scans.
    pub const TAP_MS: u32 = 200;
}

/// A fault that can be injected, by the part that fails.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The encoder of an axis, or of the spindle (`S`).
    Encoder(char, EncoderFault),
    /// The encoder of an axis's motor, which a digital speed controller reads, counts nothing.
    Motor(char),
    /// The drive of an axis, or of the spindle (`S`).
    Drive(char, DriveFault),
    /// The drive of a physical axis, from 1, of a machine of which nothing else is known.
    PhysicalDrive(u8),
    /// The offset of the amplifier of an axis jumps to this voltage, V.
    Offset(char, f64),
    /// The contact of a PLC input fails.
    Input(usize, ContactFault),
    /// The brake of an axis does not hold.
    Brake(char),
    /// Something holds an axis that nobody knows of.
    Clamp(char),
    /// A thing with two states, or `gear`.
    Device(String, DeviceFault),
    /// The relay of the control voltage.
    Relay(RelayFault),
    /// The touch probe does not answer (M2022).
    ProbeNotReady,
    /// The battery of the touch probe is low (M2027).
    ProbeBattery,
    /// The arm of the magazine, or its shuttle, drops its tools.
    ToolLost,
    /// The touch probe says that it is deflected whatever it touches.
    ProbeEarly,
    /// The buffer battery of the control's memory is low.
    BufferBattery,
    /// The memory of the control does not pass its test at the next power-on: its RAM, or the EPROMs and the checksum.
    Memory {
        /// The EPROMs and the checksum, not the RAM.
        eprom: bool,
    },
}

/// Why an event was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EventError {
    /// The first word names no event.
    #[error("`{0}` is no event; there are {list}", list = Event::WORDS.join(", "))]
    Unknown(String),
    /// The words do not fit the event.
    #[error("this event is written `{0}`")]
    Form(&'static str),
    /// A number is wrong or out of its range.
    #[error("`{0}` is no number from {1} to {2}")]
    Number(String, i64, i64),
    /// The machine has nothing of this name.
    #[error("the machine has no {what} `{name}`; there are {known}")]
    Name {
        /// What kind of thing.
        what: &'static str,
        /// The name in the text of the event.
        name: String,
        /// The names that it has.
        known: String,
    },
    /// The PLC moves this thing with its outputs.
    #[error("`{0}` is moved by the PLC, not by hand")]
    NotByHand(String),
}

impl Event {
    /// The first words of all events.
    pub const WORDS: &[&str] = &[
        "key",
        "override",
        "handwheel",
        "switch",
        "emergency",
        "voltage",
        "probe",
        "tool",
        "analogue",
        "temperature",
        "force",
        "fault",
        "repair",
    ];

    /// The forms of all events, a line each.
    pub const HELP: &str = "\
key NAME press|release|tap          a key of the panel; tap presses it for 200 ms
override feed|spindle PERCENT       a potentiometer, 0 to 150
handwheel [1|2|3] STEPS             turns the handwheel, + or -; 2 and 3 stand at an HRA 110
handwheel key NAME press|release|tap    X Y Z IV V + - RAPID SLOW MEDIUM FAST A B C, 1 to 5
handwheel S1|S2 POSITION            a step switch at an HRA 110, from 1
handwheel plug|unplug
switch THING STATE                  moves a thing by hand, as a door
emergency press|release             the EMERGENCY STOP button
voltage on|off                      the supply of the control voltage
probe insert|remove                 the touch probe in the spindle
probe push X|Y|Z NEWTON             a hand pushes its stylus; 0 lets go
tool NUMBER                         a tool put into the spindle by hand; 0 takes it out
analogue INPUT VOLTS                an analogue input 0 to 7
temperature INPUT CELSIUS           a Pt 100 input 0 to 7
force AXIS NEWTON                   pushes an axis, N or Nm
fault encoder AXIS|S amplitude|edges|stuck|marks|no-marks|twice
fault drive AXIS|S dead|runaway|reversed|slow
fault motor AXIS                    its encoder counts nothing (digital drives)
fault brake AXIS                    it does not hold
fault clamp AXIS                    something holds the axis
fault offset AXIS VOLTS
fault input I12 0|1|bouncing        a contact that sticks, or chatters
fault device THING|gear|magazine jammed|no-feedback|permanent|slow
fault magazine lost                 the arm, or the shuttle, drops its tools
fault relay slow MS | welded | open
fault probe not-ready|battery|early
fault battery                       the buffer battery of the control's memory is low
fault memory [eprom]                the RAM of the control, or EPROM and checksum, at power-on
repair AXIS|S|THING|gear|magazine|I12|relay|probe|battery|memory|all
";

    /// Reads an event from its text form. Whether the machine has what it names shows when it is
    /// applied.
    ///
    /// # Errors
    /// When the text is no event.
    ///
    /// ```
    /// use bahn_machine::{Event, KeyAction};
    /// assert_eq!(
    ///     Event::parse("key NC_START tap"),
    ///     Ok(Event::Key("NC_START".to_owned(), KeyAction::Tap))
    /// );
    /// assert!(Event::parse("override feed 200").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Event, EventError> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let Some((first, rest)) = words.split_first() else {
            return Err(EventError::Unknown(String::new()));
        };
        match *first {
            "key" => key(rest),
            "override" => match rest {
                ["feed", percent] => Ok(Event::FeedOverride(number(percent, 0, 150)?)),
                ["spindle", percent] => Ok(Event::SpindleOverride(number(percent, 0, 150)?)),
                _ => Err(EventError::Form("override feed|spindle PERCENT")),
            },
            "handwheel" => handwheel(rest),
            "switch" => match rest {
                [name, state] => Ok(Event::Switch((*name).to_owned(), (*state).to_owned())),
                _ => Err(EventError::Form("switch THING STATE")),
            },
            "emergency" => match rest {
                ["press"] => Ok(Event::EmergencyStop(Button::Pressed)),
                ["release"] => Ok(Event::EmergencyStop(Button::Released)),
                _ => Err(EventError::Form("emergency press|release")),
            },
            "voltage" => match rest {
                ["on"] => Ok(Event::Voltage(Switch::On)),
                ["off"] => Ok(Event::Voltage(Switch::Off)),
                _ => Err(EventError::Form("voltage on|off")),
            },
            "probe" => probe(rest),
            "tool" => match rest {
                [tool] => Ok(Event::Tool(number(tool, 0, 32_767)? as u32)),
                _ => Err(EventError::Form("tool NUMBER")),
            },
            "analogue" => match rest {
                [input, volts] => Ok(Event::Analogue(analogue_input(input)?, number(volts, -10, 10)?)),
                _ => Err(EventError::Form("analogue INPUT VOLTS")),
            },
            "temperature" => match rest {
                [input, celsius] => Ok(Event::Temperature(
                    analogue_input(input)?,
                    number(celsius, -50, 150)?,
                )),
                _ => Err(EventError::Form("temperature INPUT CELSIUS")),
            },
            "force" => match rest {
                [axis, force] => Ok(Event::Force(
                    letter(axis, "force AXIS NEWTON")?,
                    number(force, -1_000_000, 1_000_000)?,
                )),
                _ => Err(EventError::Form("force AXIS NEWTON")),
            },
            "fault" => fault(rest).map(Event::Fault),
            "repair" => match rest {
                [what] => Ok(Event::Repair((*what).to_owned())),
                _ => Err(EventError::Form("repair AXIS|S|THING|gear|I12|relay|probe|all")),
            },
            other => Err(EventError::Unknown(other.to_owned())),
        }
    }
}

fn key(rest: &[&str]) -> Result<Event, EventError> {
    const FORM: &str = "key NAME press|release|tap";
    match rest {
        [name] => Ok(Event::Key((*name).to_owned(), KeyAction::Tap)),
        [name, action] => Ok(Event::Key((*name).to_owned(), key_action(action, FORM)?)),
        _ => Err(EventError::Form(FORM)),
    }
}

fn probe(rest: &[&str]) -> Result<Event, EventError> {
    const FORM: &str = "probe insert|remove | push X|Y|Z NEWTON";
    match rest {
        ["insert"] => Ok(Event::Probe(Put::In)),
        ["remove"] => Ok(Event::Probe(Put::Out)),
        ["push", axis @ ("X" | "Y" | "Z"), newton] => {
            Ok(Event::Stylus(letter(axis, FORM)?, number(newton, -20, 20)?))
        }
        _ => Err(EventError::Form(FORM)),
    }
}

fn key_action(action: &str, form: &'static str) -> Result<KeyAction, EventError> {
    match action {
        "tap" => Ok(KeyAction::Tap),
        "press" => Ok(KeyAction::Press),
        "release" => Ok(KeyAction::Release),
        _ => Err(EventError::Form(form)),
    }
}

fn handwheel(rest: &[&str]) -> Result<Event, EventError> {
    const FORM: &str = "handwheel [1|2|3] STEPS | key NAME press|release|tap | S1|S2 POSITION | plug|unplug";
    let steps = |text| Ok(number(text, -1_000_000, 1_000_000)? as i64);
    match rest {
        ["plug"] => Ok(Event::HandwheelPlug(Put::In)),
        ["unplug"] => Ok(Event::HandwheelPlug(Put::Out)),
        [one] => Ok(Event::Handwheel(0, steps(one)?)),
        ["S1", position] => Ok(Event::HandwheelSwitch(0, number(position, 1, 8)? as u8)),
        ["S2", position] => Ok(Event::HandwheelSwitch(1, number(position, 1, 8)? as u8)),
        ["key", name, action @ ..] if action.len() < 2 => {
            let key = HandwheelKey::named(name).ok_or_else(|| EventError::Name {
                what: "handwheel key",
                name: (*name).to_owned(),
                known: HandwheelKey::NAMES.map(|(name, _)| name).join(", "),
            })?;
            let action = action
                .first()
                .map_or(Ok(KeyAction::Tap), |action| key_action(action, FORM))?;
            Ok(Event::HandwheelKey(key, action))
        }
        [wheel, turned] => {
            let wheel = number(wheel, 1, WHEELS as i64)? as usize;
            Ok(Event::Handwheel(wheel - 1, steps(turned)?))
        }
        _ => Err(EventError::Form(FORM)),
    }
}

fn fault(rest: &[&str]) -> Result<Fault, EventError> {
    match rest {
        ["encoder", axis, kind] => {
            const FORM: &str = "fault encoder AXIS|S amplitude|edges|stuck|marks|no-marks|twice";
            let kind = match *kind {
                "amplitude" => EncoderFault::Amplitude,
                "edges" => EncoderFault::Edges,
                "stuck" => EncoderFault::Stuck,
                "marks" => EncoderFault::Marks,
                "no-marks" => EncoderFault::NoMarks,
                "twice" => EncoderFault::Twice,
                _ => return Err(EventError::Form(FORM)),
            };
            Ok(Fault::Encoder(letter(axis, FORM)?, kind))
        }
        ["drive", axis, "dead"] if axis.parse::<u8>().is_ok() => {
            Ok(Fault::PhysicalDrive(number(axis, 1, 32)? as u8))
        }
        ["drive", axis, kind] => {
            const FORM: &str = "fault drive AXIS|S dead|runaway|reversed|slow";
            let kind = match *kind {
                "dead" => DriveFault::Dead,
                "runaway" => DriveFault::Runaway,
                "reversed" => DriveFault::Reversed,
                "slow" => DriveFault::Slow,
                _ => return Err(EventError::Form(FORM)),
            };
            Ok(Fault::Drive(letter(axis, FORM)?, kind))
        }
        ["motor", axis] => Ok(Fault::Motor(letter(axis, "fault motor AXIS")?)),
        ["brake", axis] => Ok(Fault::Brake(letter(axis, "fault brake AXIS")?)),
        ["clamp", axis] => Ok(Fault::Clamp(letter(axis, "fault clamp AXIS")?)),
        ["offset", axis, volts] => Ok(Fault::Offset(
            letter(axis, "fault offset AXIS VOLTS")?,
            number(volts, -10, 10)?,
        )),
        ["input", input, state] => {
            const FORM: &str = "fault input I12 0|1|bouncing";
            let input = input_number(input).ok_or(EventError::Form(FORM))?;
            match *state {
                "0" => Ok(Fault::Input(input, ContactFault::Stuck(false))),
                "1" => Ok(Fault::Input(input, ContactFault::Stuck(true))),
                "bouncing" => Ok(Fault::Input(input, ContactFault::Bouncing)),
                _ => Err(EventError::Form(FORM)),
            }
        }
        ["magazine", "lost"] => Ok(Fault::ToolLost),
        ["magazine", ..] => Err(EventError::Form("fault magazine lost")),
        [
            "device",
            name,
            kind @ ("jammed" | "no-feedback" | "permanent" | "slow"),
        ] => {
            let kind = match *kind {
                "jammed" => DeviceFault::Jammed,
                "no-feedback" => DeviceFault::NoFeedback,
                "permanent" => DeviceFault::Permanent,
                _ => DeviceFault::Slow,
            };
            Ok(Fault::Device((*name).to_owned(), kind))
        }
        ["relay", "slow", delay] => Ok(Fault::Relay(RelayFault::Slow(number(delay, 0, 10_000)? as u32))),
        ["relay", "welded"] => Ok(Fault::Relay(RelayFault::Welded)),
        ["relay", "open"] => Ok(Fault::Relay(RelayFault::Open)),
        ["probe", "not-ready"] => Ok(Fault::ProbeNotReady),
        ["probe", "battery"] => Ok(Fault::ProbeBattery),
        ["probe", "early"] => Ok(Fault::ProbeEarly),
        ["battery"] => Ok(Fault::BufferBattery),
        ["memory"] => Ok(Fault::Memory { eprom: false }),
        ["memory", "eprom"] => Ok(Fault::Memory { eprom: true }),
        ["memory", ..] => Err(EventError::Form("fault memory [eprom]")),
        ["battery", ..] => Err(EventError::Form("fault battery")),
        ["device", ..] => Err(EventError::Form(
            "fault device THING|gear|magazine jammed|no-feedback|permanent|slow",
        )),
        ["relay", ..] => Err(EventError::Form("fault relay slow MS | welded | open")),
        _ => Err(EventError::Form(
            "fault encoder|drive|motor|brake|clamp|offset|input|device|magazine|relay|probe|battery|memory ..",
        )),
    }
}

fn letter(text: &str, form: &'static str) -> Result<char, EventError> {
    let mut letters = text.chars();
    match (letters.next(), letters.next()) {
        (Some(letter), None) => Ok(letter),
        _ => Err(EventError::Form(form)),
    }
}

/// The number of an input such as `I12`, or `E12`.
pub(crate) fn input_number(text: &str) -> Option<usize> {
    let digits = text.strip_prefix(INPUT_LETTERS)?;
    if !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    digits.parse().ok().filter(|input| *input < INPUTS)
}

fn analogue_input(text: &str) -> Result<usize, EventError> {
    text.parse()
        .ok()
        .filter(|input| *input < ANALOGUE_INPUTS)
        .ok_or_else(|| EventError::Number(text.to_owned(), 0, ANALOGUE_INPUTS as i64 - 1))
}

fn number(text: &str, min: i64, max: i64) -> Result<f64, EventError> {
    let number = text.parse::<f64>().ok();
    number
        .filter(|number| (min as f64..=max as f64).contains(number))
        .ok_or_else(|| EventError::Number(text.to_owned(), min, max))
}
