//! Axes whose speed loop the control closes (MP1900, TNC 425): servo and current drive together, step by step.

use crate::common::BASE;
use bahn_machine::Machine;
use bahn_parameters::fault::FaultId;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_servo::{Axis, Commands, Fault, GrossFault, Measured, Method, Plant, Step, Timing};

/// A table of 100 kg on a screw of 10 mm pitch whose rotor counts 0.0002533 kg m² · (2π / 10 mm)² = 100 kg: 200 kg in all.
/// 0.5 N m/A · 6.366 A · 2π / 10 mm = 2000 N at 10 V: 10 m/s², so 1 V for each m/s².
const DRIVE: &str = r#"
[axis.X]
output = "1"
mass = 100
friction = 60
stiction = 80
brake = 400
backlash = 0
[axis.X.current_drive]
pitch = 10
torque_constant = 0.5
current = 6.3662
inertia = 0.00025330
lines = 5000
[axis.X.encoder]
input = "X1"
period_um = 20
"#;

/// Screw 10 mm / 5000 lines = 2 µm; scale 20 µm: MP1955 = 10 as in the manual's example [000:18478-18483].
const LIST: [&str; 16] = [
    "10=%00111",
    "50=%00111",
    "330.0=20",
    "1010.0=15000",
    "1060.0=2",
    "1900=%00001",
    "1910.0=20619",
    "1920.0=75",
    "1925.0=0.5",
    "1940.0=80",
    "1945.0=0",
    "1950=0",
    "1951=0",
    "1955.0=10",
    "1970.0=1",
    "1980=0",
];

/// An axis on its drive.
struct Loop {
    axis: Axis,
    machine: Machine,
    commands: Commands,
    measured: Measured,
    timing: Timing,
    time_us: u64,
    /// In the last step.
    lag_mm: f64,
}

impl Loop {
    fn new(changes: &[&str], drive: impl Fn(String) -> String) -> Loop {
        let mut list = ParameterList::reference(ControlModel::Tnc425);
        for entry in ["710.0=0", "720.0=0"].iter().chain(&LIST).chain(changes) {
            list.assign(entry).unwrap();
        }
        let timing = ControlModel::Tnc425.timing();
        let text = drive(format!("{BASE}{DRIVE}"));
        let machine = Machine::from_toml(&text).unwrap_or_else(|faults| panic!("{faults:?}"));
        let mut new = Loop {
            axis: Axis::new(list.axis_parameters(0).settings(), timing),
            machine,
            commands: Commands::default(),
            measured: Measured::default(),
            timing,
            time_us: 0,
            lag_mm: 0.0,
        };
        new.commands.control_ready = true;
        for _ in 0..50 {
            new.exchange();
        }
        new.axis.transfer();
        new.axis.close();
        new
    }

    fn plain(changes: &[&str]) -> Loop {
        Loop::new(changes, |text| text)
    }

    fn exchange(&mut self) {
        let step = Step {
            from_us: self.time_us,
            length_us: self.timing.step_us(),
        };
        self.machine.exchange(step, &self.commands, &mut self.measured);
        self.time_us += u64::from(step.length_us);
        self.axis.measure_motor(self.measured.motor(0));
        self.axis.measure(self.measured.encoder(0));
    }

    /// Runs one servo step.
    fn step(&mut self) {
        self.axis.step();
        self.lag_mm = self.axis.lag_mm();
        self.commands.axes[0] = self.axis.output();
        self.exchange();
    }

    /// A contour cycle towards a position.
    fn cycle(&mut self, nominal_mm: f64) {
        self.axis.command(nominal_mm);
        for _ in 0..self.timing.steps() {
            self.step();
        }
    }

    /// Speeds up evenly with 2 m/s² to a feed, and goes on for a time, s; where it was sent.
    fn travel(&mut self, feed_mm_min: f64, seconds: f64) -> f64 {
        let (mut target, mut speed) = (self.axis.target_mm(), 0.0_f64);
        for _ in 0..(seconds / 0.003) as usize {
            speed += (feed_mm_min / 60.0 - speed).clamp(-6.0, 6.0);
            target += speed * 0.003;
            self.cycle(target);
        }
        target
    }

    fn table(&self) -> f64 {
        self.machine.axis('X').unwrap().position
    }

