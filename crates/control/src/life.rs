//! Tool life: what is counted from TOOL CALL to TOOL CALL in the automatic modes, and what its end leads to
//! [000:9160-9192].

use bahn_exchange::signal;
use bahn_interpreter::ToolState;
use bahn_plc::{TableFile, TableKind};

use crate::command::{CURRENT_MAX_MIN, Mode};
use crate::control::Control;
use crate::tables;

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

    /// M101 would now take the replacement tool into the spindle [000:9175]. Nothing here returns to the contour
    /// with it: the run stops at the end of each block, until another tool is called or the life is reset.
    pub(crate) fn would_replace_tool(&self) -> bool {
        self.tools.replaces_worn
            && self.tools.counts
            && !self.checking.skip_unknown
            && self.tools.life(self.tools.number).is_worn()
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
