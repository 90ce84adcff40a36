//! The face of a run: what it is given.

use bahn_din::{Unit, Variables};
use bahn_motion::Limits;
use bahn_path::Position;

use crate::bounds::Bounds;
use crate::plc::Script;
use crate::report::Fault;
use crate::settings::ChannelSettings;

/// Programs in turn on one channel.
///
/// Time, PLC, spindles and functions that are still open go over from one to the next, which starts where it ended.
pub struct Run<'a> {
    /// The programs, the first of them first.
    pub programs: &'a dyn Sequence,
    /// What the channel parameter list says.
    pub settings: &'a ChannelSettings,
    /// Dynamics; a cycle of the PLC is one of the path.
    pub limits: &'a Limits,
    /// Where the path starts.
    pub start: Position,
    /// Block of the programs of the first file that the run begins with (`N50`): what is before it is not output and not
    /// moved.
    pub from: Option<&'a str>,
    /// How far it goes at most.
    pub bounds: Bounds,
    /// What the PLC does; without it a virtual one acknowledges each function its process time after it was output.
    pub script: Option<&'a Script>,
}

/// The programs of a run in their order: it asks for each by its place, for none by a name.
pub trait Sequence {
    /// How many there are.
    fn count(&self) -> usize;

    /// Name of the file of a program.
    fn name(&self, index: usize) -> String;

    /// Begins a program where the path is.
    ///
    /// # Errors
    /// When it cannot be begun.
    fn open(&self, index: usize, start: &Position) -> Result<Box<dyn Blocks + '_>, Fault>;
}

/// A program that is decoded block by block.
pub trait Blocks {
    /// The next block; `None` after the end.
    ///
    /// # Errors
    /// What is wrong with the block.
    fn next(&mut self, variables: &mut dyn Variables) -> Result<Option<Unit>, Fault>;

    /// Whether the next block is this one (`N50`, `#12`).
    fn next_is(&mut self, block: &str) -> bool;

    /// Where the path stands after the blocks that were handed on.
    fn position(&self) -> Position;

    /// There is no such block.
    fn not_found(&self, block: &str) -> Fault;
}