    /// A step of the oscilloscope for 0.3 s: overshoot in percent, and the greatest voltage.
    fn step_response(&mut self, feed_mm_min: f64) -> (f64, f64) {
        assert!(self.axis.set_speed_step(Some(feed_mm_min)));
        let (mut greatest, mut volts) = (0.0_f64, 0.0_f64);
        for _ in 0..500 {
            self.step();
            greatest = greatest.max(self.axis.speed().unwrap().actual_mm_min);
            volts = volts.max(self.axis.volts().abs());
        }
        ((greatest / feed_mm_min - 1.0) * 100.0, volts)
    }

    /// Half the difference of the greatest and the least speed from 12 ms after the rise of a step on, % of the step: what
    /// is left of its oscillation.
    fn ripple(&mut self, feed_mm_min: f64) -> f64 {
        assert!(self.axis.set_speed_step(Some(feed_mm_min)));
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut left: Option<u32> = None;
        for _ in 0..150 {
            self.step();
            let actual = self.axis.speed().unwrap().actual_mm_min;
            left = match left {
                None => (actual >= feed_mm_min).then_some(20),
                Some(left) => Some(left.saturating_sub(1)),
            };
            if left == Some(0) && self.axis.fault().is_none() {
                (least, greatest) = (actual.min(least), actual.max(greatest));
            }
        }
        (greatest - least).max(0.0) / 2.0 / feed_mm_min * 100.0
    }
}

/// The lag of a loop with kv 2 (m/min)/mm at 3 m/min is 1.5 mm, as of any other axis; the torque at constant speed is
/// what friction takes: 60 N of 2000 N.
#[test]
fn the_speed_loop_is_closed_by_the_control() {
    let mut x = Loop::plain(&["1810.0=2"]);
    x.travel(3000.0, 2.0);
    assert_eq!(x.axis.fault(), None);
    assert!((x.lag_mm - 1.5).abs() < 0.003, "{}", x.lag_mm);
    let speed = x.axis.speed().unwrap();
    assert!((speed.actual_mm_min - 3000.0).abs() < 15.0, "{speed:?}");
    let torque = x.commands.axes[0].torque.unwrap();
    assert!((torque - 60.0 / 2000.0).abs() < 0.01, "{torque}");
    assert_eq!(x.commands.axes[0].volts, torque * 10.0);
}

/// The encoder of the motor fails while the axis travels: the speed controller sees a standing motor, asks for more than
/// MP1910 permits, and gives no torque any more: 3F.
#[test]
fn a_lost_encoder_of_the_motor_is_gross_positioning_error_3f() {
    let mut x = Loop::plain(&["1810.0=2"]);
    let target = x.travel(3000.0, 1.0);
    x.machine.apply("fault motor X").unwrap();
    let counted = x.measured.motor(0);
    let mut cycles = 0;
    while x.axis.fault().is_none() {
        x.cycle(target + 0.15 * f64::from(cycles));
        cycles += 1;
        assert!(cycles < 200, "{:?}", x.axis.speed());
    }
    assert_eq!(x.axis.fault(), Some(Fault::Gross(GrossFault::SpeedController)));
    assert_eq!((x.measured.motor(0), x.axis.volts()), (counted, 0.0));
    // What was not counted stays lost; from then on it counts.
    x.machine.apply("repair X").unwrap();
    assert!(x.machine.apply("fault motor Y").is_err());
}

/// MP1980 brakes with a speed controller that is sound [000:18515-18521]: one that MP1910 has ended gives no torque any more, also
/// where an EMERGENCY STOP is on its way, or comes then, and its encoder counts again.
#[test]
fn a_speed_controller_with_a_fault_does_not_brake() {
    for before in [true, false] {
        let mut x = Loop::plain(&["1810.0=2", "1980=0.6"]);
        let mut target = x.travel(3000.0, 1.0);
        if before {
            x.axis.begin_shutdown();
        }
        x.machine.apply("fault motor X").unwrap();
        while x.axis.fault().is_none() {
            target += 0.15;
            x.cycle(target);
        }
        assert_eq!(x.axis.fault(), Some(Fault::Gross(GrossFault::SpeedController)));
        x.axis.begin_shutdown();
        x.machine.apply("repair X").unwrap();
        for _ in 0..100 {
            x.cycle(target);
            let drive = x.commands.axes[0];
            assert_eq!((x.axis.volts(), drive.enabled), (0.0, false), "before: {before}");
        }
    }
}

