//! The tool path tip, for pictures.

use crate::setup::Local;

/// Movements that are kept; more are no picture that somebody could look at, and take memory.
const MOST_MOVES: usize = 2_000_000;

/// A straight movement in the blank, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Move {
    pub from: [f32; 3],
    pub to: [f32; 3],
    pub rapid: bool,
}

/// The movements in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trail {
    moves: Vec<Move>,
}

impl Trail {
    /// `false` when there are too many.
    pub fn push(&mut self, from: Local, to: Local, rapid: bool) -> bool {
        if self.moves.len() >= MOST_MOVES {
            return false;
        }
        let [from, to] = [from, to].map(|point| point.map(|value| value as f32));
        self.moves.push(Move { from, to, rapid });
        true
    }

    pub fn moves(&self) -> &[Move] {
        &self.moves
    }

    /// The same from another corner of the blank, mm.
    pub fn seen_from(&self, corner: [f64; 2]) -> Trail {
        let shifted = |mut point: [f32; 3]| {
            for k in 0..2 {
                point[k] -= corner[k] as f32;
            }
            point
        };
        let moved = |m: &Move| Move {
            from: shifted(m.from),
            to: shifted(m.to),
            rapid: m.rapid,
        };
        Trail {
            moves: self.moves.iter().map(moved).collect(),
        }
    }
}
