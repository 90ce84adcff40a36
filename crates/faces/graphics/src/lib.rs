//! Graphics of TEST RUN and program run [003:854-945]: a part that is cut while a program is tested, another one that is
//! cut while it runs, and how the operator looks at them.
//!
//! - [`Graphics`] are those of a station, which says what is looked at, a [`Subject`];
//! - [`Picture`] is what is to be seen, drawn by whoever wants it, [`BeingCut`] the part itself;
//! - `stock` is the part that is being cut, which pictures are made of meanwhile;
//! - [`Trial`] tests a program with it, `follow` cuts what the machine has executed;
//! - `programmed` is what is seen while programming: `contour` the program as lines, `drawing` their picture, `figure`
//!   the cycle that is asked for;
//! - [`scope`] is the oscilloscope, whose curves stand in the same window.
//!
//! ```no_run
//! use bahn_graphics::{Graphics, Picture, Subject};
//! use bahn_host::Host;
//! use bahn_parameters::ParameterList;
//!
//! fn cut(host: &mut Host, list: &ParameterList) -> Option<Picture> {
//!     let mut graphics = Graphics::new(host);
//!     graphics.cycle(host);
//!     graphics.picture(Subject::Run, list)
//! }
//! ```
//!
//! In real time both cut on threads of their own; in simulation time with the machine, so that the same inputs give the same
//! screens.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod being_cut;
mod contour;
mod drawing;
mod figure;
mod follow;
mod graphics;
mod part_view;
mod picture;
mod programmed;
pub mod scope;
mod stock;
mod trial;

pub use being_cut::BeingCut;
pub use contour::Wish;
pub use graphics::{Graphics, Subject};
pub use picture::{Picture, PictureError};
pub use programmed::Asked;
pub use trial::Trial;
