//! Random areas of lines and arcs against what is counted and measured along their elements, one by one.

use bahn_path::region::{Contour, Kind, Merge, Region, Segment, SubContour, superimpose};
use bahn_path::{Point2, Sense};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

/// Chords stand for arcs here, no farther from them than this, mm.
const SAGITTA: f64 = 4e-4;
/// Points nearer to a boundary than this tell nothing, mm.
const BAND: f64 = 2e-3;

/// `PROPTEST_CASES` asks for more.
fn cases() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES")
        .ok()
        .and_then(|cases| cases.parse().ok());
    ProptestConfig {
        cases: asked.unwrap_or(1000),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Chords along contours.
#[derive(Default)]
struct Chords(Vec<[Point2; 2]>);

impl Chords {
    fn of<'a>(contours: impl IntoIterator<Item = &'a Contour>) -> Chords {
        let mut chords = Chords::default();
        for segment in contours.into_iter().flat_map(Contour::segments) {
            let mut last = segment.from();
            let count = match *segment {
                Segment::Line { .. } => 1,
                Segment::Arc {
                    from,
                    centre,
                    sweep_deg,
                    ..
                } => {
                    let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
                    let step = (8.0 * SAGITTA / radius.max(SAGITTA)).sqrt();
                    (sweep_deg.abs().to_radians() / step).ceil() as usize + 1
                }
            };
            for k in 1..=count {
                let next = match *segment {
                    Segment::Arc {
                        from,
                        centre,
                        sweep_deg,
                        ..
                    } if k < count => {
                        let (sin, cos) = (sweep_deg * k as f64 / count as f64).to_radians().sin_cos();
                        let [x, y] = [from[0] - centre[0], from[1] - centre[1]];
                        [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos]
                    }
                    _ => segment.to(),
                };
                chords.0.push([last, next]);
                last = next;
            }
        }
        chords
    }

    /// How often they turn around a point.
    fn winding(&self, [x, y]: Point2) -> i32 {
        let turn = |[a, b]: &[Point2; 2]| {
            if (a[1] > y) == (b[1] > y) {
                return 0;
            }
            let crosses_right = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x;
            i32::from(crosses_right) * if b[1] > a[1] { 1 } else { -1 }
        };
        self.0.iter().map(turn).sum()
    }

    fn holds(&self, point: Point2) -> bool {
        self.winding(point) != 0
    }

    fn distance(&self, p: Point2) -> f64 {
        let square = |[a, b]: &[Point2; 2]| {
            let (d, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
            let t = ((v[0] * d[0] + v[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]).max(1e-300)).clamp(0.0, 1.0);
            let beside = [v[0] - t * d[0], v[1] - t * d[1]];
            beside[0] * beside[0] + beside[1] * beside[1]
        };
        self.0.iter().map(square).fold(f64::INFINITY, f64::min).sqrt()
    }
}

/// A corner and how the element after it bulges: the tangent of a quarter of its sweep, 0 for a line.
type Corner = (Point2, f64);

/// Contours of three to eight elements: around a centre, or across themselves. Coordinates lie on a grid,
/// where they touch and coincide, are rounded as in a drawing, or are any.
fn contour() -> impl Strategy<Value = Contour> {
    let bulge = prop_oneof![
        6 => Just(0.0),
        2 => prop::sample::select(vec![-1.0, 1.0, 2f64.sqrt() - 1.0, 1.0 - 2f64.sqrt()]),
        2 => -0.9..0.9,
        1 => -3.0..3.0,
    ];
    let corners = prop::collection::vec(((1.0..6.0f64, -6.0..6.0f64), bulge), 3..8);
    let grid = prop::sample::select(vec![0.0, 0.001, 0.5, 1.0]);
    (
        corners,
        (-3.0..3.0f64, -3.0..3.0f64),
        grid,
        any::<bool>(),
        any::<bool>(),
    )
        .prop_map(|(corners, (x, y), grid, wild, backwards)| {
            let count = corners.len();
            let snap = |v: f64| if grid > 0.0 { (v / grid).round() * grid } else { v };
            let place = |(k, ((a, b), bulge)): (usize, ((f64, f64), f64))| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
                let point = if wild {
                    [2.0 * a - 6.0, b]
                } else {
                    [x + a * cos, y + a * sin]
                };
                (point.map(snap), bulge)
            };
            let corners: Vec<Corner> = corners.into_iter().enumerate().map(place).collect();
            let contour = chain(&corners, grid);
            if backwards { contour.reversed() } else { contour }
        })
}

