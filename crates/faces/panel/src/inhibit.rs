//! Keys that the PLC inhibits, and keys that it simulates [000:7309-7440].

use bahn_dialogue::{Key, KeyGroup};
use bahn_exchange::signal;
use bahn_tnc::{Command, KeyCode};

use crate::site::Site;

/// Codes of keys that the manual's example names; its table of the others is lost [000:7446-7535].
const CODES: [(u16, Key); 6] = [
    (60, Key::L),
    (100, Key::Capture),
    (107, Key::Z),
    (108, Key::Y),
    (109, Key::X),
    (119, Key::End),
];

/// What the PLC presses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simulated {
    /// A key of the keyboard.
    Key(Key),
    /// The soft key with this name, wherever it is shown.
    SoftKey(&'static str),
}

/// Whether the PLC inhibits a key; it is told that the key was pressed then, where a code says which.
pub(crate) fn is_inhibited(key: Key, site: &mut Site) -> bool {
    let is_set = |site: &Site, marker| site.control().memory().bit(marker);
    if let Some(code) = code(key) {
        let inhibited = code.inhibit().is_some_and(|marker| is_set(site, marker));
        if inhibited {
            site.command(Command::Key(code.code()));
        }
        return inhibited;
    }
    match key {
        Key::SkLeft | Key::SkRight => is_set(site, signal::INHIBIT_SCREEN_KEYS),
        _ if key.soft_key().is_some() => is_set(site, signal::INHIBIT_SOFT_KEYS),
        _ if key.group() == KeyGroup::Letter => is_set(site, signal::INHIBIT_ALPHA_KEYBOARD),
        _ => false,
    }
}

/// The key that the PLC has simulated in this cycle.
pub(crate) fn simulated(site: &mut Site) -> Option<Simulated> {
    let key = match site.host.take_key()? {
        KeyCode::SoftKey(name) => return Some(Simulated::SoftKey(name)),
        KeyCode::Character(character) => Key::of_character(char::from(character)),
        KeyCode::Key(code) => {
            let mut known = CODES.iter();
            known.find(|(known, _)| *known == code).map(|(_, key)| *key)
        }
    };
    key.map(Simulated::Key)
}

/// The code of a key, where one is known.
fn code(key: Key) -> Option<KeyCode> {
    if key.group() == KeyGroup::Letter {
        let letter = key.character().and_then(|letter| u8::try_from(letter).ok())?;
        return Some(KeyCode::Character(letter));
    }
    let known = CODES.iter().find(|(_, known)| *known == key);
    known.map(|(code, _)| KeyCode::Key(*code))
}
