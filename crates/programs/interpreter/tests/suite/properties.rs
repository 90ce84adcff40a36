//! Laws that hold for every program.

use crate::contour::{Contour, Spelling, contours, convex_contours};
use crate::support::{Job, Run};
use bahn_interpreter::{Interpreter, NoPrograms, Settings};
use bahn_path::{Axis, Curve, ElementSource, Frame, LiveData, PathElement, PerAxis, Plane, Position, Step};
use bahn_program::Program;
use proptest::prelude::*;
use std::sync::Arc;

/// Positions of laws that compare two calculations of the same path, mm.
const SAME_MM: f64 = 1e-6;

fn at(position: &Position) -> [f64; 2] {
    [position[Axis::X], position[Axis::Y]]
}

/// How far along the contour the distance of the tool is checked.
#[derive(Clone, Copy, PartialEq)]
enum Reach {
    Neighbours,
    WholeContour,
}

/// The tool's centre is nowhere nearer to the contour than its radius, and beside each element exactly as far.
fn keeps_its_distance(contour: &Contour, reach: Reach) -> Result<(), TestCaseError> {
    let run = Job::exact(&contour.program(Spelling::Absolute)).run();
    prop_assume!(run.error.is_none());
    let blocks = contour.element_blocks();
    let last = blocks.len() - 1;
    let mut block_before = 0;
    for element in run.moves() {
        // The second element of a block leads round the corner to the next one.
        let at_corner = element.block.block == block_before;
        block_before = element.block.block;
        let Some(own) = blocks.iter().position(|block| *block == element.block.block) else {
            continue;
        };
        let others = match reach {
            Reach::Neighbours if at_corner => own..=own + 1,
            Reach::Neighbours => own.saturating_sub(1)..=(own + 1).min(last),
            Reach::WholeContour => 0..=last,
        };
        for k in 0..=16 {
            let p = at(&element
                .curve
                .position(&element.start, &element.end, f64::from(k) / 16.0));
            for other in others.clone() {
                let distance = contour.distance(other, p);
                prop_assert!(
                    distance >= contour.tool_radius - 1e-3,
                    "beside element {own} the tool comes to {distance} from element {other}"
                );
            }
            let distance = contour.distance(own, p);
            prop_assert!(
                (distance - contour.tool_radius).abs() <= 1e-3,
                "{distance} from element {own}"
            );
        }
    }
    // The path has no gaps.
    let moves: Vec<&PathElement> = run.moves().collect();
    for pair in moves.windows(2) {
        let (a, b) = (at(&pair[0].end), at(&pair[1].start));
        prop_assert!((a[0] - b[0]).hypot(a[1] - b[1]) < SAME_MM);
    }
    Ok(())
}

/// Both runs have the same path, or the same message; `map` takes a point of the first to the second.
fn same_path(a: &Run, b: &Run, map: impl Fn(&Position) -> Position, turns: f64) -> Result<(), TestCaseError> {
    let message = |run: &Run| run.error.as_ref().map(|error| error.message.clone());
    prop_assert_eq!(message(a), message(b));
    let (first, second): (Vec<_>, Vec<_>) = (a.moves().collect(), b.moves().collect());
    prop_assert_eq!(first.len(), second.len());
    for (p, q) in first.iter().zip(&second) {
        let (expected, actual) = (at(&map(&p.end)), at(&q.end));
        let off = (expected[0] - actual[0]).hypot(expected[1] - actual[1]);
        prop_assert!(off < SAME_MM, "{:?} is not {:?}", actual, expected);
        match (p.curve, q.curve) {
            (Curve::Arc(x), Curve::Arc(y)) => {
                let mut centre = Position::ZERO;
                Plane::XY.set(&mut centre, x.centre);
                let centre = at(&map(&centre));
                prop_assert!((centre[0] - y.centre[0]).hypot(centre[1] - y.centre[1]) < 100.0 * SAME_MM);
                prop_assert!(
                    (x.sweep_deg * turns - y.sweep_deg).abs() < 1e-3,
                    "{} {}",
                    x.sweep_deg,
                    y.sweep_deg
                );
            }
            (x, y) => prop_assert_eq!(std::mem::discriminant(&x), std::mem::discriminant(&y)),
        }
    }
    Ok(())
}

