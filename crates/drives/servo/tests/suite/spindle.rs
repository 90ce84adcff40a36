//! The main spindle [000:5438-5945].

use bahn_parameters::{
    ControlModel::{Tnc407, Tnc415b},
    ParameterList,
};
use bahn_servo::{Encoder, Ramp, Rotation, Spindle, Timing, Way};

/// Counting steps of a turn: 1024 lines.
const TURN: f64 = 1024.0 * 1024.0;

/// A spindle whose speed is its voltage, with one reference mark.
struct Bench {
    spindle: Spindle,
    timing: Timing,
    rpm_per_volt: f64,
    turns: f64,
    mark_turns: f64,
    offset_volts: f64,
    counts: f64,
}

impl Bench {
    fn new(assignments: &[&str]) -> Bench {
        let mut list = ParameterList::reference(Tnc415b);
        let quick = [
            "3410.0=0",
            "3410.1=0.05",
            "3120=0",
            "3420=10",
            "3520.1=100",
            "3520.0=50",
        ];
        for assignment in quick.iter().chain(assignments) {
            list.assign(assignment).unwrap();
        }
        for index in 0..8 {
            list.set(3440, index, 1.0).unwrap();
        }
        let settings = list.spindle_parameters().settings;
        let timing = Tnc415b.timing();
        let counts = if settings.counts_negative { -TURN } else { TURN };
        Bench {
            spindle: Spindle::new(settings, timing),
            timing,
            rpm_per_volt: settings.gears[0].rated_rpm / settings.gears[0].rated_volts,
            turns: 0.0,
            mark_turns: 0.25,
            offset_volts: 0.0,
            counts,
        }
    }

    fn step(&mut self) -> f64 {
        let volts = self.spindle.volts() + self.offset_volts;
        let way = volts * self.rpm_per_volt * f64::from(self.timing.step_us()) / 60e6;
        let (before, after) = (self.turns, self.turns + way);
        self.turns = after;
        let mark = (after.max(before) - self.mark_turns).floor();
        let crossed = mark > (after.min(before) - self.mark_turns).floor();
        self.spindle.measure(Encoder {
            count: (after * self.counts).round() as i64,
            mark: crossed.then_some(((mark + self.mark_turns) * self.counts).round() as i64),
            ..Encoder::default()
        });
        self.spindle.step()
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / 0.0006).round() as u32 {
            self.step();
        }
    }

    /// A speed in gear range 1, reached at once, then some turns.
    fn turning(&mut self, rpm: f64, rotation: Rotation) {
        self.spindle.set_speed(rpm, 0);
        self.spindle.rotate(rotation);
        self.run(1.0);
    }

    /// Leads it on by so many volts more in each millisecond, for contour cycles, from where it is held; the
    /// greatest change of the voltage in a servo step.
    fn lead(&mut self, volts_ms: f64, cycles: u32) -> f64 {
        let cycle_ms = f64::from(self.timing.contour_us()) * 1e-3;
        // V to degrees/ms.
        let rate = volts_ms * self.rpm_per_volt * 6e-3;
        let from = self.spindle.held_deg();
        let mut greatest = 0.0f64;
        for k in 1..=cycles {
            let t = f64::from(k) * cycle_ms;
            self.spindle.lead(from + 0.5 * rate * t * t);
            for _ in 0..self.timing.steps() {
                let before = self.spindle.volts();
                let now = self.step();
                greatest = greatest.max((now - before).abs());
            }
        }
        greatest
    }

    /// Leads it up to half of the greatest speed along 0.1 V/ms, and down to standstill; the greatest change of the
    /// voltage in a servo step.
    fn thread(&mut self) -> f64 {
        let cycle_ms = f64::from(self.timing.contour_us()) * 1e-3;
        let rate = 0.1 * self.rpm_per_volt * 6e-3;
        let from = self.spindle.held_deg();
        let ramp = 15.0 * cycle_ms;
        let angle = |t: f64| {
            let left = (2.0 * ramp - t).max(0.0);
            if t < ramp {
                0.5 * rate * t * t
            } else {
                rate * ramp * ramp - 0.5 * rate * left * left
            }
        };
        let mut greatest = 0.0f64;
        for k in 1..=100 {
            self.spindle.lead(from + angle(f64::from(k) * cycle_ms));
            for _ in 0..self.timing.steps() {
                let before = self.spindle.volts();
                let now = self.step();
                greatest = greatest.max((now - before).abs());
            }
        }
        greatest
    }

    /// Angle of the table of the test from the reference mark, degrees.
    fn angle(&self) -> f64 {
        ((self.turns - self.mark_turns) * 360.0).rem_euclid(360.0)
    }
}

