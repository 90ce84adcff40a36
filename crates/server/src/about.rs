//! What does not change while a station is on.

use bahn_panel::{Key, Station};
use serde::Serialize;

/// What does not change while a station is on.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct About {
    /// Name of the machine.
    machine: String,
    /// Its control model.
    model: String,
    /// The keyboard.
    keys: Vec<KeyText>,
    /// Keys of the machine operating panel.
    machine_keys: Vec<String>,
    /// Axes that a handwheel can move.
    axes: String,
    /// The version of this program.
    version: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct KeyText {
    name: &'static str,
    group: String,
    label: &'static str,
}

impl About {
    /// Of a station.
    pub fn of(station: &Station) -> About {
        let key = |key: &Key| KeyText {
            name: key.name(),
            group: format!("{:?}", key.group()).to_lowercase(),
            label: key.label(),
        };
        About {
            machine: station.machine().folder.name.clone(),
            model: station.control().model().name().to_owned(),
            keys: Key::ALL.iter().map(key).collect(),
            machine_keys: station.machine_keys(),
            axes: station.control().axis_letters().collect(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}
