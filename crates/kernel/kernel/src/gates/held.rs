//! What holds a function back that is to go out ahead of its place.

/// Places nearer together than this are one, mm: a thousandth of the unit of a lead.
pub const SAME_MM: f64 = 1e-7;

/// What holds a function back that is to go out ahead of its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// Nothing: it goes out where it was planned.
    No,
    /// No more blocks, or no greater distance, are looked at.
    LookAhead,
    /// The path begins there or was to come to rest there, or what must not be crossed: another joint, a function that is
    /// waited for.
    Barrier,
}
