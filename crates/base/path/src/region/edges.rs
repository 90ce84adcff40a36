//! Segments cut into edges where they meet.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::Segment;
use super::effort::Effort;
use super::index::{Bounds, Tree};
use super::intersect::crossings;
use super::vector::*;
use crate::Point2;

/// An edge between two vertices and how often each operand runs along it (backwards: negative).
#[derive(Clone)]
pub(super) struct Edge {
    pub ends: [usize; 2],
    pub segment: Segment,
    /// The segment as it counts for directions and winding numbers: arcs no higher than what vertices
    /// are moved by are their chords, as moved ends may turn a short chord any way. No two edges have the
    /// same course: arcs that flat and with the same ends are one, see [`flatness`].
    pub course: Segment,
    pub weights: Vec<(usize, i32)>,
    /// Whether anything runs along it backwards.
    pub both_ways: bool,
}

/// A piece of input segments between two vertices, with what it will be as an [`Edge`].
struct Piece {
    segment: Segment,
    ends: [usize; 2],
    weights: Vec<(usize, i32)>,
    both_ways: bool,
    /// Made by the last cut.
    fresh: bool,
}

/// The edges that segments of operands make, cut where they meet; coincident ones are one.
pub(super) fn edges<E: Effort>(
    segments: impl Iterator<Item = (usize, Segment)>,
    tolerance: f64,
    effort: &E,
) -> Result<Vec<Edge>, E::Stop> {
    let mut vertices = Vertices {
        tolerance,
        points: Vec::new(),
        cells: HashMap::default(),
    };
    let mut pieces: Vec<Piece> = Vec::new();
    for (operand, segment) in segments {
        effort.spend(1)?;
        for segment in segment.pieces() {
            let ends = [vertices.at(segment.from()), vertices.at(segment.to())];
            pieces.push(Piece {
                segment: segment.with_ends(vertices.point(ends[0]), vertices.point(ends[1])),
                ends,
                weights: vec![(operand, 1)],
                both_ways: false,
                fresh: true,
            });
        }
    }
    // A cut moves the pieces onto the vertex, by which they may come to cross others a little beside
    // it. Mostly the second round finds nothing more. What coincides is one before it is cut: contours that
    // are run through again and again cost no more than once.
    const ROUNDS: usize = 5;
    for _ in 0..ROUNDS {
        let united = unite_coincident(pieces, tolerance, effort)?;
        let count = united.len();
        pieces = cut(united, &mut vertices, effort)?;
        if pieces.len() == count {
            break;
        }
    }
    let pieces = unite_coincident(pieces, tolerance, effort)?.into_iter();
    let kept = pieces.filter(|piece| piece.weights.iter().any(|(_, weight)| *weight != 0));
    Ok(kept.map(|piece| piece.edge(tolerance)).collect())
}

/// The pieces cut where they meet: first finds all common points, then cuts every piece at every vertex
/// that it passes within the tolerance, so that no edge runs by a vertex it should end in.
fn cut<E: Effort>(pieces: Vec<Piece>, vertices: &mut Vertices, effort: &E) -> Result<Vec<Piece>, E::Stop> {
    let boxes: Vec<Bounds> = pieces.iter().map(|piece| Bounds::of(&piece.segment)).collect();
    add_crossings(&pieces, &boxes, vertices, effort)?;
    // A common point is that near to the segment, and its vertex again that near to the point.
    let reach = 2.0 * vertices.tolerance;
    let points = Tree::new(
        vertices.points.iter().map(|point| Bounds::of_point(*point)),
        effort,
    )?;
    let mut result = Vec::with_capacity(pieces.len());
    let mut stops = Vec::new();
    for (piece, bounds) in pieces.into_iter().zip(&boxes) {
        stops.clear();
        let steps = points.touching(&bounds.grown(reach), |vertex| {
            if piece.ends.contains(&vertex) {
                return;
            }
            let point = vertices.point(vertex);
            let (t, nearest) = piece.segment.nearest(point);
            if t > 0.0 && t < 1.0 && distance(nearest, point) <= reach {
                stops.push((t, vertex));
            }
        });
        effort.spend(steps + E::KEPT * stops.len())?;
        if !stops.is_empty() {
            piece.cut_at(&mut stops, vertices, &mut result);
        } else if piece.ends[0] != piece.ends[1] {
            result.push(Piece {
                fresh: false,
                ..piece
            });
        }
    }
    Ok(result)
}

