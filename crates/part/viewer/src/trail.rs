//! The path as it grows, for whoever looks on while it is executed.

use bahn_path::{Axis, PathElement, Position};

use crate::track::{Track, TrackTool, place};

/// Points that are kept: when there are more, lines become coarser, as in a page.
const MOST_POINTS: usize = 60_000;

/// The path as it grows, with its tools, in bounded memory.
#[derive(Clone, Debug)]
pub struct Trail {
    track: Track,
    /// How often it was begun anew.
    begun: u32,
}

/// How much of a path somebody has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Had {
    begun: u32,
    thinned: u32,
    points: usize,
}

impl Default for Trail {
    fn default() -> Trail {
        Trail {
            track: Track::of_points(MOST_POINTS),
            begun: 1,
        }
    }
}

impl Trail {
    /// Takes an element that was executed, with the time of its end, s.
    pub fn element(&mut self, element: &PathElement, end_s: f64) {
        self.track.element(element, end_s);
    }

    /// Forgets the path; the tool stays in the spindle.
    pub fn begin_anew(&mut self) {
        self.track.clear();
        self.begun = self.begun.wrapping_add(1);
    }

    /// Where the tool stands, X, Y, Z, and which of the tools it is.
    pub fn tool_at(&self) -> (Option<[f64; 3]>, usize) {
        (self.track.last(), self.track.tool())
    }

    /// A position as a place, X, Y, Z; `None` while an axis has none.
    pub fn place(position: &Position) -> Option<[f64; 3]> {
        place(position)
    }

    pub(crate) fn tools(&self) -> &[TrackTool] {
        self.track.tools()
    }

    /// What there is now.
    pub(crate) fn now(&self) -> Had {
        Had {
            begun: self.begun,
            thinned: self.track.times_thinned(),
            points: self.track.len(),
        }
    }

    /// From which point on somebody lacks the path. The last point may have moved on in time, so it is sent again.
    pub(crate) fn lacks_from(&self, had: Had) -> usize {
        let now = self.now();
        match (had.begun, had.thinned) == (now.begun, now.thinned) {
            true => had.points.min(now.points).saturating_sub(1),
            false => 0,
        }
    }

    /// The points from one on, as the page reads them: places on these axes, from `min`.
    pub(crate) fn written(&self, from: usize, order: [usize; 3], min: [f64; 3]) -> Vec<u8> {
        self.track.written(from, order, min, |block| Some(block.block))
    }
}

/// The places of axes among X, Y, Z.
pub(crate) fn order(axes: [Axis; 3]) -> [usize; 3] {
    axes.map(|axis| match axis {
        Axis::X => 0,
        Axis::Y => 1,
        _ => 2,
    })
}
