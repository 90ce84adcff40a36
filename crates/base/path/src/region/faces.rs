//! The faces between edges.

use std::collections::BinaryHeap;

use super::edges::Edge;
use super::effort::Effort;
use super::index::Index;
use super::vector::*;
use super::{Contour, RESOLUTION_MM, Segment};
use crate::Point2;

/// The faces between edges. Half-edge `2 e` runs along edge `e`, half-edge `2 e + 1` against it; each has
/// its face on the left. A face is known by one of its borders: one with several of them is several here.
pub(super) struct Faces {
    edges: Vec<Edge>,
    /// For each half-edge the next one around its face.
    next: Vec<usize>,
    /// For each half-edge its face.
    face: Vec<usize>,
    /// For each face its longest half-edge and the length of that.
    longest: Vec<(f64, usize)>,
}

impl Faces {
    pub fn new<E: Effort>(edges: Vec<Edge>, effort: &E) -> Result<Faces, E::Stop> {
        let mut faces = Faces {
            next: vec![0; 2 * edges.len()],
            face: Vec::new(),
            longest: Vec::new(),
            edges,
        };
        for half_edges in leaving(&faces.edges) {
            effort.spend(half_edges.len())?;
            let around = faces.counter_clockwise(half_edges);
            // Arriving against one half-edge, the face on the left goes on along the one clockwise of it.
            for (clockwise, half_edge) in around.iter().zip(around.iter().cycle().skip(1)) {
                if let Some(next) = faces.next.get_mut(half_edge ^ 1) {
                    *next = *clockwise;
                }
            }
        }
        faces.trace(effort)?;
        Ok(faces)
    }

    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// How many faces there are.
    pub fn count(&self) -> usize {
        self.longest.len()
    }

    /// The face left of a half-edge.
    pub fn left_of(&self, half_edge: usize) -> usize {
        self.face.get(half_edge).copied().unwrap_or(0)
    }

    /// The half-edge as a segment in its direction.
    fn segment(&self, half_edge: usize) -> Segment {
        directed(self.edges.get(half_edge / 2).map(|edge| edge.segment), half_edge)
    }

    /// The segment of a half-edge in its direction; see [`Edge::course`].
    fn course(&self, half_edge: usize) -> Segment {
        directed(self.edges.get(half_edge / 2).map(|edge| edge.course), half_edge)
    }

    /// Half-edges that leave one vertex in counter-clockwise order.
    fn counter_clockwise(&self, half_edges: Vec<usize>) -> Vec<usize> {
        if half_edges.len() < 3 {
            return half_edges;
        }
        let mut leaving: Vec<(f64, Segment, usize)> = half_edges
            .into_iter()
            .map(|h| {
                let course = self.course(h);
                let tangent = course.tangent(0.0);
                (tangent[1].atan2(tangent[0]), course, h)
            })
            .collect();
        leaving.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Counting starts in the widest gap, so that no two nearly equal directions are torn apart.
        let angles: Vec<f64> = leaving.iter().map(|(angle, ..)| *angle).collect();
        let last_turn = angles.last().map(|angle| angle - std::f64::consts::TAU);
        let gaps = last_turn
            .iter()
            .chain(&angles)
            .zip(&angles)
            .map(|(before, angle)| (angle - before, before));
        let widest = gaps.enumerate().max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let (first, middle) = widest.map_or((0, 0.0), |(first, (gap, before))| (first, before + 0.5 * gap));
        let reference = [middle.cos(), middle.sin()];
        leaving.rotate_left(first);
        // Tangents put nearly all in order.
        let mut sorted: Vec<(f64, Segment, usize)> = Vec::with_capacity(leaving.len());
        for candidate in leaving {
            let after = sorted.iter().rev();
            let before = after.take_while(|other| is_before(&candidate.1, &other.1, reference));
            sorted.insert(sorted.len() - before.count(), candidate);
        }
        sorted.into_iter().map(|(_, _, h)| h).collect()
    }

