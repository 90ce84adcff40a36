//! TCH PROBE 5 to 7 on the machine: the axes scan what the probe touches [003:6532-6882] [000:7722-7958].

use crate::stand::*;
use crate::support::*;
use bahn_servo::Plant;
use bahn_tnc::{Digitized, RunState};

/// PLC: the probing is enabled while contact A is open.
fn plc() -> String {
    format!("{ACKNOWLEDGE}       L     M2503\n       AN    I20\n       R     M2503")
}

/// The same, and contact B moves Z up in MANUAL OPERATION (M2018).
fn plc_by_hand() -> String {
    format!(
        "{}\n       L     I21\n       A     M2018\n       = M2460\n       =N M2476",
        plc()
    )
}

/// The upper face of the box from X 80 to 120 and Y 0 to 100 is at Z 0. Three lines of 10 mm, 1 mm apart.
const FACE: &str = "TOOL CALL 0 Z S0
TCH PROBE 5.0 RANGE
TCH PROBE 5.1 PGM NAME: FACE
TCH PROBE 5.2 Z X+85 Y+20 Z-5
TCH PROBE 5.3 X+95 Y+22 Z+5
TCH PROBE 5.4 HEIGHT: +10
TCH PROBE 6.0 MEANDER
TCH PROBE 6.1 DIRECTN: X
TCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 1 P.P. INT: 1
L X+50 R0 F6000";

/// The block that scans.
const SCANS: u32 = 9;

fn rig_of_bench(build: Build, program: &str) -> Rig {
    let mut rig = build.program("1.H", program).rig();
    rig.power_on();
    rig.seconds(0.3);
    // The spindle is 100 above the end of the ball.
    rig.datum_at_machine(100.0);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.event("probe insert");
    rig
}

fn rig(program: &str) -> Rig {
    rig_of_bench(bench(&plc()), program)
}

/// What was digitized.
#[derive(Default)]
struct Kept {
    seen: u64,
    begun: u32,
    broken: u32,
    complete: u32,
    points: Vec<[f64; 3]>,
}

impl Kept {
    fn look(&mut self, rig: &Rig) {
        let news = rig.control.first().digitized();
        if news.number == self.seen {
            return;
        }
        assert_eq!(news.number, self.seen + 1, "a cycle says one thing at most");
        self.seen = news.number;
        match news.what.expect("news say something") {
            Digitized::Begins(job) => {
                assert_eq!(job.program.as_str(), "FACE");
                self.points.clear();
                self.begun += 1;
            }
            Digitized::Point(point) => self.points.push(point),
            Digitized::BrokenOff => self.broken += 1,
            Digitized::Complete => self.complete += 1,
        }
    }

    fn until(&mut self, rig: &mut Rig, seconds: f64, so: impl Fn(&Rig, &Kept) -> bool) {
        let end = rig.control.time_us() + (seconds * 1e6) as u64;
        while !so(rig, self) {
            assert!(
                rig.control.time_us() < end,
                "{:?} {:?}",
                rig.messages(),
                rig.control.snapshot()
            );
            rig.cycle();
            self.look(rig);
        }
    }

    fn until_the_end(&mut self, rig: &mut Rig) {
        self.until(rig, 300.0, |rig, _| rig.control.snapshot().ended);
    }

    /// All points lie on the face, no two of a line farther apart than the interval, and they cover the lines.
    fn covers_the_face(&self) {
        for point in &self.points {
            assert!(point[2].abs() < 0.005, "{point:?}");
            assert!((84.99..=95.01).contains(&point[0]), "{point:?}");
        }
        for pair in self.points.windows(2) {
            let way = (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]);
            assert!(way <= 1.05, "{pair:?}");
        }
        for line in [20.0, 21.0, 22.0] {
            let on = self.points.iter().filter(|point| (point[1] - line).abs() < 0.01);
            let (low, high) = on.fold((f64::MAX, f64::MIN), |(low, high), point| {
                (low.min(point[0]), high.max(point[0]))
            });
            assert!(low < 86.0 && high > 94.0, "Y {line}: {low} to {high}");
        }
        assert!(self.points.len() >= 33, "{}", self.points.len());
    }
}

