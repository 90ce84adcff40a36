//! Paths that follow the spindle.

use crate::common::{List, Path, function, list, plan, time_s};
use bahn_motion::{Cycle, Drive, Gate, Interpolator, Limits, Master, SpindleGear, State};
use bahn_path::{At, Axis, Curve, Function, OverrideLaw, Position, Sense, Step, Synchronisation, Thread};

const PITCH: f64 = 1.5;
const DEPTH: f64 = 30.0;
/// 600 rpm.
const FEED: f64 = 600.0 * PITCH;

fn limits() -> Limits {
    let mut spindle: [SpindleGear; 8] = Default::default();
    spindle[0] = SpindleGear {
        rated_rpm: 1000.0,
        ramp_rpm_s: 2000.0,
    };
    spindle[1] = SpindleGear {
        rated_rpm: 4000.0,
        ramp_rpm_s: 8000.0,
    };
    Limits {
        spindle,
        ..crate::common::limits()
    }
}

fn law(spindle: Sense, orientation_deg: Option<f64>) -> OverrideLaw {
    OverrideLaw::Spindle(Thread {
        pitch_mm: PITCH,
        spindle,
        orientation_deg,
        retracts: true,
    })
}

/// In and out of a hole of 30 mm, right-hand, and on at the clearance.
fn thread() -> Path {
    let mut path = Path::new(FEED);
    path.line(&[(Axis::Z, -DEPTH)]).last().override_law = law(Sense::Clockwise, Some(0.0));
    path.line(&[(Axis::Z, 0.0)]).last().override_law = law(Sense::CounterClockwise, None);
    path.line(&[(Axis::X, 10.0)]);
    path
}

/// A spindle that follows its command, some cycles later.
struct Bench {
    path: Interpolator<&'static str>,
    source: List,
    reported: Vec<f64>,
    dead: usize,
    drive: Drive,
}

impl Bench {
    fn new(path: &Path, dead: usize) -> Bench {
        let mut interpolator = Interpolator::new(&limits(), 100);
        interpolator.set_position(Position::ZERO);
        let mut bench = Bench {
            path: interpolator,
            source: list(path.elements.iter().cloned().map(Step::Element).collect()),
            reported: vec![0.0],
            dead,
            drive: Drive::default(),
        };
        bench.drive.master.ready = true;
        bench
    }

    fn angle(&self) -> f64 {
        self.reported[self.reported.len().saturating_sub(1 + self.dead)]
    }

    fn cycle(&mut self) -> Cycle {
        self.path.prepare(&mut self.source, 100);
        self.drive.master = Master {
            actual_deg: self.angle(),
            ..self.drive.master
        };
        // The control holds the path at its end until the spindle is there too.
        self.drive.in_position = self
            .reported
            .iter()
            .rev()
            .take(self.dead + 1)
            .all(|reported| *reported == self.angle());
        let cycle = self.path.cycle(&self.drive);
        self.reported.extend(
            cycle
                .lead
                .map(|lead| lead.angle_deg)
                .or(self.reported.last().copied()),
        );
        cycle
    }

    fn until(&mut self, mut so: impl FnMut(&Bench, &Cycle) -> bool) -> Cycle {
        for _ in 0..20_000 {
            let cycle = self.cycle();
            if so(self, &cycle) {
                return cycle;
            }
        }
        panic!("never");
    }
}

/// The height that belongs to an angle.
fn height(angle_deg: f64) -> f64 {
    -angle_deg / 360.0 * PITCH
}

/// F = S · p: 900 mm/min are 15 mm/s; the ramp of gear 1 is 2000 rpm/s · 1.5 mm / 60 = 50 mm/s², so each of
/// the four ramps takes 0.3 s. Plunge and retraction each: 30 mm / 15 mm/s + 0.3 s; and the orientation of 1 s. The feed override
/// has no effect.
#[test]
fn the_ramp_of_the_spindle_takes_its_time() {
    let path = thread();
    for percent in [100.0, 50.0] {
        let limits = Limits {
            feed_override_percent: percent,
            ..limits()
        };
        let planned = time_s(&plan(&path.elements[..2], &limits));
        let expected = 1.0 + 2.0 * (DEPTH / 15.0 + 0.3);
        assert!((planned - expected).abs() < 1e-9, "{planned} {expected}");
    }
    // A faster spindle is in gear 2: 8000 rpm/s.
    let mut fast = Path::new(2000.0 * PITCH);
    fast.line(&[(Axis::Z, -DEPTH)]).last().override_law = law(Sense::Clockwise, None);
    let expected = DEPTH / 50.0 + 50.0 / 200.0;
    assert!((time_s(&plan(&fast.elements, &limits())) - expected).abs() < 1e-9);
}

