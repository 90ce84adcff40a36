//! Tool life: what is counted from TOOL CALL to TOOL CALL in the automatic modes, and what its end leads to
//! [000:9160-9192].

use bahn_exchange::signal;
use bahn_interpreter::ToolState;
use bahn_parameters::MessageId;
use bahn_plc::{TableFile, TableKind};

use crate::command::{CURRENT_MAX_MIN, Mode};
use crate::control::Control;
use crate::tables;
use crate::tools::Tools;

/// The lives of a tool in the tool table, minutes; 0 is no limit (inferred).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToolLife {
    /// TIME1: behind it the PLC is told (M2094).
    pub time1_min: f64,
    /// TIME2: behind it TOOL CALL calls the replacement tool.
    pub time2_min: f64,
    /// CUR.TIME: how long it has worked.
    pub current_min: f64,
    /// RT: its replacement tool.
    pub replacement: Option<u32>,
}

impl ToolLife {
    /// Whether it may be called.
    pub fn state(&self) -> ToolState {
        match (self.is_beyond(self.time2_min), self.replacement) {
            (false, _) => ToolState::Usable,
            (true, None) => ToolState::Expired,
            (true, Some(replacement)) => ToolState::Replaced(replacement),
        }
    }

    /// TIME1 is over.
    fn time1_elapsed(&self) -> bool {
        self.is_beyond(self.time1_min)
    }

    /// M101 replaces it: the first of the two lives is over (inferred: the manual names both).
    fn is_worn(&self) -> bool {
        self.time1_elapsed() || self.is_beyond(self.time2_min)
    }

    fn is_beyond(&self, life_min: f64) -> bool {
        life_min > 0.0 && self.current_min > life_min
    }
}

/// How finely CUR.TIME is counted: 0.1 minutes (inferred; the table shows whole ones).
const STEP_US: u64 = 6_000_000;
const US_PER_MIN: f64 = 60e6;
/// Radii that differ by less are the same, mm.
const SAME_RADIUS_MM: f64 = 1e-6;

/// The count of the tool in the spindle.
#[derive(Clone, Debug, Default)]
pub(crate) struct LifeCount {
    /// Not yet in CUR.TIME, of which tool.
    uncounted_us: u64,
    tool: u32,
    /// The tool for which M2094 was set.
    told: Option<u32>,
    /// The lives have changed: the interpreter is to know.
    pub changed: bool,
    /// The block before which a worn tool is to be replaced, by its place in the order of execution.
    replace_before: Option<u64>,
    /// The path stands there.
    due: bool,
}

impl Control {
    /// One contour cycle.
    pub(crate) fn count_tool_life(&mut self) {
        let counts = self.tools.counts
            && self.run.is_active()
            && matches!(self.mode, Mode::SingleBlock | Mode::FullSequence)
            && !self.tools.is_changing();
        let goes_on = counts && self.life.tool == self.tools.number;
        let due = if goes_on { STEP_US } else { 1 };
        if self.life.uncounted_us >= due {
            let minutes = std::mem::take(&mut self.life.uncounted_us) as f64 / US_PER_MIN;
            let before = self.tools.life(self.life.tool).current_min;
            self.set_tool_life(self.life.tool, (before + minutes).min(CURRENT_MAX_MIN));
        }
        self.life.tool = self.tools.number;
        if counts {
            self.life.uncounted_us += u64::from(self.cycle_us());
        }
        self.tell_time1();
    }

    /// The current life of a tool, minutes; `false` when there is no such tool.
    pub(crate) fn set_tool_life(&mut self, number: u32, minutes: f64) -> bool {
        let Some(life) = self.tools.life_mut(number) else {
            return false;
        };
        life.current_min = minutes;
        self.life.changed = true;
        if let (Some(table), Ok(line)) = (
            self.link.files.tables.get_mut(&TableKind::Tool),
            i32::try_from(number),
        ) {
            table.set_value(line, tables::CURRENT_TIME, minutes);
        }
        true
    }

    /// M2094 follows TIME1 of the tool in the spindle on its edges: the PLC may reset it, too [000:9173].
    fn tell_time1(&mut self) {
        let number = self.tools.number;
        let elapsed = self.tools.life(number).time1_elapsed().then_some(number);
        if elapsed != self.life.told {
            self.life.told = elapsed;
            self.exchange
                .nc_set(signal::TOOL_LIFE_TIME1_ELAPSED, elapsed.is_some());
        }
    }

