//! When functions go out and where the path waits for them, type by type [004:54-90].

use crate::common::{List, Path, limits, list};
use bahn_motion::{Drive, Interpolator, Limits, State};
use bahn_path::{
    Ahead, At, Axis, FeedRate, Function, PathElement, Position, Step, Synchronisation, TechnologyFunction,
};
use proptest::prelude::*;

const T: f64 = 0.003;

/// A path whose functions a PLC acknowledges so many cycles after they went out.
struct Bench {
    source: List,
    path: Interpolator<&'static str>,
    delay: usize,
    /// Cycles until all is acknowledged.
    open: usize,
    cycle: usize,
    /// Functions with X and the cycle in which they went out.
    outputs: Vec<(Function, f64, usize)>,
    /// Where the path stood, and for how many cycles.
    stops: Vec<(f64, usize)>,
}

impl Bench {
    fn new(elements: &[PathElement], limits: &Limits, delay: usize) -> Bench {
        let mut path = Interpolator::new(limits, 64);
        path.set_position(Position::ZERO);
        Bench {
            source: list(elements.iter().cloned().map(Step::Element).collect()),
            path,
            delay,
            open: 0,
            cycle: 0,
            outputs: Vec::new(),
            stops: Vec::new(),
        }
    }

    fn x(&self) -> f64 {
        self.path.position()[Axis::X]
    }

    fn step(&mut self) -> State {
        self.path.prepare(&mut self.source, usize::MAX);
        let drive = Drive {
            acknowledged: self.open == 0,
            ..Drive::default()
        };
        let state = self.path.cycle(&drive).state;
        self.cycle += 1;
        self.open = self.open.saturating_sub(1);
        let (x, cycle) = (self.x(), self.cycle);
        while let Some(output) = self.path.next_output() {
            let functions: Vec<_> = self.path.functions(&output).cloned().collect();
            self.outputs
                .extend(functions.into_iter().map(|one| (one.function, x, cycle)));
            self.open = self.delay;
        }
        let stands = matches!(state, State::Awaiting | State::Gate(_));
        match self.stops.last_mut() {
            Some((at, count)) if stands && *at == x => *count += 1,
            _ if stands => self.stops.push((x, 1)),
            _ => {}
        }
        if matches!(state, State::Gate(_)) && self.open == 0 {
            self.path.release();
        }
        state
    }

    fn run(mut self) -> Bench {
        for _ in 0..100_000 {
            if self.step() == State::Stopped {
                return self;
            }
        }
        panic!("it stands at {} for ever", self.x());
    }

    /// Where a function went out.
    fn out(&self, code: u16) -> f64 {
        let mut all = self.outputs.iter().filter(|one| one.0 == Function::M(code));
        let (_, x, _) = all.next().unwrap();
        assert!(all.next().is_none(), "M{code} goes out once");
        *x
    }
}

fn m(code: u16, at: At, synchronisation: Synchronisation) -> TechnologyFunction {
    TechnologyFunction::new(Function::M(code), at, synchronisation)
}

/// Blocks along X with their functions; a feed of 0 is rapid traverse.
fn blocks(blocks: &[(f64, f64, &[TechnologyFunction])]) -> Vec<PathElement> {
    let mut path = Path::new(5000.0);
    for (x, feed, functions) in blocks {
        path.line(&[(Axis::X, *x)]);
        let last = path.last();
        last.feed = match *feed {
            0.0 => FeedRate::Rapid,
            feed => FeedRate::Programmed(feed),
        };
        last.functions = (!functions.is_empty()).then(|| (*functions).into());
    }
    path.elements
}

/// The program of the manual: X25, X50, X75 with M25, X100, and here X125 after it.
fn manual(synchronisation: Synchronisation) -> Vec<PathElement> {
    let m25 = [m(25, At::Start, synchronisation)];
    let f = 5000.0;
    blocks(&[
        (25.0, f, &[]),
        (50.0, f, &[]),
        (75.0, f, &m25),
        (100.0, f, &[]),
        (125.0, f, &[]),
    ])
}

