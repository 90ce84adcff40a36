//! Regions grown and shrunk by a radius.
//!
//! The boundary of the result keeps the distance to the boundary of the region everywhere, so it is made
//! of elements of that beside the moved ones: lines, arcs with the same centre, and arcs about corners.
//! Most of them, where elements are shorter than the radius, lie nearer to some other element. They
//! are covered: what is covered goes before anything is cut with anything ([`Covering::uncovered`]), which
//! leaves little more than the result. The rest is cut where it meets, and every edge is asked once more.
//!
//! Decision: An offset is what of the moved elements nothing covers: covered parts go before anything is cut, so that
//! short elements cost no more than long ones

use super::arrangement::TOLERANCES_MM;
use super::edges::{Edge, edges};
use super::effort::{Effort, Unlimited};
use super::faces::{Faces, direction_at, leaving};
use super::index::Index;
use super::intersect::carriers_cross;
use super::vector::*;
use super::{Contour, RESOLUTION_MM, Region, Segment};
use crate::Point2;
use std::f64::consts::{PI, TAU};

impl Region {
    /// The region grown by a radius (positive, mm) or shrunk by it (negative): all points within the
    /// radius of the area, or all points from which the radius stays inside. Outside corners become arcs,
    /// inside corners intersections; arcs stay arcs. A shrunk region may fall apart or vanish.
    #[must_use]
    pub fn offset(&self, distance: f64) -> Region {
        let Ok(region) = self.offset_within(distance, &Unlimited);
        region
    }

    /// [`Region::offset`] with an effort that may end it.
    ///
    /// # Errors
    /// When the effort ends it.
    pub fn offset_within<E: Effort>(&self, distance: f64, effort: &E) -> Result<Region, E::Stop> {
        if distance.abs() <= RESOLUTION_MM || !distance.is_finite() {
            return Ok(self.clone());
        }
        // The free side, where the result of shrinking lies or a grown region does not, is on the left.
        let grows = distance > 0.0;
        let contours: Vec<Contour> = match grows {
            true => self.contours().iter().map(Contour::reversed).collect(),
            false => self.contours().to_vec(),
        };
        let covering = Covering {
            index: Index::new(contours.iter().flat_map(Contour::segments).copied(), effort)?,
            radius: distance.abs(),
        };
        let mut moved = Vec::new();
        let mut first = 0;
        for contour in &contours {
            let count = contour.segments().len();
            for (place, element) in elements(contour, distance.abs()) {
                // Neighbours cover most of most.
                let beside = [count - 1, 1, 2, 2 * count - 2, 3].map(|by| first + (place + by) % count);
                covering.uncovered(&element, beside, &mut moved, effort)?;
            }
            first += count;
        }
        let loops = covering.free_loops(&moved, effort)?;
        let loops = match grows {
            true => loops.iter().map(Contour::reversed).collect(),
            false => loops,
        };
        Region::from_loops(loops, effort)
    }

    /// What a tool of a radius can machine of the region without leaving it: shrunk, then grown again.
    /// Inside corners keep a remnant.
    #[must_use]
    pub fn opening(&self, radius: f64) -> Region {
        let radius = radius.abs();
        self.offset(-radius).offset(radius)
    }
}

/// Everything nearer than the radius to a boundary.
struct Covering {
    index: Index,
    radius: f64,
}

/// What is nearer than the radius by this is covered, mm: more than rounding does.
const COVERED_MM: f64 = 1e-9;
/// Shorter parts of an element are left out, mm.
const LEAST_PART_MM: f64 = 1e-3 * RESOLUTION_MM;
/// Parts of one element that are looked at.
const MOST_LOOKS: usize = 1000;

