//! SL cycles with contour data (20 to 25): a square-cornered pocket with an island, and a contour train. Expected
//! areas are those of the contours less what a round tool leaves in inside corners; expected points are computed by
//! hand.

use std::f64::consts::PI;

use crate::support::*;
use bahn_parameters::MessageId::{
    self, CyclIncomplete, EntryValueIncorrect, RoundingRadiusTooLarge, ToolRadiusTooLarge,
};
use bahn_path::{Axis, Curve, FeedRate, PathElement};
use bahn_workpiece::EventKind;

/// A pocket X 0..80, Y 0..60 from (0,30), and an island X 30..50, Y 25..35 from (30,30).
const CONTOURS: &str = "LBL 1\nL X+0 Y+30 RL\nL Y+0\nL X+80\nL Y+60\nL X+0\nL Y+30\nLBL 0\n\
                        LBL 2\nL X+30 Y+30 RR\nL Y+25\nL X+50\nL Y+35\nL X+30\nL Y+30\nLBL 0";

/// What four inside corners of 90 degrees keep of a radius.
fn corners(radius: f64) -> f64 {
    (4.0 - PI) * radius * radius
}

struct Data {
    side: f64,
    floor: f64,
    corner: f64,
    climb: f64,
}

const PLAIN: Data = Data {
    side: 0.0,
    floor: 0.0,
    corner: 0.0,
    climb: 1.0,
};

/// A program that machines the contours to Z-10 with a tool of R5 and cycles of this text.
fn program_of(data: &Data, cycles: &str) -> String {
    let Data {
        side,
        floor,
        corner,
        climb,
    } = data;
    program(&format!(
        "BLK FORM 0.1 Z X-10 Y-10 Z-20\nBLK FORM 0.2 X+90 Y+70 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL DEF 2 L+0 R+3\n\
         TOOL DEF 3 L+0 R+10\nTOOL CALL 1 Z S1000\nCYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1/2\n\
         CYCL DEF 20.0 CONTOUR DATA\nCYCL DEF 20.1 Q1=-10 Q2=+1 Q3={side:+}\nCYCL DEF 20.2 Q4={floor:+} Q5=+0 Q6=+2\n\
         CYCL DEF 20.3 Q7=+20 Q8={corner:+} Q9={climb:+}\nL X-5 Y-5 Z+50 R0 FMAX M3\n{cycles}\nL Z+50 FMAX M2\n{CONTOURS}"
    ))
}

const ROUGH: &str = "CYCL DEF 22.0 ROUGH-OUT\nCYCL DEF 22.1 Q10=-5 Q11=+100 Q12=+350\nCYCL CALL";
const FLOOR: &str = "CYCL DEF 23.0 FLOOR FINISHING\nCYCL DEF 23.1 Q11=+100 Q12=+350\nCYCL CALL";
const SIDES: &str =
    "CYCL DEF 24.0 SIDE FINISHING\nCYCL DEF 24.1 Q9=+1 Q10=-5 Q11=+100 Q12=+300 Q14=+0\nCYCL CALL";

fn run_of(data: &Data, cycles: &str) -> Run {
    let run = Job::new(program_of(data, cycles)).run();
    run.assert_completed();
    run
}

#[track_caller]
fn removes(data: &Data, cycles: &str, expected_mm3: f64) {
    let run = run_of(data, cycles);
    close(run.removed_mm3(0.1), expected_mm3, 0.002 * expected_mm3);
    let events = run.events(0.5).into_iter();
    assert_eq!(
        events.filter(|event| event.kind == EventKind::RapidCut).count(),
        0
    );
}

