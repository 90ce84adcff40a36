//! Datum shift, mirror image, rotation and scaling: the same contour at another place.

use crate::support::*;
use bahn_parameters::MessageId;
use bahn_path::{Axis, Curve, PerAxis, Position};

/// The contour of P33 to P36, from corner to corner, and its first and last point once more.
const CONTOUR: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [0.0, 20.0],
    [25.0, 20.0],
    [30.0, 15.0],
    [30.0, 0.0],
    [0.0, 0.0],
];

/// Where the tool of radius R runs beside [`CONTOUR`] with RL: outside. Ends of lines and of the arcs about
/// the corners.
fn outside(radius: f64) -> Vec<[f64; 2]> {
    let s = radius / 2f64.sqrt();
    vec![
        [-radius, 0.0],
        [-radius, 20.0],
        [0.0, 20.0 + radius],
        [25.0, 20.0 + radius],
        [25.0 + s, 20.0 + s],
        [30.0 + s, 15.0 + s],
        [30.0 + radius, 15.0],
        [30.0 + radius, 0.0],
        [30.0, -radius],
        [0.0, -radius],
    ]
}

/// Ends of the contour's movements, first at the original place, then at the other one.
fn both(name: &str) -> (Vec<[f64; 2]>, Vec<[f64; 2]>) {
    let run = run_manual(name);
    let cutting: Vec<_> = run
        .moves()
        .filter(|e| e.end[Axis::Z] < 0.0 && e.start[Axis::Z] == e.end[Axis::Z])
        .collect();
    let half = cutting.len() / 2;
    // The last movement of each pass leads away from the contour.
    let ends = |part: &[&bahn_path::PathElement]| {
        part[..part.len() - 1]
            .iter()
            .map(|e| [e.end[Axis::X], e.end[Axis::Y]])
            .collect()
    };
    (ends(&cutting[..half]), ends(&cutting[half..]))
}

fn mapped(points: &[[f64; 2]], f: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
    points.iter().map(|p| f(*p)).collect()
}

/// P33: datum shift by (40,60) [003:6244-6259].
#[test]
fn p33_datum_shift() {
    let (first, second) = both("P33");
    close_points(&first, &outside(5.0), 1e-9);
    close_points(
        &second,
        &mapped(&outside(5.0), |[x, y]| [40.0 + x, 60.0 + y]),
        1e-9,
    );
}

/// P34: mirrored in X about the datum (70,60): the tool's side is mirrored with the contour [003:6307].
#[test]
fn p34_mirror_image() {
    let (first, second) = both("P34");
    close_points(&first, &outside(4.0), 1e-9);
    close_points(
        &second,
        &mapped(&outside(4.0), |[x, y]| [70.0 - x, 60.0 + y]),
        1e-9,
    );
    // The corners of the manual's drawing.
    let corners = mapped(&CONTOUR, |[x, y]| [70.0 - x, 60.0 + y]);
    close_points(
        &corners[..5],
        &[
            [70.0, 60.0],
            [70.0, 80.0],
            [45.0, 80.0],
            [40.0, 75.0],
            [40.0, 60.0],
        ],
        1e-9,
    );
}

/// P35: rotated by 35° about the datum (70,60) [003:6345-6379].
#[test]
fn p35_rotation() {
    let (sin, cos) = 35f64.to_radians().sin_cos();
    let turned = |[x, y]: [f64; 2]| [70.0 + x * cos - y * sin, 60.0 + x * sin + y * cos];
    let (first, second) = both("P35");
    close_points(&first, &outside(5.0), 1e-9);
    close_points(&second, &mapped(&outside(5.0), turned), 1e-9);
    close_points(
        &mapped(&CONTOUR[1..3], turned),
        &[[58.528, 76.383], [79.007, 90.722]],
        5e-4,
    );
}

/// P36: scaled by 0.8 about the datum (60,70); the tool keeps its radius [003:6422-6454].
#[test]
fn p36_scaling() {
    let (first, second) = both("P36");
    close_points(&first, &outside(5.0), 1e-9);
    // A tool of R 5/0.8 beside the original contour, then everything scaled.
    let scaled = mapped(&outside(5.0 / 0.8), |[x, y]| [60.0 + 0.8 * x, 70.0 + 0.8 * y]);
    close_points(&second, &scaled, 1e-9);
    // All axes are scaled: the depth too.
    let depths: Vec<f64> = run_manual("P36")
        .of_block(22)
        .iter()
        .map(|e| e.end[Axis::Z])
        .collect();
    assert_eq!(depths, [-5.0, -4.0]);
}

