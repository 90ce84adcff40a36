//! Finding what is near: a tree of bounding boxes, and segments in it.

use super::effort::Effort;
use super::vector::*;
use super::{Location, RESOLUTION_MM, Segment};
use crate::Point2;

/// A box along a direction: slanted lines close to each other have slim boxes that do not overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The direction, a unit vector; coordinates are along it and to its left.
    axis: Point2,
    min: Point2,
    max: Point2,
}

impl Bounds {
    pub fn of(segment: &Segment) -> Bounds {
        let chord = unit(sub(segment.to(), segment.from()));
        let axis = if dot(chord, chord) > 0.5 {
            chord
        } else {
            [1.0, 0.0]
        };
        let (along, aside) = (segment.extent(axis), segment.extent(left(axis)));
        Bounds {
            axis,
            min: [along.0, aside.0],
            max: [along.1, aside.1],
        }
    }

    pub fn of_point(point: Point2) -> Bounds {
        Bounds::between(point, point)
    }

    /// The box parallel to the axes between two corners.
    pub fn between(min: Point2, max: Point2) -> Bounds {
        Bounds {
            axis: [1.0, 0.0],
            min,
            max,
        }
    }

    /// A box around boxes, along their common direction if they have one.
    fn around(boxes: &[(usize, Bounds)]) -> Bounds {
        // Directions count without their sense: their angles are doubled.
        let doubled = boxes.iter().fold([0.0, 0.0], |sum, (_, b)| {
            let [x, y] = b.axis;
            along(sum, [x * x - y * y, 2.0 * x * y], b.max[0] - b.min[0])
        });
        let angle = 0.5 * doubled[1].atan2(doubled[0]);
        let axis = if angle.is_finite() {
            [angle.cos(), angle.sin()]
        } else {
            [1.0, 0.0]
        };
        let mut around = Bounds {
            axis,
            min: [f64::INFINITY; 2],
            max: [f64::NEG_INFINITY; 2],
        };
        for (_, b) in boxes {
            let (min, max) = b.seen_along(axis);
            for k in 0..2 {
                around.min[k] = around.min[k].min(min[k]);
                around.max[k] = around.max[k].max(max[k]);
            }
        }
        around
    }

    /// Least and greatest coordinates in the frame of another direction.
    fn seen_along(&self, axis: Point2) -> (Point2, Point2) {
        let (cos, sin) = (dot(axis, self.axis), cross(axis, self.axis));
        let pair = |factor: f64, k: usize| {
            let (a, b) = (factor * self.min[k], factor * self.max[k]);
            (a.min(b), a.max(b))
        };
        let (x, xs) = (pair(cos, 0), pair(-sin, 1));
        let (y, ys) = (pair(sin, 0), pair(cos, 1));
        ([x.0 + xs.0, y.0 + ys.0], [x.1 + xs.1, y.1 + ys.1])
    }

    fn in_frame(&self, vector: Point2) -> Point2 {
        [dot(vector, self.axis), cross(self.axis, vector)]
    }

    pub fn grown(&self, by: f64) -> Bounds {
        Bounds {
            axis: self.axis,
            min: self.min.map(|v| v - by),
            max: self.max.map(|v| v + by),
        }
    }

    /// Whether the boxes have a common point; two that miss each other just beside their corners count too.
    pub fn touches(&self, other: &Bounds) -> bool {
        let overlap = |a: &Bounds, b: &Bounds| {
            let (min, max) = b.seen_along(a.axis);
            a.min[0] <= max[0] && min[0] <= a.max[0] && a.min[1] <= max[1] && min[1] <= a.max[1]
        };
        overlap(self, other) && overlap(other, self)
    }

    /// Square of the distance of a point, 0 inside.
    fn distance_squared(&self, point: Point2) -> f64 {
        let point = self.in_frame(point);
        let beside = |k: usize| (self.min[k] - point[k]).max(point[k] - self.max[k]).max(0.0);
        let (x, y) = (beside(0), beside(1));
        x * x + y * y
    }

