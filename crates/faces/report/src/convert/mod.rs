//! Programs in another language.
//!
//! - `converter`: makes and proves them; `library`: what a converted program calls; `report`: what is told of it.

mod converter;
mod library;
mod report;

pub use converter::{Converter, Job, Target, is_iso};
pub use library::Converted;
pub use report::{Report, Reports, line, text};
