//! What the functions of a block do to the block itself.

use bahn_path::TechnologyFunction;

use crate::contour::Corner;

/// What the M functions of a block do to the block itself.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockFunctions {
    /// M90: constant speed at the corner [003:3439-3457].
    pub constant_speed: bool,
    /// M91, M92, M93: what the coordinates refer to [003:3533-3553].
    pub reference: Reference,
    /// M97, M98: how the radius compensation passes its corner.
    pub corner: Corner,
    /// M99, or M89 in force: call the cycle after the movement.
    pub cycle_call: bool,
    /// Stop after the block.
    pub stop: bool,
    /// Program end after the block.
    pub end: bool,
    /// What goes out, with its place.
    pub output: Vec<TechnologyFunction>,
}

/// What the coordinates of a block refer to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Reference {
    #[default]
    Datum,
    /// M91: machine zero.
    MachineZero,
    /// M92: machine datum of MP950.
    MachineDatum,
    /// M93: current position.
    Position,
}
