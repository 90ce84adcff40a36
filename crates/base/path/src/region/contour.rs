//! Chains of lines and arcs.

use super::vector::*;
use super::{RESOLUTION_MM, Segment};
use crate::{Point2, Sense};

/// Where a point lies relative to a closed contour or a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// The point lies inside.
    Inside,
    /// On the boundary, within [`RESOLUTION_MM`](super::RESOLUTION_MM).
    Boundary,
    /// The point lies outside.
    Outside,
}

/// A chain of lines and arcs, closed when its end is its start. A full circle is one segment.
///
/// ```
/// use bahn_path::Sense;
/// use bahn_path::region::{Contour, Location};
/// // A slot of 40 x 20: two lines and two half circles, counter-clockwise from (10, 0).
/// let slot = Contour::start_at([10.0, 0.0])
///     .line_to([30.0, 0.0])
///     .arc_to([30.0, 10.0], [30.0, 20.0], Sense::CounterClockwise)
///     .line_to([10.0, 20.0])
///     .arc_to([10.0, 10.0], [10.0, 0.0], Sense::CounterClockwise);
/// assert!(slot.is_closed());
/// let area = 20.0 * 20.0 + std::f64::consts::PI * 10.0 * 10.0;
/// assert!((slot.signed_area() - area).abs() < 1e-9);
/// assert_eq!(slot.locate([1.0, 10.0]), Location::Inside);
/// assert_eq!(slot.locate([1.0, 1.0]), Location::Outside);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    start: Point2,
    segments: Vec<Segment>,
}

impl Contour {
    /// An empty chain at its start point.
    pub fn start_at(start: Point2) -> Contour {
        Contour {
            start,
            segments: Vec::new(),
        }
    }

    /// Adds a line. A line without length is left out.
    #[must_use]
    pub fn line_to(mut self, to: Point2) -> Contour {
        self.push(Segment::line(self.end(), to));
        self
    }

    /// Adds an arc about `centre`; to the end point itself it is a full circle [003:2803].
    #[must_use]
    pub fn arc_to(mut self, centre: Point2, to: Point2, sense: Sense) -> Contour {
        self.push(Segment::arc(self.end(), to, centre, sense));
        self
    }

    /// Adds a segment; a gap between the chain and the segment is bridged by a line. Segments shorter
    /// than [`RESOLUTION_MM`](super::RESOLUTION_MM) and such that are not finite are left out. Ends that are
    /// one point within the resolution are made equal. An arc whose end is not on the circle of its start
    /// becomes one through both, see [`Segment::arc`], or gets a short line at its end.
    pub fn push(&mut self, segment: Segment) {
        segment
            .mended()
            .into_iter()
            .flatten()
            .for_each(|s| self.append(s));
    }

    fn append(&mut self, segment: Segment) {
        if !segment.is_proper() {
            return;
        }
        let gap = Segment::line(self.end(), segment.from());
        if gap.is_proper() {
            self.segments.push(gap);
        }
        let to = segment.to();
        let to = if distance(to, self.start) <= RESOLUTION_MM {
            self.start
        } else {
            to
        };
        self.segments.push(segment.with_ends(self.end(), to));
    }

    /// The chain of the segments, see [`Contour::push`]; `None` when there are none.
    pub fn from_segments(segments: impl IntoIterator<Item = Segment>) -> Option<Contour> {
        let mut segments = segments.into_iter().peekable();
        let mut contour = Contour::start_at(segments.peek()?.from());
        segments.for_each(|segment| contour.push(segment));
        Some(contour)
    }

    /// The chain of segments that an overlay gave: its arcs are as true as its tolerance.
    pub(super) fn chained(segments: impl IntoIterator<Item = Segment>) -> Option<Contour> {
        let mut segments = segments.into_iter().peekable();
        let mut contour = Contour::start_at(segments.peek()?.from());
        segments.for_each(|segment| contour.append(segment));
        Some(contour)
    }

    /// A full circle from the point at an angle to the first axis.
    pub fn circle(centre: Point2, radius: f64, start_angle_deg: f64, sense: Sense) -> Contour {
        let start = add(centre, turned([radius, 0.0], start_angle_deg.to_radians()));
        Contour::start_at(start).arc_to(centre, start, sense)
    }

    /// A closed polygon through the points.
    pub fn polygon(points: &[Point2]) -> Contour {
        let start = points.first().copied().unwrap_or_default();
        points
            .iter()
            .skip(1)
            .fold(Contour::start_at(start), |c, p| c.line_to(*p))
            .line_to(start)
    }

    /// A rectangle with sides parallel to the axes, counter-clockwise from the least corner.
    pub fn rectangle(min: Point2, max: Point2) -> Contour {
        Contour::polygon(&[min, [max[0], min[1]], max, [min[0], max[1]]])
    }

    /// Where the contour begins, mm.
    pub fn start(&self) -> Point2 {
        self.start
    }

    /// End point; the start point when the contour is closed.
    pub fn end(&self) -> Point2 {
        self.segments.last().map_or(self.start, Segment::to)
    }

    /// The segments in the order of travel.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Whether the chain has segments and ends where it starts.
    pub fn is_closed(&self) -> bool {
        !self.segments.is_empty() && distance(self.start, self.end()) <= RESOLUTION_MM
    }

    /// The contour closed by a line if it is open.
    #[must_use]
    pub fn closed(self) -> Contour {
        let start = self.start;
        if self.is_closed() {
            self
        } else {
            self.line_to(start)
        }
    }

