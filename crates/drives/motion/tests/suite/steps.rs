//! Barriers, stops and the times beside the movement.

use crate::common::{Path, function, limits, list, plan};
use bahn_motion::{
    AuxiliaryTimes, Identity, Kinematics, MAX_LOOK_AHEAD, PlannedStep, Planner, Sample, Sampler,
};
use bahn_path::{
    At, Axis, Barrier, BlockRef, Function, LiveData, PathElement, Position, Step, Synchronisation, ToolCall,
    ToolShape,
};

const X: Axis = Axis::X;

fn close(actual: f64, expected: f64) {
    assert!(
        (actual - expected).abs() <= 1e-9 * expected.abs().max(1e-3),
        "{actual} is not {expected}"
    );
}

fn straight(count: u32) -> Vec<PathElement> {
    let mut path = Path::new(3000.0);
    for i in 1..=count {
        path.line(&[(X, f64::from(i))]);
    }
    path.elements
}

/// Before a barrier and where a source starves the path is planned to a stop and handed out, then the
/// step itself comes.
#[test]
fn steps_of_the_source_come_after_the_path_before_them() {
    let stop = Barrier::Stop {
        block: BlockRef { program: 0, block: 3 },
    };
    let elements = straight(6);
    let mut steps: Vec<_> = elements.into_iter().map(Step::Element).collect();
    steps.insert(2, Step::Barrier(stop));
    steps.insert(5, Step::Starved);
    steps.push(Step::Error("lost"));
    let mut planner = Planner::new(list(steps), &limits(), &AuxiliaryTimes::default());
    let mut seen = String::new();
    let mut exits = Vec::new();
    loop {
        seen.push(match planner.next() {
            PlannedStep::Element(planned) => {
                exits.push(planned.profile.exit_mm_s);
                'e'
            }
            PlannedStep::Barrier(barrier) => {
                assert_eq!(barrier, stop);
                planner.resume(LiveData::default());
                'B'
            }
            PlannedStep::Starved => 'S',
            PlannedStep::End => break,
            PlannedStep::Error(error) => {
                assert_eq!(error, "lost");
                'E'
            }
        });
    }
    assert_eq!(seen, "eeBeeSeeE");
    assert_eq!(planner.source().resumed, 1);
    let stops: Vec<bool> = exits.iter().map(|exit| *exit == 0.0).collect();
    assert_eq!(stops, [false, true, false, true, false, true]);
}

/// The planner reads no farther than braking needs: from 50 mm/s with 1000 mm/s² that is 1.25 mm, two
/// lines of 1 mm, and one more to know where the second ends.
#[test]
fn reads_no_farther_than_braking_needs() {
    let steps = straight(1000).into_iter().map(Step::Element).collect();
    let mut planner = Planner::new(list(steps), &limits(), &AuxiliaryTimes::default());
    for handed_out in 1..900 {
        assert!(matches!(planner.next(), PlannedStep::Element(_)));
        let read = 1000 - planner.source().steps.len();
        assert!(read <= handed_out + 3, "{read} read for {handed_out}");
    }
}

/// When braking needs more elements than look-ahead holds, the path runs as fast as it can stop from
/// within these: lines of 1 µm allow `v² = 2 · 1000 · 65.536`, whatever the feed.
#[test]
fn look_ahead_is_bounded() {
    let count = 3 * MAX_LOOK_AHEAD;
    let mut path = Path::new(300_000.0);
    for i in 1..=count {
        path.line(&[(X, 0.001 * i as f64)]);
    }
    let mut l = limits();
    l.max_feed_mm_min[X] = 300_000.0;
    let steps = path.elements.into_iter().map(Step::Element).collect();
    let mut planner = Planner::new(list(steps), &l, &AuxiliaryTimes::default());
    let (mut handed_out, mut speed, mut greatest) = (0, 0.0, 0.0f64);
    while let PlannedStep::Element(planned) = planner.next() {
        handed_out += 1;
        let read = count - planner.source().steps.len();
        assert!(read - handed_out < MAX_LOOK_AHEAD);
        assert_eq!(planned.profile.entry_mm_s, speed);
        speed = planned.profile.exit_mm_s;
        greatest = greatest.max(speed);
    }
    assert_eq!((handed_out, speed), (count, 0.0));
    let reachable = (2.0 * 1000.0 * 0.001 * MAX_LOOK_AHEAD as f64).sqrt();
    assert!(
        (greatest - reachable).abs() < 1e-4 * reachable,
        "{greatest} {reachable}"
    );
}

