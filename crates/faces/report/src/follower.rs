//! Who follows a run while it goes on.

/// Sees how far a run has come and what happens in it, and may end it.
pub trait Follower {
    /// A main program of so many blocks begins.
    fn begin(&mut self, blocks: u32);

    /// An element of the path was done: its block in the main program, `None` inside a called program; and the time of
    /// machining so far, s.
    fn element(&mut self, block: Option<u32>, machining_time_s: f64);

    /// What happens, in words.
    fn say(&mut self, line: &str);

    /// Whether the run is to end before its end.
    fn is_interrupted(&self) -> bool;
}