/// With pre-control the deviation while speeding up with 2 m/s² falls by MP1945: 1 V/(m/s²) is what this drive needs.
#[test]
fn acceleration_is_pre_controlled() {
    let greatest = |factor: &str| {
        let mut x = Loop::plain(&["1510.0=4", factor]);
        x.axis.set_method(Method::Precontrol);
        let (mut target, mut speed, mut worst) = (0.0, 0.0_f64, 0.0_f64);
        for _ in 0..100 {
            speed = (speed + 6.0).min(150.0);
            target += speed * 0.003;
            x.cycle(target);
            worst = worst.max(x.lag_mm.abs());
        }
        assert_eq!(x.axis.fault(), None);
        worst
    };
    let (without, with) = (greatest("1945.0=0"), greatest("1945.0=1"));
    assert!(with < 0.35 * without, "{without} {with}");
}

/// The wrong polarity feeds back positively: GROSS POSITIONING ERROR 3F [000:18579-18584]; MP1950 and the exchanged
/// wires together are right again.
#[test]
fn wrong_polarity_is_gross_positioning_error_3f() {
    let reversed = |text: String| text.replace("lines = 5000", "lines = 5000\nreversed = true");
    let start = ["1910.0=310000", "1920.0=5", "1940.0=10", "1951=1", "1970.0=0"];
    for (polarity, fault) in [
        ("1950=0", Some(Fault::Gross(GrossFault::SpeedController))),
        ("1950=1", None),
    ] {
        let changes: Vec<&str> = start.into_iter().chain([polarity]).collect();
        let mut x = Loop::new(&changes, reversed);
        x.travel(1000.0, 0.5);
        assert_eq!(x.axis.fault(), fault, "{polarity}");
    }
    let fault = Fault::Gross(GrossFault::SpeedController);
    assert_eq!(
        (FaultId::from(fault).row().letter, fault.opens_loop()),
        ("3F", true)
    );
}

/// MP1910 = 15 V / (MP1920 · 9.7 µV): 309 278 for 5, 8591 for 180 [000:18558] [000:18601-18607]. A blocked axis whose
/// speed error is summed up faults when the calculated voltage passes 15 V, though at most 10 V are put out.
#[test]
fn mp1910_monitors_the_calculated_voltage() {
    for (integral, monitor) in [(5.0, 309_278.0), (180.0, 8591.0)] {
        let formula: f64 = 15.0 / (integral * 9.7e-6);
        assert_eq!(formula.round(), monitor);
    }
    let mut x = Loop::new(
        &["1910.0=8591", "1920.0=180", "1940.0=0", "1970.0=0", "1925.0=0"],
        |text| text.replace("stiction = 80", "stiction = 4000"),
    );
    assert!(x.axis.set_speed_step(Some(60.0)));
    // 60 mm/min are 0.6 µm in a step; a counting step is 2 µm / 256: 76.8 of them. 8591 / 76.8 = 111.9: 112 steps
    // after the one in which the speed was put in.
    let mut steps = 0;
    while x.axis.fault().is_none() && steps < 1000 {
        x.step();
        steps += 1;
        assert!(x.axis.volts().abs() <= 10.0);
    }
    assert_eq!(steps, 1 + 112);
    assert_eq!(x.axis.fault(), Some(Fault::Gross(GrossFault::SpeedController)));
}

/// MP1925 (inferred): the sum of the integral part forgets with this time constant. Of a motor that is held 100 mm/min
/// behind, 128 steps in each of 0.6 ms, it keeps no more than 128 · 0.05 s / 0.6 ms: 7.8 V in the end, not 16 V and more.
#[test]
fn mp1925_lets_the_sum_forget() {
    let volts = |limit: &str| {
        let changes = ["1910.0=16000000", "1920.0=75", "1940.0=0", "1970.0=0", limit];
        let mut x = Loop::new(&changes, |text| text.replace("stiction = 80", "stiction = 40000"));
        assert!(x.axis.set_speed_step(Some(100.0)));
        for _ in 0..1000 {
            x.step();
        }
        x.axis.volts()
    };
    let expected = 128.0 * 0.05 / 0.0006 * 75.0 * 9.7e-6;
    assert!(
        (volts("1925.0=0.05") - expected).abs() < 0.05,
        "{}",
        volts("1925.0=0.05")
    );
    assert_eq!(volts("1925.0=0"), 10.0);
}

/// MP1955 = 20 µm / 2 µm = 10 [000:18478-18483]: the encoders say the same over a long travel. With 9 the motor's travel counts
/// 10/9 of what it is: after 9 mm the difference is 1 mm, MP1970, and GROSS POSITIONING ERROR C comes.
#[test]
fn mp1970_compares_position_and_speed_encoder() {
    let mut x = Loop::plain(&[]);
    x.travel(3000.0, 2.0);
    assert_eq!(x.axis.fault(), None);
    let mut x = Loop::plain(&["1955.0=9"]);
    let mut target = 0.0;
    while x.axis.fault().is_none() && target < 20.0 {
        target += 0.05;
        x.cycle(target);
    }
    assert_eq!(x.axis.fault(), Some(Fault::Gross(GrossFault::Movement)));
    assert!((x.table() - 9.0).abs() < 0.1, "{}", x.table());
}

