//! The gates of a path hold for a family that is none of the shipped ones: its functions are numbers, and what takes them is done
//! after a time.

use std::sync::Arc;

use bahn_kernel::gates::{Action, Driving, Functions, Gates, Leg, Moment, Short, VectorLimit, Way};
use bahn_motion::{Drive, Limits};
use bahn_path::{Ahead, Axis, Curve, PerAxis, Position};

/// A cycle, s.
const T: f64 = 0.001;
/// Acceleration, mm/s².
const A: f64 = 1000.0;
/// Feed, mm/s.
const V: f64 = 10.0;

/// A function: since which cycle it is out, if it is.
#[derive(Clone, Copy, Default)]
struct Valve {
    out: Option<u64>,
}

/// A family that opens valves, each of which takes so many cycles.
struct Valves {
    cycle: u64,
    takes: u64,
    list: Vec<Valve>,
    /// Which went out, where, and whether on the way back.
    outputs: Vec<(usize, f64, f64, bool)>,
    /// When it was reported that the path came to rest, or went.
    reported: Vec<(bool, f64)>,
    ended: bool,
}

impl Functions for Valves {
    type Ticket = usize;
    /// The path ends.
    type Own = ();

    fn cycle(&self) -> u64 {
        self.cycle
    }

    fn is_done(&self, valve: usize) -> bool {
        let out = self.list.get(valve).and_then(|valve| valve.out);
        out.is_some_and(|out| self.cycle >= out + self.takes)
    }

    fn is_open(&self, valve: usize) -> bool {
        self.is_done(valve)
    }

    fn stands_for(&self, _: usize) -> bool {
        true
    }

    fn is_waited_for(&self, _: usize) -> bool {
        true
    }

    fn waits_backward(&self, _: usize) -> bool {
        false
    }

    fn blocker(&self, _: usize) -> Option<usize> {
        None
    }

    fn any_blocked(&self) -> bool {
        false
    }

    fn command(&mut self, _: usize) {}

    fn output(&mut self, valve: usize, at: Moment, way: Way) {
        self.list[valve].out = Some(self.cycle);
        self.outputs
            .push((valve, at.position[Axis::X], at.t, way == Way::Back));
    }

    fn again(&mut self, _: usize, _: bool) -> Option<usize> {
        self.list.push(Valve::default());
        Some(self.list.len() - 1)
    }

    fn renamed(&mut self, _: &dyn Fn(&mut usize)) {}

    fn act(&mut self, (): &(), _: Position, all_out: bool) -> bool {
        self.ended = all_out;
        all_out
    }

    fn stops_for(&self, (): &()) -> bool {
        true
    }

    fn waits_for(&self, (): &()) -> bool {
        false
    }

    fn goes_on(&self) -> bool {
        !self.ended
    }

    fn beside(&self, path: Position) -> Position {
        path
    }

    fn move_beside(&mut self) -> bool {
        false
    }

    fn tell(&mut self, moves: bool, _: &str, at: Moment) {
        self.reported.push((moves, at.t));
    }

    fn went(&mut self, _: f64, _: f64) {}

    fn tell_short_lead(&mut self, _: usize, _: Short) {}
}

/// Room for all that is noted in a test.
fn with_room<T>(mut list: Vec<T>) -> Vec<T> {
    list.reserve(20_000);
    list
}

struct Bench {
    gates: Gates<usize, ()>,
    valves: Valves,
    x: f64,
}

impl Bench {
    /// A path from X0, with two valves that take so many cycles.
    fn new(takes: u64) -> Bench {
        let limits = Limits {
            max_feed_mm_min: PerAxis::splat(10_000.0),
            acceleration_m_s2: PerAxis::splat(A / 1000.0),
            radial_acceleration_m_s2: 1.0,
            corner_angle_deg: 10.0,
            servo_lag: true,
            cycle_s: T,
            servo_window_s: bahn_motion::SERVO_WINDOW_S,
            spindle: Default::default(),
            feed_override_percent: 100.0,
            rapid_override_percent: 100.0,
        };
        let mut start = Position::UNKNOWN;
        start[Axis::X] = 0.0;
        Bench {
            gates: Gates::new(&limits, T, start, false),
            valves: Valves {
                cycle: 0,
                takes,
                list: with_room(vec![Valve::default(); 2]),
                outputs: with_room(Vec::new()),
                reported: with_room(Vec::new()),
                ended: false,
            },
            x: 0.0,
        }
    }

