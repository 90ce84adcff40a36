//! The same part in plain language and in DIN/ISO has the same path, functions and feeds, so the same time.

use crate::support::*;

/// A program in ISO from its blocks.
fn iso(blocks: &str) -> String {
    let lines = blocks.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut text = "%TEST G71 *\n".to_owned();
    for (number, line) in (1..).zip(lines) {
        text.push_str(&format!("N{} {line} *\n", number * 10));
    }
    text + "N99999 %TEST G71 *\n"
}

/// All that moves and switches, without the blocks that it comes from, which are fewer in ISO.
fn reported(run: &Run) -> Vec<String> {
    let nameless = |element: &bahn_path::PathElement| {
        let mut element = element.clone();
        element.block = bahn_path::BlockRef::default();
        element.sequence = 0;
        format!("{element:?}")
    };
    run.elements.iter().map(nameless).collect()
}

const FRAME: &str = "\
    BLK FORM 0.1 Z X+0 Y+0 Z-20
    BLK FORM 0.2 X+100 Y+100 Z+0
    TOOL DEF 1 L+0 R+5
    TOOL CALL 1 Z S1000
    L Z+50 R0 FMAX M3
    L X-20 Y-20 FMAX
    L Z-5 F200
";

const ISO_FRAME: &str = "\
    G30 G17 X+0 Y+0 Z-20
    G31 G90 X+100 Y+100 Z+0
    G99 T1 L+0 R+5
    T1 G17 S1000
    G00 G40 G90 Z+50 M3
    X-20 Y-20
    G01 Z-5 F200
";

#[track_caller]
fn same(plain: &str, blocks: &str) {
    let settings = |job: Job| job.with(|settings| settings.model = bahn_parameters::ControlModel::Tnc415b);
    let plain = settings(Job::new(program(&format!("{FRAME}{plain}")))).run();
    let iso = settings(Job::iso(iso(&format!("{ISO_FRAME}{blocks}")))).run();
    plain.assert_completed();
    iso.assert_completed();
    let (expected, found) = (reported(&plain), reported(&iso));
    assert!(expected.len() > 3);
    for (at, (expected, found)) in expected.iter().zip(&found).enumerate() {
        assert_eq!(found, expected, "element {at}");
    }
    assert_eq!(found.len(), expected.len());
}

#[test]
fn a_compensated_contour_with_chamfer_rounding_and_soft_approach() {
    same(
        "L X+10 Y+10 RL F250
         RND R4 F80
         L Y+80
         CHF 6
         L X+60
         RND R8
         L Y+40
         L IX+20 IY-20
         L X+10 Y+10
         RND R4
         L X-20 Y-20 R0 FMAX M9",
        "G41 X+10 Y+10 F250
         G26 R4 F80
         Y+80
         G24 R6
         X+60
         G25 R+8
         Y+40
         G91 X+20 Y-20
         G90 X+10 Y+10
         G27 R4
         G00 G40 X-20 Y-20 M9",
    );
}

#[test]
fn arcs_of_every_kind() {
    same(
        "L X+0 Y+0 R0
         CC X+20 Y+0
         C X+40 Y+0 DR-
         C X+0 Y+0 DR-
         CR X+20 Y+20 R+20 DR-
         CR X+40 Y+40 R-30 DR+
         CR X+60 Y+60 R+30 DR+
         L X+80 Y+60
         CT X+100 Y+80
         L IX+5",
        "G01 G40 X+0 Y+0
         I+20 J+0
         G02 X+40 Y+0
         X+0
         X+20 Y+20 R+20
         G03 X+40 Y+40 R-30
         G05 X+60 Y+60 R+30
         G01 X+80 Y+60
         G06 X+100 Y+80
         G01 G91 X+5",
    );
}

#[test]
fn a_centre_stands_in_the_block_of_its_arc() {
    same(
        "L X+0 Y+0
         CC IX+20 IY+0
         C X+40 Y+0 DR+
         L X+0 Y+10",
        "X+0 Y+0
         G91 I+20 J+0 G90 G03 X+40 Y+0
         G01 X+0 Y+10",
    );
}