    /// Numbers the faces by their half-edges.
    fn trace<E: Effort>(&mut self, effort: &E) -> Result<(), E::Stop> {
        const NONE: usize = usize::MAX;
        self.face = vec![NONE; self.next.len()];
        for first in 0..self.next.len() {
            if self.face.get(first) != Some(&NONE) {
                continue;
            }
            effort.spend(1)?;
            let (mut half_edge, mut longest) = (first, (0.0, first));
            while let Some(face) = self.face.get_mut(half_edge).filter(|face| **face == NONE) {
                *face = self.longest.len();
                let length = self.segment(half_edge).length();
                if length > longest.0 {
                    longest = (length, half_edge);
                }
                half_edge = self.next.get(half_edge).copied().unwrap_or(first);
            }
            self.longest.push(longest);
        }
        Ok(())
    }

    /// The winding numbers of the operands in every face. They are counted once for all faces that hang
    /// together, at the longest half-edge of them, where that is safest; from there they change at every edge
    /// by what runs along it, over long edges first: where directions were mistaken edges are short.
    pub fn windings<E: Effort>(&self, operands: usize, effort: &E) -> Result<Windings, E::Stop> {
        let index = Index::new(self.edges.iter().map(|edge| edge.course), effort)?;
        let mut windings = Windings {
            operands,
            numbers: vec![0; operands * self.count()],
        };
        let mut known = vec![false; self.count()];
        let mut order: Vec<usize> = (0..self.count()).collect();
        let length = |face: &usize| self.longest.get(*face).map_or(0.0, |(length, _)| *length);
        order.sort_by(|a, b| length(b).total_cmp(&length(a)).then(a.cmp(b)));
        for root in order {
            if known.get(root) != Some(&false) {
                continue;
            }
            let at = self.longest.get(root).map_or(0, |(_, half_edge)| *half_edge);
            let counted = self.winding_left(at, &index, operands, effort)?;
            windings.set(root, &counted);
            let mut open = BinaryHeap::new();
            let mut reached = Some((root, at));
            while let Some((face, border)) = reached.take() {
                if let Some(known) = known.get_mut(face) {
                    *known = true;
                }
                self.open_edges(border, &mut open);
                effort.spend(1)?;
                while let Some(Crossing { half_edge, .. }) = open.pop() {
                    let (here, there) = (self.left_of(half_edge), self.left_of(half_edge ^ 1));
                    if known.get(there) == Some(&false) {
                        let weights = self.edges.get(half_edge / 2).map_or(&[][..], |e| &e.weights);
                        let sign = if half_edge % 2 == 0 { -1 } else { 1 };
                        windings.step(here, there, weights, sign);
                        reached = Some((there, half_edge ^ 1));
                        break;
                    }
                }
            }
        }
        Ok(windings)
    }

    /// Adds all half-edges around the face of one of them.
    fn open_edges(&self, first: usize, open: &mut BinaryHeap<Crossing>) {
        let mut half_edge = first;
        loop {
            open.push(Crossing {
                length: self.segment(half_edge).length(),
                half_edge,
            });
            half_edge = self.following(half_edge);
            if half_edge == first {
                return;
            }
        }
    }

    /// Length of the edges at which the faces on both sides do not differ by what runs along the edge,
    /// mm: somewhere directions at a vertex were mistaken.
    pub fn tangled_length(&self, windings: &Windings) -> f64 {
        let tangled = self.edges.iter().enumerate().filter(|(index, edge)| {
            let [left, right] = [2 * index, 2 * index + 1].map(|h| windings.of(self.left_of(h)));
            left.iter().zip(right).enumerate().any(|(operand, (l, r))| {
                let mut weights = edge.weights.iter();
                let weight = weights.find(|(o, _)| *o == operand).map_or(0, |(_, w)| *w);
                l - r != weight
            })
        });
        tangled.map(|(_, edge)| edge.segment.length()).sum()
    }

