//! The warm start: a flashing message goes when the key END is held for several seconds [003:7946].

use bahn_dialogue::Key;

use super::Station;
use crate::input::Refusal;

/// How long END is held, µs (inferred: several seconds).
const HELD_US: u64 = 3_000_000;

/// Since when END is held, µs.
#[derive(Default)]
pub(super) struct WarmStart(Option<u64>);

impl Station {
    /// A key of the keyboard goes down, which presses it, or comes up.
    pub(super) fn hold(&mut self, key: Key, down: bool) -> Result<(), Refusal> {
        if key == Key::End {
            self.warm_start.0 = down.then(|| self.host.control().time_us());
        }
        match down {
            true => self.key(key),
            false => Ok(()),
        }
    }

    /// END was held long enough before a flashing message: the control begins as after power-on.
    pub(super) fn start_warm(&mut self) {
        let Some(since_us) = self.warm_start.0 else { return };
        let control = self.host.control();
        let flashes = control.shown().iter().any(|shown| shown.flashing);
        if !flashes || control.is_off() || control.time_us().saturating_sub(since_us) < HELD_US {
            return;
        }
        self.warm_start.0 = None;
        self.power(false);
        self.console.power_off();
        self.plc.power_off();
        self.power(true);
    }
}