/// Functions for which the axes wait stop the path at their end of the block; others do not.
#[test]
fn gates_stop_the_path() {
    use Synchronisation::{MnsSns, Mos, MvsSvs};
    let exits = |at: At, synchronisation: Synchronisation| {
        let mut elements = straight(3);
        elements[1].functions = Some(Box::new([function(Function::M(8), at, synchronisation)]));
        let planned = plan(&elements, &limits());
        [
            planned[0].profile.exit_mm_s > 0.0,
            planned[1].profile.exit_mm_s > 0.0,
        ]
    };
    assert_eq!(exits(At::Start, MvsSvs), [false, true]);
    assert_eq!(exits(At::End, MnsSns), [true, false]);
    assert_eq!(exits(At::Start, Mos), [true, true]);
    assert_eq!(exits(At::End, Mos), [true, true]);
    assert_eq!(exits(At::Length(0.5), MnsSns), [true, false]);
}

/// Dwell stops at the end of its block and takes its time; so does a block without movement.
#[test]
fn dwell_takes_its_time() {
    let mut elements = straight(2);
    elements[0].dwell_s = 0.75;
    let planned = plan(&elements, &limits());
    assert_eq!(planned[0].profile.exit_mm_s, 0.0);
    assert_eq!(planned[0].wait_after_s, 0.75);
    // 1 mm from rest to rest: up to sqrt(1000 · 1) = 31.6 mm/s, twice 31.6 ms.
    close(planned[0].duration_s(), 2.0 * 1000f64.sqrt() / 1000.0 + 0.75);
    close(planned[0].position_at(0.5)[X], 1.0);

    let mut path = Path::new(3000.0);
    path.line(&[(X, 10.0)]).hold(2.5).line(&[(X, 20.0)]);
    let planned = plan(&path.elements, &limits());
    assert_eq!(
        planned.iter().map(|p| p.profile.exit_mm_s).collect::<Vec<_>>(),
        [0.0, 0.0, 0.0]
    );
    close(planned[1].duration_s(), 2.5);
}

/// Tool and spindle take time when they change; what does not stop the axes takes none.
#[test]
fn auxiliary_times() {
    let call = |tool: u32, speed_rpm: f64| {
        let shape = ToolShape {
            length: 0.0,
            radius: 5.0,
            corner_radius: 0.0,
            ..ToolShape::default()
        };
        Function::Tool(ToolCall {
            tool,
            axis: Axis::Z,
            speed_rpm,
            shape,
            at_end_of_life: false,
        })
    };
    let times = AuxiliaryTimes {
        tool_change_s: 7.0,
        spindle_start_s: 1.5,
        spindle_stop_s: 1.25,
        spindle_speed_change_s: 0.5,
        spindle_orientation_s: 3.0,
        m_function_s: 0.125,
    };
    let start = |f: Function| function(f, At::Start, Synchronisation::MvsSvs);
    let end = |f: Function| function(f, At::End, Synchronisation::MnsSns);
    // Functions of each block with the waiting before and after it.
    let blocks = [
        (vec![start(call(1, 1000.0))], 7.0, 0.0),
        (vec![start(call(1, 1000.0))], 0.0, 0.0),
        (vec![start(Function::M(3))], 1.625, 0.0),
        (vec![start(Function::M(13))], 0.125, 0.0),
        (vec![start(Function::M(4))], 0.125 + 1.25 + 1.5, 0.0),
        (vec![start(Function::SpindleSpeed(2000.0))], 0.5, 0.0),
        (
            vec![start(Function::SpindleSpeed(2000.0)), end(Function::M(5))],
            0.0,
            1.375,
        ),
        (vec![start(call(1, 500.0))], 0.0, 0.0),
        (
            vec![start(call(2, 500.0)), start(Function::M(3))],
            7.0 + 1.625,
            0.0,
        ),
        (vec![start(Function::SpindleOrientation(90.0))], 3.0, 0.0),
        (
            vec![function(Function::M(3), At::Start, Synchronisation::Mos)],
            0.0,
            0.0,
        ),
        (vec![end(Function::Stop)], 0.0, 0.0),
        (vec![end(Function::M(30))], 0.0, 0.125),
    ];
    let mut path = Path::new(3000.0);
    for (functions, ..) in &blocks {
        path.hold(0.0);
        path.last().functions = Some(functions.clone().into_boxed_slice());
    }
    let steps = path.elements.iter().cloned().map(Step::Element).collect();
    let mut planner = Planner::new(list(steps), &limits(), &times);
    for (functions, before, after) in &blocks {
        let PlannedStep::Element(planned) = planner.next() else {
            panic!("an element for {functions:?}")
        };
        assert_eq!(
            (planned.wait_before_s, planned.wait_after_s),
            (*before, *after),
            "{functions:?}"
        );
    }
}

