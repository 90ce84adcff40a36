//! The tilted working plane and the transformations before and in it [000:4250-4256].

use bahn_path::{Axis, Frame, Position};

/// A working plane that cycle 19 has tilted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WorkingPlane {
    /// Machine positions of the swivel axes in it, degrees.
    pub angles: Position,
    /// The transformations before it.
    pub outer: Frame,
}

/// Why the plane may not be tilted or put upright: transformations are ended in the reverse order of their beginning
/// [000:4254].
pub(crate) fn may_tilt(frame: &Frame, is_tilted: bool) -> Result<(), &'static str> {
    let plain = Frame {
        shift: frame.shift,
        ..Frame::identity(frame.plane)
    };
    let mut linear = Axis::ALL.into_iter().filter(|axis| !axis.is_rotary());
    if *frame != plain {
        Err("rotation, mirror image and scaling begin after cycle 19 and end before it")
    } else if is_tilted && linear.any(|axis| frame.shift[axis] != 0.0) {
        Err("a datum shift in the tilted plane is to end first")
    } else {
        Ok(())
    }
}

/// The transformations where nothing is tilted, of those in a plane; those of rotary axes as they are now.
pub(crate) fn outer_of(frame: &Frame, plane: Option<&WorkingPlane>) -> Frame {
    let Some(plane) = plane else { return *frame };
    let mut outer = plane.outer;
    for axis in Axis::ALL.into_iter().filter(|axis| axis.is_rotary()) {
        outer.shift[axis] = frame.shift[axis];
    }
    outer.plane = frame.plane;
    outer
}

/// The transformations in a plane that is tilted now: the datum is that of those before it; only rotary axes keep their shift.
pub(crate) fn within(outer: &Frame) -> Frame {
    let mut frame = *outer;
    for axis in Axis::ALL.into_iter().filter(|axis| !axis.is_rotary()) {
        frame.shift[axis] = 0.0;
    }
    frame
}
