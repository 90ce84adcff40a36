//! Keys that the PLC inhibits, and keys that it simulates [000:7309-7440].

use bahn_control::Command;
use bahn_dialogue::{Key, KeyGroup};
use bahn_exchange::{Bit, BitArea};

use crate::site::Site;

/// Marker of a key = code + this [000:7326-7404].
const KEY_MARKER: u16 = 2796;
/// Inhibits the alphabetic keyboard, the soft-key row, the keys that change it [000:7326-7336].
const ALPHABET: u16 = 2876;
const SOFT_KEYS: u16 = 2877;
const SOFT_KEY_ROWS: u16 = 2878;

/// Codes of keys that the manual's example names; its table of the others is lost [000:7446-7535].
const CODES: [(u16, Key); 6] = [
    (60, Key::L),
    (100, Key::Capture),
    (107, Key::Z),
    (108, Key::Y),
    (109, Key::X),
    (119, Key::End),
];

/// Codes of soft keys by what they do [000:7424-7436]; the control itself does the others.
const FUNCTIONS: [(u16, &str); 3] = [(0x0100, "M"), (0x0200, "S"), (0x0300, "TOUCH PROBE")];
/// Lower byte of a code of the alphabetic keyboard; the upper one is the character [000:7406-7410].
const ALPHABETIC: u8 = 0x50;

/// What the PLC presses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simulated {
    /// A key.
    Key(Key),
    /// The soft key with this name, wherever it is shown.
    SoftKey(&'static str),
}

/// Whether the PLC inhibits a key; it is told that the key was pressed then.
pub(crate) fn is_inhibited(key: Key, site: &mut Site) -> bool {
    let is_set = |site: &Site, marker| {
        let marker = Bit::new(BitArea::M, marker);
        marker.is_some_and(|marker| site.control().memory().bit(marker))
    };
    if let Some(code) = code(key) {
        if is_set(site, KEY_MARKER + code) {
            site.command(Command::Key(code));
            return true;
        }
        return false;
    }
    let group = match key {
        Key::SkLeft | Key::SkRight => SOFT_KEY_ROWS,
        _ if key.soft_key().is_some() => SOFT_KEYS,
        _ if key.group() == KeyGroup::Letter => {
            let inhibited = is_set(site, ALPHABET);
            let letter = key.character().and_then(|letter| u8::try_from(letter).ok());
            if let Some(letter) = letter.filter(|_| inhibited) {
                site.command(Command::Key(u16::from_be_bytes([letter, ALPHABETIC])));
            }
            return inhibited;
        }
        _ => return false,
    };
    is_set(site, group)
}

/// The key that the PLC has simulated in this cycle.
pub(crate) fn simulated(site: &mut Site) -> Option<Simulated> {
    let code = site.host.take_key()?;
    let [character, kind] = code.to_be_bytes();
    if let Some((_, name)) = FUNCTIONS.iter().find(|(known, _)| *known == code) {
        return Some(Simulated::SoftKey(name));
    }
    let key = match kind {
        ALPHABETIC if character > 0 => Key::of_character(char::from(character)),
        _ => CODES
            .iter()
            .find(|(known, _)| *known == code)
            .map(|(_, key)| *key),
    };
    key.map(Simulated::Key)
}

/// The code of a key, where one is known.
fn code(key: Key) -> Option<u16> {
    CODES
        .iter()
        .find(|(_, known)| *known == key)
        .map(|(code, _)| *code)
}
