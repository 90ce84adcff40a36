//! The seam to a family holds: a control that is none of the shipped ones, with two axes and one handshake, runs on the kernel.
//!
//! It clamps the work piece: function 40 of a program closes the clamp, and the path waits until that says it is closed. It
//! has no operating modes, no memory of a PLC and no messages.

mod list;

use std::sync::Arc;

use bahn_kernel::{
    Axes, AxisId, AxisUnit, Cartesian, Chain, Circuit, CircuitOrder, Clock, Core, EmergencyStop, Family,
    Feeder, Mover, Offsets, Outputs, Progress, RunFault, RunState, Track, Wheels,
};
use bahn_motion::{Drive, Limits, State, Stop};
use bahn_parameters::{ControlModel, EmergencyStopTest, ParameterList, PerPlcAxis};
use bahn_path::{Axis, AxisSet, Function, LiveData, PerAxis, Position, Voltage};
use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};
use list::Places;

/// The clamp needs so long to close, µs.
const CLOSES_US: u64 = 250_000;
/// Its contact is looked at so often, µs.
const SCAN_US: u64 = 20_000;
/// The function that closes it.
const CLAMP: u16 = 40;

/// The clamp, and what is told to it.
#[derive(Default)]
struct Clamp {
    /// It is to close; since when, µs.
    asked: bool,
    since_us: Option<u64>,
    /// Its contact, as it was seen last.
    closed: bool,
}

impl Outputs for Clamp {
    fn begin(&mut self) {}

    fn output(&mut self, function: &Function) {
        if *function == Function::M(CLAMP) {
            self.asked = true;
        }
    }

    fn voltage(&mut self, _: Voltage, _: u64) {}
}

/// A control with two axes and a clamp.
struct Bench {
    core: Core,
    chain: Chain,
    track: Track,
    feeder: Feeder,
    progress: Progress,
    clamp: Clamp,
    now_us: u64,
    scanned_us: u64,
    /// The program has asked something: it is answered at the next preparation.
    asked: bool,
    /// Why the run has ended, when it was not its program.
    fault: Option<RunFault>,
}

impl Bench {
    /// At power-on, with a program of places of X and Y.
    fn new(places: &[(f64, f64, Option<u16>)]) -> Bench {
        let list = ParameterList::reference(ControlModel::Tnc415b);
        let timing = list.model().timing();
        let units = (0..2u8).filter_map(|index| {
            let id = AxisId::new(index)?;
            AxisUnit::new(id, (0, 0), list.axis_parameters(index), timing)
        });
        let mut axes = Axes::new(units.collect(), timing);
        for unit in axes.iter_mut() {
            unit.enabled = true;
            unit.referenced = true;
            unit.limits = [-500.0, 500.0];
        }
        let test = EmergencyStopTest {
            times: 1,
            recognise_us: 10_000,
            fall_us: 100_000,
            restore_us: 10_000,
        };
        let chain = Chain::new(
            Arc::new(Cartesian),
            Offsets {
                datum: Position::ZERO,
                tool_axis: Axis::Z,
                tool_length: 0.0,
            },
        );
        let own: AxisSet = [Axis::X, Axis::Y].into_iter().collect();
        let within = axes.of(0).traverse_box();
        let limits = Limits {
            max_feed_mm_min: PerAxis::splat(6000.0),
            acceleration_m_s2: PerAxis::splat(2.0),
            radial_acceleration_m_s2: 1.0,
            corner_angle_deg: 10.0,
            servo_lag: false,
            cycle_s: f64::from(timing.contour_us()) * 1e-6,
            servo_window_s: bahn_motion::SERVO_WINDOW_S,
            spindle: Default::default(),
            feed_override_percent: 100.0,
            rapid_override_percent: 100.0,
        };
        Bench {
            core: Core {
                timing,
                axes,
                emergency: EmergencyStop::new(test, false),
                loops_closed: false,
            },
            track: Track::new(&limits),
            feeder: Feeder::new(Box::new(Places::new(places)), chain.clone(), (within, own)),
            chain,
            progress: Progress::default(),
            clamp: Clamp::default(),
            now_us: 0,
            scanned_us: 0,
            asked: false,
            fault: None,
        }
    }

    /// Starts the program where the axes stand.
    fn start(&mut self) {
        let here = self.chain.to_path(&self.core.axes.of(0).programmed_position());
        self.track.begin_at(here, &self.chain);
        self.progress.begin();
        self.progress.enter(RunState::Running);
    }

