//! What stays in force from block to block, with the state at the start of a program [002:5075-5143].

use bahn_path::{Axis, PerAxis};
use bahn_system900::{Memory, PathParameter};

/// How axes move to what is programmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interpolation {
    Rapid,
    Line,
    Clockwise,
    CounterClockwise,
}

/// What stays in force.
#[derive(Clone, Debug)]
pub(crate) struct Modal {
    pub interpolation: Interpolation,
    /// G17 to G19, G117 to G119.
    pub plane: u16,
    pub is_absolute: bool,
    /// Radius and angle are programmed: G10.
    pub is_polar: bool,
    /// The zero point, by its G function.
    pub zero_point: u16,
    /// G92.
    pub shift: PerAxis<f64>,
    /// G44: the axis shifts P8000 ff. act.
    pub shifts_axes: bool,
    /// G45: P160, P161, P163 as they were in its block.
    pub rotation: Option<Rotation>,
    /// G61, G62.
    pub mirrors: [bool; 2],
    /// G28.
    pub stops_exactly: bool,
    /// G63: overrides have no effect.
    pub is_feed_fixed: bool,
    /// G95: the feed counts for a turn of the spindle.
    pub is_per_turn: bool,
    pub feed: f64,
    pub speed_rpm: f64,
    /// G81, G83, G85 act at each position.
    pub drilling: Option<u16>,
}

/// A rotation of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotation {
    pub origin: [f64; 2],
    pub angle_deg: f64,
}

impl Modal {
    /// At the start of a program.
    pub fn at_start(memory: &Memory, channel: u8) -> Modal {
        let point = memory.path(channel, PathParameter::ZeroPoint).whole();
        let point = point.and_then(|point| u16::try_from(point).ok());
        Modal {
            interpolation: Interpolation::Line,
            plane: 17,
            is_absolute: true,
            is_polar: false,
            zero_point: point.filter(|point| *point != 0).unwrap_or(53),
            shift: PerAxis::splat(0.0),
            shifts_axes: false,
            rotation: None,
            mirrors: [false; 2],
            stops_exactly: false,
            is_feed_fixed: false,
            is_per_turn: false,
            feed: 0.0,
            speed_rpm: 0.0,
            drilling: None,
        }
    }

    /// G92 shifts an axis.
    pub fn shift_axis(&mut self, axis: Axis, by: f64) {
        self.shift[axis] = by;
    }
}