impl Covering {
    /// Adds the parts of an element that are not covered, and perhaps some that are: each part is looked
    /// at in its middle and at its ends. Segments that are likely to cover it are tried first.
    fn uncovered<E: Effort>(
        &self,
        element: &Segment,
        likely: [usize; 5],
        parts: &mut Vec<Segment>,
        effort: &E,
    ) -> Result<(), E::Stop> {
        let length = element.length();
        // Long elements are looked at in more places.
        let count = (length / self.radius).ceil().clamp(1.0, 64.0) as usize;
        let least = (LEAST_PART_MM / length).clamp(1e-12, 0.5);
        let border = |k: usize| k as f64 / count as f64;
        let mut open: Vec<(f64, f64)> = (0..count).rev().map(|k| (border(k), border(k + 1))).collect();
        let mut kept: Vec<(f64, f64)> = Vec::new();
        let mut looks = 0;
        while let Some((from, to)) = open.pop() {
            let inset = 0.01 * (to - from);
            let places = [0.5 * (from + to), from + inset, to - inset];
            let mut covers = None;
            for t in places.into_iter().take(if inset > least { 3 } else { 1 }) {
                let (point, within) = (element.point(t), self.radius - COVERED_MM);
                let segments = self.index.segments();
                let likely = likely.iter().filter_map(|place| segments.get(*place));
                let mut segment = likely.into_iter().find(|s| s.distance(point) < within);
                if segment.is_none() {
                    let near = self.index.nearest(point, within, effort)?;
                    segment = near.and_then(|(_, place)| segments.get(place));
                }
                if let Some(segment) = segment {
                    covers = Some(self.covered_about(element, t, segment));
                    break;
                }
            }
            looks += 1;
            match covers {
                // Where nothing goes because digits are at their end, it stays.
                Some((start, end)) if end > start && looks < MOST_LOOKS => {
                    let rest = [(from, start.min(to)), (end.max(from), to)].into_iter();
                    let rest = rest.filter(|(a, b)| b - a > least && b - a < to - from);
                    open.extend(rest.rev());
                }
                _ => match kept.last_mut() {
                    Some(last) if last.1 >= from && last.0 <= from => last.1 = to.max(last.1),
                    _ => kept.push((from, to)),
                },
            }
        }
        parts.extend(kept.iter().map(|(from, to)| match (*from, *to) {
            (0.0, 1.0) => *element,
            (from, to) => element.part(from, to),
        }));
        Ok(())
    }

    /// The stretch about the fraction `t` of an element that a segment covers.
    fn covered_about(&self, element: &Segment, t: f64, segment: &Segment) -> (f64, f64) {
        let circle = |centre: Point2| Segment::Arc {
            from: along(centre, [1.0, 0.0], self.radius),
            to: along(centre, [1.0, 0.0], self.radius),
            centre,
            sweep_deg: 360.0,
        };
        // Where the distance to the segment is the radius: on its moved carriers and about its ends.
        let borders = [
            moved_left(segment, self.radius),
            moved_left(segment, -self.radius),
            Some(circle(segment.from())),
            Some(circle(segment.to())),
        ];
        let mut stops = vec![0.0, 1.0];
        for border in borders.iter().flatten() {
            let points = carriers_cross(element, border, 0.0);
            stops.extend(points.into_iter().flatten().map(|p| element.nearest(p).0));
        }
        stops.sort_by(f64::total_cmp);
        let within = |a: f64, b: f64| {
            let middle = element.point(0.5 * (a + b));
            b - a <= 1e-12 || segment.distance(middle) < self.radius - COVERED_MM
        };
        let (mut start, mut end) = (t, t);
        let place = stops.partition_point(|stop| *stop <= t);
        for stop in stops.iter().skip(place) {
            if !within(end, *stop) {
                break;
            }
            end = *stop;
        }
        for stop in stops.iter().take(place).rev() {
            if !within(*stop, start) {
                break;
            }
            start = *stop;
        }
        (start, end)
    }

