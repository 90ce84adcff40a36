//! Cycle 27 CYLINDER SURFACE. What the tool does to the workpiece is computed here by rotation matrices: where the tip is
//! on a table that has turned.

use crate::support::*;
use bahn_parameters::MessageId::{
    self, BlockNotKnown, CyclIncomplete, EntryValueIncorrect, PlaneWronglyDefined, WrongAxisProgrammed,
    WrongSignProgrammed,
};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{Axis, Curve, FeedRate, PathElement, PerAxis, Position};

const CENTRE: [f64; 3] = [400.0, 150.0, -300.0];
/// The workpiece datum of the tests lies here in the machine.
const DATUM: [f64; 3] = [390.0, 120.0, -280.0];
const RADIUS: f64 = 25.0;
const LENGTH: f64 = 100.0;

const CYCLE: &str = "CYCL DEF 27.0 CYLINDER SURFACE Q1=-7 Q3=+0 Q6=+2 Q10=+4 Q11=100 Q12=250 Q16=25";

fn job(machine: &[&str], tool_axis: char, before: &str, cycle: &str, contour: &str) -> Job {
    in_unit("MM", machine, tool_axis, before, cycle, contour)
}

fn in_unit(unit: &str, machine: &[&str], tool_axis: char, before: &str, cycle: &str, contour: &str) -> Job {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for assignment in machine {
        list.assign(assignment).expect(assignment);
    }
    let text = program(&format!(
        "TOOL DEF 1 L+100 R+3.5\nTOOL CALL 1 {tool_axis} S2000\nL {tool_axis}+250 R0 FMAX\n{before}\n\
         CYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1\n{cycle}\nCYCL CALL M3\nL {tool_axis}+250 FMAX M2\n\
         LBL 1\n{contour}\nLBL 0"
    ));
    Job::new(text.replace(" MM", &format!(" {unit}"))).with(|settings| {
        settings.rules = bahn_interpreter::Rules::of(&list);
        let zero = PerAxis::from_fn(|axis| DATUM.get(axis.index()).map_or(0.0, |datum| -datum)).into();
        settings.rules.machine_zero = zero;
        settings.start = Position::ZERO;
    })
}

fn rotation(about: usize, deg: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = deg.to_radians().sin_cos();
    let (i, j) = ((about + 1) % 3, (about + 2) % 3);
    let mut m = [[0.0; 3]; 3];
    m[about][about] = 1.0;
    (m[i][i], m[i][j], m[j][i], m[j][j]) = (cos, -sin, sin, cos);
    m
}

/// A place turned about another.
fn turned(place: [f64; 3], centre: [f64; 3], m: [[f64; 3]; 3]) -> [f64; 3] {
    let from = [0, 1, 2].map(|i| place[i] - centre[i]);
    [0, 1, 2].map(|i| centre[i] + (0..3).map(|j| m[i][j] * from[j]).sum::<f64>())
}

/// Where the tip is on the workpiece, seen from the centre of the table with both axes at 0: the tables have turned the
/// other way than their axes say.
fn on_workpiece(element: &PathElement, t: f64, tool: Axis) -> [f64; 3] {
    let path = element.curve.position(&element.start, &element.end, t);
    let (mut at, angles) = match &element.placement {
        Some(placement) => {
            let mut nose = placement.to_nose(&path);
            nose[tool] -= LENGTH;
            (nose, nose)
        }
        None => (path, path),
    };
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        at[axis] += DATUM[axis.index()];
    }
    let machine = [at[Axis::X], at[Axis::Y], at[Axis::Z]];
    let on_b = turned(machine, [400.0, 0.0, -500.0], rotation(1, angles[Axis::B]));
    let place = turned(on_b, CENTRE, rotation(2, angles[Axis::C]));
    [0, 1, 2].map(|i| place[i] - CENTRE[i])
}

/// Angle about the table's axis from the side where the tool comes from at C 0, degrees, height along the axis and
/// distance from it.
fn rolled([x, y, z]: [f64; 3], from_deg: f64) -> [f64; 3] {
    let angle = (y.atan2(x).to_degrees() - from_deg + 540.0).rem_euclid(360.0) - 180.0;
    [angle, z, x.hypot(y)]
}

/// What is cut: elements at the feed of the surface.
fn cuts(run: &Run) -> Vec<PathElement> {
    let cut = |e: &&PathElement| e.feed == FeedRate::Programmed(250.0);
    run.moves().filter(cut).cloned().collect()
}

