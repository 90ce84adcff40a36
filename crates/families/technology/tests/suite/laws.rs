//! Laws of random programs with random acknowledgements: no gate opens without its acknowledgement, none stays shut with
//! it, and the order of output is that of the program in every range, but for what is output ahead.

use std::collections::HashMap;

use crate::common::{Asked, Bench, T};
use bahn_technology::{EventKind, Report};
use proptest::prelude::*;

/// Types in the order in which they are drawn.
const TYPES: [&str; 12] = [
    "MOS", "MVS_SVS", "MVS_SNS", "MNS_SNS", "MVS_SLM", "MVS_SLP", "MOS_TS", "MEP_MOS", "MET_MOS", "MEP_SVS",
    "MET_SVS", "MVS_SVS",
];
/// The first number that is used for a function.
const FIRST: usize = 50;
/// More late ones may not be open.
const LATE: usize = 12;
/// What rounding of the programmed coordinates may add to a distance, mm.
const ROUNDING: f64 = 1e-4;

#[derive(Clone, Debug)]
struct Block {
    /// Rapid, and the distance in X and Y, mm.
    motion: Option<(bool, f64, f64)>,
    functions: Vec<Switch>,
    synchronise: bool,
}

#[derive(Clone, Copy, Debug)]
struct Switch {
    kind: usize,
    of_axis: bool,
    /// Acknowledged after so many cycles.
    cycles: u32,
    /// 0.1 mm, or ms.
    lead: u32,
}

fn block() -> impl Strategy<Value = Block> {
    let distance = prop_oneof![
        (1..40u32).prop_map(f64::from),
        (1..30u32).prop_map(|distance| f64::from(distance) * 0.05)
    ];
    let motion = (
        any::<bool>(),
        distance,
        prop_oneof![3 => Just(0.0), 1 => 1.0..9.0f64],
    );
    let cycles = prop_oneof![2 => Just(0), 2 => 1..60u32, 2 => 60..900u32];
    let switch = (0..TYPES.len(), prop::bool::weighted(0.3), cycles, 1..400u32);
    let switch = switch.prop_map(|(kind, of_axis, cycles, lead)| Switch {
        kind,
        of_axis,
        cycles,
        lead,
    });
    (
        prop::option::weighted(0.8, motion),
        prop::collection::vec(switch, 0..3),
        prop::bool::weighted(0.1),
    )
        .prop_map(|(motion, functions, synchronise)| Block {
            motion,
            functions,
            synchronise,
        })
}

/// A function as the program has it.
#[allow(dead_code, reason = "type and range are shown where a law is broken")]
#[derive(Debug)]
struct Known {
    kind: &'static str,
    range: &'static str,
    /// Place in the program: block, before or after its motion, place in the text.
    order: (usize, bool, usize),
    /// The distance that the path may not pass before the acknowledgement, mm.
    gate: Option<f64>,
    /// Where it is output, mm.
    place: Option<f64>,
}

/// What the laws are asked of.
struct Case {
    bench: Bench,
    known: HashMap<String, Known>,
    /// Length of the path, mm.
    distance: f64,
    /// Distances to the ends of the blocks with a motion, mm, and how many blocks there are up to each.
    ends: Vec<(f64, usize)>,
}

/// Single block between two times, with starts at some, all in cycles.
#[derive(Clone, Debug)]
struct Single {
    from: u32,
    to: u32,
    starts: Vec<u32>,
}

fn single() -> impl Strategy<Value = Option<Single>> {
    let single = (0..1500u32, 1..3000u32, prop::collection::vec(0..4000u32, 0..12));
    prop::option::of(single.prop_map(|(from, length, mut starts)| {
        starts.sort_unstable();
        Single {
            from,
            to: from + length,
            starts,
        }
    }))
}

impl Single {
    fn script(&self) -> String {
        let time = |cycle: u32| format!("{:.3}", f64::from(cycle) * T);
        let starts = self
            .starts
            .iter()
            .map(|start| format!("start {}\n", time(*start)));
        format!(
            "single {}..{}\n{}",
            time(self.from),
            time(self.to),
            starts.collect::<String>()
        )
    }

    /// When the path may go on that comes to the end of a block at a time, s, at the earliest.
    fn next_start(&self, t: f64) -> f64 {
        let mut starts = self.starts.iter().map(|start| f64::from(*start) * T);
        let end = f64::from(self.to) * T;
        starts
            .find(|start| *start > t - 1e-9)
            .map_or(end, |start| start.min(end))
    }
}

