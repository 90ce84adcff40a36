//! A run of programs with M, H and S functions: `text` for people; `picture`: velocity, outputs and waits as a drawing.

mod picture;
mod text;

pub use picture::sheet;
pub use text::text;