/// Without compensation and in degrees: a line of 90 degrees, and one along the axis, at both depths.
#[test]
fn a_contour_in_degrees() {
    let contour = "L C+10 Z+30 R0\nL C+100\nL Z+50";
    let run = job(
        ROTARY_TABLE,
        'Y',
        "L X+10 R0 FMAX",
        &format!("{CYCLE} Q17=0"),
        contour,
    )
    .run();
    run.assert_completed();
    let cuts = cuts(&run);
    assert_eq!(cuts.len(), 4);
    // The datum is 20 above the centre of the table.
    let corners = [[10.0, 50.0], [100.0, 50.0], [100.0, 70.0]];
    for (n, cut) in cuts.iter().enumerate() {
        let depth = if n < 2 { 4.0 } else { 7.0 };
        for (t, corner) in [(0.0, corners[n % 2]), (1.0, corners[n % 2 + 1])] {
            let place = rolled(on_workpiece(cut, t, Axis::Y), 90.0);
            close_points(&[place], &[[corner[0], corner[1], RADIUS - depth]], 1e-9);
        }
        // In between, too, and at the feed of the surface: a quarter of its circumference is as long.
        let half = rolled(on_workpiece(cut, 0.5, Axis::Y), 90.0);
        assert!((half[2] - (RADIUS - depth)).abs() < 1e-9, "{half:?}");
    }
    let quarter = 0.5 * std::f64::consts::PI * RADIUS;
    assert!((cuts[0].length() - quarter).abs() < 1e-9);
    // The tool stands over the centre, whose X is 10 from the datum, and ends at the setup clearance with C where it was.
    let last = run.moves().last().expect("a movement");
    assert_eq!((last.start[Axis::X], last.start[Axis::C]), (10.0, 100.0));
    // The centre is at Y 30, its surface at Y 55.
    assert!(
        (last.start[Axis::Y] - 57.0).abs() < 1e-9,
        "{}",
        last.start[Axis::Y]
    );
    assert!(last.placement.is_none());
}

/// Wherever the tool stands, below the clearance or beside the centre, it goes up first and then over the start.
#[test]
fn the_way_to_the_surface() {
    let way = |before: &str| {
        let contour = "L C+10 Z+30 R0\nL C+100";
        let run = job(ROTARY_TABLE, 'Y', before, &format!("{CYCLE} Q17=0"), contour).run();
        run.assert_completed();
        let rapid = |e: &&PathElement| e.placement.is_none() && e.feed == FeedRate::Rapid;
        let moves: Vec<_> = run
            .moves()
            .skip_while(|e| e.block.block < 8)
            .filter(rapid)
            .collect();
        moves
            .iter()
            .flat_map(|e| [Axis::X, Axis::Y, Axis::Z, Axis::C].map(|axis| e.end[axis]))
            .map(|value| (value * 1e9).round() / 1e9)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        way("L X+100 Y+20 R0 FMAX"),
        [
            [100.0, 57.0, 0.0, 0.0],
            [10.0, 57.0, 30.0, 10.0],
            [10.0, 250.0, 30.0, 100.0]
        ]
        .concat()
    );
    assert_eq!(
        way("L X+100 R0 FMAX"),
        [[10.0, 250.0, 30.0, 10.0], [10.0, 250.0, 30.0, 100.0]].concat()
    );
}

/// The tool of R3.5 is beside the contour everywhere, with the allowance Q3, in the unrolled surface; on the left as the
/// tool looks down on it. C is shifted by 30 degrees, the dimensions are mm.
#[test]
fn compensation_in_the_unrolled_surface() {
    let contour =
        "L C+40 Z+20 RL\nL C+50\nRND R7.5\nL Z+60\nRND R7.5\nL IC-20\nRND R7.5\nL Z+20\nRND R7.5\nL C+40";
    let cycle = CYCLE.replace("Q3=+0", "Q3=+0.5");
    let shift = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 C+30";
    let run = job(ROTARY_TABLE, 'Y', shift, &format!("{cycle} Q17=1"), contour).run();
    run.assert_completed();
    let cuts = cuts(&run);
    let arcs = cuts.iter().filter(|e| matches!(e.curve, Curve::Arc(_))).count();
    assert_eq!(arcs, 8, "four at each depth");
    // The rectangle C 30..50, Z 20..60 with corners of R7.5, counter-clockwise: the tool runs inside. Its path is a
    // rectangle with corners of 3.5 less 4 mm of it.
    let inside = |[u, v]: [f64; 2]| {
        let from_middle = [(u - 40.0).abs() - (10.0 - 7.5), (v - 40.0).abs() - (20.0 - 7.5)];
        match from_middle {
            [a, b] if a > 0.0 && b > 0.0 => 7.5 - a.hypot(b),
            [a, b] => 7.5 - a.max(b),
        }
    };
    for cut in &cuts {
        for t in [0.0, 0.21, 0.5, 0.83, 1.0] {
            let [angle, z, r] = rolled(on_workpiece(cut, t, Axis::Y), 90.0);
            let at = [(angle - 30.0).to_radians() * RADIUS, z - 20.0];
            assert!((inside(at) - 4.0).abs() < 1e-6, "{at:?}");
            assert!(r < RADIUS, "{r}");
        }
    }
}