/// Online the path takes as long as planned, and the command to the spindle is that path.
#[test]
fn online_it_takes_as_long_as_planned() {
    let mut bench = Bench::new(&thread(), 0);
    let mut cycles = 0.0;
    let bottom = bench.until(|bench, _| bench.path.element().is_some_and(|e| e.end[Axis::Z] == 0.0));
    assert_eq!(bottom.lead.map(|lead| lead.angle_deg > 7199.0), Some(true));
    let mut bench = Bench::new(&thread(), 0);
    bench.until(|bench, _| {
        cycles += 1.0;
        !bench.path.is_coupled() && cycles > 10.0
    });
    let planned = 2.0 * (DEPTH / 15.0 + 0.3);
    let time = cycles * 0.003;
    // Both ends of the two elements may wait for the next cycle.
    assert!((time - planned).abs() <= 4.0 * 0.003, "{time} {planned}");
}

/// However late the spindle is: in every cycle the axis stands where the angle of the spindle says, on one
/// line through both directions. 30 mm are 20 turns.
#[test]
fn the_axis_follows_the_angle_through_the_reversal() {
    for dead in [0, 1, 7, 30] {
        let mut bench = Bench::new(&thread(), dead);
        let (mut deepest, mut coupled) = (0.0f64, 0);
        bench.until(|bench, cycle| {
            if bench.path.is_coupled() {
                coupled += 1;
                let z = cycle.position[Axis::Z];
                let angle = bench.drive.master.actual_deg;
                assert!((z - height(angle)).abs() < 1e-9, "{z} at {angle}");
                deepest = deepest.min(z);
            }
            !bench.path.is_coupled() && coupled > 10
        });
        // The reversal may lie between two cycles: 50 mm/s² over half of one.
        assert!((deepest + DEPTH).abs() < 1e-4, "{deepest}");
        let greatest = bench.reported.iter().fold(0.0f64, |a, b| a.max(*b));
        assert!(
            (greatest - 7200.0).abs() < 1e-6 && bench.reported.last().is_some_and(|last| last.abs() < 1e-6)
        );
    }
}

/// The override of the spindle acts, that of the feed does not.
#[test]
fn only_the_override_of_the_spindle_acts() {
    let rpm = |feed: f64, spindle: f64| {
        let mut bench = Bench::new(&thread(), 0);
        bench.drive.feed_override_percent = feed;
        bench.drive.spindle_override_percent = spindle;
        let cycle = bench.until(|_, cycle| cycle.position[Axis::Z] < -15.0);
        cycle.lead.map_or(0.0, |lead| lead.rpm)
    };
    assert!((rpm(100.0, 100.0) - 600.0).abs() < 1e-6);
    assert!((rpm(0.0, 100.0) - 600.0).abs() < 1e-6);
    assert!((rpm(100.0, 120.0) - 720.0).abs() < 1e-6);
    assert!((rpm(150.0, 50.0) - 300.0).abs() < 1e-6);
}

/// Held in the thread both brake on the ramp of the spindle; then the path goes back to its start and forward
/// again, always on the same line.
#[test]
fn held_in_the_thread_it_goes_back_and_forward() {
    let mut bench = Bench::new(&thread(), 2);
    let check = |bench: &Bench, cycle: &Cycle| {
        let angle = bench.drive.master.actual_deg;
        assert!((cycle.position[Axis::Z] - height(angle)).abs() < 1e-9);
    };
    bench.until(|_, cycle| cycle.position[Axis::Z] < -15.0);
    bench.drive.hold = true;
    let held = bench.until(|bench, cycle| {
        check(bench, cycle);
        cycle.state == State::Held && bench.drive.in_position
    });
    // 15 mm/s at 50 mm/s²: 2.25 mm, and at most 4 cycles of 0.045 mm: two that the spindle is late,
    // that in which it was seen, and that in which the hold came.
    let z = held.position[Axis::Z];
    assert!(z < -17.2 && z > -17.45, "{z}");
    bench.drive.back = true;
    let out = bench.until(|bench, cycle| {
        check(bench, cycle);
        cycle.state == State::Held && bench.drive.in_position
    });
    assert!(out.position[Axis::Z].abs() < 1e-9);
    // Half way in again, and back while it moves: it brakes before it turns.
    (bench.drive.back, bench.drive.hold) = (false, false);
    bench.until(|bench, cycle| {
        check(bench, cycle);
        cycle.position[Axis::Z] < -10.0
    });
    bench.drive.back = true;
    let mut before = 15.0;
    bench.until(|bench, cycle| {
        check(bench, cycle);
        let speed = cycle.lead.map_or(0.0, |lead| lead.rpm * PITCH / 60.0);
        assert!(f64::abs(speed - before) < 50.0 * 0.003 + 1e-9, "{speed} {before}");
        before = speed;
        cycle.position[Axis::Z] > -0.5
    });
    bench.drive.back = false;
    bench.until(|bench, cycle| {
        if bench.path.is_coupled() {
            check(bench, cycle);
        }
        cycle.position[Axis::X] > 5.0
    });
}

