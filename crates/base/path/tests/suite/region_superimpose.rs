//! SL contours in the manual's sense: the six cases of overlapping contours and programs with several.

use bahn_path::region::{
    Contour, Kind, Location, Merge, PocketArea, Region, Segment, SubContour, Superposition, Unlimited,
    superimpose,
};
use bahn_path::{Point2, Sense};
use std::f64::consts::PI;

const BOTH: [Merge; 2] = [Merge::CentrePaths, Merge::ProgrammedContours];

/// Circles R25 about (35, 50) and (65, 50) are 30 mm apart.
const R: f64 = 25.0;
const D: f64 = 30.0;

/// Area common to two circles of equal radius: `2 r² acos(d / 2r) - d/2 sqrt(4 r² - d²)`.
fn lens(r: f64, d: f64) -> f64 {
    2.0 * r * r * (d / (2.0 * r)).acos() - 0.5 * d * (4.0 * r * r - d * d).sqrt()
}

fn circle(centre_x: f64, start_x: f64, tool_left: bool) -> SubContour {
    let start = [start_x, 50.0];
    SubContour::programmed(
        Contour::start_at(start).arc_to([centre_x, 50.0], start, Sense::CounterClockwise),
        tool_left,
    )
}

fn pocket_5_to_95() -> SubContour {
    SubContour::programmed(Contour::rectangle([5.0, 5.0], [95.0, 95.0]), true)
}

fn total(areas: &[PocketArea]) -> f64 {
    areas.iter().map(|area| area.region.area()).sum()
}

fn programmed(list: &[SubContour]) -> f64 {
    let by_mode = BOTH.map(|merge| total(&superimpose(list, 0.0, merge)));
    assert!(
        (by_mode[0] - by_mode[1]).abs() < 1e-9,
        "without a radius both orders are the same"
    );
    by_mode[0]
}

#[track_caller]
fn assert_near(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 1e-6, "{actual} instead of {expected}");
}

#[track_caller]
fn assert_at(actual: Point2, expected: Point2) {
    let gap = (actual[0] - expected[0]).hypot(actual[1] - expected[1]);
    assert!(gap < 1e-6, "{actual:?} instead of {expected:?}");
}

/// Infeed points of all outlines in their order.
fn infeeds(areas: &[PocketArea]) -> Vec<Point2> {
    areas
        .iter()
        .flat_map(|area| &area.outlines)
        .map(|outline| outline.infeed())
        .collect()
}

// Overlapping pockets [003:5741-5794].

#[test]
fn pocket_that_starts_outside_a_pocket_unites() {
    let list = [circle(35.0, 10.0, true), circle(65.0, 90.0, true)];
    assert_near(programmed(&list), 2.0 * PI * R * R - lens(R, D));
    for merge in BOTH {
        let areas = superimpose(&list, 3.0, merge);
        assert_eq!(areas.len(), 1);
        assert_eq!(areas[0].outlines.len(), 1);
        assert_eq!(areas[0].outlines[0].members, [0, 1]);
        assert_at(areas[0].outlines[0].infeed(), [13.0, 50.0]);
    }
    // Compensated first: circles R22, 30 apart.
    assert_near(
        total(&superimpose(&list, 3.0, Merge::CentrePaths)),
        2.0 * PI * 484.0 - lens(22.0, D),
    );
}

#[test]
fn pocket_that_starts_outside_an_island_loses_it() {
    let list = [circle(35.0, 10.0, true), circle(65.0, 90.0, false)];
    assert_near(programmed(&list), PI * R * R - lens(R, D));
    for merge in BOTH {
        let areas = superimpose(&list, 3.0, merge);
        assert_eq!(infeeds(&areas).len(), 1);
        assert_at(infeeds(&areas)[0], [13.0, 50.0]);
        // The crescent between R22 about (35, 50) and R28 about (65, 50): the inside corners at the
        // tips belong to the tool radius in both orders.
        let area = PI * 484.0 - unequal_lens(22.0, 28.0, D);
        assert_near(areas[0].region.area(), area);
    }
}