#[test]
fn polar_functions_and_a_helix() {
    same(
        "CC X+50 Y+50
         LP PR+30 PA+0 RR F300
         LP PA+60
         LP IPA+60
         CP PA+270 DR+
         CTP PR+30 PA+330
         LP PR+40 PA+10 R0 FMAX
         LP PR+30 PA+0 F100
         CP IPA-720 IZ-4 DR-
         L Z+50 FMAX
         CC
         LP PR+5 PA+90 FMAX",
        "I+50 J+50
         G11 G42 R+30 H+0 F300
         H+60
         G91 H+60
         G90 G13 H+270
         G16 R+30 H+330
         G10 G40 R+40 H+10
         G11 R+30 H+0 F100
         G91 G12 H-720 Z-4
         G90 G00 Z+50
         G29
         G10 R+5 H+90",
    );
}

#[test]
fn paraxial_blocks() {
    same(
        "X+20 R+ F100
         Y+30 R-
         X+0 R0",
        "G07 X+20 G43 F100
         Y+30 G44
         G40 X+0",
    );
}

/// F counts in the block of rapid traverse from the next one on; G90 and G91 act on the words after them, and the last
/// one stays.
#[test]
fn functions_stay_in_force() {
    same(
        "L X+10 Y+20 R0 FMAX M8
         L X+30 F250
         L X+60 IY-10
         L IX+5 IY+5
         L Z+2 FMAX",
        "G00 G40 G90 X+10 Y+20 F250 M8
         G01 X+30
         G90 X+60 G91 Y-10
         X+5 Y+5
         G90 G00 Z+2",
    );
}

#[test]
fn every_drilling_and_milling_cycle() {
    same(
        "CYCL DEF 1.0 PECKING
         CYCL DEF 1.1 SET UP -2
         CYCL DEF 1.2 DEPTH -20
         CYCL DEF 1.3 PECKG -5
         CYCL DEF 1.4 DWELL 0.5
         CYCL DEF 1.5 F80
         L X+20 Y+20 FMAX M99
         CYCL DEF 2.0 TAPPING
         CYCL DEF 2.1 SET UP -2
         CYCL DEF 2.2 DEPTH -20
         CYCL DEF 2.3 DWELL 0
         CYCL DEF 2.4 F1000
         CYCL CALL
         CYCL DEF 17.0 RIGID TAPPING
         CYCL DEF 17.1 SET UP -2
         CYCL DEF 17.2 DEPTH -20
         CYCL DEF 17.3 PITCH +0.75
         CYCL CALL M3
         CYCL DEF 3.0 SLOT
         CYCL DEF 3.1 SET UP -2
         CYCL DEF 3.2 DEPTH -15
         CYCL DEF 3.3 PECKG -5 F80
         CYCL DEF 3.4 X-50
         CYCL DEF 3.5 Y+15
         CYCL DEF 3.6 F120
         CYCL CALL
         CYCL DEF 4.0 POCKET
         CYCL DEF 4.1 SET UP -2
         CYCL DEF 4.2 DEPTH -10
         CYCL DEF 4.3 PECKG -4 F80
         CYCL DEF 4.4 X+80
         CYCL DEF 4.5 Y+40
         CYCL DEF 4.6 F100 DR- RADIUS 7
         CYCL CALL
         CYCL DEF 4.0 POCKET
         CYCL DEF 4.1 SET UP -2
         CYCL DEF 4.2 DEPTH -10
         CYCL DEF 4.3 PECKG -4 F80
         CYCL DEF 4.4 X+80
         CYCL DEF 4.5 Y+40
         CYCL DEF 4.6 F100 DR+
         CYCL CALL
         CYCL DEF 5.0 CIRCULAR POCKET
         CYCL DEF 5.1 SET UP -2
         CYCL DEF 5.2 DEPTH -12
         CYCL DEF 5.3 PECKG -6 F80
         CYCL DEF 5.4 RADIUS 35
         CYCL DEF 5.5 F100 DR-
         CYCL CALL
         CYCL DEF 5.0 CIRCULAR POCKET
         CYCL DEF 5.1 SET UP -2
         CYCL DEF 5.2 DEPTH -12
         CYCL DEF 5.3 PECKG -6 F80
         CYCL DEF 5.4 RADIUS 35
         CYCL DEF 5.5 F100 DR+
         L IX+1 FMAX M89
         L IX+1 FMAX
         L IX+1 FMAX M99",
        "G83 P01 -2 P02 -20 P03 -5 P04 0.5 P05 80
         G00 X+20 Y+20 M99
         G84 P01 -2 P02 -20 P03 0 P04 1000
         G79
         G85 P01 -2 P02 -20 P03 +0.75
         G79 M3
         G74 P01 -2 P02 -15 P03 -5 P04 80 P05 X-50 P06 Y+15 P07 120
         G79
         G75 P01 -2 P02 -10 P03 -4 P04 80 P05 X+80 P06 Y+40 P07 100 P08 7
         G79
         G76 P01 -2 P02 -10 P03 -4 P04 80 P05 X+80 P06 Y+40 P07 100
         G79
         G77 P01 -2 P02 -12 P03 -6 P04 80 P05 35 P06 100
         G79
         G78 P1-2 P2-12 P3-6 P4 80 P5 35 P6 100
         G91 X+1 M89
         X+1
         X+1 M99",
    );
}