/// All four together: scaled and mirrored first, then rotated about the shifted datum.
#[test]
fn all_together() {
    let text = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 Y-5\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +90
        CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nCYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2\nL X+3 Y+4 R0 FMAX\nL X+0 Y+0 FMAX";
    let run = run(text);
    // (3,4) -> scaled (6,8) -> mirrored (-6,8) -> rotated (-8,-6) -> shifted (2,-11).
    close_points(
        &ends(&run.moves().collect::<Vec<_>>()),
        &[[2.0, -11.0], [10.0, -5.0]],
        1e-12,
    );
}

/// Incremental shifts add up, incremental rotation too [003:6222] [003:6313-6333].
#[test]
fn incremental_transformations() {
    let moved = |text: &str| {
        let run = run(&format!("{text}\nL X+1 Y+0 FMAX"));
        [run.position[Axis::X], run.position[Axis::Y]]
    };
    let shift = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 IX+10";
    close_points(&[moved(&format!("{shift}\n{shift}"))], &[[21.0, 0.0]], 1e-12);
    let rotation = "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 IROT +45";
    close_points(&[moved(&format!("{rotation}\n{rotation}"))], &[[0.0, 1.0]], 1e-12);
}

/// Cycles work in the transformed system: a pocket turns with it, and is scaled with it [003:6393-6395].
#[test]
fn cycles_are_transformed() {
    let pocket = "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nCYCL DEF 4.0 POCKET\nCYCL DEF 4.1 SET UP -2\nCYCL DEF 4.2 DEPTH -10\nCYCL DEF 4.3 PECKG -10 F80
        CYCL DEF 4.4 X+80\nCYCL DEF 4.5 Y+40\nCYCL DEF 4.6 F100 DR+ RADIUS 0";
    let reach = |transformation: &str| {
        let run = run(&format!(
            "{pocket}\n{transformation}\nL X+0 Y+0 R0 FMAX M3\nL Z+2 FMAX M99"
        ));
        let bottom = run.moves().map(|e| e.end[Axis::Z]).fold(f64::MAX, f64::min);
        let span = |axis: Axis| {
            let below: Vec<f64> = run
                .moves()
                .filter(|e| e.end[Axis::Z] < 0.0)
                .map(|e| e.end[axis])
                .collect();
            below.iter().copied().fold(f64::MIN, f64::max) - below.iter().copied().fold(f64::MAX, f64::min)
        };
        [span(Axis::X), span(Axis::Y), bottom]
    };
    close_points(&[reach("")], &[[70.0, 30.0, -10.0]], 1e-9);
    close_points(
        &[reach("CYCL DEF 10.0 ROT\nCYCL DEF 10.1 ROT +90")],
        &[[30.0, 70.0, -10.0]],
        1e-9,
    );
    // The tool stands at Z = 2·2 = 4, setup clearance 2·2, depth 2·10; the tool's radius stays.
    close_points(
        &[reach("CYCL DEF 11.0 SCL\nCYCL DEF 11.1 SCL 2")],
        &[[150.0, 70.0, -20.0]],
        1e-9,
    );
}

/// MP7410 = 1: scaling in the working plane only [003:7357-7363].
#[test]
fn scaling_of_the_plane_only() {
    let text = program("TOOL CALL 0 Z\nCYCL DEF 11.0 SCL\nCYCL DEF 11.1 SCL 2\nL X+1 Y+1 Z+1 FMAX");
    let run = Job::new(text)
        .with(|s| s.rules.scaling_in_plane_only = true)
        .run();
    close_points(&[xyz(&run.position)], &[[2.0, 2.0, 1.0]], 1e-12);
}

/// A mirrored arc turns the other way; both axes mirrored it turns as before [003:6276-6284].
#[test]
fn mirrored_arcs() {
    let sweep = |axes: &str| {
        let run = run(&format!(
            "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 {axes}\nL X+10 Y+0 R0 FMAX\nCC X+0 Y+0\nC X+0 Y+10 DR+ F100"
        ));
        let arc = run.moves().last().unwrap();
        (arc_of(arc).1, arc.end[Axis::X] + 0.0, arc.end[Axis::Y])
    };
    let near = |(s, x, y): (f64, f64, f64), (s2, x2, y2): (f64, f64, f64)| {
        close_points(&[[s, x, y]], &[[s2, x2, y2]], 1e-9);
    };
    near(sweep("X"), (-90.0, 0.0, 10.0));
    near(sweep("Y"), (-90.0, 0.0, -10.0));
    near(sweep("X Y"), (90.0, 0.0, -10.0));
}

