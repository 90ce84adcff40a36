//! Fixed cycles: drilling, tapping, slots and pockets.

use std::f64::consts::PI;

use crate::support::*;
use bahn_interpreter::{Rules, Settings};
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_path::{At, Axis, Curve, FeedRate, Function, OverrideLaw, PathElement, Sense, Thread};

/// Feed and end height of movements in the tool axis.
fn heights(elements: &[&PathElement]) -> Vec<(FeedRate, f64)> {
    elements.iter().map(|e| (e.feed, e.end[Axis::Z])).collect()
}

const RAPID: FeedRate = FeedRate::Rapid;

fn feed(mm_min: f64) -> FeedRate {
    FeedRate::Programmed(mm_min)
}

/// P23: pecking. Advanced stop distance 0.6 mm up to a depth of 30 mm [003:4943-4986].
#[test]
fn p23_pecking() {
    let run = run_manual("P23");
    for (block, x, y) in [(13, 20.0, 30.0), (14, 80.0, 50.0)] {
        let moves = run.of_block(block);
        let hole = &moves[1..];
        let expected = [
            (feed(80.0), -10.0),
            (RAPID, 2.0),
            (RAPID, -10.0 + 0.6),
            (feed(80.0), -15.0),
            (RAPID, 2.0),
        ];
        assert_eq!(heights(hole), expected);
        assert!(hole.iter().all(|e| e.end[Axis::X] == x && e.end[Axis::Y] == y));
        // Dwell at the bottom.
        let dwell: f64 = run
            .elements
            .iter()
            .filter(|e| e.block.block == block)
            .map(|e| e.dwell_s)
            .sum();
        assert_eq!(dwell, 1.0);
    }
}

/// The advanced stop distance grows with the depth: depth/50 above 30 mm, 7 mm at most [003:4943-4948].
#[test]
fn advanced_stop_distance() {
    for (depth, stop) in [
        (30.0, 0.6),
        (31.0, 0.62),
        (200.0, 4.0),
        (350.0, 7.0),
        (500.0, 7.0),
    ] {
        let run = run(&format!(
            "TOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S1000\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -{depth}
             CYCL DEF 1.3 PECKG -20\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F80\nL X+0 Y+0 Z+2 FMAX M99"
        ));
        let hole = run.of_block(9);
        // Movement, first infeed, back, down to before the first depth.
        close(hole[3].end[Axis::Z], -20.0 + stop, 1e-9);
        close(hole[hole.len() - 2].end[Axis::Z], -depth, 1e-9);
    }
}

/// P24: tapping with a floating holder: F = S · p, the spindle stops on the way, and reverses at the bottom and
/// above [003:4994-5067] [000:6060-6081].
#[test]
fn p24_tapping() {
    let run = run_manual("P24");
    let moves = run.of_block(12);
    assert_eq!(
        heights(&moves),
        [(RAPID, 3.0), (feed(100.0), -20.0), (feed(100.0), 3.0)]
    );
    assert!(
        moves[1..]
            .iter()
            .all(|e| matches!(e.override_law, OverrideLaw::Tapping { .. }))
    );
    let in_block = run.functions().into_iter().filter(|(block, _)| *block == 12);
    let functions: Vec<_> = in_block.map(|(_, f)| f.clone()).collect();
    assert_eq!(functions, [5, 4, 5, 3].map(Function::M));
    let dwell: f64 = run.elements.iter().map(|e| e.dwell_s).sum();
    assert_eq!(dwell, 0.4);
}

/// A left-hand thread of cycle 2 by a list: the lead of switching the spindle off, s, the M functions and the dwells, s.
fn tapped(model: ControlModel, kind: &str, assignments: &str) -> (f64, Vec<Function>, Vec<f64>) {
    let mut list = ParameterList::reference(model);
    for assignment in assignments.split(' ').chain([kind]) {
        list.assign(assignment).unwrap();
    }
    let settings = Settings {
        model,
        rules: Rules::of(&list),
        ..Settings::default()
    };
    let run = run_with(
        "TOOL DEF 1 L+0 R+3
         TOOL CALL 1 Z S1000
         CYCL DEF 2.0 TAPPING
         CYCL DEF 2.1 SET UP -2
         CYCL DEF 2.2 DEPTH -30
         CYCL DEF 2.3 DWELL 0.2
         CYCL DEF 2.4 F1000
         L X+0 Y+0 Z+2 F9999 M4
         CYCL CALL",
        settings,
    );
    let call: Vec<_> = run.elements.iter().filter(|e| e.block.block == 9).collect();
    let all: Vec<_> = call.iter().flat_map(|e| e.functions()).collect();
    let At::BeforeEnd(early) = all[0].at else {
        panic!("{all:?}")
    };
    (
        early,
        all.iter().map(|f| f.function.clone()).collect(),
        call.iter().map(|e| e.dwell_s).filter(|s| *s > 0.0).collect(),
    )
}