/// M2503 waits for the PLC; then the stylus scans line by line. At the end it stands at clearance height, and the program
/// goes on.
#[test]
fn a_face_is_digitized() {
    let mut rig = rig(FACE);
    let mut kept = Kept::default();
    rig.event("key A press");
    rig.start();
    kept.until(&mut rig, 20.0, |rig, _| rig.bit("M2503"));
    rig.seconds(1.0);
    assert!(rig.bit("M2503") && kept.points.is_empty());
    near(display(&rig, 'Z'), 10.0);
    rig.event("key A release");
    kept.until(&mut rig, 20.0, |rig, _| rig.bit("M2025"));
    kept.until_the_end(&mut rig);
    assert!(rig.bit("M2026"));
    assert_eq!((kept.begun, kept.complete, kept.broken), (1, 1, 0));
    kept.covers_the_face();
    near(display(&rig, 'Z'), 10.0);
    near(display(&rig, 'X'), 50.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// NC stop holds the stylus where it is, NC start goes on; with half the override it takes longer.
#[test]
fn a_scan_is_stopped_and_slowed_down() {
    let time = |percent: u32| {
        let mut rig = rig(FACE);
        rig.event(&format!("override feed {percent}"));
        let mut kept = Kept::default();
        rig.start();
        kept.until(&mut rig, 60.0, |_, kept| kept.points.len() == 5);
        let begun = rig.control.time_us();
        rig.event("key NC_STOP tap");
        rig.seconds(0.4);
        let at = ['X', 'Y', 'Z'].map(|axis| nominal(&rig, axis));
        rig.seconds(0.5);
        assert_eq!(at, ['X', 'Y', 'Z'].map(|axis| nominal(&rig, axis)));
        assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
        rig.start();
        kept.until_the_end(&mut rig);
        assert_eq!((kept.begun, kept.complete), (1, 1));
        kept.covers_the_face();
        rig.control.time_us() - begun
    };
    let (full, half) = (time(100), time(50));
    assert!(half as f64 > 1.5 * full as f64, "{half} {full}");
}

/// A probe that is not ready any more ends the scan with its message; a repaired one begins anew with the next start.
#[test]
fn the_probe_fails_in_the_middle() {
    let mut rig = rig(FACE);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |_, kept| kept.points.len() == 5);
    rig.event("fault probe not-ready");
    kept.until(&mut rig, 10.0, |rig, _| !rig.messages().is_empty());
    assert!(
        rig.messages()[0].starts_with("PROBE SYSTEM NOT READY"),
        "{:?}",
        rig.messages()
    );
    let block = rig.control.shown()[0].block.map(|block| block.block);
    assert_eq!((kept.broken, kept.complete, block), (1, 0, Some(SCANS)));
    rig.seconds(0.1);
    assert!(rig.bit("M2022") && rig.bit("M2026") && !rig.bit("M2503"));
    rig.event("repair probe");
    rig.command("ce");
    rig.start();
    kept.until_the_end(&mut rig);
    assert_eq!((kept.begun, kept.complete), (2, 1));
    kept.covers_the_face();
}

/// A battery that is low shows in M2027 at once, in the message when the probe reaches the end of a line, at X 95
/// [003:8043-8045]; it is said once, and scanned with.
#[test]
fn a_low_battery_is_said_at_the_end_of_a_line() {
    let mut rig = rig(FACE);
    let mut kept = Kept::default();
    rig.event("fault probe battery");
    rig.start();
    kept.until(&mut rig, 60.0, |_, kept| kept.points.len() == 5);
    assert!(rig.bit("M2027"));
    assert_eq!(rig.messages(), [""; 0]);
    kept.until(&mut rig, 60.0, |rig, _| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["EXCHANGE TOUCH PROBE BATTERY"]);
    within(display(&rig, 'X'), 95.0, 0.05);
    within(display(&rig, 'Y'), 20.0, 0.01);
    rig.command("ce");
    kept.until_the_end(&mut rig);
    assert_eq!((rig.messages().len(), kept.complete), (0, 1));
    kept.covers_the_face();
}

/// A box of 10 by 10 mm, and a round stud of 5 mm radius, both about X 100 and Y 50 with the upper face at Z 0.
const BOX: &str = "[[probe.solid]]\nmin = [95, 45, -50]\nmax = [105, 55, 0]\n";
const STUD: &str = "[[probe.ring]]\ncentre = [100, 50]\nradii = [0, 5]\nz = [-50, 0]\n";

/// Three levels at Z -6, -5 and -4: the ball of 2 mm stands below the upper edge.
const LEVELS: &str = "TOOL CALL 0 Z S0
TCH PROBE 5.0 RANGE
TCH PROBE 5.1 PGM NAME: FACE
TCH PROBE 5.2 Z X+85 Y+35 Z-6
TCH PROBE 5.3 X+115 Y+65 Z-4
TCH PROBE 5.4 HEIGHT: +10
TCH PROBE 7.0 CONTOUR LINES
TCH PROBE 7.1 TIME: 0 X+100 Y+38
TCH PROBE 7.2 ORDER Y+/X+
TCH PROBE 7.3 TRAVEL: 0.5 L.SPAC: +1 P.P. INT: 1
L X+90 R0 F6000";

/// The bench with something else on its table.
fn bench_on(solid: &str) -> Build {
    bench(&plc()).plant(
        "[[probe.solid]]\nmin = [80, 0, -50]\nmax = [120, 100, 0]\n",
        solid,
    )
}

/// Each level is orbited once, with points that lie no farther apart than the interval; the tip keeps the radius of the
/// ball from the model, and the orbit ends within the window of its first point.
fn orbits(points: &[[f64; 3]], distance: impl Fn(f64, f64) -> f64, orbit_mm: f64, closed_mm: f64) {
    for level in [-6.0, -5.0, -4.0] {
        let on: Vec<_> = points
            .iter()
            .filter(|point| (point[2] - level).abs() < 0.02)
            .collect();
        let (Some(first), Some(last)) = (on.first(), on.last()) else {
            panic!("no point at Z {level}: {points:?}")
        };
        let apart = |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(apart(first, last) <= closed_mm, "Z {level}: {first:?} {last:?}");
        let mut way = 0.0;
        for pair in on.windows(2) {
            let step = apart(pair[0], pair[1]);
            assert!(step <= 1.05, "{pair:?}");
            way += step;
        }
        assert!((way - orbit_mm).abs() < 0.05 * orbit_mm, "Z {level}: {way} mm");
        for point in on {
            let from = distance(point[0], point[1]);
            assert!((from - 2.0).abs() < 0.03, "{point:?}: {from}");
        }
    }
    let stray = |point: &&[f64; 3]| {
        [-6.0, -5.0, -4.0]
            .iter()
            .all(|level| (point[2] - level).abs() >= 0.02)
    };
    assert_eq!(points.iter().find(stray), None);
}

/// TCH PROBE 7 with a TS 120 around a box: four sides of 10 mm and four quarters of a circle of 2 mm. It ends at the starting
/// point, at clearance height, and the program goes on.
#[test]
fn a_box_is_digitized_in_contour_lines() {
    let mut rig = rig_of_bench(bench_on(BOX), LEVELS);
    let mut kept = Kept::default();
    rig.start();
    kept.until_the_end(&mut rig);
    assert_eq!(rig.messages(), [""; 0]);
    assert_eq!((kept.begun, kept.complete, kept.broken), (1, 1, 0));
    let beside = |x: f64, y: f64| {
        ((x - 100.0).abs() - 5.0)
            .max(0.0)
            .hypot(((y - 50.0).abs() - 5.0).max(0.0))
    };
    orbits(&kept.points, beside, 40.0 + 4.0 * std::f64::consts::PI, 0.25);
    near(display(&rig, 'X'), 90.0);
    near(display(&rig, 'Y'), 38.0);
    near(display(&rig, 'Z'), 10.0);
}

/// TCH PROBE 7 with a TM 110 around a round stud: the tip orbits at 7 mm and ends within MP6390 of its first point.
#[test]
fn a_stud_is_digitized_in_contour_lines_with_a_measuring_probe() {
    let mut rig = measuring_with(bench_on(STUD), LEVELS, "", &[]);
    let mut kept = Kept::default();
    rig.start();
    kept.until_the_end(&mut rig);
    assert_eq!(rig.messages(), [""; 0]);
    assert_eq!((kept.begun, kept.complete, kept.broken), (1, 1, 0));
    let beside = |x: f64, y: f64| (x - 100.0).hypot(y - 50.0) - 5.0;
    orbits(&kept.points, beside, 14.0 * std::f64::consts::PI, 0.3);
    near(display(&rig, 'X'), 90.0);
    near(display(&rig, 'Z'), 10.0);
}

/// An orbit of 53 mm takes longer than 4 s: TIME LIMIT EXCEEDED, and the cycle is broken off. A starting point outside the
/// range is said before an axis moves: START POSITION INCORRECT.
#[test]
fn an_orbit_that_takes_too_long_or_begins_outside() {
    let mut rig = rig_of_bench(bench_on(BOX), &LEVELS.replace("TIME: 0", "TIME: 4"));
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |rig, _| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["TIME LIMIT EXCEEDED program 1.H block 10"]);
    assert_eq!((kept.broken, kept.complete), (1, 0));
    assert!(kept.points.len() > 5, "{:?}", kept.points);

    let mut rig = rig_of_bench(bench_on(BOX), &LEVELS.replace("X+100 Y+38", "X+120 Y+38"));
    let before = ['X', 'Y', 'Z'].map(|axis| nominal(&rig, axis));
    rig.start();
    rig.until(20.0, "the message", |rig| !rig.messages().is_empty());
    assert_eq!(
        rig.messages(),
        ["START POSITION INCORRECT program 1.H block 10: the starting point lies outside of the range"]
    );
    assert_eq!(before, ['X', 'Y', 'Z'].map(|axis| nominal(&rig, axis)));
    assert_eq!(rig.control.first().digitized().number, 0);
}