    /// Whether a half line meets the box or passes it within the resolution.
    fn meets_ray(&self, from: Point2, ray: Point2) -> bool {
        let (from, ray) = (self.in_frame(from), self.in_frame(ray));
        let wide = self.grown(RESOLUTION_MM);
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for k in 0..2 {
            if ray[k] == 0.0 {
                if from[k] < wide.min[k] || from[k] > wide.max[k] {
                    return false;
                }
                continue;
            }
            let (a, b) = ((wide.min[k] - from[k]) / ray[k], (wide.max[k] - from[k]) / ray[k]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        near <= far
    }
}

/// A tree over boxes: each node halves its items across the longer side.
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// Items with their boxes in the order of the leaves.
    items: Vec<(usize, Bounds)>,
}

struct Node {
    bounds: Bounds,
    /// Items of its children and their children.
    items: std::ops::Range<usize>,
    /// The second child; the first one is the next node. 0: a leaf.
    second: usize,
}

/// Items of a leaf.
const LEAF: usize = 6;

impl Tree {
    pub fn new<E: Effort>(boxes: impl IntoIterator<Item = Bounds>, effort: &E) -> Result<Tree, E::Stop> {
        let items: Vec<(usize, Bounds)> = boxes.into_iter().enumerate().collect();
        let mut tree = Tree {
            nodes: Vec::with_capacity(items.len() / 2),
            items,
        };
        let all = 0..tree.items.len();
        if !all.is_empty() {
            tree.add(all, effort)?;
        }
        Ok(tree)
    }

    /// Adds the node of some items and all below it. The halves keep it no deeper than the logarithm.
    fn add<E: Effort>(&mut self, range: std::ops::Range<usize>, effort: &E) -> Result<usize, E::Stop> {
        // To sort an item into its half is far less than a test.
        effort.spend(range.len() / 16)?;
        let items = self.items.get_mut(range.clone()).unwrap_or_default();
        let bounds = Bounds::around(items);
        let place = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            items: range.clone(),
            second: 0,
        });
        if range.len() > LEAF {
            let wide = bounds.max[0] - bounds.min[0] >= bounds.max[1] - bounds.min[1];
            let half = items.len() / 2;
            let across = if wide { bounds.axis } else { left(bounds.axis) };
            let middle = |item: &(usize, Bounds)| {
                let Bounds { axis, min, max } = &item.1;
                (min[0] + max[0]) * dot(*axis, across) + (min[1] + max[1]) * cross(*axis, across)
            };
            items.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.0.cmp(&b.0)));
            self.add(range.start..range.start + half, effort)?;
            let second = self.add(range.start + half..range.end, effort)?;
            if let Some(node) = self.nodes.get_mut(place) {
                node.second = second;
            }
        }
        Ok(place)
    }

    /// Calls `found` for every item for whose box, and that of the nodes above, `wanted` holds. The
    /// answer is one more than the number of items.
    fn walk(&self, wanted: impl Fn(&Bounds) -> bool, mut found: impl FnMut(usize)) -> usize {
        let mut steps = 1;
        let mut open = vec![0];
        while let Some(place) = open.pop() {
            let Some(node) = self.nodes.get(place) else {
                continue;
            };
            if !wanted(&node.bounds) {
                continue;
            }
            if node.second > 0 {
                open.push(node.second);
                open.push(place + 1);
                continue;
            }
            let items = self.items.get(node.items.clone()).unwrap_or_default();
            for (item, bounds) in items {
                if wanted(bounds) {
                    steps += 1;
                    found(*item);
                }
            }
        }
        steps
    }

    /// The items whose boxes touch a box; the answer is one more than their number.
    pub fn touching(&self, bounds: &Bounds, found: impl FnMut(usize)) -> usize {
        self.walk(|other| bounds.touches(other), found)
    }

    /// The item nearest to a point, if it is nearer than `within`, by the true distance of an item.
    /// The second answer is one more than the number of items looked at.
    fn nearest(
        &self,
        point: Point2,
        within: f64,
        distance: impl Fn(usize) -> f64,
    ) -> (Option<(f64, usize)>, usize) {
        let (mut best, mut least, mut steps) = (None, within, 1);
        let mut open = vec![(0.0, 0)];
        while let Some((square, place)) = open.pop() {
            let Some(node) = self.nodes.get(place).filter(|_| square < least * least) else {
                continue;
            };
            if node.second > 0 {
                let nodes = &self.nodes;
                let far = |n: usize| {
                    nodes
                        .get(n)
                        .map_or(f64::INFINITY, |n| n.bounds.distance_squared(point))
                };
                let (a, b) = ((far(place + 1), place + 1), (far(node.second), node.second));
                // The nearer one comes first.
                open.extend(if a.0 <= b.0 { [b, a] } else { [a, b] });
                continue;
            }
            for (item, bounds) in self.items.get(node.items.clone()).unwrap_or_default() {
                if bounds.distance_squared(point) < least * least {
                    steps += 1;
                    let gap = distance(*item);
                    if gap < least {
                        (least, best) = (gap, Some((gap, *item)));
                    }
                }
            }
        }
        (best, steps)
    }
}