/// Cycle 2 on a machine: S1000 are 6 V of gear 1 (1500 rpm at 9 V); at 0.1 V/ms (MP3410.2) they take 60 ms, less the run-on
/// of 20 ms. With coded speed MP7120.1 counts. Then the dwell MP7120.0 and the programmed one [000:6060-6116].
#[test]
fn tapping_by_the_list() {
    let list = "3510.0=1500 3210.0=9 3410.2=0.1 7120.0=0.3 7120.1=0.35 7120.2=0.02";
    for (kind, lead) in [("3010=3", 0.04), ("3010=1", 0.35)] {
        let (early, codes, dwells) = tapped(ControlModel::Tnc415b, kind, list);
        close(early, lead, 1e-12);
        assert_eq!(codes, [5, 3, 5, 4].map(Function::M), "a left-hand thread");
        assert_eq!(dwells, [0.3, 0.2]);
    }
}

/// A TNC 155 with a coded speed: MP67 is the dwell before the spindle reverses, MP73 the lead of switching it off before the
/// end of the thread [001:1804-1812]; with an analogue speed MP73 is without effect [001:3261]: the lead is the ramp from
/// 1000 / 1500 * 9 V = 6 V with 0.1 V/ms, 60 ms.
#[test]
fn tapping_by_the_list_of_a_tnc_155() {
    let list = "63=1991 67=0.3 73=0.35 78=1500 79=0 86=9 168=0.1";
    for (kind, lead) in [("62=1", 0.35), ("62=3", 0.06)] {
        let (early, codes, dwells) = tapped(ControlModel::Tnc155, kind, list);
        close(early, lead, 1e-12);
        assert_eq!(codes, [5, 3, 5, 4].map(Function::M), "a left-hand thread");
        assert_eq!(dwells, [0.3, 0.2]);
    }
}

/// Cycle 17: the path follows the spindle with the pitch and sense of the thread, in and out; feed override has
/// no effect. The spindle stops, and is oriented unless MP7160 says no [003:4845] [003:5071-5106] [000:6122-6141].
#[test]
fn rigid_tapping() {
    for (pitch, turns, orients) in [
        (0.75, Sense::Clockwise, true),
        (-1.5, Sense::CounterClockwise, true),
        (0.75, Sense::Clockwise, false),
    ] {
        let mut settings = Settings::default();
        settings.rules.tapping.orients = orients;
        let run = run_with(
            &format!(
                "TOOL DEF 1 L+0 R+3
                 TOOL CALL 1 Z S400
                 CYCL DEF 17.0 RIGID TAPPING
                 CYCL DEF 17.1 SET UP -2
                 CYCL DEF 17.2 DEPTH -30
                 CYCL DEF 17.3 PITCH {pitch:+}
                 L X+0 Y+0 Z+2 FMAX M3
                 CYCL CALL
                 CYCL CALL"
            ),
            settings,
        );
        let f = 400.0 * f64::abs(pitch);
        let moves = run.of_block(8);
        assert_eq!(heights(&moves), [(feed(f), -30.0), (feed(f), 2.0)]);
        assert!(run.functions().contains(&(8, &Function::M(5))));
        let thread = |spindle, orientation_deg| {
            OverrideLaw::Spindle(Thread {
                pitch_mm: f64::abs(pitch),
                spindle,
                orientation_deg,
                retracts: true,
            })
        };
        let laws: Vec<_> = moves.iter().map(|e| e.override_law).collect();
        let angle = orients.then_some(0.0);
        assert_eq!(laws, [thread(turns, angle), thread(turns.opposite(), None)]);
        // The spindle stands from then on.
        assert_eq!(heights(&run.of_block(9)), [(feed(f), -30.0), (feed(f), 2.0)]);
    }
}

