//! The seam of a program run to the family of its control.

use bahn_path::{AxisSet, LiveData, Position};

use crate::axes::OwnAxes;
use crate::kinematics::Chain;
use crate::now::Now;
use crate::spindle::SpindleLoop;
use crate::thread::{Leading, Standing};
use crate::track::Outputs;

/// Where a run acts: axes and spindle of a channel.
pub struct Acting<'a, 'b> {
    /// The axes of the channel.
    pub axes: &'a mut OwnAxes<'b>,
    /// The kinematics with datum and tool.
    pub chain: &'a mut Chain,
    /// The spindle that threads lead.
    pub spindle: &'a mut SpindleLoop,
    /// What holds for all movements of this cycle.
    pub now: &'a Now,
}

impl<'b> Acting<'_, 'b> {
    /// The path position at which the axes stand: no program knows the slave of a gantry or an axis of the PLC, which would
    /// count as parallel axes.
    pub fn here(&self) -> Position {
        self.chain.to_path(&self.axes.programmed_position())
    }

    /// Axes and spindle, to be looked at.
    pub fn standing(&self) -> Standing<'_> {
        Standing {
            axes: self.axes,
            chain: self.chain,
            spindle: self.spindle,
            now: self.now,
        }
    }

    /// Axes and spindle, to be led along a thread.
    pub fn leading(&mut self) -> Leading<'_, 'b> {
        Leading {
            axes: self.axes,
            chain: self.chain,
            spindle: self.spindle,
            now: self.now,
        }
    }
}

/// What a family decides in a program run. Its functions go to it as [`Outputs`].
pub trait RunFamily<'b>: Outputs {
    /// Where the run acts.
    fn acting(&mut self) -> Acting<'_, 'b>;

    /// Every function that was output is done.
    fn has_transferred(&self) -> bool;

    /// What a program that has waited for its functions goes on with.
    fn answer(&mut self) -> LiveData;
}

/// What a family demands of a run in a contour cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Demands {
    /// Blocks are executed one by one.
    pub single_block: bool,
    /// After the block that is executed none is.
    pub read_in_inhibited: bool,
    /// No more functions are taken now.
    pub crowded: bool,
    /// Axes are positioned beside the program: no block begins.
    pub positions: bool,
    /// The operator moves axes while the run is interrupted.
    pub by_hand: bool,
    /// Something stops the drives, not the path alone.
    pub drives_stopped: bool,
    /// The loop of the spindle is kept open.
    pub spindle_open: bool,
    /// The block before which the path stops, by its place in the order of execution.
    pub stop_before: Option<u64>,
    /// Axes that are to be clamped after their block.
    pub clamping: AxisSet,
}