/// The clearance height lies in the box: the stylus is deflected before it may be.
#[test]
fn the_stylus_is_deflected_at_the_start() {
    let deep = FACE
        .replace("Z-5", "Z-20")
        .replace("Z+5", "Z-10")
        .replace("+10", "-5");
    let mut rig = rig(&deep);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |rig, _| !rig.messages().is_empty());
    assert!(
        rig.messages()[0].starts_with("STYLUS ALREADY IN CONTACT"),
        "{:?}",
        rig.messages()
    );
    rig.seconds(0.1);
    assert!(rig.bit("M2023"));
    kept.look(&rig);
    assert_eq!((kept.complete, kept.points.len()), (0, 0));
}

/// The greatest point of the range lies behind the software limit of X: FAULTY RANGE DATA at the block, and no axis moves
/// [003:8049].
#[test]
fn the_range_leaves_the_software_limits() {
    let mut rig = rig_of_bench(bench(&plc()).mp("910.0=94"), FACE);
    let before = ['X', 'Y', 'Z'].map(|axis| nominal(&rig, axis));
    rig.start();
    rig.until(20.0, "the message", |rig| !rig.messages().is_empty());
    let message =
        format!("FAULTY RANGE DATA program 1.H block {SCANS}: the range leaves the traverse range of X");
    assert_eq!(rig.messages(), [message]);
    assert_eq!(before, ['X', 'Y', 'Z'].map(|axis| nominal(&rig, axis)));
}