/// Area common to circles r and s, d apart: two circular segments on the common chord.
fn unequal_lens(r: f64, s: f64, d: f64) -> f64 {
    let a = (d * d + r * r - s * s) / (2.0 * d);
    let b = d - a;
    let segment = |r: f64, a: f64| r * r * (a / r).acos() - a * (r * r - a * a).sqrt();
    segment(r, a) + segment(s, b)
}

#[test]
fn pocket_that_starts_inside_a_pocket_intersects() {
    let list = [circle(35.0, 60.0, true), circle(65.0, 90.0, true)];
    assert_near(programmed(&list), lens(R, D));
    for merge in BOTH {
        let areas = superimpose(&list, 3.0, merge);
        // A lens of circles R22.
        assert_near(total(&areas), lens(22.0, D));
        assert_at(infeeds(&areas)[0], [57.0, 50.0]);
    }
    // Figures of the manual's example as they are known: 3367.9, 1404.4 and 559.1 mm².
    assert!((lens(R, D) - 559.1).abs() < 0.05);
    assert!((2.0 * PI * R * R - lens(R, D) - 3367.9).abs() < 0.05);
    assert!((PI * R * R - lens(R, D) - 1404.4).abs() < 0.05);
}

// Overlapping islands in an enclosing pocket, label order 2/3/1 [003:5811-5927].

#[test]
fn island_that_starts_outside_an_island_unites() {
    let list = [
        circle(35.0, 10.0, false),
        circle(65.0, 90.0, false),
        pocket_5_to_95(),
    ];
    assert_near(programmed(&list), 8100.0 - (2.0 * PI * R * R - lens(R, D)));
    // Tool R2.5: the islands reach to X7.5, where the tool's path around the pocket also is. The circles
    // R27.5 touch the square 7.5..92.5 in one point each.
    for merge in BOTH {
        let areas = superimpose(&list, 2.5, merge);
        let first = &areas[0].outlines[0];
        assert_eq!(first.leader, 0);
        assert_at(first.infeed(), [7.5, 50.0]);
    }
}

#[test]
fn island_is_reduced_by_a_pocket_that_starts_inside() {
    let list = [
        circle(35.0, 10.0, false),
        circle(65.0, 40.0, true),
        pocket_5_to_95(),
    ];
    assert_near(programmed(&list), 8100.0 - (PI * R * R - lens(R, D)));
    let areas = superimpose(&list, 2.5, Merge::ProgrammedContours);
    assert_at(areas[0].outlines[0].infeed(), [7.5, 50.0]);
}

#[test]
fn island_that_starts_inside_an_island_intersects() {
    let list = [
        circle(35.0, 60.0, false),
        circle(65.0, 90.0, false),
        pocket_5_to_95(),
    ];
    assert_near(programmed(&list), 8100.0 - lens(R, D));
    for merge in BOTH {
        let areas = superimpose(&list, 2.5, merge);
        assert_eq!(areas.len(), 1);
        let leaders: Vec<usize> = areas[0].outlines.iter().map(|o| o.leader).collect();
        assert_eq!(leaders, [0, 2], "the island comes first in the list");
        assert_at(areas[0].outlines[0].infeed(), [62.5, 50.0]);
        assert_at(areas[0].outlines[1].infeed(), [7.5, 7.5]);
    }
}