/// Spindle and axis were turned and moved by something else: they are coupled again as they stand, and the path
/// goes on from there.
#[test]
fn coupled_again_as_they_stand() {
    let mut bench = Bench::new(&thread(), 0);
    bench.until(|_, cycle| cycle.position[Axis::Z] < -15.0);
    bench.drive.hold = true;
    bench.until(|_, cycle| cycle.state == State::Held);
    let mut here = bench.path.position();
    here[Axis::Z] = -12.0;
    bench.reported.push(100.0);
    bench.path.couple_again(&here, 100.0);
    bench.drive.hold = false;
    let mut deepest = 0.0f64;
    bench.until(|bench, cycle| {
        if bench.path.is_coupled() {
            let expected = -12.0 + height(bench.drive.master.actual_deg - 100.0);
            assert!((cycle.position[Axis::Z] - expected).abs() < 1e-9);
        }
        deepest = deepest.min(cycle.position[Axis::Z]);
        cycle.position[Axis::X] > 0.0
    });
    assert!((deepest + DEPTH).abs() < 1e-9, "{deepest}");
}

/// Spindle and axis have come to stand beyond an end of the thread: the path goes back to it as they are coupled, on the ramp of
/// the spindle, and on from there. The spindle gets no command elsewhere than it stands: 50 mm/s² over a cycle of
/// 3 ms are 0.15 mm/s, and 0.0002 mm of the thread.
#[test]
fn beyond_its_ends_a_thread_begins_where_it_stands() {
    for (element, here_z) in [(0, -DEPTH - 2.0), (0, 2.0), (1, 2.0), (1, -DEPTH - 2.0)] {
        let mut bench = Bench::new(&thread(), 0);
        bench.until(|bench, cycle| {
            let down = bench.path.element().is_some_and(|e| e.end[Axis::Z] < 0.0);
            cycle.position[Axis::Z] < -15.0 && down == (element == 0)
        });
        bench.drive.hold = true;
        bench.until(|_, cycle| cycle.state == State::Held);
        let mut here = bench.path.position();
        here[Axis::Z] = here_z;
        bench.reported.push(100.0);
        bench.path.couple_again(&here, 100.0);
        // Two millimetres behind the end there is less than nothing to go, before the start more than all of it; covered is
        // all or nothing.
        let beyond = (element == 0) == (here_z < 0.0);
        let (rest, part) = if beyond { (-2.0, 1.0) } else { (DEPTH + 2.0, 0.0) };
        assert!((bench.path.rest_mm() - rest).abs() < 1e-9, "{element} {here_z}");
        assert_eq!(bench.path.part(), part, "{element} {here_z}");
        // By the axis key it goes back to the nearer end at most, and nowhere from before its start.
        bench.drive.back = true;
        for _ in 0..10 {
            let cycle = bench.cycle();
            let moved = height(bench.angle() - 100.0).abs();
            assert!(
                moved < 0.5 * 50.0 * 0.03 * 0.03 + 1e-6,
                "{element} {here_z}: {moved}"
            );
            assert_eq!(cycle.state == State::Moving, beyond, "{element} {here_z}");
        }
        bench.drive.back = false;
        bench.until(|_, cycle| cycle.state == State::Held);
        bench.drive.hold = false;
        let (mut reported, mut speed, mut deepest) = (bench.angle(), 0.0, here_z.min(0.0));
        let end = bench.until(|bench, cycle| {
            if let Some(lead) = cycle.lead {
                let now = (height(lead.angle_deg) - height(reported)) / 0.003;
                let change = f64::abs(now - speed);
                assert!(
                    change <= 50.0 * 0.003 + 1e-6,
                    "{element} {here_z}: {speed} {now} at {}",
                    cycle.position[Axis::Z]
                );
                (reported, speed) = (lead.angle_deg, now);
            }
            if bench.path.is_coupled() {
                let expected = here_z + height(bench.drive.master.actual_deg - 100.0);
                assert!((cycle.position[Axis::Z] - expected).abs() < 1e-9);
            }
            deepest = deepest.min(cycle.position[Axis::Z]);
            cycle.position[Axis::X] > 0.0
        });
        assert!(end.position[Axis::Z].abs() < 1e-9, "{element} {here_z}");
        let expected = if element == 0 {
            here_z.min(-DEPTH)
        } else {
            here_z.min(0.0)
        };
        assert!((deepest - expected).abs() < 1e-9, "{element} {here_z}: {deepest}");
    }
}

