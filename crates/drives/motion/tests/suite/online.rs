//! The interpolator: the path in contour cycles with overrides, stops and gates.

use crate::common::{List, Path, limits, list, plan, time_s};
use bahn_motion::{Drive, Gate, Interpolator, Limits, Place, Prepared, State, Stop};
use bahn_path::{
    At, Axis, Barrier, Function, LiveData, PathElement, Position, Sense, Step, Synchronisation,
    TechnologyFunction,
};

const T: f64 = 0.003;

struct Bench {
    source: List,
    path: Interpolator<&'static str>,
    drive: Drive,
}

impl Bench {
    fn new(elements: &[PathElement], limits: &Limits) -> Bench {
        let steps = elements.iter().cloned().map(Step::Element).collect();
        Bench::of(steps, limits)
    }

    fn of(steps: Vec<Step<&'static str>>, limits: &Limits) -> Bench {
        let mut path = Interpolator::new(limits, 64);
        path.set_position(Position::ZERO);
        Bench {
            source: list(steps),
            path,
            drive: Drive::default(),
        }
    }

    fn cycle(&mut self) -> State {
        self.path.prepare(&mut self.source, usize::MAX);
        self.path.cycle(&self.drive).state
    }

    /// Cycles until the state is another one; how many there were of it, and the new state.
    fn run(&mut self, while_in: State) -> (usize, State) {
        for count in 0..1_000_000 {
            let state = self.cycle();
            if state != while_in {
                return (count, state);
            }
        }
        panic!("for ever in {while_in:?}");
    }

    fn cycles(&mut self, count: usize) {
        for _ in 0..count {
            self.cycle();
        }
    }

    fn x(&self) -> f64 {
        self.path.position()[Axis::X]
    }

    fn speed(&self) -> f64 {
        self.path.speed_mm_s()
    }
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9, "{a} is not {b}");
}

fn m(number: u16, at: At, synchronisation: Synchronisation) -> TechnologyFunction {
    TechnologyFunction::new(Function::M(number), at, synchronisation)
}

/// 100 mm at 100 mm/s with 1000 mm/s²: 1.1 s are 366 cycles of 3 ms and a rest.
#[test]
fn one_line_takes_as_long_as_planned() {
    let elements = Path::new(6000.0).line(&[(Axis::X, 100.0)]).elements.clone();
    let mut bench = Bench::new(&elements, &limits());
    assert_eq!(bench.cycle(), State::Moving);
    close(bench.x(), 0.5 * 1000.0 * T * T);
    close(bench.speed(), 3.0);
    assert_eq!(bench.run(State::Moving), (365, State::Stopped));
    assert_eq!(bench.x(), 100.0);
    assert_eq!(bench.speed(), 0.0);
    assert_eq!(bench.path.take_stop(), Some(Stop::End));
    assert_eq!(bench.path.take_stop(), None);
    assert_eq!(bench.cycle(), State::Empty);
}

/// 10 mm from standstill with 1000 mm/s² take sqrt(2 · 10 / 1000) s, and are passed at the speed that has grown until
/// then, within the cycle.
#[test]
fn the_end_of_an_element_is_reported_within_its_cycle() {
    let mut path = Path::new(12_000.0);
    path.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 100.0)]);
    let mut bench = Bench::new(&path.elements, &limits());
    let at_s = (2.0f64 * 10.0 / 1000.0).sqrt();
    let before = (at_s / T).floor() as usize;
    bench.cycles(before);
    assert!(bench.path.passed().is_empty());
    bench.cycle();
    let [passed] = bench.path.passed() else {
        panic!("{:?}", bench.path.passed());
    };
    assert_eq!(passed.sequence, 1);
    close(passed.left_s, (before + 1) as f64 * T - at_s);
    close(passed.speed_mm_s, 1000.0 * at_s);
    bench.cycle();
    assert!(bench.path.passed().is_empty());
}

/// From 100 to 50 mm/s in 50 ms over 3.75 mm.
#[test]
fn a_lower_override_brakes_with_the_path_acceleration() {
    let elements = Path::new(6000.0).line(&[(Axis::X, 100.0)]).elements.clone();
    let mut bench = Bench::new(&elements, &limits());
    bench.cycles(100);
    close(bench.speed(), 100.0);
    let from = bench.x();
    bench.drive.feed_override_percent = 50.0;
    for k in 1..=16 {
        bench.cycle();
        close(bench.speed(), 100.0 - 3.0 * f64::from(k));
    }
    bench.cycle();
    close(bench.speed(), 50.0);
    close(bench.x(), from + 3.75 + 50.0 * (17.0 * T - 0.05));
}