/// `MVS_SNS`: out at X50, the movement goes on at once; acknowledged in time nobody sees it, otherwise the path
/// stops at X75 [004:63].
#[test]
fn before_the_block_and_after_it() {
    let undisturbed = Bench::new(&manual(Synchronisation::Mos), &limits(), 0)
        .run()
        .cycle;
    // 25 mm at 83 mm/s are 100 cycles, less those in which the path would brake (83 ms, 28 cycles).
    let early = Bench::new(&manual(Synchronisation::MvsSns), &limits(), 60).run();
    assert!((50.0..50.26).contains(&early.out(25)), "{:?}", early.outputs);
    assert_eq!((early.cycle, &early.stops), (undisturbed, &vec![]));
    let late = Bench::new(&manual(Synchronisation::MvsSns), &limits(), 300).run();
    assert_eq!(late.stops.len(), 1);
    assert_eq!(late.stops[0].0, 75.0);
    // It stands from when it comes to X75, 100 cycles and half the braking later, until the 300th.
    let out = late.outputs[0].2;
    let (v, a) = (5000.0 / 60.0, 1000.0);
    let arrives = (25.0 / v + 0.5 * v / a) / T;
    let stood = late.stops[0].1 as f64;
    assert!(
        (stood - (300.0 - arrives)).abs() < 3.0,
        "{stood} cycles, {arrives} after {out}"
    );
    // The path braked, for an acknowledgement might not come: while it brakes it may still speed up again.
    let braking = Bench::new(&manual(Synchronisation::MvsSns), &limits(), 90).run();
    assert!(braking.stops.is_empty() && braking.cycle > undisturbed);
}

/// `MVS_SLM`: M24 and M25 in rapid traverse are waited for where the feed begins; in the block with a feed itself the
/// function is one at its start [004:72].
#[test]
fn late_implicit() {
    use Synchronisation::MvsSlm;
    let (m24, m25) = ([m(24, At::Start, MvsSlm)], [m(25, At::Start, MvsSlm)]);
    let program = |feed: f64| {
        blocks(&[
            (10.0, feed, &m24),
            (25.0, 0.0, &m25),
            (50.0, 0.0, &[]),
            (75.0, 2000.0, &[]),
            (100.0, 0.0, &[]),
        ])
    };
    let late = Bench::new(&program(0.0), &limits(), 1000).run();
    assert_eq!(late.stops.iter().map(|stop| stop.0).collect::<Vec<_>>(), [50.0]);
    let early = Bench::new(&program(0.0), &limits(), 5).run();
    assert!(early.stops.is_empty());
    let own = Bench::new(&program(3000.0), &limits(), 1000).run();
    assert_eq!(
        own.stops.iter().map(|stop| stop.0).collect::<Vec<_>>(),
        [0.0, 50.0]
    );
}

/// `MVS_SLP`: neither feed nor the ends of blocks are waited at, but where the program wants it [004:75].
#[test]
fn late_explicit() {
    let m26 = [m(26, At::Start, Synchronisation::MvsSlp)];
    let wanted = [TechnologyFunction::new(
        Function::Synchronise,
        At::Start,
        Synchronisation::Mos,
    )];
    let program = blocks(&[
        (25.0, 0.0, &m26),
        (50.0, 2000.0, &[]),
        (75.0, 0.0, &[]),
        (100.0, 2000.0, &wanted),
        (125.0, 0.0, &[]),
    ]);
    let late = Bench::new(&program, &limits(), 2000).run();
    assert_eq!(late.stops.iter().map(|stop| stop.0).collect::<Vec<_>>(), [75.0]);
    assert!(Bench::new(&program, &limits(), 5).run().stops.is_empty());
}

/// Five blocks of 10 mm and M96 before the one from X40 to X80 [004:81].
fn ahead(lead: Ahead, synchronisation: Synchronisation) -> Vec<PathElement> {
    let m96 = [m(96, At::Ahead(lead), synchronisation)];
    let f = 5000.0;
    blocks(&[
        (10.0, f, &[]),
        (20.0, f, &[]),
        (30.0, f, &[]),
        (40.0, f, &[]),
        (80.0, f, &m96),
        (0.0, f, &[]),
    ])
}

/// `MEP_SVS` with 25 mm: out at X15, wherever blocks end; not acknowledged, the path stands at X40 [004:81-87].
#[test]
fn ahead_by_a_distance() {
    let distance = 5000.0 / 60.0 * T;
    for (synchronisation, delay, stops) in [
        (Synchronisation::MepSvs, 60, vec![]),
        (Synchronisation::MepSvs, 1000, vec![40.0]),
        (Synchronisation::MepMos, 1000, vec![]),
    ] {
        let run = Bench::new(&ahead(Ahead::Distance(25.0), synchronisation), &limits(), delay).run();
        assert!(
            (15.0..=15.0 + distance).contains(&run.out(96)),
            "{:?}",
            run.outputs
        );
        assert_eq!(
            run.stops.iter().map(|stop| stop.0).collect::<Vec<_>>(),
            stops,
            "{synchronisation:?} {delay}"
        );
    }
    // More than there is: at the start of the path.
    let run = Bench::new(
        &ahead(Ahead::Distance(100.0), Synchronisation::MepMos),
        &limits(),
        0,
    )
    .run();
    assert!(run.out(96) <= distance, "in the first cycle");
}

