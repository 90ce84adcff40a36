//! DIN 66025 as a TF5200 reads it: `.nc` programs with subroutines, expressions, variables and macros.
//!
//! A `Program` is the text of one file. A `Decoder` executes programs block by block and gives for each a
//! [`Unit`]: what it moves, which functions it orders, what else it commands. Whoever follows it answers for the
//! variables of the channel ([`Variables`]) and finds subroutines ([`Shelf`]).

mod unit;

pub use unit::{
    Command, Function, Independent, Kind, Motion, Place, Shelf, SpindleOrder, Target, Unit, Variable,
    Variables,
};
