//! Clearing paths: parallel passes over a region.

use super::intersect::intersections;
use super::vector::*;
use super::{Contour, Location, RESOLUTION_MM, Region, Segment};
use crate::Point2;
use crate::frame::sin_cos_deg;

/// Resolution of the input, mm.
const LEAST_STEPOVER_MM: f64 = 0.001;
/// Far beyond what anybody mills, but soon computed.
const MOST_LINES: f64 = 1e6;

/// Order and direction of the passes of [`Region::hatch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HatchPattern {
    /// Neighbouring passes alternate in direction and are linked where the way stays inside the
    /// region. Each stretch between islands is cleared as far as it goes before the next one.
    Zigzag,
    /// All passes run in the direction of the angle, line by line; none is linked.
    OneWay,
}

/// A straight clearing pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The way from the end of the pass before to the start of this one inside the region; `None` when
    /// the tool must be lifted.
    pub link: Option<Vec<Segment>>,
    /// Start point.
    pub from: Point2,
    /// End point.
    pub to: Point2,
}

impl Pass {
    /// Whether the tool stays down on its way from the pass before.
    pub fn is_connected(&self) -> bool {
        self.link.is_some()
    }
}

impl Region {
    /// Parallel passes that clear a tool-centre region at an angle to the first axis, with the distance
    /// `stepover` (mm) between the lines. The lines count from the least extent of the region across
    /// the angle; the boundary itself gets no pass, it is milled as a channel. A pass ends on the boundary;
    /// islands are jumped over [003:5493-5497].
    ///
    /// With a stepover of the tool radius or less, boundary and passes together clear everything that
    /// the tool can reach. There are no passes when the stepover is less than 0.001 mm or makes more
    /// than a million lines.
    ///
    /// ```
    /// use bahn_path::region::{Contour, HatchPattern, Region};
    /// let area = Region::from_contour(&Contour::rectangle([0.0, 0.0], [30.0, 10.0]));
    /// let passes = area.hatch(0.0, 4.0, HatchPattern::Zigzag);
    /// assert_eq!((passes[0].from, passes[0].to), ([0.0, 4.0], [30.0, 4.0]));
    /// assert_eq!((passes[1].from, passes[1].to), ([30.0, 8.0], [0.0, 8.0]));
    /// assert!(!passes[0].is_connected() && passes[1].is_connected());
    /// ```
    pub fn hatch(&self, angle_deg: f64, stepover: f64, pattern: HatchPattern) -> Vec<Pass> {
        if !(stepover >= LEAST_STEPOVER_MM && angle_deg.is_finite()) {
            return Vec::new();
        }
        let (sin, cos) = sin_cos_deg(angle_deg);
        let lines = self.spans([cos, sin], stepover);
        match pattern {
            HatchPattern::Zigzag => self.zigzag(lines, stepover),
            HatchPattern::OneWay => {
                let pass = |span: Span| Pass {
                    link: None,
                    from: span.from,
                    to: span.to,
                };
                lines.into_iter().flatten().map(pass).collect()
            }
        }
    }

    /// The parts of the hatch lines that lie inside, line by line in the direction of the angle.
    fn spans(&self, direction: Point2, stepover: f64) -> Vec<Vec<Span>> {
        let segments = || self.contours().iter().flat_map(Contour::segments);
        let extent = |direction: Point2| {
            let extents = segments().map(|s| s.extent(direction));
            extents.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        };
        let across = left(direction);
        let (Some((start, end)), Some((low, high))) = (extent(direction), extent(across)) else {
            return Vec::new();
        };
        let at = |u: f64, v: f64| add(scale(direction, u), scale(across, v));
        let count = ((high - low - RESOLUTION_MM) / stepover).floor();
        if count.is_nan() || count > MOST_LINES {
            return Vec::new();
        }
        (1..=count.max(0.0) as usize)
            .map(|k| {
                let v = low + k as f64 * stepover;
                let line = Segment::line(at(start - 1.0, v), at(end + 1.0, v));
                let mut stops: Vec<f64> = segments()
                    .flat_map(|s| intersections(&line, s, RESOLUTION_MM))
                    .map(|p| dot(p, direction))
                    .collect();
                stops.sort_by(f64::total_cmp);
                let mut spans: Vec<(f64, f64)> = Vec::new();
                for (a, b) in stops.iter().copied().zip(stops.iter().copied().skip(1)) {
                    if b - a <= RESOLUTION_MM || self.locate(at(0.5 * (a + b), v)) != Location::Inside {
                        continue;
                    }
                    match spans.last_mut() {
                        // The line only touches the boundary at `a`.
                        Some(last) if a - last.1 <= RESOLUTION_MM => last.1 = b,
                        _ => spans.push((a, b)),
                    }
                }
                spans
                    .into_iter()
                    .map(|(a, b)| Span {
                        from: at(a, v),
                        to: at(b, v),
                        low: a,
                        high: b,
                    })
                    .collect()
            })
            .collect()
    }

