//! SL cycles: pockets and islands superimposed. Expected areas are those of the contours, less what a round
//! tool cannot reach in corners.

use std::f64::consts::PI;

use crate::support::*;
use bahn_path::{Axis, Curve, FeedRate, PathElement};
use bahn_workpiece::EventKind;

/// Resolution of the removed volumes, and what that makes of them.
const RESOLUTION_MM: f64 = 0.1;
const TOLERANCE: f64 = 0.002;

/// The circles of P29 to P32: R25 about (35,50) and (65,50).
const CENTRES: [[f64; 2]; 2] = [[35.0, 50.0], [65.0, 50.0]];
const APART: f64 = 30.0;
const RADIUS: f64 = 25.0;

#[track_caller]
fn removes(name: &str, expected_mm3: f64) {
    let run = run_manual(name);
    close(
        run.removed_mm3(RESOLUTION_MM),
        expected_mm3,
        TOLERANCE * expected_mm3,
    );
    let rapid_cuts = run
        .events(0.5)
        .into_iter()
        .filter(|event| event.kind == EventKind::RapidCut);
    assert_eq!(rapid_cuts.count(), 0);
}

/// Area of the intersection of two equal circles.
fn lens(radius: f64) -> f64 {
    2.0 * radius * radius * (APART / (2.0 * radius)).acos()
        - 0.5 * APART * (4.0 * radius * radius - APART * APART).sqrt()
}

fn union(radius: f64) -> f64 {
    2.0 * PI * radius * radius - lens(radius)
}

/// Area between three circles that touch or cross each other one after the other: from the intersection S of
/// two of them along both to the points where the tool's circle touches. By Green's theorem, as a sum over
/// its arcs: centre, start, end (the short way).
fn area_within(arcs: &[([f64; 2], [f64; 2], [f64; 2])]) -> f64 {
    let twice: f64 = arcs
        .iter()
        .map(|(centre, from, to)| {
            let a = [from[0] - centre[0], from[1] - centre[1]];
            let b = [to[0] - centre[0], to[1] - centre[1]];
            let sweep = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
            let r2 = a[0] * a[0] + a[1] * a[1];
            r2 * sweep + centre[0] * (b[1] - a[1]) - centre[1] * (b[0] - a[0])
        })
        .sum();
    0.5 * twice.abs()
}

/// The upper intersection of circles about [`CENTRES`] with radii `a` and `b`.
fn crossing(a: f64, b: f64) -> [f64; 2] {
    let x = (a * a - b * b + APART * APART) / (2.0 * APART);
    [CENTRES[0][0] + x, 50.0 + (a * a - x * x).sqrt()]
}

/// What the tool leaves in the corner at the upper intersection of both circles when its centre stands at
/// the distances `a` and `b` from their centres.
fn remnant(a: f64, b: f64, tool: f64) -> f64 {
    let corner = crossing(RADIUS, RADIUS);
    let at = crossing(a, b);
    let touch = |centre: [f64; 2], distance: f64| {
        [0, 1].map(|k: usize| centre[k] + (at[k] - centre[k]) * RADIUS / distance)
    };
    let (ta, tb) = (touch(CENTRES[0], a), touch(CENTRES[1], b));
    close((ta[0] - at[0]).hypot(ta[1] - at[1]), tool, 1e-9);
    area_within(&[(CENTRES[0], corner, ta), (at, ta, tb), (CENTRES[1], tb, corner)])
}

/// P28: an island with rounded corners stays in the cleared blank; the pocket around it is larger than the
/// blank [003:5563-5597].
#[test]
fn p28_island() {
    let island = (70.0 - 15.0) * (60.0 - 20.0) - (4.0 - PI) * 12.0 * 12.0;
    removes("P28", (100.0 * 100.0 - island) * 15.0);
    // Two infeeds: 8 mm and the rest.
    let run = run_manual("P28");
    let mut depths: Vec<f64> = run
        .moves()
        .filter(|e| e.feed == FeedRate::Programmed(100.0))
        .map(|e| e.end[Axis::Z])
        .collect();
    depths.sort_by(f64::total_cmp);
    depths.dedup();
    assert_eq!(depths, [-15.0, -8.0]);
    assert!(run.moves().any(|e| e.feed == FeedRate::Programmed(500.0)));
}

/// P29: two overlapping pockets, A starts outside B: both are machined [003:5657-5726].
#[test]
fn p29_union() {
    close(union(RADIUS), 3367.9, 0.05);
    removes("P29-union", union(RADIUS) * 10.0);
}

