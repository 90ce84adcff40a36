//! Laws and examples of boolean operations on regions.

use crate::common::{jittered, region, shape, turned};
use bahn_path::Sense;
use bahn_path::region::{Contour, Location, Merge, Region, Segment, SubContour, superimpose};
use proptest::prelude::*;
use std::f64::consts::PI;

#[track_caller]
fn assert_near(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 1e-6, "{actual} instead of {expected}");
}

fn disc(x: f64, y: f64, r: f64) -> Region {
    Region::from_contour(&Contour::circle([x, y], r, 0.0, Sense::CounterClockwise))
}

fn rectangle(min: [f64; 2], max: [f64; 2]) -> Region {
    Region::from_contour(&Contour::rectangle(min, max))
}

#[test]
fn tangent_circles() {
    // From outside: one point in common.
    let (a, b) = (disc(0.0, 0.0, 10.0), disc(15.0, 0.0, 5.0));
    assert_near(a.union(&b).area(), PI * 125.0);
    assert_eq!(
        a.union(&b).parts().count(),
        2,
        "areas that touch in a point are apart"
    );
    assert!(a.intersection(&b).is_empty());
    assert_near(a.difference(&b).area(), PI * 100.0);
    // From inside.
    let c = disc(4.0, 3.0, 5.0);
    assert_near(a.union(&c).area(), PI * 100.0);
    assert_near(a.intersection(&c).area(), PI * 25.0);
    let crescent = a.difference(&c);
    assert_near(crescent.area(), PI * 75.0);
    // The tips of the crescent meet in one point; shrunk, they are cut off.
    assert!(crescent.offset(-0.5).area() < PI * 75.0 - 20.0);
}

#[test]
fn touching_rectangles_grow_together() {
    let (a, b) = (
        rectangle([0.0, 0.0], [10.0, 10.0]),
        rectangle([10.0, 0.0], [20.0, 10.0]),
    );
    let both = a.union(&b);
    assert_near(both.area(), 200.0);
    assert_eq!(both.contours().len(), 1);
    assert_eq!(
        both.contours()[0].segments().len(),
        4,
        "lines that continue each other become one"
    );
    // In a corner they stay apart.
    let c = rectangle([10.0, 10.0], [20.0, 20.0]);
    assert_eq!(a.union(&c).parts().count(), 2);
}

#[test]
fn identical_and_contained() {
    let (a, b) = (disc(3.0, 4.0, 10.0), disc(3.0, 4.0, 6.0));
    assert_near(a.union(&a).area(), PI * 100.0);
    assert_near(a.intersection(&a).area(), PI * 100.0);
    assert!(a.difference(&a).is_empty());
    assert_near(a.union(&b).area(), PI * 100.0);
    assert!(b.difference(&a).is_empty());
    let ring = a.difference(&b);
    assert_eq!(ring.contours().len(), 2);
    assert_near(ring.union(&b).area(), PI * 100.0);
    assert_eq!(ring.union(&b).contours().len(), 1);
    let island = disc(3.0, 4.0, 2.0);
    let target = ring.union(&island);
    assert_eq!(target.parts().count(), 2);
    assert_near(target.area(), PI * (64.0 + 4.0));
}

#[test]
fn arcs_are_kept() {
    let cut = rectangle([0.0, 0.0], [40.0, 40.0]).difference(&disc(40.0, 40.0, 15.0));
    let arcs: Vec<Segment> = cut.contours()[0]
        .segments()
        .iter()
        .copied()
        .filter(|s| s.radius().is_some())
        .collect();
    let [
        Segment::Arc {
            centre, sweep_deg, ..
        },
    ] = arcs[..]
    else {
        panic!("{arcs:?}")
    };
    assert_near(centre[0], 40.0);
    assert_near(centre[1], 40.0);
    assert_near(sweep_deg, -90.0);
    assert_near(arcs[0].radius().unwrap_or_default(), 15.0);
}