#[test]
fn transformations_dwell_orientation_and_their_cancelling() {
    same(
        "CYCL DEF 7.0 DATUM SHIFT
         CYCL DEF 7.1 X+40
         CYCL DEF 7.2 Y+60
         L X+5 Y+5
         CYCL DEF 7.0 DATUM SHIFT
         CYCL DEF 7.1 IX+10
         L X+5 Y+5
         CYCL DEF 8.0 MIRROR IMAGE
         CYCL DEF 8.1 X
         L X+5 Y+6
         CYCL DEF 8.0 MIRROR IMAGE
         CYCL DEF 8.1
         CYCL DEF 10.0 ROTATION
         CYCL DEF 10.1 ROT+35
         L X+5 Y+7
         CYCL DEF 10.0 ROTATION
         CYCL DEF 10.1 IROT+10
         L X+5 Y+8
         CYCL DEF 11.0 SCALING
         CYCL DEF 11.1 SCL 0.8
         L X+5 Y+9
         CYCL DEF 9.0 DWELL TIME
         CYCL DEF 9.1 DWELL 2.5
         CYCL DEF 13.0 ORIENTATION
         CYCL DEF 13.1 ANGLE 90
         L X+6 M19",
        "G54 X+40 Y+60
         X+5 Y+5
         G54 G91 X+10
         G90 X+5 Y+5
         G28 X
         X+5 Y+6
         G28
         G73 H+35
         X+5 Y+7
         G73 G91 H+10
         G90 X+5 Y+8
         G72 F0.8
         X+5 Y+9
         G04 F2.5
         G36 S90
         X+6 M19",
    );
}

/// G04 F5 is five seconds, G72 F a factor, and G36 S an angle: the feed and the speed stay.
#[test]
fn f_and_s_of_some_cycles_set_no_feed_and_no_speed() {
    same(
        "L X+1 F333
         CYCL DEF 9.0 DWELL TIME
         CYCL DEF 9.1 DWELL 5
         CYCL DEF 11.0 SCALING
         CYCL DEF 11.1 SCL 1.5
         CYCL DEF 13.0 ORIENTATION
         CYCL DEF 13.1 ANGLE 45
         L X+2 M3",
        "X+1 F333
         G04 F5
         G72 F1.5
         G36 S45
         X+2 M3",
    );
}