    /// Goes on after an EMERGENCY STOP.
    fn go_on(&mut self) {
        let mut axes = self.core.axes.of(0);
        // The path goes on from where they are.
        axes.settle();
        self.track.regain(&axes, &self.chain);
        self.progress.enter(RunState::Running);
    }

    /// Reads ahead, outside the cycle.
    fn prepare(&mut self) {
        self.track.reserve();
        if self.progress.is_on_its_way() {
            self.feeder.allow_work();
            if std::mem::take(&mut self.asked) {
                self.track.path.resume(&mut self.feeder, LiveData::default());
            }
            self.track.path.prepare(&mut self.feeder, 64);
        }
    }
}

impl Family for Bench {
    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn begin_step(&mut self, _: &Measured) {}

    fn looks_at_inputs(&mut self, _: u64) -> bool {
        true
    }

    fn scan_is_due(&mut self, now_us: u64) -> bool {
        self.now_us = now_us;
        now_us >= self.scanned_us + SCAN_US
    }

    /// The contact of the clamp closes a time after it was told to.
    fn scan(&mut self, _: &Measured, _: &mut Commands) {
        self.scanned_us = self.now_us;
        if self.clamp.asked {
            let since = *self.clamp.since_us.get_or_insert(self.now_us);
            self.clamp.closed = self.now_us >= since + CLOSES_US;
        }
    }

    fn output(&mut self, _: &mut Commands) {}

    fn pass(&mut self, now_us: u64) {
        self.now_us = now_us;
    }

    fn circuit_order(&mut self) -> CircuitOrder {
        match self.core.emergency.circuit() {
            Circuit::Ready if !self.core.loops_closed => CircuitOrder::CloseLoops,
            Circuit::EmergencyStop => CircuitOrder::Stop,
            _ => CircuitOrder::Nothing,
        }
    }

    fn stop(&mut self, _: bool) {
        self.progress.stop();
    }

    fn come_to_a_stand(&mut self) -> bool {
        self.core.axes.of(0).stand()
    }

    fn loops_closed(&mut self) {}

    fn loops_open(&mut self) {}

    fn follow_loops(&mut self, _: &Measured) {}

    fn move_axes(&mut self, _: &Measured) {
        if !self.progress.is_on_its_way() {
            return;
        }
        let settled = self.core.axes.of(0).are_in_position();
        let clamped = !self.clamp.asked || self.clamp.closed;
        let drive = Drive {
            hold: !self.progress.goes_on(),
            in_position: settled,
            acknowledged: clamped,
            ..Drive::default()
        };
        let cycle = self.track.path.cycle(&drive);
        self.track.set_speed(cycle.speed_mm_s);
        let time_s = f64::from(self.core.timing.contour_us()) * 1e-6;
        let mut axes = self.core.axes.of(0);
        let wheels = Wheels {
            turned_mm: &PerPlcAxis::splat(0.0),
            rapid_limit_mm_min: f64::INFINITY,
            time_s,
            fault: false,
        };
        self.track
            .follow(&cycle.position, &mut axes, &mut self.chain, &wheels);
        self.track.output(&mut self.clamp, settled);
        let done = self.track.has_output_all() && (!self.clamp.asked || self.clamp.closed);
        match cycle.state {
            State::Gate(_) if done => self.track.path.release(),
            State::Stopped if done && settled => match self.track.path.take_stop() {
                None => {}
                Some(Stop::Barrier(_)) => self.asked = true,
                Some(stop) => {
                    if let Stop::Error(fault) = stop {
                        self.fault = Some(fault);
                    }
                    self.progress.break_off();
                    self.progress.end();
                    axes.release(|mover| mover == Mover::Path);
                }
            },
            _ => {}
        }
    }

    fn settle(&mut self) {}

    fn rest(&mut self, _: &Measured) {}

    fn transfer(&mut self) {}

    fn end_cycle(&mut self, _: &Measured) {}
}

/// A machine whose axes go where they are told, with an EMERGENCY STOP button.
#[derive(Default)]
struct Machine {
    axes: IdealAxes,
    pressed: bool,
}

impl Plant for Machine {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.axes.exchange(step, commands, measured);
        measured.control_ready &= !self.pressed;
    }
}

/// The bench on its machine.
struct Rig {
    bench: Bench,
    clock: Clock,
    plant: Machine,
}

