//! The seam to a family holds: a control that is none of the shipped ones, with two axes and one handshake, runs on the kernel.
//!
//! It clamps the work piece: function 40 of a program closes the clamp, and the path waits until that says it is closed. It
//! has no operating modes, no memory of a PLC and no messages.

mod list;

use std::sync::Arc;

use bahn_kernel::probing::{Probed, Probing};
use bahn_kernel::{
    Acting, Axes, AxisId, AxisUnit, Came, Cartesian, Chain, Circuit, CircuitOrder, Clock, Core, Demands,
    EmergencyStop, Family, Feeder, HandMove, Now, Offsets, Outputs, OwnAxes, Run, RunFamily, RunFault,
    RunState, SpindleLoop, SpindleWiring, Track, move_by_hand,
};
use bahn_motion::{FunctionOutput, Limits, Stop};
use bahn_parameters::{ControlModel, EmergencyStopTest, ParameterList, PerPlcAxis};
use bahn_path::{Axis, AxisSet, Barrier, Function, LiveData, PerAxis, Position, Touch, Voltage};
use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};
use list::{PROBE, Places, STOP};

/// The clamp needs so long to close, µs.
const CLOSES_US: u64 = 250_000;
/// Its contact is looked at so often, µs.
const SCAN_US: u64 = 20_000;
/// The function that closes it.
const CLAMP: u16 = 40;
/// A function that the control does not have.
const UNKNOWN: u16 = 41;

/// The clamp, and what is told to it.
#[derive(Default)]
struct Clamp {
    /// It is to close; since when, µs.
    asked: bool,
    since_us: Option<u64>,
    /// Its contact, as it was seen last.
    closed: bool,
}

/// Where the run acts.
struct Site<'a> {
    axes: OwnAxes<'a>,
    chain: &'a mut Chain,
    spindle: &'a mut SpindleLoop,
    clamp: &'a mut Clamp,
    now: Now,
}

impl Outputs for Site<'_> {
    fn begin(&mut self, _: &FunctionOutput) {}

    fn output(&mut self, function: &Function) -> bool {
        if *function == Function::M(CLAMP) {
            self.clamp.asked = true;
        }
        *function != Function::M(UNKNOWN)
    }

    fn voltage(&mut self, _: Voltage, _: u64) {}
}

impl<'a> RunFamily<'a> for Site<'a> {
    fn acting(&mut self) -> Acting<'_, 'a> {
        Acting {
            axes: &mut self.axes,
            chain: self.chain,
            spindle: self.spindle,
            now: &self.now,
        }
    }

    fn has_transferred(&self) -> bool {
        !self.clamp.asked || self.clamp.closed
    }

    fn answer(&mut self) -> LiveData {
        LiveData::default()
    }
}

/// A control with two axes and a clamp. A third axis turns its magazine: no program knows it, and it has no feed enable.
struct Bench {
    core: Core,
    chain: Chain,
    spindle: SpindleLoop,
    run: Run,
    feeder: Feeder,
    clamp: Clamp,
    probing: Option<Probing>,
    /// What the program has learned of the last probing.
    touch: Option<Touch>,
    now_us: u64,
    scanned_us: u64,
    /// NC start and NC stop are pressed.
    start: bool,
    stop: bool,
    /// Blocks are executed one by one.
    single: bool,
    /// Where the operator leads Y while the run is interrupted.
    by_hand: Option<f64>,
    /// Why the run has ended, when it was not its program.
    fault: Option<RunFault>,
    /// The block that was refused, by its place in the order of execution.
    refused: Option<u64>,
}

impl Bench {
    /// At power-on, with a program of places of X and Y.
    fn new(places: &[(f64, f64, Option<u16>)]) -> Bench {
        let list = ParameterList::reference(ControlModel::Tnc415b);
        let timing = list.model().timing();
        let units = (0..3u8).filter_map(|index| {
            let id = AxisId::new(index)?;
            let mut parameters = list.axis_parameters(index);
            if index == 2 {
                (parameters.letter, parameters.plc_axis) = (Some(Axis::A), true);
            }
            AxisUnit::new(id, (0, 0), parameters, timing)
        });
        let mut axes = Axes::new(units.collect(), timing);
        for unit in axes.iter_mut().filter(|unit| !unit.is_plc_axis()) {
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
            spindle: SpindleLoop::new(SpindleWiring::default(), list.spindle_parameters(), timing),
            run: Run::new(Track::new(&limits)),
            feeder: Feeder::new(Box::new(Places::new(places)), chain.clone(), (within, own)),
            chain,
            clamp: Clamp::default(),
            probing: None,
            touch: None,
            now_us: 0,
            scanned_us: 0,
            start: false,
            stop: false,
            single: false,
            by_hand: None,
            fault: None,
            refused: None,
        }
    }