    /// What the interpreter is to know of worn tools, outside the cycle.
    pub(crate) fn take_tool_states(&mut self) {
        if std::mem::take(&mut self.life.changed)
            && let Some(feeder) = &mut self.run.feeder
        {
            feeder.interpreter_mut().set_barred_tools(self.tools.barred());
        }
    }

    /// The path stands at the end of a block: the tool is replaced there, outside the cycle, when it may be.
    pub(crate) fn replaces_here(&mut self) -> bool {
        let block_end = self.path.element().zip(self.path.next_element());
        self.life.due = self.run.waiting.is_empty()
            && !self.handshakes.inhibit_read_in()
            && self
                .life
                .replace_before
                .zip(block_end)
                .is_some_and(|(block, (last, next))| last.sequence < block && block <= next.sequence);
        self.life.due
    }

    /// The block before which a worn tool is to be replaced.
    pub(crate) fn replacement_place(&self) -> Option<u64> {
        self.life.replace_before
    }

    /// Replaces a worn tool where the path has stopped for it, or finds where it is to stop, outside the cycle.
    pub(crate) fn prepare_replacement(&mut self) {
        let due = std::mem::take(&mut self.life.due);
        self.life.replace_before = None;
        let (Wear::Replace(tool), Some(feeder)) = (self.tools.wear(), &mut self.run.feeder) else {
            return;
        };
        let Some(behind) = self.path.element().map(|element| element.sequence) else {
            return;
        };
        self.life.replace_before = feeder.next_replacement(behind, self.tools.number);
        let next = self.path.next_element().map(|element| element.sequence);
        if let Some((place, next)) = self.life.replace_before.zip(next)
            && due
            && place <= next
        {
            self.path.clear();
            feeder.replace_tool_before(place, tool, self.offsets);
            self.life.replace_before = None;
        }
    }
}

/// What M101 makes of the tool in the spindle [000:9175].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wear {
    /// It works on.
    None,
    /// Its life is over: this tool replaces it.
    Replace(u32),
    /// Its life is over, and no tool replaces it.
    Expired,
    /// The tool that replaces it is larger, and M107 is not in force.
    TooLarge,
}

impl Wear {
    /// Why the run cannot go on with it behind the block.
    pub fn message(self) -> Option<MessageId> {
        match self {
            Wear::None | Wear::Replace(_) => None,
            Wear::Expired => Some(MessageId::MaxToolLifeExpired),
            Wear::TooLarge => Some(MessageId::ToolRadiusTooLarge),
        }
    }
}

impl Tools {
    /// The first of its replacement tools, and of theirs, that may be called and is not worn itself takes its place
    /// (inferred). Programs count on its radius: a smaller one leaves material, a larger one is refused unless M107
    /// allows it [000:9175-9177].
    pub(crate) fn wear(&self) -> Wear {
        let worn = self.number;
        if !self.replaces_worn || !self.counts || self.is_changing() || !self.life(worn).is_worn() {
            return Wear::None;
        }
        let mut tool = worn;
        // In a longer chain a tool stands twice.
        for _ in 0..self.count() {
            let Some(replacement) = self.life(tool).replacement else {
                return Wear::Expired;
            };
            tool = replacement;
            if self.may_be_called(tool) && !self.life(tool).is_worn() {
                let larger = self.radius(tool) > self.radius(worn) + SAME_RADIUS_MM;
                return match larger && !self.takes_larger {
                    true => Wear::TooLarge,
                    false => Wear::Replace(tool),
                };
            }
        }
        Wear::Expired
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_life_of_zero_never_ends() {
        let life = |time1_min, time2_min, current_min| ToolLife {
            time1_min,
            time2_min,
            current_min,
            replacement: None,
        };
        assert_eq!(life(0.0, 0.0, 1e6).state(), ToolState::Usable);
        assert!(!life(0.0, 0.0, 1e6).is_worn());
        // Greater than, not equal [000:9168-9173].
        assert_eq!(life(10.0, 20.0, 20.0).state(), ToolState::Usable);
        assert_eq!(life(10.0, 20.0, 20.1).state(), ToolState::Expired);
        assert!(!life(10.0, 20.0, 10.0).time1_elapsed() && life(10.0, 20.0, 10.1).time1_elapsed());
        assert!(life(0.0, 20.0, 20.1).is_worn() && life(10.0, 0.0, 10.1).is_worn());
    }
}
