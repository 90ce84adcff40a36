//! Pictures and mesh of a part with a million columns.

#![expect(clippy::expect_used, reason = "a benchmark may stop")]

use std::sync::atomic::AtomicBool;

use bahn_path::{
    Arc, Axis, Blank, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Plane, Position, ToolShape,
};
use bahn_workpiece::{Page, Part, PlanView, Resolution, ThreePlanes, View3d, Workpiece};

fn main() {
    divan::main();
}

/// A ring-shaped groove in a blank of 100 x 100 mm.
fn part() -> Part {
    let blank = Blank {
        plane: Plane::XY,
        min: [0.0, 0.0, -30.0],
        max: [100.0, 100.0, 0.0],
    };
    let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.1)).expect("a valid blank");
    let mut start = Position::UNKNOWN;
    start[Axis::X] = 80.0;
    start[Axis::Y] = 50.0;
    start[Axis::Z] = -15.0;
    let element = PathElement {
        block: BlockRef::default(),
        sequence: 0,
        curve: Curve::Arc(Arc {
            plane: Plane::XY,
            centre: [50.0, 50.0],
            sweep_deg: 360.0,
        }),
        start,
        end: start,
        feed: FeedRate::Programmed(1000.0),
        override_law: OverrideLaw::Free,
        constant_speed: false,
        tangential_end: false,
        end_feed: None,
        dwell_s: 0.0,
        placement: None,
        functions: None,
    };
    for corner_radius in [0.0, 8.0] {
        workpiece.cut(
            &element,
            &ToolShape {
                length: 0.0,
                radius: 8.0,
                corner_radius,
                ..ToolShape::default()
            },
            Axis::Z,
        );
    }
    workpiece.finished()
}

#[divan::bench(sample_count = 10)]
fn plan_view(bencher: divan::Bencher) {
    let part = part();
    bencher.bench_local(|| part.plan_view(&Page::standard("", ""), &PlanView::default()));
}

#[divan::bench(sample_count = 10)]
fn three_planes(bencher: divan::Bencher) {
    let part = part();
    bencher.bench_local(|| part.three_planes(&Page::standard("", ""), &ThreePlanes::default()));
}

#[divan::bench(sample_count = 5)]
fn view_3d(bencher: divan::Bencher) {
    let part = part();
    bencher.bench_local(|| part.view_3d(&Page::standard("", ""), &View3d::default()));
}

#[divan::bench(sample_count = 5)]
fn stl(bencher: divan::Bencher) {
    let part = part();
    bencher.bench_local(|| part.write_stl(std::io::sink(), &AtomicBool::new(false)));
}
