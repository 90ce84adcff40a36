//! The stylus of a measuring probe on ideal surfaces [000:7882-7958].

use bahn_motion::{Scan, ScanStep, Sense};
use bahn_path::{
    Axis, MeasuringRules, ScanFault, ScanJob, ScanName, ScanPattern, ScanPoint, ScanRules, Scanned,
};

const CYCLE_S: f64 = 3e-3;
/// MP1060
const ACCELERATION_M_S2: f64 = 1.0;

/// A stylus 0.5 mm deep at 600 mm/min.
fn job() -> ScanJob {
    let measuring = MeasuringRules {
        depth_mm: 0.5,
        reversed: [false; 3],
        axes: [0, 1, 2],
        limit_mm: 2.0,
        feed_mm_min: 600.0,
        slows: false,
        window_mm: 0.4,
    };
    ScanJob {
        tool_axis: Axis::Z,
        min: [0.0, 0.0, -10.0],
        max: [20.0, 2.0, 10.0],
        shift: [0.0; 3],
        clearance_mm: 25.0,
        pattern: ScanPattern::Meander { line: Axis::X },
        travel_mm: 0.5,
        spacing_mm: 1.0,
        interval_mm: 0.5,
        stylus_radius_mm: 0.0,
        beside: [0.0; 3],
        inch: false,
        program: ScanName::default(),
        rules: ScanRules {
            measuring: Some(measuring),
            ..ScanRules::default()
        },
    }
}

/// Points, the end, its time and the deepest deflection.
type Scanning = (Vec<ScanPoint>, Scanned, f64, f64);