#[test]
fn labels_jumps_and_parameters() {
    same(
        "FN 0: Q5 = +60
         FN 1: Q6 = +Q5 + -20
         FN 2: Q7 = +Q5 - +2
         FN 3: Q8 = +3 * +2
         FN 4: Q9 = +Q5 DIV +4
         FN 5: Q10 = SQRT +16
         FN 6: Q11 = SIN +30
         FN 7: Q12 = COS +60
         FN 8: Q13 = +3 LEN +4
         FN 13: Q14 = +1 ANG +1
         Q15 = SIN 30 + 2 * Q8
         L X+Q6 Y-Q7 FQ5
         L X+Q8 Y+Q9
         L X+Q10 Y+Q11
         L X+Q12 Y+Q13
         L X+Q14 Y+Q15
         LBL 2
         L IX+5 IY+1
         CALL LBL 2 REP 3/3
         CALL LBL 7
         FN 1: Q1 = +Q1 + +1
         FN 12: IF +Q1 LT +3 GOTO LBL 2
         FN 9: IF +Q1 EQU +3 GOTO LBL 9
         L X+99
         LBL 9
         FN 10: IF +1 NE +2 GOTO LBL 10
         L X+98
         LBL 10
         FN 11: IF +2 GT +1 GOTO LBL 11
         L X+97
         LBL 11
         FN 19: PLC = +10/+Q3
         FN 15: PRINT 1/Q1
         STOP M9
         L X+0 M2
         LBL 7
         L Y+3
         LBL 0",
        "D00 Q05 P01 +60
         D01 Q6 P01 +Q5 P02 -20
         D02 Q7 P01 +Q5 P02 +2
         D03 Q8 P01 +3 P02 +2
         D04 Q9 P01 +Q5 P02 +4
         D05 Q10 P01 +16
         D06 Q11 P01 +30
         D07 Q12 P01 +60
         D08 Q13 P01 +3 P02 +4
         D13 Q14 P01 +1 P02 +1
         Q15 = SIN 30 + 2 * Q8
         X+Q6 Y-Q7 FQ5
         X+Q8 Y+Q9
         X+Q10 Y+Q11
         X+Q12 Y+Q13
         X+Q14 Y+Q15
         G98 L2
         G91 X+5 Y+1
         L2,3
         L7,0
         D01 Q1 P01 +Q1 P02 +1
         D12 P01 +Q1 P02 +3 P03 2
         D09 P01 +Q1 P02 +3 P03 9
         G90 X+99
         G98 L9
         D10 P01 +1 P02 +2 P03 10
         G90 X+98
         G98 L10
         D11 P01 +2 P02 +1 P03 11
         X+97
         G98 L11
         D19 P01 +10 P02 +Q3
         D15 P01 1 P02 Q1
         G38 M9
         G90 X+0 M2
         G98 L7
         G90 Y+3
         G98 L0",
    );
}

#[test]
fn contours_of_subprograms() {
    for (cycle, function) in [
        (
            "CYCL DEF 6.0 ROUGH-OUT
             CYCL DEF 6.1 SET UP -2 DEPTH -15
             CYCL DEF 6.2 PECKG -8 F100 ALLOW +0.5
             CYCL DEF 6.3 ANGLE +30 F500",
            "G57 P01 -2 P02 -15 P03 -8 P04 100 P05 +0.5 P06 +30 P07 500",
        ),
        (
            "CYCL DEF 15.0 PILOT DRILLING
             CYCL DEF 15.1 SET UP -2 DEPTH -15
             CYCL DEF 15.2 PECKG -5 F100 ALLOW +2",
            "G56 P01 -2 P02 -15 P03 -5 P04 100 P05 +2",
        ),
        (
            "CYCL DEF 16.0 CONTOUR MILLING
             CYCL DEF 16.1 SET UP -2 DEPTH -15
             CYCL DEF 16.2 PECKG -5 F100 DR- F500",
            "G58 P01 -2 P02 -15 P03 -5 P04 100 P05 500",
        ),
        (
            "CYCL DEF 16.0 CONTOUR MILLING
             CYCL DEF 16.1 SET UP -2 DEPTH -15
             CYCL DEF 16.2 PECKG -5 F100 DR+ F500",
            "G59 P01 -2 P02 -15 P03 -5 P04 100 P05 500",
        ),
    ] {
        same(
            &format!(
                "L Z+2 FMAX
                 CYCL DEF 14.0 CONTOUR GEOMETRY
                 CYCL DEF 14.1 CONTOUR LABEL 1/2
                 {cycle}
                 CYCL CALL M3
                 L Z+50 FMAX M2
                 LBL 1
                 L X+10 Y+10 RR
                 L Y+90
                 L X+90
                 RND R10
                 L Y+10
                 L X+10
                 LBL 0
                 LBL 2
                 CC X+50 Y+50
                 L X+60 Y+50 RL
                 CP IPA+360 DR-
                 LBL 0"
            )
            .replace("IPA+360 DR-", "IPA-360 DR-"),
            &format!(
                "G00 Z+2
                 G37 P01 1 P02 2
                 {function}
                 G79 M3
                 Z+50 M2
                 G98 L1
                 G01 G42 X+10 Y+10
                 Y+90
                 X+90
                 G25 R10
                 Y+10
                 X+10
                 G98 L0
                 G98 L2
                 I+50 J+50
                 G41 X+60 Y+50
                 G91 G12 H-360
                 G90
                 G98 L0"
            ),
        );
    }
}

