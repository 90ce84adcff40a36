//! What does not change while a station is on.

use bahn_service::{Key, Machine, Press, SHORTCUTS, Shortcut};
use serde::Serialize;

/// What does not change while a station is on.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct About {
    /// Name of the machine.
    machine: String,
    /// The control model, as people read it.
    model: String,
    /// The keyboard of the model.
    keys: Vec<KeyText>,
    /// Keys of the machine operating panel.
    machine_keys: Vec<String>,
    /// Axes that a handwheel can move.
    axes: String,
    /// What keys of a real keyboard do.
    shortcuts: Vec<ShortcutText>,
    /// The version of this program.
    version: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct KeyText {
    name: &'static str,
    group: String,
    label: &'static str,
}

/// Exactly one of `key`, `machine`, `feed` and `spindle` is there.
#[derive(Clone, Debug, Serialize)]
struct ShortcutText {
    real: &'static str,
    alt: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    key: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    machine: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    feed: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    spindle: Option<f64>,
}

impl ShortcutText {
    fn of(shortcut: &Shortcut) -> ShortcutText {
        let mut text = ShortcutText {
            real: shortcut.real,
            alt: shortcut.alt,
            key: None,
            machine: None,
            feed: None,
            spindle: None,
        };
        match shortcut.press {
            Press::Key(key) => text.key = Some(key.name()),
            Press::Machine(name) => text.machine = Some(name),
            Press::Feed(step) => text.feed = Some(step),
            Press::Spindle(step) => text.spindle = Some(step),
        }
        text
    }
}

impl About {
    /// What does not change about a machine.
    pub fn of(machine: &Machine) -> About {
        let key = |key: &Key| KeyText {
            name: key.name(),
            group: format!("{:?}", key.group()).to_lowercase(),
            label: key.label(),
        };
        let is_there = |shortcut: &&Shortcut| match shortcut.press {
            Press::Key(key) => machine.keyboard.contains(&key),
            _ => true,
        };
        About {
            machine: machine.name.clone(),
            model: machine.model.name().to_owned(),
            keys: machine.keyboard.iter().map(key).collect(),
            machine_keys: machine.machine_keys.clone(),
            axes: machine.axes.clone(),
            shortcuts: SHORTCUTS.iter().filter(is_there).map(ShortcutText::of).collect(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}
