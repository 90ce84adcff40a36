//! Movement monitoring of a spindle that is led along a thread: it is held against what it is told as an axis is against its
//! voltage [000:5266-5287] (inferred).

use bahn_parameters::{ControlModel::Tnc415b, ParameterList};
use bahn_servo::{Encoder, Fault, GrossFault, Rotation, Spindle, Timing};

/// Counting steps of a turn: 1024 lines.
const TURN: f64 = 1024.0 * 1024.0;
/// The spindle of the gantry: time constant and acceleration of its drive, and what friction takes away.
const TIME_CONSTANT_S: f64 = 0.06;
const ACCELERATION_RPM_S: f64 = 9000.0;
const FRICTION_RPM_S: f64 = 400.0;
/// MP3410.3 of 0.01 V/ms, 9 V at 6000 rpm.
const RAMP_RPM_S: f64 = 6000.0 / 9.0 * 10.0;
/// A turn and a bit: MP1110 of 0.2 mm in a thread of 0.15 mm.
const MOST_DEG: f64 = 480.0;

/// What becomes of the drive.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Drive {
    Sound,
    Runaway,
    Reversed,
    Dead,
}

struct Bench {
    spindle: Spindle,
    timing: Timing,
    drive: Drive,
    stuck: bool,
    rpm: f64,
    turns: f64,
    shown: f64,
    angle: f64,
    speed: f64,
}

impl Bench {
    fn new() -> Bench {
        let mut list = ParameterList::reference(Tnc415b);
        for assignment in [
            "3010=6",
            "3510.0=6000",
            "3210.0=9",
            "3410.3=0.01",
            "3140=0",
            "3120=0",
        ] {
            list.assign(assignment).unwrap();
        }
        let timing = Tnc415b.timing();
        let mut bench = Bench {
            spindle: Spindle::new(list.spindle_parameters().settings, timing),
            timing,
            drive: Drive::Sound,
            stuck: false,
            rpm: 0.0,
            turns: 0.0,
            shown: 0.0,
            angle: 0.0,
            speed: 0.0,
        };
        bench.spindle.rotate(Rotation::M5);
        bench.spindle.monitor_movement(Some(MOST_DEG));
        bench
    }

    /// A contour cycle in which the path leads towards a speed, rpm, on its ramp, or at once.
    fn cycle(&mut self, towards: f64, at_once: bool) {
        let cycle_s = f64::from(self.timing.contour_us()) * 1e-6;
        let change = RAMP_RPM_S * cycle_s;
        self.speed = if at_once {
            towards
        } else {
            self.speed + (towards - self.speed).clamp(-change, change)
        };
        self.angle += self.speed * 6.0 * cycle_s;
        self.spindle.lead(self.angle);
        for _ in 0..self.timing.steps() {
            let step_s = cycle_s / f64::from(self.timing.steps());
            let volts = self.spindle.volts();
            let nominal = volts / 9.0 * 6000.0;
            let wanted = match self.drive {
                Drive::Sound => nominal,
                Drive::Runaway => 6667.0,
                Drive::Reversed => -nominal,
                Drive::Dead => 0.0,
            };
            let most = if self.drive == Drive::Dead {
                FRICTION_RPM_S
            } else {
                ACCELERATION_RPM_S
            } * step_s;
            let rate = if self.drive == Drive::Dead {
                1.0
            } else {
                step_s / TIME_CONSTANT_S
            };
            self.rpm += ((wanted - self.rpm) * rate).clamp(-most, most);
            self.turns += self.rpm / 60.0 * step_s;
            if !self.stuck {
                self.shown = self.turns;
            }
            self.spindle.measure(Encoder {
                count: (self.shown * TURN).round() as i64,
                ..Encoder::default()
            });
            self.spindle.step();
        }
    }

    fn seconds(&mut self, seconds: f64, towards: f64) {
        for _ in 0..(seconds / 0.003).round() as u32 {
            self.cycle(towards, false);
        }
    }

