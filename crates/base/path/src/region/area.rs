//! Areas and their boolean operations.

use super::arrangement::overlay;
use super::effort::{Effort, Unlimited};
use super::index::Index;
use super::{Contour, Location, RESOLUTION_MM};
use crate::Point2;

/// An area of the plane: outer contours (counter-clockwise), each followed by its holes (clockwise).
/// The area lies left of every contour. Contours are simple and touch each other at most in points.
///
/// Results of operations are regularised: parts thinner than [`RESOLUTION_MM`] vanish, areas that share
/// an edge grow together, lines and arcs that continue each other become one. The same input gives the
/// same output, bit for bit.
///
/// ```
/// use bahn_path::Sense;
/// use bahn_path::region::{Contour, Region};
/// let plate = Region::from_contour(&Contour::rectangle([0.0, 0.0], [100.0, 60.0]));
/// let bore = Region::from_contour(&Contour::circle([50.0, 30.0], 20.0, 0.0, Sense::CounterClockwise));
/// let ring = plate.difference(&bore);
/// assert_eq!(ring.contours().len(), 2);
/// assert!((ring.area() - (6000.0 - std::f64::consts::PI * 400.0)).abs() < 1e-9);
/// // The centre of a tool of radius 5 may go where the ring, shrunk by 5, is.
/// let centre = ring.offset(-5.0);
/// assert!((centre.area() - (90.0 * 50.0 - std::f64::consts::PI * 625.0)).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    contours: Vec<Contour>,
}

impl Region {
    /// The region without area.
    pub const EMPTY: Region = Region { contours: Vec::new() };

    /// The area inside a contour, whatever its sense; an open chain is closed by a line. Where a contour
    /// crosses itself, everything it goes around counts (non-zero winding rule).
    pub fn from_contour(contour: &Contour) -> Region {
        let Ok(region) = Region::from_contour_within(contour, &Unlimited);
        region
    }

    /// [`Region::from_contour`] with an effort that may end it.
    ///
    /// # Errors
    /// When the effort ends it.
    pub(crate) fn from_contour_within<E: Effort>(contour: &Contour, effort: &E) -> Result<Region, E::Stop> {
        let contour = contour.clone().closed();
        let inside = |w: &[i32]| w.first().is_some_and(|w| *w != 0);
        Region::from_loops(overlay(&[(0, &contour)], 1, &inside, effort)?, effort)
    }

    /// The contours: each outer one followed by its holes.
    pub fn contours(&self) -> &[Contour] {
        &self.contours
    }

    /// The connected parts, each an outer contour with its holes. Parts that touch in a point are apart.
    pub fn parts(&self) -> impl Iterator<Item = Region> {
        let mut rest = self.contours.as_slice();
        std::iter::from_fn(move || {
            let (outer, after) = rest.split_first()?;
            let holes = after.iter().take_while(|c| !c.is_counter_clockwise()).count();
            let (holes, next) = after.split_at(holes);
            rest = next;
            Some(Region {
                contours: std::iter::once(outer).chain(holes).cloned().collect(),
            })
        })
    }

    /// Whether there is no area.
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    /// Area, mm².
    pub fn area(&self) -> f64 {
        self.contours.iter().map(Contour::signed_area).sum()
    }

    /// Length of all contours, mm.
    pub fn perimeter(&self) -> f64 {
        self.contours.iter().map(Contour::length).sum()
    }

    /// Least and greatest corner of the bounding box; `None` when empty.
    pub fn bounding_box(&self) -> Option<(Point2, Point2)> {
        let boxes = self.contours.iter().map(Contour::bounding_box);
        boxes.reduce(|(a, b), (c, d)| ([a[0].min(c[0]), a[1].min(c[1])], [b[0].max(d[0]), b[1].max(d[1])]))
    }