/// Held at 100 mm/s the path stands 5 mm on, in the midst of a line, and goes on from there.
#[test]
fn a_held_path_stands_where_it_can_and_goes_on() {
    let elements = Path::new(6000.0).line(&[(Axis::X, 100.0)]).elements.clone();
    let mut bench = Bench::new(&elements, &limits());
    bench.cycles(100);
    let from = bench.x();
    bench.drive.hold = true;
    // 0.1 s to brake: 33.3 cycles.
    assert_eq!(bench.run(State::Moving), (34, State::Held));
    close(bench.x(), from + 5.0);
    assert_eq!(bench.path.rest_mm(), 100.0 - bench.x());
    bench.drive.hold = false;
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
    assert_eq!(bench.x(), 100.0);
}

#[test]
fn override_zero_stands_too() {
    let elements = Path::new(6000.0).line(&[(Axis::X, 100.0)]).elements.clone();
    let mut bench = Bench::new(&elements, &limits());
    bench.drive.feed_override_percent = 0.0;
    (0..10).for_each(|_| assert_eq!(bench.cycle(), State::Moving));
    assert_eq!(bench.x(), 0.0);
    bench.drive.feed_override_percent = f64::NAN;
    bench.cycle();
    assert_eq!(bench.x(), 0.0);
    bench.drive.feed_override_percent = 100.0;
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
}

/// M3 before the movement and M5 after it wait, M8 does not.
#[test]
fn gates_wait_for_release() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 20.0)]);
    path.last().functions = Some(Box::new([
        m(3, At::Start, Synchronisation::MvsSvs),
        m(8, At::Length(5.0), Synchronisation::Mos),
        m(5, At::End, Synchronisation::MnsSns),
    ]));
    path.line(&[(Axis::X, 30.0)]);
    let mut bench = Bench::new(&path.elements, &limits());
    assert_eq!(bench.run(State::Moving).1, State::Gate(Gate::Start));
    assert_eq!(bench.x(), 10.0);
    let output = bench.path.next_output().unwrap();
    assert_eq!(
        (output.place, output.waits, output.sequence),
        (Place::Start, true, 2)
    );
    let functions: Vec<_> = bench
        .path
        .functions(&output)
        .map(|f| f.function.clone())
        .collect();
    assert_eq!(functions, [Function::M(3)]);
    assert_eq!(bench.path.next_output(), None);
    (0..5).for_each(|_| assert_eq!(bench.cycle(), State::Gate(Gate::Start)));
    bench.path.release();
    let passed = loop {
        assert_eq!(bench.cycle(), State::Moving);
        if let Some(output) = bench.path.next_output() {
            break output;
        }
    };
    assert_eq!((passed.place, passed.waits), (Place::Along(1), false));
    assert!((15.0..15.31).contains(&bench.x()), "{}", bench.x());
    // Acknowledged before the path is there: it does not wait, but the function comes.
    bench.path.release();
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
    let output = bench.path.next_output().unwrap();
    assert_eq!((output.place, output.waits), (Place::End, false));
}

/// 10 mm, 0.5 s of dwell, 10 mm: two movements of 0.2 s (0.1 s up, 0.1 s down).
#[test]
fn dwell_takes_its_time_and_is_held() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]).hold(0.5).line(&[(Axis::X, 20.0)]);
    let mut bench = Bench::new(&path.elements, &limits());
    // 66 cycles are 0.198 s: the 67th ends in the dwell.
    assert_eq!(bench.run(State::Moving), (66, State::Dwell));
    bench.drive.hold = true;
    (0..100).for_each(|_| assert_eq!(bench.cycle(), State::Held));
    bench.drive.hold = false;
    // 0.201 s are over; at 0.699 s the dwell is not.
    assert_eq!(bench.run(State::Dwell), (166, State::Moving));
    // That was 0.702 s; the end is at 0.9 s = 300 cycles.
    let (count, state) = bench.run(State::Moving);
    assert!(
        state == State::Stopped && (65..=66).contains(&count),
        "{count} {state:?}"
    );
}

#[test]
fn single_block_stops_at_the_end_of_each_block() {
    let mut path = Path::new(6000.0);
    for i in 1..=4 {
        path.line(&[(Axis::X, 10.0 * f64::from(i))]);
    }
    // The second block has two elements.
    path.elements[2].sequence = 2;
    let mut bench = Bench::new(&path.elements, &limits());
    bench.drive.single_block = true;
    for x in [10.0, 30.0, 40.0] {
        assert_eq!(bench.run(State::Moving).1, State::BlockEnd);
        assert_eq!((bench.x(), bench.speed()), (x, 0.0));
        assert_eq!(bench.cycle(), State::BlockEnd);
        bench.path.go_on();
    }
    assert_eq!(bench.cycle(), State::Stopped);
}