/// In single block no end of a block is passed without a start, and nothing of the next one is output before.
fn hold_single(case: &Case, single: &Single, report: &Report) -> Result<(), TestCaseError> {
    let within = |t: f64| t > f64::from(single.from) * T - 1e-9 && t < f64::from(single.to) * T - 1e-9;
    // Where the path comes to rest at the end of a block: the last sample is the end of the run.
    let stops = report
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Stop && within(event.t));
    for stop in stops {
        let distance = report
            .samples
            .iter()
            .take_while(|sample| sample.t <= stop.t + 1e-9);
        let distance = distance.last().map_or(0.0, |sample| sample.distance_mm);
        let end = case
            .ends
            .iter()
            .find(|(end, _)| (end - distance).abs() < ROUNDING);
        let Some((end, blocks)) = end.filter(|_| distance > ROUNDING) else {
            prop_assert!(distance < ROUNDING, "it stands at {distance}");
            continue;
        };
        let start = single.next_start(stop.t);
        let before = report.samples.iter().filter(|sample| sample.t <= start + 1e-9);
        let farthest = before.map(|sample| sample.distance_mm).fold(0.0, f64::max);
        prop_assert!(
            farthest <= end + ROUNDING,
            "{end} is passed before {start}: {farthest}"
        );
        for event in report.of(EventKind::Output) {
            let known = &case.known[event.function.as_deref().unwrap()];
            if known.place.is_some() && known.order.0 >= *blocks {
                prop_assert!(event.t >= start - 1e-9, "{event:?} {known:?} before {start}");
            }
        }
    }
    // After the first standstill a start leads over one end of a block, and no more.
    let first = report
        .events
        .iter()
        .find(|event| event.kind == EventKind::Stop && within(event.t));
    let Some(first) = first else { return Ok(()) };
    let mut passed = 0;
    let mut at = None;
    for sample in report.samples.iter().filter(|sample| within(sample.t)) {
        let beyond = case
            .ends
            .iter()
            .filter(|(end, _)| sample.distance_mm > end + ROUNDING)
            .count();
        if sample.t <= first.t + 1e-9 {
            at = Some(beyond);
        }
        passed = passed.max(beyond - at.unwrap_or(beyond));
        let starts = single.starts.iter().map(|start| f64::from(*start) * T);
        let starts = starts
            .filter(|start| *start >= first.t - 1e-9 && *start <= sample.t + 1e-9)
            .count();
        // At a gate before the end of its block it may stand without one.
        prop_assert!(
            passed <= starts + 1,
            "{passed} ends are passed with {starts} starts"
        );
    }
    Ok(())
}

/// Where a function of a block between two movements is output; not known of one that is output ahead.
fn place(kind: &str, start: f64, end: f64) -> Option<f64> {
    match kind {
        "MNS_SNS" => Some(end),
        kind if kind.starts_with("ME") => None,
        _ => Some(start),
    }
}

fn case(blocks: &[Block]) -> Case {
    let (mut program, mut list, mut script) =
        ("%LAWS\nN1 G00 F4000\n".to_owned(), String::new(), String::new());
    let mut known: HashMap<String, Known> = HashMap::new();
    let (mut distance, mut x, mut y, mut number, mut late) = (0.0f64, 0.0, 0.0, FIRST, 0);
    let mut ends = Vec::new();
    let mut open: [Vec<String>; 2] = Default::default();
    for (index, block) in blocks.iter().enumerate() {
        if block.synchronise {
            program += "#EXPL SYN\n";
            for name in open[1].drain(..) {
                known.get_mut(&name).unwrap().gate = Some(distance);
            }
        }
        program += &format!("N{} ", index + 2);
        let start = distance;
        if let Some((rapid, dx, dy)) = block.motion {
            (x, y, distance) = (x + dx, y + dy, distance + dx.hypot(dy));
            ends.push((distance, index + 1));
            program += &format!("{} X{x:.6} Y{y:.6} ", if rapid { "G00" } else { "G01" });
        }
        let feed = block.motion.is_some_and(|(rapid, ..)| !rapid);
        for (at, switch) in block.functions.iter().enumerate() {
            let mut kind = TYPES[switch.kind];
            if kind.starts_with("MVS_SL") {
                late += 1;
                if late > LATE {
                    kind = "MOS";
                }
            }
            let name = format!("M{number}");
            number += 1;
            let range = if switch.of_axis { "X" } else { "channel" };
            program += &if switch.of_axis {
                format!("X[{name}] ")
            } else {
                format!("{name} ")
            };
            list += &format!("m_synch[{}] {kind}\n", &name[1..]);
            if kind.starts_with("ME") {
                list += &format!("m_pre_outp[{}] {}\n", &name[1..], switch.lead * 1000);
            }
            script += &format!("{name} ack {:.3}\n", f64::from(switch.cycles) * T);
            let gate = match kind {
                "MVS_SVS" | "MEP_SVS" | "MET_SVS" => Some(start),
                "MVS_SNS" | "MNS_SNS" => Some(distance),
                "MVS_SLM" if feed => Some(start),
                _ => None,
            };
            match kind {
                "MVS_SLM" if !feed => open[0].push(name.clone()),
                "MVS_SLP" => open[1].push(name.clone()),
                _ => {}
            }
            let place = place(kind, start, distance);
            let order = (index, kind == "MNS_SNS" && block.motion.is_some(), at);
            let one = Known {
                kind,
                range,
                order,
                gate,
                place,
            };
            known.insert(name, one);
        }
        if feed {
            for name in open[0].drain(..) {
                known.get_mut(&name).unwrap().gate = Some(start);
            }
        }
        program += "\n";
    }
    program += "M30\n";
    Case {
        bench: Bench::new(&program, &list).script(&script),
        known,
        distance,
        ends,
    }
}