/// Scans a surface that pushes the tip out of it by this, and holds it to the acceleration of the axes.
fn scan(job: ScanJob, pushes: impl Fn(ScanPoint) -> ScanPoint) -> Scanning {
    let mut scan = Scan::new(job, ACCELERATION_M_S2);
    let (mut points, mut sense, mut deepest) = (Vec::new(), Sense::default(), 0.0_f64);
    sense.at = scan.position();
    let mut before = [0.0; 3];
    for cycle in 1..10_000_000 {
        match scan.cycle(CYCLE_S, &sense, 1.0) {
            ScanStep::Moves => {}
            ScanStep::Point(point) => points.push(point),
            ScanStep::Over(scanned) => return (points, scanned, f64::from(cycle) * CYCLE_S, deepest),
        }
        let at = scan.position();
        let velocity: ScanPoint = std::array::from_fn(|k| (at[k] - sense.at[k]) / CYCLE_S);
        let change = (0..3)
            .map(|k| (velocity[k] - before[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        let possible = ACCELERATION_M_S2 * 1e3 * CYCLE_S;
        assert!(change <= possible + 1e-6, "{before:?} {velocity:?} at {at:?}");
        before = velocity;
        let deflection = pushes(at);
        let depth = deflection.iter().map(|part| part * part).sum::<f64>().sqrt();
        deepest = deepest.max(depth);
        let deflected = depth > 0.0;
        sense = Sense {
            touch: (deflected && !sense.deflected).then_some(at),
            deflected,
            at,
            deflection,
        };
    }
    panic!("it never ends: {} points, at {:?}", points.len(), scan.position());
}

/// A slope of 30° in X through the origin: its normal is (-0.5, 0, cos 30°).
fn slope(at: ScanPoint) -> ScanPoint {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let below = (at[0] * sin - at[2] * cos).max(0.0);
    [-sin * below, 0.0, cos * below]
}

/// On a slope the points lie on its surface, though the tip is 0.5 mm in it, and no farther apart than P.P.INT.
#[test]
fn a_slope_is_scanned_in_contact() {
    let mut steep = job();
    steep.max[2] = 15.0;
    let (points, scanned, time_s, deepest) = scan(steep, slope);
    assert_eq!(scanned.fault, None);
    for point in &points {
        let height = point[0] * 30f64.to_radians().tan();
        assert!((point[2] - height).abs() < 0.01, "{point:?}");
    }
    for pair in points.windows(2) {
        let distance = (0..3)
            .map(|k| (pair[0][k] - pair[1][k]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(distance <= 0.51, "{pair:?}");
    }
    assert!(points.len() > 3 * 46, "{}", points.len());
    assert!((0.45..0.6).contains(&deepest), "{deepest}");
    // Three lines of 20 / cos 30° mm at 10 mm/s, and the movements in air.
    assert!((7.0..60.0).contains(&time_s), "{time_s}");
}

/// Round a stud of 8 mm radius: each level ends within the window of MP6390 about its first point, and its points lie on
/// the stud.
#[test]
fn a_contour_line_ends_in_its_window() {
    let mut job = job();
    job.min = [-15.0, -15.0, 0.0];
    job.max = [15.0, 15.0, 1.0];
    job.pattern = ScanPattern::ContourLines {
        start: [0.0, -14.0, 0.0],
        approach: (Axis::Y, 1.0),
        direction: (Axis::X, 1.0),
        time_limit_s: 60.0,
    };
    let stud = |at: ScanPoint| {
        let radius = at[0].hypot(at[1]);
        let inside = if at[2] < 5.0 { (8.0 - radius).max(0.0) } else { 0.0 };
        [at[0] / radius * inside, at[1] / radius * inside, 0.0]
    };
    let (points, scanned, _, _) = scan(job, stud);
    assert_eq!(scanned.fault, None);
    for level in [0.0, 1.0] {
        let on: Vec<&ScanPoint> = points
            .iter()
            .filter(|point| (point[2] - level).abs() < 0.01)
            .collect();
        assert!(on.len() > 95, "{} points", on.len());
        for point in &on {
            assert!((point[0].hypot(point[1]) - 8.0).abs() < 0.02, "{point:?}");
        }
        let (Some(first), Some(last)) = (on.first(), on.last()) else {
            panic!("level {level} is empty");
        };
        let off = [0, 1].map(|k| (first[k] - last[k]).abs());
        assert!(off.iter().all(|off| *off <= 0.4), "{off:?}");
        // It went round: 50 mm of circle.
        assert!(on.iter().any(|point| point[1] > 7.9));
    }
}

/// MP6362: at an inside corner, where the deflection grows, the feed falls: it takes longer and goes less deep.
#[test]
fn the_feed_falls_beside_the_path() {
    let corner = |at: ScanPoint| {
        let up = (-at[2]).max(0.0);
        let (dx, dz) = (at[0] - 10.0, at[2]);
        // A slope of 60° rises beyond X 10.
        let (sin, cos) = 60f64.to_radians().sin_cos();
        let below = (dx * sin - dz * cos).max(0.0);
        if below > up {
            [-sin * below, 0.0, cos * below]
        } else {
            [0.0, 0.0, up]
        }
    };
    let mut low = job();
    low.max = [13.0, 0.5, 10.0];
    if let Some(rules) = &mut low.rules.measuring {
        rules.feed_mm_min = 2000.0;
        rules.limit_mm = 4.0;
    }
    let fast = scan(low, corner);
    if let Some(rules) = &mut low.rules.measuring {
        rules.slows = true;
    }
    let slow = scan(low, corner);
    assert_eq!((fast.1.fault, slow.1.fault), (None, None));
    assert!(slow.2 > fast.2, "{} {}", slow.2, fast.2);
    assert!(slow.3 < fast.3 - 0.02, "{} {}", slow.3, fast.3);
}

/// A step up that is too fast for the stylus: farther than MP6330 ends the scan.
#[test]
fn too_far_a_deflection_ends_the_scan() {
    let mut fast = job();
    if let Some(rules) = &mut fast.rules.measuring {
        rules.feed_mm_min = 3000.0;
        rules.limit_mm = 0.8;
    }
    let wall = |at: ScanPoint| match at[0] > 10.0 {
        true => [10.0 - at[0], 0.0, 0.0],
        false => [0.0, 0.0, (-at[2]).max(0.0)],
    };
    let (_, scanned, _, _) = scan(fast, wall);
    assert_eq!(scanned.fault, Some(ScanFault::DeflectionExceedsMax));
}