/// MP1951 = 1: the motor's encoder is that of the position. A scale that counts nothing is not missed then.
#[test]
fn mp1951_positions_by_the_encoder_of_the_motor() {
    for (mp1951, there) in [("1951=1", true), ("1951=0", false)] {
        let mut x = Loop::plain(&[mp1951, "1970.0=0"]);
        x.machine.apply("fault encoder X stuck").unwrap();
        let target = x.travel(1000.0, 0.3);
        for _ in 0..300 {
            x.cycle(target);
        }
        let arrived = x.axis.fault().is_none() && (x.table() - target).abs() < 0.02;
        assert_eq!(arrived, there, "{mp1951}: {} of {target}", x.table());
    }
}

/// MP1040 turns the speed between the loops, MP210 counts the scale: a machine mounted the other way round, whose motor
/// and scale count negative, runs with both [000:18453-18454].
#[test]
fn mp1040_and_mp210_fit_a_machine_mounted_the_other_way_round() {
    let mounted = |text: String| {
        text.replace(
            "lines = 5000",
            "lines = 5000\nreversed = true\nencoder_reversed = true",
        )
        .replace("period_um = 20", "period_um = 20\nreversed = true")
    };
    let mut x = Loop::new(&["1040=1", "210=1", "1810.0=2"], mounted);
    x.travel(3000.0, 1.0);
    assert_eq!(x.axis.fault(), None);
    assert!((x.lag_mm - 1.5).abs() < 0.01 && x.table() > 40.0);
}

/// The trimming procedure [000:18523-18607]: from its start values MP1940 rises until the speed oscillates and is halved,
/// then MP1920 the same way; then the overshoot is at most 40 %, MP1910 follows, and the axis positions.
#[test]
fn the_speed_controller_can_be_trimmed_as_the_manual_says() {
    let start = "1910.0=310000 1951=1 1970.0=0 1925.0=0";
    let with = |proportional: f64, integral: f64| {
        let values = [format!("1940.0={proportional}"), format!("1920.0={integral}")];
        let entries: Vec<&str> = start
            .split(' ')
            .chain(values.iter().map(String::as_str))
            .collect();
        Loop::plain(&entries)
    };
    let oscillates = |proportional: f64, integral: f64| with(proportional, integral).ripple(100.0) > 10.0;
    let raise = |oscillates: &dyn Fn(f64) -> bool| {
        let oscillating = (2..400)
            .map(|part| f64::from(part) * 5.0)
            .find(|value| oscillates(*value));
        (oscillating.unwrap() / 2.0).floor()
    };
    let proportional = raise(&|value| oscillates(value, 5.0));
    assert!(
        (50.0..=200.0).contains(&proportional),
        "{proportional}: the recommended range"
    );
    let mut integral = raise(&|value| oscillates(proportional, value));
    // What overshoots more than 40 % then is lowered further.
    while with(proportional, integral).step_response(100.0).0 > 40.0 && integral > 50.0 {
        integral = (integral * 0.8).floor();
    }
    let (overshoot, volts) = with(proportional, integral).step_response(100.0);
    assert!(
        (0.0..=40.0).contains(&overshoot),
        "{proportional} {integral}: {overshoot} %"
    );
    assert!(volts < 10.0, "{volts} V: a step in which nothing is limited");
    let monitor = (15.0 / (integral * 9.7e-6)).round();
    let values = [
        format!("1940.0={proportional}"),
        format!("1920.0={integral}"),
        format!("1910.0={monitor}"),
    ];
    let entries: Vec<&str> = values.iter().map(String::as_str).collect();
    let mut x = Loop::plain(&entries);
    let target = x.travel(6000.0, 1.0);
    for _ in 0..700 {
        x.cycle(target);
    }
    assert_eq!(x.axis.fault(), None);
    assert!((x.table() - target).abs() < 0.01 && x.axis.in_position());
}

/// After a step the position loop closes where the axis is.
#[test]
fn the_position_loop_is_off_in_a_step() {
    let mut x = Loop::plain(&[]);
    x.step_response(300.0);
    assert!(x.lag_mm == 0.0 && x.table() > 1.4, "it runs without a command");
    assert!(x.axis.set_speed_step(Some(0.0)));
    for _ in 0..200 {
        x.step();
    }
    assert!(x.axis.set_speed_step(None));
    let there = x.table();
    let target = x.axis.target_mm();
    for _ in 0..100 {
        x.cycle(target);
    }
    assert!((x.table() - there).abs() < 0.01 && x.axis.fault().is_none());
}