/// P29: pocket A without island B; the tips of the sickle are too narrow for the tool R3 [003:5745-5780].
#[test]
fn p29_exclusion() {
    let sickle = PI * RADIUS * RADIUS - lens(RADIUS);
    close(sickle, 1404.4, 0.05);
    // Inside A and outside B.
    let tips = 2.0 * remnant(RADIUS - 3.0, RADIUS + 3.0, 3.0);
    removes("P29-exclusion", (sickle - tips) * 10.0);
}

/// P29: A starts inside B: only what both share is machined [003:5781-5794].
#[test]
fn p29_intersection() {
    close(lens(RADIUS), 559.1, 0.05);
    let tips = 2.0 * remnant(RADIUS - 3.0, RADIUS - 3.0, 3.0);
    removes("P29-intersection", (lens(RADIUS) - tips) * 10.0);
    // The same by Steiner's formula: the lens of the tool's centre, grown by the tool.
    let centre_perimeter = 4.0 * 22.0 * (APART / 44.0).acos();
    close(
        lens(RADIUS) - tips,
        lens(22.0) + 3.0 * centre_perimeter + 9.0 * PI,
        1e-9,
    );
}

/// Area of the pocket X 5..95, Y 5..95 with corners of the tool R2.5.
fn enclosing_pocket() -> f64 {
    90.0 * 90.0 - (4.0 - PI) * 2.5 * 2.5
}

/// P30: two overlapping islands stay; the tool does not reach the notches between them [003:5811-5871].
#[test]
fn p30_union() {
    let notches = 2.0 * remnant(RADIUS + 2.5, RADIUS + 2.5, 2.5);
    removes("P30-union", (enclosing_pocket() - union(RADIUS) - notches) * 10.0);
}

/// P30: island A without pocket B stays [003:5882-5900].
#[test]
fn p30_exclusion() {
    let sickle = PI * RADIUS * RADIUS - lens(RADIUS);
    removes("P30-exclusion", (enclosing_pocket() - sickle) * 10.0);
}

/// P30: A starts inside B: only what both islands share stays [003:5905-5927].
#[test]
fn p30_intersection() {
    removes("P30-intersection", (enclosing_pocket() - lens(RADIUS)) * 10.0);
}

/// Square and triangle of P31, grown by `d` with round corners.
fn islands_grown(d: f64) -> f64 {
    let square = 16.0 * 16.0 + 4.0 * 16.0 * d + PI * d * d;
    let side = 8.0f64.hypot(16.0);
    let triangle = 0.5 * 16.0 * 16.0 + (16.0 + 2.0 * side) * d + PI * d * d;
    square + triangle
}

/// P31: two pockets with two islands, 2 mm are left for finishing [003:5944-5983].
#[test]
fn p31_rough_with_allowance() {
    close(union(RADIUS) - islands_grown(0.0), 2983.9, 0.05);
    removes("P31", (union(RADIUS - 2.0) - islands_grown(2.0)) * 10.0);
}

/// Distance of a point to the contours of P31: to the rim of both pockets and to the islands. Negative
/// where the point is outside the area.
fn clearance(p: [f64; 2]) -> f64 {
    let in_pockets = CENTRES.map(|c| RADIUS - (p[0] - c[0]).hypot(p[1] - c[1]));
    let polygon = |corners: &[[f64; 2]]| {
        let mut inside = false;
        let mut nearest = f64::MAX;
        for (i, a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let d = [b[0] - a[0], b[1] - a[1]];
            let t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
            let t = t.clamp(0.0, 1.0);
            nearest = nearest.min((p[0] - a[0] - t * d[0]).hypot(p[1] - a[1] - t * d[1]));
            let crosses = (a[1] > p[1]) != (b[1] > p[1]);
            if crosses && p[0] < a[0] + d[0] * (p[1] - a[1]) / d[1] {
                inside = !inside;
            }
        }
        if inside { -nearest } else { nearest }
    };
    let square = polygon(&[[27.0, 42.0], [27.0, 58.0], [43.0, 58.0], [43.0, 42.0]]);
    let triangle = polygon(&[[57.0, 42.0], [73.0, 42.0], [65.0, 58.0]]);
    in_pockets[0].max(in_pockets[1]).min(square).min(triangle)
}

/// Least distance of the tool's centre to the contours of P31 over movements below the surface.
fn least_clearance(elements: &[&PathElement]) -> f64 {
    let mut least = f64::MAX;
    for e in elements.iter().filter(|e| e.end[Axis::Z] < 0.0) {
        for k in 0..=64 {
            let at = e.curve.position(&e.start, &e.end, f64::from(k) / 64.0);
            least = least.min(clearance([at[Axis::X], at[Axis::Y]]));
        }
    }
    least
}