/// Island X15..70 Y20..60 with corners R12 in a pocket of 110 x 110, label order 2/1 [003:5563-5597].
#[test]
fn island_in_an_auxiliary_pocket() {
    let island = Contour::start_at([40.0, 60.0])
        .line_to([27.0, 60.0])
        .arc_to([27.0, 48.0], [15.0, 48.0], Sense::CounterClockwise)
        .line_to([15.0, 32.0])
        .arc_to([27.0, 32.0], [27.0, 20.0], Sense::CounterClockwise)
        .line_to([58.0, 20.0])
        .arc_to([58.0, 32.0], [70.0, 32.0], Sense::CounterClockwise)
        .line_to([70.0, 48.0])
        .arc_to([58.0, 48.0], [58.0, 60.0], Sense::CounterClockwise)
        .line_to([40.0, 60.0]);
    let list = [
        SubContour::programmed(Contour::rectangle([-5.0, -5.0], [105.0, 105.0]), true),
        SubContour::programmed(island, false),
    ];
    let island_area = 55.0 * 40.0 - (4.0 - PI) * 144.0;
    assert!((island_area - 2076.4).abs() < 0.05);
    assert_near(programmed(&list), 110.0 * 110.0 - island_area);
    for merge in BOTH {
        let areas = superimpose(&list, 5.0, merge);
        // Grown by 5: 65 x 50 with corners R17.
        assert_near(total(&areas), 10_000.0 - (65.0 * 50.0 - (4.0 - PI) * 289.0));
        assert_at(infeeds(&areas)[0], [0.0, 0.0]);
        assert_at(infeeds(&areas)[1], [40.0, 65.0]);
        let hole = &areas[0].region.contours()[1];
        let radii: Vec<f64> = hole.segments().iter().filter_map(|s| s.radius()).collect();
        assert_eq!(radii.len(), 4);
        radii.into_iter().for_each(|r| assert_near(r, 17.0));
    }
}

fn four_contours() -> [SubContour; 4] {
    let square = [[27.0, 42.0], [27.0, 58.0], [43.0, 58.0], [43.0, 42.0]];
    let triangle = [[57.0, 42.0], [73.0, 42.0], [65.0, 58.0]];
    [
        circle(35.0, 10.0, true),
        circle(65.0, 90.0, true),
        SubContour::programmed(Contour::polygon(&square), true), // clockwise with RL: an island
        SubContour::programmed(Contour::polygon(&triangle), false),
    ]
}

/// Two pockets with a square and a triangular island [003:5944-5983].
#[test]
fn overlapping_pockets_with_islands() {
    let list = four_contours();
    let area = 2.0 * PI * R * R - lens(R, D) - 16.0 * 16.0 - 0.5 * 16.0 * 16.0;
    assert!((area - 2983.9).abs() < 0.05);
    assert_near(programmed(&list), area);
    // Tool R3 and allowance 2.
    for merge in BOTH {
        let areas = superimpose(&list, 5.0, merge);
        assert_eq!(areas.len(), 1);
        let leaders: Vec<usize> = areas[0].outlines.iter().map(|o| o.leader).collect();
        assert_eq!(leaders, [0, 2, 3]);
        let points = infeeds(&areas);
        assert_at(points[0], [15.0, 50.0]);
        assert_at(points[1], [22.0, 42.0]);
        assert_at(points[2], [57.0, 37.0]);
        for outline in &areas[0].outlines {
            let island = outline.leader >= 2;
            assert_eq!(outline.contour.is_counter_clockwise(), !island);
        }
    }
}

/// Pilot drilling with R2.2 + 2.8 and roughing with R3 + 2 have the same infeed points [003:6010-6012].
#[test]
fn infeed_points_depend_on_the_sum_of_radius_and_allowance() {
    let at = |distance: f64| infeeds(&superimpose(&four_contours(), distance, Merge::CentrePaths));
    assert_eq!(at(2.2 + 2.8).len(), 3);
    for (drill, rough) in at(2.2 + 2.8).into_iter().zip(at(3.0 + 2.0)) {
        assert_at(drill, rough);
    }
}

