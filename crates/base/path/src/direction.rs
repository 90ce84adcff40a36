//! Which way something goes: along an axis, or round.

use std::fmt;

/// A direction along an axis.
///
/// ```
/// use bahn_path::Direction;
/// assert_eq!(Direction::of(-0.5), Some(Direction::Minus));
/// assert_eq!((Direction::Minus.sign(), Direction::Minus.to_string()), (-1.0, "-".to_owned()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The position grows.
    Plus,
    /// The position becomes less.
    Minus,
}

impl Direction {
    /// Both, plus first.
    pub const BOTH: [Direction; 2] = [Direction::Plus, Direction::Minus];

    /// The direction of a value's sign; `None` for 0.
    pub fn of(value: f64) -> Option<Direction> {
        match value {
            value if value > 0.0 => Some(Direction::Plus),
            value if value < 0.0 => Some(Direction::Minus),
            _ => None,
        }
    }

    /// Minus where something says so, as a bit of a machine parameter does; otherwise plus.
    pub fn minus_if(minus: bool) -> Direction {
        if minus { Direction::Minus } else { Direction::Plus }
    }

    /// +1 for plus, -1 for minus: the factor of a distance or feed.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Plus => 1.0,
            Direction::Minus => -1.0,
        }
    }

    /// `+` or `-`, as it stands after the letter of an axis.
    pub fn symbol(self) -> char {
        match self {
            Direction::Plus => '+',
            Direction::Minus => '-',
        }
    }

    /// The other direction.
    #[must_use]
    pub fn opposite(self) -> Direction {
        match self {
            Direction::Plus => Direction::Minus,
            Direction::Minus => Direction::Plus,
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.symbol())
    }
}

/// A sense of rotation, seen against the tool axis.
///
/// ```
/// use bahn_path::Sense;
/// assert_eq!(Sense::of_sweep(-90.0), Sense::Clockwise);
/// assert_eq!(Sense::Clockwise.sign(), -1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Angles grow: DR+ [003:2715-2720].
    CounterClockwise,
    /// Angles become less: DR- [003:2715-2720].
    Clockwise,
}

impl Sense {
    /// The sense of an arc with this sweep, degrees.
    pub fn of_sweep(sweep_deg: f64) -> Sense {
        if sweep_deg > 0.0 {
            Sense::CounterClockwise
        } else {
            Sense::Clockwise
        }
    }

    /// +1 counter-clockwise, -1 clockwise: the factor of an angle.
    pub fn sign(self) -> f64 {
        match self {
            Sense::CounterClockwise => 1.0,
            Sense::Clockwise => -1.0,
        }
    }

    /// The other sense.
    #[must_use]
    pub fn opposite(self) -> Sense {
        match self {
            Sense::CounterClockwise => Sense::Clockwise,
            Sense::Clockwise => Sense::CounterClockwise,
        }
    }
}