/// At 100 mm/s the path needs 5 mm to stop: 2 mm before the end of a block it stops at the next end.
#[test]
fn single_block_in_full_run_stops_where_it_can() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 20.0)])
        .line(&[(Axis::X, 40.0)])
        .line(&[(Axis::X, 60.0)]);
    for (from, to) in [(14.0, 20.0), (18.0, 40.0)] {
        let mut bench = Bench::new(&path.elements, &limits());
        while bench.x() < from {
            bench.cycle();
        }
        bench.drive.single_block = true;
        assert_eq!(bench.run(State::Moving).1, State::BlockEnd);
        assert_eq!(bench.x(), to);
    }
}

#[test]
fn a_barrier_comes_after_the_path_and_is_answered() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 20.0)]);
    let [first, second] = [0, 1].map(|i| Step::Element(path.elements[i].clone()));
    let barrier = Barrier::Stop {
        block: path.elements[0].block,
    };
    let steps = vec![first, Step::Barrier(barrier), second, Step::Error("wrong")];
    let mut bench = Bench::of(steps, &limits());
    assert_eq!(bench.path.take_stop(), None);
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
    assert_eq!(bench.x(), 10.0);
    assert_eq!(bench.path.prepare(&mut bench.source, 10), Prepared::Closed);
    assert_eq!(bench.path.take_stop(), Some(Stop::Barrier(barrier)));
    bench.path.resume(&mut bench.source, LiveData::default());
    assert_eq!(bench.source.resumed, 1);
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
    assert_eq!(bench.x(), 20.0);
    assert_eq!(bench.path.take_stop(), Some(Stop::Error("wrong")));
}

/// An element that comes before the path has braked for the end of what was known is no stop.
#[test]
fn a_starved_path_goes_on_when_more_comes() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 20.1)]);
    let whole = time_s(&plan(&path.elements, &limits()));
    let [first, second] = [0, 1].map(|i| Step::Element(path.elements[i].clone()));
    let steps = vec![first, Step::Starved, Step::Starved, Step::Starved, second];
    let mut bench = Bench::of(steps, &limits());
    assert_eq!(bench.path.prepare(&mut bench.source, 10), Prepared::Starved);
    let (count, state) = bench.run(State::Moving);
    assert_eq!(state, State::Stopped);
    assert_eq!(count, (whole / T) as usize);
}

#[test]
fn an_internal_stop_says_where() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 30.0)]);
    let mut bench = Bench::new(&path.elements, &limits());
    while bench.x() < 12.0 {
        bench.cycle();
    }
    bench.drive.hold = true;
    assert_eq!(bench.run(State::Moving).1, State::Held);
    let cut = bench.path.clear().unwrap();
    assert_eq!((cut.sequence, cut.block.block), (2, 2));
    close(cut.covered_mm, bench.x() - 10.0);
    close(cut.covered_mm + cut.rest_mm, 20.0);
    assert_eq!(cut.position, bench.path.position());
    assert_eq!(bench.path.clear(), None);
    // The next path starts where the first was cut, whatever its elements say.
    bench.source = list(vec![Step::Element(path.elements[0].clone())]);
    bench.drive.hold = false;
    let from = bench.x();
    bench.cycle();
    close(bench.x(), from - 0.5 * 1000.0 * T * T);
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
    assert_eq!(bench.x(), 10.0);
}

/// Axes without a position at the start of an element move from where they are.
#[test]
fn unknown_starts_are_where_the_axes_are() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]);
    path.last().start = Position::UNKNOWN;
    path.last().end[Axis::Z] = f64::NAN;
    let mut bench = Bench::new(&path.elements, &limits());
    let mut actual = Position::ZERO;
    (actual[Axis::X], actual[Axis::Y], actual[Axis::Z]) = (4.0, 8.0, 5.0);
    bench.path.set_position(actual);
    bench.cycle();
    // 6 mm in X and -8 mm in Y: 10 mm, of which the first cycle goes 4.5 µm.
    close(bench.x(), 4.0 + 0.6 * 0.0045);
    close(bench.path.position()[Axis::Y], 8.0 - 0.8 * 0.0045);
    assert_eq!(bench.path.position()[Axis::Z], 5.0);
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
    assert_eq!((bench.x(), bench.path.position()[Axis::Y]), (10.0, 0.0));
}