/// Gear I 1500 rpm at 6 V, gear II 3000 rpm at 8 V up to 3375 rpm, override 50 to 125 %, at least 1 V
/// [000:5596-5610].
const DIAGRAM: &[&str] = &[
    "3510.0=1500",
    "3210.0=6",
    "3515.0=1875",
    "3510.1=3000",
    "3210.1=8",
    "3515.1=3375",
    "3310.0=125",
    "3310.1=50",
    "3240.1=1",
];

#[test]
fn the_spindle_diagram_of_the_manual() {
    for (speed, percent, gear, rpm, volts) in [
        (1500.0, 100.0, 0, 1500.0, 6.0),
        (1500.0, 125.0, 0, 1875.0, 7.5),
        (1501.0, 100.0, 1, 1501.0, 4.002_667),
        (3000.0, 100.0, 1, 3000.0, 8.0),
        (3000.0, 125.0, 1, 3375.0, 9.0),
        (3000.0, 150.0, 1, 3375.0, 9.0),
        (3000.0, 50.0, 1, 1500.0, 4.0),
        (3000.0, 10.0, 1, 1500.0, 4.0),
        // 100/1500 · 6 V = 0.4 V, raised to the least voltage.
        (100.0, 100.0, 0, 100.0, 1.0),
        (0.0, 100.0, 0, 0.0, 0.0),
    ] {
        let mut bench = Bench::new(DIAGRAM);
        assert_eq!(bench.spindle.gear_for(speed), Some(gear), "S{speed}");
        bench.spindle.set_speed(speed, gear);
        bench.spindle.set_override(percent);
        bench.spindle.rotate(Rotation::M3);
        let put_out = bench.step();
        assert!((put_out - volts).abs() < 1e-4, "S{speed} {percent} %: {put_out}");
        assert!(
            (bench.spindle.nominal_rpm() - rpm).abs() < 1e-9,
            "S{speed} {percent} %"
        );
        assert_eq!(bench.spindle.at_zero(), volts == 0.0);
    }
}

#[test]
fn speeds_that_no_gear_has_are_wrong() {
    let bench = Bench::new(DIAGRAM);
    assert_eq!(bench.spindle.gear_for(3000.001), None);
    assert_eq!(bench.spindle.gear_for(-1.0), None);
    assert_eq!(bench.spindle.gear_for(f64::NAN), None);
    assert_eq!(bench.spindle.gear_for(0.0), Some(0));
    assert_eq!(
        Bench::new(&[DIAGRAM, &["3120=1"]].concat()).spindle.gear_for(0.0),
        None
    );
}

#[test]
fn the_override_down_to_0_stops_the_spindle() {
    let mut bench = Bench::new(&[DIAGRAM, &["3310.1=0"]].concat());
    bench.turning(1000.0, Rotation::M3);
    bench.spindle.set_override(0.0);
    bench.step();
    assert!(bench.spindle.at_zero());
}

#[test]
fn mp3130_and_m2489_are_the_polarity() {
    for (entry, m3, m4) in [
        ("3130=0", 6.0, -6.0),
        ("3130=1", -6.0, 6.0),
        ("3130=2", 6.0, 6.0),
        ("3130=3", -6.0, -6.0),
    ] {
        for (inverted, sign) in [(false, 1.0), (true, -1.0)] {
            let mut bench = Bench::new(&[DIAGRAM, &[entry]].concat());
            bench.spindle.set_inverted(inverted);
            bench.spindle.set_speed(1500.0, 0);
            for (rotation, volts) in [(Rotation::M3, m3), (Rotation::M4, m4), (Rotation::M5, 0.0)] {
                bench.spindle.rotate(rotation);
                let put_out = bench.step();
                assert!(
                    (put_out - sign * volts).abs() < 1e-4,
                    "{entry} {rotation:?} {inverted}"
                );
            }
        }
    }
}