/// Rough-out leaves the allowances; floor and sides take them away. Q8 rounds the inside corners of the tool's path,
/// so that the workpiece gets R + Q8.
#[test]
fn a_square_pocket_with_an_island() {
    let whole = 80.0 * 60.0 - 20.0 * 10.0 - corners(5.0);
    removes(&PLAIN, ROUGH, 10.0 * whole);
    let allowances = Data {
        side: 0.5,
        floor: 0.5,
        ..PLAIN
    };
    // The island has round corners of 0.5 mm then.
    let rough = 79.0 * 59.0 - (21.0 * 11.0 - corners(0.5)) - corners(5.0);
    removes(&allowances, ROUGH, 9.5 * rough);
    let finished = [ROUGH, FLOOR, SIDES].join("\n");
    removes(&allowances, &finished, 10.0 * whole);
    // The floor alone, without a plunging depth.
    removes(&PLAIN, FLOOR, 10.0 * whole);
    let rounded = Data { corner: 4.0, ..PLAIN };
    removes(&rounded, ROUGH, 10.0 * (80.0 * 60.0 - 20.0 * 10.0 - corners(9.0)));
    // Cutting feeds and depths: two infeeds of 5 mm, from the clearance height by way of the set-up clearance.
    let run = run_of(&PLAIN, ROUGH);
    let moves = run.of_block(16);
    let heights: Vec<f64> = moves.iter().take(5).map(|e| e.end[Axis::Z]).collect();
    assert_eq!(heights, [20.0, 20.0, 2.0, -5.0, -5.0]);
    assert_eq!(moves[3].feed, FeedRate::Programmed(100.0));
    assert_eq!(moves[4].feed, FeedRate::Programmed(350.0));
    // Back to where the tool stood before the call (MP7420 bit 4 = 0).
    assert_eq!(xyz(&moves.last().unwrap().end), [-5.0, -5.0, 20.0]);
}

fn points(moves: &[&PathElement]) -> Vec<[f64; 3]> {
    moves.iter().map(|e| xyz(&e.end)).collect()
}

/// Side finishing with Q14 0.5: the tool's centre runs 5.5 mm beside the pocket, from the middle of its first longest
/// side, which it reaches and leaves on quarter circles of R5; counter-clockwise with Q9 = +1, clockwise with -1.
#[test]
fn sides_are_reached_and_left_on_arcs() {
    for climb in [1.0, -1.0] {
        let cycle = format!(
            "CYCL DEF 24.0 SIDE FINISHING\nCYCL DEF 24.1 Q9={climb:+} Q10=-6 Q11=+100 Q12=+300 Q14=+0.5\nCYCL CALL"
        );
        let run = run_of(&PLAIN, &cycle);
        let moves = run.of_block(16);
        let around = [
            [74.5, 5.5],
            [74.5, 54.5],
            [5.5, 54.5],
            [5.5, 30.0],
            [5.5, 5.5],
            [40.0, 5.5],
        ];
        let mut expected = vec![[-5.0, -5.0, 20.0]];
        let (from, to) = if climb > 0.0 { (35.0, 45.0) } else { (45.0, 35.0) };
        expected.extend([[from, 10.5, 20.0], [from, 10.5, 2.0]]);
        for z in [-6.0, -10.0] {
            if z == -10.0 {
                expected.push([from, 10.5, -6.0]);
            }
            expected.extend([[from, 10.5, z], [40.0, 5.5, z]]);
            let mut way = around.to_vec();
            if climb < 0.0 {
                way.pop();
                way.reverse();
                way.push([40.0, 5.5]);
            }
            expected.extend(way.iter().map(|[x, y]| [*x, *y, z]));
            expected.push([to, 10.5, z]);
        }
        expected.push([to, 10.5, 20.0]);
        close_points(&points(&moves)[..expected.len()], &expected, 1e-9);
        let (centre, sweep) = arc_of(moves[4]);
        close_points(
            &[centre, [sweep, 0.0]],
            &[[40.0, 10.5], [climb * 90.0, 0.0]],
            1e-9,
        );
        // Around the island the other way, 5.5 mm beside it, and no nearer to it on the arcs.
        for element in &moves[expected.len()..] {
            for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let p = element.curve.position(&element.start, &element.end, t);
                let beside = [(p[Axis::X] - 40.0).abs() - 10.0, (p[Axis::Y] - 30.0).abs() - 5.0];
                let gap = beside[0].max(0.0).hypot(beside[1].max(0.0));
                assert!(gap >= 5.5 - 1e-9 || p[Axis::Z] >= 2.0, "{p:?}");
            }
        }
        let sweeps = moves[expected.len()..].iter().filter_map(|e| match e.curve {
            Curve::Arc(arc) if (arc_radius(e) - 5.5).abs() < 1e-9 => Some(arc.sweep_deg),
            _ => None,
        });
        let sweeps: Vec<f64> = sweeps.collect();
        // Four corners at each depth.
        assert_eq!(sweeps.len(), 8);
        assert!(
            sweeps.iter().all(|sweep| (sweep + climb * 90.0).abs() < 1e-9),
            "{sweeps:?}"
        );
    }
}