    /// The loops around what is not covered, which is on their left.
    ///
    /// A tolerance serves when nothing speaks against its loops that is more than the tolerance: every edge
    /// that was taken away because it ends nowhere runs along a kept one ([`strayed_length`]), so that
    /// nothing of the true boundary is missing by more; and every face whose edges disagree is a sliver
    /// ([`free_faces`]), so that nothing thicker is decided wrongly. Every kept edge is covered by no more
    /// than is granted. Together the loops are the boundary within what is granted, wherever it is.
    fn free_loops<E: Effort>(&self, moved: &[Segment], effort: &E) -> Result<Vec<Contour>, E::Stop> {
        let mut best: Option<(f64, Faces, Vec<bool>)> = None;
        'tolerances: for tolerance in TOLERANCES_MM {
            let edges = edges(moved.iter().map(|segment| (0, *segment)), tolerance, effort)?;
            let mut depths = Vec::with_capacity(edges.len());
            for edge in &edges {
                let near = self.index.nearest(edge.segment.point(0.5), self.radius, effort)?;
                // Elements that coincide against each other are covered from both sides.
                let depth = near.map_or(0.0, |(gap, _)| self.radius - gap);
                depths.push(if edge.both_ways { f64::INFINITY } else { depth });
            }
            // Cutting moved the edges a little; as little as will do is granted.
            for granted in [tolerance, 4.0 * tolerance] {
                let pairs = edges.iter().zip(&depths);
                let kept = pairs
                    .filter(|(_, depth)| **depth <= granted)
                    .map(|(e, _)| e.clone())
                    .collect();
                let (kept, removed) = without_ends(kept);
                let strayed = strayed_length(&removed, &kept, granted, effort)?;
                let faces = Faces::new(kept, effort)?;
                let (free, doubtful) = free_faces(&faces, granted);
                let tangled = strayed.max(doubtful);
                if best.as_ref().is_none_or(|(least, ..)| tangled < *least) {
                    best = Some((tangled, faces, free));
                }
                if tangled == 0.0 {
                    break 'tolerances;
                }
            }
        }
        best.map_or(Ok(Vec::new()), |(_, faces, free)| faces.boundary(&free, effort))
    }
}

/// The edges without those that end nowhere, taken away one after the other, and these.
fn without_ends(edges: Vec<Edge>) -> (Vec<Edge>, Vec<Edge>) {
    let leaving = leaving(&edges);
    let mut degree: Vec<usize> = leaving.iter().map(Vec::len).collect();
    let mut gone = vec![false; edges.len()];
    let mut open: Vec<usize> = (0..degree.len()).filter(|v| degree.get(*v) == Some(&1)).collect();
    while let Some(vertex) = open.pop() {
        let half_edges = leaving.get(vertex).map_or(&[][..], Vec::as_slice);
        let Some(last) = half_edges.iter().find(|h| gone.get(**h / 2) == Some(&false)) else {
            continue;
        };
        if let (Some(gone), Some(edge)) = (gone.get_mut(last / 2), edges.get(last / 2)) {
            *gone = true;
            for end in edge.ends {
                if let Some(degree) = degree.get_mut(end) {
                    *degree -= 1;
                    if *degree == 1 {
                        open.push(end);
                    }
                }
            }
        }
    }
    let (removed, kept): (Vec<_>, Vec<_>) = edges.into_iter().zip(gone).partition(|(_, gone)| *gone);
    let edges = |pairs: Vec<(Edge, bool)>| pairs.into_iter().map(|(edge, _)| edge).collect();
    (edges(kept), edges(removed))
}

/// Thinner than this times what is granted is the tolerance's doing. Edges that cross at a flat angle are
/// both kept after the crossing until one is covered by more than is granted, which brings them no farther
/// apart than that; cutting moved each by twice the tolerance.
const SLIVER: f64 = 4.0;

/// Length of the longest edge that was taken away and along which no edge is kept, mm.
fn strayed_length<E: Effort>(
    removed: &[Edge],
    kept: &[Edge],
    granted: f64,
    effort: &E,
) -> Result<f64, E::Stop> {
    let reach = SLIVER * granted;
    let long = |edge: &&Edge| edge.segment.length() > reach;
    if !removed.iter().any(|edge| long(&edge)) {
        return Ok(0.0);
    }
    let index = Index::new(kept.iter().map(|edge| edge.segment), effort)?;
    let mut longest = 0.0f64;
    for edge in removed.iter().filter(long) {
        if index.nearest(edge.segment.point(0.5), reach, effort)?.is_none() {
            longest = longest.max(edge.segment.length());
        }
    }
    Ok(longest)
}

