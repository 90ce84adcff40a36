//! Geometry of the tool path, the ground floor of the house.
//!
//! The face of this room is small:
//! - [`Axis`], [`AxisSet`], [`PerAxis`], [`Position`]: the nine programmable axes, something of each, and a point of them;
//! - [`Direction`], [`Sense`]: which way along an axis, and round; [`Switch`]: on or off;
//! - [`Plane`]: a working plane, which is two axes and the tool axis that stands on it;
//! - [`Curve`], [`Arc`], [`CornerArc`]: line, circular arc, helix and corner arc with length, tangent and splitting;
//! - [`Frame`]: datum shift, mirror image, rotation and scaling as one transformation;
//! - [`Swivels`], [`Placement`]: the swivel axes of a machine, and how a tilted or compensated path stands in it;
//! - [`region`]: areas of a plane with holes and true arcs, for the SL cycles;
//! - [`PathElement`]: one movement with its feed, block and technology functions;
//! - [`Synchronisation`]: when a function goes out, and where the path waits for it;
//! - [`ElementSource`] and [`Step`]: how every stage pulls elements from the stage before it.
//!
//! ```
//! use bahn_path::{Axis, Position};
//! let mut here = Position::UNKNOWN;
//! here[Axis::X] = 10.0;
//! assert_eq!((here.get(Axis::X), here.get(Axis::Y)), (Some(10.0), None));
//! assert_eq!(Axis::from_letter(b'C'), Some(Axis::C));
//! assert!(Axis::C.is_rotary());
//! ```
//!
//! Lengths are millimetres, angles degrees, feed rates mm/min, times seconds at every public face.
//! Nothing here knows of program text, time or hardware.

mod axis;
mod characteristic;
mod corner_arc;
mod curve;
mod cylinder;
mod direction;
mod element;
mod frame;
pub mod parallel;
mod placement;
mod plane;
pub mod region;
mod scan;
mod source;
mod switch;
mod swivel;
mod synchronisation;

pub use axis::{Axis, AxisSet, PerAxis, Position};
pub use characteristic::Characteristic;
pub use corner_arc::{Circle, CornerArc};
pub use curve::{Arc, Curve, angle_deg, sweep_deg};
pub use cylinder::Cylinder;
pub use direction::{Direction, Sense};
pub use element::{
    Ahead, At, Blank, BlockRef, ControlFunction, FeedRate, Function, OverrideLaw, Oversize, PathElement,
    SpindleOrder, TechnologyFunction, Thread, ToolCall, ToolShape, Voltage,
};
pub use frame::{AxisScaling, Frame};
pub use placement::Placement;
pub use plane::{Plane, Point2};
pub use scan::{
    MeasuringRules, ScanFault, ScanJob, ScanName, ScanPattern, ScanPoint, ScanRules, Scanned,
    deflection_along_axes,
};
pub use source::{Barrier, ElementSource, LiveData, MeasuredPart, Step, ToolMeasuring, Touch};
pub use switch::Switch;
pub use swivel::{Link, Swivels};
pub use synchronisation::{OutputPlace, Synchronisation, WaitPlace};
