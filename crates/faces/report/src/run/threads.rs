//! Threads of a run, for its report.

use bahn_host::ThreadCut;
use bahn_tnc::ChannelView;
use serde::Serialize;

use super::listed::program_name;
use crate::record::tidy;

/// A thread that was cut, or begun.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Thread {
    pub program: String,
    pub block: u32,
    /// Number of the cycle: 2, 17 or 18.
    pub cycle: u8,
    /// Depth from where the tool axis begins, mm: commanded, and reached by the plant.
    pub depth_mm: f64,
    pub reached_mm: f64,
    /// Largest distance of the tool from where the angle of the spindle says, mm; in cycle 2 what the floating holder
    /// takes.
    pub off_mm: f64,
}

impl Thread {
    pub fn of(cut: &ThreadCut, channel: ChannelView) -> Thread {
        Thread {
            program: program_name(channel, cut.block),
            block: channel.number_of(cut.block),
            cycle: cut.cycle,
            depth_mm: tidy(cut.depth_mm),
            reached_mm: tidy(cut.reached_mm),
            off_mm: tidy(cut.off_mm),
        }
    }

    pub fn text(&self) -> String {
        let beyond = (self.reached_mm - self.depth_mm) * 1e3;
        let off = match self.cycle {
            2 => "the holder takes",
            _ => "off the spindle by",
        };
        format!(
            "{} block {}, cycle {}: {:.3} mm deep for {:.3} ({beyond:+.1} µm), {off} {:.4} mm",
            self.program, self.block, self.cycle, self.reached_mm, self.depth_mm, self.off_mm
        )
    }
}