/// A shift without a movement moves nothing; the next incremental word counts from where the tool stands
/// (inferred).
#[test]
fn a_shift_alone_moves_nothing() {
    let run =
        run("L X+10 Y+20 FMAX\nCYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+100\nL IX+1 FMAX\nL Y+0 FMAX\nL X+0 FMAX");
    close_points(
        &ends(&run.moves().collect::<Vec<_>>()),
        &[[10.0, 20.0], [11.0, 20.0], [11.0, 0.0], [100.0, 0.0]],
        1e-12,
    );
}

/// M91 refers to machine zero, M92 to the machine datum, whatever is transformed [003:3533-3553].
#[test]
fn machine_coordinates() {
    let text = program(
        "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+100\nL X+1 FMAX\nL X+1 FMAX M91\nL X+1 FMAX M92\nL X+1 FMAX",
    );
    let mut at = Position::ZERO;
    at[Axis::X] = -200.0;
    let mut datum = Position::ZERO;
    datum[Axis::X] = 30.0;
    let run = Job::new(text)
        .with(|s| {
            s.rules.machine_zero = at;
            s.rules.machine_datum = datum;
        })
        .run();
    run.assert_completed();
    let x: Vec<f64> = run.moves().map(|e| e.end[Axis::X]).collect();
    assert_eq!(x, [101.0, -199.0, -169.0, 101.0]);
    assert!(run.moves().all(|e| e.curve == Curve::Line));
}

/// A datum table: line 3 shifts X, Y and C, line 4 is all 0.
fn datum_table() -> bahn_interpreter::DatumTable {
    let line = |x: f64, y: f64, c: f64| {
        let mut datum = Position::UNKNOWN;
        (datum[Axis::X], datum[Axis::Y], datum[Axis::C]) = (x, y, c);
        datum
    };
    [(3, line(40.0, -7.5, 30.0)), (4, line(0.0, 0.0, 0.0))].into()
}

/// `CYCL DEF 7.1 #n`: the axes of the table are shifted as its line says, absolute, the others stay; the number may
/// be a Q parameter. With MP7475 = 1 the values count from the machine datum [000:6898-6904].
#[test]
fn a_line_of_the_datum_table_shifts() {
    let shift = |words: &str| format!("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 {words}\n");
    let blocks = format!(
        "{}{}L X+1 Y+2 Z+3 FMAX\nQ5 = 4\n{}L X+1 Y+2 Z+3 FMAX",
        shift("X+1\nCYCL DEF 7.2 Z+100"),
        shift("#3"),
        shift("#Q5"),
    );
    for from_machine in [false, true] {
        let run = Job::new(program(&blocks))
            .with(|settings| {
                settings.model = bahn_parameters::ControlModel::Tnc415b;
                settings.datum_table = Ok(std::sync::Arc::new(datum_table()));
                settings.rules.datums_from_machine = from_machine;
                settings.rules.machine_zero = PerAxis::splat(-200.0).into();
            })
            .run();
        run.assert_completed();
        let zero = if from_machine { -200.0 } else { 0.0 };
        let ends: Vec<[f64; 3]> = run.moves().map(|element| xyz(&element.end)).collect();
        let expected = [
            [zero + 40.0 + 1.0, zero - 7.5 + 2.0, 103.0],
            [zero + 1.0, zero + 2.0, 103.0],
        ];
        close_points(&ends, &expected, 1e-12);
    }
}

/// A line that is not there, no table, a datum of the machine that nobody knows: errors of the block.
#[test]
fn a_datum_that_is_missing_is_an_error() {
    let with = |words: &str, change: &dyn Fn(&mut bahn_interpreter::Settings)| {
        let blocks = format!("L X+1 FMAX\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 {words}\nL X+2 FMAX");
        Job::new(program(&blocks))
            .with(|settings| {
                settings.model = bahn_parameters::ControlModel::Tnc415b;
                settings.datum_table = Ok(std::sync::Arc::new(datum_table()));
                change(settings);
            })
            .run()
    };
    let wrong = Some((bahn_parameters::MessageId::EntryValueIncorrect, 3));
    for words in ["#5", "#-1", "#3.5", "#", "##3", "X+5 #3", "#3 X+5", "#3 #4"] {
        assert_eq!(
            with(words, &|_| {}).message().map(|(id, _)| id),
            wrong.map(|(id, _)| id),
            "{words}"
        );
    }
    let unknown = with("#3", &|settings| {
        settings.rules.datums_from_machine = true;
        settings.rules.machine_zero = Position::UNKNOWN;
    });
    assert_eq!(unknown.message(), wrong);
    let none = with("#3", &|settings| {
        settings.datum_table = Err("no table".to_owned())
    });
    assert_eq!(none.message(), wrong);
    // Passed over where that is wanted: the rest of the program runs where it is.
    let passed = with("#3", &|settings| {
        settings.datum_table = Err("no table".to_owned());
        settings.skip_unknown = true;
    });
    passed.assert_completed();
    assert_eq!((passed.warnings.len(), passed.position[Axis::X]), (1, 2.0));
}