    /// Distance of a point to the boundary, mm; infinite when empty.
    pub fn boundary_distance(&self, point: Point2) -> f64 {
        self.contours
            .iter()
            .map(|c| c.distance(point))
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether a point lies inside, on the boundary or outside.
    pub fn locate(&self, point: Point2) -> Location {
        if self.boundary_distance(point) <= RESOLUTION_MM {
            return Location::Boundary;
        }
        let winding: i32 = self.contours.iter().map(|c| c.winding(point)).sum();
        if winding > 0 {
            Location::Inside
        } else {
            Location::Outside
        }
    }

    /// Whether a point lies inside or on the boundary.
    pub fn contains(&self, point: Point2) -> bool {
        self.locate(point) != Location::Outside
    }

    /// The area of either.
    #[must_use]
    pub fn union(&self, other: &Region) -> Region {
        Region::combine(&[self, other], &|inside| inside.contains(&true))
    }

    /// The area of both.
    #[must_use]
    pub fn intersection(&self, other: &Region) -> Region {
        Region::combine(&[self, other], &|inside| !inside.contains(&false))
    }

    /// The area of this one that is not in the other.
    #[must_use]
    pub fn difference(&self, other: &Region) -> Region {
        Region::combine(&[self, other], &|inside| *inside == [true, false])
    }

    /// The area that `rule` names, given for any point in which of the regions it lies. One step
    /// however many regions there are.
    pub fn combine(regions: &[&Region], rule: &dyn Fn(&[bool]) -> bool) -> Region {
        let Ok(region) = Region::combine_within(regions, rule, &Unlimited);
        region
    }

    /// [`Region::combine`] with an effort that may end it.
    ///
    /// # Errors
    /// When the effort ends it.
    pub fn combine_within<E: Effort>(
        regions: &[&Region],
        rule: &dyn Fn(&[bool]) -> bool,
        effort: &E,
    ) -> Result<Region, E::Stop> {
        if let ([only], true, false) = (regions, rule(&[true]), rule(&[false])) {
            return Ok((*only).clone());
        }
        let contours: Vec<(usize, &Contour)> = regions
            .iter()
            .enumerate()
            .flat_map(|(operand, region)| region.contours.iter().map(move |c| (operand, c)))
            .collect();
        let inside = |winding: &[i32]| rule(&winding.iter().map(|w| *w > 0).collect::<Vec<bool>>());
        Region::from_loops(overlay(&contours, regions.len(), &inside, effort)?, effort)
    }

    /// Puts every hole after the outer contour that holds it.
    pub(super) fn from_loops<E: Effort>(loops: Vec<Contour>, effort: &E) -> Result<Region, E::Stop> {
        let (outer, holes): (Vec<Contour>, Vec<Contour>) =
            loops.into_iter().partition(Contour::is_counter_clockwise);
        if holes.is_empty() {
            return Ok(Region { contours: outer });
        }
        let outlines = Outlines::new(&outer, effort)?;
        let mut parts: Vec<Vec<Contour>> = outer.into_iter().map(|c| vec![c]).collect();
        for hole in holes {
            let holder = outlines.holder(&hole, effort)?;
            if let Some(part) = holder.and_then(|holder| parts.get_mut(holder)) {
                part.push(hole);
            }
        }
        Ok(Region {
            contours: parts.into_iter().flatten().collect(),
        })
    }
}

/// Outer contours, to find which of them holds a hole.
struct Outlines {
    index: Index,
    /// For each segment its contour.
    of: Vec<usize>,
    areas: Vec<f64>,
}

impl Outlines {
    fn new<E: Effort>(outer: &[Contour], effort: &E) -> Result<Outlines, E::Stop> {
        let numbered = outer.iter().enumerate();
        Ok(Outlines {
            index: Index::new(outer.iter().flat_map(Contour::segments).copied(), effort)?,
            of: numbered
                .flat_map(|(k, c)| std::iter::repeat_n(k, c.segments().len()))
                .collect(),
            areas: outer.iter().map(Contour::area).collect(),
        })
    }

    /// The smallest contour that holds a loop which crosses none; they may touch in points.
    fn holder<E: Effort>(&self, hole: &Contour, effort: &E) -> Result<Option<usize>, E::Stop> {
        let samples = hole
            .segments()
            .iter()
            .flat_map(|s| [s.point(0.5), s.point(0.25), s.point(0.75)]);
        for point in samples {
            let near = self.index.nearest(point, 2.0 * RESOLUTION_MM, effort)?;
            if near.is_some_and(|(gap, _)| gap <= RESOLUTION_MM) {
                continue;
            }
            let mut turns: Vec<(usize, i32)> = Vec::new();
            self.index
                .windings(point, [1.0, 0.0], effort, |segment, winding| {
                    let contour = self.of.get(segment).copied().unwrap_or(0);
                    turns.push((contour, winding));
                })?;
            turns.sort_unstable();
            let area = |contour: usize| self.areas.get(contour).copied().unwrap_or(0.0);
            let holders = turns
                .chunk_by(|a, b| a.0 == b.0)
                .filter(|chunk| chunk.iter().map(|(_, winding)| winding).sum::<i32>() != 0)
                .filter_map(|chunk| chunk.first());
            let least = holders.min_by(|a, b| area(a.0).total_cmp(&area(b.0)));
            return Ok(least.map(|(contour, _)| *contour));
        }
        Ok(None)
    }
}