fn unchanged(p: &Position) -> Position {
    *p
}

/// The blocks of cycles 7, 8, 10 and 11 for a frame.
fn transformation(shift: [f64; 2], mirror: [bool; 2], rotation: f64, scale: f64) -> (String, Frame) {
    let axes = match mirror {
        [true, true] => "X Y",
        [true, false] => "X",
        [false, true] => "Y",
        [false, false] => "",
    };
    let text = format!(
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X{:+.12}\nCYCL DEF 7.2 Y{:+.12}\nCYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 {axes}\n\
         CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT {rotation:+.12}\nCYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL {scale:.12}\n",
        shift[0], shift[1]
    );
    let mut frame = Frame::identity(Plane::XY);
    frame.shift[Axis::X] = shift[0];
    frame.shift[Axis::Y] = shift[1];
    frame.rotation_deg = rotation;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        frame.factor[axis] = scale;
    }
    if mirror[0] {
        frame.factor[Axis::X] = -scale;
    }
    if mirror[1] {
        frame.factor[Axis::Y] = -scale;
    }
    (text, frame)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_global_rejects: 100_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The rule of these controls looks at two neighbouring elements at a time: outside corners get a
    /// transition arc, inside corners the intersection of both parallels, and what cannot be reached that way
    /// is TOOL RADIUS TOO LARGE [003:2061-2078] [003:8009-8014]. They do not look further along the contour: an
    /// element that comes near a much later one is damaged without a message. So for any contour the law holds
    /// for each element and its neighbours, as long as these do not turn back and cut each other.
    #[test]
    fn a_compensated_path_keeps_the_tool_radius_to_its_neighbours(contour in contours(false)) {
        prop_assume!(!contour.turns_back());
        keeps_its_distance(&contour, Reach::Neighbours)?;
    }

    /// Outside and inside of a convex contour the rule for neighbours is enough for the whole contour.
    #[test]
    fn a_compensated_path_keeps_the_tool_radius_to_a_convex_contour(contour in convex_contours()) {
        keeps_its_distance(&contour, Reach::WholeContour)?;
    }

    /// Where an element says that it goes on tangentially, it does: motion passes there without slowing down.
    /// Transition arcs begin and end tangentially, roundings too; no joint has a gap.
    #[test]
    fn tangential_joints_are_tangential(contour in contours(true)) {
        let run = Job::exact(&contour.program(Spelling::Absolute)).run();
        let moves: Vec<&PathElement> = run.moves().collect();
        for pair in moves.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let (p, q) = (at(&a.end), at(&b.start));
            prop_assert!((p[0] - q[0]).hypot(p[1] - q[1]) < SAME_MM);
            if a.tangential_end && b.length() > 1e-3 && a.length() > 1e-3 {
                let in_plane = |tangent: PerAxis<f64>| [tangent[Axis::X], tangent[Axis::Y]];
                let s = in_plane(a.curve.tangent(&a.start, &a.end, 1.0));
                let t = in_plane(b.curve.tangent(&b.start, &b.end, 0.0));
                let turn = (s[0] * t[1] - s[1] * t[0]).atan2(s[0] * t[0] + s[1] * t[1]).to_degrees();
                prop_assert!(turn.abs() < 0.2, "{turn}° between {a:?} and {b:?}");
            }
        }
    }

    /// Shifted, mirrored, rotated: the path is the transformed path. Scaled by f the tool keeps its radius,
    /// so the plain run has a tool of R/f.
    #[test]
    fn a_transformed_run_is_the_transformed_path(
        contour in contours(true),
        shift in (-100.0..100.0f64, -100.0..100.0f64),
        mirror in any::<[bool; 2]>(),
        rotation in prop_oneof![Just(0.0), -360.0..360.0f64],
        scale in prop_oneof![Just(1.0), 0.3..3.0f64],
    ) {
        let (text, frame) = transformation([shift.0, shift.1], mirror, rotation, scale);
        let plain = Contour { tool_radius: contour.tool_radius / scale, ..contour.clone() };
        let a = Job::exact(&plain.program(Spelling::Absolute)).run();
        let b = Job::exact(&contour.program_with(Spelling::Absolute, &text)).run();
        let turns = if frame.reverses(Plane::XY) { -1.0 } else { 1.0 };
        same_path(&a, &b, |p| frame.to_outer(p), turns)?;
    }

    #[test]
    fn incremental_points_are_the_same(contour in contours(true)) {
        let a = Job::exact(&contour.program(Spelling::Absolute)).run();
        let b = Job::exact(&contour.program(Spelling::Incremental)).run();
        same_path(&a, &b, unchanged, 1.0)?;
    }

    #[test]
    fn polar_points_are_the_same(contour in contours(true)) {
        let a = Job::exact(&contour.program(Spelling::Absolute)).run();
        let b = Job::exact(&contour.program(Spelling::Polar)).run();
        same_path(&a, &b, unchanged, 1.0)?;
    }

    #[test]
    fn a_program_in_inches_is_the_same(contour in contours(true)) {
        let a = Job::exact(&contour.program(Spelling::Absolute)).run();
        let b = Job::exact(&contour.program(Spelling::Inch)).run();
        same_path(&a, &b, unchanged, 1.0)?;
        for (p, q) in a.moves().zip(b.moves()) {
            match (p.feed, q.feed) {
                (bahn_path::FeedRate::Programmed(p), bahn_path::FeedRate::Programmed(q)) => prop_assert!((p - q).abs() < 1e-6),
                (p, q) => prop_assert_eq!(p, q),
            }
        }
    }

    /// Machined from the other end with the other side, the tool runs the same way backwards.
    #[test]
    fn the_reversed_contour_is_the_reversed_path(contour in contours(false)) {
        let a = Job::exact(&contour.program(Spelling::Absolute)).run();
        let b = Job::exact(&reversed(&contour).program(Spelling::Absolute)).run();
        prop_assert_eq!(a.error.is_some(), b.error.is_some());
        prop_assume!(a.error.is_none());
        // Without approach and departure.
        let inner = |run: &Run| {
            let moves: Vec<PathElement> = run.moves().cloned().collect();
            moves[2..moves.len() - 1].to_vec()
        };
        let (there, mut back) = (inner(&a), inner(&b));
        back.reverse();
        prop_assert_eq!(there.len(), back.len());
        for (p, q) in there.iter().zip(&back) {
            let (s, e) = (at(&q.start), at(&q.end));
            prop_assert!((at(&p.start)[0] - e[0]).hypot(at(&p.start)[1] - e[1]) < SAME_MM);
            prop_assert!((at(&p.end)[0] - s[0]).hypot(at(&p.end)[1] - s[1]) < SAME_MM);
        }
    }

    /// With tool axis Y the plane is Z/X, with tool axis X it is Y/Z [003:2733-2738]: the same contour in
    /// other letters is the same path on other axes.
    #[test]
    fn other_tool_axes_are_the_same(contour in contours(true), polar in any::<bool>()) {
        let spelling = if polar { Spelling::Polar } else { Spelling::Absolute };
        let text = contour.program(spelling);
        let plain = Job::new(text.clone()).run();
        for (first, second, tool) in [('Z', 'X', 'Y'), ('Y', 'Z', 'X')] {
            let renamed: String = text
                .replace("TOOL CALL 1 Z", "TOOL CALL 1 @")
                .chars()
                .map(|c| match c {
                    'X' => first,
                    'Y' => second,
                    '@' => tool,
                    c => c,
                })
                .collect::<String>()
                .replace(&format!("FMA{first}"), "FMAX");
            let other = Job::new(renamed).run();
            let axis = |letter: char| Axis::from_letter(letter as u8).unwrap();
            prop_assert_eq!(plain.error.as_ref().map(|e| (&e.message, e.block)), other.error.as_ref().map(|e| (&e.message, e.block)));
            let (a, b): (Vec<_>, Vec<_>) = (plain.moves().collect(), other.moves().collect());
            prop_assert_eq!(a.len(), b.len());
            for (p, q) in a.iter().zip(&b) {
                prop_assert_eq!([p.end[Axis::X], p.end[Axis::Y]], [q.end[axis(first)], q.end[axis(second)]]);
                if let (Curve::Arc(x), Curve::Arc(y)) = (p.curve, q.curve) {
                    prop_assert_eq!((x.centre, x.sweep_deg), (y.centre, y.sweep_deg));
                }
            }
        }
    }

    /// A contour called as a subprogram, or from another program, is the contour written out.
    #[test]
    fn called_is_written_out(contour in contours(true), times in 1..4usize) {
        let blocks = contour.blocks(Spelling::Absolute);
        let head = format!("TOOL DEF 1 L+0 R{:+.12}\nTOOL CALL 1 Z S1000\n", contour.tool_radius);
        let wrap = |body: &str| format!("BEGIN PGM 1 MM\n{head}{body}END PGM 1 MM\n");
        let written = Job::new(wrap(&blocks.repeat(times))).run();
        let called = wrap(&format!("{}STOP M2\nLBL 1\n{blocks}LBL 0\n", "CALL LBL 1\n".repeat(times)));
        same_path(&written, &Job::new(called).run(), unchanged, 1.0)?;
        let repeated = wrap(&format!("LBL 1\n{blocks}CALL LBL 1 REP {}\n", times - 1));
        same_path(&written, &Job::new(repeated).run(), unchanged, 1.0)?;
        let other = format!("BEGIN PGM 2 MM\n{blocks}END PGM 2 MM\n");
        let program = wrap(&"CALL PGM 2\n".repeat(times));
        same_path(&written, &Job::new(program).library("2", other).run(), unchanged, 1.0)?;
    }

    /// From a checkpoint taken before any step the run goes on as it did the first time.
    #[test]
    fn a_checkpoint_brings_the_run_back(contour in contours(true), at in 0..30usize) {
        let text = format!(
            "BEGIN PGM 1 MM\nTOOL DEF 1 L+0 R{:+.12}\nTOOL CALL 1 Z S1000\nLBL 1\nFN 1: Q1 = +Q1 + +1\nCYCL DEF 7.0 D\nCYCL DEF 7.1 IX+Q1\n\
             CALL LBL 2\nCALL LBL 1 REP 2/2\nL Z+1 FMAX M2\nLBL 2\n{}LBL 0\nEND PGM 1 MM\n",
            contour.tool_radius,
            contour.blocks(Spelling::Absolute)
        );
        let program = Arc::new(Program::from_bytes("1", text.into_bytes()));
        let mut run = Interpreter::new(program, Settings::default(), Arc::new(NoPrograms));
        let mut steps = 0;
        let mut checkpoint = run.checkpoint();
        let mut first = Vec::new();
        loop {
            if steps == at {
                checkpoint = run.checkpoint();
                first.clear();
            }
            steps += 1;
            let step = run.next();
            let over = matches!(step, Step::End | Step::Error(_));
            first.push(step);
            if over {
                break;
            }
        }
        let q = run.q_values().to_vec();
        run.restore(&checkpoint);
        for expected in first {
            prop_assert_eq!(run.next(), expected);
        }
        prop_assert_eq!(run.q_values(), &q[..]);
    }

    /// A cycle called in a transformed system runs the transformed path.
    #[test]
    fn a_transformed_cycle_is_the_transformed_path(
        cycle in cycle(),
        shift in (-100.0..100.0f64, -100.0..100.0f64),
        mirror in any::<[bool; 2]>(),
        rotation in prop_oneof![Just(0.0), Just(90.0), -360.0..360.0f64],
        scale in prop_oneof![Just(1.0), 0.3..3.0f64],
        tool_radius in 2.0..6.0f64,
    ) {
        let (text, frame) = transformation([shift.0, shift.1], mirror, rotation, scale);
        let program = |radius: f64, before: &str| {
            format!(
                "BEGIN PGM 1 MM\nTOOL DEF 1 L+0 R{radius:+.12}\nTOOL CALL 1 Z S1000\n{before}{cycle}\n\
                 L X+10 Y+20 R0 FMAX M3\nL Z+2 FMAX M99\nL Z+50 FMAX M2\nLBL 1\nL X-40 Y-30 RL\nL X+60\nRND R15\nL Y+50\nL X-40\nL Y-30\nLBL 0\n\
                 LBL 2\nCC X+10 Y+15\nL X+0 Y+15 RR\nC X+0 Y+15 DR+\nLBL 0\nEND PGM 1 MM\n"
            )
        };
        let a = Job::exact(&program(tool_radius / scale, "")).run();
        let b = Job::exact(&program(tool_radius, &text)).run();
        let message = |run: &Run| run.error.as_ref().map(|error| error.message.clone());
        prop_assert_eq!(message(&a), message(&b));
        let (first, second): (Vec<_>, Vec<_>) = (a.moves().collect(), b.moves().collect());
        prop_assert_eq!(first.len(), second.len());
        // With one axis mirrored, fixed cycles run in the opposite direction, as the mirror image does
        // [003:6276-6284]; cycle 16 keeps climb or up-cut milling (inferred).
        let contour_cycle = cycle.contains("CYCL DEF 14.0");
        if !(frame.reverses(Plane::XY) && contour_cycle) {
            let turns = if frame.reverses(Plane::XY) { -1.0 } else { 1.0 };
            same_path(&a, &b, |p| frame.to_outer(p), turns)?;
        }
        // The advanced stop distance of pecking is a length of the control, not of the program: it ends rapid
        // movements in the hole, and these alone.
        for (p, q) in first.iter().zip(&second).filter(|(p, _)| !crate::support::is_rapid(p)) {
            let depth = (p.end[Axis::Z] * scale - q.end[Axis::Z]).abs();
            prop_assert!(p.end[Axis::Z].is_nan() || depth < SAME_MM, "{:?} {:?}", p.end, q.end);
        }
    }

    /// Any sequence of blocks comes to an end: with a path, a message, or the end of the patience. Without
    /// the block that the message names it comes further.
    #[test]
    fn no_sequence_of_blocks_breaks_the_interpreter(blocks in prop::collection::vec(block(), 1..40)) {
        let mut lines: Vec<String> = vec!["BEGIN PGM 1 MM".into(), "TOOL DEF 1 L+5 R+3".into()];
        lines.extend(blocks.iter().flat_map(|block| block.lines()).map(str::to_owned));
        lines.push("END PGM 1 MM".into());
        while let Some(faulty) = run_bounded(&lines.join("\n"))? {
            let faulty = faulty as usize;
            prop_assert!(faulty < lines.len(), "block {faulty}");
            if faulty == 0 || faulty + 1 == lines.len() {
                break;
            }
            lines.remove(faulty);
        }
    }
}

