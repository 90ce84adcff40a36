//! How far a run goes.

/// How far a run goes at most: what is longer ends with the fault `endless` at the block where it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Time of the run, s.
    pub time_s: f64,
    /// Blocks that are executed.
    pub blocks: u64,
}

impl Default for Bounds {
    /// A day, and far more blocks than anybody waits for.
    fn default() -> Bounds {
        Bounds {
            time_s: 86_400.0,
            blocks: 50_000_000,
        }
    }
}
