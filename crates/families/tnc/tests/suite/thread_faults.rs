//! Threads in which something fails: what the tool axis, its spindle and the path do then [000:6115-6139].

use crate::support::*;
use bahn_tnc::{RunState, Signal};

const PITCH: f64 = 1.5;
const RPM: f64 = 600.0;

/// A hole M10 in the middle of the table, from 3 mm above it.
fn thread() -> Rig {
    thread_at(Build::mill())
}

fn thread_at(build: Build) -> Rig {
    let program = format!(
        "TOOL CALL 3 Z S{RPM}
CYCL DEF 17.0 RIGID TAPPING
CYCL DEF 17.1 SET UP -3
CYCL DEF 17.2 DEPTH -20
CYCL DEF 17.3 PITCH +{PITCH}
L X+20 Y+20 R0 FMAX
L Z+3 FMAX M3
CYCL CALL
L X+30 FMAX"
    );
    let mut rig = build.program("1.H", &program).rig();
    rig.power_on();
    rig.seconds(0.5);
    for (axis, value) in [("X", 0.0), ("Y", 0.0), ("Z", 100.0)] {
        rig.command(&format!("datum {axis} {value}"));
    }
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(60.0, "the thread begins", |rig| {
        rig.bit("M2095") && observe(rig, "path.speed") > 0.0
    });
    rig
}

fn observe(rig: &Rig, signal: &str) -> f64 {
    rig.control.observe(&signal.parse::<Signal>().unwrap())
}

/// The spindle is told no more than what the thread asks for, 9 V at 1500 rpm in gear 1, and what its loop adds to hold it: 0.1 V.
fn assert_thread_is_reported(rig: &Rig) {
    let volts = observe(rig, "S.volts");
    assert!(
        volts.abs() < 9.0 * RPM / 1500.0 + 0.1,
        "{volts} V, {:?}",
        rig.messages()
    );
}

/// The tool is on its way out of the hole.
fn retracts(rig: &Rig) -> bool {
    observe(rig, "S.rpm") < -0.9 * RPM
}

/// The clamp of the tool goes and comes in the thread, and with it feed and spindle enable, for so long that the spindle has run out beside its axis, too: in every cycle in which the path goes on after
/// that, Z goes by the pitch for each turn. What friction leaves of the lag is no way of Z: 1 µm of rounding, and no more.
#[test]
fn after_a_lost_feed_enable_the_axis_follows_its_spindle() {
    let mut rig = thread();
    for milliseconds in [50, 3000, 90, 4000] {
        rig.until(20.0, "it goes on", |rig| observe(rig, "path.speed") > 5.0);
        rig.seconds(0.1);
        rig.input("I19", false);
        rig.seconds(f64::from(milliseconds) * 1e-3);
        rig.input("I19", true);
        for _ in 0..60 {
            rig.cycle();
            assert_thread_is_reported(&rig);
        }
    }
    let (mut z, mut angle, mut led) = (observe(&rig, "Z.nominal"), observe(&rig, "S.angle"), 0);
    while rig.bit("M2095") {
        rig.cycle();
        assert_thread_is_reported(&rig);
        let (z_now, angle_now) = (observe(&rig, "Z.nominal"), observe(&rig, "S.angle"));
        if observe(&rig, "path.speed") > 10.0 && observe(&rig, "path.block") == 8.0 {
            // Z takes the angle of the cycle before.
            led += 1;
            assert!(
                z_now != z || angle_now == angle,
                "Z stands at {z}, {:?}",
                rig.control.snapshot()
            );
        }
        (z, angle) = (z_now, angle_now);
    }
    assert!(led > 100, "{led}");
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
}

/// The speed of Z from cycle to cycle, mm/s.
struct Speed {
    z: f64,
    mm_s: f64,
}

impl Speed {
    fn of(rig: &mut Rig) -> Speed {
        let before = observe(rig, "Z.nominal");
        rig.cycle();
        let z = observe(rig, "Z.nominal");
        Speed {
            z,
            mm_s: (z - before) / 0.003,
        }
    }

    /// A cycle of 3 ms: Z gains no more than MP1060, 1.5 m/s² (4.5 mm/s), and what the grid of the encoder of the spindle makes of its
    /// speed: a count. Standing at once is no gain [000:5352].
    fn cycle(&mut self, rig: &mut Rig) {
        rig.cycle();
        let z = observe(rig, "Z.nominal");
        let mm_s = (z - self.z) / 0.003;
        let gain = match mm_s.signum() == self.mm_s.signum() {
            true => mm_s.abs() - self.mm_s.abs(),
            false => mm_s.abs(),
        };
        let count = PITCH / 4096.0 / 0.003;
        assert!(
            gain <= 1.5 * 3.0 + count,
            "{mm_s} behind {} mm/s at {z}, {:?}",
            self.mm_s,
            rig.control.snapshot()
        );
        (self.z, self.mm_s) = (z, mm_s);
    }

    fn seconds(&mut self, seconds: f64, rig: &mut Rig) {
        for _ in 0..(seconds / 0.003) as usize {
            self.cycle(rig);
        }
    }
}