/// Samples go on over elements without a gap, and the last one is the end of the path.
#[test]
fn sampler_walks_the_path_in_cycles() {
    let elements = straight(10);
    let steps = elements.into_iter().map(Step::Element).collect();
    let planner = Planner::new(list(steps), &limits(), &AuxiliaryTimes::default());
    let mut sampler = Sampler::new(planner, Identity, 0.01);
    let mut x = Vec::new();
    loop {
        match sampler.next() {
            Sample::Axes(axes) => x.push(axes[X]),
            step => {
                assert_eq!(step, Sample::End);
                break;
            }
        }
    }
    // 10 mm at 50 mm/s: ramps of 0.05 s, 0.25 s in all.
    assert_eq!(x.len(), 26);
    for (k, x) in x.iter().enumerate() {
        let t = 0.01 * k as f64;
        let expected = if t < 0.05 {
            500.0 * t * t
        } else if t < 0.2 {
            1.25 + 50.0 * (t - 0.05)
        } else {
            10.0 - 500.0 * (0.25 - t) * (0.25 - t)
        };
        assert!((x - expected).abs() < 1e-9, "{x} {expected} at {t}");
    }
}

/// A machine whose table moves instead of the tool: its X axis goes the other way.
#[test]
fn sampler_goes_through_the_kinematics() {
    struct MovingTable;
    impl Kinematics for MovingTable {
        fn axes(&self, path: &Position) -> Position {
            let mut axes = *path;
            axes[X] = -axes[X];
            axes
        }
    }
    let steps = straight(1).into_iter().map(Step::Element).collect();
    let planner = Planner::new(list(steps), &limits(), &AuxiliaryTimes::default());
    let mut sampler = Sampler::new(planner, MovingTable, 0.003);
    let mut last = None;
    while let Sample::Axes(axes) = sampler.next() {
        last = Some(axes[X]);
    }
    assert_eq!(last, Some(-1.0));
}

/// Time that waits before and after the movement is sampled at its ends.
#[test]
fn sampler_stands_while_waiting() {
    let mut elements = straight(1);
    elements[0].dwell_s = 0.1;
    elements[0].functions = Some(Box::new([function(
        Function::M(3),
        At::Start,
        Synchronisation::MvsSvs,
    )]));
    let steps = elements.into_iter().map(Step::Element).collect();
    let planner = Planner::new(list(steps), &limits(), &AuxiliaryTimes::default());
    let mut sampler = Sampler::new(planner, Identity, 0.01);
    let mut x = Vec::new();
    while let Sample::Axes(axes) = sampler.next() {
        x.push(axes[X]);
    }
    // 1 s for the spindle, 63 ms of movement, 100 ms of dwell: 116.3 cycles and the end.
    assert_eq!(x.len(), 118);
    assert!(x[..=100].iter().all(|x| *x < 1e-9) && x[101] > 1e-3);
    assert!(x[107..].iter().all(|x| *x == 1.0));
}

/// A rotary axis beside the path keeps to MP7460 too, a degree for a mm as a mm: B stops from 2 degrees/mm at a
/// joint where X goes straight on. A change of 0.1 degrees/mm is a corner of 5.7 degrees, passed within 10, not
/// within 5; at a tangential joint likewise. M90 passes it however the axis steps, as far as the servo follows.
#[test]
fn a_rotary_axis_beside_the_path_stops_at_a_straight_joint() {
    let exit = |first: f64, second: f64, corner_deg: f64, change: fn(&mut PathElement)| {
        let mut path = Path::new(3000.0);
        path.line(&[(X, 50.0), (Axis::B, 50.0 * first)]);
        change(path.last());
        path.line(&[(X, 100.0), (Axis::B, 50.0 * (first + second))]);
        let limits = bahn_motion::Limits {
            corner_angle_deg: corner_deg,
            ..limits()
        };
        plan(&path.elements, &limits)[0].profile.exit_mm_s
    };
    let plain = |_: &mut PathElement| {};
    assert_eq!(exit(2.0, 0.0, 10.0, plain), 0.0);
    assert_eq!(exit(0.0, 2.0, 10.0, plain), 0.0);
    assert_eq!(exit(0.3, 0.4, 5.0, plain), 0.0);
    assert!(exit(0.3, 0.4, 10.0, plain) > 0.0);
    close(exit(0.3, 0.3, 5.0, plain), 50.0);
    let tangential = |element: &mut PathElement| element.tangential_end = true;
    assert_eq!(exit(0.3, 0.4, 5.0, tangential), 0.0);
    close(exit(0.3, 0.3, 5.0, tangential), 50.0);
    assert!(exit(2.0, 0.0, 10.0, |element| element.constant_speed = true) > 0.0);
}

/// An element says how fast its end may be passed: a straight joint at a third of the feed of 50 mm/s, at 0 with a stop.
#[test]
fn an_element_limits_the_feed_at_its_end() {
    let exit = |end_feed: Option<f64>| {
        let mut path = Path::new(3000.0);
        path.line(&[(X, 50.0)]);
        path.last().end_feed = end_feed;
        path.line(&[(X, 100.0)]);
        plan(&path.elements, &limits())[0].profile.exit_mm_s
    };
    close(exit(None), 50.0);
    close(exit(Some(1000.0)), 1000.0 / 60.0);
    close(exit(Some(6000.0)), 50.0);
    assert_eq!(exit(Some(0.0)), 0.0);
}
