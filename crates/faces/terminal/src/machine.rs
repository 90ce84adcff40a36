//! The machine operating panel: its keys, and the letters that press them.

use bahn_panel::{EMERGENCY_STOP, Key};
use bahn_service::Surface;

/// Letters of the machine's keys in their order.
const LETTERS: &str = "abcdefghijklmnopqrstuvwxyz0123456789";
/// Presses EMERGENCY STOP among them.
pub(crate) const STOP_LETTER: char = '!';

/// What does not change while a machine is on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Machine {
    /// The name of the machine.
    pub name: String,
    /// Keys of the keyboard of its control.
    pub keyboard: Vec<Key>,
    /// Keys of its operating panel.
    pub keys: Vec<String>,
}

impl Machine {
    /// What is shown of a machine here. Keys that no letter of the keyboard names are pressed as those of the machine are.
    pub fn of(surface: &Surface) -> Machine {
        let named = surface
            .keys
            .iter()
            .map(|key| (key.name, Key::from_name(key.name)));
        let (known, own): (Vec<_>, Vec<_>) = named.partition(|(_, key)| key.is_some());
        let own = own.into_iter().map(|(name, _)| name.to_owned());
        Machine {
            name: surface.name.clone(),
            keyboard: known.into_iter().filter_map(|(_, key)| key).collect(),
            keys: surface.machine_keys.iter().cloned().chain(own).collect(),
        }
    }

    #[cfg(test)]
    pub fn of_keys(names: &[&str]) -> Machine {
        Machine {
            name: "test".to_owned(),
            keyboard: Key::ALL.to_vec(),
            keys: names.iter().map(|name| (*name).to_owned()).collect(),
        }
    }

    /// Whether the keyboard of its control has a key.
    pub fn has(&self, key: Key) -> bool {
        self.keyboard.contains(&key)
    }

    /// A key of the machine by its name, in whatever letters.
    pub fn key(&self, name: &str) -> Option<String> {
        let known = self.keys.iter().map(String::as_str).chain([EMERGENCY_STOP]);
        let mut found = known.filter(|key| key.eq_ignore_ascii_case(name));
        found.next().map(str::to_owned)
    }

    /// The letter that presses a key while the keys are those of the machine.
    pub fn letter(place: usize) -> Option<char> {
        LETTERS.chars().nth(place)
    }

    /// The key that a letter presses then, small or capital.
    pub fn lettered(&self, letter: char) -> Option<String> {
        let place = LETTERS.find(letter.to_ascii_lowercase())?;
        self.keys.get(place).cloned()
    }
}