/// Cycle 26: each axis has its factor about its centre, before rotation and shift; cycle 11 multiplies it; factor 1
/// ends it. The tool keeps its radius.
#[test]
fn cycle_26_scales_each_axis_about_its_centre() {
    let own = "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X1.4 Y0.6 CCX+15 CCY+20";
    let ends_of = |text: &str| {
        let run = run(text);
        run.assert_completed();
        ends(&run.moves().collect::<Vec<_>>())
    };
    // X: 15 + 1.4 (25 - 15) = 29; Y: 20 + 0.6 (0 - 20) = 8.
    let point = "L X+25 Y+0 R0 FMAX";
    close_points(&ends_of(&format!("{own}\n{point}")), &[[29.0, 8.0]], 1e-12);
    // (29,8) turned by 90 degrees is (-8,29), shifted by (10,0) (2,29).
    let turned = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +90";
    close_points(
        &ends_of(&format!("{turned}\n{own}\n{point}")),
        &[[2.0, 29.0]],
        1e-12,
    );
    // Mirrored in X and twice as large: (-58,16).
    let larger = "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nCYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2";
    close_points(
        &ends_of(&format!("{own}\n{larger}\n{point}")),
        &[[-58.0, 16.0]],
        1e-12,
    );
    // X keeps its factor; that of Y counts from the datum where no centre is given, and 1 ends it.
    let y = |factor: &str| format!("CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 {factor}");
    let text = format!(
        "{own}\n{}\nL X+25 Y+10 R0 FMAX\n{}\nL Y+11 FMAX",
        y("Y0.5"),
        y("Y1")
    );
    close_points(&ends_of(&text), &[[29.0, 5.0], [29.0, 11.0]], 1e-12);
    // RL with R5 along X at Y 8: the tool is 5 mm beside the scaled contour.
    let text = format!(
        "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S100\nL X+0 Y-50 R0 FMAX\n{own}\nL X+25 Y+0 RL F100\nL X+35\nL X+45 R0"
    );
    let run = run(&text);
    run.assert_completed();
    let last = run.moves().last().unwrap();
    close_points(
        &[[last.start[Axis::X], last.start[Axis::Y]]],
        &[[43.0, 13.0]],
        1e-9,
    );
}

/// Axes of an arc need the same factor (later controls): with 0.6 for both it is an arc of 0.6 times the radius.
#[test]
fn arcs_take_one_factor_for_both_axes() {
    let cut = |factors: &str, block: &str| {
        format!(
            "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 {factors}\nCC X+0 Y+0\nL X+10 Y+0 R0 F100\n{block}\nL X+50 Y+50"
        )
    };
    let run_of = |text: &str| Job::new(program(&format!("TOOL CALL 0 Z S100\n{text}"))).run();
    let quarter = run_of(&cut("X0.6 Y0.6 Z2", "C X+0 Y+10 DR+"));
    quarter.assert_completed();
    let arc = quarter.moves().find_map(|e| match e.curve {
        Curve::Arc(arc) => Some((arc, e.start[Axis::X], e.end[Axis::Y])),
        _ => None,
    });
    let (arc, from, to) = arc.unwrap();
    close_points(&[arc.centre, [from, to]], &[[0.0, 0.0], [6.0, 6.0]], 1e-12);
    for block in ["C X+0 Y+10 DR+", "CR X+0 Y+10 R10 DR+", "RND R2", "CHF 1"] {
        let run = run_of(&cut("X0.6 Y0.7", block));
        assert_eq!(
            run.message(),
            Some((MessageId::PlaneWronglyDefined, 6)),
            "{block}"
        );
    }
}

/// What cycle 26 does not take.
#[test]
fn factors_out_of_range() {
    use MessageId::{EntryValueIncorrect, WrongAxisProgrammed};
    for (words, message) in [
        ("X0", EntryValueIncorrect),
        ("X-1", EntryValueIncorrect),
        ("X100", EntryValueIncorrect),
        ("C2", WrongAxisProgrammed),
        ("X2 CCA+5", WrongAxisProgrammed),
    ] {
        let run = Job::new(program(&format!(
            "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 {words}"
        )))
        .run();
        assert_eq!(run.message(), Some((message, 2)), "{words}");
    }
}