#[test]
fn the_voltage_follows_its_ramp() {
    // 6 V at 0.01 V/ms are 600 ms: 1000 steps of 0.6 ms.
    let mut bench = Bench::new(&[DIAGRAM, &["3410.0=0.01", "3410.2=0.02"]].concat());
    bench.spindle.set_speed(1500.0, 0);
    let mut steps = |rotation, ramp| {
        bench.spindle.set_ramp(ramp);
        bench.spindle.rotate(rotation);
        let mut steps = 0;
        loop {
            bench.step();
            steps += 1;
            if !bench.spindle.on_ramp() {
                return steps;
            }
            assert!(steps < 10_000);
        }
    };
    let near = |steps: u32, expected: u32| assert!(steps.abs_diff(expected) <= 1, "{steps} {expected}");
    near(steps(Rotation::M3, Ramp::Normal), 1000);
    near(steps(Rotation::M5, Ramp::Tapping), 500);
    near(steps(Rotation::M4, Ramp::Tapping), 500);
    // Through 0 to the other side: 12 V.
    near(steps(Rotation::M3, Ramp::Normal), 2000);
    near(steps(Rotation::M5, Ramp::Volts(0.005)), 2000);
    assert!(bench.spindle.at_zero() && !bench.spindle.on_ramp());
}

#[test]
fn without_enable_the_output_is_0_volts_at_once() {
    let mut bench = Bench::new(&[DIAGRAM, &["3410.0=0.01"]].concat());
    bench.turning(1500.0, Rotation::M3);
    bench.spindle.set_enabled(false);
    assert_eq!(bench.step(), 0.0);
    bench.spindle.set_enabled(true);
    assert!(
        (bench.step() - 0.006).abs() < 2e-4,
        "and it starts along its ramp"
    );
}

#[test]
fn the_gear_change_jogs_to_and_fro() {
    let mut bench = Bench::new(&[DIAGRAM, &["3240.2=0.5"]].concat());
    let mut jog = |rotation| {
        bench.spindle.jog(rotation);
        (bench.step() * 1e3).round()
    };
    assert_eq!(
        [jog(Rotation::M4), jog(Rotation::M3), jog(Rotation::M5)],
        [-500.0, 500.0, 0.0]
    );
}

#[test]
fn the_actual_speed_is_that_of_the_encoder() {
    for counting in ["3140=0", "3140=1"] {
        let mut bench = Bench::new(&[DIAGRAM, &[counting]].concat());
        bench.turning(1200.0, Rotation::M3);
        assert!((bench.spindle.actual_rpm() - 1200.0).abs() < 0.5, "{counting}");
        bench.turning(600.0, Rotation::M4);
        assert!((bench.spindle.actual_rpm() + 600.0).abs() < 0.5, "{counting}");
        let turned = bench.turns * 360.0;
        assert!(
            (bench.spindle.turned_deg() - turned).abs() <= STEP_DEG,
            "{counting}"
        );
    }
}

/// A step of its encoder: 1024 lines, evaluated fourfold [000:5877] [001:450-454], degrees.
const STEP_DEG: f64 = 360.0 / 4096.0;

/// At whole steps of 360/4096 degree the control sees the angle; what lies between is the step below, counted up.
#[test]
fn the_encoder_is_evaluated_fourfold() {
    let mut bench = Bench::new(&[]);
    for (counts, steps) in [
        (0, 0),
        (255, 0),
        (256, 1),
        (1023, 3),
        (1024, 4),
        (-1, -1),
        (-256, -1),
        (-257, -2),
    ] {
        bench.spindle.measure(Encoder {
            count: counts,
            mark: (counts == 1023).then_some(512),
            ..Encoder::default()
        });
        assert_eq!(
            bench.spindle.turned_deg(),
            f64::from(steps) * STEP_DEG,
            "{counts}"
        );
    }
    // The mark was crossed at step 2, and it stands at step -2.
    assert_eq!(bench.spindle.angle_deg(), Some(360.0 - 4.0 * STEP_DEG));
}

