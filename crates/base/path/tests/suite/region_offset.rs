//! Laws and examples of offsets.

use crate::common::{jittered, region, shape, turned};
use bahn_path::Sense;
use bahn_path::region::{Contour, Location, Region, Segment};
use proptest::prelude::*;
use std::f64::consts::PI;

#[track_caller]
fn assert_near(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 1e-6, "{actual} instead of {expected}");
}

fn area_of(contour: &Contour, distance: f64) -> f64 {
    Region::from_contour(contour).offset(distance).area()
}

/// A convex area A of perimeter P grows by r to A + P r + pi r² (Steiner).
#[test]
fn convex_areas_grow_by_steiners_formula() {
    let slot = Contour::start_at([10.0, 0.0])
        .line_to([30.0, 0.0])
        .arc_to([30.0, 10.0], [30.0, 20.0], Sense::CounterClockwise)
        .line_to([10.0, 20.0])
        .arc_to([10.0, 10.0], [10.0, 0.0], Sense::CounterClockwise);
    let shapes = [
        Contour::rectangle([1.0, 2.0], [31.0, 14.0]),
        Contour::polygon(&[[0.0, 0.0], [40.0, 7.0], [13.0, 29.0]]),
        Contour::circle([3.0, 4.0], 12.5, 77.0, Sense::Clockwise),
        slot,
    ];
    for contour in &shapes {
        for r in [0.001, 0.5, 3.0, 100.0] {
            let expected = contour.area() + contour.length() * r + PI * r * r;
            assert!((area_of(contour, r) / expected - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn inside_corners_intersect_and_outside_corners_get_arcs() {
    // L of 40 x 40 with arms 10 wide. Shrunk by 2: arms 6 wide, the outside corner of the notch keeps an
    // arc of R2, the others are intersections.
    let l = Contour::polygon(&[
        [0.0, 0.0],
        [40.0, 0.0],
        [40.0, 10.0],
        [10.0, 10.0],
        [10.0, 40.0],
        [0.0, 40.0],
    ]);
    let shrunk = Region::from_contour(&l).offset(-2.0);
    assert_eq!(shrunk.contours().len(), 1);
    let radii: Vec<f64> = shrunk.contours()[0]
        .segments()
        .iter()
        .filter_map(Segment::radius)
        .collect();
    assert_eq!(radii.len(), 1);
    assert_near(radii[0], 2.0);
    // 2..38 x 2..8 and 2..8 x 8..38, and at the notch a square of 2 x 2 without a quarter disc.
    assert_near(shrunk.area(), 36.0 * 6.0 + 6.0 * 30.0 + (4.0 - PI));
}

#[test]
fn shrinking_splits_and_vanishes() {
    // Two plates of 20 x 20, joined by a bridge 4 wide.
    let bone = Contour::polygon(&[
        [0.0, 0.0],
        [20.0, 0.0],
        [20.0, 8.0],
        [30.0, 8.0],
        [30.0, 0.0],
        [50.0, 0.0],
        [50.0, 20.0],
        [30.0, 20.0],
        [30.0, 12.0],
        [20.0, 12.0],
        [20.0, 20.0],
        [0.0, 20.0],
    ]);
    let region = Region::from_contour(&bone);
    assert_eq!(region.offset(-1.9).contours().len(), 1);
    // At 2 the bridge is a line without area; at more it is gone.
    for r in [2.0, 2.1] {
        let plates = region.offset(-r);
        assert_eq!(plates.parts().count(), 2, "shrunk by {r}");
    }
    // Two squares of 16 x 16, and towards the bridge what two arcs R2 leave of 2 x 4: 8 - 2 pi each.
    assert_near(region.offset(-2.0).area(), 2.0 * (256.0 + 8.0 - 2.0 * PI));
    assert!(region.offset(-10.0).is_empty());
    assert!(region.offset(-1000.0).is_empty());
}

#[test]
fn arcs_stay_arcs_down_to_their_centre_and_beyond() {
    let disc = Contour::circle([5.0, 5.0], 10.0, 30.0, Sense::CounterClockwise);
    assert_near(area_of(&disc, -4.0), PI * 36.0);
    assert_eq!(area_of(&disc, -10.0), 0.0);
    let circle = &Region::from_contour(&disc).offset(-4.0).contours()[0].clone();
    assert_eq!(circle.segments().len(), 1, "a full circle is one segment");
    // A plate with corners R3, shrunk by 5: the corners are sharp.
    let plate = Region::from_contour(&Contour::rectangle([3.0, 3.0], [37.0, 27.0])).offset(3.0);
    assert_near(plate.area(), 40.0 * 30.0 - (4.0 - PI) * 9.0);
    let shrunk = plate.offset(-5.0);
    assert_near(shrunk.area(), 30.0 * 20.0);
    assert_eq!(shrunk.contours()[0].segments().len(), 4);
}

#[test]
fn holes_grow_when_the_region_shrinks() {
    let ring =
        Region::from_contour(&Contour::circle([0.0, 0.0], 20.0, 0.0, Sense::CounterClockwise)).difference(
            &Region::from_contour(&Contour::circle([0.0, 0.0], 8.0, 0.0, Sense::CounterClockwise)),
        );
    assert_near(ring.offset(-5.0).area(), PI * (225.0 - 169.0));
    assert_near(ring.offset(5.0).area(), PI * (625.0 - 9.0));
    // A hole smaller than the radius closes, also if its centre is far from everything.
    assert_near(ring.offset(9.0).area(), PI * 841.0);
    assert!(ring.offset(-6.0).is_empty());
}

/// In a corner of 90 degrees a tool of radius r leaves r² (1 - pi/4).
#[test]
fn opening_leaves_the_corners() {
    let rectangle = Region::from_contour(&Contour::rectangle([0.0, 0.0], [60.0, 40.0]));
    let reached = rectangle.opening(5.0);
    assert_near(reached.area(), 2400.0 - 4.0 * 25.0 * (1.0 - PI / 4.0));
    assert_near(
        rectangle.difference(&reached).area(),
        4.0 * 25.0 * (1.0 - PI / 4.0),
    );
    assert_near(reached.difference(&rectangle).area(), 0.0);
    // An area without corners is reached whole.
    let disc = Region::from_contour(&Contour::circle([0.0, 0.0], 10.0, 0.0, Sense::CounterClockwise));
    assert_near(disc.opening(9.0).area(), PI * 100.0);
}

/// Lines and arcs of a boundary in a corner angle of 2a: remnant r² (cot a - (pi/2 - a)).
#[test]
fn opening_of_a_triangle() {
    let triangle = Region::from_contour(&Contour::polygon(&[[0.0, 0.0], [40.0, 0.0], [0.0, 30.0]]));
    let angles = [90f64.to_radians(), 30f64.atan2(40.0), 40f64.atan2(30.0)];
    let remnant: f64 = angles
        .iter()
        .map(|angle| 4.0 * (1.0 / (angle / 2.0).tan() - (PI - angle) / 2.0))
        .sum();
    assert_near(triangle.opening(2.0).area(), 600.0 - remnant);
}

/// A contour as a program gives it: rounded, so that an arc ends beside the circle of its start.
fn rounded(contour: &Contour, digits: i32) -> Contour {
    let unit = 0.1f64.powi(digits);
    let round = |p: [f64; 2]| p.map(|v| (v / unit).round() * unit);
    let segments = contour.segments().iter().map(|segment| match *segment {
        Segment::Line { from, to } => Segment::line(round(from), round(to)),
        Segment::Arc {
            from,
            to,
            centre,
            sweep_deg,
        } => {
            let (from, to, centre) = (round(from), round(to), round(centre));
            Segment::Arc {
                from,
                to,
                centre,
                sweep_deg: bahn_path::sweep_deg(centre, from, to, Sense::of_sweep(sweep_deg)),
            }
        }
    });
    Contour::from_segments(segments).unwrap_or_else(|| contour.clone())
}

/// A hundred half circles about a ring, rounded to as much as MP7431 lets pass: their areas differ from the exact
/// ones by no more than the rounding all along them.
#[test]
fn arcs_of_rounded_coordinates_are_moved() {
    let joint = |k: i32| {
        let (sin, cos) = (2.0 * PI * f64::from(k % 100) / 100.0).sin_cos();
        [300.0 * cos, 300.0 * sin]
    };
    let exact = (0..100).fold(Contour::start_at(joint(0)), |contour, k| {
        let (from, to) = (joint(k), joint(k + 1));
        contour.arc_to(
            [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])],
            to,
            Sense::CounterClockwise,
        )
    });
    for (digits, error) in [(2, 1.5e-2), (3, 1.5e-3), (4, 1.5e-4)] {
        let rounded = rounded(&exact, digits);
        for by in [-3.0, -20.0, 3.0, 20.0] {
            let (found, expected) = (area_of(&rounded, by), area_of(&exact, by));
            let allowed = error * exact.length();
            assert!(
                (found - expected).abs() < allowed,
                "{by}: {found} instead of {expected}"
            );
        }
    }
}

/// Nearly a full circle whose end is 5 micrometres too far out: no centre fits both ends, but the circle stays
/// where it is.
#[test]
fn a_full_circle_that_does_not_quite_close_stays_where_it_is() {
    let circle = Segment::Arc {
        from: [10.0, 0.0],
        to: [10.005, -0.001],
        centre: [0.0, 0.0],
        sweep_deg: 360.0 - (0.001f64 / 10.005).atan().to_degrees(),
    };
    let contour = Contour::from_segments([circle]).map(Contour::closed).unwrap();
    for (by, radius) in [(-3.0, 7.0), (0.0, 10.0), (3.0, 13.0)] {
        let area = area_of(&contour, by);
        assert!((area - PI * radius * radius).abs() < 0.01, "{by}: {area}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    /// The boundary keeps the distance to the original everywhere, and encloses what it should.
    #[test]
    fn offset_keeps_its_distance(
        a in region(),
        d in prop::sample::select(vec![0.25, 0.5, 1.0, 1.5, 2.0]),
        shrink in any::<bool>(),
        (x, y) in (-4.0..17.0, -4.0..17.0),
    ) {
        let moved = a.offset(if shrink { -d } else { d });
        for segment in moved.contours().iter().flat_map(Contour::segments) {
            for t in [0.0, 0.1, 0.37, 0.5, 0.81] {
                let gap = a.boundary_distance(segment.point(t));
                prop_assert!((gap - d).abs() < 2e-6, "{gap} instead of {d}");
            }
        }
        let p = [x, y];
        let gap = a.boundary_distance(p);
        prop_assume!((gap - d).abs() > 1e-4);
        let expected = match (a.contains(p), shrink) {
            (true, true) => gap > d,
            (true, false) => true,
            (false, true) => false,
            (false, false) => gap < d,
        };
        prop_assert_eq!(moved.locate(p) == Location::Inside, expected);
    }

    /// The same with coordinates that rounding or measuring noise touches everywhere.
    #[test]
    fn offset_keeps_its_distance_off_the_grid(
        contours in prop::collection::vec(shape(), 2),
        noise in prop::sample::select(vec![0.0, 1e-9, 1e-7, 1e-5, 1e-3]),
        (angle, seed) in (-180.0..180.0, any::<u64>()),
        d in prop::sample::select(vec![-1.5, -1.0, -0.5, 0.5, 1.0, 2.0]),
    ) {
        let place = |c: &Contour| Region::from_contour(&turned(&jittered(c, noise, seed), angle, 0.0));
        let a = place(&contours[0]).difference(&place(&contours[1]));
        for segment in a.offset(d).contours().iter().flat_map(Contour::segments) {
            for t in [0.0, 0.1, 0.37, 0.5, 0.81] {
                let gap = a.boundary_distance(segment.point(t));
                // Where features are as far apart as the resolution, a tolerance of up to 1e-4 may be used.
                prop_assert!((gap - d.abs()).abs() < 3e-4, "{gap} instead of {d}");
            }
        }
    }

    #[test]
    fn growing_twice_is_growing_once(a in region(), d in 0.2..2.0, e in 0.2..2.0) {
        let once = a.offset(d + e).area();
        prop_assert!((a.offset(d).offset(e).area() - once).abs() < 1e-4 * once.max(1.0));
    }
}