#[test]
fn contour_that_crosses_itself_counts_all_it_goes_around() {
    // A bow tie of two triangles of 10 x 10 / 4 each, wound in opposite senses.
    let bow = Contour::polygon(&[[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]]);
    assert_near(Region::from_contour(&bow).area(), 50.0);
    // A pentagram of circumradius 10: its outline including the middle.
    let corner = |k: i32| {
        let angle = f64::from(144 * k + 90).to_radians();
        [10.0 * angle.cos(), 10.0 * angle.sin()]
    };
    let star = Contour::polygon(&[corner(0), corner(1), corner(2), corner(3), corner(4)]);
    // Ten triangles with the angle 36 degrees at the centre between radii 10 and 10 cos 72 / cos 36.
    let inner = 10.0 * 72f64.to_radians().cos() / 36f64.to_radians().cos();
    assert_near(
        Region::from_contour(&star).area(),
        10.0 * 0.5 * 10.0 * inner * 36f64.to_radians().sin(),
    );
}

#[test]
fn contour_facts() {
    let circle = Contour::circle([10.0, 0.0], 5.0, 90.0, Sense::Clockwise);
    assert!(circle.is_closed() && !circle.is_counter_clockwise());
    assert_near(circle.area(), PI * 25.0);
    assert_near(circle.length(), PI * 10.0);
    let (min, max) = circle.bounding_box();
    assert_near(min[0], 5.0);
    assert_near(max[1], 5.0);
    assert!(
        circle.start_tangent()[0] > 0.999,
        "clockwise from the top it runs in +X"
    );
    let turned = circle.starting_near([20.0, 0.0]);
    assert_near(turned.start()[0], 15.0);
    assert_eq!(turned.segments().len(), 1);
    assert_near(turned.signed_area(), circle.signed_area());
    assert_eq!(circle.locate([15.0, 0.0]), Location::Boundary);
    assert_eq!(circle.locate([14.9, 0.0]), Location::Inside);
    let square = Contour::rectangle([0.0, 0.0], [10.0, 10.0]);
    let from_side = square.starting_near([5.0, -3.0]);
    assert_eq!(from_side.start(), [5.0, 0.0]);
    assert_eq!(from_side.segments().len(), 5);
    assert_near(from_side.reversed().signed_area(), -100.0);
    assert_eq!(from_side.reversed().start(), [5.0, 0.0]);
    let open = Contour::start_at([0.0, 0.0])
        .line_to([10.0, 0.0])
        .line_to([10.0, 10.0]);
    assert!(!open.is_closed());
    assert_near(Region::from_contour(&open).area(), 50.0);
}