/// MP1960: on a circle the sum gets what the friction asks for when it turns round, and the peak is smaller.
#[test]
fn mp1960_takes_the_peak_at_quadrants_away() {
    let peak = |entry: &str| {
        let mut x = Loop::plain(&["1510.0=4", "1920.0=75", "1945.0=1", entry]);
        x.axis.set_method(Method::Precontrol);
        x.axis.set_circular(true);
        // Radius 20 mm, 1000 mm/min: 0.8333 rad/s.
        let mut worst = 0.0_f64;
        for cycle in 0..3000 {
            let angle = f64::from(cycle) * 0.003 * (1000.0 / 60.0 / 20.0);
            x.cycle(20.0 * angle.sin());
            if cycle > 300 {
                worst = worst.max(x.lag_mm.abs());
            }
        }
        assert_eq!(x.axis.fault(), None);
        worst
    };
    // Friction of 60 N is 0.3 V; twice that are 0.6 V / (75 · 9.7 µV) = 825 steps of 2 µm / 256: 6.4 µm.
    let (without, with) = (peak("1960.0=0"), peak("1960.0=0.0064"));
    assert!(with < 0.6 * without, "{without} {with}");
}

/// MP1980: in an EMERGENCY STOP the loop brakes as long as it says; with 0 the torque is off at once and the axis runs
/// down by its friction of 60 N on 200 kg: 50 mm/s last 50 / 300 s and 4.2 mm.
#[test]
fn mp1980_goes_on_braking_in_an_emergency_stop() {
    let run_on = |entry: &str| {
        let mut x = Loop::new(&[entry, "1810.0=4", "1710.0=30", "1720.0=30"], |text| {
            text.replace("lines = 5000", "lines = 5000\noff_delay_ms = 500")
        });
        x.travel(3000.0, 0.5);
        let from = x.table();
        x.axis.begin_shutdown();
        // The path is stopped with 2 m/s²: 25 ms.
        let (mut target, mut speed) = (x.axis.target_mm(), 50.0_f64);
        for _ in 0..200 {
            speed = (speed - 6.0).max(0.0);
            target += speed * 0.003;
            x.cycle(target);
        }
        (x.table() - from, x.axis.closed(), x.axis.volts())
    };
    let (coasted, closed, volts) = run_on("1980=0");
    assert!(
        (coasted - 4.17).abs() < 0.1 && !closed && volts == 0.0,
        "{coasted}"
    );
    let (braked, closed, volts) = run_on("1980=0.3");
    // The lag of 0.75 mm and 0.6 mm of the ramp.
    assert!(braked < 1.5 && !closed && volts == 0.0, "{braked}");
}

/// Without feed enable the axis is held at speed 0.
#[test]
fn without_feed_enable_the_axis_is_held() {
    let mut x = Loop::plain(&["1810.0=4", "1710.0=30", "1720.0=30"]);
    x.travel(3000.0, 0.5);
    let from = x.table();
    x.axis.set_enabled(false);
    let target = x.axis.target_mm();
    for _ in 0..100 {
        x.cycle(target);
    }
    // 50 mm/s with 2 m/s²: 0.625 mm.
    assert!((x.table() - from - 0.625).abs() < 0.05, "{}", x.table() - from);
    assert!(x.commands.axes[0].enabled && x.machine.axis('X').unwrap().speed_per_min.abs() < 10.0);
}

/// A drive that has a speed controller of its own gets the voltage of an axis without MP1900, bit for bit.
#[test]
fn a_drive_with_its_own_speed_controller_gets_speed() {
    let text = format!(
        "{BASE}[axis.X]\noutput = \"1\"\nspeed = 15000\nvolts = 9\ntime_constant_ms = 2\n[axis.X.encoder]\ninput = \"X1\"\nperiod_um = 20\n"
    );
    let volts = |mp1900: &str| {
        let mut x = Loop::new(&[mp1900], |_| text.clone());
        (0..200)
            .map(|cycle| {
                x.cycle(0.1 * f64::from(cycle));
                assert_eq!(x.commands.axes[0].torque, None);
                x.axis.volts()
            })
            .collect::<Vec<f64>>()
    };
    assert_eq!(volts("1900=1"), volts("1900=0"));
}
