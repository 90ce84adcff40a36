//! What a text for LinuxCNC has beside the run.

use bahn_parameters::ControlModel;
use bahn_program::Unit;

/// What the text has beside the run.
#[derive(Clone, Debug)]
pub struct Options {
    /// The control that the run is of.
    pub model: ControlModel,
    /// Unit of the text: G21 or G20.
    pub unit: Unit,
    /// The block of the source after what comes of it.
    pub comments: bool,
    /// Arcs in rapid traverse, which LinuxCNC does not have, move with this feed, mm/min.
    pub rapid_mm_min: f64,
    /// Functions M00 to M99 of the machine builder as M100 to M199, which LinuxCNC gives to programs of its user.
    pub user_functions: bool,
}