impl Rig {
    /// Switched on, until the control voltage is there.
    fn on(places: &[(f64, f64, Option<u16>)]) -> Rig {
        let mut rig = Rig {
            bench: Bench::new(places),
            clock: Clock::default(),
            plant: Machine::default(),
        };
        rig.until(|rig| rig.bench.core.loops_closed);
        rig
    }

    fn cycle(&mut self) {
        self.bench.prepare();
        self.clock.cycle(&mut self.bench, false, &mut self.plant, None);
    }

    /// Goes on until something is so, 20 s at most.
    fn until(&mut self, so: impl Fn(&Rig) -> bool) {
        let end = self.clock.now_us() + 20_000_000;
        while !so(self) {
            assert!(self.clock.now_us() < end, "it never came");
            self.cycle();
        }
    }

    /// Where the axes of the machine are, mm.
    fn at(&self) -> [f64; 2] {
        let mut axes = self.bench.core.axes.iter();
        std::array::from_fn(|_| axes.next().map_or(f64::NAN, |unit| unit.servo.actual_mm()))
    }
}

/// X goes to 60; the clamp closes, which takes 250 ms and is seen 20 ms later at most; then Y goes to 30. Meanwhile nothing moves.
#[test]
fn the_path_waits_for_the_handshake() {
    let mut rig = Rig::on(&[(60.0, 0.0, None), (60.0, 30.0, Some(CLAMP))]);
    rig.bench.start();
    rig.until(|rig| rig.bench.clamp.asked);
    let asked_us = rig.clock.now_us();
    assert!(
        (rig.at()[0] - 60.0).abs() < 0.01,
        "the clamp is told where X has arrived"
    );
    rig.until(|rig| rig.bench.clamp.closed);
    let waited_ms = (rig.clock.now_us() - asked_us) / 1000;
    // Told in the scan after the output, seen in a later one: twice 20 ms, and a cycle of 3 ms.
    assert!((250..=293).contains(&waited_ms), "{waited_ms} ms");
    assert!(rig.at()[1].abs() < 0.001, "Y has waited");
    rig.until(|rig| rig.bench.progress.has_ended());
    let [x, y] = rig.at();
    assert!((x - 60.0).abs() < 0.01 && (y - 30.0).abs() < 0.01, "{x} {y}");
    assert_eq!(rig.bench.fault, None);
}

/// X+500 is the limit of the axis: a program that asks for more ends before it.
#[test]
fn what_leaves_the_traverse_range_is_refused() {
    let mut rig = Rig::on(&[(20.0, 0.0, None), (500.1, 0.0, None)]);
    rig.bench.start();
    rig.until(|rig| rig.bench.progress.has_ended());
    assert!(
        matches!(rig.bench.fault, Some(RunFault::Limit { axis: Axis::X, .. })),
        "{:?}",
        rig.bench.fault
    );
    assert!((rig.at()[0] - 20.0).abs() < 0.01);
}

/// EMERGENCY STOP at 50 mm/s: X brakes with 2 m/s², v²/(2a) = 0.625 mm, and a cycle of 3 ms, 0.15 mm, before. Then its loop is
/// open. When the voltage is back the program goes on to its end.
#[test]
fn an_emergency_stop_brakes_and_opens_the_loops() {
    let mut rig = Rig::on(&[(400.0, 0.0, None)]);
    rig.bench.start();
    rig.until(|rig| rig.at()[0] > 50.0);
    let [pressed_at, _] = rig.at();
    rig.plant.pressed = true;
    rig.until(|rig| !rig.bench.core.loops_closed);
    let way = rig.at()[0] - pressed_at;
    assert!((0.5..=0.625 + 0.15 + 0.05).contains(&way), "{way} mm");
    assert!(rig.bench.core.axes.iter().all(|unit| !unit.servo.closed()));
    assert_eq!(rig.bench.core.emergency.circuit(), Circuit::EmergencyStop);

    rig.plant.pressed = false;
    rig.until(|rig| rig.bench.core.emergency.circuit() == Circuit::VoltageBack);
    assert!(rig.bench.core.emergency.clear());
    rig.until(|rig| rig.bench.core.loops_closed);
    rig.bench.go_on();
    rig.until(|rig| rig.bench.progress.has_ended());
    assert!((rig.at()[0] - 400.0).abs() < 0.01, "{:?}", rig.at());
}
