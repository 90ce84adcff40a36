//! A run of programs with M, H and S functions: `text` for people; `picture`: velocity, outputs and waits as a drawing;
//! `rows`: what parameters and types mean.

mod picture;
pub mod rows;
mod text;

pub use picture::sheet;
pub use text::text;