/// Cycle 18: Z follows the spindle from where it stands to DEPTH from there, and stays [000:6143-6145]. A right-hand
/// thread turns clockwise downwards, the other way upwards.
#[test]
fn thread_cutting() {
    for (depth, pitch, spindle) in [
        (-20.0, 1.5, Sense::Clockwise),
        (-20.0, -1.5, Sense::CounterClockwise),
        (20.0, 1.5, Sense::CounterClockwise),
    ] {
        let run = run(&format!(
            "TOOL CALL 1 Z S400
             CYCL DEF 18.0 THREAD CUTTING
             CYCL DEF 18.1 DEPTH {depth:+}
             CYCL DEF 18.2 PITCH {pitch:+}
             L X+0 Y+0 Z+2 FMAX M3
             CYCL CALL
             L X+4 FMAX"
        ));
        run.assert_completed();
        let moves = run.of_block(6);
        assert_eq!(heights(&moves), [(feed(600.0), 2.0 + depth)]);
        let law = OverrideLaw::Spindle(Thread {
            pitch_mm: 1.5,
            spindle,
            orientation_deg: Some(0.0),
            retracts: false,
        });
        assert_eq!(moves[0].override_law, law);
        assert!(run.functions().contains(&(6, &Function::M(5))));
        assert_eq!((run.position[Axis::X], run.position[Axis::Z]), (4.0, 2.0 + depth));
    }
    let none = Job::new(program(
        "TOOL CALL 1 Z S0\nCYCL DEF 18.0 THREAD CUTTING\nCYCL DEF 18.1 DEPTH -20\nCYCL DEF 18.2 PITCH +1\nL Z+2 FMAX\nCYCL CALL",
    )).run();
    assert_eq!(none.message(), Some((MessageId::WrongRpm, 6)));
}

/// P25: two slots [003:5190-5215].
#[test]
fn p25_slots() {
    let run = run_manual("P25");
    // Slot 1: X 30..80, Y 10..20, first cut in -X; slot 2: X 15..25, Y 10..90, first cut in +Y.
    let slot = |elements: &[&PathElement]| {
        let cuts: Vec<_> = elements
            .iter()
            .filter(|e| e.end[Axis::Z] < 0.0 && !is_rapid(e))
            .copied()
            .collect();
        let reach = |axis: Axis, sign: f64| {
            cuts.iter().map(|e| sign * e.end[axis]).fold(f64::MIN, f64::max) * sign + sign * 4.0
        };
        let first = cuts.iter().find(|e| e.start[Axis::Z] == e.end[Axis::Z]).unwrap();
        let direction = [
            first.end[Axis::X] - first.start[Axis::X],
            first.end[Axis::Y] - first.start[Axis::Y],
        ];
        (
            [
                reach(Axis::X, -1.0),
                reach(Axis::X, 1.0),
                reach(Axis::Y, -1.0),
                reach(Axis::Y, 1.0),
            ],
            direction.map(|d| if d == 0.0 { 0.0 } else { d.signum() }),
        )
    };
    let (first, second) = (run.of_block(14), run.of_block(23));
    assert_eq!(slot(&first), ([30.0, 80.0, 10.0, 20.0], [-1.0, 0.0]));
    assert_eq!(slot(&second), ([15.0, 25.0, 10.0, 90.0], [0.0, 1.0]));
    for (elements, mm_min) in [(&first, 120.0), (&second, 110.0)] {
        let depths: Vec<f64> = elements
            .iter()
            .filter(|e| e.end[Axis::Z] < e.start[Axis::Z] && !is_rapid(e))
            .map(|e| e.end[Axis::Z])
            .filter(|z| *z < 0.0)
            .collect();
        assert_eq!(depths, [-5.0, -10.0, -15.0]);
        let milling = elements
            .iter()
            .filter(|e| e.start[Axis::Z] == e.end[Axis::Z] && e.end[Axis::Z] < 0.0);
        assert!(milling.into_iter().all(|e| e.feed == feed(mm_min)));
    }
    // Odd number of infeeds: back to the start position at setup clearance [003:5124].
    close_points(&[xyz(&first.last().unwrap().end)], &[[76.0, 15.0, 2.0]], 1e-9);
}

/// P25: the removed volume: both rectangles with corners of the tool's radius R4.
#[test]
fn p25_volume() {
    let corners = (4.0 - PI) * 4.0 * 4.0;
    let expected = (50.0 * 10.0 - corners + 80.0 * 10.0 - corners) * 15.0;
    close(run_manual("P25").removed_mm3(0.1), expected, 0.002 * expected);
}

