//! A contour cycle allocates nothing and frees nothing.
#![allow(clippy::panic, reason = "a test may fail")]

mod common;

use std::collections::VecDeque;

use bahn_motion::{Drive, Interpolator, Master, State};
use bahn_path::{
    Ahead, At, Axis, AxisSet, ElementSource, FeedRate, Function, LiveData, OverrideLaw, PathElement,
    Position, Sense, Step, Synchronisation, TechnologyFunction, Thread,
};
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
            let function = |at, synchronisation| {
                TechnologyFunction::new(Function::Print(format!("line {i}").into()), at, synchronisation)
            };
            path.last().functions = Some(Box::new([
                function(At::Start, Synchronisation::Mos),
                function(At::Length(0.05), Synchronisation::Mos),
                function(At::Ahead(Ahead::Distance(0.3)), Synchronisation::MvsSvs),
                function(At::Start, Synchronisation::MvsSns),
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
            // 29 elements with functions at three places and one ahead.
            assert_eq!(outputs, 4 * 29);
            return;
        }
    }
    panic!("it does not end");
}

/// A source to which elements are given back.
struct Queue(VecDeque<PathElement>);

impl ElementSource for Queue {
    type Error = &'static str;

    fn next(&mut self) -> Step<&'static str> {
        self.0.pop_front().map_or(Step::End, Step::Element)
    }

    fn resume(&mut self, _: LiveData) {}
}

/// Blocks with feeds of their own, rapid traverse and threads among the others.
fn many_feeds() -> VecDeque<PathElement> {
    let mut path = path();
    for i in 0..600u32 {
        path.by(&[(Axis::X, 0.02)]);
        path.last().feed = match i % 10 {
            0 => FeedRate::Rapid,
            _ => FeedRate::Programmed(500.0 + f64::from(i * 37 % 6000)),
        };
        if i % 100 == 50 {
            path.by(&[(Axis::Z, -2.0)]);
            path.last().override_law = OverrideLaw::Spindle(Thread {
                pitch_mm: 1.0,
                spindle: Sense::Clockwise,
                orientation_deg: None,
                retracts: true,
            });
        }
    }
    path.elements.into()
}

/// Whatever the path is asked for at any moment: other overrides and limits, axes to be clamped, a movement back in a
/// thread, and to be taken back.
#[test]
fn whatever_is_done_no_cycle_allocates() {
    let mut source = Queue(many_feeds());
    let mut path: Interpolator<&str> = Interpolator::new(&limits(), 512);
    path.set_position(Position::ZERO);
    let (mut recalls, mut led, mut angle) = (0, 0, 0.0);
    for cycle in 0..200_000u32 {
        let drive = Drive {
            feed_override_percent: f64::from(cycle * 7919 % 150 + 1),
            rapid_override_percent: f64::from(cycle * 13 % 100 + 1),
            rapid_limit_mm_min: f64::from(10_000 + cycle % 100 / 10 * 500),
            master: Master {
                nominal_deg: angle,
                actual_deg: angle,
                ready: true,
            },
            back: cycle % 90 < 5,
            hold: cycle % 70 < 8,
            single_block: cycle % 400 < 50,
            clamping: if cycle % 60 < 10 {
                AxisSet::EMPTY.with(Axis::Z)
            } else {
                AxisSet::EMPTY
            },
            ..Drive::default()
        };
        path.prepare(&mut source, 50);
        let (mut state, mut lead) = (State::Empty, None);
        let allocated = allocation_counter::measure(|| {
            let now = path.cycle(&drive);
            (state, lead) = (now.state, now.lead);
            match state {
                State::Gate(_) => path.release(),
                State::BlockEnd => path.go_on(),
                State::Held if cycle % 5 == 0 && !path.is_coupled() => {
                    path.recall(now.position);
                    recalls += 1;
                }
                _ => {}
            }
            while path.next_output().is_some() {}
        });
        assert_eq!(
            (allocated.count_total, allocated.count_current),
            (0, 0),
            "cycle {cycle} {state:?}"
        );
        if let Some(lead) = lead {
            angle = lead.angle_deg;
            led += 1;
        }
        for element in path.take_recalled().into_iter().flatten().rev() {
            source.0.push_front(element);
        }
        if state == State::Stopped {
            assert!(recalls > 10 && led > 100, "{recalls} {led}");
            return;
        }
    }
    panic!("it does not end");
}

/// What is recalled is not lost: until it is taken nothing is read, and it comes but once.
#[test]
fn what_is_recalled_waits_to_be_taken() {
    let mut line = Path::new(6000.0);
    line.line(&[(Axis::X, 10.0)]).line(&[(Axis::X, 20.0)]);
    let mut source = Queue(line.elements.into());
    let mut path: Interpolator<&str> = Interpolator::new(&limits(), 10);
    path.set_position(Position::ZERO);
    path.prepare(&mut source, 1);
    let mut here = Position::ZERO;
    here[Axis::Y] = 5.0;
    path.recall(here);
    path.recall(here);
    path.prepare(&mut source, 10);
    assert_eq!(
        (path.cycle(&Drive::default()).state, source.0.len()),
        (State::Empty, 1)
    );
    let taken = path.take_recalled().unwrap_or_default();
    assert_eq!((taken.len(), taken[0].end[Axis::X]), (1, 10.0));
    assert_eq!(path.take_recalled(), None);
    // An internal stop drops it for good.
    source.0.push_front(taken[0].clone());
    path.prepare(&mut source, 1);
    path.recall(here);
    path.clear();
    path.recall(here);
    assert_eq!(path.take_recalled(), Some(Vec::new()));
    source.0.push_front(taken[0].clone());
    path.prepare(&mut source, 10);
    assert_eq!(path.element().map(|element| element.start[Axis::Y]), Some(5.0));
}

/// A copy of the path takes the memory that it has: elements without functions are run ahead in each cycle so. It goes on as
/// the path does.
#[test]
fn a_copy_in_place_allocates_nothing() {
    let mut path = Path::new(6000.0);
    for i in 0..300 {
        path.feed(FeedRate::Programmed(1000.0 + f64::from(i * 37 % 5000)));
        path.by(&[(Axis::X, 0.3), (Axis::Y, 0.01 * f64::from(7 * i % 10))]);
    }
    let mut source = list(path.elements.into_iter().map(Step::Element).collect());
    let mut path: Interpolator<&str> = Interpolator::new(&limits(), 100);
    path.set_position(Position::ZERO);
    let mut ahead = Interpolator::new(&limits(), 100);
    let mut cycles = 0;
    let drive = Drive::default();
    loop {
        let allocated = allocation_counter::measure(|| {
            path.prepare(&mut source, usize::MAX);
            ahead.clone_from(&path);
            ahead.cycle(&drive);
        });
        assert_eq!(allocated.count_total, 0, "cycle {cycles}");
        let state = path.cycle(&drive).state;
        assert_eq!(ahead.position(), path.position());
        assert_eq!(ahead.speed_mm_s(), path.speed_mm_s());
        if state == State::Stopped {
            break;
        }
        cycles += 1;
    }
    assert!(cycles > 300, "{cycles}");
}