    /// The run, and where it acts.
    fn parts(&mut self) -> (&mut Run, &mut Feeder, Site<'_>) {
        let now = Now {
            time_s: f64::from(self.core.timing.contour_us()) * 1e-6,
            us: self.now_us,
            start: self.start,
            stop: self.stop,
            fault: false,
            stop_pressed: self.stop,
            ready: self.core.emergency.circuit() == Circuit::Ready,
            loops_closed: self.core.loops_closed,
            feed_percent: 100.0,
            program_percent: 100.0,
            program_rapid: false,
            axis_keys: PerPlcAxis::splat(None),
            wheel_mm: PerPlcAxis::splat(0.0),
            rapid_limit_mm_min: f64::INFINITY,
        };
        let site = Site {
            axes: self.core.axes.of(0),
            chain: &mut self.chain,
            spindle: &mut self.spindle,
            clamp: &mut self.clamp,
            now,
        };
        (&mut self.run, &mut self.feeder, site)
    }

    /// Reads ahead, outside the cycle; begins a run.
    fn prepare(&mut self) {
        let (run, feeder, mut site) = self.parts();
        if run.takes_begin(|| site.axes.rest()) {
            run.begin();
            run.set_off(&site.acting());
        }
        run.track.reserve();
        if run.progress().is_on_its_way() {
            run.prepare(feeder, 64, Position::ZERO, &site.acting(), |_, _| {});
        }
    }

    /// What a program has reached that has none of its own: it probes, ends or fails.
    fn take(&mut self, stop: Stop<RunFault>) {
        match stop {
            Stop::Barrier(Barrier::Probe {
                from,
                to,
                feed_mm_min,
                ..
            }) => {
                let axes = self.core.axes.of(0);
                let mut probing = Probing::new([from, to], feed_mm_min, None, &axes, &self.chain);
                // Nobody has to enable it.
                probing.begin();
                self.probing = Some(probing);
            }
            stop => {
                if let Stop::Error(fault) = stop {
                    self.fault = Some(fault);
                }
                let (run, _, mut site) = self.parts();
                run.break_off(&mut site.acting());
                run.end();
            }
        }
    }

    /// Moves the axes of a probing for a cycle.
    fn probe(&mut self, mut probing: Probing) {
        let (run, _, mut site) = self.parts();
        let runs = run.progress().goes_on();
        match probing.moves(runs, &mut site.axes, site.chain, &site.now) {
            Probed::Over(position) => {
                let touch = position.map(|position| Touch { position });
                let answer = LiveData {
                    touch,
                    ..LiveData::default()
                };
                let here = site.acting().here();
                run.go_on_with(answer, here);
                (self.probing, self.touch) = (None, touch);
            }
            _ => self.probing = Some(probing),
        }
    }

    /// Moves the axes along the path for a cycle.
    fn follow_path(&mut self) {
        let demands = Demands {
            single_block: self.single,
            ..Demands::default()
        };
        let (run, _, mut site) = self.parts();
        match run.moves(&demands, &mut site) {
            Came::On => {}
            Came::BlockEnd => run.end_block(demands.single_block, false),
            Came::NoThread => unreachable!("no program has a thread"),
            Came::Refused(refused) => {
                run.break_off(&mut site.acting());
                self.refused = Some(refused.sequence);
            }
            Came::Stop(stop) => self.take(stop),
        }
    }

    /// Moves Y by hand for a cycle; whether it is where it is to be.
    fn move_y(&mut self, to: f64) -> bool {
        let (_, _, mut site) = self.parts();
        let now = site.now;
        let mut there = false;
        for unit in site.axes.iter_mut().filter(|unit| unit.axis == Axis::Y) {
            let wanted = HandMove {
                wheel: Some(to),
                ..HandMove::default()
            };
            move_by_hand(unit, &wanted, &Now { stop: false, ..now });
            there = unit.ptp.is_at(to) && unit.stands();
        }
        there
    }
}

