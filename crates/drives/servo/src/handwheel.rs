//! What a handwheel sends to the control [000:8060-8446].

/// Wheels at most: an HRA 110 has three [000:8310].
pub const WHEELS: usize = 3;

/// A handwheel as the control sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandwheelInputs {
    /// It is plugged in.
    pub connected: bool,
    /// Counting steps of each wheel since power-on.
    pub counts: [i64; WHEELS],
    /// The keys that are pressed.
    pub keys: HandwheelKeys,
    /// Positions of the step switches S1 and S2 of an HRA 110, from 1; 0 where there is none [000:8353-8385].
    pub switches: [u8; 2],
}

impl Default for HandwheelInputs {
    /// A wheel that stands still, without keys.
    fn default() -> HandwheelInputs {
        HandwheelInputs {
            connected: true,
            counts: [0; WHEELS],
            keys: HandwheelKeys::default(),
            switches: [0; 2],
        }
    }
}

/// A key of a handwheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "they are named as on the keys")]
pub enum HandwheelKey {
    X,
    Y,
    Z,
    Fourth,
    Fifth,
    Plus,
    Minus,
    Rapid,
    Slow,
    Medium,
    Fast,
    Capture,
    A,
    B,
    C,
    /// The five keys of an HR 332 without a function of their own.
    Free1,
    Free2,
    Free3,
    Free4,
    Free5,
}

impl HandwheelKey {
    /// All keys with their names.
    pub const NAMES: [(&'static str, HandwheelKey); 20] = [
        ("X", HandwheelKey::X),
        ("Y", HandwheelKey::Y),
        ("Z", HandwheelKey::Z),
        ("IV", HandwheelKey::Fourth),
        ("V", HandwheelKey::Fifth),
        ("+", HandwheelKey::Plus),
        ("-", HandwheelKey::Minus),
        ("RAPID", HandwheelKey::Rapid),
        ("SLOW", HandwheelKey::Slow),
        ("MEDIUM", HandwheelKey::Medium),
        ("FAST", HandwheelKey::Fast),
        ("CAPTURE", HandwheelKey::Capture),
        ("A", HandwheelKey::A),
        ("B", HandwheelKey::B),
        ("C", HandwheelKey::C),
        ("1", HandwheelKey::Free1),
        ("2", HandwheelKey::Free2),
        ("3", HandwheelKey::Free3),
        ("4", HandwheelKey::Free4),
        ("5", HandwheelKey::Free5),
    ];

    /// The key of this name, such as those of the script; `None` where there is none.
    pub fn named(name: &str) -> Option<HandwheelKey> {
        let mut keys = HandwheelKey::NAMES.iter();
        keys.find(|(known, _)| *known == name).map(|(_, key)| *key)
    }
}

/// The keys that are pressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HandwheelKeys(u32);

impl HandwheelKeys {
    /// Whether a key is pressed.
    pub fn has(self, key: HandwheelKey) -> bool {
        self.0 & 1 << key as u32 != 0
    }

    /// Presses or releases a key.
    pub fn set(&mut self, key: HandwheelKey, pressed: bool) {
        if pressed {
            self.0 |= 1 << key as u32;
        } else {
            self.0 &= !(1 << key as u32);
        }
    }
}
