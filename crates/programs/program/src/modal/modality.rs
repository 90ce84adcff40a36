//! What a block says of the functions in force.

use bahn_path::{Axis, AxisSet};

/// Whether words count from the datum or from the last position: G90 or G91.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distance {
    /// G90: words count from the datum.
    Absolute,
    /// G91: words count from the last position.
    Incremental,
}

/// The G function that says how a block moves; it stays in force until another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathFunction {
    /// G00: line in rapid traverse.
    Rapid,
    /// G01: line.
    Line,
    /// G02: arc, clockwise.
    Clockwise,
    /// G03: arc, counter-clockwise.
    CounterClockwise,
    /// G05: arc in the last direction.
    Arc,
    /// G06: tangential arc.
    Tangential,
    /// G07: a single axis.
    Paraxial,
    /// G10: polar line in rapid traverse.
    PolarRapid,
    /// G11: polar line.
    PolarLine,
    /// G12: polar arc, clockwise.
    PolarClockwise,
    /// G13: polar arc, counter-clockwise.
    PolarCounterClockwise,
    /// G15: polar arc in the last direction.
    PolarArc,
    /// G16: polar tangential arc.
    PolarTangential,
}

impl PathFunction {
    /// All, each with the number of its G function.
    pub const ALL: [(u16, PathFunction); 13] = [
        (0, PathFunction::Rapid),
        (1, PathFunction::Line),
        (2, PathFunction::Clockwise),
        (3, PathFunction::CounterClockwise),
        (5, PathFunction::Arc),
        (6, PathFunction::Tangential),
        (7, PathFunction::Paraxial),
        (10, PathFunction::PolarRapid),
        (11, PathFunction::PolarLine),
        (12, PathFunction::PolarClockwise),
        (13, PathFunction::PolarCounterClockwise),
        (15, PathFunction::PolarArc),
        (16, PathFunction::PolarTangential),
    ];

    /// The number of its G function.
    pub fn code(self) -> u16 {
        let row = PathFunction::ALL.iter().find(|(_, function)| *function == self);
        row.map_or(0, |(code, _)| *code)
    }

    /// Whether it moves in rapid traverse, whatever feed stands in the block.
    #[inline]
    pub const fn is_rapid(self) -> bool {
        matches!(self, PathFunction::Rapid | PathFunction::PolarRapid)
    }

    /// Whether its end point is given by R and H.
    #[inline]
    pub(crate) const fn is_polar(self) -> bool {
        self as u8 >= PathFunction::PolarRapid as u8
    }
}

/// What a block says of the functions in force, and what it leaves to them.
///
/// A positioning block that has one is not complete: its kind, its direction, whether it is rapid traverse and
/// which words are incremental follow from it and from what the blocks before it have said. R stands in
/// [`Motion::polar_radius`](crate::Motion::polar_radius) until it is known whether it is that or the radius of an arc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modality {
    /// How the block moves; without it as the block before.
    pub function: Option<PathFunction>,
    /// What is in force after the block, if it says so.
    pub distance: Option<Distance>,
    /// The tool axis of G17 to G20, if a block without tool call says so.
    pub plane: Option<Axis>,
    /// Axes whose words stand before any G90 or G91 of the block.
    pub open: AxisSet,
    /// R stands before any G90 or G91 of the block.
    pub open_radius: bool,
    /// H stands before any G90 or G91 of the block.
    pub open_angle: bool,
}