    /// A line of 10 mm; so many lines may still be split.
    fn line(&mut self, split: usize) {
        let [mut start, mut end] = [Position::UNKNOWN; 2];
        (start[Axis::X], end[Axis::X]) = (self.x, self.x + 10.0);
        self.x += 10.0;
        let driving = Driving {
            rapid: false,
            feed_mm_min: V * 60.0,
            limit: VectorLimit::NONE,
        };
        let leg = Leg {
            curve: Curve::Line,
            start,
            end,
            driving,
            block: Arc::from("N10"),
            unit: 1,
            length_mm: 10.0,
            from_mm: self.gates.window.distance(),
        };
        self.gates.push(leg, split, 50);
    }

    fn at_end(&mut self, action: Action<usize, ()>) {
        self.gates.window.action(action);
    }

    /// Runs to the end, the last action, backward in these cycles.
    fn run(self, backward: std::ops::Range<u64>) -> Valves {
        self.run_so(|cycle, _| (Drive::default(), backward.contains(&cycle)))
    }

    /// Runs to the end, the last action, driven and backward in each cycle as is said. No cycle allocates.
    fn run_so(mut self, mut so: impl FnMut(u64, &mut Gates<usize, ()>) -> (Drive, bool)) -> Valves {
        self.at_end(Action::Own(()));
        self.gates.release();
        self.gates.closed = true;
        while !self.valves.ended {
            let Bench { gates, valves, .. } = &mut self;
            assert!(valves.cycle < 60_000, "it comes to its end");
            let allocated = allocation_counter::measure(|| {
                let (drive, back) = so(valves.cycle, gates);
                match gates.is_backward() {
                    true => while gates.act_backward(valves) {},
                    false => while gates.output_ahead(&drive, valves) | gates.act(valves) {},
                }
                for valve in gates.missing(&drive, valves) {
                    assert!(!valves.is_done(valve), "{valve} is not missing");
                }
                gates.cycle(drive, back, valves);
            });
            assert_eq!(allocated.count_total, 0, "cycle {}", valves.cycle);
            valves.cycle += 1;
        }
        self.valves
    }
}

/// From standstill to standstill over 10 mm with 10 mm/s and 1 m/s²: s/v + v/a, s.
const LINE_S: f64 = 10.0 / V + V / A;

fn near(is: f64, expected: f64, within: f64) {
    assert!((is - expected).abs() <= within, "{is} is not {expected}");
}

/// Output place and wait place between two lines: the path stands there until the valve is open, half a second.
#[test]
fn the_path_waits_at_its_wait_place() {
    let mut bench = Bench::new(500);
    bench.line(1);
    bench.at_end(Action::Output(0));
    bench.at_end(Action::Gate([0].into()));
    bench.line(1);
    let run = bench.run(0..0);
    let [(valve, x, t, _)] = run.outputs[..] else {
        panic!("{:?}", run.outputs)
    };
    assert_eq!(valve, 0);
    near(x, 10.0, 1e-9);
    near(t, LINE_S, 2.0 * T);
    near(run.cycle as f64 * T, 2.0 * LINE_S + 0.5, 5.0 * T);
}

/// Output before the line, wait place after it: the valve is open before the path must brake, which so does not stop.
#[test]
fn a_wait_place_that_is_open_in_time_is_passed() {
    let mut bench = Bench::new(500);
    bench.at_end(Action::Output(0));
    bench.line(1);
    bench.at_end(Action::Gate([0].into()));
    bench.line(1);
    let run = bench.run(0..0);
    // It begins to move once, and is not at rest again before its end.
    assert_eq!(
        run.reported.iter().map(|(moves, _)| *moves).collect::<Vec<_>>(),
        [true]
    );
    near(run.cycle as f64 * T, 20.0 / V + V / A, 5.0 * T);
}