    /// The loops around the faces that are given as inside, interior on the left.
    ///
    /// # Errors
    /// When the effort ends it.
    pub fn boundary<E: Effort>(&self, inside: &[bool], effort: &E) -> Result<Vec<Contour>, E::Stop> {
        let holds = |half_edge: usize| inside.get(self.left_of(half_edge)).copied().unwrap_or(false);
        let on_boundary = |half_edge: usize| holds(half_edge) && !holds(half_edge ^ 1);
        let mut used = vec![false; self.next.len()];
        let mut loops = Vec::new();
        let mut splitter = Splitter::new(self);
        for first in (0..self.next.len()).filter(|h| on_boundary(*h)) {
            let mut half_edge = first;
            while let Some(used) = used.get_mut(half_edge).filter(|used| !**used) {
                *used = true;
                effort.spend(1)?;
                splitter.push(half_edge, &mut loops);
                // Around the corner of the interior: edges that have it on both sides are passed over.
                half_edge = self.following(half_edge);
                while !on_boundary(half_edge) {
                    half_edge = self.following(half_edge ^ 1);
                }
            }
            splitter.clear();
        }
        Ok(loops)
    }

    fn following(&self, half_edge: usize) -> usize {
        self.next.get(half_edge).copied().unwrap_or(half_edge)
    }

    fn start_of(&self, half_edge: usize) -> usize {
        let edge = self.edges.get(half_edge / 2);
        edge.map_or(0, |edge| edge.ends[half_edge % 2])
    }

    /// The winding numbers just left of the middle of a half-edge.
    fn winding_left<E: Effort>(
        &self,
        half_edge: usize,
        index: &Index,
        operands: usize,
        effort: &E,
    ) -> Result<Vec<i32>, E::Stop> {
        let mut winding = vec![0; operands];
        let course = self.course(half_edge);
        let middle = course.point(0.5);
        // The ray leaves to the left and, as no edge sweeps more than 120 degrees, never meets its own
        // edge again. It is askew, because in drawings edges meet at right angles.
        const ASKEW: f64 = 0.29;
        let ray = turned(left(course.tangent(0.5)), ASKEW);
        index.windings(middle, ray, effort, |other, turns| {
            let weights = self.edges.get(other).map_or(&[][..], |edge| &edge.weights);
            for (operand, weight) in weights.iter().filter(|_| other != half_edge / 2) {
                if let Some(w) = winding.get_mut(*operand) {
                    *w += turns * weight;
                }
            }
        })?;
        Ok(winding)
    }
}

/// The winding numbers of each operand in each face.
pub(super) struct Windings {
    operands: usize,
    numbers: Vec<i32>,
}

impl Windings {
    pub fn of(&self, face: usize) -> &[i32] {
        let start = face * self.operands;
        self.numbers.get(start..start + self.operands).unwrap_or_default()
    }

    fn set(&mut self, face: usize, winding: &[i32]) {
        let start = face * self.operands;
        let numbers = self.numbers.get_mut(start..start + self.operands);
        for (number, value) in numbers.unwrap_or_default().iter_mut().zip(winding) {
            *number = *value;
        }
    }

    /// The numbers across an edge.
    fn step(&mut self, here: usize, there: usize, weights: &[(usize, i32)], sign: i32) {
        let mut winding = self.of(here).to_vec();
        for (operand, weight) in weights {
            if let Some(w) = winding.get_mut(*operand) {
                *w += sign * weight;
            }
        }
        self.set(there, &winding);
    }
}

/// A half-edge over which the face on its other side may be reached: longer ones first.
struct Crossing {
    length: f64,
    half_edge: usize,
}

impl Ord for Crossing {
    fn cmp(&self, other: &Crossing) -> std::cmp::Ordering {
        let by_length = self.length.total_cmp(&other.length);
        by_length.then(other.half_edge.cmp(&self.half_edge))
    }
}

