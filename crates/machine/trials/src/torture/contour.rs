//! The contour of a program as its undisturbed run has it: curves, whatever the time on them was.

use std::collections::HashMap;

use bahn_path::{Axis, BlockRef, Curve, PathElement, Position};

/// Elements around the last one that are looked at first.
const NEAR: usize = 24;

/// The curves of a program in the order of its run.
#[derive(Clone, Debug, Default)]
pub(super) struct Contour {
    elements: Vec<PathElement>,
    by_block: HashMap<BlockRef, Vec<usize>>,
}

impl Contour {
    pub fn add(&mut self, element: PathElement) {
        let place = self.elements.len();
        self.by_block.entry(element.block).or_default().push(place);
        self.elements.push(element);
    }

    pub fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }

    /// How far a place is from the curves of a block, mm or degrees, as far as `tolerance`; the nearest one first is the
    /// `hint` for the next place. A thread goes on beyond its ends by `reach`.
    pub fn distance(
        &self,
        place: &Position,
        block: BlockRef,
        tolerance: f64,
        reach: f64,
        hint: &mut usize,
    ) -> f64 {
        let mut nearest = f64::INFINITY;
        let mut look = |index: usize, hint: &mut usize| {
            let Some(element) = self.elements.get(index) else {
                return false;
            };
            let beyond = element.thread().map_or(0.0, |_| reach);
            let distance = from_element(place, element, beyond);
            if distance < nearest {
                nearest = distance;
                *hint = index;
            }
            nearest <= tolerance
        };
        let from = *hint;
        let around = (from..from + NEAR).chain(from.saturating_sub(NEAR)..from);
        for index in around {
            if look(index, hint) {
                return nearest;
            }
        }
        for index in self.by_block.get(&block).into_iter().flatten() {
            if look(*index, hint) {
                return nearest;
            }
        }
        nearest
    }
}

/// The distance of a place from an element, whose line goes on `beyond` its ends, mm.
fn from_element(place: &Position, element: &PathElement, beyond: f64) -> f64 {
    let (start, end) = (&element.start, &element.end);
    match &element.curve {
        Curve::Hold => apart(place, end),
        Curve::Line => {
            let (mut along, mut square) = (0.0, 0.0);
            for axis in Axis::ALL {
                let way = end[axis] - start[axis];
                let after = place[axis] - start[axis];
                if way.is_finite() && after.is_finite() {
                    along += way * after;
                    square += way * way;
                }
            }
            let t = if square > 0.0 {
                let beyond = beyond / square.sqrt();
                (along / square).clamp(-beyond, 1.0 + beyond)
            } else {
                1.0
            };
            // Beyond its ends, too: a curve has no positions there.
            let mut nearest = *end;
            for axis in Axis::ALL {
                nearest[axis] = start[axis] + t * (end[axis] - start[axis]);
            }
            apart(place, &nearest)
        }
        Curve::Arc(arc) => {
            let angle = |point: [f64; 2]| {
                (point[1] - arc.centre[1])
                    .atan2(point[0] - arc.centre[0])
                    .to_degrees()
            };
            let turned = angle(arc.plane.point(place)) - angle(arc.plane.point(start));
            let (sweep, sense) = (arc.sweep_deg.abs(), arc.sweep_deg.signum());
            let mut after = (turned * sense).rem_euclid(360.0);
            let mut nearest = apart(place, start).min(apart(place, end));
            while after <= sweep && sweep > 0.0 {
                nearest = nearest.min(apart(place, &element.curve.position(start, end, after / sweep)));
                after += 360.0;
            }
            nearest
        }
        Curve::Corner(corner) => {
            let circle = corner.circle(start, end);
            let at = circle.nearest([Axis::X, Axis::Y, Axis::Z].map(|axis| place[axis]));
            apart(place, &element.curve.position(start, end, at))
        }
    }
}

/// The distance of two places over the axes that both have; rotary axes within a turn.
fn apart(one: &Position, other: &Position) -> f64 {
    let mut square = 0.0;
    for axis in Axis::ALL {
        let mut way = one[axis] - other[axis];
        if axis.is_rotary() {
            way = (way + 180.0).rem_euclid(360.0) - 180.0;
        }
        if way.is_finite() {
            square += way * way;
        }
    }
    square.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_path::{Arc, Plane};

    fn at(x: f64, y: f64) -> Position {
        let mut place = Position::UNKNOWN;
        (place[Axis::X], place[Axis::Y]) = (x, y);
        place
    }

    /// Beside a line of 10 mm, after its end; inside a half circle of radius 5.
    #[test]
    fn the_distance_is_that_of_the_nearest_point() {
        let line = element(Curve::Line, at(0.0, 0.0), at(10.0, 0.0));
        assert_eq!(from_element(&at(4.0, 0.25), &line, 0.0), 0.25);
        assert_eq!(from_element(&at(13.0, 4.0), &line, 0.0), 5.0);
        // A thread may go on by 1 mm, to 11 and -1.
        assert_eq!(from_element(&at(14.0, 4.0), &line, 1.0), 5.0);
        assert_eq!(from_element(&at(-0.5, 0.25), &line, 1.0), 0.25);
        let arc = Arc {
            plane: Plane::XY,
            centre: [0.0, 0.0],
            sweep_deg: 180.0,
        };
        let half = element(Curve::Arc(arc), at(5.0, 0.0), at(-5.0, 0.0));
        assert!((from_element(&at(0.0, 4.0), &half, 0.0) - 1.0).abs() < 1e-12);
        assert!((from_element(&at(5.0, -3.0), &half, 0.0) - 3.0).abs() < 1e-12);
        // A quarter of radius 5 about (0, 0), touching x = 5 and y = 5.
        let corner = bahn_path::CornerArc {
            corner: [5.0, 5.0, 0.0],
        };
        let level = |mut place: Position| {
            place[Axis::Z] = 0.0;
            place
        };
        let quarter = element(Curve::Corner(corner), level(at(5.0, 0.0)), level(at(0.0, 5.0)));
        assert!((from_element(&level(at(3.0, 4.0)), &quarter, 0.0)).abs() < 1e-12);
        assert!((from_element(&level(at(6.0, 8.0)), &quarter, 0.0) - 5.0).abs() < 1e-12);
        assert!((from_element(&level(at(8.0, -4.0)), &quarter, 0.0) - 5.0).abs() < 1e-12);
    }

    fn element(curve: Curve, start: Position, end: Position) -> PathElement {
        PathElement {
            block: BlockRef::default(),
            sequence: 0,
            curve,
            start,
            end,
            feed: bahn_path::FeedRate::Rapid,
            override_law: bahn_path::OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            end_feed: None,
            dwell_s: 0.0,
            functions: None,
            placement: None,
        }
    }
}