/// Nothing lies below the range of X-70: the stylus ends at MIN. A wall beside the face leaves the range.
#[test]
fn the_surface_is_not_where_it_is_to_be() {
    for (program, message) in [
        (
            FACE.replace("X+85", "X+40").replace("X+95", "X+60"),
            "TOUCH POINT INACCESSIBLE",
        ),
        (FACE.replace("X+95", "X+130"), "RANGE EXCEEDED"),
    ] {
        let mut rig = rig(&program);
        let mut kept = Kept::default();
        rig.start();
        kept.until(&mut rig, 120.0, |rig, _| !rig.messages().is_empty());
        assert_eq!(rig.messages(), [format!("{message} program 1.H block {SCANS}")]);
        assert_eq!((kept.broken, kept.complete), (1, 0));
    }
}

/// EMERGENCY STOP in the middle: the axes stand, and after it the scan goes on without a point that is off the face.
#[test]
fn emergency_stop_in_the_middle() {
    let mut rig = rig(FACE);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |_, kept| kept.points.len() == 8);
    rig.event("emergency press");
    rig.seconds(0.5);
    kept.look(&rig);
    let points = kept.points.len();
    rig.seconds(1.0);
    kept.look(&rig);
    assert_eq!(kept.points.len(), points, "nothing is scanned");
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    rig.event("emergency release");
    rig.seconds(0.5);
    for _ in 0..3 {
        rig.control.command("ce".parse().unwrap());
        rig.seconds(0.2);
    }
    rig.start();
    kept.until_the_end(&mut rig);
    assert_eq!(kept.complete, 1);
    kept.covers_the_face();
}

