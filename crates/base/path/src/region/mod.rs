//! Areas of the plane with boundaries of lines and true arcs: what the SL cycles are computed with.
//!
//! - [`Contour`] is a chain of [`Segment`]s, as a contour subprogram describes it;
//! - [`Region`] is an area with holes: boolean operations, offset, what a tool can reach, and the
//!   parallel passes that clear it ([`Region::hatch`]);
//! - [`superimpose`] makes the areas of cycle 14 CONTOUR GEOMETRY from pockets and islands by the start
//!   point rules, compensated and with their infeed points.
//!
//! An SL contour from subprograms to tool movements:
//!
//! ```
//! use bahn_path::Sense;
//! use bahn_path::region::{Contour, HatchPattern, Merge, SubContour, superimpose};
//! // LBL 1: X0 Y0 RL, X60, Y40, X0, Y0. LBL 2: a full circle about X30 Y20 with RR, counter-clockwise.
//! let pocket = SubContour::programmed(Contour::rectangle([0.0, 0.0], [60.0, 40.0]), true);
//! let island = SubContour::programmed(Contour::circle([30.0, 20.0], 8.0, 0.0, Sense::CounterClockwise), false);
//! let (tool_radius, allowance) = (3.0, 0.5);
//! let areas = superimpose(&[pocket, island], tool_radius + allowance, Merge::CentrePaths);
//! for area in &areas {
//!     // Channels: around the pocket counter-clockwise, around the island clockwise.
//!     for outline in &area.outlines {
//!         let _plunge_at = outline.infeed();
//!         for _segment in outline.contour.segments() { /* mill */ }
//!     }
//!     for pass in area.region.hatch(0.0, tool_radius, HatchPattern::Zigzag) {
//!         match &pass.link {
//!             Some(_way) => { /* mill to the start of the pass */ }
//!             None => { /* lift, traverse and plunge at pass.from */ }
//!         }
//!         // mill to pass.to
//!     }
//! }
//! // Infeed points: the start points moved aside by radius and allowance.
//! let infeeds: Vec<String> =
//!     areas[0].outlines.iter().map(|o| format!("{:.3?}", o.infeed())).collect();
//! assert_eq!(infeeds, ["[3.500, 3.500]", "[41.500, 20.000]"]);
//! ```
//!
//! Everything here works for any input that is finite: contours may touch, coincide, cross themselves or
//! hold no area. No arc is ever replaced by lines. Time grows with the size of input and result, not with
//! its square; an [`Effort`] counts it and may end every operation.

mod area;
mod arrangement;
mod contour;
mod edges;
mod effort;
mod faces;
mod hatch;
mod index;
mod intersect;
mod offset;
mod resolution;
mod segment;
mod superimpose;
mod vector;

pub use area::Region;
pub use contour::{Contour, Location};
pub use effort::{Effort, Unlimited};
pub use hatch::{HatchPattern, Pass};
pub use segment::Segment;
pub use superimpose::{Kind, Merge, Outline, PocketArea, SubContour, Superposition, superimpose};

pub use resolution::RESOLUTION_MM;
