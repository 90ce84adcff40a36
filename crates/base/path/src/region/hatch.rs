//! Clearing paths: parallel passes over a region.

use super::effort::{Effort, Unlimited};
use super::index::{Bounds, Index};
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
    /// Neighbouring passes alternate in direction and are linked where the link stays inside the
    /// region. Each stretch between islands is cleared as far as it goes before the next one.
    Zigzag,
    /// All passes run in the direction of the angle, line by line; none is linked.
    OneWay,
}

/// A straight clearing pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The path from the end of the pass before to the start of this one inside the region; `None` when
    /// the tool must be lifted.
    pub link: Option<Vec<Segment>>,
    /// Start of the pass, mm.
    pub from: Point2,
    /// End of the pass, mm.
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
        let Ok(passes) = self.hatch_within(angle_deg, stepover, pattern, &Unlimited);
        passes
    }

    /// [`Region::hatch`] with an effort that may end it.
    ///
    /// # Errors
    /// When the effort ends it.
    pub fn hatch_within<E: Effort>(
        &self,
        angle_deg: f64,
        stepover: f64,
        pattern: HatchPattern,
        effort: &E,
    ) -> Result<Vec<Pass>, E::Stop> {
        if !(stepover >= LEAST_STEPOVER_MM && angle_deg.is_finite()) {
            return Ok(Vec::new());
        }
        let (sin, cos) = sin_cos_deg(angle_deg);
        let area = Area::new(self, effort)?;
        let lines = area.spans([cos, sin], stepover, effort)?;
        match pattern {
            HatchPattern::Zigzag => area.zigzag(lines, stepover, effort),
            HatchPattern::OneWay => {
                let pass = |span: Span| Pass {
                    link: None,
                    from: span.from,
                    to: span.to,
                };
                Ok(lines.into_iter().flatten().map(pass).collect())
            }
        }
    }
}

/// The region that is cleared.
struct Area<'a> {
    contours: &'a [Contour],
    index: Index,
    /// For each segment of the index its contour and its place in it.
    places: Vec<(usize, usize)>,
}