/// Makes vertices of all points in which pieces cross or touch.
fn add_crossings<E: Effort>(
    pieces: &[Piece],
    boxes: &[Bounds],
    vertices: &mut Vertices,
    effort: &E,
) -> Result<(), E::Stop> {
    let tolerance = vertices.tolerance;
    let tree = Tree::new(boxes.iter().copied(), effort)?;
    let mut beside = Vec::new();
    for (place, (a, bounds)) in pieces.iter().zip(boxes).enumerate() {
        let known = vertices.points.len();
        let steps = tree.touching(&bounds.grown(tolerance), |other| {
            if other > place {
                beside.push(other);
            }
        });
        for b in beside.drain(..).filter_map(|other| pieces.get(other)) {
            // What the last cut left as it was has its common points already, and ends are vertices.
            if (a.fresh || b.fresh) && !a.meets_at_end(b) {
                for point in crossings(&a.segment, &b.segment, tolerance).into_iter().flatten() {
                    vertices.at(point);
                }
            }
        }
        effort.spend(steps + E::KEPT * (vertices.points.len() - known))?;
    }
    Ok(())
}

impl Piece {
    /// Adds the parts between the given vertices, each with its fraction of the piece.
    fn cut_at(&self, stops: &mut Vec<(f64, usize)>, vertices: &Vertices, parts: &mut Vec<Piece>) {
        stops.push((1.0, self.ends[1]));
        stops.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut last = (0.0, self.ends[0]);
        for stop in stops.iter() {
            let ((t0, start), (t1, end)) = (last, *stop);
            last = *stop;
            if start != end {
                let (from, to) = (vertices.point(start), vertices.point(end));
                parts.push(Piece {
                    segment: part_between(&self.segment, t1 - t0, from, to),
                    ends: [start, end],
                    weights: self.weights.clone(),
                    both_ways: self.both_ways,
                    fresh: true,
                });
            }
        }
    }

    /// Whether both are lines from one vertex, which have no other common point.
    fn meets_at_end(&self, other: &Piece) -> bool {
        let lines = |piece: &Piece| matches!(piece.segment, Segment::Line { .. });
        other.ends.iter().any(|end| self.ends.contains(end)) && lines(self) && lines(other)
    }

    /// Takes up a piece that coincides with this one.
    fn unite(&mut self, other: &Piece) {
        let sign = if self.ends == other.ends { 1 } else { -1 };
        self.both_ways |= other.both_ways || sign < 0;
        for (operand, weight) in &other.weights {
            match self.weights.iter_mut().find(|(o, _)| o == operand) {
                Some((_, own)) => *own += sign * weight,
                None => self.weights.push((*operand, sign * weight)),
            }
        }
    }

    fn edge(self, tolerance: f64) -> Edge {
        let chord = Segment::line(self.segment.from(), self.segment.to());
        let flat = distance(chord.point(0.5), self.segment.point(0.5)) <= flatness(tolerance);
        Edge {
            ends: self.ends,
            course: if flat { chord } else { self.segment },
            segment: self.segment,
            weights: self.weights,
            both_ways: self.both_ways,
        }
    }
}

/// Pieces with the same ends that bulge less than this apart are one, mm.
fn coincidence(tolerance: f64) -> f64 {
    4.0 * tolerance
}

