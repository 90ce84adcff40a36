//! Swivel axes: cycle 19, M114 to M117, M126 and M127.

use std::sync::Arc;

use crate::support::*;
use bahn_parameters::MessageId::{
    BlockNotKnown, EntryValueIncorrect, PlaneWronglyDefined, WrongAxisProgrammed,
};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{Axis, FeedRate, Placement, Position};

const TOOL: &str = "TOOL DEF 1 L+100 R+5\nTOOL CALL 1 Z S1000\n";

fn on(machine: &[&str], blocks: &str) -> Run {
    on_datum(machine, Position::ZERO, blocks)
}

/// On a machine whose workpiece datum lies at a place of it.
fn on_datum(machine: &[&str], datum: Position, blocks: &str) -> Run {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for assignment in machine {
        list.assign(assignment).expect(assignment);
    }
    let text = program(&format!("{TOOL}{blocks}"));
    Job::new(text)
        .with(|settings| {
            settings.rules = bahn_interpreter::Rules::of(&list);
            settings.rules.machine_zero = datum.values().map(|x| -x).into();
            settings.start = Position::ZERO;
        })
        .run()
}

/// Cycle 19, the swivel axes first where it says [000:4250-4252].
fn tilted(angles: &str) -> String {
    format!("L {angles} R0 FMAX\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 {angles}\n")
}

/// "The swivel axes must first be positioned manually or with an appropriate NC block" [000:4250-4252]: what moves in the
/// plane while they stand elsewhere, or moves them beside, is refused. Alone they may go to where they are to be.
#[test]
fn swivel_axes_stand_where_cycle_19_says() {
    let plane = "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+30\n";
    let message = |blocks: &str| on(SWIVEL_HEAD, &format!("{plane}{blocks}")).message();
    // Blocks 1 and 2 are those of the tool, 3 and 4 the cycle.
    assert_eq!(message("L X+1 R0 FMAX"), Some((PlaneWronglyDefined, 5)));
    assert_eq!(message("L B+30 R0 FMAX\nL X+1 FMAX"), None);
    // A whole turn is the same place for the head.
    assert_eq!(message("L B-330 R0 FMAX\nL X+1 FMAX"), None);
    // Moved while the plane is in force: with the linear axes, or before them; A is to stand at 0.
    assert_eq!(message("L X+1 B+30 R0 FMAX"), Some((PlaneWronglyDefined, 5)));
    let after = |blocks: &str| message(&format!("L B+30 R0 FMAX\nL X+1 FMAX\n{blocks}"));
    assert_eq!(after("L X+2 B+40 FMAX"), Some((PlaneWronglyDefined, 7)));
    assert_eq!(after("L B+40 FMAX\nL X+2 FMAX"), Some((PlaneWronglyDefined, 8)));
    assert_eq!(after("L A+5 FMAX\nL X+2 FMAX"), Some((PlaneWronglyDefined, 8)));
    let peck = "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -10\nCYCL DEF 1.3 PECKG -4\n\
                CYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100\n";
    assert_eq!(
        after(&format!("{peck}L B+40 FMAX\nCYCL CALL M3")),
        Some((PlaneWronglyDefined, 14))
    );
    assert_eq!(
        after(&format!("{peck}L B+40 FMAX M99")),
        Some((PlaneWronglyDefined, 13))
    );
    let probe = "TCH PROBE 0.0 REF. PLANE Q1 X-\nTCH PROBE 0.1 X+0 Y+0 Z+0";
    assert_eq!(
        after(&format!("L B+40 FMAX\n{probe}")),
        Some((PlaneWronglyDefined, 9))
    );
    // The cycle takes positions of the machine: with the datum of B at 10, B+20 is its 30.
    let mut datum = Position::ZERO;
    datum[Axis::B] = 10.0;
    let on_datum =
        |b: &str| on_datum(SWIVEL_HEAD, datum, &format!("{plane}L B{b} R0 FMAX\nL X+1 FMAX")).message();
    assert_eq!(on_datum("+20"), None);
    // In a test run it may lie at the datum of the machine as well, since nobody may have said where.
    assert_eq!(on_datum("+30"), None);
    assert_eq!(on_datum("+40"), Some((PlaneWronglyDefined, 6)));
    // After the plane they go where they are told.
    assert_eq!(
        after("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\nL X+2 B+40 FMAX"),
        None
    );
}