/// The drive of X fails on a line: POSITIONING ERROR. CE takes X over where it stands, and it waits there for NC start, which
/// leads it back to where the scan has left it; then the scan goes on, and no point of it lies elsewhere.
#[test]
fn positioning_error_in_the_middle() {
    // Without movement monitoring the lag grows beyond MP1710 or MP1720, and CE clears it [000:5194-5198].
    let unwatched = [
        "1140.0=10",
        "1110.0=30",
        "1710.0=3",
        "1720.0=20",
        "1410.0=3",
        "1420.0=20",
    ];
    let build = unwatched.iter().fold(bench(&plc()), |build, mp| build.mp(mp));
    let mut rig = rig_of_bench(build, FACE);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |rig, kept| {
        kept.points.len() == 3 && rig.control.observe(&"X.speed".parse().expect("a signal")).abs() > 100.0
    });
    rig.event("fault drive X dead");
    kept.until(&mut rig, 10.0, |rig, _| {
        rig.messages().contains(&"POSITIONING ERROR X".to_owned())
    });
    // What X touched as it ran on without its drive is where it was, beyond the range in the end.
    let ran_on = kept.points.len();
    rig.event("repair all");
    rig.seconds(0.5);
    rig.command("ce");
    rig.cycle();
    let stood = ['X', 'Y', 'Z'].map(|letter| nominal(&rig, letter));
    for _ in 0..300 {
        rig.cycle();
        kept.look(&rig);
        for (letter, stood) in ['X', 'Y', 'Z'].into_iter().zip(stood) {
            let now = nominal(&rig, letter);
            assert!(
                (now - stood).abs() < 1e-9,
                "{letter} goes from {stood} to {now} with CE"
            );
        }
    }
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    rig.start();
    kept.until_the_end(&mut rig);
    assert_eq!(kept.complete, 1);
    assert!(
        kept.points.iter().all(|point| point[2].abs() < 0.005),
        "{:?}",
        kept.points
    );
    for [x, _, z] in kept.points.iter().skip(ran_on) {
        assert!((84.99..=95.01).contains(x) && z.abs() < 0.005, "{x} {z}");
    }
    let last = kept.points.iter().filter(|point| (point[1] - 22.0).abs() < 0.01);
    assert!(last.count() > 10, "{:?}", kept.points);
}

/// A TM 110 on the bench: it stays deflected by MP6310 and scans with MP6360 along the face.
fn measuring(mounting: &str, parameters: &[&str]) -> Rig {
    let reads = "\n       PS    K+100\n       PS    K+5\n       CM    9041\n";
    measuring_with(bench(&(plc() + reads)), FACE, mounting, parameters)
}

fn measuring_with(build: Build, program: &str, mounting: &str, parameters: &[&str]) -> Rig {
    let build = build.plant(
        "radius = 2\n",
        &format!("radius = 2\nmeasuring = true\n{mounting}\n"),
    );
    let usual = [
        "6200=1",
        "6310=0.5",
        "6330=2",
        "6350=200",
        "6360=600",
        "6361=3000",
        "6390=0.2",
    ];
    let build = usual
        .iter()
        .chain(parameters)
        .fold(build, |build, mp| build.mp(mp));
    rig_of_bench(build, program)
}

