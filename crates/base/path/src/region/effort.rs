//! What a computation may cost.
//!
//! Decision: A contour that crosses itself 300,000 times is refused: its crossings would take gigabytes (also
//! `interpreter/src/cycles/contour_pocket.rs`)

use std::convert::Infallible;

/// Counts the steps of a computation and may end it: an interrupt, a bound.
///
/// A step is a test of two segments, or of a segment and a point, or a search for those. Finding what is to
/// be tested takes the logarithm of the size of a contour beside.
pub trait Effort {
    /// Why a computation is given up.
    type Stop;

    /// What a common point of two segments or a part cut off counts, in steps: they take memory, too.
    const KEPT: usize = 1000;

    /// Called again and again in the course of a computation, with the steps since the last call.
    ///
    /// # Errors
    /// When the computation shall end.
    fn spend(&self, steps: usize) -> Result<(), Self::Stop>;
}

/// An effort without a limit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unlimited;

impl Effort for Unlimited {
    type Stop = Infallible;

    fn spend(&self, _: usize) -> Result<(), Infallible> {
        Ok(())
    }
}