    fn zigzag(&self, lines: Vec<Vec<Span>>, stepover: f64) -> Vec<Pass> {
        let mut done: Vec<Vec<bool>> = lines.iter().map(|line| vec![false; line.len()]).collect();
        let mut passes: Vec<Pass> = Vec::new();
        for (first_line, first_index) in lines
            .iter()
            .enumerate()
            .flat_map(|(l, line)| (0..line.len()).map(move |i| (l, i)))
        {
            let (mut line, mut index) = (first_line, first_index);
            let mut forward = true;
            let mut link = None;
            // Follows one stretch from line to line as long as a link is found.
            while let Some(flag) = done.get_mut(line).and_then(|d| d.get_mut(index))
                && !*flag
                && let Some(span) = lines.get(line).and_then(|l| l.get(index))
            {
                *flag = true;
                let pass = span.pass(forward, link.take());
                let end = pass.to;
                passes.push(pass);
                let next = lines
                    .get(line + 1)
                    .into_iter()
                    .flatten()
                    .enumerate()
                    .filter(|(i, s)| {
                        done.get(line + 1).and_then(|d| d.get(*i)) == Some(&false)
                            && s.low < span.high
                            && s.high > span.low
                    });
                let linked =
                    next.filter_map(|(i, s)| Some((i, self.link(end, s.entry(!forward), stepover)?)));
                let way = |link: &[Segment]| link.iter().map(Segment::length).sum::<f64>();
                let Some((next, found)) = linked.min_by(|a, b| way(&a.1).total_cmp(&way(&b.1))) else {
                    break;
                };
                (line, index, forward, link) = (line + 1, next, !forward, Some(found));
            }
        }
        passes
    }

    /// The way between ends of neighbouring passes: straight if that stays inside, else along the boundary
    /// if that is not much longer than the stepover.
    fn link(&self, from: Point2, to: Point2, stepover: f64) -> Option<Vec<Segment>> {
        const LONGEST_DETOUR: f64 = 4.0; // (inferred) in stepovers, beyond it the tool is lifted
        let straight = Segment::line(from, to);
        if straight.length() <= LONGEST_DETOUR * stepover && self.holds_line(&straight) {
            return Some(vec![straight]);
        }
        let holds_both = |c: &&Contour| c.distance(from) <= RESOLUTION_MM && c.distance(to) <= RESOLUTION_MM;
        let ways = self
            .contours()
            .iter()
            .filter(holds_both)
            .flat_map(|c| [c.between(from, to), c.reversed().between(from, to)]);
        ways.map(|way| (way.iter().map(Segment::length).sum::<f64>(), way))
            .filter(|(length, _)| *length <= LONGEST_DETOUR * stepover)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, way)| way)
    }

    /// Whether a line between two points of the region stays in it; it may run along the boundary.
    fn holds_line(&self, line: &Segment) -> bool {
        let segments = self.contours().iter().flat_map(Contour::segments);
        let touched = segments
            .flat_map(|s| intersections(line, s, RESOLUTION_MM))
            .map(|p| line.nearest(p).0);
        let mut stops: Vec<f64> = touched.chain([0.0, 1.0]).collect();
        stops.sort_by(f64::total_cmp);
        let pieces = stops
            .iter()
            .zip(stops.iter().skip(1))
            .filter(|(a, b)| *b - *a > 1e-9);
        pieces
            .map(|(a, b)| 0.5 * (a + b))
            .all(|t| self.locate(line.point(t)) != Location::Outside)
    }
}

/// A part of a hatch line inside the region, with its coordinates along the line.
struct Span {
    from: Point2,
    to: Point2,
    low: f64,
    high: f64,
}

impl Span {
    fn pass(&self, forward: bool, link: Option<Vec<Segment>>) -> Pass {
        let (from, to) = if forward {
            (self.from, self.to)
        } else {
            (self.to, self.from)
        };
        Pass { link, from, to }
    }

    fn entry(&self, forward: bool) -> Point2 {
        if forward { self.from } else { self.to }
    }
}

impl Contour {
    /// The way along a closed contour from one of its points to another one, in its sense.
    fn between(&self, from: Point2, to: Point2) -> Vec<Segment> {
        let contour = self.starting_near(from);
        let mut way = Vec::new();
        for segment in contour.segments() {
            if segment.distance(to) <= RESOLUTION_MM {
                let (t, _) = segment.nearest(to);
                way.push(segment.part(0.0, t));
                break;
            }
            way.push(*segment);
        }
        way
    }
}