/// 4 mm ahead of X10 a function goes out at X6; 0.3 s ahead, where nothing stops the path, at X7.
#[test]
fn leads_count_by_way_and_time() {
    let mut bench = Bench::new(0);
    bench.line(1);
    bench.gates.leads.push(0, 2, Ahead::Distance(4.0), 10.0);
    bench.gates.leads.push(1, 2, Ahead::Time(0.3), 10.0);
    bench.line(1);
    let run = bench.run(0..0);
    let place = |of: usize| run.outputs.iter().find(|(valve, ..)| *valve == of).unwrap().1;
    near(place(0), 6.0, 1e-6);
    near(place(1), 7.0, V * T);
}

/// A Micro Joint: the place lies within a line, which is split for it, and the path does not stop.
#[test]
fn a_line_is_split_for_a_joint() {
    let mut bench = Bench::new(0);
    bench.line(2);
    bench.line(2);
    let planned = bench.gates.window.plan(12.5, f64::INFINITY);
    bench
        .gates
        .window
        .insert(planned.real_mm, vec![Action::Output(0)], None);
    let run = bench.run(0..0);
    near(run.outputs[0].1, 20.0 - 12.5, 1e-9);
    near(run.cycle as f64 * T, 20.0 / V + V / A, 5.0 * T);
}

/// Turned back at 1.5 s, at X14.9, for a second: the path comes over X10 again, where the function goes out as another one, and
/// once more when it goes forward.
#[test]
fn on_the_way_back_functions_go_out_again() {
    let mut bench = Bench::new(0);
    bench.line(1);
    bench.at_end(Action::Output(0));
    bench.line(1);
    let run = bench.run(1500..2500);
    let ways: Vec<bool> = run.outputs.iter().map(|(.., back)| *back).collect();
    assert_eq!(ways, [false, true, false]);
    for (_, x, ..) in &run.outputs {
        near(*x, 10.0, 1e-9);
    }
    let valves: Vec<usize> = run.outputs.iter().map(|(valve, ..)| *valve).collect();
    assert_eq!(valves[0], 0);
    assert!(valves[1] > 1 && valves[2] > valves[1], "{valves:?}");
}

/// Whatever happens on the way, no cycle allocates: functions at places and ahead of them, dwells, single block with its starts,
/// holds, overrides and turns. All functions go out, some of them on the way back and forward again.
#[test]
fn no_cycle_allocates() {
    const LINES: usize = 40;
    let mut bench = Bench::new(30);
    bench.valves.list.resize(4 * LINES, Valve::default());
    for line in 0..LINES {
        let (valve, unit) = (4 * line, line as u64 + 1);
        let point = 10.0 * line as f64;
        if line > 0 {
            bench.gates.leads.push(valve, unit, Ahead::Distance(4.0), point);
            bench.gates.leads.push(valve + 1, unit, Ahead::Time(0.3), point);
            bench.at_end(Action::Gate([valve, valve + 1].into()));
        }
        bench.at_end(Action::Output(valve + 2));
        bench.line(1);
        bench.at_end(Action::Output(valve + 3));
        bench.at_end(Action::Gate([valve + 2, valve + 3].into()));
        if line % 8 == 0 {
            bench.at_end(Action::Dwell(0.05));
        }
        bench.at_end(Action::BlockEnd);
    }
    let run = bench.run_so(|cycle, gates| {
        gates.single_block(cycle % 5000 > 3500);
        if cycle % 300 == 0 {
            gates.start(cycle as f64 * T);
        }
        let drive = Drive {
            hold: cycle % 700 > 640,
            feed_override_percent: 60.0 + (cycle / 500 % 10) as f64 * 10.0,
            ..Drive::default()
        };
        (drive, cycle % 4000 > 3000 && cycle < 30_000)
    });
    let forward = |back: bool| run.outputs.iter().filter(move |(.., of)| *of == back).count();
    assert!(forward(false) > 4 * LINES - 2, "{}", forward(false));
    assert!(forward(true) > 20, "{}", forward(true));
    near(run.outputs.last().unwrap().1, 10.0 * LINES as f64, 1e-9);
}
