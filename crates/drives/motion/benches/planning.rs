//! Time of look-ahead planning per element. Run with `cargo bench -p bahn-motion`; divan reports
//! elements per second.

use bahn_motion::{AuxiliaryTimes, Limits, PlannedStep, Planner};
use bahn_path::{
    Arc, Axis, BlockRef, Curve, ElementSource, FeedRate, LiveData, OverrideLaw, PathElement, PerAxis, Plane,
    Position, Step,
};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

const ELEMENTS: usize = 1_000_000;

fn main() {
    divan::main();
}

/// A source that makes its elements from their number, so that the bench measures planning and the
/// copying of elements, not the memory of a list.
struct Synthetic<F> {
    point: F,
    at: Position,
    count: usize,
    feed: FeedRate,
}

impl<F: FnMut(usize, Position) -> (Curve, Position)> ElementSource for Synthetic<F> {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        if self.count == ELEMENTS {
            return Step::End;
        }
        self.count += 1;
        let start = self.at;
        let (curve, end) = (self.point)(self.count, start);
        self.at = end;
        Step::Element(PathElement {
            block: BlockRef {
                program: 0,
                block: self.count as u32,
            },
            sequence: self.count as u64,
            curve,
            start,
            end,
            feed: self.feed,
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

fn source<F>(feed_mm_min: f64, point: F) -> Synthetic<F> {
    Synthetic {
        point,
        at: Position::ZERO,
        count: 0,
        feed: FeedRate::Programmed(feed_mm_min),
    }
}

fn limits() -> Limits {
    Limits {
        max_feed_mm_min: PerAxis::splat(300_000.0),
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

fn time_of<S: ElementSource>(source: S) -> f64 {
    let mut planner = Planner::new(source, &limits(), &AuxiliaryTimes::default());
    let mut time = 0.0;
    while let PlannedStep::Element(planned) = planner.next() {
        time += planned.duration_s();
    }
    time
}

fn bench<F>(bencher: Bencher<'_, '_>, feed: f64, mut make: impl FnMut() -> F + Sync + Send)
where
    F: FnMut(usize, Position) -> (Curve, Position),
{
    bencher
        .counter(ItemsCount::new(ELEMENTS))
        .with_inputs(|| source(feed, make()))
        .bench_local_values(|source| black_box(time_of(source)));
}

/// What the source alone costs: subtract it.
#[divan::bench(sample_count = 5)]
fn source_alone(bencher: Bencher<'_, '_>) {
    bencher
        .counter(ItemsCount::new(ELEMENTS))
        .with_inputs(|| source(3000.0, surface))
        .bench_local_values(|mut source| {
            while let Step::Element(element) = source.next() {
                black_box(element);
            }
        });
}

/// A milled surface: lines of 0.2 mm whose direction wavers by some degrees in three axes.
#[divan::bench(sample_count = 10)]
fn surface_of_short_lines(bencher: Bencher<'_, '_>) {
    bench(bencher, 3000.0, || surface);
}

/// Corners at which the path stops after every line.
#[divan::bench(sample_count = 10)]
fn zigzag_with_stops(bencher: Bencher<'_, '_>) {
    bench(bencher, 3000.0, || {
        |n, mut at: Position| {
            at[if n % 2 == 0 { Axis::X } else { Axis::Y }] += 0.2;
            (Curve::Line, at)
        }
    });
}

/// The worst for look-ahead: every new element lets all before it run faster, and the braking distance
/// is longer than the window.
#[divan::bench(sample_count = 10)]
fn deepest_look_ahead(bencher: Bencher<'_, '_>) {
    bench(bencher, 300_000.0, || {
        |_, mut at: Position| {
            at[Axis::X] += 0.001;
            (Curve::Line, at)
        }
    });
}

/// Half circles of 1 mm radius, one tangential to the other.
#[divan::bench(sample_count = 10)]
fn tangential_arcs(bencher: Bencher<'_, '_>) {
    bench(bencher, 3000.0, || {
        |n, mut at: Position| {
            let centre = [at[Axis::X] + 1.0, at[Axis::Y]];
            at[Axis::X] += 2.0;
            let sweep_deg = if n % 2 == 0 { 180.0 } else { -180.0 };
            (
                Curve::Arc(Arc {
                    plane: Plane::XY,
                    centre,
                    sweep_deg,
                }),
                at,
            )
        }
    });
}

fn surface(n: usize, mut at: Position) -> (Curve, Position) {
    at[Axis::X] += 0.2;
    at[Axis::Y] += 0.001 * (7 * n % 10) as f64;
    at[Axis::Z] += 0.001 * ((13 * n % 10) as f64 - 5.0);
    (Curve::Line, at)
}