/// Arcs that rise no higher than this above their chord count as it, mm. That is half of what coincides:
/// two such arcs on both sides of one chord are one, as nothing would tell which of them is on which side,
/// and the lens between them could be turned inside out.
fn flatness(tolerance: f64) -> f64 {
    0.5 * coincidence(tolerance)
}

/// The pieces with coincident ones united, in the order of the first of each.
fn unite_coincident<E: Effort>(
    pieces: Vec<Piece>,
    tolerance: f64,
    effort: &E,
) -> Result<Vec<Piece>, E::Stop> {
    let mut united: Vec<Piece> = Vec::with_capacity(pieces.len());
    // The last piece between two vertices, and for each piece the one before it between the same.
    let mut between: HashMap<[usize; 2], usize, Mixing> = HashMap::default();
    let mut before: Vec<Option<usize>> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let mut key = piece.ends;
        key.sort_unstable();
        let middle = piece.segment.point(0.5);
        let last = between.get(&key).copied();
        let (mut same, mut steps) = (last, 1);
        while let Some(c) = same
            && united
                .get(c)
                .is_some_and(|other| distance(other.segment.point(0.5), middle) > coincidence(tolerance))
        {
            same = before.get(c).copied().flatten();
            steps += 1;
        }
        effort.spend(steps)?;
        if let Some(other) = same.and_then(|c| united.get_mut(c)) {
            other.unite(&piece);
            other.fresh |= piece.fresh;
        } else {
            between.insert(key, united.len());
            before.push(last);
            united.push(piece);
        }
    }
    Ok(united)
}

/// The part of a segment that is `share` of it, between vertices near its ends.
fn part_between(segment: &Segment, share: f64, from: Point2, to: Point2) -> Segment {
    if let (
        Segment::Arc {
            centre, sweep_deg, ..
        },
        Some(radius),
    ) = (*segment, segment.radius())
    {
        let sweep_deg = sweep_deg * share;
        let chord = 2.0 * radius * (0.5 * sweep_deg.abs().to_radians()).sin();
        // Of the length of the resolution, where the vertices lie decides more than the arc does.
        if (chord - distance(from, to)).abs() <= 0.5 * chord {
            return Segment::Arc {
                from,
                to,
                centre,
                sweep_deg,
            };
        }
    }
    Segment::Line { from, to }
}

/// Points, those within the tolerance of each other being one.
struct Vertices {
    tolerance: f64,
    points: Vec<Point2>,
    cells: HashMap<[i64; 2], Vec<usize>, Mixing>,
}

impl Vertices {
    /// The vertex at a point, a new one if there is none.
    fn at(&mut self, point: Point2) -> usize {
        let side = 4.0 * self.tolerance;
        let cell = |v: f64| (v / side).floor() as i64;
        let (low, high) = (
            point.map(|v| cell(v - self.tolerance)),
            point.map(|v| cell(v + self.tolerance)),
        );
        let mut nearest: Option<(f64, usize)> = None;
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for vertex in self.cells.get(&[i, j]).into_iter().flatten() {
                    let d = distance(self.point(*vertex), point);
                    if d <= self.tolerance && nearest.is_none_or(|(least, _)| d < least) {
                        nearest = Some((d, *vertex));
                    }
                }
            }
        }
        if let Some((_, vertex)) = nearest {
            return vertex;
        }
        let vertex = self.points.len();
        self.points.push(point);
        self.cells.entry(point.map(cell)).or_default().push(vertex);
        vertex
    }

    fn point(&self, vertex: usize) -> Point2 {
        self.points.get(vertex).copied().unwrap_or_default()
    }
}

/// Hashes of small whole numbers that nobody chose to collide.
type Mixing = BuildHasherDefault<Mixer>;

#[derive(Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u64(&mut self, value: u64) {
        // Multiplication by 2^64 / golden ratio carries every bit upward, the rotation brings it down.
        self.0 = (self.0 ^ value)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .rotate_left(29);
    }

    fn write_i64(&mut self, value: i64) {
        self.write_u64(value as u64);
    }

    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