    /// Time until the fault is found, s, within 2 s.
    fn found_after(&mut self, towards: f64) -> Option<f64> {
        let cycles = (0..667).find(|_| {
            self.cycle(towards, false);
            self.spindle.fault().is_some()
        })?;
        assert_eq!(self.spindle.fault(), Some(Fault::Gross(GrossFault::Movement)));
        Some(f64::from(cycles + 1) * 0.003)
    }
}

/// Threads at many speeds, with reversal, and with a path that stands at once, as without feed enable: a drive that is as slow as
/// it may be is no fault.
#[test]
fn a_sound_spindle_is_no_fault() {
    for rpm in [50.0, 320.0, 1000.0, 3000.0] {
        let mut bench = Bench::new();
        for towards in [rpm, -rpm, rpm, 0.0] {
            bench.seconds(1.5, towards);
            assert_eq!(bench.spindle.fault(), None, "{rpm}");
        }
        bench.seconds(1.5, rpm);
        bench.cycle(0.0, true);
        bench.seconds(1.5, 0.0);
        assert_eq!(bench.spindle.fault(), None, "{rpm} stops at once");
    }
}

/// 320 rpm run away with 9000 rpm/s: half as fast again is passed after 160/9000 = 18 ms, and from there 480 degrees are
/// 9000·6·t²/2: 133 ms. Standing it needs the latter only. Two contour cycles are the measuring of the speed and the cycle
/// itself.
#[test]
fn a_runaway_is_found_when_it_is_beside_by_what_it_may() {
    let alone = (2.0 * MOST_DEG / (ACCELERATION_RPM_S * 6.0)).sqrt();
    for (rpm, expected) in [(320.0, 160.0 / ACCELERATION_RPM_S + alone), (0.0, alone)] {
        let mut bench = Bench::new();
        bench.seconds(1.0, rpm);
        bench.drive = Drive::Runaway;
        let found = bench.found_after(rpm).unwrap();
        assert!(
            found >= expected - 0.003 && found <= expected + 0.009,
            "{rpm}: {found} {expected}"
        );
    }
}

/// An encoder that is stuck at 320 rpm shows 0: half of it is missing, 160 rpm are 960 degrees/s, and 480 degrees take 0.5 s.
#[test]
fn a_stuck_encoder_is_found() {
    let mut bench = Bench::new();
    bench.seconds(1.0, 320.0);
    bench.stuck = true;
    let found = bench.found_after(320.0).unwrap();
    let expected = MOST_DEG / (160.0 * 6.0);
    assert!(
        found >= expected - 0.003 && found <= expected + 0.009,
        "{found} {expected}"
    );
    // From standstill it is known as soon as the spindle must have begun to turn: the drive has 0.1 s for that.
    let mut bench = Bench::new();
    bench.stuck = true;
    let found = bench.found_after(320.0).unwrap();
    assert!(
        found > expected && found < expected + 0.1 + 0.05 + 0.009,
        "{found} {expected}"
    );
}

/// A drive that turns the wrong way round, and one without power.
#[test]
fn a_drive_that_does_something_else_is_found() {
    for drive in [Drive::Reversed, Drive::Dead] {
        let mut bench = Bench::new();
        bench.seconds(1.0, 600.0);
        bench.drive = drive;
        assert!(
            bench.found_after(600.0).is_some_and(|found| found < 1.5),
            "{drive:?}"
        );
    }
}

/// Without spindle enable it runs out, and nobody monitors it; nor when the limit is taken away: no thread is cut.
#[test]
fn it_is_monitored_in_a_thread_only() {
    for enabled in [false, true] {
        let mut bench = Bench::new();
        bench.seconds(1.0, 600.0);
        bench.drive = Drive::Dead;
        bench.spindle.set_enabled(enabled);
        if enabled {
            bench.spindle.monitor_movement(None);
        }
        bench.seconds(2.0, 600.0);
        assert_eq!(bench.spindle.fault(), None, "{enabled}");
    }
}
