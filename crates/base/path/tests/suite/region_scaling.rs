//! Work grows with the size of contours, not with its square.

use bahn_path::Sense;
use bahn_path::region::{
    Contour, Effort, HatchPattern, Kind, Merge, Region, Segment, SubContour, Superposition,
};
use std::cell::Cell;
use std::convert::Infallible;
use std::f64::consts::TAU;

/// Counts steps.
#[derive(Default)]
struct Count(Cell<usize>);

impl Effort for Count {
    type Stop = Infallible;

    fn spend(&self, steps: usize) -> Result<(), Infallible> {
        self.0.set(self.0.get() + steps);
        Ok(())
    }
}

/// Ends after some steps.
struct Limit(Cell<usize>);

impl Effort for Limit {
    type Stop = ();

    fn spend(&self, steps: usize) -> Result<(), ()> {
        self.0.set(self.0.get().checked_sub(steps).ok_or(())?);
        Ok(())
    }
}

fn polar(radius: f64, turn: f64) -> [f64; 2] {
    let (sin, cos) = (TAU * turn).sin_cos();
    [radius * cos, radius * sin]
}

/// A closed curve of short lines with five waves.
fn smooth(count: usize) -> Contour {
    let at = |k: usize| {
        let turn = k as f64 / count as f64;
        polar(50.0 + 8.0 * (5.0 * TAU * turn).cos(), turn)
    };
    Contour::polygon(&(0..count).map(at).collect::<Vec<_>>())
}

/// A star, its points much nearer together than they are high.
fn star(count: usize) -> Contour {
    let at = |k: usize| {
        polar(
            if k.is_multiple_of(2) { 50.0 } else { 45.0 },
            k as f64 / count as f64,
        )
    };
    Contour::polygon(&(0..count).map(at).collect::<Vec<_>>())
}

/// Lines and arcs in turn: scallops that bulge outward.
fn scallops(count: usize) -> Contour {
    let half = count / 2;
    let start = polar(50.0, 0.0);
    (0..half)
        .fold(Contour::start_at(start), |contour, k| {
            let turn = |part: f64| (k as f64 + part) / half as f64;
            let (joint, end) = (polar(50.0, turn(0.5)), polar(50.0, turn(1.0)));
            let centre = [0.5 * (joint[0] + end[0]), 0.5 * (joint[1] + end[1])];
            contour
                .line_to(joint)
                .arc_to(centre, end, Sense::CounterClockwise)
        })
        .closed()
}

fn sub(contour: Contour, kind: Kind) -> SubContour {
    SubContour { contour, kind }
}

/// Everything a cycle computes: areas and passes.
fn cycle<E: Effort>(subcontours: &[SubContour], effort: &E) -> Result<(f64, usize), E::Stop> {
    let result = Superposition::new(subcontours, 3.0, Merge::CentrePaths, effort)?;
    let mut passes = 0;
    for area in &result.areas {
        let hatch = area
            .region
            .hatch_within(20.0, 3.0, HatchPattern::Zigzag, effort)?;
        passes += hatch.len();
    }
    Ok((result.areas.iter().map(|area| area.region.area()).sum(), passes))
}

fn islands(pocket: Contour, count: usize) -> Vec<SubContour> {
    let small = |dx: f64| {
        let at = |k: usize| {
            let [x, y] = polar(
                if k.is_multiple_of(2) { 6.0 } else { 5.0 },
                k as f64 / count as f64,
            );
            [x + dx, y]
        };
        Contour::polygon(&(0..count).map(at).collect::<Vec<_>>())
    };
    vec![
        sub(pocket, Kind::Pocket),
        sub(small(-15.0), Kind::Island),
        sub(small(15.0), Kind::Island),
    ]
}

#[test]
fn work_grows_as_the_contour_does() {
    type Shape = fn(usize) -> Vec<SubContour>;
    let shapes: [(&str, Shape); 4] = [
        ("smooth", |n| vec![sub(smooth(n), Kind::Pocket)]),
        ("star", |n| vec![sub(star(n), Kind::Pocket)]),
        ("scallops", |n| vec![sub(scallops(n), Kind::Pocket)]),
        ("islands", |n| islands(star(n / 2), n / 4)),
    ];
    for (name, shape) in shapes {
        let work = |n: usize| {
            let count = Count::default();
            let begun = std::time::Instant::now();
            let Ok((area, passes)) = cycle(&shape(n), &count);
            if std::env::var_os("BAHN_TIMES").is_some() {
                eprintln!(
                    "{name} {n}: {} steps, {:?}, {area} {passes}",
                    count.0.get(),
                    begun.elapsed()
                );
            }
            assert!(area > 0.0 && passes > 0, "{name}");
            count.0.get() as f64
        };
        let works: Vec<f64> = sizes().into_iter().map(work).collect();
        for pair in works.windows(2) {
            assert!(pair[1] / pair[0] < 2.6, "{name}: {works:?}");
        }
    }
}

fn sizes() -> Vec<usize> {
    match std::env::var("BAHN_TIMES") {
        Ok(_) => vec![2500, 5000, 10_000, 20_000],
        Err(_) => vec![1000, 2000, 4000],
    }
}

/// Arcs stay arcs: the scallops shrunk are arcs about the same centres, and nothing else in number.
#[test]
fn arcs_of_large_contours_stay_arcs() {
    let shrunk = Region::from_contour(&scallops(4000)).offset(3.0);
    let arcs = shrunk.contours()[0]
        .segments()
        .iter()
        .filter_map(Segment::radius)
        .collect::<Vec<_>>();
    assert!(arcs.len() >= 1999, "{}", arcs.len());
    let half_scallop = 50.0 * (TAU / 8000.0).sin();
    assert!(
        arcs.iter()
            .all(|r| (r - 3.0 - half_scallop).abs() < 1e-6 || (r - 3.0).abs() < 1e-6)
    );
}

/// An effort that ends is obeyed wherever it ends.
#[test]
fn every_computation_ends_with_its_effort() {
    let contours = islands(star(400), 100);
    let count = Count::default();
    let Ok(_) = cycle(&contours, &count);
    let all = count.0.get();
    for share in [0, 1, 2, 5, 9] {
        assert!(cycle(&contours, &Limit(Cell::new(all * share / 10))).is_err());
    }
    assert!(cycle(&contours, &Limit(Cell::new(all))).is_ok());
}