/// Runs a program as far as some thousand elements; gives the block of its error.
fn run_bounded(text: &str) -> Result<Option<u32>, TestCaseError> {
    let program = Arc::new(Program::from_bytes("1", text.as_bytes().to_vec()));
    let settings = Settings {
        max_blocks_without_motion: 2_000,
        ..Settings::default()
    };
    let mut run = Interpreter::new(program, settings, Arc::new(NoPrograms));
    for _ in 0..5_000 {
        match run.next() {
            Step::Element(element) => {
                prop_assert!(element.length().is_finite(), "{element:?}");
                prop_assert!(element.dwell_s >= 0.0);
            }
            Step::Barrier(barrier) => {
                let touch = match barrier {
                    bahn_path::Barrier::Probe { to, .. } => Some(bahn_path::Touch { position: to }),
                    _ => None,
                };
                run.resume(LiveData {
                    touch,
                    ..LiveData::default()
                });
            }
            Step::Error(error) => return Ok(Some(error.block.block)),
            Step::End | Step::Starved => break,
        }
    }
    Ok(None)
}

fn reversed(contour: &Contour) -> Contour {
    let mut points = vec![contour.start];
    points.extend(contour.pieces.iter().map(|piece| piece.end));
    let pieces = contour
        .pieces
        .iter()
        .enumerate()
        .rev()
        .map(|(k, piece)| crate::contour::Piece {
            shape: match piece.shape {
                crate::contour::Shape::Arc(centre, ccw) => crate::contour::Shape::Arc(centre, !ccw),
                line => line,
            },
            end: points[k],
            joint: crate::contour::Joint::Corner,
        });
    Contour {
        start: points[points.len() - 1],
        pieces: pieces.collect(),
        left: !contour.left,
        tool_radius: contour.tool_radius,
    }
}