/// A step in a cycle is 60 / 4096 / 0.003 = 4.9 rpm on a TNC 415, 2.4 rpm in the 6 ms of a TNC 407. At a steady speed it is
/// divided among 16 cycles; a spindle that stands on an edge and trembles about it stands.
#[test]
fn the_speed_is_finer_than_a_step_in_a_cycle() {
    for model in [Tnc407, Tnc415b] {
        let (timing, settings) = (
            model.timing(),
            ParameterList::reference(model).spindle_parameters().settings,
        );
        let cycle_s = f64::from(timing.contour_us()) * 1e-6;
        let step_rpm = 60.0 / 4096.0 / cycle_s;
        let mut spindle = Spindle::new(settings, timing);
        let mut turn = |rpm: f64, trembles: bool, cycles: u32| {
            let mut worst = 0.0f64;
            let from = (spindle.turned_deg() / 360.0 * TURN) as i64;
            for step in 1..=cycles * timing.steps() {
                let way = rpm / 60.0 * f64::from(step * timing.step_us()) * 1e-6 * TURN;
                let tremble = if trembles {
                    i64::from(step / timing.steps() % 2) - 1
                } else {
                    0
                };
                spindle.measure(Encoder {
                    count: from + way as i64 + tremble,
                    ..Encoder::default()
                });
                if step > 40 * timing.steps() {
                    worst = worst.max((spindle.actual_rpm() - rpm).abs());
                }
            }
            worst
        };
        for rpm in [0.0, 0.3, 3.0, 50.0, 100.0, 1234.5, -2000.0] {
            let worst = turn(rpm, false, 500);
            assert!(worst <= 1.001 * step_rpm / 16.0, "{model} {rpm}: {worst}");
        }
        // Below 1 rpm a spindle has come to a standstill.
        let worst = turn(0.0, true, 500);
        assert!(worst <= 1.001 * step_rpm / 16.0, "{model}: {worst}");
        assert!(step_rpm / 16.0 < 0.5);
    }
}

/// On a ramp nothing is divided: 5000 rpm/s, that of the mill, are 15 rpm in a cycle of 3 ms, of which the speed is the mean:
/// 7.5 rpm and a step behind the end of the cycle at most.
#[test]
fn on_a_ramp_the_speed_is_that_of_the_last_cycle() {
    let mut bench = Bench::new(&[]);
    let (cycle_s, step_s) = (0.003, 0.0006);
    let slope = 5000.0 / 60.0;
    for step in 1..=500u32 {
        let time = f64::from(step) * step_s;
        bench.spindle.measure(Encoder {
            count: (0.5 * slope * time * time * TURN) as i64,
            ..Encoder::default()
        });
        // The first step that is counted may as well be one of slow turning: a cycle later it is none.
        if step % 5 == 0 && step > 5 {
            let lag_rpm = slope * 60.0 * time - bench.spindle.actual_rpm();
            let step_rpm = 60.0 / 4096.0 / cycle_s;
            assert!((lag_rpm - 7.5).abs() <= step_rpm, "{step}: {lag_rpm}");
        }
    }
}

/// Window 10 increments of 360/4096: 0.88 degrees; the orientation goes on to the target itself, which it reaches to 0.1 degree,
/// a step of the encoder [000:5877].
fn near(angle: f64, target: f64) -> bool {
    let difference = (angle - target).rem_euclid(360.0);
    difference.min(360.0 - difference) < 0.1
}

#[test]
fn a_turning_spindle_stops_at_its_angle_in_its_direction() {
    for (rotation, sign) in [(Rotation::M3, 1.0), (Rotation::M4, -1.0)] {
        for target in [0.0, 90.0, 181.0, 359.9] {
            let mut bench = Bench::new(DIAGRAM);
            bench.turning(1000.0, rotation);
            // The way said is ignored [000:16130].
            bench.spindle.orient(target, 0.0, Way::In(Rotation::M3));
            assert!(bench.spindle.orienting() && !bench.spindle.in_position());
            let mut last = bench.turns;
            let mut furthest = 0.0f64;
            for _ in 0..5000 {
                bench.step();
                furthest = furthest.min(sign * (bench.turns - last));
                last = bench.turns;
            }
            assert!(bench.spindle.in_position(), "{rotation:?} {target}");
            assert!(
                near(bench.angle(), target),
                "{rotation:?} {target}: {}",
                bench.angle()
            );
            assert!(near(bench.spindle.angle_deg().unwrap(), target));
            assert!(furthest > -2e-4, "no way back: {furthest} turns");
        }
    }
}