/// Which faces are free, and the greatest length that speaks against it, mm: the left of every edge is
/// free and its right covered, so that every half-edge is evidence about its face. They may disagree in slivers
/// and in faces that are as small all around; elsewhere directions at a vertex were mistaken, or edges are
/// missing between two faces.
fn free_faces(faces: &Faces, granted: f64) -> (Vec<bool>, f64) {
    #[derive(Clone, Copy, Default)]
    struct Evidence {
        free: f64,
        covered: f64,
        area: f64,
    }
    let mut evidence = vec![Evidence::default(); faces.count()];
    // Areas far from the datum lose no digits.
    let origin = faces
        .edges()
        .first()
        .map_or([0.0, 0.0], |edge| edge.segment.from());
    for (place, edge) in faces.edges().iter().enumerate() {
        let length = edge.segment.length();
        let area = edge.segment.moved(scale(origin, -1.0)).area_to_origin();
        if let Some(left) = evidence.get_mut(faces.left_of(2 * place)) {
            left.free += length;
            left.area += area;
        }
        if let Some(right) = evidence.get_mut(faces.left_of(2 * place + 1)) {
            right.covered += length;
            right.area -= area;
        }
    }
    let width = SLIVER * granted;
    let doubtful = evidence.iter().filter(|evidence| {
        let around = evidence.free + evidence.covered;
        evidence.area.abs() > 0.5 * width * around && around > 25.0 * width
    });
    let doubtful = doubtful
        .map(|evidence| f64::min(evidence.free, evidence.covered))
        .fold(0.0, f64::max);
    let free = evidence
        .iter()
        .map(|evidence| evidence.free > 2.0 * evidence.covered);
    (free.collect(), doubtful)
}

/// The elements of a contour moved to its left by the radius, with arcs about the corners at which it
/// turns right, each with the place of its segment. Where it turns left its elements cross.
fn elements(contour: &Contour, radius: f64) -> impl Iterator<Item = (usize, Segment)> + '_ {
    let segments = contour.segments();
    let pairs = segments.iter().zip(segments.iter().cycle().skip(1));
    pairs
        .enumerate()
        .flat_map(move |(place, (segment, next))| {
            let alone = segments.len() == 1 && segment.is_full_circle();
            let turn = if alone { 0.0 } else { corner_angle(segment, next) };
            let corner = segment.to();
            let beside = |tangent: Point2| along(corner, left(tangent), radius);
            let arc = (turn < 0.0).then(|| Segment::Arc {
                from: beside(segment.tangent(1.0)),
                to: beside(next.tangent(0.0)),
                centre: corner,
                sweep_deg: turn.to_degrees(),
            });
            // An arc moved beyond its centre is nearer to the other side of it everywhere.
            let shrinks_away = matches!(segment, Segment::Arc { sweep_deg, .. } if *sweep_deg > 0.0)
                && segment.radius().is_some_and(|r| r <= radius + RESOLUTION_MM);
            let moved = moved_left(segment, radius).filter(|_| !shrinks_away);
            [moved, arc].map(|element| element.map(|element| (place, element)))
        })
        .flatten()
        .filter(|(_, element)| element.is_proper())
}

/// A line moved to its left, or an arc with the same centre; `None` when it is moved to the centre or
/// beyond.
fn moved_left(segment: &Segment, by: f64) -> Option<Segment> {
    match *segment {
        Segment::Line { from, to } => {
            let aside = scale(left(unit(sub(to, from))), by);
            Some(Segment::Line {
                from: add(from, aside),
                to: add(to, aside),
            })
        }
        Segment::Arc {
            from,
            to,
            centre,
            sweep_deg,
        } => {
            // Each end from where it is, so that the arcs about corners begin there even if the radii
            // differ a little.
            let point = |p: Point2| {
                let moved = distance(p, centre) - by * sweep_deg.signum();
                (moved > 0.0).then(|| along(centre, unit(sub(p, centre)), moved))
            };
            Some(Segment::Arc {
                from: point(from)?,
                to: point(to)?,
                centre,
                sweep_deg,
            })
        }
    }
}

/// Angle by which the direction turns between two segments, radians, left positive. At a cusp, where the
/// way goes straight back, the curvatures decide whether the tip (left turn) or the notch is inside.
fn corner_angle(segment: &Segment, next: &Segment) -> f64 {
    // Contours do not cross themselves, so this near to a cusp the order farther on is the order at it.
    const CUSP: f64 = 1e-3;
    let angle = angle_between(segment.tangent(1.0), next.tangent(0.0));
    if PI - angle.abs() > CUSP {
        return angle;
    }
    let reach = |s: &Segment| s.length().min(s.radius().unwrap_or(f64::INFINITY));
    let chord = 0.5 * reach(segment).min(reach(next));
    let back = direction_at(&segment.reversed(), chord);
    let on = direction_at(next, chord);
    match (angle > 0.0, cross(on, back) >= 0.0) {
        (true, false) => angle - TAU,
        (false, true) => angle + TAU,
        _ => angle,
    }
}