/// P26: rectangular pocket X 20..100, Y 15..55 with infeeds to 4, 8 and 10 mm [003:5292-5309].
#[test]
fn p26_pocket() {
    let run = run_manual("P26");
    let moves = run.of_block(15);
    let plunges: Vec<f64> = moves
        .iter()
        .filter(|e| e.feed == feed(80.0))
        .map(|e| e.end[Axis::Z])
        .collect();
    assert_eq!(plunges, [-4.0, -8.0, -10.0]);
    let cuts: Vec<_> = moves.iter().filter(|e| e.feed == feed(100.0)).collect();
    let reach = |axis: Axis| {
        let values = cuts.iter().map(|e| e.end[axis]);
        [
            values.clone().fold(f64::MAX, f64::min),
            values.fold(f64::MIN, f64::max),
        ]
    };
    assert_eq!((reach(Axis::X), reach(Axis::Y)), ([25.0, 95.0], [20.0, 50.0]));
    // The first cut runs in the positive direction of the longer side [003:5223-5228].
    assert!(cuts[0].end[Axis::X] > cuts[0].start[Axis::X] && cuts[0].end[Axis::Y] == cuts[0].start[Axis::Y]);
    close_points(&[xyz(&moves.last().unwrap().end)], &[[60.0, 35.0, 2.0]], 1e-9);
    let expected = (80.0 * 40.0 - (4.0 - PI) * 25.0) * 10.0;
    close(run.removed_mm3(0.1), expected, 0.002 * expected);
}

/// P26: DR+ climbs with M3, so the outermost rectangle runs counter-clockwise; DR- runs the other way
/// [003:5256-5258].
#[test]
fn p26_direction() {
    for (dr, sign) in [("DR+", 1.0), ("DR-", -1.0)] {
        let run = Job::new(manual("P26").replace("DR+", dr)).run();
        let area: f64 = run
            .of_block(15)
            .iter()
            .filter(|e| e.end[Axis::Z] == -4.0)
            .map(|e| 0.5 * (e.start[Axis::X] * e.end[Axis::Y] - e.end[Axis::X] * e.start[Axis::Y]))
            .sum();
        assert!(area * sign > 0.0, "{dr}");
    }
}

/// P27: circular pocket R35 with DR- [003:5370-5387].
#[test]
fn p27_circular_pocket() {
    let run = run_manual("P27");
    let moves = run.of_block(13);
    let plunges: Vec<f64> = moves
        .iter()
        .filter(|e| e.feed == feed(80.0))
        .map(|e| e.end[Axis::Z])
        .collect();
    assert_eq!(plunges, [-6.0, -12.0]);
    let circles: Vec<_> = moves
        .iter()
        .filter(|e| matches!(e.curve, Curve::Arc(arc) if arc.sweep_deg.abs() == 360.0))
        .collect();
    assert_eq!(circles.len(), 2);
    for circle in circles {
        close_points(&[arc_of(circle).0], &[[60.0, 50.0]], 1e-9);
        close(arc_radius(circle), 35.0 - 10.0, 1e-9);
    }
    assert!(
        moves
            .iter()
            .filter(|e| matches!(e.curve, Curve::Arc(_)))
            .all(|e| arc_of(e).1 < 0.0)
    );
    close_points(&[xyz(&moves.last().unwrap().end)], &[[60.0, 50.0, 2.0]], 1e-9);
    let expected = PI * 35.0 * 35.0 * 12.0;
    close(run.removed_mm3(0.1), expected, 0.002 * expected);
}

const DRILL: &str = "TOOL DEF 1 L+0 R+3
    TOOL CALL 1 Z S1000
    CYCL DEF 1.0 PECKING
    CYCL DEF 1.1 SET UP -2
    CYCL DEF 1.2 DEPTH -10
    CYCL DEF 1.3 PECKG -10
    CYCL DEF 1.4 DWELL 0
    CYCL DEF 1.5 F80";

/// X positions of the holes.
fn drilled(blocks: &str) -> Vec<f64> {
    let run = run(&format!("{DRILL}\nL X+0 Y+0 Z+2 FMAX\n{blocks}"));
    run.moves()
        .filter(|e| e.feed == feed(80.0))
        .map(|e| e.end[Axis::X])
        .collect()
}