/// A machine knows where its axes stand: with the datum of B at 10 only B+20 is its 30, and nothing is taken for the datum of the
/// machine as in a test run.
#[test]
fn on_a_machine_swivel_axes_stand_in_it() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for assignment in SWIVEL_HEAD {
        list.assign(assignment).expect(assignment);
    }
    let message = |b: &str| {
        let text = program(&format!(
            "{TOOL}CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+30\nL B{b} R0 FMAX\nL X+1 FMAX"
        ));
        let job = Job::new(text).with(|settings| {
            settings.rules = bahn_interpreter::Rules::of(&list);
            settings.rules.machine_zero = Position::ZERO;
            settings.rules.machine_zero[Axis::B] = -10.0;
            settings.start = Position::ZERO;
            settings.machine = true;
        });
        job.run().message()
    };
    assert_eq!(message("+20"), None);
    for b in ["+30", "+10", "+40"] {
        assert_eq!(message(b), Some((PlaneWronglyDefined, 6)), "B{b}");
    }
}

fn at(x: f64, y: f64, z: f64) -> Position {
    let mut position = Position::ZERO;
    (position[Axis::X], position[Axis::Y], position[Axis::Z]) = (x, y, z);
    position
}

fn xyz(position: &Position) -> [f64; 3] {
    [position[Axis::X], position[Axis::Y], position[Axis::Z]]
}

/// Where the tool datum is at the end of the `n`th movement, and at the start of it.
fn noses(run: &Run, n: usize) -> [[f64; 3]; 2] {
    let element = run.moves().nth(n).expect("a movement");
    let upright = |position: &Position| {
        let [x, y, z] = xyz(position);
        [x, y, z + 100.0]
    };
    [&element.end, &element.start].map(|position| match &element.placement {
        Some(placement) => xyz(&placement.to_nose(position)),
        None => upright(position),
    })
}

#[track_caller]
fn assert_near(a: [f64; 3], b: [f64; 3]) {
    assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-9), "{a:?} is not {b:?}");
}

/// B+90 lays the tool along -X as it leads from its tip to the datum: +X. In the tilted plane X is then -Z of the machine
/// and Z its X, and the centre of B, 201.5 beside and 203.5 above the tool datum at B+0, stays above the datum as if the
/// tool datum had swung around it: from (-201.5, -203.5) to (-203.5, +201.5) in X and Z.
#[test]
fn cycle_19_tilts_the_working_plane() {
    let run = on(
        SWIVEL_HEAD,
        "L Z+50 R0 FMAX\nL B+90 FMAX\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+90\nL X+10 Y+20 Z+5 R0 FMAX",
    );
    run.assert_completed();
    let swung = [201.5 - 203.5, 0.0, 203.5 + 201.5];
    let tip = [5.0, 20.0, -10.0];
    let [end, start] = noses(&run, 2);
    // The tool datum is 100 from the tip in +X. The axes move by what the tool datum has swung, the other way.
    assert_near(
        end,
        [tip[0] + 100.0 - swung[0], tip[1] + swung[1], tip[2] - swung[2]],
    );
    // The definition has moved nothing.
    assert_near(start, noses(&run, 1)[0]);
    assert_near(start, [0.0, 0.0, 150.0]);
}

/// The datum shift before cycle 19 is the datum of the plane, one after it is in the plane; and they end in the reverse
/// order [000:4254].
#[test]
fn shifts_before_and_after_cycle_19() {
    let shift = |x: &str| format!("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X{x}\n");
    let tilt = |angles: &str| match angles {
        "" => "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\n".to_owned(),
        _ => tilted(angles),
    };
    let to = "L X+1 Y+2 Z+3 R0 FMAX\n";
    let plain = on(SWIVEL_HEAD, &format!("{}{to}", tilt("A-45 B+30")));
    let shifted = on(SWIVEL_HEAD, &format!("{}{}{to}", shift("+40"), tilt("A-45 B+30")));
    shifted.assert_completed();
    let [x, y, z] = noses(&plain, 1)[0];
    assert_near(noses(&shifted, 1)[0], [x + 40.0, y, z]);
    // In the plane the shift leads along its X, which B+30 has turned in the machine's X and Z.
    let inner = on(SWIVEL_HEAD, &format!("{}{}{to}", tilt("A-45 B+30"), shift("+40")));
    let (sin, cos) = 30f64.to_radians().sin_cos();
    assert_near(noses(&inner, 1)[0], [x + 40.0 * cos, y, z - 40.0 * sin]);
    // Ended in the reverse order all is as before.
    let ended = format!(
        "{}{}{}{}{to}{}{}{to}",
        shift("+40"),
        tilt("B+30"),
        shift("+5"),
        shift("+0"),
        tilt(""),
        shift("+0")
    );
    let run = on(SWIVEL_HEAD, &ended);
    run.assert_completed();
    // One that was begun before the plane does not end in it, and goes on after it.
    let within = |inner: &str| on(SWIVEL_HEAD, &format!("{}{}{inner}", shift("+40"), tilt("B+30")));
    assert_eq!(within(&shift("+0")).message(), Some((PlaneWronglyDefined, 9)));
    within(&shift("+5")).assert_completed();
    // The plane has no shift in Y, and one of its own in X that ends.
    within(&shift("+0").replace('X', "Y")).assert_completed();
    within(&format!("{}{}", shift("+5"), shift("+0"))).assert_completed();
    let last = run.moves().last().expect("a movement");
    assert!(last.placement.is_none());
    assert_near(xyz(&last.end), [1.0, 2.0, 3.0]);
}

