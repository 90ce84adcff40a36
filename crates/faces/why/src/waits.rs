//! What is waited for, and since when.

use bahn_host::{Host, LoadedMachine, Operable, Wired};
use bahn_path::BlockRef;
use bahn_screen::texts::Language;
use bahn_tnc::{Control, RunState, Waiting};

use crate::reason::{Reason, Urgency};
use crate::reasons::Situation;
use crate::trace::Writers;

/// A key of the panel counts so long as one that was to start something, µs.
const PRESSED_US: u64 = 20_000_000;
/// After so long a start has had its effect, µs.
const EFFECT_US: u64 = 400_000;

/// A run whose axes stand so long waits for something, µs.
const STANDS_US: u64 = 1_000_000;
/// Changes of what is waited for that are known at most.
const WAITED: usize = 256;

/// What a machine waits for, and since when.
pub struct Waits {
    wired: Vec<Wired>,
    writers: Writers,
    start: String,
    /// What was waited for from which time on, the oldest first.
    waited: Vec<(u64, Option<Waiting>)>,
    /// NC start was pressed, and nothing has come of it.
    pressed_us: Option<u64>,
    block: Option<BlockRef>,
    /// A program runs and its axes stand since then.
    stands_us: Option<u64>,
}

impl Waits {
    /// What it has to know of a machine and its plant; nothing is waited for yet.
    pub fn new(machine: &LoadedMachine, plant: &impl Operable) -> Waits {
        Waits {
            wired: plant.wires(),
            writers: Writers::of(&machine.plc),
            start: machine.folder.operator.start.clone(),
            waited: Vec::new(),
            pressed_us: None,
            block: None,
            stands_us: None,
        }
    }

    /// To be called after every cycle.
    pub fn follow(&mut self, control: &Control) {
        let now_us = control.time_us();
        // What was later belongs to a way that was left.
        while self.waited.pop_if(|(time, _)| *time > now_us).is_some() {}
        let waiting = control.waiting();
        if self.waited.last().and_then(|(_, waiting)| *waiting) != waiting {
            if self.waited.len() == WAITED {
                self.waited.remove(0);
            }
            self.waited.push((now_us, waiting));
        }
        // A run that goes on, an axis that moves, another block: the start had its effect.
        let block = control.element().map(|element| element.block);
        let another = self.block != block;
        self.block = block;
        let stands = control.run_state() == RunState::Running && control.stands() && !another;
        self.stands_us = stands.then(|| self.stands_us.unwrap_or(now_us));
        let old = self
            .pressed_us
            .is_some_and(|pressed| now_us > pressed + PRESSED_US);
        if old || another || control.run_state() == RunState::Running || !control.stands() {
            self.pressed_us = None;
        }
    }

    /// A key of the panel was pressed.
    pub fn pressed(&mut self, key: &str, now_us: u64) {
        if key == self.start {
            self.pressed_us = Some(now_us);
        }
    }

    /// The machine is at another moment.
    pub fn forget(&mut self) {
        self.pressed_us = None;
        self.stands_us = None;
    }

    /// How long a control has waited for what it waits for, s.
    fn waits_s(&self, control: &Control) -> f64 {
        let now_us = control.time_us();
        let begun = self.waited.iter().rfind(|(time, _)| *time <= now_us);
        let begun = begun.filter(|(_, waiting)| *waiting == control.waiting());
        begun.map_or(0.0, |(time, _)| (now_us - time) as f64 / 1e6)
    }

    /// The reasons, what is most urgent first.
    pub fn reasons<P: Operable>(
        &self,
        host: &Host<P>,
        machine: &LoadedMachine,
        language: Language,
    ) -> Vec<Reason> {
        let control = host.control();
        let now_us = control.time_us();
        let in_vain = self
            .pressed_us
            .is_some_and(|pressed| now_us >= pressed + EFFECT_US);
        let situation = Situation {
            control,
            plant: host.plant(),
            machine,
            wired: &self.wired,
            writers: &self.writers,
            language,
            waits_s: self.waits_s(control),
            start_in_vain: in_vain,
            stands_long: self.stands_us.is_some_and(|since| now_us >= since + STANDS_US),
        };
        let mut reasons = situation.reasons();
        reasons.sort_by_key(|reason| reason.urgency);
        reasons
    }
}

/// The reasons as the screen shows them, while something stands or waits.
pub fn in_words(reasons: &[Reason]) -> Vec<String> {
    let all = reasons
        .iter()
        .filter(|reason| reason.urgency != Urgency::Reported);
    all.map(|reason| match reason.causes.is_empty() {
        true => reason.text.clone(),
        false => format!("{} < {}", reason.text, reason.causes.join(", ")),
    })
    .collect()
}