/// M99 calls once, M89 after every positioning block until M99, CYCL CALL or another definition
/// [003:4857-4881].
#[test]
fn cycle_calls() {
    assert_eq!(drilled("L X+1 FMAX M99\nL X+2 FMAX"), [1.0]);
    assert_eq!(
        drilled("L X+1 FMAX M89\nL X+2 FMAX\nL X+3 FMAX M99\nL X+4 FMAX"),
        [1.0, 2.0, 3.0]
    );
    assert_eq!(drilled("L X+1 FMAX M89\nCYCL CALL\nL X+4 FMAX"), [1.0, 1.0]);
    assert_eq!(
        drilled(&format!(
            "L X+1 FMAX M89\n{}\nL X+4 FMAX",
            &DRILL[DRILL.find("CYCL").unwrap()..]
        )),
        [1.0]
    );
    // M89 is a free function when MP7440 says so.
    let text = program(&format!("{DRILL}\nL X+0 Y+0 Z+2 FMAX\nL X+1 FMAX M89"));
    let run = Job::new(text)
        .with(|s| s.rules.m_functions.m89_calls_cycle = false)
        .run();
    run.assert_completed();
    assert!(run.functions().contains(&(10, &Function::M(89))));
    assert_eq!(run.of_block(10).len(), 1);
}

/// What ends M89 is the definition of a cycle that is called [003:4877-4881]: after one that acts at once [003:4846-4852] the
/// last-programmed machining cycle [000:7274] is called as before, here where the datum is then.
#[test]
fn cycles_that_act_at_once_leave_m89() {
    for (cycle, hole) in [
        ("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10", 14.0),
        ("CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X", -4.0),
        ("CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1", 4.0),
        ("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+180", -4.0),
        ("CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.5", 2.0),
        ("CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 0", 4.0),
        (
            "CYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1",
            4.0,
        ),
    ] {
        let blocks = format!("L X+1 FMAX M89\n{cycle}\nL X+4 FMAX");
        let holes = drilled(&blocks);
        assert_eq!(holes.len(), 2, "{cycle}: {holes:?}");
        close(holes[0], 1.0, 1e-9);
        close(holes[1], hole, 1e-9);
    }
}

/// Cycle 9 dwells where it is defined; the spindle goes on [003:6462-6474].
#[test]
fn dwell_time() {
    let run = run("L X+0 FMAX\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 2.5\nL X+1 FMAX");
    let dwells: Vec<_> = run
        .elements
        .iter()
        .filter(|e| e.dwell_s > 0.0)
        .map(|e| e.dwell_s)
        .collect();
    assert_eq!(dwells, [2.5]);
}

/// No cycle dwells for less than no time.
#[test]
fn negative_dwell_time_is_refused() {
    let pecking = |seconds: f64| {
        let text = format!(
            "TOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+2 R0 FMAX M3\n\
             CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -4\nCYCL DEF 1.3 PECKG -4\n\
             FN 0: Q1 = {seconds:+}\nCYCL DEF 1.4 DWELL Q1\nCYCL DEF 1.5 F80\nCYCL CALL"
        );
        Job::new(program(&text)).run().message()
    };
    assert_eq!(pecking(0.0), None);
    assert_eq!(pecking(-0.5), Some((MessageId::EntryValueIncorrect, 11)));
}

/// Cycle 13 gives the angle of M19 [003:6500-6528].
#[test]
fn oriented_spindle_stop() {
    let run = run("CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 45\nL X+0 FMAX M19");
    assert!(
        run.functions()
            .contains(&(3, &Function::SpindleOrientation(45.0)))
    );
}

/// Another tool axis: holes run along it [003:2733-2738].
#[test]
fn drilling_along_x() {
    let text = DRILL.replace("TOOL CALL 1 Z", "TOOL CALL 1 X");
    let run = run(&format!("{text}\nL Y+10 Z+20 X+2 FMAX M99"));
    let bottom = run.moves().find(|e| e.feed == feed(80.0)).unwrap();
    close_points(&[xyz(&bottom.end)], &[[-10.0, 10.0, 20.0]], 1e-9);
}