/// A machining cycle with fitting numbers.
fn cycle() -> impl Strategy<Value = String> {
    let numbers = (
        1.0..20.0f64,
        0.8..9.0f64,
        13.0..60.0f64,
        13.0..60.0f64,
        any::<bool>(),
    );
    (0..6u32, numbers).prop_map(|(kind, (depth, pecking, a, b, plus))| {
        let dr = if plus { "DR+" } else { "DR-" };
        let head = |n: u32| format!("CYCL DEF {n}.0 X\nCYCL DEF {n}.1 SET UP -2\nCYCL DEF {n}.2 DEPTH -{depth:.3}");
        match kind {
            0 => format!("{}\nCYCL DEF 1.3 PECKG -{pecking:.3}\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F80", head(1)),
            1 => format!("{}\nCYCL DEF 3.3 PECKG -{pecking:.3} F80\nCYCL DEF 3.4 X-{a:.3}\nCYCL DEF 3.5 Y+12.5\nCYCL DEF 3.6 F90", head(3)),
            2 => format!("{}\nCYCL DEF 4.3 PECKG -{pecking:.3} F80\nCYCL DEF 4.4 X+{a:.3}\nCYCL DEF 4.5 Y+{b:.3}\nCYCL DEF 4.6 F90 {dr} RADIUS 7", head(4)),
            3 => format!("{}\nCYCL DEF 5.3 PECKG -{pecking:.3} F80\nCYCL DEF 5.4 RADIUS {a:.3}\nCYCL DEF 5.5 F90 {dr}", head(5)),
            4 => format!(
                "CYCL DEF 14.0 G\nCYCL DEF 14.1 CONTOUR LABEL 1/2\nCYCL DEF 16.0 M\nCYCL DEF 16.1 SET UP -2 DEPTH -{depth:.3}\nCYCL DEF 16.2 PECKG -{pecking:.3} F80 {dr} F90"
            ),
            _ => format!(
                "CYCL DEF 14.0 G\nCYCL DEF 14.1 CONTOUR LABEL 1/2\nCYCL DEF 15.0 D\nCYCL DEF 15.1 SET UP -2 DEPTH -{depth:.3}\nCYCL DEF 15.2 PECKG -{pecking:.3} F80 ALLOW +0"
            ),
        }
    })
}