impl Area<'_> {
    fn new<'a, E: Effort>(region: &'a Region, effort: &E) -> Result<Area<'a>, E::Stop> {
        let contours = region.contours();
        let numbered = contours.iter().enumerate();
        Ok(Area {
            contours,
            index: Index::new(contours.iter().flat_map(Contour::segments).copied(), effort)?,
            places: numbered
                .flat_map(|(c, contour)| (0..contour.segments().len()).map(move |k| (c, k)))
                .collect(),
        })
    }

    /// The parts of the hatch lines that lie inside, line by line in the direction of the angle.
    fn spans<E: Effort>(
        &self,
        direction: Point2,
        stepover: f64,
        effort: &E,
    ) -> Result<Vec<Vec<Span>>, E::Stop> {
        let across = left(direction);
        let mut waiting: Vec<(f64, f64, &Segment)> = self
            .index
            .segments()
            .iter()
            .map(|s| {
                let (low, high) = s.extent(across);
                (low, high, s)
            })
            .collect();
        waiting.sort_by(|a, b| a.0.total_cmp(&b.0));
        let low = waiting.first().map_or(0.0, |(low, ..)| *low);
        let high = waiting.iter().map(|(_, high, _)| *high).fold(low, f64::max);
        let count = ((high - low - RESOLUTION_MM) / stepover).floor();
        if count.is_nan() || count > MOST_LINES {
            return Ok(Vec::new());
        }
        let mut waiting = waiting.into_iter().peekable();
        let mut reached: Vec<(f64, &Segment)> = Vec::new();
        let mut lines = Vec::new();
        for k in 1..=count.max(0.0) as usize {
            let v = low + k as f64 * stepover;
            while let Some((_, high, segment)) = waiting.next_if(|(low, ..)| low - RESOLUTION_MM <= v) {
                reached.push((high, segment));
            }
            reached.retain(|(high, _)| high + RESOLUTION_MM >= v);
            effort.spend(1 + reached.len())?;
            lines.push(self.line(direction, v, &reached, effort)?);
        }
        Ok(lines)
    }

    /// The parts of one hatch line inside, which meets the segments that it has reached.
    fn line<E: Effort>(
        &self,
        direction: Point2,
        v: f64,
        reached: &[(f64, &Segment)],
        effort: &E,
    ) -> Result<Vec<Span>, E::Stop> {
        let at = |u: f64| add(scale(direction, u), scale(left(direction), v));
        let mut stops: Vec<f64> = Vec::new();
        for (_, segment) in reached {
            let (start, end) = segment.extent(direction);
            let line = Segment::line(at(start - 1.0), at(end + 1.0));
            stops.extend(intersections(&line, segment, RESOLUTION_MM).map(|p| dot(p, direction)));
        }
        stops.sort_by(f64::total_cmp);
        let mut spans: Vec<(f64, f64)> = Vec::new();
        for (a, b) in stops.iter().copied().zip(stops.iter().copied().skip(1)) {
            if b - a <= RESOLUTION_MM || self.index.locate(at(0.5 * (a + b)), effort)? != Location::Inside {
                continue;
            }
            match spans.last_mut() {
                // The line only touches the boundary at `a`.
                Some(last) if a - last.1 <= RESOLUTION_MM => last.1 = b,
                _ => spans.push((a, b)),
            }
        }
        let span = |(low, high): (f64, f64)| Span {
            from: at(low),
            to: at(high),
            low,
            high,
        };
        Ok(spans.into_iter().map(span).collect())
    }

    fn zigzag<E: Effort>(
        &self,
        lines: Vec<Vec<Span>>,
        stepover: f64,
        effort: &E,
    ) -> Result<Vec<Pass>, E::Stop> {
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
                // The spans of a line lie one after the other.
                let next = lines.get(line + 1).map_or(&[][..], Vec::as_slice);
                let first = next.partition_point(|s| s.high <= span.low);
                let beside = next.iter().enumerate().skip(first);
                let mut best: Option<(f64, usize, Vec<Segment>)> = None;
                for (i, s) in beside.take_while(|(_, s)| s.low < span.high) {
                    if done.get(line + 1).and_then(|d| d.get(i)) != Some(&false) {
                        continue;
                    }
                    if let Some(path) = self.link(end, s.entry(!forward), stepover, effort)? {
                        let length = path.iter().map(Segment::length).sum();
                        if best.as_ref().is_none_or(|(least, ..)| length < *least) {
                            best = Some((length, i, path));
                        }
                    }
                }
                let Some((_, next, path)) = best else { break };
                (line, index, forward, link) = (line + 1, next, !forward, Some(path));
            }
        }
        Ok(passes)
    }

    /// The path between ends of neighbouring passes: straight if that stays inside, else along the boundary
    /// if that is not much longer than the stepover.
    fn link<E: Effort>(
        &self,
        from: Point2,
        to: Point2,
        stepover: f64,
        effort: &E,
    ) -> Result<Option<Vec<Segment>>, E::Stop> {
        const LONGEST_DETOUR: f64 = 4.0; // (inferred) in stepovers, beyond it the tool is lifted
        let longest = LONGEST_DETOUR * stepover;
        let straight = Segment::line(from, to);
        if straight.length() > longest {
            return Ok(None);
        }
        if self.holds_line(&straight, effort)? {
            return Ok(Some(vec![straight]));
        }
        let mut starts: Vec<(usize, usize)> = Vec::new();
        let here = Bounds::of_point(from).grown(RESOLUTION_MM);
        self.index.touching(&here, effort, |place, segment| {
            if segment.distance(from) <= RESOLUTION_MM {
                starts.extend(self.places.get(place));
            }
        })?;
        let mut best: Option<(f64, Vec<Segment>)> = None;
        for (contour, place) in starts {
            for forward in [true, false] {
                let segments = self.contours.get(contour).map_or(&[][..], Contour::segments);
                let found = path_along(segments, place, [from, to], forward, longest);
                effort.spend(found.as_ref().map_or(1, |(_, path)| path.len()))?;
                let shorter = |(length, _): &(f64, _)| best.as_ref().is_none_or(|(least, _)| length < least);
                if let Some(found) = found.filter(shorter) {
                    best = Some(found);
                }
            }
        }
        Ok(best.map(|(_, path)| path))
    }

    /// Whether a line between two points of the region stays in it; it may run along the boundary.
    fn holds_line<E: Effort>(&self, line: &Segment, effort: &E) -> Result<bool, E::Stop> {
        let mut stops: Vec<f64> = vec![0.0, 1.0];
        let bounds = Bounds::of(line).grown(RESOLUTION_MM);
        self.index.touching(&bounds, effort, |_, segment| {
            stops.extend(intersections(line, segment, RESOLUTION_MM).map(|p| line.nearest(p).0));
        })?;
        stops.sort_by(f64::total_cmp);
        for (a, b) in stops.iter().zip(stops.iter().skip(1)) {
            let middle = line.point(0.5 * (a + b));
            if b - a > 1e-9 && self.index.locate(middle, effort)? == Location::Outside {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The path along a closed contour between two of its points, in its sense or against it, from the segment
/// at a place; `None` when it is longer than `longest`.
fn path_along(
    segments: &[Segment],
    place: usize,
    [from, to]: [Point2; 2],
    forward: bool,
    longest: f64,
) -> Option<(f64, Vec<Segment>)> {
    let count = segments.len();
    let mut length = 0.0;
    let mut path: Vec<Segment> = Vec::new();
    // The segment of the start may be the one of the end too, and come again after all others.
    for step in 0..=count {
        let at = if forward {
            place + step
        } else {
            place + 2 * count - step
        };
        let segment = segments.get(at % count)?;
        let segment = if forward { *segment } else { segment.reversed() };
        let start = if step == 0 { segment.nearest(from).0 } else { 0.0 };
        let (t, end) = segment.nearest(to);
        let arrives = distance(end, to) <= RESOLUTION_MM && t >= start;
        let part = segment.part(start, if arrives { t } else { 1.0 });
        length += part.length();
        if length > longest {
            return None;
        }
        if part.is_proper() {
            match path.last().and_then(|last| last.joined(&part)) {
                Some(joined) => *path.last_mut()? = joined,
                None => path.push(part),
            }
        }
        if arrives {
            return Some((length, path));
        }
    }
    None
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