#[test]
fn a_standing_spindle_goes_the_way_said() {
    let after = |start: f64, target: f64, way: Way| {
        let mut bench = Bench::new(DIAGRAM);
        bench.turning(1000.0, Rotation::M3);
        bench.spindle.orient(start, 0.0, Way::Shortest);
        bench.run(2.0);
        let before = bench.turns;
        bench.spindle.orient(target, 200.0, way);
        bench.run(2.0);
        assert!(bench.spindle.in_position());
        ((bench.turns - before) * 360.0).round()
    };
    assert_eq!(after(10.0, 350.0, Way::Shortest), -20.0);
    assert_eq!(after(10.0, 350.0, Way::In(Rotation::M3)), 340.0);
    assert_eq!(after(350.0, 10.0, Way::In(Rotation::M4)), -340.0);
    // Within the window MP3420, 0.88 degrees: the shortest way.
    assert_eq!(after(10.4, 10.0, Way::In(Rotation::M3)), 0.0);
}

#[test]
fn the_first_orientation_looks_for_the_reference_mark() {
    let mut bench = Bench::new(DIAGRAM);
    assert_eq!(bench.spindle.angle_deg(), None);
    bench.spindle.orient(30.0, 0.0, Way::Shortest);
    bench.run(3.0);
    assert!(bench.spindle.in_position());
    assert!(near(bench.angle(), 30.0), "{}", bench.angle());
}

#[test]
fn the_reference_mark_stands_at_mp3430() {
    let mut bench = Bench::new(&[DIAGRAM, &["3430=20"]].concat());
    bench.turning(500.0, Rotation::M3);
    bench.spindle.orient(30.0, 0.0, Way::Shortest);
    bench.run(3.0);
    assert!(near(bench.angle(), 10.0), "{}", bench.angle());
    // M2615: the mark is looked for again.
    bench.mark_turns = 0.5;
    bench.spindle.forget_mark();
    assert_eq!(bench.spindle.angle_deg(), None);
    bench.turning(500.0, Rotation::M3);
    bench.spindle.orient(30.0, 0.0, Way::Shortest);
    bench.run(3.0);
    assert!(near(bench.angle(), 10.0), "{}", bench.angle());
}

#[test]
fn with_m2499_the_loop_opens_in_the_window() {
    for opens in [false, true] {
        let mut bench = Bench::new(DIAGRAM);
        bench.turning(500.0, Rotation::M3);
        bench.spindle.set_opens(opens);
        bench.spindle.orient(30.0, 0.0, Way::Shortest);
        bench.run(3.0);
        assert!(bench.spindle.in_position());
        // A push of 10 degrees is driven back by the loop only.
        let before = bench.turns;
        bench.turns += 10.0 / 360.0;
        bench.run(1.0);
        assert_eq!((bench.turns - before) * 360.0 > 9.0, opens);
        assert_eq!(bench.spindle.at_zero(), opens || bench.spindle.volts() == 0.0);
    }
}

#[test]
fn m2501_turns_the_spindle_at_its_speed() {
    let mut bench = Bench::new(DIAGRAM);
    bench.spindle.turn(Rotation::M4);
    bench.run(1.0);
    assert!(
        (bench.spindle.actual_rpm() + 50.0).abs() < 0.5,
        "{}",
        bench.spindle.actual_rpm()
    );
    bench.spindle.turn(Rotation::M5);
    bench.run(0.5);
    assert!(bench.spindle.at_zero());
}

