//! What the tests of the viewer share.
#![allow(dead_code, unused_imports, reason = "each test uses its own part of this")]

mod screen;

use bahn_path::{Axis, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Position};

pub use screen::{Reader, Screen};

/// A straight line.
pub fn element(from: [f64; 3], to: [f64; 3]) -> PathElement {
    let at = |[x, y, z]: [f64; 3]| {
        let mut position = Position::UNKNOWN;
        (position[Axis::X], position[Axis::Y], position[Axis::Z]) = (x, y, z);
        position
    };
    PathElement {
        block: BlockRef::default(),
        sequence: 0,
        curve: Curve::Line,
        start: at(from),
        end: at(to),
        feed: FeedRate::Programmed(100.0),
        override_law: OverrideLaw::Free,
        constant_speed: false,
        tangential_end: false,
        end_feed: None,
        dwell_s: 0.0,
        placement: None,
        functions: None,
    }
}