/// Pilot drilling at the infeed points of the rough-out tool 1 (R5) with an allowance of 0.5: beside the starts of the
/// contours; down to the allowance of the floor, in pecks as cycle 1.
#[test]
fn pilot_drilling_where_the_rough_out_tool_goes_down() {
    let data = Data {
        side: 0.5,
        floor: 0.5,
        ..PLAIN
    };
    let cycles =
        "TOOL CALL 2 Z S500\nCYCL DEF 21.0 PILOT DRILLING\nCYCL DEF 21.1 Q10=-5 Q11=+100 Q13=+1\nCYCL CALL";
    let run = run_of(&data, cycles);
    let mut expected = vec![[-5.0, -5.0, 20.0]];
    for x in [5.5, 24.5] {
        expected.push([x, 30.0, 20.0]);
        expected.extend([2.0, -5.0, 2.0, -4.4, -9.5, 2.0, 20.0].map(|z| [x, 30.0, z]));
    }
    expected.push([-5.0, -5.0, 20.0]);
    close_points(&points(&run.of_block(17)), &expected, 1e-9);
}

/// After a coarse tool of R10 (Q18) the tool of R3 cuts in the corners only, and leaves what it cannot reach there.
#[test]
fn fine_roughing_after_a_coarse_tool() {
    let coarse =
        "TOOL CALL 3 Z S500\nCYCL DEF 22.0 ROUGH-OUT\nCYCL DEF 22.1 Q10=-10 Q11=+100 Q12=+350\nCYCL CALL";
    let fine = "TOOL CALL 2 Z S500\nCYCL DEF 22.0 ROUGH-OUT\nCYCL DEF 22.1 Q10=-10 Q11=+100 Q12=+350 Q18=+3\nCYCL CALL";
    let both = format!("{coarse}\n{fine}");
    removes(&PLAIN, &both, 10.0 * (80.0 * 60.0 - 20.0 * 10.0 - corners(3.0)));
    let run = run_of(&PLAIN, &both);
    let cuts: Vec<_> = run
        .of_block(21)
        .into_iter()
        .filter(|e| e.end[Axis::Z] < 0.0)
        .collect();
    assert!(cuts.len() > 8);
    for e in cuts {
        let [x, y] = [e.end[Axis::X], e.end[Axis::Y]];
        let to_corner = x.min(80.0 - x).hypot(y.min(60.0 - y));
        // What a circle of R10 leaves lies within 10 mm of a corner in each axis, and the tool's centre 3 mm from it.
        assert!(to_corner <= 13.0 * 2f64.sqrt(), "{x} {y}");
    }
}

/// The tool reaches the floor straight down; a feed for going to and fro (Q19) is not passed over in silence.
#[test]
fn reciprocation_is_said() {
    let said = |q19: &str| {
        let run = run_of(&PLAIN, &ROUGH.replace("Q12=+350", &format!("Q12=+350 {q19}")));
        run.assert_completed();
        run.warnings
            .iter()
            .map(|warning| warning.kind.to_string())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        said("Q19=+150"),
        ["cycle 22: Q19, the tool reaches the floor straight down"]
    );
    assert_eq!(said("Q19=+0"), [""; 0]);
}

/// The parameters are Q parameters: what the program sets after the definition counts at the call.
#[test]
fn parameters_are_q_parameters() {
    let run = run_of(
        &PLAIN,
        &ROUGH.replace("CYCL CALL", "FN 0: Q10 = -2.5\nFN 0: Q1 = -5\nCYCL CALL"),
    );
    let mut depths: Vec<f64> = run
        .of_block(18)
        .iter()
        .map(|e| e.end[Axis::Z])
        .filter(|z| *z < 0.0)
        .collect();
    depths.sort_by(f64::total_cmp);
    depths.dedup();
    assert_eq!(depths, [-5.0, -2.5]);
    assert_eq!([run.q[2], run.q[7], run.q[12]], [1.0, 20.0, 350.0]);
}