#[test]
fn degenerate_input_holds_no_area() {
    let nothing = [
        Contour::start_at([1.0, 1.0]),
        Contour::polygon(&[]),
        Contour::polygon(&[[0.0, 0.0], [10.0, 0.0]]),
        Contour::polygon(&[[0.0, 0.0], [10.0, 0.0], [5.0, 0.0]]),
        Contour::circle([0.0, 0.0], 0.0, 0.0, Sense::CounterClockwise),
        Contour::polygon(&[[f64::NAN, 0.0], [10.0, f64::INFINITY], [5.0, f64::NAN]]),
    ];
    for contour in &nothing {
        let region = Region::from_contour(contour);
        assert!(region.is_empty(), "{contour:?}");
        assert!(region.offset(-1.0).is_empty());
        assert!(region.union(&region).is_empty());
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-4
}

/// A point on the chord of an arc, from where the ray that counts runs along the chord: it is inside or not as
/// the arc bulges, whichever way the contour goes.
#[test]
fn points_on_chords_are_where_the_arc_leaves_them() {
    for (up, inside) in [(true, Location::Inside), (false, Location::Outside)] {
        // From (-1, 0) over (0, +-1) to (1, 0), and around by (1, -4) and (-1, -4).
        let contour = Contour::start_at([-1.0, 0.0])
            .arc_to(
                [0.0, 0.0],
                [1.0, 0.0],
                if up {
                    Sense::Clockwise
                } else {
                    Sense::CounterClockwise
                },
            )
            .line_to([1.0, -4.0])
            .line_to([-1.0, -4.0])
            .line_to([-1.0, 0.0]);
        for contour in [contour.reversed(), contour] {
            for x in [-0.75, 0.0, 0.25] {
                assert_eq!(contour.locate([x, 0.0]), inside, "{x} {up}");
                assert_eq!(Region::from_contour(&contour).locate([x, 0.0]), inside);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn areas_add_up(a in region(), b in region()) {
        let (union, both) = (a.union(&b), a.intersection(&b));
        prop_assert!(near(union.area() + both.area(), a.area() + b.area()));
        prop_assert!(near(a.difference(&b).area(), a.area() - both.area()));
        prop_assert!(near(b.difference(&a).area(), b.area() - both.area()));
    }

    #[test]
    fn chained_operations_keep_the_laws(a in region(), b in region(), c in shape()) {
        let c = Region::from_contour(&c);
        let cut = a.union(&b).difference(&c);
        prop_assert!(near(cut.intersection(&c).area(), 0.0));
        prop_assert!(near(cut.difference(&c).area(), cut.area()));
        prop_assert!(near(cut.union(&c).area(), cut.area() + c.area()));
        prop_assert!(near(cut.difference(&cut).area(), 0.0));
        prop_assert!(near(cut.union(&cut).area(), cut.area()));
        prop_assert!(near(a.difference(&c).union(&b.difference(&c)).area(), cut.area()));
    }

    #[test]
    fn contains_agrees(a in region(), b in region(), (x, y) in (-4.0..17.0, -4.0..17.0)) {
        let p = [x, y];
        prop_assume!(a.boundary_distance(p) > 1e-3 && b.boundary_distance(p) > 1e-3);
        prop_assert_eq!(a.union(&b).contains(p), a.contains(p) || b.contains(p));
        prop_assert_eq!(a.intersection(&b).contains(p), a.contains(p) && b.contains(p));
        prop_assert_eq!(a.difference(&b).contains(p), a.contains(p) && !b.contains(p));
    }

    /// The laws hold where nothing coincides exactly but much does nearly.
    #[test]
    fn areas_add_up_off_the_grid(
        contours in prop::collection::vec(shape(), 4),
        noise in prop::sample::select(vec![0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4]),
        shift in prop::sample::select(vec![0.0, 123.4567, 10_000.0]),
        (angle, seed) in (-180.0..180.0, any::<u64>()),
    ) {
        let mut place = (0u64..).zip(&contours).map(|(k, c)| {
            Region::from_contour(&turned(&jittered(c, noise, seed.wrapping_add(k)), angle, shift))
        });
        let mut next = || place.next().unwrap_or_default();
        let (a, b) = (next().union(&next()), next().difference(&next()));
        let tolerance = 1e-3 + 100.0 * noise;
        let (union, both) = (a.union(&b), a.intersection(&b));
        prop_assert!((union.area() + both.area() - a.area() - b.area()).abs() < tolerance);
        prop_assert!((a.difference(&b).area() + both.area() - a.area()).abs() < tolerance);
        prop_assert!((union.intersection(&b).area() - b.area()).abs() < tolerance);
        prop_assert!(both.difference(&a).area() < tolerance);
    }

    /// Every arc of a result lies on a circle of the input.
    #[test]
    fn no_arc_is_invented(contours in prop::collection::vec(shape(), 3)) {
        let regions: Vec<Region> = contours.iter().map(Region::from_contour).collect();
        let result = regions[0].union(&regions[1]).difference(&regions[2]);
        for segment in result.contours().iter().flat_map(Contour::segments) {
            let Segment::Arc { centre, .. } = *segment else { continue };
            let radius = segment.radius().unwrap_or_default();
            let known = contours.iter().flat_map(Contour::segments).any(|s| match *s {
                Segment::Arc { centre: c, .. } => {
                    (c[0] - centre[0]).hypot(c[1] - centre[1]) < 1e-6
                        && (s.radius().unwrap_or_default() - radius).abs() < 1e-5
                }
                Segment::Line { .. } => false,
            });
            prop_assert!(known, "{segment:?}");
        }
    }

    #[test]
    fn same_input_gives_the_same_bits(a in region(), b in region()) {
        prop_assert_eq!(a.union(&b), a.union(&b));
        prop_assert_eq!(a.difference(&b).offset(-0.5), a.difference(&b).offset(-0.5));
    }

    /// Any numbers at all: an answer, no panic, no hang.
    #[test]
    fn any_numbers_are_survived(
        points in prop::collection::vec((any::<f64>(), any::<f64>(), any::<bool>()), 0..8),
        small in prop::collection::vec((-5.0..5.0, -5.0..5.0, any::<bool>()), 0..8),
        distance in prop_oneof![any::<f64>(), -3.0..3.0],
    ) {
        let chain = |points: &[(f64, f64, bool)]| {
            points.iter().fold(Contour::start_at([0.0, 0.0]), |c, (x, y, line)| {
                if *line { c.line_to([*x, *y]) } else { c.arc_to([y * 0.5, *x], [*x, *y], Sense::of_sweep(x - y)) }
            })
        };
        let list: Vec<SubContour> =
            [chain(&points), chain(&small)].into_iter().map(|c| SubContour::programmed(c, true)).collect();
        for merge in [Merge::CentrePaths, Merge::ProgrammedContours] {
            for area in superimpose(&list, distance, merge) {
                prop_assert!(!area.outlines.is_empty());
                let _ = area.region.hatch(distance, 1.0, bahn_path::region::HatchPattern::Zigzag).len();
            }
        }
    }
}

/// A vertex exactly at the height of a point, reached with different rounding from both sides.
#[test]
fn chains_are_closed_to_the_last_bit() {
    let slot = Contour::start_at([3.0, -2.0])
        .line_to([4.0, -2.0])
        .arc_to([4.0, 0.0], [4.0, 2.0], Sense::CounterClockwise)
        .line_to([3.0, 2.0])
        .arc_to([3.0, 0.0], [3.0, -2.0], Sense::CounterClockwise);
    let area = Region::from_contour(&slot)
        .union(&disc(0.0, 3.0, 3.0))
        .offset(-0.5);
    for contour in area.contours() {
        let next = contour.segments().iter().cycle().skip(1);
        for (segment, next) in contour.segments().iter().zip(next) {
            assert_eq!(segment.to(), next.from());
        }
    }
    assert_eq!(area.locate([0.0, 1.5]), Location::Inside);
}

/// Two arcs that end in a corner just after where they cross: between crossing and corner lies a lens, which
/// the contour goes around twice. However thin, it is inside, and no boundary of its own.
#[test]
fn arcs_that_cross_just_before_their_corner_leave_no_loop_in_the_lens() {
    const R: f64 = 1.0;
    // The square 6 x 6 below a notch between two discs; its tip is where the arcs cross.
    let below = |contour: Contour, top: f64| {
        let corners = [[-3.0, top], [-3.0, top - 6.0], [3.0, top - 6.0], [3.0, top]];
        corners.into_iter().fold(contour, Contour::line_to).closed()
    };
    for thickness in (1..=200).map(|k| f64::from(k) * 1e-7) {
        // The discs overlap by the thickness, and on the common chord the arcs turn by twice phi.
        let aside = R - 0.5 * thickness;
        let half_chord = (R * R - aside * aside).sqrt();
        let phi = half_chord.atan2(aside);
        let lens = R * R * (2.0 * phi - (2.0 * phi).sin());
        let (right, left) = ([aside, half_chord], [-aside, half_chord]);
        let top = half_chord + R;
        let through = |tip: [f64; 2]| {
            let arc = Contour::start_at([aside, top]).arc_to(right, tip, Sense::CounterClockwise);
            below(arc.arc_to(left, [-aside, top], Sense::CounterClockwise), top)
        };
        let (to_crossing, to_corner) = (through([0.0, 2.0 * half_chord]), through([0.0, 0.0]));
        // What the tool's centre may sweep is that of the contour without the lens.
        let shrunk = Region::from_contour(&to_crossing).offset(-0.05);
        assert!(shrunk.area() > 25.0);
        for contour in [to_corner.reversed(), to_corner] {
            let region = Region::from_contour(&contour);
            assert_eq!(region.contours().len(), 1, "lens of {thickness} mm");
            assert_near(region.area(), contour.area() - lens);
            assert_near(region.offset(-0.05).area(), shrunk.area());
        }
    }
}