#[test]
fn after_an_orientation_the_offset_goes_by_1_mv_in_7_seconds() {
    let mut bench = Bench::new(DIAGRAM);
    bench.offset_volts = -0.005;
    bench.turning(500.0, Rotation::M3);
    bench.spindle.orient(30.0, 0.0, Way::Shortest);
    bench.run(3.5);
    assert!(bench.spindle.in_position());
    // 5 mV are 1.25 rpm, 450 degrees/min; kv 1 is 1000 degrees/min for a degree: 0.45 degrees.
    let lag = |bench: &Bench| 30.0 - bench.angle();
    let first = lag(&bench);
    assert!((first - 0.45).abs() <= STEP_DEG, "{first}");
    bench.run(28.0);
    let second = lag(&bench);
    // 28 steps of 0.1526 mV = 4.27 mV of 5 mV: 0.385 degrees.
    assert!((first - second - 0.385).abs() <= STEP_DEG, "{first} {second}");
}

/// A thread takes the spindle over where it is held, whatever it did before: standing still after M05, in the
/// loop of an orientation, after an earlier thread, after an EMERGENCY STOP in a thread. MP3410.3 = 0.1 V/ms are
/// 0.06 V in a servo step of 0.6 ms [000:6056] [000:5790]; the loop adds kv of a lag that changes by the way of two
/// steps at most, 16.7/s · 1.2 ms = 2 %.
#[test]
fn a_thread_takes_the_spindle_over_where_it_is_held() {
    type Before = fn(&mut Bench);
    let befores: [(&str, Before); 6] = [
        ("M05", |bench| {
            bench.turning(333.0, Rotation::M3);
            bench.spindle.rotate(Rotation::M5);
            bench.run(1.0);
        }),
        ("orientation", |bench| {
            bench.turning(333.0, Rotation::M3);
            bench.spindle.orient(77.0, 0.0, Way::Shortest);
            bench.run(3.0);
        }),
        ("jog", |bench| {
            bench.spindle.jog(Rotation::M4);
            bench.run(0.5);
            bench.spindle.rotate(Rotation::M5);
            bench.run(0.5);
        }),
        ("M2501", |bench| {
            bench.spindle.turn(Rotation::M3);
            bench.run(1.0);
            bench.spindle.turn(Rotation::M5);
            bench.run(1.0);
        }),
        ("an earlier thread", |bench| {
            bench.thread();
            bench.turning(500.0, Rotation::M4);
            bench.spindle.rotate(Rotation::M5);
            bench.run(1.0);
        }),
        ("EMERGENCY STOP in a thread", |bench| {
            bench.lead(0.1, 200);
            bench.spindle.rotate(Rotation::M5);
            bench.spindle.set_enabled(false);
            bench.run(0.5);
            // Turned by hand while the drive is off.
            bench.turns += 0.4;
            bench.run(0.1);
            bench.spindle.set_enabled(true);
        }),
    ];
    for (name, before) in befores {
        let entries = ["7130=0.5", "7140=0.5", "3510.0=1500", "3210.0=9", "3410.3=0.1"];
        let mut bench = Bench::new(&entries);
        before(&mut bench);
        let held = bench.spindle.held_deg();
        assert!((held - bench.spindle.turned_deg()).abs() < 0.05, "{name}");
        let greatest = bench.thread();
        let allowed = 0.1 * 0.6 * 1.02;
        assert!(
            greatest <= allowed,
            "{name}: {greatest} V in a servo step of {allowed}"
        );
        assert!(greatest > 0.05, "{name}: it was on its ramp: {greatest}");
    }
}

/// From one thread to the next orientation the spindle goes the shorter way, as from standstill: what the loop puts
/// out to hold it is no turning [000:6122].
#[test]
fn a_led_spindle_that_stands_goes_the_shorter_way_to_its_orientation() {
    for (start, target, way) in [(10.0, 350.0, -20.0), (350.0, 10.0, 20.0), (300.0, 210.0, -90.0)] {
        for push in [-0.1, 0.0, 0.1] {
            let mut bench = Bench::new(DIAGRAM);
            bench.turning(500.0, Rotation::M3);
            bench.spindle.orient(start, 0.0, Way::Shortest);
            bench.run(3.0);
            let held = bench.spindle.held_deg();
            bench.lead(0.0, 100);
            bench.turns += push / 360.0;
            bench.lead(0.0, 1);
            bench.spindle.orient(target, 0.0, Way::Shortest);
            bench.run(3.0);
            assert!(bench.spindle.in_position());
            let turned = bench.spindle.turned_deg() - held;
            assert!((turned - way).abs() <= STEP_DEG, "{start} to {target}: {turned}");
        }
    }
}

