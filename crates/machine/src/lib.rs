//! The simulated machine: what the control drives when no real one is there.