impl Family for Bench {
    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn begin_step(&mut self, measured: &Measured) {
        if let Some(probing) = &mut self.probing {
            probing.watch(measured.probe.deflected, self.core.axes.owned(0), &self.chain);
        }
    }

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
        self.run.stop();
    }

    fn come_to_a_stand(&mut self) -> bool {
        self.run.axes_stand(&self.core.axes.of(0))
    }

    fn loops_closed(&mut self) {}

    fn loops_open(&mut self) {
        self.run.track.halt();
    }

    fn follow_loops(&mut self, _: &Measured) {}

    fn move_axes(&mut self, _: &Measured) {
        let (run, _, mut site) = self.parts();
        let now = site.now;
        if now.stop {
            run.stop();
        } else if now.start && !run.restores() {
            run.start(&mut site);
        }
        if let Some(to) = self.by_hand {
            if self.move_y(to) {
                self.by_hand = None;
            }
        } else {
            let mut probing = self.probing;
            let (run, _, mut site) = self.parts();
            let held = |axes: &OwnAxes| {
                probing
                    .as_mut()
                    .is_some_and(|probing| probing.line().is_held(axes))
            };
            if run.may_move(held, &mut site.acting()) {
                match probing {
                    Some(probing) => self.probe(probing),
                    None => self.follow_path(),
                }
            }
        }
        let (run, feeder, mut site) = self.parts();
        run.move_back(Some(feeder), &mut site);
        self.start = false;
    }

    fn settle(&mut self) {}

    fn rest(&mut self, _: &Measured) {}

    fn transfer(&mut self) {}

    fn end_cycle(&mut self, _: &Measured) {}
}

/// A machine whose axes go where they are told, with an EMERGENCY STOP button, and a stylus that meets a work piece.
#[derive(Default)]
struct Machine {
    axes: IdealAxes,
    pressed: bool,
    /// The count of X from which on the stylus is deflected.
    side: Option<i64>,
}

impl Plant for Machine {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.axes.exchange(step, commands, measured);
        measured.control_ready &= !self.pressed;
        measured.probe.deflected = self.side.is_some_and(|side| self.axes.count(0) >= side);
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

    /// NC start.
    fn start(&mut self) {
        self.bench.start = true;
        self.cycle();
    }

    /// NC stop, until the axes stand.
    fn stop(&mut self) {
        self.bench.stop = true;
        self.until(|rig| rig.bench.core.axes.iter().all(AxisUnit::stands));
        self.bench.stop = false;
    }

    fn has_ended(&self) -> bool {
        self.bench.run.progress().has_ended()
    }

