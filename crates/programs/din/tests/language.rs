//! What blocks mean beyond the programs of the manual, and what is refused with its name.

mod support;

use std::sync::Arc;

use bahn_din::{Command, LandmarkKind, Program, Step};
use bahn_path::{Axis, Curve, Plane, Position, Switch};
use bahn_text::{MemoryFiles, Span};
use support::{Bench, decoder_with, refused, reported, reported_all, run, run_with, variable};

#[test]
fn incremental_and_absolute_coordinates() {
    let units = run("G90 G00 X10 Y5\nG91 X2 Y-1\nX1\nG90 X1 Z-3\nA90\nG91 A-30");
    let ends: Vec<(f64, f64)> = units
        .iter()
        .filter_map(|unit| unit.motion.as_ref())
        .map(|motion| (motion.end[Axis::X], motion.end[Axis::Y]))
        .collect();
    assert_eq!(ends[..4], [(10.0, 5.0), (12.0, 4.0), (13.0, 4.0), (1.0, 4.0)]);
    let turn = units[5].motion.as_ref().expect("a motion");
    assert_eq!((turn.start[Axis::A], turn.end[Axis::A]), (90.0, 60.0));
    let first = units[4].motion.as_ref().expect("a motion");
    assert_eq!(
        first.start[Axis::A],
        0.0,
        "an axis that was never programmed stands at 0"
    );
}

#[test]
fn words_may_be_glued_and_small() {
    assert_eq!(
        reported_all(&run("n10g01x10.5y-.5f200m3s500\nM30")),
        ["N10 M3 S500 to X10.5 Y-0.5 F200", "#2 M30 end"]
    );
}

#[test]
fn an_arc_about_a_centre_from_its_start() {
    let units = run("G01 X10 F100\nG03 X0 Y10 I-10 J0\nG02 X10 Y0 J-10\nG03 I-10");
    let arcs: Vec<_> = units[1..4]
        .iter()
        .map(|unit| match unit.motion.as_ref().map(|motion| motion.curve) {
            Some(Curve::Arc(arc)) => (arc.plane, arc.centre, arc.sweep_deg.round()),
            other => panic!("{other:?}"),
        })
        .collect();
    let xy = Plane::XY;
    assert_eq!(
        arcs,
        [
            (xy, [0.0, 0.0], 90.0),
            (xy, [0.0, 0.0], -90.0),
            (xy, [0.0, 0.0], 360.0)
        ]
    );
}