#[test]
fn programs_call_each_other_across_languages() {
    let frame = |blocks: &str| program(&format!("{FRAME}{blocks}"));
    let called = program("L IX+5\nL IY+5");
    let expected = Job::new(frame("CALL PGM SUB\nL X+0\nCALL PGM SUB"))
        .library("SUB", called.clone())
        .run();
    expected.assert_completed();
    let iso_called = iso("G91 G01 X+5\nY+5\nG90");
    let plain_calls = Job::new(frame("CALL PGM SUB.I\nL X+0\nCALL PGM SUB.I"))
        .library("SUB.I", iso_called)
        .run();
    let as_cycle = Job::iso(iso(&format!("{ISO_FRAME}%SUB\nX+0\nG39 P01 SUB\nG79")))
        .library("SUB", called)
        .run();
    for run in [plain_calls, as_cycle] {
        run.assert_completed();
        assert_eq!(reported(&run), reported(&expected));
    }
}

#[test]
fn a_probe_measures() {
    let plain = "TCH PROBE 0.0 REF. PLANE Q10 X-\nTCH PROBE 0.1 X+5 Y+0 Z-5\nL X+Q10";
    let blocks = "G55 P01 10 P02 X- P03 X+5 P04 Y+0 P05 Z-5\nX+Q10";
    let expected = Job::new(program(&format!("{FRAME}{plain}")))
        .surfaces(&[4.25])
        .run();
    let found = Job::iso(iso(&format!("{ISO_FRAME}{blocks}")))
        .surfaces(&[4.25])
        .run();
    expected.assert_completed();
    found.assert_completed();
    assert_eq!(reported(&found), reported(&expected));
    assert_eq!(found.q[10], expected.q[10]);
}

/// A block of DIN/ISO has 150 characters at most [000:615], 64 on the TNC 151/155 [001:1174-1183]; a longer one ends the run as
/// `check` says.
#[test]
fn a_block_that_is_too_long_ends_the_run() {
    use bahn_parameters::{ControlModel, MessageId};
    for (model, max) in [(ControlModel::Tnc155, 64), (ControlModel::Tnc415b, 150)] {
        for (length, message) in [(max, None), (max + 1, Some(MessageId::EntryValueIncorrect))] {
            let block = format!("N10 G00 G40 G90 X+5 ;{}", "x".repeat(length - 21));
            let text = format!("%7 G71 *\n{block}\nN99999 %7 G71 *\n");
            let run = Job::iso(text).with(|settings| settings.model = model).run();
            let found = run
                .error
                .as_ref()
                .map(|error| (error.block.block, error.message.text(model)));
            assert_eq!(found, message.map(|message| (1, message.text(model))), "{length}");
        }
    }
}