    /// Length of the contour, mm.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(Segment::length).sum()
    }

    /// Enclosed area, mm²: positive when the contour runs counter-clockwise. An open chain counts as
    /// closed by its chord.
    pub fn signed_area(&self) -> f64 {
        // About the start point, so that contours far from the datum lose no digits.
        let origin = self.start;
        self.segments
            .iter()
            .map(|s| s.moved(scale(origin, -1.0)).area_to_origin())
            .sum()
    }

    /// Enclosed area, mm².
    pub fn area(&self) -> f64 {
        self.signed_area().abs()
    }

    /// Whether the contour runs counter-clockwise.
    pub fn is_counter_clockwise(&self) -> bool {
        self.signed_area() > 0.0
    }

    /// Least and greatest corner of the bounding box.
    pub fn bounding_box(&self) -> (Point2, Point2) {
        self.segments.iter().map(Segment::bounding_box).fold(
            (self.start, self.start),
            |(min, max), (a, b)| {
                (
                    [min[0].min(a[0]), min[1].min(a[1])],
                    [max[0].max(b[0]), max[1].max(b[1])],
                )
            },
        )
    }

    /// Distance of a point to the chain, mm.
    pub fn distance(&self, point: Point2) -> f64 {
        self.segments
            .iter()
            .map(|s| s.distance(point))
            .fold(distance(self.start, point), f64::min)
    }

    /// Whether a point lies inside the contour (non-zero winding rule), on it or outside.
    pub fn locate(&self, point: Point2) -> Location {
        if self.distance(point) <= RESOLUTION_MM {
            return Location::Boundary;
        }
        if self.winding(point) != 0 {
            Location::Inside
        } else {
            Location::Outside
        }
    }

    /// How often the contour turns around a point, positive counter-clockwise.
    pub(super) fn winding(&self, point: Point2) -> i32 {
        self.segments.iter().map(|s| s.winding(point, [1.0, 0.0])).sum()
    }

    /// Unit vector of the direction of travel at the start; zero for an empty chain.
    pub fn start_tangent(&self) -> Point2 {
        self.segments.first().map_or([0.0, 0.0], |s| s.tangent(0.0))
    }

    /// Unit vector of the direction of travel at the end; zero for an empty chain.
    pub fn end_tangent(&self) -> Point2 {
        self.segments.last().map_or([0.0, 0.0], |s| s.tangent(1.0))
    }

    /// The contour travelled the other way. A closed contour keeps its start point.
    #[must_use]
    pub fn reversed(&self) -> Contour {
        Contour {
            start: self.end(),
            segments: self.segments.iter().rev().map(Segment::reversed).collect(),
        }
    }

    /// The point of the contour that is nearest to `point`.
    pub fn nearest(&self, point: Point2) -> Point2 {
        self.nearest_on(point).map_or(self.start, |(_, _, p)| p)
    }

    /// The closed contour started at the point that is nearest to `point`: the segment there is split.
    /// An open chain stays as it is.
    #[must_use]
    pub fn starting_near(&self, point: Point2) -> Contour {
        let Some((index, t, start)) = self.nearest_on(point).filter(|_| self.is_closed()) else {
            return self.clone();
        };
        let (before, rest) = self.segments.split_at(index);
        let Some((split, after)) = rest.split_first() else {
            return self.clone();
        };
        if split.is_full_circle() {
            let Segment::Arc {
                centre, sweep_deg, ..
            } = *split
            else {
                return self.clone();
            };
            return Contour {
                start,
                segments: vec![Segment::Arc {
                    from: start,
                    to: start,
                    centre,
                    sweep_deg,
                }],
            };
        }
        let length = split.length();
        let (head, tail) = match t * length {
            at if at <= RESOLUTION_MM => (None, Some(*split)),
            at if at >= length - RESOLUTION_MM => (Some(*split), None),
            _ => (Some(split.part(0.0, t)), Some(split.part(t, 1.0))),
        };
        let segments: Vec<Segment> = tail
            .iter()
            .chain(after)
            .chain(before)
            .chain(head.iter())
            .copied()
            .collect();
        Contour {
            start: segments.first().map_or(start, Segment::from),
            segments,
        }
    }

    fn nearest_on(&self, point: Point2) -> Option<(usize, f64, Point2)> {
        let candidates = self.segments.iter().enumerate().map(|(i, s)| {
            let (t, p) = s.nearest(point);
            (i, t, p)
        });
        candidates.min_by(|a, b| distance(a.2, point).total_cmp(&distance(b.2, point)))
    }

    /// Joins consecutive segments of one line or one circle into one segment.
    #[must_use]
    pub(super) fn simplified(&self) -> Contour {
        let mut merged: Vec<Segment> = Vec::with_capacity(self.segments.len());
        for segment in &self.segments {
            match merged.last().and_then(|last| last.joined(segment)) {
                Some(joined) => {
                    merged.pop();
                    merged.push(joined);
                }
                None => merged.push(*segment),
            }
        }
        if let [first, .., last] = merged.as_slice()
            && self.is_closed()
            && let Some(joined) = last.joined(first)
        {
            merged.pop();
            if let Some(first) = merged.first_mut() {
                *first = joined;
            }
        }
        Contour {
            start: merged.first().map_or(self.start, Segment::from),
            segments: merged,
        }
    }
}
