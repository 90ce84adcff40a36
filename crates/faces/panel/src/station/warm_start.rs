//! The warm start: a flashing message goes when the key END is held for several seconds [003:7946].
//!
//! Decision: END is held for 3 s for the warm start, which is power-off and power-on, on all controls

use bahn_dialogue::Key;
use bahn_machine::Button;
use bahn_tnc::Control;

/// How long END is held, µs (inferred: several seconds).
const HELD_US: u64 = 3_000_000;

/// Since when END is held, µs.
#[derive(Default)]
pub(super) struct WarmStart(Option<u64>);

impl WarmStart {
    /// A key of the keyboard goes down or comes up, at a time, µs.
    pub(super) fn hold(&mut self, key: Key, button: Button, now_us: u64) {
        if key == Key::End {
            self.0 = button.is_pressed().then_some(now_us);
        }
    }

    /// Whether END was held long enough before a flashing message; it is said once.
    pub(super) fn is_due(&mut self, control: &Control) -> bool {
        let Some(since_us) = self.0 else { return false };
        let flashes = control.shown().iter().any(|shown| shown.flashing);
        let is_due = flashes && !control.is_off() && control.time_us().saturating_sub(since_us) >= HELD_US;
        if is_due {
            self.0 = None;
        }
        is_due
    }
}