/// An arc keeps its place: from elsewhere the path goes straight to its start first.
#[test]
fn an_arc_is_approached() {
    let mut path = Path::new(6000.0);
    path.arc([10.0, 0.0], [20.0, 0.0], Sense::CounterClockwise);
    let mut bench = Bench::new(&path.elements, &limits());
    let mut actual = Position::ZERO;
    actual[Axis::Y] = 5.0;
    bench.path.set_position(actual);
    bench.cycle();
    let mut last = actual;
    let mut state = State::Moving;
    while state == State::Moving {
        let at = bench.path.position();
        // Half a mm is more than any cycle goes at 100 mm/s.
        let step = (at[Axis::X] - last[Axis::X]).hypot(at[Axis::Y] - last[Axis::Y]);
        assert!(step < 0.5, "{last:?} to {at:?}");
        let on_the_way = at[Axis::X] == 0.0 && at[Axis::Y] > 0.0;
        let radius = (at[Axis::X] - 10.0).hypot(at[Axis::Y]);
        assert!(on_the_way || (radius - 10.0).abs() < 1e-9, "{at:?}");
        last = at;
        state = bench.cycle();
    }
    assert_eq!(bench.path.position()[Axis::X], 20.0);
}

/// M8 at the start and M9 at the end do not stop the path; they come in the order of the path.
#[test]
fn functions_that_do_not_wait_are_passed() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 20.0)]);
    path.last().functions = Some(Box::new([
        m(9, At::End, Synchronisation::Mos),
        m(8, At::Start, Synchronisation::Mos),
    ]));
    path.line(&[(Axis::X, 30.1)]);
    let whole = time_s(&plan(&path.elements, &limits()));
    let mut bench = Bench::new(&path.elements, &limits());
    let mut seen = Vec::new();
    let mut count = 0;
    while bench.cycle() == State::Moving {
        count += 1;
        while let Some(output) = bench.path.next_output() {
            assert!(!output.waits);
            let functions: Vec<_> = bench
                .path
                .functions(&output)
                .map(|f| f.function.clone())
                .collect();
            seen.push((output.place, functions, (bench.x() / 10.0) as u32));
        }
    }
    assert_eq!(count, (whole / T) as usize);
    let expected = [
        (Place::Start, vec![Function::M(8)], 1),
        (Place::End, vec![Function::M(9)], 2),
    ];
    assert_eq!(seen, expected);
}

/// What is asked for in advance is forgotten with the path that it was meant for.
#[test]
fn an_internal_stop_at_a_gate_forgets_it() {
    let mut path = Path::new(6000.0);
    path.line(&[(Axis::X, 10.0)]);
    path.last().functions = Some(Box::new([m(3, At::Start, Synchronisation::MvsSvs)]));
    let mut bench = Bench::new(&path.elements, &limits());
    assert_eq!(bench.cycle(), State::Gate(Gate::Start));
    let cut = bench.path.clear().unwrap();
    assert_eq!((cut.sequence, cut.covered_mm, cut.rest_mm), (1, 0.0, 10.0));
    assert_eq!(bench.path.next_output(), None);
    bench.path.release();
    bench.path.clear();
    bench.source = list(path.elements.iter().cloned().map(Step::Element).collect());
    assert_eq!(bench.cycle(), State::Gate(Gate::Start));
    bench.path.release();
    assert_eq!(bench.run(State::Moving).1, State::Stopped);
}

/// From v on the way over v²/2a, within a block or over its end: with 1 m/s² 20 mm/s take 0.2 mm, as the path that is held
/// then shows.
#[test]
fn the_braking_distance_is_known() {
    let mut path = Path::new(1200.0);
    for _ in 0..100 {
        path.by(&[(Axis::X, 0.05)]);
    }
    let mut bench = Bench::new(&path.elements, &limits());
    assert_eq!(bench.path.braking_mm(), 0.0);
    bench.cycles(50);
    let v = bench.path.speed_mm_s();
    assert!((v - 20.0).abs() < 1e-9);
    let (from, distance) = (bench.x(), bench.path.braking_mm());
    assert!((distance - v * v / 2000.0).abs() < 1e-9, "{distance}");
    bench.drive.hold = true;
    bench.run(State::Moving);
    assert!((bench.x() - from - distance).abs() < 1e-9, "{}", bench.x() - from);
    assert_eq!(bench.path.braking_mm(), 0.0);
}