    fn state(&self) -> RunState {
        self.bench.run.progress().state()
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
    rig.start();
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
    rig.until(Rig::has_ended);
    let [x, y] = rig.at();
    assert!((x - 60.0).abs() < 0.01 && (y - 30.0).abs() < 0.01, "{x} {y}");
    assert_eq!(rig.bench.fault, None);
}

/// X+500 is the limit of the axis: a program that asks for more ends before it.
#[test]
fn what_leaves_the_traverse_range_is_refused() {
    let mut rig = Rig::on(&[(20.0, 0.0, None), (500.1, 0.0, None)]);
    rig.start();
    rig.until(Rig::has_ended);
    assert!(
        matches!(rig.bench.fault, Some(RunFault::Limit { axis: Axis::X, .. })),
        "{:?}",
        rig.bench.fault
    );
    assert!((rig.at()[0] - 20.0).abs() < 0.01);
}

/// A function that the control does not have, before X moves to 60: its block does not begin, and the one after it neither.
#[test]
fn a_function_that_is_refused_refuses_its_block() {
    let mut rig = Rig::on(&[(20.0, 0.0, None), (60.0, 0.0, Some(UNKNOWN)), (90.0, 0.0, None)]);
    rig.start();
    rig.until(|rig| rig.bench.refused.is_some());
    assert_eq!(rig.bench.refused, Some(2));
    assert!((rig.at()[0] - 20.0).abs() < 0.01);
}

/// EMERGENCY STOP at 50 mm/s: X brakes with 2 m/s², v²/(2a) = 0.625 mm, and a cycle of 3 ms, 0.15 mm, before. Then its loop is
/// open. When the voltage is back the program goes on to its end.
#[test]
fn an_emergency_stop_brakes_and_opens_the_loops() {
    let mut rig = Rig::on(&[(400.0, 0.0, None)]);
    rig.start();
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
    rig.start();
    rig.until(Rig::has_ended);
    assert!((rig.at()[0] - 400.0).abs() < 0.01, "{:?}", rig.at());
}

/// X goes to 60 and stops there; NC start leads Y to 30.
#[test]
fn a_programmed_stop_waits_for_nc_start() {
    let mut rig = Rig::on(&[(60.0, 0.0, None), (60.0, 30.0, Some(STOP))]);
    rig.start();
    rig.until(|rig| rig.state() == RunState::Stopped);
    for _ in 0..100 {
        rig.cycle();
    }
    assert_eq!(rig.at().map(f64::round), [60.0, 0.0], "nothing moves by itself");
    rig.start();
    rig.until(Rig::has_ended);
    assert_eq!(rig.at().map(f64::round), [60.0, 30.0]);
}

/// Each block waits for its own NC start.
#[test]
fn single_blocks_wait_for_nc_start() {
    let mut rig = Rig::on(&[(20.0, 0.0, None), (20.0, 10.0, None)]);
    rig.bench.single = true;
    rig.start();
    rig.until(|rig| rig.state() == RunState::BlockEnd);
    assert_eq!(rig.at().map(f64::round), [20.0, 0.0]);
    rig.start();
    rig.until(|rig| rig.at()[1] > 9.9);
    rig.until(|rig| rig.has_ended() || rig.state() == RunState::BlockEnd);
    assert_eq!(rig.at().map(f64::round), [20.0, 10.0]);
}

/// X is stopped on its way to 100, Y led away to 10 by hand, and both are brought back: first they go to where the path was
/// left, with an NC start of their own, then X goes on. At 50 mm/s X brakes with 2 m/s² on v²/(2a) = 0.625 mm.
#[test]
fn an_interrupted_run_is_restored() {
    let mut rig = Rig::on(&[(100.0, 0.0, None)]);
    rig.start();
    rig.until(|rig| rig.at()[0] > 50.0);
    let [before, _] = rig.at();
    rig.stop();
    let [left, _] = rig.at();
    assert!((0.5..=0.625 + 0.15 + 0.05).contains(&(left - before)), "{left}");
    let mut axes = rig.bench.core.axes.of(0);
    assert!(rig.bench.run.leave_path(true, false, &mut axes));
    rig.bench.by_hand = Some(10.0);
    rig.until(|rig| rig.bench.by_hand.is_none());
    assert_eq!(rig.at().map(f64::round), [left.round(), 10.0]);

    let (run, _, mut site) = rig.bench.parts();
    assert!(run.restore(true, &mut site.acting()));
    rig.cycle();
    assert!((rig.at()[1] - 10.0).abs() < 0.01, "it waits for NC start");
    rig.start();
    rig.until(|rig| !rig.bench.run.restores());
    let [x, y] = rig.at();
    assert!(
        (x - left).abs() < 0.01 && y.abs() < 0.01,
        "back on the contour: {x} {y}"
    );
    assert_eq!(rig.state(), RunState::Interrupted);
    rig.start();
    rig.until(Rig::has_ended);
    let [x, y] = rig.at();
    assert!((x - 100.0).abs() < 0.01 && y.abs() < 0.01, "{x} {y}");
}

/// The work piece begins at X 50. At 10 mm/s X is at most 6 µm beyond when a servo step of 0.6 ms sees it; the program learns of
/// the place, X goes back to it, and on from there.
#[test]
fn a_probing_finds_the_side() {
    let mut rig = Rig::on(&[(20.0, 0.0, None), (80.0, 0.0, Some(PROBE)), (45.0, 30.0, None)]);
    rig.bench.single = true;
    rig.start();
    rig.until(|rig| rig.at()[0] > 19.99 && rig.bench.core.axes.iter().all(AxisUnit::stands));
    let steps_per_mm = rig.plant.axes.count(0) as f64 / 20.0;
    rig.plant.side = Some((50.0 * steps_per_mm).round() as i64);
    rig.bench.single = false;
    rig.start();
    rig.until(|rig| rig.bench.probing.is_some());
    rig.until(|rig| rig.bench.probing.is_none());
    let step_mm = 10.0 * f64::from(rig.bench.core.timing.step_us()) * 1e-6;
    let [x, _] = rig.at();
    assert!(
        (50.0..=50.0 + 2.0 * step_mm).contains(&x),
        "{x}, a step is {step_mm} mm"
    );
    rig.until(Rig::has_ended);
    assert_eq!(rig.at().map(f64::round), [45.0, 30.0]);
}

/// Nothing is met: the program goes on at the farthest place.
#[test]
fn a_probing_that_meets_nothing_ends_at_its_farthest_place() {
    let mut rig = Rig::on(&[(40.0, 0.0, Some(PROBE))]);
    rig.start();
    rig.until(Rig::has_ended);
    assert_eq!(rig.at().map(f64::round), [40.0, 0.0]);
    assert_eq!((rig.bench.touch, rig.bench.fault), (None, None));
}