/// Without feed enable, or with a loop that the PLC opens (M2546 alone, M2830 all), Z stands at once while its spindle runs on to where
/// it is led; all the more where the path has come to the end of the thread in nominal values. Then Z goes after it on its
/// ramp, behind a stop goes on with NC start, and the thread ends in the window MP7150 = 0.005 mm of where it began. M2830 takes the
/// voltage of the spindle, too: what is coupled as it stands ends at the same place.
#[test]
fn an_axis_that_stood_goes_after_its_spindle_on_its_ramp() {
    type Moment = (&'static str, fn(&Rig) -> bool);
    let moments: [Moment; 4] = [
        ("on its way in", |rig| observe(rig, "S.rpm") > 0.9 * RPM),
        ("at the bottom", |rig| {
            observe(rig, "S.rpm") > 50.0 && observe(rig, "path.speed") == 0.0
        }),
        ("on its way out", retracts),
        ("at the end", |rig| {
            observe(rig, "S.rpm") < -50.0 && observe(rig, "path.speed") == 0.0
        }),
    ];
    let events: [fn(&mut Rig, bool); 3] = [
        |rig, goes| {
            rig.event(if goes {
                "switch door open"
            } else {
                "switch door closed"
            })
        },
        |rig, goes| rig.command(if goes { "M2546=1" } else { "M2546=0" }),
        |rig, goes| rig.command(if goes { "M2830=1" } else { "M2830=0" }),
    ];
    for ((moment, reached), (number, event)) in moments
        .into_iter()
        .flat_map(|moment| events.iter().enumerate().map(move |event| (moment, event)))
    {
        let mut rig = thread();
        let top = observe(&rig, "Z.nominal");
        rig.until(20.0, moment, reached);
        let mut speed = Speed::of(&mut rig);
        event(&mut rig, true);
        speed.seconds(0.024, &mut rig);
        event(&mut rig, false);
        speed.seconds(3.0, &mut rig);
        if rig.control.snapshot().run == RunState::Interrupted {
            rig.start();
        }
        let end = rig.control.time_us() + 20_000_000;
        let mut last = speed.z;
        while observe(&rig, "path.block") == 8.0 {
            last = speed.z;
            speed.cycle(&mut rig);
            assert!(
                rig.control.time_us() < end,
                "{moment}, event {number}: {:?}",
                rig.messages()
            );
        }
        assert!(
            (last - top).abs() < 0.005 + 0.002,
            "{moment}, event {number}: {last} of {top}"
        );
        rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
        assert_eq!(rig.messages(), [""; 0], "{moment}, event {number}");
    }
}

/// The drive of Z runs away on the way out of the hole, and Z comes to stand far above it: POSITIONING ERROR. MP1720, beyond which
/// that would be gross, is wide. After CE the
/// spindle is held where it stands, and does not turn for the way that Z has gone; NC start leads Z back to where the
/// thread ends, and the program goes on.
#[test]
fn a_tool_that_ran_out_of_its_thread_goes_back_to_its_end() {
    let mut rig = thread_at(Build::mill().mp("1720.2=300"));
    rig.until(20.0, "it retracts", retracts);
    rig.seconds(0.2);
    rig.event("fault drive Z runaway");
    rig.until(5.0, "it is seen", |rig| !rig.messages().is_empty());
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["POSITIONING ERROR Z"]);
    rig.event("repair all");
    rig.seconds(5.0);
    let stands = observe(&rig, "S.angle");
    rig.command("ce");
    for _ in 0..1000 {
        rig.cycle();
        assert!(observe(&rig, "S.volts").abs() < 0.1);
        let angle = observe(&rig, "S.angle");
        assert!((angle - stands).abs() < 5.0, "{stands} {angle}");
    }
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
    assert!((observe(&rig, "S.angle") - stands).abs() < 5.0);
}

/// What is wrong with the spindle in a thread is a GROSS POSITIONING ERROR C of S: the loops open, and the tool axis is no deeper than
/// the thread until then. By the movement monitoring that is MP1110 = 0.2 mm beside what half as fast again as the thread, for
/// 0.1 s and on the ramp of 1667 rpm/s, would be, and what Z needs to stop.
#[test]
fn a_spindle_that_does_not_follow_its_command_ends_the_thread() {
    for fault in ["drive S runaway", "drive S reversed", "encoder S stuck"] {
        let mut rig = thread();
        rig.until(20.0, "it is half way", |rig| observe(rig, "Z.actual") < 403.0);
        let from = observe(&rig, "Z.actual");
        rig.event(&format!("fault {fault}"));
        rig.until(2.0, "it is seen", |rig| {
            assert_thread_is_reported(rig);
            !rig.messages().is_empty()
        });
        assert_eq!(rig.messages(), ["GROSS POSITIONING ERROR S C"], "{fault}");
        rig.seconds(1.0);
        let (v, ramp) = (RPM * PITCH / 60.0, 1667.0 * PITCH / 60.0);
        let allowed = 1.5 * v * (0.1 + 0.5 * v / ramp) + 0.2 + 0.3;
        let way = (observe(&rig, "Z.actual") - from).abs();
        assert!(way < allowed, "{fault}: {way} of {allowed}");
    }
}

/// The encoder of the spindle loses its signal in the thread: MEASURING SYSTEM DEFECTIVE A of S, by bit 5 of MP31 [000:3310-3318].
#[test]
fn an_encoder_of_the_spindle_without_signal_ends_the_thread() {
    let mut rig = thread();
    rig.seconds(0.5);
    rig.event("fault encoder S amplitude");
    rig.seconds(0.05);
    assert_eq!(rig.messages(), ["MEASURING SYSTEM S DEFECTIVE A"]);
}