/// What holds whatever happens.
fn hold_gates(case: &Case, report: &Report) -> Result<(), TestCaseError> {
    let mut acknowledged: HashMap<&str, f64> = HashMap::new();
    for event in report.of(EventKind::Acknowledge) {
        let twice = acknowledged.insert(event.function.as_deref().unwrap(), event.t);
        prop_assert!(twice.is_none(), "{:?}", event);
    }
    for (name, known) in &case.known {
        let Some(gate) = known.gate else { continue };
        let until = acknowledged.get(name.as_str()).copied().unwrap_or(f64::INFINITY);
        let before = report.samples.iter().filter(|sample| sample.t <= until);
        let farthest = before.map(|sample| sample.distance_mm).fold(0.0, f64::max);
        prop_assert!(
            farthest <= gate + ROUNDING,
            "{name} {known:?} lets the path go to {farthest} before {until}"
        );
    }
    // In program order, each range by itself; nothing beside a function of an earlier cycle that is not fetched.
    for range in ["channel", "X"] {
        let outputs = report.of(EventKind::Output);
        let of_range = outputs
            .iter()
            .filter(|event| event.target.as_deref() == Some(range));
        let known = of_range.map(|event| &case.known[event.function.as_deref().unwrap()]);
        let in_place: Vec<_> = known.filter(|known| known.place.is_some()).collect();
        for pair in in_place.windows(2) {
            prop_assert!(pair[0].order < pair[1].order, "{pair:?}");
        }
        hold_range(report, range)?;
    }
    Ok(())
}

/// Nothing is output beside a function of an earlier cycle that is not fetched, and each is fetched once.
fn hold_range(report: &Report, range: &str) -> Result<(), TestCaseError> {
    let mut unfetched: HashMap<&str, Vec<f64>> = HashMap::new();
    for event in &report.events {
        let function = event.function.as_deref().unwrap_or_default();
        match event.kind {
            EventKind::Output if event.target.as_deref() == Some(range) => {
                prop_assert!(unfetched.values().flatten().all(|t| *t >= event.t), "{event:?}");
                unfetched.entry(function).or_default().push(event.t);
            }
            EventKind::Fetch if event.target.as_deref() == Some(range) => {
                prop_assert!(
                    unfetched.get_mut(function).and_then(Vec::pop).is_some(),
                    "{event:?}"
                );
            }
            _ => {}
        }
    }
    Ok(())
}

fn hold_laws(case: &Case, single: Option<&Single>, report: &Report) -> Result<(), TestCaseError> {
    prop_assert!(report.completed, "{:?} {:?}", report.error, report.waits);
    hold_gates(case, report)?;
    prop_assert_eq!(report.of(EventKind::Output).len(), case.known.len());
    prop_assert_eq!(report.of(EventKind::Fetch).len(), case.known.len());
    // A wait ends with its acknowledgement, in the same cycle, and the path goes when the last one ends.
    for wait in &report.waits {
        let acknowledged = report.events.iter().find(|event| {
            event.kind == EventKind::Acknowledge && event.function.as_ref() == Some(&wait.function)
        });
        let known = &case.known[&wait.function];
        prop_assert_eq!(
            acknowledged.map(|event| event.t),
            wait.to_s,
            "{:?} {:?}",
            wait,
            known
        );
    }
    let mut stopped = None;
    for event in &report.events {
        match event.kind {
            EventKind::Stop => stopped = Some(event.t),
            EventKind::Go => {
                if let Some(stop) = stopped.take() {
                    let within = report
                        .waits
                        .iter()
                        .filter(|wait| wait.from_s >= stop && wait.from_s < event.t);
                    let last = within.filter_map(|wait| wait.to_s).fold(0.0, f64::max);
                    // A start, or the end of single block, may come later than the last acknowledgement.
                    let started = single
                        .is_some_and(|single| (single.next_start(stop) - event.t).abs() < 1e-9)
                        || single
                            .is_some_and(|single| (single.next_start(last.max(stop)) - event.t).abs() < 1e-9);
                    prop_assert!(
                        started || (event.t - last).abs() < 1e-9,
                        "{:?} goes at {}, not {}",
                        event,
                        event.t,
                        last
                    );
                }
            }
            EventKind::Output => {
                let known = &case.known[event.function.as_deref().unwrap()];
                // Where an output lies is asked where the path is known: without a movement in Y.
                let x = event.position.0[bahn_path::Axis::X];
                let y = event.position.0[bahn_path::Axis::Y];
                if let Some(place) = known.place.filter(|_| y == 0.0) {
                    prop_assert!((x - place).abs() < 1e-3, "{event:?} {known:?}");
                }
            }
            _ => {}
        }
    }
    Ok(())
}