/// With B at 90 the table's axis lies along X, and the tool axis is Z.
#[test]
fn a_table_that_lies() {
    for b in [90.0, -90.0] {
        let before = format!("L B{b:+} FMAX");
        let run = job(
            ROTARY_TABLE,
            'Z',
            &before,
            &format!("{CYCLE} Q17=0"),
            "L C+0 X+30 R0\nL C+90\nL X+50",
        )
        .run();
        run.assert_completed();
        let cuts = cuts(&run);
        assert_eq!(cuts.len(), 4);
        let place = |n: usize, t: f64| on_workpiece(&cuts[n], t, Axis::Z);
        let [x, y, _] = place(0, 0.0);
        let from = y.atan2(x).to_degrees();
        let [start, corner, end] = [place(0, 0.0), place(0, 1.0), place(1, 1.0)].map(|at| rolled(at, from));
        // A positive turn of C leads the tool about the workpiece in positive direction.
        assert!(
            (start[0]).abs() < 1e-9 && (corner[0] - 90.0).abs() < 1e-9,
            "{start:?} {corner:?}"
        );
        // X of the machine is along the axis, by the sense of B.
        assert!((corner[1] - start[1]).abs() < 1e-9);
        assert!(
            ((end[1] - corner[1]).abs() - 20.0).abs() < 1e-9,
            "{corner:?} {end:?}"
        );
        for at in [start, corner, end] {
            assert!((at[2] - (RADIUS - 4.0)).abs() < 1e-9, "{at:?}");
        }
    }
}

/// Dimensions in inches, and a full turn: the rotary axis goes on through it.
#[test]
fn inches_and_whole_turns() {
    // Programmed in steps of 0.0001 inch, which are 0.006 degrees here.
    let circumference = 2.0 * std::f64::consts::PI * RADIUS / 25.4;
    let contour = format!("L C+0 Z+0 R0\nL C+{circumference:.4}");
    let cycle = "CYCL DEF 27.0 CYLINDER SURFACE Q1=-0.1 Q3=+0 Q6=+0.1 Q10=+0.1 Q11=100 Q12=250 Q16=Q50 Q17=1";
    let run = in_unit(
        "INCH",
        ROTARY_TABLE,
        'Y',
        "FN 4: Q50 = +25 DIV +25.4",
        cycle,
        &contour,
    )
    .run();
    run.assert_completed();
    let last = run.moves().last().expect("a movement");
    assert!(
        (last.start[Axis::C] - 360.0).abs() < 0.003,
        "{}",
        last.start[Axis::C]
    );
}

#[test]
fn wrong_surfaces() {
    let message = |machine: &[&str], axis: char, before: &str, cycle: &str, contour: &str| {
        job(machine, axis, before, cycle, contour)
            .run()
            .message()
            .map(|(id, _)| id)
    };
    let good = "L C+0 Z+0 R0\nL C+90";
    let with = |from: &str, to: &str| {
        let cycle = format!("{CYCLE} Q17=0").replace(from, to);
        message(ROTARY_TABLE, 'Y', "", &cycle, good)
    };
    assert_eq!(with("", ""), None);
    let cases: &[(&str, &str, MessageId)] = &[
        ("Q1=-7", "Q1=+0", CyclIncomplete),
        ("Q1=-7", "Q1=+7", WrongSignProgrammed),
        ("Q1=-7", "Q1=-25", EntryValueIncorrect),
        ("Q10=+4", "Q10=+0", CyclIncomplete),
        ("Q16=25", "", CyclIncomplete),
        ("Q16=25", "Q16=0", EntryValueIncorrect),
        ("Q17=0", "Q17=2", EntryValueIncorrect),
        ("Q3=+0", "Q3=-4", EntryValueIncorrect),
    ];
    for (from, to, id) in cases {
        assert_eq!(with(from, to), Some(*id), "{from} -> {to}");
    }
    let cycle = format!("{CYCLE} Q17=0");
    for (axis, before, contour, id) in [
        // The tool axis lies along the rotary axis.
        ('Z', "", "L C+0 X+0 R0\nL C+90", PlaneWronglyDefined),
        ('Y', "", "L Z+0 R0\nL Z+90", WrongAxisProgrammed),
        ('Y', "", "L C+0 X+0 R0\nL C+90", WrongAxisProgrammed),
        ('Y', "", "L A+0 Z+0 R0\nL A+90", WrongAxisProgrammed),
        // The table leans.
        ('Y', "L B+30 FMAX", good, PlaneWronglyDefined),
        (
            'Y',
            "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30",
            good,
            PlaneWronglyDefined,
        ),
        (
            'Y',
            "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+0",
            good,
            PlaneWronglyDefined,
        ),
    ] {
        assert_eq!(
            message(ROTARY_TABLE, axis, before, &cycle, contour),
            Some(id),
            "{axis} {before} {contour}"
        );
    }
    // Without a description of the machine nobody knows the centre.
    assert_eq!(message(&[], 'Y', "", &cycle, good), Some(BlockNotKnown));
}
