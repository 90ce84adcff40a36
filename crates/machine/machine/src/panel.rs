//! The machine operating panel: keys, lamps, potentiometers [000:2622-2683].

use bahn_servo::{HandwheelKey, INPUTS, OUTPUTS, OperatorInputs};

use crate::event::KeyAction;
use crate::reader::{Coil, Contact, Section};

/// A key with one contact or, as NC START, with two [000:7598-7608].
#[derive(Clone, Debug)]
pub(crate) struct Key {
    pub name: String,
    contacts: Vec<Contact>,
    pub pressed: bool,
    /// Milliseconds until a tapped key is released.
    tapped_ms: u32,
}

impl Key {
    /// It is pressed until it is released.
    pub fn is_held(&self) -> bool {
        self.pressed && self.tapped_ms == 0
    }
}

/// The operating panel; the module describes its wiring.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    pub keys: Vec<Key>,
    pub lamps: Vec<(String, Coil)>,
    pub operator: OperatorInputs,
    /// Milliseconds until the tapped keys of the handwheel are released.
    wheel_taps_ms: [u32; HandwheelKey::NAMES.len()],
    wheel_is_tapped: bool,
    key_is_tapped: bool,
}

impl Panel {
    /// Reads `[keys]` and `[lamps]`.
    pub fn read(root: &Section) -> Panel {
        let key = |(name, contacts): (String, _)| Key {
            name,
            contacts,
            pressed: false,
            tapped_ms: 0,
        };
        Panel {
            keys: root.named_contacts("keys").into_iter().map(key).collect(),
            lamps: root.named_coils("lamps"),
            operator: OperatorInputs {
                feed_override_percent: 100.0,
                spindle_override_percent: 100.0,
                ..OperatorInputs::default()
            },
            wheel_taps_ms: [0; HandwheelKey::NAMES.len()],
            wheel_is_tapped: false,
            key_is_tapped: false,
        }
    }

    /// Presses, releases or taps a key. `false` when there is none of this name.
    pub fn act(&mut self, name: &str, action: KeyAction) -> bool {
        let Some(key) = self.keys.iter_mut().find(|key| key.name == name) else {
            return false;
        };
        key.pressed = action != KeyAction::Release;
        key.tapped_ms = if action == KeyAction::Tap {
            KeyAction::TAP_MS
        } else {
            0
        };
        self.key_is_tapped |= key.tapped_ms > 0;
        true
    }

    /// Presses, releases or taps a key of the handwheel.
    pub fn wheel_key(&mut self, key: HandwheelKey, action: KeyAction) {
        let keys = &mut self.operator.handwheel.keys;
        keys.set(key, action != KeyAction::Release);
        if let Some(tapped) = self.wheel_taps_ms.get_mut(key as usize) {
            *tapped = if action == KeyAction::Tap {
                KeyAction::TAP_MS
            } else {
                0
            };
            self.wheel_is_tapped |= *tapped > 0;
        }
    }

    /// The place of a key among all.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.keys.iter().position(|key| key.name == name)
    }

    pub fn pressed(&self, place: usize) -> bool {
        self.keys.get(place).is_some_and(|key| key.pressed)
    }

    /// A key goes back by itself soon.
    pub fn is_tapped(&self) -> bool {
        self.key_is_tapped || self.wheel_is_tapped
    }

    /// Lets a millisecond pass; whether a key goes back by itself in it.
    pub fn advance(&mut self) -> bool {
        let tapped = self.key_is_tapped;
        if tapped {
            self.key_is_tapped = false;
            for key in self.keys.iter_mut().filter(|key| key.tapped_ms > 0) {
                key.tapped_ms -= 1;
                key.pressed = key.tapped_ms > 0;
                self.key_is_tapped |= key.pressed;
            }
        }
        if self.wheel_is_tapped {
            self.wheel_is_tapped = false;
            for (tapped, (_, key)) in self.wheel_taps_ms.iter_mut().zip(HandwheelKey::NAMES) {
                if *tapped > 0 {
                    *tapped -= 1;
                    self.operator.handwheel.keys.set(key, *tapped > 0);
                    self.wheel_is_tapped |= *tapped > 0;
                }
            }
        }
        tapped
    }

    pub fn set_inputs(&self, inputs: &mut [bool; INPUTS]) {
        for key in &self.keys {
            for contact in &key.contacts {
                contact.set(inputs, key.pressed);
            }
        }
    }

    pub fn lamp(&self, name: &str, outputs: &[bool; OUTPUTS]) -> Option<bool> {
        let (_, coil) = self.lamps.iter().find(|(lamp, _)| lamp == name)?;
        Some(coil.is_on(outputs))
    }
}
