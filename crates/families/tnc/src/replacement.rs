//! M101: a tool whose life is over is replaced between two blocks [000:9175-9177].
//!
//! Decision: M101 replaces a worn tool after a block, outside contours with radius compensation: what was read ahead
//! is read again after the change, and the path comes back to where it was, the tool axis last (also
//! `interpreter/src/outside.rs`)

use bahn_kernel::{Feeder, Track};
use bahn_parameters::MessageId;

use crate::language::OwnLanguage;
use crate::magazine::Magazine;
use crate::site::Site;
use crate::tools::Tools;

/// Radii that differ by less are the same, mm.
const SAME_RADIUS_MM: f64 = 1e-6;

/// What M101 makes of the tool in the spindle [000:9175].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wear {
    /// Nothing: the tool works on.
    None,
    /// Its life is over: this tool replaces it.
    Replace(u32),
    /// Its life is over, and no tool replaces it.
    Expired,
    /// The tool that replaces it is larger, and M107 is not in force.
    TooLarge,
}

impl Wear {
    /// The first of its replacement tools, and of theirs, that may be called and is not worn itself takes its place
    /// (inferred). Programs count on its radius: a smaller one leaves material, a larger one is refused unless M107
    /// allows it [000:9175-9177].
    pub fn of(tools: &Tools, magazine: &Magazine) -> Wear {
        let worn = tools.number;
        if !tools.replaces_worn || !tools.counts || tools.is_changing() || !magazine.life(worn).is_worn() {
            return Wear::None;
        }
        let mut tool = worn;
        // In a longer chain a tool stands twice.
        for _ in 0..magazine.count() {
            let Some(replacement) = magazine.life(tool).replacement else {
                return Wear::Expired;
            };
            tool = replacement;
            if magazine.may_be_called(tool) && !magazine.life(tool).is_worn() {
                let larger = magazine.radius(tool) > magazine.radius(worn) + SAME_RADIUS_MM;
                return match larger && !tools.takes_larger {
                    true => Wear::TooLarge,
                    false => Wear::Replace(tool),
                };
            }
        }
        Wear::Expired
    }

    /// Why the run cannot go on with it after the block.
    pub fn message(self) -> Option<MessageId> {
        match self {
            Wear::None | Wear::Replace(_) => None,
            Wear::Expired => Some(MessageId::MaxToolLifeExpired),
            Wear::TooLarge => Some(MessageId::ToolRadiusTooLarge),
        }
    }
}

/// Where a worn tool is to be replaced.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Replacement {
    /// The block before which, by its place in the order of execution.
    before: Option<u64>,
    /// The path stands there.
    due: bool,
}

impl Replacement {
    /// The block before which the path is to stop for it.
    pub fn place(&self) -> Option<u64> {
        self.before
    }

    /// The path stands at the end of a block: the tool is replaced there, outside the cycle, when it may be.
    pub fn is_here(&mut self, track: &Track, site: &Site) -> bool {
        let block_end = track.path.element().zip(track.path.next_element());
        self.due = track.has_output_all()
            && !site.handshakes.inhibit_read_in()
            && self
                .before
                .zip(block_end)
                .is_some_and(|(block, (last, next))| last.sequence < block && block <= next.sequence);
        self.due
    }

    /// Replaces a worn tool where the path has stopped for it, or finds where it is to stop, outside the cycle.
    pub fn prepare(&mut self, feeder: Option<&mut Feeder>, track: &mut Track, site: &Site) {
        let due = std::mem::take(&mut self.due);
        self.before = None;
        let (Wear::Replace(tool), Some(feeder)) = (Wear::of(site.tools, site.magazine), feeder) else {
            return;
        };
        let Some(after) = track.path.element().map(|element| element.sequence) else {
            return;
        };
        self.before = feeder.next_replacement(after, site.tools.number);
        let next = track.path.next_element().map(|element| element.sequence);
        if let Some((place, next)) = self.before.zip(next)
            && due
            && place <= next
        {
            track.path.clear();
            feeder.replace_tool_before(place, tool, site.chain);
            self.before = None;
        }
    }
}
