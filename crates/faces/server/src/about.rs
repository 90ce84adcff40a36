//! What does not change while a station is on.

use bahn_service::{Presses, Surface, SurfaceShortcut};
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
    /// There is a time line; there are lessons; the part is shown.
    has_past: bool,
    has_teacher: bool,
    has_part: bool,
    /// What keys of a real keyboard do.
    shortcuts: Vec<ShortcutText>,
    /// The version of this program.
    version: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct KeyText {
    name: &'static str,
    group: &'static str,
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
    fn of(shortcut: &SurfaceShortcut) -> ShortcutText {
        let mut text = ShortcutText {
            real: shortcut.real,
            alt: shortcut.alt,
            key: None,
            machine: None,
            feed: None,
            spindle: None,
        };
        match shortcut.does {
            Presses::Key(name) => text.key = Some(name),
            Presses::Machine(name) => text.machine = Some(name),
            Presses::Feed(step) => text.feed = Some(step),
            Presses::Spindle(step) => text.spindle = Some(step),
        }
        text
    }
}

impl About {
    /// What does not change about a machine.
    pub fn of(surface: Surface) -> About {
        let keys = surface.keys.iter().map(|key| KeyText {
            name: key.name,
            group: key.group,
            label: key.label,
        });
        About {
            keys: keys.collect(),
            shortcuts: surface.shortcuts.iter().map(ShortcutText::of).collect(),
            machine: surface.name,
            model: surface.model,
            machine_keys: surface.machine_keys,
            axes: surface.axes,
            has_past: surface.has_past,
            has_teacher: surface.has_teacher,
            has_part: surface.has_part,
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}
