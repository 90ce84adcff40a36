//! Areas and their boolean operations.

use super::arrangement::overlay;
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
/// use bahn_path::region::{Contour, Region};
/// let plate = Region::from_contour(&Contour::rectangle([0.0, 0.0], [100.0, 60.0]));
/// let bore = Region::from_contour(&Contour::circle([50.0, 30.0], 20.0, 0.0, true));
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
        let contour = contour.clone().closed();
        Region::overlay(&[(0, &contour)], 1, &|w| w.first().is_some_and(|w| *w != 0))
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
        let contours: Vec<(usize, &Contour)> = regions
            .iter()
            .enumerate()
            .flat_map(|(operand, region)| region.contours.iter().map(move |c| (operand, c)))
            .collect();
        Region::overlay(&contours, regions.len(), &|winding| {
            rule(&winding.iter().map(|w| *w > 0).collect::<Vec<bool>>())
        })
    }

    /// The region whose boundary [`overlay`] finds.
    pub(super) fn overlay(
        contours: &[(usize, &Contour)],
        operands: usize,
        inside: &dyn Fn(&[i32]) -> bool,
    ) -> Region {
        Region::from_loops(overlay(contours, operands, inside))
    }

    /// Puts every hole behind the outer contour that holds it.
    fn from_loops(loops: Vec<Contour>) -> Region {
        let (outer, holes): (Vec<Contour>, Vec<Contour>) =
            loops.into_iter().partition(Contour::is_counter_clockwise);
        let mut parts: Vec<Vec<Contour>> = outer.into_iter().map(|c| vec![c]).collect();
        for hole in holes {
            let holders = parts
                .iter_mut()
                .filter(|part| part.first().is_some_and(|outer| encloses(outer, &hole)));
            let area = |part: &Vec<Contour>| part.first().map_or(0.0, Contour::area);
            if let Some(part) = holders.min_by(|a, b| area(a).total_cmp(&area(b))) {
                part.push(hole);
            }
        }
        Region {
            contours: parts.into_iter().flatten().collect(),
        }
    }
}

/// Whether a loop that does not cross `outer` lies inside it. They may touch in points.
fn encloses(outer: &Contour, inner: &Contour) -> bool {
    let samples = inner
        .segments()
        .iter()
        .flat_map(|s| [s.point(0.5), s.point(0.25), s.point(0.75)]);
    let mut places = samples.map(|p| outer.locate(p));
    places.find(|place| *place != Location::Boundary) == Some(Location::Inside)
}
