//! What a follower learns of the stylus, and how it wants it to go on.

use bahn_path::ScanPoint;

/// What the follower learns in a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Felt {
    pub at: ScanPoint,
    /// Where it is to be: it leads by the lag of the axes.
    pub nominal: ScanPoint,
    pub deflected: bool,
    pub touch: Option<ScanPoint>,
    pub deflection: ScanPoint,
    pub time_s: f64,
}

/// How the tip is to move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wish {
    /// Velocity of the tip, mm/s.
    pub velocity: ScanPoint,
    /// Axis that must not go beyond a coordinate in a direction.
    pub end: Option<(usize, f64, f64)>,
}

impl Wish {
    pub fn stand() -> Wish {
        Wish {
            velocity: [0.0; 3],
            end: None,
        }
    }

    /// Along a direction, mm/s.
    pub fn along(direction: ScanPoint, speed: f64) -> Wish {
        Wish {
            velocity: direction.map(|part| part * speed),
            end: None,
        }
    }
}

/// The plane in which a surface is followed: the direction along it and the one off it, unit vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tracking {
    pub along: ScanPoint,
    pub off: ScanPoint,
}

/// What a cycle of following comes to.
pub(super) enum Followed {
    Moves(Wish),
    /// A point, and how it goes on.
    Touched(ScanPoint, Wish),
    /// It gets no farther.
    Stuck,
}
