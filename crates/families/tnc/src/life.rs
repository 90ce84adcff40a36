//! Tool life: what is counted from TOOL CALL to TOOL CALL in the automatic modes, and what its end leads to
//! [000:9160-9192].
//!
//! Decision: Tool life counts from TOOL CALL on, in steps of 0.1 minutes beside the tool table

use bahn_exchange::{Exchange, signal};
use bahn_plc::{TableFile, TableKind};

use crate::command::CURRENT_MAX_MIN;
use crate::magazine::Magazine;
use crate::plc_link::NcFiles;
use crate::tables;
use crate::tools::Tools;

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
    reported: Option<u32>,
}

/// What counts in a contour cycle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counting {
    pub cycle_us: u32,
    /// Blocks of a program are executed.
    pub runs: bool,
}

impl LifeCount {
    /// One contour cycle: the time of the tool in the spindle is counted, and the tables say what was changed. Whether
    /// something has changed that is to be stored: it is on the medium before the PLC sees the end of a tool change.
    pub fn follow(
        &mut self,
        counting: Counting,
        tools: &mut Tools,
        magazine: &mut Magazine,
        exchange: &mut Exchange,
        files: &mut NcFiles,
    ) -> bool {
        if let Some(measured) = tools.measured.take() {
            tables::take_measured(&measured, magazine, files);
            tools.changed = true;
        }
        self.count(counting, tools, magazine, files);
        self.tell_time1(tools.number, magazine, exchange);
        let changed = std::mem::take(&mut tools.changed);
        if changed {
            tables::mirror_pockets(magazine, files);
            magazine.touch();
        }
        changed
    }

    /// Adds the time that has passed to the life of the tool in the spindle.
    fn count(&mut self, counting: Counting, tools: &Tools, magazine: &mut Magazine, files: &mut NcFiles) {
        let counts = tools.counts && counting.runs && !tools.is_changing();
        let goes_on = counts && self.tool == tools.number;
        let due = if goes_on { STEP_US } else { 1 };
        if self.uncounted_us >= due {
            let minutes = std::mem::take(&mut self.uncounted_us) as f64 / US_PER_MIN;
            let before = magazine.life(self.tool).current_min;
            let current = (before + minutes).min(CURRENT_MAX_MIN);
            set(magazine, files, self.tool, current);
        }
        self.tool = tools.number;
        if counts {
            self.uncounted_us += u64::from(counting.cycle_us);
        }
    }

    /// M2094 follows TIME1 of the tool in the spindle on its edges: the PLC may reset it, too [000:9173].
    fn tell_time1(&mut self, number: u32, magazine: &Magazine, exchange: &mut Exchange) {
        let elapsed = magazine.life(number).time1_elapsed().then_some(number);
        if elapsed != self.reported {
            self.reported = elapsed;
            exchange.nc_set(signal::TOOL_LIFE_TIME1_ELAPSED, elapsed.is_some());
        }
    }
}

/// The current life of a tool, minutes, with the tool table that modules see; `false` when there is no such tool.
pub(crate) fn set(magazine: &mut Magazine, files: &mut NcFiles, number: u32, minutes: f64) -> bool {
    let known = magazine.set_life(number, minutes);
    let table = files.tables.get_mut(&TableKind::Tool);
    if let (true, Some(table), Ok(line)) = (known, table, i32::try_from(number)) {
        table.set_value(line, tables::CURRENT_TIME, minutes);
    }
    known
}
