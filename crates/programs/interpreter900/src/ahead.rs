//! Feeds that what comes next decides: P8857 limits them by the circles through the points of the path, P8851 slows down before
//! corners.
//!
//! Decision: P8857 takes the circle through start, end and next end of two movements of G1, G2, G3 on the path of the tool
//! centre, and limits both as P8852 limits a circle
//!
//! Decision: P8851 slows down to the programmed feed times the cosine to that power, at the corner, whatever the override is; the
//! axes X, Y and Z make the angle. -1 counts as 1

use std::collections::VecDeque;

use bahn_path::{Axis, Curve, FeedRate, PathElement, Position};
use bahn_system900::PathData;

use crate::feeds::circle_limit;
use crate::item::{Item, WAITING_MAX};

const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
/// P8851 = -1.
const STANDARD: f64 = 1.0;
/// Cosine of a change of direction that is rounding, no corner.
const STRAIGHT: f64 = 1.0 - 1e-9;
/// Cosine of a corner of 90 degrees, with its rounding.
const SQUARE: f64 = 1e-9;

/// Taken when the parameters were written.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AheadRules {
    /// P8857, mm.
    pub deviation: Option<f64>,
    /// P8851, without 0.
    pub exponent: Option<f64>,
    /// The smallest Kv of the axes of the plane, 1/s.
    pub kv: f64,
}

impl AheadRules {
    pub fn of(data: &PathData, kv: f64) -> AheadRules {
        AheadRules {
            deviation: data.outline_deviation(),
            exponent: data
                .corner_exponent()
                .filter(|exponent| *exponent != 0.0)
                .map(|exponent| if exponent < 0.0 { STANDARD } else { exponent }),
            kv,
        }
    }

    /// Whether a movement has to wait for the next one.
    pub fn act(&self) -> bool {
        self.deviation.is_some() || self.exponent.is_some()
    }

    /// What two movements say of each other.
    fn meet(&self, before: &mut PathElement, after: &mut PathElement) {
        let (FeedRate::Programmed(feed), FeedRate::Programmed(_)) = (before.feed, after.feed) else {
            return;
        };
        if let Some(exponent) = self.exponent {
            let cos = cosine(before, after);
            let factor = if cos > SQUARE { cos.powf(exponent) } else { 0.0 };
            before.end_feed = (cos < STRAIGHT).then_some(feed * factor);
        }
        if let Some(deviation) = self.deviation
            && let Some(radius) = radius([&before.start, &before.end, &after.end])
        {
            let limit = circle_limit(self.kv, radius, deviation);
            before.feed = before.feed.up_to(limit);
            after.feed = after.feed.up_to(limit);
        }
    }
}

/// Cosine of the change of direction between two movements, in space. The angle of the corner is what it lacks of 180 degrees.
fn cosine(before: &PathElement, after: &PathElement) -> f64 {
    let at = |element: &PathElement, t: f64| {
        let tangent = element.curve.tangent(&element.start, &element.end, t);
        MAIN.map(|axis| tangent[axis])
    };
    let (a, b) = (at(before, 1.0), at(after, 0.0));
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let lengths = (dot(a, a) * dot(b, b)).sqrt();
    // Without a direction in space there is no corner.
    if lengths > 0.0 { dot(a, b) / lengths } else { 1.0 }
}

/// The radius of the circle through three points, mm; `None` where they lie on a line.
fn radius([a, b, c]: [&Position; 3]) -> Option<f64> {
    let to = |from: &Position, to: &Position| MAIN.map(|axis| to[axis] - from[axis]);
    let length = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
    let (one, two, whole) = (to(a, b), to(b, c), to(a, c));
    let ([x, y, z], [u, v, w]) = (one, two);
    let area = length([y * w - z * v, z * u - x * w, x * v - y * u]);
    let sides = length(one) * length(two) * length(whole);
    (sides > 0.0 && area > 1e-12 * sides).then(|| sides / (2.0 * area))
}

/// Holds the last movement, and what came after it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ahead {
    held: Option<PathElement>,
    after: Vec<Item>,
}

impl Ahead {
    pub fn holds(&self) -> bool {
        self.held.is_some()
    }

    pub fn push(&mut self, item: Item, rules: &AheadRules, out: &mut VecDeque<Item>) {
        match item {
            Item::Element(mut element) if element.curve != Curve::Hold => {
                if let Some(held) = &mut self.held {
                    rules.meet(held, &mut element);
                }
                self.flush(out);
                match rules.act() {
                    true => self.held = Some(element),
                    false => out.push_back(Item::Element(element)),
                }
            }
            item if self.held.is_some() => {
                self.after.push(item);
                if self.after.len() > WAITING_MAX {
                    self.flush(out);
                }
            }
            item => out.push_back(item),
        }
    }

    pub fn flush(&mut self, out: &mut VecDeque<Item>) {
        out.extend(self.held.take().map(Item::Element));
        out.extend(self.after.drain(..));
    }
}