impl PartialOrd for Crossing {
    fn partial_cmp(&self, other: &Crossing) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Crossing {
    fn eq(&self, other: &Crossing) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Crossing {}

/// Splits a closed path wherever it passes a vertex again.
struct Splitter<'a> {
    faces: &'a Faces,
    open: Vec<usize>,
    /// For each vertex the place in `open` of the half-edge that starts there.
    places: Vec<Option<usize>>,
}

impl Splitter<'_> {
    fn new(faces: &Faces) -> Splitter<'_> {
        Splitter {
            faces,
            open: Vec::new(),
            places: vec![None; vertex_count(&faces.edges)],
        }
    }

    fn push(&mut self, half_edge: usize, loops: &mut Vec<Contour>) {
        self.place(self.faces.start_of(half_edge), Some(self.open.len()));
        self.open.push(half_edge);
        let end = self.faces.start_of(half_edge ^ 1);
        let Some(start) = self.places.get(end).copied().flatten() else {
            return;
        };
        let ring = self.open.split_off(start);
        ring.iter()
            .for_each(|h| self.place(self.faces.start_of(*h), None));
        if let Some(contour) = Contour::chained(ring.iter().map(|h| self.faces.segment(*h))) {
            // What is thinner than the resolution is no area, and what is not much larger all
            // around comes of moved vertices.
            let length = contour.length();
            if contour.area() > RESOLUTION_MM * length && length > 100.0 * RESOLUTION_MM {
                loops.push(contour.simplified());
            }
        }
    }

    fn place(&mut self, vertex: usize, place: Option<usize>) {
        if let Some(entry) = self.places.get_mut(vertex) {
            *entry = place;
        }
    }

    fn clear(&mut self) {
        let open = std::mem::take(&mut self.open);
        open.iter()
            .for_each(|h| self.place(self.faces.start_of(*h), None));
    }
}

/// One more than the greatest number of a vertex.
fn vertex_count(edges: &[Edge]) -> usize {
    edges.iter().flat_map(|edge| edge.ends).max().map_or(0, |v| v + 1)
}

/// For each vertex the half-edges that leave it.
pub(super) fn leaving(edges: &[Edge]) -> Vec<Vec<usize>> {
    let mut leaving = vec![Vec::new(); vertex_count(edges)];
    for (index, edge) in edges.iter().enumerate() {
        for (side, vertex) in edge.ends.into_iter().enumerate() {
            if let Some(half_edges) = leaving.get_mut(vertex) {
                half_edges.push(2 * index + side);
            }
        }
    }
    leaving
}

fn directed(segment: Option<Segment>, half_edge: usize) -> Segment {
    match segment {
        Some(segment) if half_edge.is_multiple_of(2) => segment,
        Some(segment) => segment.reversed(),
        None => Segment::line([0.0, 0.0], [0.0, 0.0]),
    }
}

/// Whether of two segments from one point the first comes before the second, counter-clockwise from the
/// reference direction. They are compared where both pass one small circle about the point, which tells
/// segments apart that are tangent to each other.
fn is_before(a: &Segment, b: &Segment, reference: Point2) -> bool {
    let chord = |s: &Segment| distance(s.from(), s.to());
    let radius = 0.5 * chord(a).min(chord(b));
    let angle = |s: &Segment| {
        let angle = angle_between(reference, direction_at(s, radius));
        if angle < 0.0 {
            angle + std::f64::consts::TAU
        } else {
            angle
        }
    };
    angle(a) < angle(b)
}

/// Direction from the start of a segment to its point at the distance `chord` from the start.
pub(super) fn direction_at(segment: &Segment, chord: f64) -> Point2 {
    match *segment {
        Segment::Line { from, to } => sub(to, from),
        Segment::Arc { sweep_deg, .. } => {
            let radius = segment.radius().unwrap_or(0.0);
            let half = (chord / (2.0 * radius).max(f64::MIN_POSITIVE)).min(1.0).asin();
            turned(segment.tangent(0.0), half.copysign(sweep_deg))
        }
    }
}