/// P32: pilot drilling, roughing and finishing with three tools [003:6121-6184].
#[test]
fn p32_drill_rough_finish() {
    let run = run_manual("P32");
    let tools: Vec<u32> = run.tool_calls().iter().map(|call| call.tool).collect();
    assert_eq!(tools, [0, 1, 0, 2, 0, 3, 0]);
    // The three cycle calls.
    let (drilling, roughing, finishing) = (run.of_block(15), run.of_block(24), run.of_block(32));

    // Pilot holes: at each infeed point, infeeds of 5 mm. All lie 2.2 + 2.8 mm from the contours.
    let mut holes: Vec<[f64; 2]> = Vec::new();
    for e in drilling.iter().filter(|e| e.end[Axis::Z] == -10.0) {
        holes.push([e.end[Axis::X], e.end[Axis::Y]]);
        close(clearance([e.end[Axis::X], e.end[Axis::Y]]), 5.0, 1e-6);
    }
    assert!(
        holes.len() >= 3,
        "one hole for the pockets and one for each island: {holes:?}"
    );

    // Roughing plunges its outlines in the pilot holes and stays 3 + 2 mm away from the contours.
    let outlines: Vec<_> = roughing
        .iter()
        .filter(|e| e.feed == FeedRate::Programmed(100.0) && e.end[Axis::Z] == -5.0)
        .map(|e| [e.end[Axis::X], e.end[Axis::Y]])
        .collect();
    for hole in &holes {
        assert!(
            outlines
                .iter()
                .any(|p| (p[0] - hole[0]).hypot(p[1] - hole[1]) < 1e-6),
            "{hole:?} in {outlines:?}"
        );
    }
    close(least_clearance(&roughing), 5.0, 1e-6);

    // Finishing: the tool R2.5 touches the contours.
    close(least_clearance(&finishing), 2.5, 1e-6);
    let milling = finishing
        .iter()
        .filter(|e| e.start[Axis::Z] == e.end[Axis::Z] && e.end[Axis::Z] < 0.0);
    for e in milling {
        let middle = e.curve.position(&e.start, &e.end, 0.5);
        close(clearance([middle[Axis::X], middle[Axis::Y]]), 2.5, 1e-3);
        assert_eq!(e.feed, FeedRate::Programmed(500.0));
    }
}

/// P32: DR- is up-cut with M3: the material lies to the left of the tool's way, that is the rim of the pockets
/// is run clockwise and islands counter-clockwise [003:6043-6066].
#[test]
fn p32_finishes_up_cut() {
    let run = run_manual("P32");
    for e in run.of_block(32) {
        let Curve::Arc(arc) = e.curve else { continue };
        let is_rim = CENTRES
            .iter()
            .any(|c| (arc.centre[0] - c[0]).hypot(arc.centre[1] - c[1]) < 1e-6);
        assert_eq!(arc.sweep_deg < 0.0, is_rim, "{arc:?}");
    }
}

/// P32: after finishing, the whole area of the contours is removed to the full depth.
#[test]
fn p32_volume() {
    removes("P32", (union(RADIUS) - islands_grown(0.0)) * 10.0);
}

/// A pocket of 60 x 40 mm around a round island, with two infeeds, under MP7420 = `bits`.
fn with_mp7420(bits: u32) -> Run {
    let text = program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-20
         BLK FORM 0.2 X+100 Y+100 Z+0
         TOOL DEF 1 L+0 R+3
         TOOL CALL 1 Z S1000
         CYCL DEF 14.0 GEOM
         CYCL DEF 14.1 CONTOUR LABEL 1/2
         CYCL DEF 6.0 ROUGH
         CYCL DEF 6.1 SET UP -2 DEPTH -10
         CYCL DEF 6.2 PECKG -5 F100 ALLOW +0
         CYCL DEF 6.3 ANGLE +0 F500
         L X+5 Y+5 R0 FMAX M3
         L Z+2 FMAX
         CYCL CALL
         L IZ+20 FMAX M2
         LBL 1
         L X+20 Y+30 RL
         L X+80
         L Y+70
         L X+20
         L Y+30
         LBL 0
         LBL 2
         CC X+50 Y+50
         L X+40 Y+50 RR
         C X+40 Y+50 DR+
         LBL 0",
    );
    let run = Job::new(text)
        .with(|s| s.rules.contour_pocket = bahn_interpreter::ContourPocketRules::from_bits(bits))
        .run();
    run.assert_completed();
    run
}

