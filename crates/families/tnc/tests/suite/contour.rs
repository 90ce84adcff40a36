//! The path through the whole kernel: lag, feed pre-control, exact stops, corners.

use crate::stand::*;
use crate::support::*;
use bahn_machine::Machine;
use bahn_servo::{Commands, Measured, Plant, Step};

fn lag(build: Build) -> Build {
    build
        .mp("1390=1")
        .mp("1710.0=50")
        .mp("1720.0=60")
        .mp("1710.1=50")
        .mp("1720.1=60")
}

/// Operation with servo lag: lag = v / kv within 1 %: 2.5 mm at 5 m/min and kv 2, at the voltage of the feed:
/// 9 V at 15 000 mm/min, 3 V at 5000 [000:4881-4891].
#[test]
fn following_error() {
    for (feed, kv, expected) in [(5000, "2", 2.5), (3000, "1.5", 2.0), (600, "5", 0.12)] {
        let build = lag(bench(ACKNOWLEDGE)).mp(&format!("1810.0={kv}"));
        let mut rig = ready(build.program("1.H", &format!("L X+400 R0 F{feed}")));
        rig.start();
        rig.seconds(2.0);
        let measured = rig.control.snapshot().axes[0].lag;
        assert!(
            (measured / expected - 1.0).abs() < 0.01,
            "F{feed} kv {kv}: {measured}"
        );
        let volts = f64::from(feed) / 15_000.0 * 9.0;
        let signal = rig.control.observe(&"X.volts".parse().unwrap());
        assert!((signal / volts - 1.0).abs() < 0.01, "{signal}");
    }
}

/// A machine whose distance from a circle is looked at after each servo step.
struct Watched<'a> {
    machine: &'a mut Machine,
    centre: [f64; 2],
    radius: f64,
    worst: f64,
}

impl Plant for Watched<'_> {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.machine.exchange(step, commands, measured);
        let [x, y] = ['X', 'Y'].map(|axis| self.machine.axis(axis).map_or(f64::NAN, |axis| axis.position));
        let distance = (x - self.centre[0]).hypot(y - self.centre[1]);
        assert!(distance.is_finite(), "the machine has X and Y");
        self.worst = self.worst.max((distance - self.radius).abs());
    }
}

/// A circle with feed pre-control on the ideal plant: the contour deviation is the chord error of the contour
/// cycle, at most MP1070·T²/8: v² = r·a, chord v·T, error chord²/(8·r) = a·T²/8 = 1000·0.003²/8 = 0.001125 mm.
/// It is looked at after each servo step, within 0.1 µm.
#[test]
fn circle_with_precontrol() {
    for (radius, feed) in [(10, 9000), (25, 9000), (60, 3000)] {
        let program = format!(
            "L X+{} Y+50 R0 F3000\nCC X+100 Y+50\nC X+{} Y+50 DR+ F{feed}",
            100 + radius,
            100 + radius
        );
        let build = bench(ACKNOWLEDGE).mp("1520=10").mp("1070=1");
        let mut rig = ready(build.program("1.H", &program));
        rig.start();
        rig.until(10.0, "the circle", |rig| {
            rig.control.snapshot().block.is_some_and(|block| block.block == 3)
        });
        let (x0, y0) = (
            rig.machine_position('X') - display(&rig, 'X'),
            rig.machine_position('Y') - display(&rig, 'Y'),
        );
        let mut watched = Watched {
            machine: &mut rig.machine,
            centre: [x0 + 100.0, y0 + 50.0],
            radius: f64::from(radius),
            worst: 0.0,
        };
        while !rig.control.snapshot().ended {
            rig.control.prepare();
            rig.control.cycle(&mut watched);
        }
        let worst = watched.worst;
        let r = f64::from(radius);
        let speed = (f64::from(feed) / 60.0).min((r * 1000.0).sqrt());
        let (chord, bound) = [speed * speed / r, 1000.0]
            .map(|a| a * 0.003f64.powi(2) / 8.0)
            .into();
        assert!((worst - chord).abs() < 0.0001, "r {radius}: {worst} {chord}");
        assert!(worst <= bound, "r {radius}: {worst} > {bound}");
    }
}