/// Bit 2 of MP7420: a narrow overlap that the tool centre does not pass [000:6720-6747].
#[test]
fn narrow_overlap_merges_by_mode() {
    // Circles R25, 46 apart, tool R5: the centre paths R20 do not meet.
    let list = [circle(35.0, 10.0, true), circle(81.0, 106.0, true)];
    let separate = superimpose(&list, 5.0, Merge::CentrePaths);
    assert_eq!(separate.len(), 2);
    assert_eq!(
        [separate[0].outlines[0].leader, separate[1].outlines[0].leader],
        [0, 1]
    );
    assert_at(infeeds(&separate)[1], [101.0, 50.0]);
    // Programmed overlap: half chord sqrt(25² - 23²) = 9.80 > 5, so the tool passes through.
    let merged = superimpose(&list, 5.0, Merge::ProgrammedContours);
    assert_eq!(merged.len(), 1);
    assert!(total(&merged) > total(&separate));
}

/// A pocket reduces several islands: it starts inside the first, the others start outside of it
/// [003:5805-5809]. An island that starts inside the pocket stays.
#[test]
fn pocket_reduces_several_islands() {
    let rectangle = |min: Point2, max: Point2, tool_left: bool| {
        SubContour::programmed(Contour::rectangle(min, max), tool_left)
    };
    let first = rectangle([10.0, 40.0], [40.0, 60.0], false);
    let second = rectangle([90.0, 40.0], [60.0, 60.0], true); // clockwise from X90
    assert!(!second.contour.is_counter_clockwise());
    let stays = rectangle([47.0, 47.0], [53.0, 53.0], false);
    // The pocket X30..70 Y45..55 starts at (30, 45), inside the first island.
    let pocket = rectangle([30.0, 45.0], [70.0, 55.0], true);
    let list = [first, second, stays, pocket, pocket_5_to_95()];
    let islands = (600.0 - 100.0) + (600.0 - 100.0) + 36.0;
    assert_near(programmed(&list), 8100.0 - islands);
}

/// The order of pockets and islands in the list does not matter, only their start points.
#[test]
fn enclosing_pocket_may_come_first_or_last() {
    let mut list = four_contours().to_vec();
    list.push(SubContour::programmed(
        Contour::rectangle([0.0, 0.0], [100.0, 100.0]),
        true,
    ));
    let last = programmed(&list);
    list.rotate_right(1);
    assert_near(programmed(&list), last);
    assert_near(last, 10_000.0 - 256.0 - 128.0);
}

#[test]
fn three_pockets_intersect_and_unite_in_the_order_of_the_list() {
    let square = |min: Point2, max: Point2| SubContour::programmed(Contour::rectangle(min, max), true);
    // A starts at (0, 0) inside B = -5..10, outside C = 5..20.
    let (a, b, c) = (
        square([0.0, 0.0], [20.0, 20.0]),
        square([-5.0, -5.0], [10.0, 10.0]),
        square([5.0, 5.0], [30.0, 30.0]),
    );
    // A ∩ B = 100; then united with C = 625, common 5 x 5.
    assert_near(
        programmed(&[a.clone(), b.clone(), c.clone()]),
        100.0 + 625.0 - 25.0,
    );
    // (A ∪ C) ∩ B = A ∩ B, as C lies above (0, 0).
    assert_near(programmed(&[a, c, b]), 100.0);
}

#[test]
fn twelve_separate_pockets_are_twelve_areas_in_order() {
    let list: Vec<SubContour> = (0..12)
        .map(|i| {
            let x = f64::from(i) * 10.0;
            SubContour::programmed(Contour::circle([x, 0.0], 4.0, 0.0, Sense::CounterClockwise), true)
        })
        .collect();
    let areas = superimpose(&list, 1.0, Merge::CentrePaths);
    let leaders: Vec<usize> = areas.iter().map(|a| a.outlines[0].leader).collect();
    assert_eq!(leaders, (0..12).collect::<Vec<_>>());
    areas.iter().for_each(|a| assert_near(a.region.area(), PI * 9.0));
}

