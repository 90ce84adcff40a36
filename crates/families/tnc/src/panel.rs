//! What the machine operating panel asks for: the markers with their complements.
//!
//! A command is active when its marker is 1 and its complement 0. Two equal markers are a fault of the PLC
//! program or of a key: `ERROR IN PLC-PROGRAM` with the code of the command [000:7543-7585].

use bahn_exchange::{Bit, Image, signal};
use bahn_path::Direction;

use crate::markers::AXES;
use bahn_parameters::PerPlcAxis;

/// The letters after `ERROR IN PLC-PROGRAM`.
pub(crate) type PlcFaultCode = [u8; 2];

/// A command marker with its complement and the code of its fault.
struct Command {
    marker: Bit,
    complement: Bit,
    code: PlcFaultCode,
}

const fn command(marker: Bit, complement: Bit, code: &[u8; 2]) -> Command {
    Command {
        marker,
        complement,
        code: *code,
    }
}

use signal as s;
const START: Command = command(s::NC_START, s::NC_START_COMPLEMENT, b"1A");
const RAPID: Command = command(s::RAPID_TRAVERSE, s::RAPID_TRAVERSE_COMPLEMENT, b"1B");
const MEMORY: Command = command(s::AXIS_KEY_MEMORY, s::AXIS_KEY_MEMORY_COMPLEMENT, b"1C");
const FEED: Command = command(s::FEED_ENABLE, s::FEED_ENABLE_COMPLEMENT, b"1D");
const AXIS_KEYS: [[Command; 2]; AXES] = [
    [
        command(
            s::MANUAL_TRAVERSE_X_PLUS,
            s::MANUAL_TRAVERSE_X_PLUS_COMPLEMENT,
            b"1I",
        ),
        command(
            s::MANUAL_TRAVERSE_X_MINUS,
            s::MANUAL_TRAVERSE_X_MINUS_COMPLEMENT,
            b"1J",
        ),
    ],
    [
        command(
            s::MANUAL_TRAVERSE_Y_PLUS,
            s::MANUAL_TRAVERSE_Y_PLUS_COMPLEMENT,
            b"1K",
        ),
        command(
            s::MANUAL_TRAVERSE_Y_MINUS,
            s::MANUAL_TRAVERSE_Y_MINUS_COMPLEMENT,
            b"1L",
        ),
    ],
    [
        command(
            s::MANUAL_TRAVERSE_Z_PLUS,
            s::MANUAL_TRAVERSE_Z_PLUS_COMPLEMENT,
            b"1M",
        ),
        command(
            s::MANUAL_TRAVERSE_Z_MINUS,
            s::MANUAL_TRAVERSE_Z_MINUS_COMPLEMENT,
            b"1N",
        ),
    ],
    [
        command(
            s::MANUAL_TRAVERSE_4_PLUS,
            s::MANUAL_TRAVERSE_4_PLUS_COMPLEMENT,
            b"1O",
        ),
        command(
            s::MANUAL_TRAVERSE_4_MINUS,
            s::MANUAL_TRAVERSE_4_MINUS_COMPLEMENT,
            b"1P",
        ),
    ],
    [
        command(
            s::MANUAL_TRAVERSE_5_PLUS,
            s::MANUAL_TRAVERSE_5_PLUS_COMPLEMENT,
            b"2M",
        ),
        command(
            s::MANUAL_TRAVERSE_5_MINUS,
            s::MANUAL_TRAVERSE_5_MINUS_COMPLEMENT,
            b"2N",
        ),
    ],
];
const JOG_KEYS: [[Command; 2]; AXES] = [
    [
        command(s::JOG_X_PLUS, s::JOG_X_PLUS_COMPLEMENT, b"2A"),
        command(s::JOG_X_MINUS, s::JOG_X_MINUS_COMPLEMENT, b"2B"),
    ],
    [
        command(s::JOG_Y_PLUS, s::JOG_Y_PLUS_COMPLEMENT, b"2C"),
        command(s::JOG_Y_MINUS, s::JOG_Y_MINUS_COMPLEMENT, b"2D"),
    ],
    [
        command(s::JOG_Z_PLUS, s::JOG_Z_PLUS_COMPLEMENT, b"2E"),
        command(s::JOG_Z_MINUS, s::JOG_Z_MINUS_COMPLEMENT, b"2F"),
    ],
    [
        command(s::JOG_4_PLUS, s::JOG_4_PLUS_COMPLEMENT, b"2G"),
        command(s::JOG_4_MINUS, s::JOG_4_MINUS_COMPLEMENT, b"2H"),
    ],
    [
        command(s::JOG_5_PLUS, s::JOG_5_PLUS_COMPLEMENT, b"2I"),
        command(s::JOG_5_MINUS, s::JOG_5_MINUS_COMPLEMENT, b"2J"),
    ],
];

/// The complements of all commands; they are 1 while no command is given.
pub(crate) fn complements() -> impl Iterator<Item = Bit> {
    let single = [&START, &RAPID, &MEMORY, &FEED];
    let keys = AXIS_KEYS.iter().chain(&JOG_KEYS).flatten();
    single.into_iter().chain(keys).map(|command| command.complement)
}

/// The state of the panel after a PLC scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Panel {
    /// NC start became active with this scan (its edge is evaluated).
    pub started: bool,
    /// NC stop is given (M2488 = 0).
    pub stop: bool,
    /// Rapid traverse is pressed.
    pub rapid: bool,
    /// Axis direction keys are latched.
    pub memory: bool,
    /// Feed enable for all axes.
    pub feed_enable: bool,
    /// The direction key of each axis; none when both are pressed.
    pub axis_keys: PerPlcAxis<Option<Direction>>,
    /// The direction key of each axis for the jog increment became active with this scan.
    pub jog_started: PerPlcAxis<Option<Direction>>,
    start: bool,
    jog: PerPlcAxis<Option<Direction>>,
}

