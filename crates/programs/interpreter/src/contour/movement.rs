//! What passes the contour stages: a movement, with what is to become of its end.

use bahn_path::parallel::Round;
pub(crate) use bahn_path::parallel::Side;
use bahn_path::{Barrier, PathElement, Plane};

use super::corner_arc::CornerArcs;

/// A movement (or a hold with functions) on its way to the output.
#[derive(Clone, Debug)]
pub(crate) struct ContourMove {
    /// Start and end on the programmed contour.
    pub element: PathElement,
    /// Working plane of radius compensation.
    pub plane: Plane,
    /// Side of the tool.
    pub side: Side,
    /// Tool radius including oversize, mm.
    pub radius: f64,
    /// What happens at the corner at the end of the element.
    pub corner: Corner,
    /// What the feed refers to on arcs.
    pub feed_law: FeedLaw,
    /// The movement touches an axis of the plane.
    pub in_plane: bool,
    /// Smooth approach or departure by RND [003:2477-2495].
    pub smooth: Option<Smooth>,
    /// What the run waits for after the element.
    pub barrier: Option<Barrier>,
    /// M112: an arc at the corner with the next line.
    pub corner_arcs: Option<CornerArcs>,
}

/// How the compensated path goes round the corner at the end of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Corner {
    /// Transition arc outside, intersection inside [003:2061-2076].
    #[default]
    Normal,
    /// M97: intersection outside too [003:3467-3493].
    Intersection,
    /// M98: both elements completely machined [003:3497-3512].
    Open,
}

impl Corner {
    /// As the geometry says it.
    pub fn round(self) -> Round {
        match self {
            Corner::Normal => Round::Arc,
            Corner::Intersection => Round::Meet,
            Corner::Open => Round::Open,
        }
    }
}

/// What the programmed feed refers to on arcs [000:5120-5126].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum FeedLaw {
    /// M111: path of the tool centre.
    #[default]
    Centre,
    /// M109: cutting edge, raised or lowered.
    Edge,
    /// M110: cutting edge, lowered only.
    EdgeReduced,
}

/// A smooth approach or departure on an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Smooth {
    pub radius: f64,
    pub feed_mm_min: Option<f64>,
    pub block: bahn_path::BlockRef,
}