/// A word's number: mostly small, sometimes at the limits.
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => (-60..60i32).prop_map(|n| format!("{n:+}")),
        2 => (-9999..9999i32).prop_map(|n| format!("{:+.3}", f64::from(n) / 1000.0)),
        2 => (0..12u32).prop_map(|q| format!("+Q{q}")),
        1 => prop_oneof![Just("+0"), Just("-30000"), Just("+99999.9999"), Just("+1e"), Just("+Q999")].prop_map(str::to_owned),
    ]
}

#[expect(clippy::too_many_lines, reason = "a list")]
fn block() -> impl Strategy<Value = String> {
    const TEMPLATES: &[&str] = &[
        "L X# Y# FMAX",
        "L X# Y# RL F100",
        "L X# Y# RR F200",
        "L X#",
        "L Y# R0",
        "L Z# FMAX",
        "L IX# IY#",
        "X# R+ F50",
        "C X# Y# DR+ F100",
        "C X# Y# DR-",
        "CC X# Y#",
        "CC",
        "CR X# Y# R# DR+ F80",
        "CT X# Y#",
        "RND R2",
        "RND R#",
        "L 2",
        "LP PR# PA#",
        "LP PA#",
        "CP IPA# DR+",
        "CP PA# DR- Z#",
        "CTP PR# PA#",
        "L X# M97",
        "L Y# M98",
        "L X# M91",
        "LBL 1",
        "LBL 2",
        "LBL 3",
        "LBL 0",
        "CALL LBL 1",
        "CALL LBL 2",
        "CALL LBL 1 REP 2/2",
        "CALL LBL 3 REP 3",
        "CALL PGM 1",
        "FN 0: Q1 = #",
        "FN 1: Q2 = # + #",
        "FN 4: Q3 = # DIV #",
        "FN 5: Q4 = SQRT #",
        "FN 13: Q5 = # ANG #",
        "FN 9: IF # EQU # GOTO LBL 1",
        "FN 12: IF +Q1 LT # GOTO LBL 2",
        "FN 14: ERROR = 3",
        "Q6 = SIN ( # ) / #",
        "FN 15: PRINT 1/Q1",
        "TOOL CALL 1 Z S500",
        "TOOL CALL 1 X S500",
        "TOOL DEF 1 L# R#",
        "TOOL CALL 0 Z",
        "L M3",
        "STOP M5",
        "L X# M99",
        "L Y# M89",
        "CYCL DEF 1.0 P\nCYCL DEF 1.1 S -2\nCYCL DEF 1.2 D #\nCYCL DEF 1.3 P #\nCYCL DEF 1.4 W 0\nCYCL DEF 1.5 F80",
        "CYCL DEF 2.0 T\nCYCL DEF 2.1 S #\nCYCL DEF 2.2 D #\nCYCL DEF 2.3 W 0\nCYCL DEF 2.4 F80",
        "CYCL DEF 3.0 S\nCYCL DEF 3.1 S -2\nCYCL DEF 3.2 D -9\nCYCL DEF 3.3 P # F80\nCYCL DEF 3.4 X#\nCYCL DEF 3.5 Y#\nCYCL DEF 3.6 F90",
        "CYCL DEF 4.0 P\nCYCL DEF 4.1 S -2\nCYCL DEF 4.2 D #\nCYCL DEF 4.3 P -5 F80\nCYCL DEF 4.4 X#\nCYCL DEF 4.5 Y#\nCYCL DEF 4.6 F90 DR+ RADIUS #",
        "CYCL DEF 5.0 C\nCYCL DEF 5.1 S -2\nCYCL DEF 5.2 D -4\nCYCL DEF 5.3 P # F80\nCYCL DEF 5.4 RADIUS #\nCYCL DEF 5.5 F90 DR-",
        "CYCL DEF 14.0 G\nCYCL DEF 14.1 CONTOUR LABEL 1/2",
        "CYCL DEF 14.0 G\nCYCL DEF 14.1 CONTOUR LABEL 9",
        "CYCL DEF 6.0 R\nCYCL DEF 6.1 S -2 D #\nCYCL DEF 6.2 P # F80 ALLOW #\nCYCL DEF 6.3 ANGLE # F90",
        "CYCL DEF 16.0 M\nCYCL DEF 16.1 S -2 D -5\nCYCL DEF 16.2 P # F80 DR- F90",
        "CYCL DEF 17.0 T\nCYCL DEF 17.1 S -2\nCYCL DEF 17.2 D #\nCYCL DEF 17.3 P #",
        "CYCL DEF 7.0 D\nCYCL DEF 7.1 X#\nCYCL DEF 7.2 IY#",
        "CYCL DEF 8.0 M\nCYCL DEF 8.1 X",
        "CYCL DEF 8.0 M\nCYCL DEF 8.1",
        "CYCL DEF 10.0 R\nCYCL DEF 10.1 ROT #",
        "CYCL DEF 11.0 S\nCYCL DEF 11.1 SCL 0.5",
        "CYCL DEF 11.0 S\nCYCL DEF 11.1 SCL 1",
        "CYCL DEF 9.0 W\nCYCL DEF 9.1 W 1",
        "CYCL DEF 13.0 O\nCYCL DEF 13.1 ANGLE 90",
        "CYCL CALL M3",
        "LBL 9\nL X+0 Y+0 RL\nL X+50\nL Y#\nL X+0 Y+0\nLBL 0",
        "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y# Z+0",
        "TCH PROBE 0.0 REF. PLANE Q5 X-\nTCH PROBE 0.1 X# Y#",
    ];
    (
        prop::sample::select(TEMPLATES),
        prop::collection::vec(number(), 6),
    )
        .prop_map(|(template, numbers)| {
            let mut numbers = numbers.iter();
            template.split('#').collect::<Vec<_>>().iter().enumerate().fold(
                String::new(),
                |mut text, (k, part)| {
                    if k > 0 {
                        text.push_str(numbers.next().map_or("+1", |n| n.as_str()));
                    }
                    text.push_str(part);
                    text
                },
            )
        })
}