#[test]
fn nothing_is_machined_without_a_pocket_or_room() {
    assert!(superimpose(&[], 1.0, Merge::CentrePaths).is_empty());
    assert!(superimpose(&[circle(35.0, 10.0, false)], 1.0, Merge::CentrePaths).is_empty());
    assert!(superimpose(&[circle(35.0, 10.0, true)], 25.0, Merge::CentrePaths).is_empty());
    assert!(superimpose(&[circle(35.0, 10.0, true)], 40.0, Merge::ProgrammedContours).is_empty());
}

/// The centre of the tool keeps its distance to everything that must stay.
#[test]
fn tool_keeps_its_distance() {
    let list = four_contours();
    let islands: Vec<Region> = list[2..]
        .iter()
        .map(|s| Region::from_contour(&s.contour))
        .collect();
    for merge in BOTH {
        for area in superimpose(&list, 5.0, merge) {
            for segment in area.outlines.iter().flat_map(|o| o.contour.segments()) {
                for t in [0.0, 0.25, 0.5, 0.75] {
                    let p = segment.point(t);
                    for island in &islands {
                        assert_eq!(island.locate(p), Location::Outside);
                        assert!(island.boundary_distance(p) >= 5.0 - 1e-6);
                    }
                }
            }
        }
    }
}

/// A triangle and a contour whose two arcs cross 4 µm before the corner they end in. The lens between is
/// 4e-6 mm thick, and neither it nor anything else makes the second pocket too narrow for the tool.
#[test]
fn pocket_whose_arcs_cross_just_before_their_corner_is_machined() {
    let triangle = Contour::polygon(&[
        [1.0, 0.0],
        [-0.4999999999999998, 0.8660254037844387],
        [-0.5000000000000004, -0.8660254037844384],
    ]);
    let mut arcs = Contour::start_at([1.0, 1.067])
        .line_to([0.623, 0.28500000000000003])
        .line_to([-0.223, 0.092])
        .line_to([-0.901, 0.633])
        .line_to([-1.961, 2.012]);
    arcs.push(Segment::Arc {
        from: [-1.961, 2.012],
        to: [-0.467, 3.114],
        centre: [-1.2140000000000002, 2.563],
        sweep_deg: -180.00000000000003,
    });
    arcs.push(Segment::Arc {
        from: [-0.467, 3.114],
        to: [1.8960000000000001, 3.444],
        centre: [0.62422776987385, 3.9254038781457345],
        sweep_deg: -237.36652867379064,
    });
    let arcs = arcs.line_to([1.0, 1.067]);
    assert_eq!(Region::from_contour(&arcs).contours().len(), 1);
    let pocket = |contour: Contour| SubContour {
        contour,
        kind: Kind::Pocket,
    };
    let distance = 0.05;
    let list = [pocket(triangle), pocket(arcs)];
    let found = Superposition::new(&list, distance, Merge::CentrePaths, &Unlimited);
    let Ok(Superposition { areas, too_narrow }) = found;
    assert!(too_narrow.is_empty());
    // Neither starts in the other: one area, of the paths of both.
    assert_eq!(areas.len(), 1);
    assert_eq!(areas[0].outlines[0].members, [0, 1]);
    // The point lies above the second contour's line (-0.223, 0.092) to (0.623, 0.285) by more than the
    // distance, and outside of the triangle's path: that side is x + √3 y = 1.
    let [x, y] = [0.4035000000000001, 0.2935826118829248];
    let (dx, dy) = (0.623 + 0.223, 0.285 - 0.092);
    let above = (dx * (y - 0.092) - dy * (x + 0.223)) / f64::hypot(dx, dy);
    assert!(above > distance + 0.007);
    assert!((1.0 - x - 3f64.sqrt() * y) / 2.0 < distance - 0.005);
    assert_eq!(areas[0].region.locate([x, y]), Location::Inside);
}
