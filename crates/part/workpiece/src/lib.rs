//! What is left of the workpiece.
//!
//! The face of this room:
//! - [`Workpiece`]: takes a [`bahn_path::Blank`] and path elements, removes what the tool sweeps, and
//!   collects what the operator should know ([`Event`]);
//! - [`Cutting`]: follows a program from its BLK FORM on, with its tools and its spindle, and reports to who [`Hears`];
//! - [`Part`]: the material as it is now ([`Workpiece::part`]): removed volume, heights, probing, who cut what ([`CutBy`]);
//! - views of it as an [`Image`]: [`Part::plan_view`], [`Part::three_planes`], [`Part::view_3d`], each
//!   on a [`Page`] with a title line;
//! - [`Part::deviation`] from another part, as numbers and [`Part::deviation_view`];
//! - [`Part::write_stl`]: the finished part as a closed mesh; [`Part::from_stl`]: a solid from one;
//! - [`Feeler`]: a ball that feels its way over a part.
//!
//! The material is a height map over the working plane of the blank: square columns of equal size
//! that tile the blank exactly, each with one height along the tool axis. Everything that a tool in
//! the tool axis can leave behind, undercuts excepted, is such a map.
//!
//! ```
//! use bahn_path::{Axis, Blank, Plane, Position};
//! use bahn_workpiece::{Resolution, Workpiece};
//!
//! let blank = Blank { plane: Plane::XY, min: [0.0, 0.0, -20.0], max: [100.0, 80.0, 0.0] };
//! let workpiece = Workpiece::new(&blank, Resolution::BySize)?;
//! assert_eq!(workpiece.finished().removed_mm3(), 0.0);
//! # Ok::<(), bahn_workpiece::WorkpieceError>(())
//! ```
//!
//! Lengths are millimetres in workpiece coordinates, volumes mm³, angles degrees.

mod batch;
mod chords;
mod coarsen;
mod cutters;
mod cutting;
mod deviation;
mod event;
mod feeler;
mod grid;
mod leads;
mod part;
mod raster;
mod round;
mod setup;
mod solid;
mod stl;
mod strip;
mod sweep;
mod tool;
mod touch;
mod track;
mod trail;
mod view;
mod workpiece;

pub use cutting::{Columns, Cutting, Hears, Memory, Remark, Spindle};
pub use deviation::Deviation;
pub use event::{Event, EventKind};
pub use feeler::Feeler;
pub use grid::{MAX_CELLS, Resolution};
pub use part::Part;
pub use solid::SolidError;
pub use stl::{MAX_TRIANGLES, MeshError};
pub use view::{Colouring, CutBy, Page, PageError, PlanView, Projection, Scheme, ThreePlanes, View3d};
pub use workpiece::{Workpiece, WorkpieceError};
