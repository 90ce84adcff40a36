//! Codes of keys, as the PLC and whoever has the keyboard exchange them [000:7309-7440].

use bahn_exchange::{Bit, BitArea, signal};

/// Marker that inhibits a key = its code + this [000:7326-7404].
const MARKER: u16 = 2796;
/// Codes of single keys [000:7338-7404].
const KEYS: std::ops::RangeInclusive<u16> = 58..=127;
/// Codes of soft keys by what they do [000:7424-7436]; the control itself does the others.
const SOFT_KEYS: [(u16, &str); 3] = [(0x0100, "M"), (0x0200, "S"), (0x0300, "TOUCH PROBE")];
/// Lower byte of a code of the alphabetic keyboard; the upper one is the character [000:7406-7410].
const ALPHABETIC: u8 = 0x50;

/// What a code calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyCode {
    /// A key of the keyboard, 58 to 127.
    Key(u16),
    /// The soft key with this name, in the modes by hand.
    SoftKey(&'static str),
    /// A key of the alphabetic keyboard, by its ASCII character.
    Character(u8),
}

impl KeyCode {
    /// Actual position capture [000:7511].
    pub(crate) const CAPTURE: u16 = 100;

    /// What a code calls; `None` for one that calls nothing, or that the manual's lost tables had.
    ///
    /// ```
    /// use bahn_tnc::KeyCode;
    /// assert_eq!(KeyCode::of(0x0200), Some(KeyCode::SoftKey("S")));
    /// assert_eq!(KeyCode::of(0x4150), Some(KeyCode::Character(b'A')));
    /// assert_eq!(KeyCode::of(57), None);
    /// ```
    pub fn of(code: u16) -> Option<KeyCode> {
        let [character, kind] = code.to_be_bytes();
        if KEYS.contains(&code) {
            return Some(KeyCode::Key(code));
        }
        if let Some((_, name)) = SOFT_KEYS.iter().find(|(known, _)| *known == code) {
            return Some(KeyCode::SoftKey(name));
        }
        (kind == ALPHABETIC && character.is_ascii_graphic()).then_some(KeyCode::Character(character))
    }

    /// Index of the axis whose key of the keyboard it is: X, Y and Z; those of IV and V are in the lost tables [000:7446-7535].
    pub(crate) fn axis(self) -> Option<usize> {
        const X_Y_Z: [u16; 3] = [109, 108, 107];
        X_Y_Z.iter().position(|code| self == KeyCode::Key(*code))
    }

    /// Its code; that of an unknown soft key is 0.
    pub fn code(self) -> u16 {
        match self {
            KeyCode::Key(code) => code,
            KeyCode::SoftKey(name) => {
                let mut known = SOFT_KEYS.iter();
                known.find(|(_, own)| *own == name).map_or(0, |(code, _)| *code)
            }
            KeyCode::Character(character) => u16::from_be_bytes([character, ALPHABETIC]),
        }
    }

    /// The marker with which the PLC inhibits it; soft keys by their place have one of their own, M2877 [000:7335].
    pub fn inhibit(self) -> Option<Bit> {
        match self {
            KeyCode::Key(code) => Bit::new(BitArea::M, MARKER + code),
            KeyCode::SoftKey(_) => None,
            KeyCode::Character(_) => Some(signal::INHIBIT_ALPHA_KEYBOARD),
        }
    }
}