#[test]
fn ten_thousand_random_programs_with_random_acknowledgements() {
    let config = ProptestConfig {
        cases: 10_000,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let blocks = (prop::collection::vec(block(), 1..14), single());
    let result = runner.run(&blocks, |(blocks, single)| {
        let mut case = case(&blocks);
        if let Some(single) = &single {
            let script = case.bench.script.clone().unwrap() + &single.script();
            case.bench = case.bench.clone().script(&script);
        }
        let report = case.bench.run();
        hold_laws(&case, single.as_ref(), &report)?;
        single.map_or(Ok(()), |single| hold_single(&case, &single, &report))
    });
    if let Err(error) = result {
        panic!("{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Holds, other overrides and resets at any moment: gates stay gates, and every run ends.
    #[test]
    fn holds_and_resets_at_any_moment(
        blocks in prop::collection::vec(block(), 1..10),
        holds in prop::collection::vec((0.0..2.0f64, 0.0..0.5f64), 0..4),
        overrides in prop::collection::vec((0.0..2.0f64, 1.0..150.0f64), 0..4),
        reset in prop::option::of(0.0..2.0f64),
    ) {
        let mut case = case(&blocks);
        let mut script = case.bench.script.clone().unwrap();
        for (from, time) in &holds {
            script += &format!("hold {from}..{}\n", from + time);
        }
        for (at, percent) in &overrides {
            script += &format!("override {percent} at {at}\n");
        }
        if let Some(reset) = reset {
            script += &format!("reset {reset}\n");
        }
        case.bench = case.bench.clone().script(&script);
        let report = case.bench.run();
        hold_gates(&case, &report)?;
        let was_reset = reset.is_some_and(|reset| report.time_s >= reset);
        prop_assert!(report.completed || was_reset, "{:?}", report.waits);
        prop_assert!(report.error.is_none());
    }

    /// Back and forth, simulated, with functions that are never fetched or acknowledged: every run ends, and one that is
    /// completed stands where the program ends, with everything fetched and every range served in order.
    #[test]
    fn back_and_forth_at_any_moment(
        blocks in prop::collection::vec(block(), 1..10),
        backward in prop::collection::vec((0.0..2.5f64, 0.0..0.7f64), 0..4),
        simulated in prop::collection::vec((0.0..2.0f64, 0.0..0.5f64), 0..3),
        holds in prop::collection::vec((0.0..2.0f64, 0.0..0.5f64), 0..3),
        never in prop::option::weighted(0.3, (0..8usize, any::<bool>())),
        single in single(),
        bits in any::<u64>(),
    ) {
        let mut case = case(&blocks);
        // Some have the bits for going back and for simulated motion.
        let lines = case.bench.list.lines().zip(0..);
        let with_bits = lines.map(|(line, at)| match (bits >> (at % 32)) & 3 {
            0 if line.starts_with("m_synch") => format!("{line} | BWD_SYNCH\n"),
            1 if line.starts_with("m_synch") => format!("{line} | FWD_SYNCH\n"),
            _ => format!("{line}\n"),
        });
        let list: String = with_bits.collect();
        let mut script = case.bench.script.clone().unwrap();
        for (name, ranges) in [("backward", &backward), ("simulated", &simulated), ("hold", &holds)] {
            for (from, time) in ranges {
                script += &format!("{name} {from}..{}\n", from + time);
            }
        }
        script += &single.map_or_else(String::new, |single| single.script());
        if let Some((at, fetched)) = never {
            script += &format!("M{} {}\n", FIRST + at, if fetched { "ack never" } else { "nofetch" });
        }
        case.bench.list = list;
        case.bench = case.bench.clone().script(&script);
        let report = case.bench.run();
        prop_assert!(report.error.is_none(), "{:?}", report.error);
        if never.is_none() {
            prop_assert!(report.completed, "{:?} {:?}", report.waits, report.time_s);
            prop_assert_eq!(report.of(EventKind::Output).len(), report.of(EventKind::Fetch).len());
            let distance = report.samples.last().map_or(0.0, |sample| sample.distance_mm);
            prop_assert!((distance - case.distance).abs() < ROUNDING, "{} {}", distance, case.distance);
        }
        for range in ["channel", "X"] {
            hold_range(&report, range)?;
        }
    }
}
