//! How the spindle of the machine turned on each element of the path.
//!
//! Decision: Spindle faults of a cut on a machine file are those of its spindle at the end of each element, not of M
//! and S

use std::collections::VecDeque;

use bahn_exchange::signal;
use bahn_host::ElementId;
use bahn_machine::Machine;
use bahn_path::{OverrideLaw, PathElement};
use bahn_servo::Rotation;
use bahn_tnc::Control;

use bahn_workpiece::Spindle;

/// Elements that were seen and are passed over at most, when one of them is looked for.
const PASSED_OVER: usize = 8;

/// What was seen of the spindle, by elements in their order: as many as were begun and not yet handed on.
#[derive(Default)]
pub(super) struct Turning {
    seen: VecDeque<(ElementId, Spindle)>,
    latest: Option<Spindle>,
}

impl Turning {
    /// Looks at the spindle, while the path moves. Only an analogue output turns the spindle of a machine file; of
    /// others the program alone tells.
    pub fn cycle(&mut self, control: &Control, machine: &Machine) {
        let analogue = control.memory().bit(signal::SPINDLE_IS_ANALOGUE);
        let Some(spindle) = machine.spindle().filter(|_| analogue) else {
            return;
        };
        let Some(element) = control.element().filter(|_| !control.stands()) else {
            return;
        };
        let state = control.spindle();
        let without_speed = state.programmed_rpm == 0.0 && state.rotation != Rotation::M5;
        let now = Spindle::seen(spindle.rpm, without_speed);
        match self.seen.back_mut().filter(|(last, _)| last.is_of(element)) {
            // In cycle 2 the spindle brakes on the way to the depth, as it should.
            Some(_) if is_tapping(element) => {}
            // What is so at the end of an element counts: until then the spindle may have come to speed.
            Some((_, then)) => *then = now,
            None => self.seen.push_back((ElementId::of(element), now)),
        }
    }

    /// How it turned on an element that is handed on; on one that was shorter than a cycle as on the one before.
    pub fn take(&mut self, element: &PathElement) -> Option<Spindle> {
        let mut first = self.seen.iter().take(PASSED_OVER);
        let found = first.position(|(seen, _)| seen.is_of(element));
        let passed = self
            .seen
            .iter()
            .take_while(|(seen, _)| seen.sequence < element.sequence);
        let count = found.map_or_else(|| passed.count(), |place| place + 1);
        if let Some((_, spindle)) = self.seen.drain(..count).next_back() {
            self.latest = Some(spindle);
        }
        self.latest
    }
}

fn is_tapping(element: &PathElement) -> bool {
    matches!(element.override_law, OverrideLaw::Tapping { .. })
}