/// What the milling movements of a run are, in their order, with their depth: `o` round the island, `x` along
/// a clearing pass; repeated ones once. Sides of the pocket are left out, as a pass may run along them.
fn milling(run: &Run) -> Vec<(char, f64)> {
    let mut order: Vec<(char, f64)> = Vec::new();
    for e in run
        .of_block(13)
        .into_iter()
        .filter(|e| e.feed == FeedRate::Programmed(500.0))
    {
        let kind = match e.curve {
            Curve::Arc(arc) if (arc_radius(e) - 13.0).abs() < 1e-6 && arc.sweep_deg.abs() > 300.0 => 'o',
            Curve::Line
                if e.end[Axis::Y] == e.start[Axis::Y]
                    && (e.end[Axis::Y] - 33.0).abs() > 1.0
                    && (e.end[Axis::Y] - 67.0).abs() > 1.0 =>
            {
                'x'
            }
            _ => continue,
        };
        if order.last() != Some(&(kind, e.end[Axis::Z])) {
            order.push((kind, e.end[Axis::Z]));
        }
    }
    order
}

/// Bit 1: clear out first; bit 3: both for each infeed [000:6739-6753].
#[test]
fn mp7420_order() {
    assert_eq!(
        milling(&with_mp7420(0)),
        [('o', -5.0), ('o', -10.0), ('x', -5.0), ('x', -10.0)]
    );
    assert_eq!(
        milling(&with_mp7420(2)),
        [('x', -5.0), ('x', -10.0), ('o', -5.0), ('o', -10.0)]
    );
    assert_eq!(
        milling(&with_mp7420(8)),
        [('o', -5.0), ('x', -5.0), ('o', -10.0), ('x', -10.0)]
    );
    assert_eq!(
        milling(&with_mp7420(10)),
        [('x', -5.0), ('o', -5.0), ('x', -10.0), ('o', -10.0)]
    );
}

/// Bit 0: the channel runs counter-clockwise in pockets and clockwise round islands, or the other way.
#[test]
fn mp7420_direction() {
    for (bits, counter_clockwise) in [(0, false), (1, true)] {
        let run = with_mp7420(bits);
        let round_island = run
            .of_block(13)
            .into_iter()
            .find(|e| (arc_radius(e) - 13.0).abs() < 1e-6)
            .unwrap();
        assert_eq!(arc_of(round_island).1 > 0.0, counter_clockwise);
        let right_side = run
            .of_block(13)
            .into_iter()
            .find(|e| e.start[Axis::X] == 77.0 && e.end[Axis::X] == 77.0 && (e.length() - 34.0).abs() < 1e-6)
            .unwrap();
        assert_eq!(
            right_side.end[Axis::Y] > right_side.start[Axis::Y],
            !counter_clockwise
        );
    }
}

/// Bit 4: the tool stays where the cycle ends, at the clearance height, or returns to where it was called.
#[test]
fn mp7420_end() {
    let end = |bits| xyz(&with_mp7420(bits).of_block(13).last().unwrap().end);
    assert_eq!(end(0), [5.0, 5.0, 2.0]);
    let stays = end(16);
    assert_eq!(stays[2], 2.0);
    assert!(stays[0] >= 23.0 && stays[1] >= 33.0, "{stays:?}");
}

/// Whatever the order, the same is removed.
#[test]
fn mp7420_volume() {
    let area = 60.0 * 40.0 - (4.0 - PI) * 9.0 - PI * 100.0;
    for bits in 0..32 {
        close(
            with_mp7420(bits).removed_mm3(0.2),
            area * 10.0,
            0.003 * area * 10.0,
        );
    }
}

/// The first coordinate block gives the plane of the contours: with U for X the parallel axis mills
/// [003:5397-5432].
#[test]
fn contour_with_a_parallel_axis() {
    let run = run("TOOL DEF 1 L+0 R+3
         TOOL CALL 1 Z S1000
         CYCL DEF 14.0 GEOM
         CYCL DEF 14.1 CONTOUR LABEL 1
         CYCL DEF 6.0 ROUGH
         CYCL DEF 6.1 SET UP -2 DEPTH -10
         CYCL DEF 6.2 PECKG -10 F100 ALLOW +0
         CYCL DEF 6.3 ANGLE +0 F500
         L X+0 Y+5 U+5 R0 FMAX M3
         L Z+2 FMAX
         CYCL CALL
         L Z+50 FMAX M2
         LBL 1
         L U+20 Y+30 RL
         L U+80
         L Y+70
         L U+20
         L Y+30
         LBL 0");
    let milling: Vec<_> = run
        .of_block(11)
        .into_iter()
        .filter(|e| e.end[Axis::Z] < 0.0)
        .collect();
    let reach = |axis: Axis| {
        let ends = milling.iter().map(|e| e.end[axis]);
        [
            ends.clone().fold(f64::MAX, f64::min),
            ends.fold(f64::MIN, f64::max),
        ]
    };
    close_points(
        &[reach(Axis::U), reach(Axis::Y), reach(Axis::X)],
        &[[23.0, 77.0], [33.0, 67.0], [0.0, 0.0]],
        1e-9,
    );
}