/// Stopped between plunge and retraction of a thread, with single block, too: coupled again elsewhere it begins where spindle and axis
/// stand, and goes on to the end of the pass that it stands before or behind.
#[test]
fn between_its_passes_a_thread_begins_where_it_stands() {
    for single_block in [false, true] {
        let mut bench = Bench::new(&thread(), 3);
        bench.drive.single_block = single_block;
        bench.until(|_, cycle| cycle.state == State::Settling);
        bench.drive.hold = true;
        let waits = if single_block {
            State::BlockEnd
        } else {
            State::Held
        };
        bench.until(|_, cycle| cycle.state == waits);
        let second = bench
            .path
            .element()
            .is_some_and(|element| element.end[Axis::Z] == 0.0);
        assert_eq!(second, !single_block);
        bench.dead = 0;
        let mut here = bench.path.position();
        here[Axis::Z] = -12.0;
        bench.reported.push(100.0);
        bench.path.couple_again(&here, 100.0);
        (bench.drive.hold, bench.drive.single_block) = (false, false);
        bench.path.go_on();
        let (mut reported, mut speed) = (100.0, 0.0);
        let end = bench.until(|bench, cycle| {
            if let Some(lead) = cycle.lead {
                let now = (height(lead.angle_deg) - height(reported)) / 0.003;
                assert!(
                    f64::abs(now - speed) <= 50.0 * 0.003 + 1e-6,
                    "{single_block}: {speed} {now}"
                );
                (reported, speed) = (lead.angle_deg, now);
            }
            if bench.path.is_coupled() {
                let expected = -12.0 + height(bench.drive.master.actual_deg - 100.0);
                assert!((cycle.position[Axis::Z] - expected).abs() < 1e-9);
            }
            cycle.position[Axis::X] > 0.0
        });
        assert!(end.position[Axis::Z].abs() < 1e-9, "{single_block}");
    }
}

/// The path has reached the end of a thread in nominal values, and its function is output, when the drives are taken away from a spindle
/// that lags behind: what is left of the thread is driven again, from a standstill, and the function is not output again.
#[test]
fn a_thread_that_was_not_reached_is_driven_to_its_end() {
    for synchronisation in [Synchronisation::Mos, Synchronisation::MnsSns] {
        let mut path = Path::new(FEED);
        path.line(&[(Axis::Z, -DEPTH)]).last().override_law = law(Sense::Clockwise, Some(0.0));
        path.line(&[(Axis::Z, 0.0)]);
        with_m(
            &mut path,
            9,
            At::End,
            synchronisation,
            law(Sense::CounterClockwise, None),
        );
        path.line(&[(Axis::X, 10.0)]);
        let mut bench = Bench::new(&path, 40);
        let waits = match synchronisation {
            Synchronisation::Mos => State::Settling,
            _ => State::Gate(Gate::End),
        };
        bench.until(|bench, cycle| {
            cycle.state == waits
                && bench
                    .path
                    .element()
                    .is_some_and(|element| element.end[Axis::Z] == 0.0)
        });
        assert!(bench.path.next_output().is_some());
        let mut here = bench.path.position();
        here[Axis::Z] = -2.0;
        bench.dead = 0;
        bench.reported.push(100.0);
        bench.path.couple_again(&here, 100.0);
        bench.path.release();
        // The acceleration of the spindle in gear 1 is 50 mm/s² of the thread.
        let (mut before, mut speed, mut outputs) = (-2.0, 0.0, 0);
        let end = bench.until(|bench, cycle| {
            if bench.path.is_coupled() {
                let at = cycle.position[Axis::Z];
                let now = (at - before) / 0.003;
                assert!(
                    f64::abs(now - speed) <= 50.0 * 0.003 + 1e-6,
                    "{speed} {now} at {at}"
                );
                assert!((at - (-2.0 + height(bench.drive.master.actual_deg - 100.0))).abs() < 1e-9);
                (before, speed) = (at, now);
            }
            cycle.position[Axis::X] > 0.0
        });
        let reached = end.position[Axis::Z];
        // The last cycle of the ramp ends in the one in which the path goes on.
        assert!(
            reached.abs() < 1e-9 && before.abs() < 50.0 * 0.003 * 0.003,
            "{synchronisation:?} {reached} {before}"
        );
        while bench.path.next_output().is_some() {
            outputs += 1;
        }
        assert_eq!(outputs, 0);
    }
}

