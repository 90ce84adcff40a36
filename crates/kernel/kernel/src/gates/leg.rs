//! An element of a path between two places.

use std::sync::Arc;

use bahn_path::{BlockRef, Curve, FeedRate, PathElement, Position};

/// How a movement is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driving {
    /// It goes in rapid traverse.
    pub rapid: bool,
    /// Programmed feed, mm/min.
    pub feed_mm_min: f64,
    /// What limits it beside the axes.
    pub limit: VectorLimit,
}

/// Limits of the path itself, as `#VECTOR LIMIT` sets them: infinite where there are none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VectorLimit {
    /// Greatest velocity along the path, mm/min.
    pub velocity_mm_min: f64,
    /// Greatest acceleration, mm/s²: both slopes have the lesser of ACC and DEC.
    pub acceleration_mm_s2: f64,
}

impl VectorLimit {
    /// The axes alone limit the path.
    pub const NONE: VectorLimit = VectorLimit {
        velocity_mm_min: f64::INFINITY,
        acceleration_mm_s2: f64::INFINITY,
    };
}

/// An element of the path.
#[derive(Clone, Debug)]
pub struct Leg {
    /// Line or arc from start to end.
    pub curve: Curve,
    /// Path position where it begins.
    pub start: Position,
    /// Path position where it ends.
    pub end: Position,
    /// How it is driven.
    pub driving: Driving,
    /// The name of its block.
    pub block: Arc<str>,
    /// Count of executed blocks.
    pub unit: u64,
    /// Length along the path, mm.
    pub length_mm: f64,
    /// Distance along the path to its start, mm.
    pub from_mm: f64,
}

impl Leg {
    /// Distance along the path to its end, mm.
    pub fn to(&self) -> f64 {
        self.from_mm + self.length_mm
    }

    /// The place so far along it, mm.
    pub fn place(&self, along: f64) -> Position {
        let part = if self.length_mm > 0.0 {
            along / self.length_mm
        } else {
            1.0
        };
        self.curve.position(&self.start, &self.end, part.clamp(0.0, 1.0))
    }

    /// Its parts before and after a place so far along it, mm.
    pub fn split(&self, along: f64) -> (Leg, Leg) {
        let at = along / self.length_mm;
        let part = |from: f64, to: f64| {
            let (curve, start, end) = self.curve.part(&self.start, &self.end, from, to);
            Leg {
                curve,
                start,
                end,
                length_mm: self.length_mm * (to - from),
                from_mm: self.from_mm + self.length_mm * from,
                ..self.clone()
            }
        };
        let (mut first, mut second) = (part(0.0, at), part(at, 1.0));
        (first.length_mm, second.length_mm) = (along, self.length_mm - along);
        (second.from_mm, second.end) = (self.from_mm + along, self.end);
        first.end = second.start;
        (first, second)
    }

    /// What is left of it after a place so far along it, or, backward, what lies from there to its start.
    pub fn rest(&self, along: f64, backward: bool) -> Leg {
        let at = if self.length_mm > 0.0 {
            along / self.length_mm
        } else {
            1.0
        };
        if !backward {
            return self.split(along).1;
        }
        let (curve, start, end) = self.curve.part(&self.start, &self.end, 0.0, at);
        let curve = match curve {
            Curve::Arc(arc) => Curve::Arc(bahn_path::Arc {
                sweep_deg: -arc.sweep_deg,
                ..arc
            }),
            other => other,
        };
        Leg {
            curve,
            start: end,
            end: start,
            length_mm: along,
            ..self.clone()
        }
    }

    /// As the planner takes it, with this number.
    pub fn element(&self, sequence: u64) -> PathElement {
        let Driving {
            rapid,
            feed_mm_min,
            limit,
        } = self.driving;
        let feed = if rapid {
            FeedRate::Rapid
        } else {
            FeedRate::Programmed(feed_mm_min)
        };
        let feed = feed.up_to(limit.velocity_mm_min);
        let ends = [self.start, self.end];
        PathElement::new(BlockRef::default(), sequence, self.curve, ends, feed)
    }
}
