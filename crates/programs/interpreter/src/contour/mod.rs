//! From contour elements to the path of the tool centre.
//!
//! Positioning blocks arrive as [`ContourMove`]s in workpiece coordinates. Two stages follow, each
//! holding back one element because it needs to see the next one:
//! `rounding` inserts roundings and chamfers, `compensation` offsets by the tool radius.

pub(crate) mod compensation;
mod corner;
mod corner_arc;
mod movement;
pub(crate) mod rounding;

use bahn_path::Plane;

pub(crate) use self::corner_arc::CornerArcs;

use self::compensation::CompensationStage;
use self::rounding::RoundingStage;
use crate::error::Fault;
use crate::output::Output;

pub(crate) use movement::{ContourMove, Corner, FeedLaw, Side, Smooth};

/// The stages in a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contour {
    rounding: RoundingStage,
    compensation: CompensationStage,
}

impl Contour {
    /// Stages that record a contour subprogram.
    pub fn recorder() -> Contour {
        Contour {
            rounding: RoundingStage::default(),
            compensation: CompensationStage::recorder(),
        }
    }

    /// Ends a recorded contour and gives its elements.
    pub fn take_recorded(&mut self, out: &mut Output) -> Result<Vec<ContourMove>, Fault> {
        self.flush(out)?;
        self.rounding = RoundingStage::default();
        Ok(self.compensation.take_recorded())
    }

    /// Takes the next movement.
    #[inline]
    pub fn push(&mut self, item: ContourMove, out: &mut Output) -> Result<(), Fault> {
        self.rounding.push(item, &mut self.compensation, out)
    }

    /// Whether the next uncompensated movement passes through unchanged.
    #[inline]
    pub fn is_idle(&self) -> bool {
        self.rounding.has_no_join() && self.compensation.is_idle()
    }

    /// Whether nothing is held back and no contour is compensated.
    pub fn is_empty(&self) -> bool {
        self.is_idle() && !self.holds_from(0)
    }

    /// Whether no contour is on its way; the last movement may be held back for a rounding that does not come.
    pub fn is_between_contours(&self) -> bool {
        self.is_idle() && !self.compensation.holds_from(0)
    }

    /// Whether something of a block at or after a sequence is held back.
    pub fn holds_from(&self, sequence: u64) -> bool {
        self.rounding.holds_from(sequence) || self.compensation.holds_from(sequence)
    }

    /// Whether a rounding or chamfer waits for the movement after it.
    pub fn has_join(&self) -> bool {
        self.rounding.has_join()
    }

    /// Hands out the movement held back for a rounding that does not come. Only when idle.
    #[inline]
    pub fn release(&mut self, out: &mut Output) {
        if let Some(held) = self.rounding.release() {
            out.push(held.element, held.barrier);
        }
    }

    /// Takes a rounding or chamfer between the last movement and the next.
    pub fn join(&mut self, join: rounding::Join) -> Result<(), Fault> {
        self.rounding.join(join)
    }

    /// Hands out everything that is held back, as if nothing followed.
    pub fn flush(&mut self, out: &mut Output) -> Result<(), Fault> {
        self.rounding.flush(&mut self.compensation, out)?;
        self.compensation.flush(out)
    }

    /// Where the tool centre really stands in the plane, when that is beside the programmed position.
    pub fn displaced(&self) -> Option<(Plane, bahn_path::Point2)> {
        self.compensation.displaced()
    }
}