/// A spindle that has never turned, and does not know its reference mark, turns by 180 degrees and back [000:7654]; one that
/// turns does not.
#[test]
fn a_standing_spindle_turns_by_a_way() {
    let mut bench = Bench::new(DIAGRAM);
    bench.mark_turns = 0.9;
    bench.run(0.1);
    for (way, turned) in [(180.0, 180.0), (-180.0, 0.0)] {
        assert!(bench.spindle.turn_by(way) && bench.spindle.orienting());
        bench.run(2.0);
        assert!(bench.spindle.in_position() && bench.spindle.angle_deg().is_none());
        assert!(
            (bench.turns * 360.0 - turned).abs() <= STEP_DEG,
            "{}",
            bench.turns
        );
    }
    bench.turning(100.0, Rotation::M3);
    assert!(!bench.spindle.turn_by(180.0));
}

/// Led through 3 turns there and back at 600 rpm, ramps of 0.1 s: an ideal drive follows the velocity, the loop
/// what is left; it stands where it was led to.
#[test]
fn a_led_spindle_follows_its_angle() {
    let entries = ["7130=0.5", "7140=0.5", "3510.0=1500", "3210.0=9"];
    let mut bench = Bench::new(&entries);
    bench.turning(0.0, Rotation::M5);
    let from = bench.spindle.turned_deg();
    assert_eq!(bench.spindle.held_deg(), from);
    let (speed, ramp, way) = (3600.0, 0.1, 1080.0);
    let total = way / speed + ramp;
    // The angle at a time of the trapezoid.
    let angle = |t: f64| match t {
        t if t < ramp => 0.5 * speed / ramp * t * t,
        t if t < total - ramp => speed * (t - 0.5 * ramp),
        t if t < total => way - 0.5 * speed / ramp * (total - t).powi(2),
        _ => way,
    };
    let cycle = f64::from(bench.timing.contour_us()) * 1e-6;
    let mut nominal = vec![from; 8];
    let mut greatest = 0.0f64;
    for k in 1..=1000 {
        let t = f64::from(k) * cycle;
        let back = (t - total).clamp(0.0, total);
        let wanted = from + angle(t.min(total)) - angle(back);
        bench.spindle.lead(wanted);
        for _ in 0..bench.timing.steps() {
            bench.step();
        }
        nominal.push(wanted);
        // Two means of one contour cycle delay it by one cycle in all, the output by one step.
        let delayed = nominal[nominal.len() - 2];
        greatest = greatest.max((bench.spindle.turned_deg() - delayed).abs());
    }
    // 3600 degrees/s in one servo step of 0.6 ms are 2.2 degrees; the ramps of 36 000 degrees/s² within the means.
    assert!(
        greatest < 3600.0 * 0.0012 + 36_000.0 * 0.003 * 0.003,
        "{greatest}"
    );
    assert!((bench.spindle.turned_deg() - from).abs() < 0.02);
    assert_eq!(bench.spindle.held_deg(), from);
    // Smaller entries round more: the speed at the end of the first ramp is still on its way.
    let rpm = |entries: &[&str]| {
        let mut bench = Bench::new(entries);
        bench.turning(0.0, Rotation::M5);
        let from = bench.spindle.turned_deg();
        for k in 1..=12 {
            bench.spindle.lead(from + 3600.0 * 0.003 * f64::from(k));
            for _ in 0..bench.timing.steps() {
                bench.step();
            }
        }
        bench.spindle.nominal_rpm()
    };
    let (quick, run_in, both) = (
        rpm(&["7130=0.5", "7140=0.5"]),
        rpm(&["7130=0.05", "7140=0.5"]),
        rpm(&["7130=0.05", "7140=0.05"]),
    );
    assert!((quick - 600.0).abs() < 1e-6, "{quick}");
    assert!(
        run_in > both && both > 0.0 && run_in <= 600.0 + 1e-6,
        "{run_in} {both}"
    );
}
