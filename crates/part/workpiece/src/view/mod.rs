//! Pictures of the part: what all views share.

mod camera;
mod colouring;
mod deviation;
mod edges;
mod legend;
mod light;
mod page;
mod plan;
mod raycast;
mod scale;
mod scheme;
mod shade;
mod solid;
mod three_planes;
mod tool_path;

pub use camera::View3d;
pub use colouring::{Colouring, CutBy};
pub use plan::PlanView;
pub use scheme::Scheme;

pub use three_planes::{Projection, ThreePlanes};

use page::{Area, fit};
pub use page::{Page, PageError};
