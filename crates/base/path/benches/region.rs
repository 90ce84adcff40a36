//! How long contours of 20,000 elements take: their offset, and everything of an SL cycle but its movements.

use std::f64::consts::TAU;

use bahn_path::region::{Contour, HatchPattern, Kind, Merge, Region, SubContour, Superposition, Unlimited};
use bahn_path::{Point2, Sense};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

const ELEMENTS: usize = 20_000;
/// Of the tool, mm.
const RADIUS: f64 = 3.0;
const SHAPES: [&str; 10] = [
    "star", "smooth", "scallops", "islands", "spiral", "comb", "zigzag", "disc", "wedges", "star_151",
];

/// Target: 2 s each.
#[divan::bench(args = SHAPES, sample_count = 3, sample_size = 1)]
fn offset(bencher: Bencher, shape: &str) {
    let subcontours = subcontours(shape);
    bencher.bench(|| {
        for subcontour in &subcontours {
            let region = Region::from_contour(&subcontour.contour);
            let grows = subcontour.kind == Kind::Island;
            black_box(region.offset(if grows { RADIUS } else { -RADIUS }));
        }
    });
}

/// Target: 2 s each.
#[divan::bench(args = SHAPES, sample_count = 3, sample_size = 1)]
fn cycle(bencher: Bencher, shape: &str) {
    let subcontours = subcontours(shape);
    bencher.bench(|| {
        let Ok(result) = Superposition::new(&subcontours, RADIUS, Merge::CentrePaths, &Unlimited);
        for area in &result.areas {
            black_box(area.region.hatch(20.0, RADIUS, HatchPattern::Zigzag));
        }
    });
}

fn subcontours(shape: &str) -> Vec<SubContour> {
    let pocket = |contour| SubContour {
        contour,
        kind: Kind::Pocket,
    };
    let only = |contour| vec![pocket(contour)];
    match shape {
        "star" => only(polygon(ELEMENTS, |k, turn| {
            polar(if k % 2 == 0 { 50.0 } else { 45.0 }, turn)
        })),
        "smooth" => only(polygon(ELEMENTS, |_, turn| {
            polar(50.0 + 8.0 * (5.0 * TAU * turn).cos(), turn)
        })),
        "scallops" => only(scallops(ELEMENTS)),
        "islands" => islands(20),
        "spiral" => only(spiral()),
        "comb" => only(comb(0.0)),
        "zigzag" => only(comb(0.4)),
        // All elements are as far from where the tool's centre goes.
        "disc" => only(polygon(ELEMENTS, |_, turn| polar(RADIUS + 0.01, turn))),
        // All meet in one point.
        "wedges" => only(polygon(ELEMENTS, |k, turn| {
            if k % 3 == 0 { [0.0, 0.0] } else { polar(50.0, turn) }
        })),
        // 151 corners, each side leads past 75 of them; run through again and again.
        _ => only(polygon(ELEMENTS, |k, _| {
            polar(50.0, (k * 75 % 151) as f64 / 151.0)
        })),
    }
}

fn polar(radius: f64, turn: f64) -> Point2 {
    let (sin, cos) = (TAU * turn).sin_cos();
    [radius * cos, radius * sin]
}

fn polygon(count: usize, at: impl Fn(usize, f64) -> Point2) -> Contour {
    Contour::polygon(
        &(0..count)
            .map(|k| at(k, k as f64 / count as f64))
            .collect::<Vec<_>>(),
    )
}

/// Arcs alone: half circles that bulge outward.
fn scallops(count: usize) -> Contour {
    let joint = |k: usize| polar(50.0, k as f64 / count as f64);
    (0..count).fold(Contour::start_at(joint(0)), |contour, k| {
        let (from, to) = (joint(k), joint((k + 1) % count));
        contour.arc_to(
            [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])],
            to,
            Sense::CounterClockwise,
        )
    })
}

/// Lines and arcs in turn around a pocket and around islands in it, half of all elements each.
fn islands(count: usize) -> Vec<SubContour> {
    let wavy = |centre: Point2, radius: f64, elements: usize| {
        let joint = |k: usize| {
            let [x, y] = polar(radius, k as f64 / elements as f64);
            [x + centre[0], y + centre[1]]
        };
        (0..elements).fold(Contour::start_at(joint(0)), |contour, k| {
            let (from, to) = (joint(k), joint((k + 1) % elements));
            if k % 2 == 0 {
                contour.line_to(to)
            } else {
                contour.arc_to(
                    [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])],
                    to,
                    Sense::CounterClockwise,
                )
            }
        })
    };
    let pocket = SubContour {
        contour: wavy([0.0, 0.0], 100.0, ELEMENTS / 2),
        kind: Kind::Pocket,
    };
    let island = |k: usize| SubContour {
        contour: wavy(polar(60.0, k as f64 / count as f64), 4.0, ELEMENTS / 2 / count),
        kind: Kind::Island,
    };
    std::iter::once(pocket).chain((0..count).map(island)).collect()
}

/// A lane that widens to 8 mm and winds inward ten times, and back.
fn spiral() -> Contour {
    let half = ELEMENTS / 2;
    let at = |k: usize, radius: f64| {
        let turn = 10.0 * k as f64 / half as f64;
        polar(radius - 10.0 * turn, turn)
    };
    let outer = (0..half).map(|k| at(k, 120.0));
    let inner = (0..half).rev().map(|k| at(k, 112.0));
    Contour::polygon(&outer.chain(inner).collect::<Vec<_>>())
}

/// A pocket with slots too narrow for the tool, whose flanks lean.
fn comb(lean: f64) -> Contour {
    let teeth = ELEMENTS / 4 - 1;
    let pitch = 400.0 / teeth as f64;
    let slots = (0..teeth).flat_map(|k| {
        let x = 400.0 - k as f64 * pitch;
        let at = |part: f64, y: f64| [x - (part + lean * y / 20.0) * pitch, y];
        [at(0.0, 20.0), at(0.0, 40.0), at(0.5, 40.0), at(0.5, 20.0)]
    });
    let floor = [[0.0, 0.0], [400.0, 0.0]];
    Contour::polygon(&floor.into_iter().chain(slots).collect::<Vec<_>>())
}