impl Panel {
    /// Reads the markers that the PLC set in a scan.
    ///
    /// # Errors
    /// The code of the first command whose marker and complement are equal.
    pub fn read(&self, plc: &Image) -> Result<Panel, PlcFaultCode> {
        let start = START.active(plc)?;
        let jog = if plc.bit(signal::ENABLE_JOG_INCREMENT) {
            keys(&JOG_KEYS, plc)?
        } else {
            PerPlcAxis::splat(None)
        };
        let mut jog_started = PerPlcAxis::splat(None);
        for ((started, now), before) in jog_started.iter_mut().zip(&jog).zip(&self.jog) {
            *started = now.filter(|_| before.is_none());
        }
        Ok(Panel {
            started: start && !self.start,
            stop: !plc.bit(signal::NC_STOP),
            rapid: RAPID.active(plc)?,
            memory: MEMORY.active(plc)?,
            feed_enable: FEED.active(plc)?,
            axis_keys: keys(&AXIS_KEYS, plc)?,
            jog_started,
            start,
            jog,
        })
    }
}

/// Buttons that act without a PLC program.
pub(crate) struct Buttons {
    pub start: bool,
    pub rapid: bool,
    /// Plus and minus of X, Y, Z, IV.
    pub directions: [[bool; 2]; 4],
}

/// Sets the commands that buttons give: start latches directions that are held, the feed is enabled, and NC stop is not
/// given.
pub(crate) fn press(buttons: &Buttons, plc: &mut Image) {
    let single = [
        (&START, buttons.start),
        (&MEMORY, buttons.start),
        (&RAPID, buttons.rapid),
        (&FEED, true),
    ];
    let pressed = buttons.directions.iter().flatten().copied();
    let directions = AXIS_KEYS
        .iter()
        .flatten()
        .zip(pressed.chain(std::iter::repeat(false)));
    for (command, pressed) in single.into_iter().chain(directions) {
        plc.set_bit(command.marker, pressed);
        plc.set_bit(command.complement, !pressed);
    }
    plc.set_bit(signal::NC_STOP, true);
}

impl Command {
    fn active(&self, plc: &Image) -> Result<bool, PlcFaultCode> {
        let (marker, complement) = (plc.bit(self.marker), plc.bit(self.complement));
        if marker == complement {
            return Err(self.code);
        }
        Ok(marker)
    }
}

fn keys(commands: &[[Command; 2]; AXES], plc: &Image) -> Result<PerPlcAxis<Option<Direction>>, PlcFaultCode> {
    let mut keys = PerPlcAxis::splat(None);
    for (key, [plus, minus]) in keys.iter_mut().zip(commands) {
        *key = match (plus.active(plc)?, minus.active(plc)?) {
            (true, false) => Some(Direction::Plus),
            (false, true) => Some(Direction::Minus),
            _ => None,
        };
    }
    Ok(keys)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]
    use bahn_exchange::BitArea;

    use super::*;

    fn m(number: u16) -> Bit {
        Bit::new(BitArea::M, number).unwrap()
    }

    /// All complements 1: no key is pressed.
    fn at_rest() -> Image {
        let mut plc = Image::default();
        for marker in (2464..=2467).chain(2472..=2479).chain(2540..=2541) {
            plc.set_bit(m(marker), true);
        }
        plc.set_bit(signal::NC_STOP, true);
        plc
    }

    fn press(plc: &mut Image, marker: u16, complement: u16) {
        plc.set_bit(m(marker), true);
        plc.set_bit(m(complement), false);
    }

    #[test]
    fn start_counts_once() {
        let mut plc = at_rest();
        press(&mut plc, 2448, 2464);
        let panel = Panel::default().read(&plc).unwrap();
        assert!(panel.started && !panel.stop);
        assert!(!panel.read(&plc).unwrap().started);
    }

    #[test]
    fn axis_keys_have_directions() {
        let mut plc = at_rest();
        press(&mut plc, 2457, 2473);
        press(&mut plc, 2460, 2476);
        let panel = Panel::default().read(&plc).unwrap();
        let expected = [Some(Direction::Minus), None, Some(Direction::Plus), None, None];
        assert_eq!(*panel.axis_keys, expected);
        press(&mut plc, 2456, 2472);
        assert_eq!(
            Panel::default().read(&plc).unwrap().axis_keys[0],
            None,
            "both keys"
        );
    }

    /// M2456 = M2472: flashing `ERROR IN PLC-PROGRAM 1I` [000:7543-7585].
    #[test]
    fn equal_markers_are_a_fault() {
        for (marker, code) in [
            (2464, b"1A"),
            (2467, b"1D"),
            (2472, b"1I"),
            (2479, b"1P"),
            (2541, b"2N"),
        ] {
            let mut plc = at_rest();
            plc.set_bit(m(marker), false);
            assert_eq!(Panel::default().read(&plc), Err(*code));
        }
    }

    #[test]
    fn jog_keys_count_only_when_enabled() {
        let mut plc = at_rest();
        assert!(
            Panel::default().read(&plc).is_ok(),
            "complements are not looked at"
        );
        plc.set_bit(signal::ENABLE_JOG_INCREMENT, true);
        assert_eq!(Panel::default().read(&plc), Err(*b"2A"));
        for marker in 2528..=2537 {
            plc.set_bit(m(marker), true);
        }
        press(&mut plc, 2513, 2529);
        let panel = Panel::default().read(&plc).unwrap();
        assert_eq!(panel.jog_started[0], Some(Direction::Minus));
        assert_eq!(panel.read(&plc).unwrap().jog_started[0], None);
    }
}
