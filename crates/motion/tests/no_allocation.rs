//! A contour cycle allocates nothing and frees nothing.
#![allow(clippy::panic, reason = "a test may fail")]

mod common;

use bahn_motion::{Drive, Interpolator, State};
use bahn_path::{At, Axis, Function, Position, Step, Synchronisation, TechnologyFunction};
use common::{Path, limits, list};

/// A path with all that there is: lines, arcs, corners, functions that wait and that do not, dwell.
fn path() -> Path {
    let mut path = Path::new(6000.0);
    for i in 0..200 {
        path.by(&[(Axis::X, 0.1), (Axis::Y, 0.001 * f64::from(7 * i % 10))]);
        if i % 10 == 0 {
            path.turn(f64::from(i), 0.5, 180.0, 0.1);
        }
        if i % 7 == 0 {
            let function = |at, synchronisation| TechnologyFunction {
                function: Function::Print(format!("line {i}")),
                at,
                synchronisation,
            };
            path.last().functions = Some(Box::new([
                function(At::Start, Synchronisation::Mos),
                function(At::Length(0.05), Synchronisation::Mos),
                function(At::End, Synchronisation::MnsSns),
            ]));
        }
        if i % 50 == 0 {
            path.hold(0.01);
        }
    }
    path
}

#[test]
fn no_cycle_allocates() {
    let elements = path().elements;
    let count = elements.len();
    let mut source = list(elements.into_iter().map(Step::Element).collect());
    let mut path: Interpolator<&str> = Interpolator::new(&limits(), 100);
    path.set_position(Position::ZERO);
    let (mut outputs, mut executed) = (0, 0);
    for cycle in 0..100_000 {
        let drive = Drive {
            feed_override_percent: f64::from(cycle % 150 + 1),
            hold: cycle % 100 < 10,
            single_block: cycle % 500 < 100,
            ..Drive::default()
        };
        path.prepare(&mut source, 20);
        let mut state = State::Empty;
        let allocated = allocation_counter::measure(|| {
            state = path.cycle(&drive).state;
            match state {
                State::Gate(_) => path.release(),
                State::BlockEnd => path.go_on(),
                _ => {}
            }
        });
        assert_eq!(
            (allocated.count_total, allocated.count_current),
            (0, 0),
            "cycle {cycle}"
        );
        // Asked for late, so that they wait in the queue.
        if cycle % 20 == 0 || state == State::Stopped {
            outputs += std::iter::from_fn(|| path.next_output()).count();
        }
        executed = executed.max(path.element().map_or(0, |element| element.sequence));
        if state == State::Stopped {
            assert_eq!(executed, count as u64);
            // 29 elements with functions at three places.
            assert_eq!(outputs, 3 * 29);
            return;
        }
    }
    panic!("it does not end");
}