/// Missing and impossible parameters.
#[test]
fn wrong_contour_data() {
    let message = |from: &str, to: &str| {
        let cycles = [ROUGH, SIDES].join("\n");
        let text = program_of(&PLAIN, &cycles).replace(from, to);
        Job::new(text).run().message()
    };
    let cases: &[(&str, &str, MessageId, u32)] = &[
        ("Q1=-10", "Q1=+0", CyclIncomplete, 16),
        ("Q10=-5", "Q10=+0", CyclIncomplete, 16),
        ("Q10=-5 Q11=+100 Q12=+350", "Q10=-5 Q12=+350", CyclIncomplete, 16),
        ("Q14=+0", "", CyclIncomplete, 19),
        ("Q2=+1 ", "", CyclIncomplete, 16),
        ("Q2=+1 ", "Q2=+2 ", EntryValueIncorrect, 16),
        ("Q7=+20", "Q7=+1", EntryValueIncorrect, 16),
        ("Q4=+0", "Q4=+10", EntryValueIncorrect, 16),
        ("Q8=+0", "Q8=+30", RoundingRadiusTooLarge, 16),
        ("Q3=+0", "Q3=+30", ToolRadiusTooLarge, 16),
        ("CYCL DEF 20.2", "CYCL DEF 20.3", CyclIncomplete, 16),
    ];
    for (from, to, id, block) in cases {
        assert_eq!(message(from, to), Some((*id, *block)), "{from} -> {to}");
    }
    let none = "CYCL DEF 22.0 ROUGH-OUT\nCYCL DEF 22.1 Q10=-5 Q11=+100 Q12=+350\nCYCL CALL";
    assert_eq!(Job::new(program(none)).run().message(), Some((CyclIncomplete, 3)));
}

/// A train X 0..50, then Y 0..30, with the tool of R5 on its left: (0,5), (45,5), (45,30).
fn train(side: &str, climb: f64) -> Vec<[f64; 3]> {
    let run = Job::new(program(&format!(
        "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nCYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1\n\
         CYCL DEF 25.0 CONTOUR TRAIN\nCYCL DEF 25.1 Q1=-6 Q3=+0 Q5=+0 Q7=+15\n\
         CYCL DEF 25.2 Q10=-3 Q11=+100 Q12=+200 Q15={climb:+}\nL X-20 Y-20 Z+50 R0 FMAX M3\nCYCL CALL\nL Z+50 FMAX M2\n\
         LBL 1\nL X+0 Y+0 {side}\nL X+50\nL Y+30\nLBL 0"
    )))
    .run();
    run.assert_completed();
    points(&run.of_block(9))
}

#[test]
fn a_contour_train() {
    let pass = |way: &[[f64; 2]; 3], z: f64| {
        let [start, ..] = *way;
        let mut points = vec![[start[0], start[1], 15.0], [start[0], start[1], z]];
        points.extend(way[1..].iter().map(|[x, y]| [*x, *y, z]));
        points.push([way[2][0], way[2][1], 15.0]);
        points
    };
    let above = vec![[-20.0, -20.0, 15.0]];
    let left = [[0.0, 5.0], [45.0, 5.0], [45.0, 30.0]];
    let mut back = left;
    back.reverse();
    // Climb milling with M3 is to the left of the way; up-cut is the same way back.
    close_points(
        &train("RL", 1.0),
        &[above.clone(), pass(&left, -3.0), pass(&left, -6.0)].concat(),
        1e-9,
    );
    close_points(
        &train("RL", -1.0),
        &[above.clone(), pass(&back, -3.0), pass(&back, -6.0)].concat(),
        1e-9,
    );
    // To and fro: no way through the air between the depths.
    let mut to_and_fro = pass(&left, -3.0);
    to_and_fro.pop();
    to_and_fro.extend(pass(&back, -6.0).into_iter().skip(1));
    close_points(&train("RL", 0.0), &[above.clone(), to_and_fro].concat(), 1e-9);
    // On the contour itself.
    let on = [[0.0, 0.0], [50.0, 0.0], [50.0, 30.0]];
    close_points(
        &train("R0", 1.0),
        &[above, pass(&on, -3.0), pass(&on, -6.0)].concat(),
        1e-9,
    );
    // To the right of it the tool rolls round the corner, and climbs on the way back.
    let right = train("RR", 1.0);
    close_points(
        &right[1..4],
        &[[55.0, 30.0, 15.0], [55.0, 30.0, -3.0], [55.0, 0.0, -3.0]],
        1e-9,
    );
    close_points(&right[4..6], &[[50.0, -5.0, -3.0], [0.0, -5.0, -3.0]], 1e-9);
}