/// An exact stop in operation with lag waits for the positioning window: the actual position reaches the corner
/// within MP1030 before Y moves; with M90 the corner is rounded.
#[test]
fn corners_with_lag() {
    let corner = |m90: &str| {
        let build = lag(bench(ACKNOWLEDGE)).mp("1030.0=0.01").mp("7460=10");
        let program = format!("L X+100 R0 F6000 {m90}\nL Y+100");
        let mut rig = ready(build.program("1.H", &program));
        rig.start();
        rig.until(5.0, "Y moves", |rig| nominal(rig, 'Y') > 50.01);
        100.0 - display(&rig, 'X')
    };
    let exact = corner("");
    assert!(exact.abs() <= 0.0101, "{exact}");
    let rounded = corner("M90");
    // At 6000 mm/min and kv 2 the lag is 3 mm; the path passes slower, for its change of velocity is bounded.
    assert!((0.3..3.0).contains(&rounded), "{rounded}");
}

/// MP7460: a corner of 5 degrees is passed at full speed with feed pre-control, one of 30 degrees is stopped at.
#[test]
fn angle_of_constant_feed() {
    let slowest = |y: f64| {
        let mut rig =
            ready(bench(ACKNOWLEDGE).program("1.H", &format!("L X+100 R0 F2000\nL X+150 Y+{}", 50.0 + y)));
        rig.start();
        rig.until(5.0, "near the corner", |rig| nominal(rig, 'X') > 90.0);
        let mut slowest = f64::INFINITY;
        while nominal(&rig, 'X') < 110.0 {
            rig.cycle();
            slowest = slowest.min(rig.control.snapshot().feed_mm_min);
        }
        slowest
    };
    assert!(slowest(4.0) > 0.0);
    assert_eq!(slowest(29.0), 0.0);
}

/// Reversal peaks (MP711, after M105 MP715) are put on the nominal position where an axis turns round on a
/// circle, and not on straight lines [000:3663-3714]. A negative peak lies against the new direction.
#[test]
fn reversal_peaks() {
    let peak = |program: &str| {
        let build = bench(ACKNOWLEDGE)
            .mp("1520=10")
            .mp("711.0=0.02")
            .mp("712.0=0.002")
            .mp("715.0=0.05")
            .mp("716.0=0.005")
            .mp("7440=%01011");
        let mut rig = ready(build.program("1.H", program));
        rig.start();
        rig.until(1.0, "begin", |rig| {
            rig.control.snapshot().run == bahn_tnc::RunState::Running
        });
        let signal = "X.nominal".parse().unwrap();
        let offset = rig.machine_position('X') - display(&rig, 'X');
        let mut last = 0.0;
        let mut worst: f64 = 0.0;
        while !rig.control.snapshot().ended {
            rig.cycle();
            // What the loop was told for the end of the last cycle, and where the path was then.
            let reported = rig.control.observe(&signal) - offset;
            let now = nominal(&rig, 'X');
            if (now - last).abs() < 0.01 && rig.control.snapshot().feed_mm_min > 0.0 {
                worst = worst.max((reported - now).abs() - (now - last).abs());
            }
            last = now;
        }
        worst
    };
    let circle = "CC X+50 Y+30\nC X+50 Y+50 DR- R0 F600";
    let line = "L X+60 R0 F600\nL X+50\nL X+60";
    let first = peak(circle);
    assert!((0.015..0.021).contains(&first), "{first}");
    let second = peak(&format!("L Y+50 R0 F600 M105\n{circle}"));
    assert!((0.045..0.051).contains(&second), "{second}");
    let none = peak(line);
    assert!(none < 0.005, "{none}");
}