/// The contour through corners; centres of arcs are as coarse as drawings give them, but for grids.
fn chain(corners: &[Corner], grid: f64) -> Contour {
    let mut contour = Contour::start_at(corners[0].0);
    for (k, (from, bulge)) in corners.iter().enumerate() {
        let to = corners[(k + 1) % corners.len()].0;
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        if bulge.abs() < 1e-3 || dx.hypot(dy) < 1e-3 {
            contour = contour.line_to(to);
            continue;
        }
        let aside = (1.0 / bulge - bulge) / 4.0;
        let centre = [
            0.5 * (from[0] + to[0]) - dy * aside,
            0.5 * (from[1] + to[1]) + dx * aside,
        ];
        let round = |v: f64| {
            if grid == 0.001 {
                (v * 1e4).round() * 1e-4
            } else {
                v
            }
        };
        contour = contour.arc_to(centre.map(round), to, Sense::of_sweep(*bulge));
    }
    contour
}

/// Points across the area in question.
fn points() -> impl Strategy<Value = Vec<Point2>> {
    prop::collection::vec((-12.0..12.0f64, -12.0..12.0f64).prop_map(|(x, y)| [x, y]), 16)
}

/// Points beside the elements of a region, where it counts.
fn beside(region: &Region, by: f64) -> Vec<Point2> {
    let segments = region.contours().iter().flat_map(Contour::segments);
    let at = |segment: &Segment| {
        let ([x, y], [u, v]) = (segment.point(0.37), segment.tangent(0.37));
        [[x - by * v, y + by * u], [x + by * v, y - by * u]]
    };
    segments.flat_map(at).collect()
}

#[derive(Clone, Copy, Debug)]
enum Operation {
    Union,
    Intersection,
    Difference,
}

fn operation() -> impl Strategy<Value = Operation> {
    use Operation::{Difference, Intersection, Union};
    prop::sample::select(vec![Union, Intersection, Difference, Difference])
}

/// The region of the operations one after the other.
fn combined(first: &Contour, more: &[(Contour, Operation)]) -> Region {
    more.iter()
        .fold(Region::from_contour(first), |region, (contour, operation)| {
            let other = Region::from_contour(contour);
            match operation {
                Operation::Union => region.union(&other),
                Operation::Intersection => region.intersection(&other),
                Operation::Difference => region.difference(&other),
            }
        })
}