/// `MET_SVS` with 0.3 s: the distance v T - v²/2a, as if the path stopped at X40, so X18.47; `MET_MOS` v T, X15
/// [004:87-90].
#[test]
fn ahead_by_a_time() {
    let (v, a, lead) = (5000.0 / 60.0, 1000.0, 0.3);
    for (synchronisation, place) in [
        (Synchronisation::MetSvs, 40.0 - (v * lead - 0.5 * v * v / a)),
        (Synchronisation::MetMos, 40.0 - v * lead),
    ] {
        let run = Bench::new(&ahead(Ahead::Time(lead), synchronisation), &limits(), 5).run();
        let x = run.out(96);
        assert!(
            (place..=place + v * T + 1e-9).contains(&x),
            "{synchronisation:?}: {x}, not {place}"
        );
    }
}

/// The axes were moved away while a function is out: what is given again has it not any more, and waits for it.
#[test]
fn a_recalled_path_goes_on_waiting() {
    let mut bench = Bench::new(
        &ahead(Ahead::Distance(25.0), Synchronisation::MepSvs),
        &limits(),
        5000,
    );
    while bench.outputs.is_empty() {
        bench.step();
    }
    bench.path.halt();
    bench.path.recall(bench.path.position());
    let elements = bench.path.take_recalled().unwrap();
    assert_eq!(
        elements.len(),
        5,
        "what is left of the second block, and the four after it"
    );
    assert!(elements.iter().all(|element| element.functions.is_none()));
    bench.source = list(elements.into_iter().map(Step::Element).collect());
    assert_eq!(bench.step(), State::Awaiting);
    bench.open = 0;
    let end = bench.run();
    end.out(96);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Functions that are acknowledged at once cost the path no time, whichever of the late types they are of; and all
    /// of them go out once, however late they are acknowledged.
    #[test]
    fn in_time_nobody_sees_them(
        lengths in prop::collection::vec(0.2..30.0f64, 2..12),
        kinds in prop::collection::vec(0usize..6, 12),
        delay in 0usize..200,
    ) {
        let mut x = 0.0;
        let program = |with: bool| {
            x = 0.0;
            let functions: Vec<Vec<TechnologyFunction>> = kinds.iter().enumerate().map(|(index, kind)| {
                let code = u16::try_from(index).unwrap();
                match kind {
                    0 => vec![m(code, At::Start, Synchronisation::MvsSns)],
                    1 => vec![m(code, At::Start, Synchronisation::MvsSlp)],
                    2 => vec![m(code, At::Ahead(Ahead::Distance(7.0)), Synchronisation::MepSvs)],
                    3 => vec![m(code, At::Ahead(Ahead::Time(0.2)), Synchronisation::MetMos)],
                    4 => vec![TechnologyFunction::new(Function::Synchronise, At::Start, Synchronisation::Mos)],
                    _ => vec![],
                }
            }).collect();
            let rows: Vec<(f64, f64, &[TechnologyFunction])> = lengths.iter().zip(&functions).map(|(length, own)| {
                x += length;
                (x, 3000.0, if with { own.as_slice() } else { &[] })
            }).collect();
            blocks(&rows)
        };
        let mut program = program;
        let (with, without) = (program(true), program(false));
        let expected = kinds.iter().take(lengths.len()).filter(|kind| **kind < 4).count();
        // Out and acknowledged between two cycles: a function at the start of a block shorter than a cycle is not.
        let quick = Bench::new(&with, &limits(), 0).run();
        let plain = Bench::new(&without, &limits(), 0).run();
        prop_assert!(quick.cycle >= plain.cycle && quick.stops.iter().all(|stop| stop.0 == 0.0));
        let slow = Bench::new(&with, &limits(), delay).run();
        let went = |run: &Bench| run.outputs.iter().filter(|one| matches!(one.0, Function::M(_))).count();
        prop_assert_eq!((went(&quick), went(&slow)), (expected, expected));
        prop_assert_eq!(slow.x(), x);
    }
}