/// P26 with RADIUS 12: the corners of the pocket get that radius instead of the tool's (inferred).
#[test]
fn pocket_with_corner_radius() {
    let run = Job::new(manual("P26").replace("RADIUS 0", "RADIUS 12")).run();
    run.assert_completed();
    let expected = (80.0 * 40.0 - (4.0 - PI) * 144.0) * 10.0;
    close(run.removed_mm3(0.1), expected, 0.002 * expected);
    let corners = run
        .of_block(15)
        .into_iter()
        .filter(|e| matches!(e.curve, Curve::Arc(_)));
    let radii: Vec<f64> = corners.map(arc_radius).collect();
    assert_eq!(radii.len(), 3 * 4);
    assert!(radii.iter().all(|radius| (radius - (12.0 - 5.0)).abs() < 1e-9));
}

/// Stepover by MP7430: whatever the overlap factor, a square pocket is cleared completely [003:5270-5278].
#[test]
fn overlap_factor() {
    for overlap in [0.3, 1.0, 1.4] {
        for (x, y) in [("+80", "+40"), ("+40", "+40"), ("+20", "+60")] {
            let text = manual("P26").replace("CYCL DEF 4.4 X+80", &format!("CYCL DEF 4.4 X{x}"));
            let text = text.replace("CYCL DEF 4.5 Y+40", &format!("CYCL DEF 4.5 Y{y}"));
            let run = Job::new(text).with(|s| s.rules.overlap = overlap).run();
            run.assert_completed();
            let sides: [f64; 2] = [x.parse().unwrap(), y.parse().unwrap()];
            let expected = (sides[0] * sides[1] - (4.0 - PI) * 25.0) * 10.0;
            close(run.removed_mm3(0.2), expected, 0.006 * expected);
        }
    }
}

/// M103 F limits the feed into the material to a share of the programmed one [000:7278-7292].
#[test]
fn plunging_feed() {
    let run =
        run("L X+0 Y+0 Z+0 R0 FMAX\nL X+1 F400 M103 F25\nL Z-10\nL X+31 Z-50\nL Z+0\nL X+0 M103\nL Z-10");
    let feeds: Vec<f64> = run
        .moves()
        .skip(1)
        .map(|e| {
            if let FeedRate::Programmed(f) = e.feed {
                f
            } else {
                0.0
            }
        })
        .collect();
    // Straight down: 25 %. Down 40 mm on a way of 50 mm: the part along the axis is 25 %.
    let expected = [400.0, 100.0, 100.0 * 50.0 / 40.0, 400.0, 400.0, 400.0];
    assert!(
        feeds.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
        "{feeds:?}"
    );
}

/// A slot along a parallel axis: 40 long in U, 10 wide, tool R5: the tool centre runs 40 - 2 · 5 = 30 along U
/// and X stays [003:5130-5132].
#[test]
fn slot_along_a_parallel_axis() {
    let run = run(
        "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nL X+1 Y+2 Z+2 U-20 R0 FMAX M3\n\
                   CYCL DEF 3.0 SLOT\nCYCL DEF 3.1 SET UP -2\nCYCL DEF 3.2 DEPTH -4\nCYCL DEF 3.3 PECKG -4 F80\n\
                   CYCL DEF 3.4 U+40\nCYCL DEF 3.5 Y+10\nCYCL DEF 3.6 F100\nCYCL CALL",
    );
    run.assert_completed();
    let far = run
        .moves()
        .map(|e| e.end[Axis::U])
        .fold(f64::NEG_INFINITY, f64::max);
    close(far, 10.0, 1e-9);
    assert!(run.moves().all(|e| e.end[Axis::X] == 1.0));
}

/// The spindle of the machine turns with M4 and S500 before the program begins: the thread of cycle 17 is left-handed
/// and its feed 500 · 1.5.
#[test]
fn tapping_with_the_spindle_that_turns_already() {
    let blocks = "TOOL DEF 1 L+0 R+4\nTOOL CALL 1 Z\nCYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP -3\n\
        CYCL DEF 17.2 DEPTH -20\nCYCL DEF 17.3 PITCH -1.5\nL X+0 Y+0 Z+3 R0 FMAX\nCYCL CALL";
    let run = Job::new(program(blocks))
        .with(|settings| settings.status.take_spindle(Some(Sense::CounterClockwise), 500.0))
        .run();
    run.assert_completed();
    let thread = run.moves().find(|element| element.thread().is_some()).unwrap();
    assert_eq!(thread.feed, FeedRate::Programmed(750.0));
    let stops = run
        .functions()
        .into_iter()
        .any(|(_, function)| *function == Function::M(5));
    assert!(stops, "the spindle is stopped before it is led");
}
