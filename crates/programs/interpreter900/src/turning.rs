//! Axes that turn: which of the ways to a place they go [002:6905-6916].
//!
//! Decision: G5 to G7 of a System 900 stay in force, G7 at the start; they count for absolute coordinates, those of G91 go as
//! they say. Half a turn goes in positive direction

/// Degrees below which an axis is where it is to be.
const NEAR_DEG: f64 = 1e-9;

/// The way to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// G5
    Positive,
    /// G6
    Negative,
    /// G7
    Shortest,
}

/// How an axis turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    /// One turn, degrees.
    deg: f64,
    /// G5 to G7 say which way: P12001 = 3; else the shortest.
    by_word: bool,
}

impl Turning {
    pub fn of((deg, by_word): (f64, bool)) -> Turning {
        Turning { deg, by_word }
    }

    /// The place to which it turns from where it is.
    pub fn end(self, way: Way, to: f64, here: f64) -> f64 {
        let ahead = (to - here).rem_euclid(self.deg);
        if ahead < NEAR_DEG || self.deg - ahead < NEAR_DEG {
            return here;
        }
        let back = ahead - self.deg;
        here + match way {
            Way::Positive if self.by_word => ahead,
            Way::Negative if self.by_word => back,
            _ if ahead <= -back => ahead,
            _ => back,
        }
    }
}