/// MP6200 = 1; MP6310 depth, MP6320 and MP6322 mounting, MP6350, MP6360 and MP6361 feeds: 32 mm of surface at
/// 600 mm/min are scanned in less than 10 s, with the stylus 0.5 mm deep; the points are those of the face.
#[test]
fn a_measuring_probe_stays_deflected() {
    for (mounting, parameters) in [
        ("", &[][..]),
        // Its X counts along -Y of the machine, its Y along Z, its Z along X.
        (
            "mounting = [-2, 3, 1]",
            &["6320=%010", "6322.0=2", "6322.1=0", "6322.2=1"],
        ),
    ] {
        let mut rig = measuring(mounting, parameters);
        let mut kept = Kept::default();
        rig.start();
        kept.until(&mut rig, 60.0, |_, kept| kept.points.len() == 3);
        let begun = rig.control.time_us();
        let mut depth = Vec::new();
        let end = begun + 60_000_000;
        while kept.points.len() < 10 {
            assert!(rig.control.time_us() < end, "{:?}", rig.messages());
            rig.cycle();
            kept.look(&rig);
            depth.push(-display(&rig, 'Z'));
        }
        // Module 9041 tells the PLC the deflection along the axes of the machine [000:15004].
        let [x, y, z] = ["D100", "D104", "D108"].map(|word| f64::from(rig.number(word)) / 10_000.0);
        assert!(
            x.abs() < 0.1 && y.abs() < 0.1 && (0.3..0.6).contains(&z),
            "{x} {y} {z}"
        );
        let least = depth.iter().copied().fold(f64::MAX, f64::min);
        assert!(
            least > 0.3 && depth.iter().all(|depth| *depth < 0.6),
            "{least} {depth:?}"
        );
        // 7 mm at 10 mm/s.
        let time_s = (rig.control.time_us() - begun) as f64 * 1e-6;
        assert!((time_s - 0.7).abs() < 0.1, "{time_s}");
        kept.until_the_end(&mut rig);
        assert_eq!((kept.begun, kept.complete), (1, 1));
        kept.covers_the_face();
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// Deflected farther than MP6330: a flashing message, and the axes stand [000:7917].
#[test]
fn a_stylus_that_is_deflected_too_far_stops_the_machine() {
    let mut rig = measuring("", &["6330=0.4"]);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |rig, _| !rig.messages().is_empty());
    assert!(
        rig.messages()[0].starts_with("STYLUS DEFLECTION EXCEEDS MAX"),
        "{:?}",
        rig.messages()
    );
    assert!(rig.control.shown()[0].flashing);
    rig.seconds(1.0);
    let deepest = -display(&rig, 'Z');
    assert!((0.38..0.6).contains(&deepest), "{deepest}");
    kept.look(&rig);
    assert_eq!(kept.complete, 0);
}

/// With the wrong counting direction (MP6320) the stylus is led off the face: it gets no farther than MP6330 beside the
/// range.
#[test]
fn a_probe_that_counts_the_wrong_way_is_stopped() {
    let mut rig = measuring("", &["6320=%100"]);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |rig, _| !rig.messages().is_empty());
    assert_eq!(
        rig.messages(),
        [format!("RANGE EXCEEDED program 1.H block {SCANS}")]
    );
    assert!(display(&rig, 'X') > 85.0 - 2.0 - 0.5, "{}", display(&rig, 'X'));
    assert_eq!(kept.complete, 0);
}

/// Once the run is on its way no cycle of a scan allocates.
#[test]
fn no_cycle_of_a_scan_allocates() {
    let mut rig = rig(FACE);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |_, kept| kept.begun == 1);
    let mut cycles = 0u32;
    while kept.complete == 0 {
        rig.control.prepare();
        let (control, machine) = (&mut rig.control, &mut rig.machine);
        let allocated = allocation_counter::measure(|| control.cycle(machine as &mut dyn Plant));
        assert_eq!(
            allocated.count_total,
            0,
            "cycle {cycles}: {:?}",
            rig.control.snapshot()
        );
        kept.look(&rig);
        cycles += 1;
        assert!(cycles < 100_000, "{:?}", rig.messages());
    }
    kept.covers_the_face();
}

fn within(actual: f64, expected: f64, window: f64) {
    assert!((actual - expected).abs() <= window, "{actual} is not {expected}");
}

/// In the second of three lines the scan is interrupted, and the operator leads the stylus away: RESTORE POSITION and NC start bring it back to
/// where it was, not to where the scan began, and the lines are completed.
#[test]
fn an_interrupted_scan_goes_on_where_it_was() {
    let mut rig = rig_of_bench(bench(&plc_by_hand()).mp("7680=%0000010"), FACE);
    let mut kept = Kept::default();
    rig.start();
    kept.until(&mut rig, 60.0, |_, kept| {
        let last = kept.points.last();
        last.is_some_and(|point| (20.9..21.1).contains(&point[1]) && point[0] < 91.0)
    });
    rig.event("key NC_STOP tap");
    kept.until(&mut rig, 1.0, |rig, _| {
        rig.control.snapshot().run == RunState::Interrupted
    });
    rig.seconds(0.5);
    let place = |rig: &Rig| ['X', 'Y', 'Z'].map(|letter| nominal(rig, letter));
    let left = place(&rig);
    rig.command("manual-operation");
    rig.event("key B press");
    rig.seconds(0.5);
    rig.event("key B release");
    rig.seconds(0.5);
    assert!(nominal(&rig, 'Z') > left[2] + 5.0, "{left:?} {:?}", place(&rig));
    rig.command("restore-position");
    rig.start();
    rig.seconds(4.0);
    assert_eq!(place(&rig), left);
    rig.start();
    kept.until_the_end(&mut rig);
    kept.covers_the_face();
    assert_eq!((kept.begun, kept.complete, kept.broken), (1, 1, 0));
    assert_eq!(rig.messages(), [""; 0]);
}