#[test]
fn an_arc_of_a_radius_is_the_shorter_one_or_with_a_sign_the_longer_one() {
    let sweep = |text: &str| {
        let units = run(text);
        let motion = units
            .iter()
            .find_map(|unit| unit.motion.clone())
            .expect("a motion");
        match motion.curve {
            Curve::Arc(arc) => (arc.centre.map(f64::round), arc.sweep_deg.round()),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(sweep("G03 X10 Y10 R10 F1"), ([0.0, 10.0], 90.0));
    assert_eq!(sweep("G03 X10 Y10 R-10 F1"), ([10.0, 0.0], 270.0));
    assert_eq!(sweep("G02 X10 Y10 R10 F1"), ([10.0, 0.0], -90.0));
    assert_eq!(sweep("G02 X10 Y10 R-10 F1"), ([0.0, 10.0], -270.0));
    assert_eq!(sweep("G02 X20 R10 F1"), ([10.0, 0.0], -180.0));
}

#[test]
fn the_plane_turns_the_arc() {
    for (g, words, plane) in [(18, "Z10 X10 I10", Plane::ZX), (19, "Y10 Z10 K10", Plane::YZ)] {
        let units = run(&format!("G{g} G03 F100 {words}"));
        let motion = units[0].motion.clone().expect("a motion");
        let Curve::Arc(arc) = motion.curve else {
            panic!("no arc")
        };
        assert_eq!((arc.plane, arc.centre), (plane, [0.0, 10.0]), "G{g}");
        assert_eq!(arc.sweep_deg.round(), 90.0, "G{g}");
        assert!((motion.curve.length(&motion.start, &motion.end) - 5.0 * std::f64::consts::PI).abs() < 1e-9);
    }
}

#[test]
fn a_helix_moves_the_other_axes_along() {
    let units = run("G02 X20 I10 Z-5 F300");
    let motion = units[0].motion.as_ref().expect("a motion");
    let length = motion.curve.length(&motion.start, &motion.end);
    assert!((length - (10.0 * std::f64::consts::PI).hypot(5.0)).abs() < 1e-9);
}

#[test]
fn time_of_standing() {
    let units = run("P1=2\nG04 X0.5\nG04 3.5\nG04 P1*2\nX1");
    let times: Vec<f64> = units.iter().map(|unit| unit.dwell_s).collect();
    assert_eq!(times, [0.0, 0.5, 3.5, 4.0, 0.0, 0.0]);
    assert_eq!(
        reported(&units[4]),
        "#5 to X1 Y0 rapid",
        "X of G04 is no coordinate"
    );
}

#[test]
fn expressions() {
    let value = |text: &str| {
        let units = run(&format!("P1=4 P2=-0.5 P[2+1]=7\nX[{text}]"));
        units[1].motion.as_ref().map_or(0.0, |motion| motion.end[Axis::X])
    };
    let near = |text: &str, expected: f64| {
        assert!(
            (value(text) - expected).abs() < 1e-12,
            "{text} is {}",
            value(text)
        );
    };
    near("1+2*3-4/8", 6.5);
    near("[1+2]*3", 9.0);
    near("-2**2", -4.0);
    near("2**3**2", 512.0);
    near("2**-1", 0.5);
    near("P1*P2", -2.0);
    near("P[P1-1]", 7.0);
    near("SIN[30]+COS[60]*2+TAN[45]", 2.5);
    near("ASIN[1]+ACOS[0]+ATAN[1]", 225.0);
    near("SQRT[16]+SQR[3]+ABS[-2]", 15.0);
    near("EXP[0]+LN[1]+INT[-2.7]+FRACT[2.25]+ROUND[2.5]", 2.25);
    near("'16#ff'+'2#101'", 260.0);
    near("--3", 3.0);
    // The strings of the vendor's example, with other numbers (public): angles are degrees, strings stand in strings.
    let units = run("\"A\"=\"COS[\\\"B\\\"]\"\n\"B\"=\"6 * 10\"\nX[4 * \"A\" + \"B\"]");
    let end = units[2].motion.as_ref().map_or(0.0, |motion| motion.end[Axis::X]);
    assert!((end - 62.0).abs() < 1e-12);
}

#[test]
fn numbers_of_functions_are_rounded() {
    assert_eq!(
        reported_all(&run("P10=24.6 P1=7\nMP10 H[P1*2]=P1/2 X[MP10=1]\n")),
        ["#1", "#2 M25 H14=4 X[M25=1]", "#2 end"]
    );
    assert_eq!(
        refused("P1=-2\nMP1").2,
        "-2 is no number of a function: 0 to 65535"
    );
    assert_eq!(
        refused("M70000").2,
        "70000 is no number of a function: 0 to 65535"
    );
}

#[test]
fn additive_values_have_32_bits() {
    assert_eq!(
        reported_all(&run("M50=2.5 M51=-99999999999 M52=3000000000")),
        ["#1 M50=3 M51=-2147483648 M52=2147483647", "#1 end"]
    );
}

#[test]
fn a_function_may_be_asked_for() {
    let mut bench = Bench {
        m: vec![80],
        h: vec![3],
        ..Bench::default()
    };
    let (units, fault) = run_with(
        "X[EXIST[M80]*5+EXIST[H3]] Y[EXIST[M81]+EXIST[H80]]",
        &mut bench,
        MemoryFiles::default(),
    );
    assert_eq!((reported(&units[0]), fault), ("#1 to X6 Y0 rapid".into(), None));
}

#[test]
fn everything_is_executed_before_an_external_variable_is_read() {
    // [004:126]
    let mut bench = Bench::default();
    let mut decoder = decoder_with(
        "N10 X10\nN20 M5=V.E.STATE X20\nN30 V.E.STATE=3",
        MemoryFiles::default(),
    );
    let mut next = |bench: &mut Bench| match decoder.next(bench) {
        Step::Unit(unit) => *unit,
        other => panic!("{other:?}"),
    };
    assert_eq!(reported(&next(&mut bench)), "N10 to X10 Y0 rapid");
    let barrier = next(&mut bench);
    assert_eq!(reported(&barrier), "N20");
    assert_eq!(barrier.commands, [Command::Flush { wait: true }]);
    assert_eq!(bench.log, [""; 0], "not asked before everything else is done");
    bench.values.insert(variable("V.E.STATE", None), 7.0);
    let block = next(&mut bench);
    assert_eq!(reported(&block), "N20 M5=7 to X20 Y0 rapid");
    assert!(block.commands.is_empty());
    assert!(next(&mut bench).commands.is_empty(), "writing waits for nothing");
    assert_eq!(bench.log, ["read V.E.STATE", "write V.E.STATE 3"]);
}

#[test]
fn subroutines_of_the_same_file() {
    let text = "%L FIRST\nN1 M11\nN2 LL SECOND\nN3 M29\n% L SECOND (name)\nN4 M12\n%MAIN\nN10 X1 L FIRST\nN20 LL SECOND\nN30 M30\n%OTHER\nN40 M99";
    assert_eq!(
        reported_all(&run(text)),
        [
            "N10 to X1 Y0 rapid",
            "N1 M11",
            "N2",
            "N4 M12",
            "N3 M29",
            "N20",
            "N4 M12",
            "N30 M30 end"
        ]
    );
}

#[test]
fn a_subroutine_may_end_the_program() {
    let beside = MemoryFiles::from([("end.nc", "M30\n"), ("deep.nc", "L end\nM50")]);
    let (units, fault) = run_with("L deep\nM51", &mut Bench::default(), beside);
    assert_eq!(
        (reported_all(&units), fault),
        (vec!["#1".into(), "#1".into(), "#1 M30 end".into()], None)
    );
}

#[test]
fn subroutines_end_somewhere() {
    let beside = MemoryFiles::from([("loop.nc", "L loop.nc")]);
    let (units, fault) = run_with("L loop.nc", &mut Bench::default(), beside);
    let message = fault.map(|fault| fault.message).unwrap_or_default();
    assert_eq!(
        message,
        "subroutine loop.nc is called too deep: 20 in one another at most"
    );
    assert_eq!(units.len(), 20);
    assert_eq!(
        refused("N1 L nowhere.nc"),
        ("N1".into(), 4, "subroutine nowhere.nc is not found".into())
    );
}

/// Executes what stands before a block. Its name where it was found.
fn skip_to(decoder: &mut bahn_din::Decoder, block: &str, bench: &mut Bench) -> Option<String> {
    while !decoder.next_is(block) {
        match decoder.next(bench) {
            Step::Unit(unit) if !unit.ends => {}
            _ => return None,
        }
    }
    match decoder.next(bench) {
        Step::Unit(unit) => Some(reported(&unit)),
        _ => None,
    }
}

#[test]
fn search_for_a_block_executes_what_stands_before_it() {
    let beside = || MemoryFiles::from([("sub.nc", "N50 G91 X5 M7\nV.G.RW=4\nN70 X2")]);
    let text = "N10 G01 F500 X10 M3\nN30 L sub.nc\nN37 #EXPL SYN\n(here)\nN50 X1 M9\nN60 M30";
    let mut decoder = decoder_with(text, beside());
    let mut bench = Bench::default();
    // A block of the program itself goes before one of the same name in a subroutine; G91 and F of that are in force.
    assert_eq!(
        skip_to(&mut decoder, "N50", &mut bench).as_deref(),
        Some("N50 M9 to X18 Y0 F500")
    );
    assert_eq!(bench.log, ["write V.G.RW 4"]);

    // What the program itself does not have is looked for in the subroutines that it calls; after their end it goes on.
    let mut decoder = decoder_with(text, beside());
    assert!(!decoder.has("N70") && decoder.has("N50") && !decoder.has("#4"));
    assert_eq!(
        skip_to(&mut decoder, "N70", &mut bench).as_deref(),
        Some("N70 to X17 Y0 F500")
    );
    assert!(decoder.next_is("N37"));

    let mut missing = decoder_with(text, beside());
    assert_eq!(skip_to(&mut missing, "N99", &mut bench), None);
    assert_eq!(
        (&*missing.begin().block, &*missing.begin().program),
        ("N10", "test.nc")
    );
    let mut line = decoder_with("X1\n\nX2", MemoryFiles::default());
    assert!(skip_to(&mut line, "#3", &mut bench).is_some());
    assert_eq!(line.position()[Axis::X], 2.0);
}

#[test]
fn programs_of_a_file_are_distinguished() {
    let program = Program::from_bytes(
        "two.nc",
        b"\n; before\nM1\n%PRG1\nN5 M2\n%L SUB\nN6 M17\n%PRG2\r\nN7 M30\r\n",
    );
    let mains: Vec<(&str, u32)> = program
        .mains()
        .map(|main| (main.name.as_str(), main.line))
        .collect();
    assert_eq!(mains, [("", 3), ("PRG1", 4), ("PRG2", 8)]);
    let landmarks: Vec<(LandmarkKind, String, u32)> = program
        .landmarks()
        .into_iter()
        .map(|mark| (mark.kind, mark.name, mark.line))
        .collect();
    use LandmarkKind::{Number, Program as Head, Subroutine};
    let expected = [
        (Head, "PRG1", 4),
        (Number, "N5", 5),
        (Subroutine, "SUB", 6),
        (Number, "N6", 7),
        (Head, "PRG2", 8),
        (Number, "N7", 9),
    ];
    assert_eq!(
        landmarks,
        expected.map(|(kind, name, line)| (kind, name.to_owned(), line))
    );
    assert_eq!(program.block_count(), 4);

    // The second one begins anew, where the first one ended.
    let program = Arc::new(program);
    let main = program.mains().nth(2).expect("a program").clone();
    let mut start = Position::UNKNOWN;
    start[Axis::X] = 7.0;
    let mut decoder = bahn_din::Decoder::new(
        Arc::clone(&program),
        &main,
        start,
        Arc::new(MemoryFiles::default()),
    );
    let Step::Unit(unit) = decoder.next(&mut Bench::default()) else {
        panic!("no unit")
    };
    assert_eq!(
        (reported(&unit), decoder.position()[Axis::X]),
        ("N7 M30 end".into(), 7.0)
    );
    assert_eq!(decoder.next(&mut Bench::default()), Step::End);
}

#[test]
fn comments_over_several_lines() {
    let text = "X1 #COMMENT BEGIN\nthis is no block\n  #comment end X2\n(#COMMENT BEGIN)\nX3\n#COMMENT BEGIN #COMMENT END M5";
    assert_eq!(
        reported_all(&run(text)),
        [
            "#1 to X1 Y0 rapid",
            "#3 to X2 Y0 rapid",
            "#5 to X3 Y0 rapid",
            "#6 M5",
            "#6 end"
        ]
    );
    let open = Program::from_bytes("t.nc", b"X1\n  #COMMENT BEGIN\nX2").faults();
    assert_eq!(open.len(), 1);
    assert_eq!(open[0].span, Span::new(2, 3, 14));
}

#[test]
fn g40_to_g42_are_reported_and_change_no_path() {
    let units = run("G41 G01 X10 F100\nG40 X20");
    assert_eq!(units[0].commands, [Command::RadiusCompensation(Switch::On)]);
    assert_eq!(units[1].commands, [Command::RadiusCompensation(Switch::Off)]);
    assert_eq!(reported(&units[1]), "#2 to X20 Y0 F100");
}

/// Everything that is not known is named where it stands.
#[test]
fn what_is_not_known_is_named() {
    for (text, column, message) in [
        ("N10 G01 X1 F1 T12X20", 15, "unknown word T12"),
        ("G54", 1, "unknown G function G54"),
        ("N1 X1 G0923", 7, "unknown G function G0923"),
        ("G01.5", 1, "unknown G function G01.5"),
        ("#HSC ON [BSPLINE]", 1, "unknown command #HSC ON"),
        (
            "N20  #MC_MovePath SYN [CH=1]",
            6,
            "unknown command #MC_MovePath SYN",
        ),
        (
            "#CHANNEL SET [PATH_DEV=1]",
            15,
            "unknown word in #CHANNEL SET: PATH_DEV",
        ),
        (
            "#CHANNEL SET [M_PRE_OUTPUT X=1]",
            28,
            "unknown word in #CHANNEL SET: X",
        ),
        ("#VECTOR LIMIT OFF [VEL]", 19, "unknown word [VEL]"),
        ("N40 $IF P1 == 1", 5, "unknown control statement $IF"),
        ("$ENDIF", 1, "unknown control statement $ENDIF"),
        ("XV.L.LOC_VAR5", 2, "unknown variable V.L.LOC_VAR5"),
        ("V.P.ARRAY_1[3][6] = 1", 1, "unknown variable V.P.ARRAY_1[3][6]"),
        ("P1=V.A.ABS.X", 4, "unknown variable V.A.ABS.X"),
        ("V.G.WZ_AKT.R=1", 1, "unknown variable V.G.WZ_AKT.R"),
        ("A1 = 0", 1, "unknown axis A1"),
        ("[LABEL_1] X0", 1, "unknown word [LABEL_1]"),
        ("N20: Y20", 1, "unknown word N20: (a label)"),
        ("/ X1", 1, "unknown word / (a block that may be skipped)"),
        ("X1 \\", 4, "unknown word \\ (a block of several lines)"),
        (
            "L CYCLE [NAME=test.nc @P1=3]",
            1,
            "unknown word L CYCLE (a cycle)",
        ),
        ("LL CYCLE[NAME=UP1]", 1, "unknown word LL CYCLE (a cycle)"),
        ("L sub.nc X1", 10, "unknown word X1 after L sub.nc"),
        ("foofoo X1", 1, "unknown word foofoo"),
        ("AP20", 1, "P20 has no value"),
        ("@P1=1", 1, "unknown word @P1"),
        ("X1 \"NAME\"", 4, "unknown macro \"NAME\""),
        ("P1=R1*2", 4, "unknown word R1"),
        ("P1=2 MOD 3", 6, "unknown word MOD"),
        ("P1=ATAN2[1]", 4, "ATAN needs its argument in [ ]"),
        ("S2=100", 1, "unknown word S2"),
        ("S[T1]", 3, "unknown word in the brackets of S: T1"),
        ("X[POS=1]", 3, "in the brackets of X INDP stands before this word"),
        ("X[INDP G02 POS=1]", 8, "unknown word in the brackets of X: G02"),
        ("E5", 1, "unknown word E5"),
        ("D1", 1, "unknown word D1"),
        (".....", 1, "unknown word ....."),
        ("EXIST[P1]", 1, "unknown word EXIST"),
    ] {
        let (_, at, reported) = refused(text);
        assert_eq!((at, reported.as_str()), (column, message), "{text}");
    }
}

#[test]
fn what_is_wrong_is_reported_where_it_stands() {
    for (text, column, message) in [
        ("G00 G01 X1", 5, "G01 beside G00: one of them counts in a block"),
        ("G01 X10", 5, "no feed F is programmed"),
        ("X1 X2", 4, "X stands twice in the block"),
        ("F0", 1, "F0 is not greater than 0"),
        ("X", 2, "a number is missing"),
        ("X Y1", 3, "unknown word Y1"),
        ("X1 Y[2", 5, "bracket [ is not closed"),
        ("X1.2.3", 2, "1.2.3 is no number"),
        ("X1/0", 1, "division by 0"),
        ("XSQRT[-1]", 1, "the expression has no value"),
        ("P1", 1, "a parameter that is given no value"),
        ("V.G.RW", 1, "a variable that is given no value"),
        ("V.G.RW=-1", 1, "V.G.RW takes no -1"),
        ("X1 I2", 4, "I, J, K and R belong to G02 and G03"),
        ("G02 X1 F1", 5, "G02 and G03 need I, J, K or R"),
        ("G02 X10 R2 F1", 9, "R=2 does not reach the end, 10.0000 mm away"),
        (
            "G02 X10 I4 F1",
            9,
            "the end lies 2.0000 mm beside the circle, whose radius is 4.0000 mm",
        ),
        ("G03 R5 F1", 5, "R describes no full circle"),
        ("G04", 1, "G04 needs its time"),
        ("G04 1 M5", 7, "G04 stands alone in its block"),
        ("G04 -1", 1, "the time of G04 is less than 0"),
        ("M5='16#1G'", 4, "'16#1G' is no number"),
        ("M5='16#1F", 4, "quote ' is not closed"),
        ("\"A\"=\"1", 5, "quote \" is not closed"),
        ("\"A\"=\"\\\"A\\\"\"", 0, ""),
        ("X[INDP G01 POS=1]", 1, "X[INDP] needs FEED"),
        ("X[INDP G00]", 1, "X[INDP] needs POS"),
        ("X[M5", 2, "bracket [ of X is not closed"),
        ("S[]", 2, "the brackets of S are empty"),
        ("L", 1, "L needs the name of a subroutine"),
        ("#VECTOR LIMIT ON", 1, "#VECTOR LIMIT ON needs its brackets [ ]"),
        ("#VECTOR LIMIT ON[VEL=0]", 1, "VEL=0 is not greater than 0"),
    ] {
        if message.is_empty() {
            // A macro in itself is only wrong where it is used.
            assert_eq!(
                refused(&format!("{text}\nX\"A\"")).2,
                "macro \"A\" is nested too deep"
            );
            continue;
        }
        let (_, at, reported) = refused(text);
        assert_eq!((at, reported.as_str()), (column, message), "{text}");
    }
}

#[test]
fn a_fault_ends_the_program() {
    let (units, fault) = run_with(
        "N10 X1\nN20 T1\nN30 X2",
        &mut Bench::default(),
        MemoryFiles::default(),
    );
    assert_eq!(reported_all(&units), ["N10 to X1 Y0 rapid"]);
    let fault = fault.expect("a fault");
    assert_eq!(
        (&*fault.place.block, fault.place.line, fault.length),
        ("N20", 2, 2)
    );
    // What a macro of a caller may end is judged as far as the macro.
    let text = b"#MSG[\"Text: %s\",@P1]\nL CYCLE [NAME=a.nc @P1 =\"S\"]\nX\"LATER\"\nT1 X\"LATER\"\nP1=[2*\"LATER\"]\n";
    let lines: Vec<(u32, u32, u32)> = Program::from_bytes("t.nc", text)
        .faults()
        .iter()
        .map(|fault| (fault.span.line, fault.span.column, fault.span.length))
        .collect();
    assert_eq!(lines, [(1, 1, 4), (2, 1, 7), (4, 1, 2)]);
    // The text has all of them.
    let program = Program::from_bytes("t.nc", b"N10 T1\nN20 X1\nN30 D2\n%L S\n%L S\n%L\nX\"LATER\"");
    let reported: Vec<(u32, String)> = program
        .faults()
        .into_iter()
        .map(|fault| (fault.span.line, fault.message))
        .collect();
    assert_eq!(
        reported,
        [
            (1, "unknown word T1".into()),
            (3, "unknown word D2".into()),
            (5, "subroutine S stands twice in the file".into()),
            (6, "%L needs the name of a subroutine".into()),
        ]
    );
}