/// A spindle that is not ready keeps the path before the thread.
#[test]
fn the_path_waits_for_the_spindle() {
    let mut bench = Bench::new(&thread(), 0);
    bench.drive.master.ready = false;
    for _ in 0..100 {
        let cycle = bench.cycle();
        assert_eq!((cycle.state, cycle.lead), (State::Master, None));
    }
    bench.drive.master.ready = true;
    bench.until(|_, cycle| cycle.position[Axis::Z] < -1.0);
}

fn with_m(path: &mut Path, code: u16, at: At, synchronisation: Synchronisation, law: OverrideLaw) {
    let element = path.last();
    element.override_law = law;
    let function = function(Function::M(code), at, synchronisation);
    element.functions = Some(Box::new([function]));
}

/// In and out with a floating holder; M05 goes out so long before the depth.
fn floating(lead_s: f64) -> Path {
    let law = OverrideLaw::Tapping {
        from_percent: 90.0,
        to_percent: 110.0,
    };
    let mut path = Path::new(FEED);
    path.line(&[(Axis::Z, -DEPTH)]);
    with_m(&mut path, 5, At::BeforeEnd(lead_s), Synchronisation::Mos, law);
    let wait = Synchronisation::MvsSvs;
    path.to(Curve::Hold, path.at);
    with_m(&mut path, 4, At::Start, wait, law);
    path.line(&[(Axis::Z, 0.0)]).last().override_law = law;
    for code in [5, 3] {
        path.to(Curve::Hold, path.at);
        with_m(&mut path, code, At::Start, wait, OverrideLaw::Free);
    }
    path
}

/// M05 comes the lead before the end: 15 mm/s, braking 15 ms with 1 m/s². A lead shorter than braking is braking:
/// the spindle follows the flatter ramp [000:6070].
#[test]
fn a_function_before_the_end_of_a_movement() {
    for (lead, distance) in [
        (0.5, 15.0 * (0.5 - 0.0075)),
        (0.1, 15.0 * (0.1 - 0.0075)),
        (0.0, 15.0 * 0.0075),
        (100.0, DEPTH),
    ] {
        let mut bench = Bench::new(&floating(lead), 0);
        let at = (0..20_000).find_map(|_| {
            let cycle = bench.cycle();
            let output = bench.path.next_output()?;
            let mut functions = bench.path.functions(&output);
            let is_m5 = functions.any(|function| function.function == Function::M(5));
            assert!(is_m5 && !output.waits);
            Some(cycle.position[Axis::Z] + DEPTH)
        });
        // It goes out at the end of the cycle in which the path passes its place.
        let early = distance - at.unwrap_or(f64::NAN);
        assert!((-1e-9..=15.0 * 0.003 + 1e-9).contains(&early), "{lead}: {early}");
    }
}

/// In the thread nothing waits for the speed of the spindle; above M05 and M03 do, 1 s each.
#[test]
fn a_floating_holder_waits_for_no_speed() {
    let planned = plan(&floating(0.1).elements, &limits());
    let moving = 2.0 * (DEPTH / 15.0 + 0.015);
    // Before M04 the spindle was stopped by M05 on the way, and turns when it comes to the one above.
    assert!(
        (time_s(&planned) - moving - 2.0).abs() < 1e-9,
        "{}",
        time_s(&planned)
    );
}
