//! Clearing passes: complete, inside, and linked inside.

use crate::common::region;
use bahn_path::region::{Contour, HatchPattern, Pass, Region, Segment};
use bahn_path::{Point2, Sense};
use proptest::prelude::*;

const PATTERNS: [HatchPattern; 2] = [HatchPattern::Zigzag, HatchPattern::OneWay];

/// Everything that the tool passes after the boundary: passes and links.
fn segments(passes: &[Pass]) -> impl Iterator<Item = Segment> {
    passes.iter().flat_map(|pass| {
        pass.link
            .iter()
            .flatten()
            .copied()
            .chain([Segment::line(pass.from, pass.to)])
            .collect::<Vec<_>>()
    })
}

fn gap(a: Point2, b: Point2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn rectangle_is_cleared_in_one_zigzag() {
    // 40 x 20 across 90 degrees with 6 mm: lines at X 40 - 6, 40 - 12, ... counted from the side of the
    // least extent across the angle, which for 90 degrees is -X.
    let passes = Region::from_contour(&Contour::rectangle([0.0, 0.0], [40.0, 20.0])).hatch(
        90.0,
        6.0,
        HatchPattern::Zigzag,
    );
    let x: Vec<f64> = passes.iter().map(|p| p.from[0]).collect();
    assert_eq!(x, [34.0, 28.0, 22.0, 16.0, 10.0, 4.0]);
    assert_eq!((passes[0].from[1], passes[0].to[1]), (0.0, 20.0));
    assert_eq!((passes[1].from[1], passes[1].to[1]), (20.0, 0.0));
    assert!(passes.iter().skip(1).all(Pass::is_connected));
}

#[test]
fn spans_end_on_arcs() {
    // A disc R10 and lines at Y -10 + 4 k: half chords sqrt(100 - y²).
    let disc = Region::from_contour(&Contour::circle([0.0, 0.0], 10.0, 0.0, Sense::CounterClockwise));
    let passes = disc.hatch(0.0, 4.0, HatchPattern::OneWay);
    let expected: Vec<f64> = [-6.0f64, -2.0, 2.0, 6.0]
        .iter()
        .map(|y| (100.0 - y * y).sqrt())
        .collect();
    assert_eq!(passes.len(), 4);
    for (pass, half) in passes.iter().zip(expected) {
        assert!((pass.from[0] + half).abs() < 1e-9 && (pass.to[0] - half).abs() < 1e-9);
        assert!(!pass.is_connected());
    }
}

#[test]
fn island_is_jumped_over() {
    let frame = Region::from_contour(&Contour::rectangle([0.0, 0.0], [60.0, 40.0]));
    let island = Region::from_contour(&Contour::rectangle([20.0, 11.0], [40.0, 29.0]));
    let area = frame.difference(&island);
    let passes = area.hatch(0.0, 5.0, HatchPattern::Zigzag);
    // Lines 5, 10 whole; 15, 20, 25 on both sides; 30, 35 whole.
    assert_eq!(passes.len(), 2 + 3 * 2 + 2);
    // The left side and what follows is one stretch, then one lift to the right side.
    let lifts = passes.iter().filter(|p| !p.is_connected()).count();
    assert_eq!(lifts, 2);
}

#[test]
fn nonsense_gives_no_passes() {
    let area = Region::from_contour(&Contour::rectangle([0.0, 0.0], [60.0, 40.0]));
    for pattern in PATTERNS {
        for (angle, stepover) in [
            (0.0, 0.0),
            (0.0, -1.0),
            (0.0, f64::NAN),
            (f64::NAN, 1.0),
            (0.0, 1e-9),
            (0.0, 50.0),
        ] {
            assert!(area.hatch(angle, stepover, pattern).is_empty());
        }
        assert!(Region::EMPTY.hatch(0.0, 1.0, pattern).is_empty());
    }
    let endless = Region::from_contour(&Contour::rectangle([0.0, 0.0], [1e12, 1e12]));
    assert!(endless.hatch(0.0, 0.001, HatchPattern::Zigzag).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Boundary and passes clear all that the tool can reach, and go nowhere else.
    #[test]
    fn hatching_clears_everything(
        area in region(),
        radius in prop::sample::select(vec![0.3, 0.5, 1.0]),
        angle in prop_oneof![Just(0.0), Just(90.0), Just(45.0), -180.0..180.0],
        zigzag in any::<bool>(),
        samples in prop::collection::vec((-4.0..17.0, -4.0..17.0), 60),
    ) {
        let centre = area.offset(-radius);
        let reachable = centre.offset(radius);
        let passes = centre.hatch(angle, radius, PATTERNS[usize::from(!zigzag)]);
        for segment in segments(&passes) {
            for t in [0.0, 0.01, 0.2, 0.5, 0.77, 0.99, 1.0] {
                let p = segment.point(t);
                prop_assert!(centre.contains(p) || centre.boundary_distance(p) < 1e-5, "{p:?} is outside");
            }
        }
        for (x, y) in samples {
            let p = [x, y];
            if reachable.contains(p) {
                let cleared = segments(&passes).map(|segment| segment.distance(p)).fold(centre.boundary_distance(p), f64::min);
                prop_assert!(cleared <= radius + 1e-5, "{p:?} stays, {cleared} away");
            }
        }
    }

    /// A link begins where the pass before ends and ends where its pass begins.
    #[test]
    fn links_are_continuous(area in region(), angle in -180.0..180.0, stepover in 0.3..2.0) {
        let passes = area.hatch(angle, stepover, HatchPattern::Zigzag);
        for pair in passes.windows(2) {
            if let Some(link) = &pair[1].link {
                let mut at = pair[0].to;
                for segment in link {
                    prop_assert!(gap(at, segment.from()) < 1e-5);
                    at = segment.to();
                }
                prop_assert!(gap(at, pair[1].from) < 1e-5);
            }
        }
    }

    /// Zigzag and one-way cut the same lines.
    #[test]
    fn patterns_cut_the_same(area in region(), angle in -180.0..180.0, stepover in 0.3..2.0) {
        let length = |pattern| -> f64 {
            area.hatch(angle, stepover, pattern).iter().map(|p| gap(p.from, p.to)).sum()
        };
        prop_assert!((length(HatchPattern::Zigzag) - length(HatchPattern::OneWay)).abs() < 1e-9);
    }
}
