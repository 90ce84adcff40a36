//! Time of a contour cycle of the interpolator. Run with `cargo bench -p bahn-motion --bench cycle`;
//! divan reports cycles per second.

use bahn_motion::{Drive, Interpolator, Limits, PointToPoint, Prepared, State};
use bahn_path::{
    Axis, AxisSet, BlockRef, Curve, ElementSource, FeedRate, LiveData, OverrideLaw, PathElement, PerAxis,
    Position, Step,
};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

/// Elements of look-ahead.
const CAPACITY: usize = 512;

fn main() {
    divan::main();
}

/// Lines of a length without end, one at a slight angle to the other.
struct Lines {
    length: f64,
    at: Position,
    count: u64,
    /// Every block has a feed of its own.
    feeds: bool,
}

impl ElementSource for Lines {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        self.count += 1;
        let start = self.at;
        self.at[Axis::X] += self.length;
        self.at[Axis::Y] += 0.0005 * self.length * (self.count % 5) as f64;
        let own = (self.count * 7919 % 1000) as f64;
        Step::Element(PathElement {
            block: BlockRef::default(),
            sequence: self.count,
            curve: Curve::Line,
            start,
            end: self.at,
            feed: FeedRate::Programmed(10_000.0 + if self.feeds { own } else { 0.0 }),
            override_law: OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            end_feed: None,
            dwell_s: 0.0,
            placement: None,
            functions: None,
        })
    }

    fn resume(&mut self, _: LiveData) {}
}

fn limits() -> Limits {
    Limits {
        max_feed_mm_min: PerAxis::splat(30_000.0),
        acceleration_m_s2: PerAxis::splat(1.0),
        radial_acceleration_m_s2: 0.5,
        corner_angle_deg: 10.0,
        servo_lag: true,
        cycle_s: 0.003,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: Default::default(),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    }
}

/// An interpolator at full speed with a full ring.
fn running(length: f64, feeds: bool) -> (Interpolator<()>, Lines) {
    let mut path = Interpolator::new(&limits(), CAPACITY);
    path.set_position(Position::ZERO);
    let mut source = Lines {
        length,
        at: Position::ZERO,
        count: 0,
        feeds,
    };
    for _ in 0..1000 {
        path.prepare(&mut source, usize::MAX);
        path.cycle(&Drive::default());
    }
    assert_eq!(path.prepare(&mut source, usize::MAX), Prepared::Full);
    assert!(path.speed_mm_s() > 10_000.0 / 60.0 - 1.0, "{}", path.speed_mm_s());
    (path, source)
}

/// 60 cycles, 0.5 mm each, from a full ring.
fn cycles(bencher: Bencher<'_, '_>, length: f64, feeds: bool, drive: impl Fn(u32) -> Drive + Sync) {
    bencher
        .counter(ItemsCount::new(60usize))
        .with_inputs(|| running(length, feeds))
        .bench_local_refs(|(path, _)| {
            for cycle in 0..60 {
                let cycle = black_box(path.cycle(&drive(cycle)));
                assert_eq!(cycle.state, State::Moving);
            }
        });
}

#[divan::bench]
fn cycle_of_lines_of_0_1_mm(bencher: Bencher<'_, '_>) {
    cycles(bencher, 0.1, false, |_| Drive::default());
}

#[divan::bench]
fn cycle_of_lines_of_100_mm(bencher: Bencher<'_, '_>) {
    cycles(bencher, 100.0, false, |_| Drive::default());
}

fn alternating(cycle: u32) -> Drive {
    Drive {
        feed_override_percent: 100.0 + f64::from(cycle % 2),
        ..Drive::default()
    }
}

/// The override changes in every cycle.
#[divan::bench]
fn cycle_with_changing_override(bencher: Bencher<'_, '_>) {
    cycles(bencher, 0.1, false, alternating);
}

/// And every block has its own feed: each of those within the braking distance is asked.
#[divan::bench]
fn cycle_with_changing_override_and_feeds(bencher: Bencher<'_, '_>) {
    cycles(bencher, 0.1, true, alternating);
}

/// An axis is clamped that no block moves.
#[divan::bench]
fn cycle_with_a_clamped_axis(bencher: Bencher<'_, '_>) {
    cycles(bencher, 0.1, false, |_| Drive {
        clamped: AxisSet::EMPTY.with(Axis::C),
        ..Drive::default()
    });
}

/// Reading ahead by what 60 cycles have used, 300 elements.
#[divan::bench]
fn prepare_an_element(bencher: Bencher<'_, '_>) {
    bencher
        .counter(ItemsCount::new(300usize))
        .with_inputs(|| {
            let (mut path, source) = running(0.1, false);
            (0..60).for_each(|_| {
                path.cycle(&Drive::default());
            });
            (path, source)
        })
        .bench_local_refs(|(path, source)| path.prepare(source, usize::MAX));
}

#[divan::bench]
fn point_to_point(bencher: Bencher<'_, '_>) {
    bencher
        .counter(ItemsCount::new(1000usize))
        .with_inputs(|| PointToPoint::new(0.0))
        .bench_local_refs(|axis| {
            for _ in 0..1000 {
                axis.cycle(0.003, bahn_motion::Aim::Position(black_box(500.0)), 10_000.0, 1.0);
            }
        });
}
