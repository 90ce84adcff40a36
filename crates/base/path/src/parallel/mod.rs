//! Paths beside a contour, and what is put into its corners: what radius compensation, roundings and chamfers are computed
//! with, an element and the next one at a time.
//!
//! - [`Flat`] is an element seen in its plane, with its parallel ([`Flat::offset`]) and intersections;
//! - [`joint`] leads from one parallel to the next round the corner between their elements;
//! - [`rounding`] and [`chamfer`] are put between two elements.
//!
//! ```
//! use bahn_path::{Plane, Sense};
//! use bahn_path::parallel::{Flat, Round, Side, joint};
//! // Along X and up along Y, the tool with a radius of 5 mm to the left: inside the corner.
//! let contour = [
//!     Flat::Line { start: [0.0, 0.0], end: [50.0, 0.0] },
//!     Flat::Line { start: [50.0, 0.0], end: [50.0, 30.0] },
//! ];
//! let beside = contour.map(|element| element.offset(5.0));
//! if let [Some(before), Some(after)] = beside {
//!     let joint = joint(Plane::XY, contour, [before, after], Side::Left, Round::Arc);
//!     assert_eq!(joint.map(|joint| joint.start), Some([45.0, 5.0]));
//! }
//! ```

mod corner;
pub mod flat;
mod joint;
mod side;

pub use corner::{Rounded, TooLarge, chamfer, cut, rounding};
pub use flat::{Flat, SAME_POINT_MM};
pub use joint::{Ending, Joint, Round, joint, meeting, turn_deg, what_is_left};
pub use side::Side;