/// Whether the tool's centre region holds every point that it should, and no other.
fn check(region: &Region, points: &[Point2], expected: impl Fn(Point2) -> Option<bool>) -> TestCaseResult {
    let found = Chords::of(region.contours());
    for point in points.iter().chain(&beside(region, 3.0 * BAND)) {
        if found.distance(*point) > BAND
            && let Some(expected) = expected(*point)
        {
            prop_assert_eq!(found.winding(*point), i32::from(expected), "at {:?}", point);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn boolean_operations_hold_what_their_contours_say(
        first in contour(),
        more in prop::collection::vec((contour(), operation()), 0..4),
        points in points(),
    ) {
        let region = combined(&first, &more);
        let chords = Chords::of([&first]);
        let others: Vec<(Chords, Operation)> =
            more.iter().map(|(contour, operation)| (Chords::of([contour]), *operation)).collect();
        check(&region, &points, |p| {
            let mut gap = chords.distance(p);
            let mut inside = chords.holds(p);
            for (other, operation) in &others {
                gap = gap.min(other.distance(p));
                inside = match operation {
                    Operation::Union => inside || other.holds(p),
                    Operation::Intersection => inside && other.holds(p),
                    Operation::Difference => inside && !other.holds(p),
                };
            }
            (gap > BAND).then_some(inside)
        })?;
    }

    /// A point is in the shrunk region if it is in the region and its elements are all farther away; in the
    /// grown one if it is in the region or an element is nearer.
    #[test]
    fn offsets_hold_what_their_distance_says(
        first in contour(),
        more in prop::collection::vec((contour(), operation()), 0..3),
        by in prop_oneof![-3.0..3.0f64, prop::sample::select(vec![-2.0, -1.0, -0.5, 0.5, 1.0, 2.0])],
        points in points(),
    ) {
        prop_assume!(by.abs() > 0.01);
        let region = combined(&first, &more);
        let chords = Chords::of(region.contours());
        let moved = region.offset(by);
        // Where the offset must begin, beside the elements of the region.
        let near = [by.abs() - 3.0 * BAND, by.abs() + 3.0 * BAND].map(|by| beside(&region, by));
        let points: Vec<Point2> = points.into_iter().chain(near.into_iter().flatten()).collect();
        check(&moved, &points, |p| {
            let (gap, inside) = (chords.distance(p), chords.holds(p));
            let holds = if by > 0.0 { inside || gap < by } else { inside && gap > -by };
            ((gap - by.abs()).abs() > BAND && gap > BAND).then_some(holds)
        })?;
    }

    /// The six cases of the manual [003:5741-5927], and contours that do not cross.
    #[test]
    fn two_subcontours_superimpose_by_their_start_points(
        contours in [contour(), contour()],
        kinds in prop::sample::select(vec![[Kind::Pocket, Kind::Pocket], [Kind::Island, Kind::Pocket]]),
        swapped in any::<bool>(),
        by in 0.05..1.0f64,
        points in points(),
    ) {
        use Kind::{Island, Pocket};
        // Where contours cross themselves, elements inside bound nothing.
        let chords = contours.each_ref().map(|contour| Chords::of(Region::from_contour(contour).contours()));
        let kinds = if swapped { [kinds[1], kinds[0]] } else { kinds };
        let start = |k: usize| contours[k].start();
        // What starts on the other contour is decided by less than is measured here.
        prop_assume!((0..2).all(|k| chords[k].distance(start(1 - k)) > BAND));
        // So is what overlaps or stands out by next to nothing.
        let [a, b] = contours.each_ref().map(Region::from_contour);
        let shares = [a.intersection(&b), a.difference(&b), b.difference(&a)];
        prop_assume!(shares.iter().all(|share| share.is_empty() || share.area() > BAND));
        let starts_inside = |k: usize| chords[1 - k].holds(start(k));
        let crosses = shares.iter().all(|share| !share.is_empty());
        let subcontours: Vec<SubContour> =
            (0..2).map(|k| SubContour { contour: contours[k].clone(), kind: kinds[k] }).collect();
        let areas = superimpose(&subcontours, by, Merge::CentrePaths);
        let in_pocket = |k: usize, p: Point2| chords[k].holds(p) && chords[k].distance(p) > by;
        let in_island = |k: usize, p: Point2| chords[k].holds(p) || chords[k].distance(p) < by;
        let loops: Vec<Contour> = areas.iter().flat_map(|area| area.region.contours().to_vec()).collect();
        let found = Chords::of(&loops);
        let beside = areas.iter().flat_map(|area| beside(&area.region, 3.0 * BAND));
        for p in points.into_iter().chain(beside) {
            if (0..2).any(|k| (chords[k].distance(p) - by).abs() < BAND) || found.distance(p) < BAND {
                continue;
            }
            let machined = match kinds {
                [Pocket, Pocket] if crosses && starts_inside(0) => in_pocket(0, p) && in_pocket(1, p),
                [Pocket, Pocket] => in_pocket(0, p) || in_pocket(1, p),
                // A pocket that starts inside an island reduces it.
                [Pocket, Island] => in_pocket(0, p) && (starts_inside(0) || !in_island(1, p)),
                [Island, Pocket] => in_pocket(1, p) && (starts_inside(1) || !in_island(0, p)),
                [Island, Island] => false,
            };
            prop_assert_eq!(found.winding(p), i32::from(machined), "at {:?}", p);
        }
    }
}