/// Segments that are found by their place.
pub(super) struct Index {
    segments: Vec<Segment>,
    tree: Tree,
}

impl Index {
    pub fn new<E: Effort>(segments: impl IntoIterator<Item = Segment>, effort: &E) -> Result<Index, E::Stop> {
        let segments: Vec<Segment> = segments.into_iter().collect();
        let tree = Tree::new(segments.iter().map(Bounds::of), effort)?;
        Ok(Index { segments, tree })
    }

    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The nearest segment to a point and its distance, if that is less than `within`.
    pub fn nearest<E: Effort>(
        &self,
        point: Point2,
        within: f64,
        effort: &E,
    ) -> Result<Option<(f64, usize)>, E::Stop> {
        let gap = |item: usize| {
            self.segments
                .get(item)
                .map_or(f64::INFINITY, |s| s.distance(point))
        };
        let (found, steps) = self.tree.nearest(point, within, gap);
        effort.spend(steps)?;
        Ok(found)
    }

    /// The segments whose boxes touch a box.
    pub fn touching<E: Effort>(
        &self,
        bounds: &Bounds,
        effort: &E,
        mut found: impl FnMut(usize, &Segment),
    ) -> Result<(), E::Stop> {
        let steps = self.tree.touching(bounds, |item| {
            if let Some(segment) = self.segments.get(item) {
                found(item, segment);
            }
        });
        effort.spend(steps)
    }

    /// What each segment that counts adds to the winding number about a point, see [`Segment::winding`].
    pub fn windings<E: Effort>(
        &self,
        point: Point2,
        ray: Point2,
        effort: &E,
        mut found: impl FnMut(usize, i32),
    ) -> Result<(), E::Stop> {
        let steps = self.tree.walk(
            |bounds| bounds.meets_ray(point, ray),
            |item| {
                let turns = self.segments.get(item).map_or(0, |s| s.winding(point, ray));
                if turns != 0 {
                    found(item, turns);
                }
            },
        );
        effort.spend(steps)
    }

    /// Whether a point lies inside the contours of a region that the segments are, on them or outside.
    pub fn locate<E: Effort>(&self, point: Point2, effort: &E) -> Result<Location, E::Stop> {
        let touched = self.tree.nearest(point, 2.0 * RESOLUTION_MM, |item| {
            self.segments
                .get(item)
                .map_or(f64::INFINITY, |s| s.distance(point))
        });
        if touched.0.is_some_and(|(gap, _)| gap <= RESOLUTION_MM) {
            return Ok(Location::Boundary);
        }
        let mut winding = 0;
        self.windings(point, [1.0, 0.0], effort, |_, turns| winding += turns)?;
        Ok(if winding > 0 {
            Location::Inside
        } else {
            Location::Outside
        })
    }
}