/// A tilting table leaves the directions as they are: the datum has gone with the table [000:4264].
#[test]
fn a_tilting_table_carries_the_datum() {
    let blocks = format!("{}L X+1 Y+2 Z+3 R0 FMAX", tilted("C+90 B+0"));
    // The datum lies 60 in X beside the centre of C: with C+90 it lies 60 in -Y from it.
    let run = on_datum(ROTARY_TABLE, at(460.0, 150.0, -250.0), &blocks);
    run.assert_completed();
    let gone = [400.0 - 460.0, 90.0 - 150.0, 0.0];
    assert_near(noses(&run, 1)[0], [1.0 + gone[0], 2.0 + gone[1], 103.0 + gone[2]]);
    // The direction of the tool, too.
    let element = run.moves().nth(1).expect("a movement");
    let placement = element.placement.as_ref().expect("a placement");
    assert_eq!(
        placement.rotation(),
        Some(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    );
}

/// In the plane all goes on as in an upright one: compensation, circles, roundings, cycles give the same path.
#[test]
fn paths_in_the_plane_are_those_of_an_upright_one() {
    let contour = "L X-20 Y-20 Z+2 R0 FMAX\nL Z-5 F500\nL X+0 Y+0 RL F1000\nL Y+40\nRND R5\nL X+40\nCC X+40 Y+20\n\
                   C X+40 Y+0 DR-\nL X+0\nL X-20 Y-20 R0\nL Z+50 FMAX\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\n\
                   CYCL DEF 1.2 DEPTH -10\nCYCL DEF 1.3 PECKG -4\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100\n\
                   L X+10 Y+10 FMAX M99";
    let upright = on(SWIVEL_HEAD, &format!("L A+20 B-35 R0 FMAX\n{contour}"));
    let tilted = on(SWIVEL_HEAD, &format!("{}{contour}", tilted("A+20 B-35")));
    upright.assert_completed();
    tilted.assert_completed();
    assert_eq!(upright.moves().count(), tilted.moves().count());
    for (a, b) in upright.moves().zip(tilted.moves()).skip(2) {
        assert!(b.placement.is_some());
        assert_eq!(
            (&a.curve, &a.start, &a.end, a.feed),
            (&b.curve, &b.start, &b.end, b.feed)
        );
    }
}

/// Another tool in the tilted plane: the axes stand still, the tip is farther out along the tool.
#[test]
fn a_tool_change_in_the_plane() {
    let blocks = "L B+90 R0 FMAX\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+90\nL X+10 Y+20 Z+5 R0 FMAX\nTOOL DEF 2 L+130 R+5\n\
                  TOOL CALL 2 Z S1000\nL IX+0 Z+5 R0 FMAX";
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for assignment in SWIVEL_HEAD {
        list.assign(assignment).expect(assignment);
    }
    let run = Job::new(program(&format!("{TOOL}{blocks}")))
        .with(|settings| {
            settings.rules = bahn_interpreter::Rules::of(&list);
            settings.start = Position::ZERO;
            settings.machine = true;
        })
        .run();
    run.assert_completed();
    let [end, start] = noses(&run, 2);
    assert_near(start, noses(&run, 1)[0]);
    // It goes back by 30 along the tool, +X of the machine.
    assert_near(end, [start[0] + 30.0, start[1], start[2]]);
    let last = run.moves().last().expect("a movement");
    assert!((last.start[Axis::Z] - (5.0 - 30.0)).abs() < 1e-9);
}

#[test]
fn cycle_19_is_refused() {
    let plane = |angles: &str| format!("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 {angles}\n");
    let without = [&SWIVEL_HEAD[1..], &["7500=0"]].concat();
    // Blocks 1 and 2 are those of the tool.
    assert_eq!(on(&without, &plane("A+10")).message(), Some((BlockNotKnown, 4)));
    assert_eq!(
        on(&["7500=1"], &plane("A+10")).message(),
        Some((BlockNotKnown, 4))
    );
    assert_eq!(
        on(SWIVEL_HEAD, &plane("C+10")).message(),
        Some((WrongAxisProgrammed, 4))
    );
    assert_eq!(
        on(SWIVEL_HEAD, &plane("X+10")).message(),
        Some((WrongAxisProgrammed, 4))
    );
    assert_eq!(
        on(SWIVEL_HEAD, &plane("IA+10")).message(),
        Some((EntryValueIncorrect, 4))
    );
    // No M91 and M92 in the plane [000:4268].
    let m91 = format!("{}L X+1 R0 FMAX M91", plane("A+10"));
    assert_eq!(on(SWIVEL_HEAD, &m91).message(), Some((PlaneWronglyDefined, 5)));
    // What was begun last ends first.
    let rotation = "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30\n";
    let before = format!("{rotation}{}", plane("A+10"));
    assert_eq!(on(SWIVEL_HEAD, &before).message(), Some((PlaneWronglyDefined, 6)));
    let after = format!("{}{rotation}{}", plane("A+10"), plane(""));
    assert_eq!(on(SWIVEL_HEAD, &after).message(), Some((PlaneWronglyDefined, 8)));
    let shift = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+5\n";
    let after = format!("{}{shift}{}", plane("A+10"), plane("A+20"));
    assert_eq!(on(SWIVEL_HEAD, &after).message(), Some((PlaneWronglyDefined, 8)));
    let both = format!("{}L X+1 R0 FMAX M114", plane("A+10"));
    assert_eq!(on(SWIVEL_HEAD, &both).message(), Some((PlaneWronglyDefined, 5)));
    let both = format!("L X+1 R0 FMAX M114\n{}", plane("A+10"));
    assert_eq!(on(SWIVEL_HEAD, &both).message(), Some((PlaneWronglyDefined, 5)));
}

/// M114: while B swivels from 0 to 90 the tip stays where it is programmed, so the tool datum goes as in the tilted plane;
/// after M115 the coordinates are those of the tool datum again.
#[test]
fn m114_keeps_the_tip_on_the_path() {
    let run = on(
        SWIVEL_HEAD,
        "L X+10 Y+20 Z+5 B+0 R0 FMAX\nL B+90 F1000 M114\nL X+11\nL Z+6 M115\nL Z+7",
    );
    run.assert_completed();
    let plane = {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for assignment in SWIVEL_HEAD {
            list.assign(assignment).expect(assignment);
        }
        let swivels = Arc::new(list.swivels().expect("swivel axes"));
        let mut angles = Position::ZERO;
        angles[Axis::B] = 90.0;
        Placement::tilted(&swivels, &angles, [&Position::ZERO; 2], (Axis::Z, 100.0))
    };
    let [end, start] = noses(&run, 1);
    assert_near(start, [10.0, 20.0, 105.0]);
    // The tip (10,20,5) of the workpiece is (-5,20,10) in the plane of B+90.
    assert_near(end, xyz(&plane.to_nose(&at(-5.0, 20.0, 10.0))));
    assert_near(noses(&run, 2)[0], [end[0] + 1.0, end[1], end[2]]);
    // M115: nothing moves, and from there on the coordinates count upright: Z+6 is 106 of the tool datum.
    let [after, before] = noses(&run, 3);
    assert_near(before, noses(&run, 2)[0]);
    assert_near(after, [before[0], before[1], 106.0]);
    assert!(run.moves().last().expect("a movement").placement.is_none());
    // The feed is that of the tip, M114 ends with the program, and needs the geometry.
    assert!(
        run.moves()
            .skip(1)
            .all(|element| element.feed == FeedRate::Programmed(1000.0))
    );
    assert_eq!(
        on(&["7500=1"], "L X+1 R0 FMAX M114").message(),
        Some((BlockNotKnown, 3))
    );
}

/// M116: a point 60 mm beside the centre of C goes 60 · π/2 mm in a quarter turn; at F600 that takes as long as the quarter
/// turn at 600 · 90 / (60 · π/2) degrees/min. M117 and the end of the program end it.
#[test]
fn m116_feeds_the_tool_over_the_workpiece() {
    let datum = at(460.0, 150.0, -250.0);
    let run = on_datum(
        ROTARY_TABLE,
        datum,
        "L X+0 Y+0 R0 FMAX\nL C+90 F600 M116\nL X-60 FMAX\nL C+180 F600\nL C+0 F600 M117",
    );
    run.assert_completed();
    let feeds: Vec<_> = run.moves().map(|element| element.feed).collect();
    let FeedRate::Programmed(feed) = feeds[1] else {
        panic!("a feed")
    };
    let degrees = 600.0 * 90.0 / (60.0 * std::f64::consts::FRAC_PI_2);
    assert!((feed - degrees).abs() < 1e-9, "{feed} is not {degrees}");
    // In the centre nothing goes over the workpiece; without M116 the feed is that of the axis.
    assert_eq!(feeds[3..], [FeedRate::Programmed(600.0); 2]);
    // With X along: 60 mm along the axis while the radius falls from 60 to 0, 30 in the middle.
    let run = on_datum(ROTARY_TABLE, datum, "L X+0 Y+0 R0 FMAX\nL X-60 C+90 F600 M116");
    let FeedRate::Programmed(feed) = run.moves().last().expect("a movement").feed else {
        panic!("a feed")
    };
    let over = 60f64.hypot(30.0 * std::f64::consts::FRAC_PI_2);
    assert!((feed - 600.0 * 60.0 / over).abs() < 1e-9, "{feed}");
    assert_eq!(on(&[], "L C+90 F600 M116").message(), Some((BlockNotKnown, 3)));
}

/// M126 leads a table with modulo value the short way, M127 the one that does not cross 0 [000:836].
#[test]
fn m126_takes_the_shortest_way() {
    let table = ["10=%11111", "410.3=2", "810.3=360"];
    let run = on(
        &table,
        "L C+350 R0 FMAX\nL C+10 FMAX M126\nL C+350 FMAX\nL IC-20 FMAX\nL C+10 FMAX\nL C+350 FMAX M127\nL C+10 FMAX",
    );
    run.assert_completed();
    let ends: Vec<f64> = run.moves().map(|element| element.end[Axis::C]).collect();
    // 350 to 370, back, incremental as programmed, 330 to 370; then within the turn from 360: 710 and 370.
    assert_eq!(ends, [350.0, 370.0, 350.0, 330.0, 370.0, 710.0, 370.0]);
    // An axis without modulo value goes where it is told.
    let run = on(
        &["10=%11111", "410.3=2", "810.3=0"],
        "L C+350 R0 FMAX M126\nL C+10 FMAX",
    );
    assert_eq!(run.moves().last().expect("a movement").end[Axis::C], 10.0);
}

/// Radius compensation in five-axis blocks: RL and RR act in the plane of the tool axis while Z and the swivel axes go to
/// their ends. The tool of 5 mm, to the right into the second line and left of the first one: on the left of the contour it
/// goes around the outer corner (0,50) on an arc, during which nothing swivels; on the right of it the parallels meet at
/// (5,45). A block stands for its whole way: both axes come to their angles where the line ends.
#[test]
fn radius_compensation_in_five_axis_blocks() {
    let contour = |side: &str| {
        format!(
            "L X+0 Y-20 Z+0 A+0 B+0 R0 FMAX\nL X+0 Y+0 {side} F500\nL Y+50 Z-4 A+10 B+20\nL X+50 Z-6 A-5 B+30\n\
             L X+80 R0"
        )
    };
    let ends = |side: &str| -> Vec<_> {
        let run = on(&[], &contour(side));
        run.assert_completed();
        let five = [Axis::X, Axis::Y, Axis::Z, Axis::A, Axis::B];
        run.moves()
            .skip(1)
            .map(|element| five.map(|axis| element.end[axis]))
            .collect()
    };
    let left = [
        [-5.0, 0.0, 0.0, 0.0, 0.0],
        [-5.0, 50.0, -4.0, 10.0, 20.0],
        [0.0, 55.0, -4.0, 10.0, 20.0],
        [50.0, 55.0, -6.0, -5.0, 30.0],
        [80.0, 50.0, -6.0, -5.0, 30.0],
    ];
    let right = [
        [5.0, 0.0, 0.0, 0.0, 0.0],
        [5.0, 45.0, -4.0, 10.0, 20.0],
        [50.0, 45.0, -6.0, -5.0, 30.0],
        [80.0, 50.0, -6.0, -5.0, 30.0],
    ];
    close_points(&ends("RL"), &left, 1e-9);
    close_points(&ends("RR"), &right, 1e-9);
}
