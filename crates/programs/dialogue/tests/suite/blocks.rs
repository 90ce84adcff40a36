//! Every block and cycle by dialogue: keys in, block out, with the prompts in their order.

use crate::desk::Desk;
use bahn_dialogue::{Key, Reaction};
use bahn_parameters::{ControlModel, MessageId};

/// The block that keys give on a control.
fn block_on(model: ControlModel, keys: &str) -> String {
    let mut desk = Desk::with("", model);
    desk.enter(keys);
    desk.blocks().join("\n")
}

fn block(keys: &str) -> String {
    block_on(ControlModel::Tnc360, keys)
}

/// The prompts that keys lead through; an ENT, NO_ENT or END asks for the next.
fn prompts(keys: &str) -> Vec<String> {
    let mut desk = Desk::new();
    let mut prompts = Vec::new();
    for key in keys.split_whitespace() {
        desk.enter(key);
        let prompt = desk.prompt();
        if !prompt.is_empty() && prompts.last() != Some(&prompt) {
            prompts.push(prompt);
        }
    }
    prompts
}

#[test]
fn positioning_blocks() {
    for (keys, text) in [
        (
            "L X 10 Y -5.5 ENT RL ENT 200 ENT 3 ENT",
            "L X+10 Y-5.5 RL F200 M3",
        ),
        ("L X 10 Y 5 END", "L X+10 Y+5"),
        ("L I X 10 Y 5 I ENT ENT ENT NO_ENT", "L IX+10 IY+5 R0 FMAX"),
        ("L Z 2 ENT NO_ENT NO_ENT 99 ENT", "L Z+2 M99"),
        ("L NO_ENT NO_ENT NO_ENT 99 ENT", "L M99"),
        ("L X Q 1 Y SIGN Q 12 ENT RR ENT Q 5 END", "L X+Q1 Y-Q12 RR FQ5"),
        ("L X 10 SIGN SIGN SIGN END", "L X-10"),
        ("L 5 ENT", "L5"),
        ("CHF 2.5 ENT", "L2.5"),
        ("RND 10 ENT 100 ENT", "RND R10 F100"),
        ("RND 10 END", "RND R10"),
        ("CC X 50 I Y 20 ENT", "CC X+50 IY+20"),
        ("CC NO_ENT", "CC"),
        ("C X 10 Y 5 ENT ENT RL ENT NO_ENT NO_ENT", "C X+10 Y+5 DR- RL"),
        ("C X 10 Y 5 ENT SIGN END", "C X+10 Y+5 DR+"),
        ("C X 10 Y 5 ENT SIGN SIGN END", "C X+10 Y+5 DR-"),
        ("C X 10 Y 5 ENT SK1 END", "C X+10 Y+5 DR+"),
        ("C X 10 Y 5 I Z -2 ENT ENT END", "C X+10 Y+5 IZ-2 DR-"),
        ("CR X 10 Y 2 ENT -5 ENT SK2 ENT END", "CR X+10 Y+2 R-5 DR-"),
        ("CT X 50 Y 50 ENT ENT END", "CT X+50 Y+50 R0"),
        ("L P 50 ENT I 30 ENT RR ENT END", "LP PR+50 IPA+30 RR"),
        ("L P NO_ENT 30 ENT END", "LP PA+30"),
        ("L P P X 1 END", "L X+1"),
        (
            "C P 1080 I ENT I Z 5 ENT SK1 ENT RL END",
            "CP IPA+1080 IZ+5 DR+ RL",
        ),
        ("CT P 30 ENT 60 ENT END", "CTP PR+30 PA+60"),
        ("X 46 ENT R_PLUS ENT 100 ENT NO_ENT", "X+46 R+ F100"),
        ("IV 90 ENT ENT NO_ENT NO_ENT", "C+90 R0"),
        ("STOP 6 ENT", "STOP M6"),
        ("STOP NO_ENT", "STOP"),
        ("M 8 ENT", "M8"),
        ("M SK3 ENT", "M3"),
    ] {
        assert_eq!(block(keys), text, "{keys}");
    }
}

#[test]
fn tools_labels_and_programs() {
    for (keys, text) in [
        ("TOOL_DEF 5 ENT 10 ENT 2.5 ENT", "TOOL DEF 5 L+10 R+2.5"),
        ("TOOL_DEF 5 END", "TOOL DEF 5"),
        ("TOOL_CALL 5 ENT Z ENT 500 ENT", "TOOL CALL 5 Z S500"),
        ("TOOL_CALL NO_ENT NO_ENT 1000 ENT", "TOOL CALL S1000"),
        ("TOOL_CALL 0 ENT Z END", "TOOL CALL 0 Z"),
        ("LBL_SET 5 ENT", "LBL 5"),
        ("LBL_SET 0 END", "LBL 0"),
        ("LBL_CALL 7 ENT 10 ENT", "CALL LBL 7 REP 10/10"),
        ("LBL_CALL 7 ENT NO_ENT", "CALL LBL 7"),
        ("LBL_CALL 7 END", "CALL LBL 7"),
        ("LBL_CALL 7 ENT Q 4 END", "CALL LBL 7 REP Q4/Q4"),
        ("PGM_CALL 12 ENT", "CALL PGM 12"),
        ("PGM_CALL P A L 1 ENT", "CALL PGM PAL1"),
        ("CYCL_CALL 3 ENT", "CYCL CALL M3"),
        ("CYCL_CALL NO_ENT", "CYCL CALL"),
        (
            "BLK_FORM Z ENT X 0 Y 0 Z -20 ENT X 100 I Y 100 Z 0 ENT",
            "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 IY+100 Z+0",
        ),
    ] {
        assert_eq!(block(keys), text, "{keys}");
    }
}

#[test]
fn functions_of_q_parameters() {
    for (keys, text) in [
        ("Q ENT 5 ENT 60 ENT", "FN0: Q5 = +60"),
        ("Q 1 ENT 1 ENT SIGN Q 2 ENT -5 ENT", "FN1: Q1 = -Q2 + -5"),
        ("Q GOTO 2 ENT 1 ENT 10 ENT 5 ENT", "FN2: Q1 = +10 - +5"),
        ("Q 3 ENT 2 ENT 3 ENT 3 ENT", "FN3: Q2 = +3 * +3"),
        ("Q 4 ENT 4 ENT 8 ENT Q 2 ENT", "FN4: Q4 = +8 DIV +Q2"),
        ("Q 5 ENT 20 ENT 4 ENT", "FN5: Q20 = SQRT +4"),
        ("Q 6 ENT 20 ENT SIGN Q 5 ENT", "FN6: Q20 = SIN -Q5"),
        ("Q 7 ENT 21 ENT SIGN Q 5 ENT", "FN7: Q21 = COS -Q5"),
        ("Q 8 ENT 10 ENT 5 ENT 4 ENT", "FN8: Q10 = +5 LEN +4"),
        ("Q 9 ENT Q 1 ENT Q 3 ENT 5 ENT", "FN9: IF +Q1 EQU +Q3 GOTO LBL 5"),
        ("Q 10 ENT 1 ENT Q 3 ENT 5 ENT", "FN10: IF +1 NE +Q3 GOTO LBL 5"),
        ("Q 11 ENT Q 1 ENT 10 ENT 5 ENT", "FN11: IF +Q1 GT +10 GOTO LBL 5"),
        ("Q 12 ENT Q 1 ENT 10 ENT 5 ENT", "FN12: IF +Q1 LT +10 GOTO LBL 5"),
        ("Q 13 ENT 20 ENT 10 ENT SIGN Q 1 ENT", "FN13: Q20 = +10 ANG -Q1"),
        ("Q 14 ENT 254 ENT", "FN14: ERROR = 254"),
        ("Q 15 ENT 1 ENT Q 1 ENT 2 END", "FN15: PRINT 1/Q1/2"),
        ("Q 19 ENT 10 ENT Q 3 ENT", "FN19: PLC = +10/+Q3"),
        ("Q 19 ENT 10 ENT NO_ENT", "FN19: PLC = +10"),
        ("Q DOWN DOWN ENT 1 ENT 10 ENT 5 ENT", "FN2: Q1 = +10 - +5"),
    ] {
        assert_eq!(block(keys), text, "{keys}");
    }
    let mut desk = Desk::with("", ControlModel::Tnc415b);
    desk.enter("Q");
    let lines = desk.editor.view(0, 0).list.unwrap().lines;
    desk.enter(&"DOWN ".repeat(lines.len()));
    desk.enter("ENT 1 ENT");
    desk.editor.type_text("sin 30 + sqrt q2");
    desk.enter("ENT");
    assert_eq!(desk.blocks(), ["Q1 = SIN 30 + SQRT Q2"]);
}

#[test]
fn every_cycle_block_by_block() {
    for (keys, text) in [
        (
            "1 ENT -2 ENT -15 ENT -10 ENT 0 ENT 80 ENT",
            "1.0 PECKING|1.1 SET UP -2|1.2 DEPTH -15|1.3 PECKG -10|1.4 DWELL 0|1.5 F80",
        ),
        (
            "2 ENT -2 ENT -15 ENT .5 ENT 100 ENT",
            "2.0 TAPPING|2.1 SET UP -2|2.2 DEPTH -15|2.3 DWELL 0.5|2.4 F100",
        ),
        (
            "3 ENT -2 ENT -15 ENT -5 ENT 80 ENT X -50 ENT Y 10 ENT 120 ENT",
            "3.0 SLOT MILLING|3.1 SET UP -2|3.2 DEPTH -15|3.3 PECKG -5 F80|3.4 X-50|3.5 Y+10|3.6 F120",
        ),
        (
            "4 ENT -2 ENT -10 ENT -4 ENT 80 ENT X 80 ENT Y 40 ENT 100 ENT SK1 ENT 0 ENT",
            "4.0 POCKET MILLING|4.1 SET UP -2|4.2 DEPTH -10|4.3 PECKG -4 F80|4.4 X+80|4.5 Y+40|4.6 F100 DR+ RADIUS 0",
        ),
        (
            "5 ENT -2 ENT -12 ENT -6 ENT 80 ENT 35 ENT 100 ENT ENT",
            "5.0 CIRCULAR POCKET|5.1 SET UP -2|5.2 DEPTH -12|5.3 PECKG -6 F80|5.4 RADIUS 35|5.5 F100 DR-",
        ),
        (
            "6 ENT -2 ENT -15 ENT -8 ENT 100 ENT 0 ENT 0 ENT 500 ENT",
            "6.0 ROUGH-OUT|6.1 SET UP -2 DEPTH -15|6.2 PECKG -8 F100 ALLOW +0|6.3 ANGLE +0 F500",
        ),
        (
            "7 ENT X 40 ENT I Y 60 ENT NO_ENT",
            "7.0 DATUM SHIFT|7.1 X+40|7.2 IY+60",
        ),
        ("7 ENT X 0 END", "7.0 DATUM SHIFT|7.1 X+0"),
        ("8 ENT X Y ENT", "8.0 MIRROR IMAGE|8.1 X Y"),
        ("8 ENT NO_ENT", "8.0 MIRROR IMAGE|8.1"),
        ("9 ENT 2.5 ENT", "9.0 DWELL TIME|9.1 DWELL 2.5"),
        ("10 ENT 35 ENT", "10.0 ROTATION|10.1 ROT+35"),
        ("10 ENT 35 I ENT", "10.0 ROTATION|10.1 IROT+35"),
        ("11 ENT .8 ENT", "11.0 SCALING|11.1 SCL 0.8"),
        ("12 ENT 50 ENT", "12.0 PGM CALL|12.1 PGM 50"),
        ("13 ENT 90.1 ENT", "13.0 ORIENTATION|13.1 ANGLE 90.1"),
        (
            "14 ENT 1 ENT 2 ENT 3 ENT ENT",
            "14.0 CONTOUR GEOMETRY|14.1 CONTOUR LABEL 1/2/3",
        ),
        (
            "15 ENT -2 ENT -10 ENT -5 ENT 500 ENT 2.8 ENT",
            "15.0 PILOT DRILLING|15.1 SET UP -2 DEPTH -10|15.2 PECKG -5 F500 ALLOW +2.8",
        ),
        (
            "16 ENT -2 ENT -10 ENT -5 ENT 100 ENT ENT 500 ENT",
            "16.0 CONTOUR MILLING|16.1 SET UP -2 DEPTH -10|16.2 PECKG -5 F100 DR- F500",
        ),
        (
            "17 ENT -2 ENT -30 ENT .75 ENT",
            "17.0 RIGID TAPPING|17.1 SET UP -2|17.2 DEPTH -30|17.3 PITCH +0.75",
        ),
        ("68 ENT Q 1 SK3 SK2 8 ENT NO_ENT", "68.0|68.1 Q1=+8"),
    ] {
        let wanted: Vec<String> = text.split('|').map(|line| format!("CYCL DEF {line}")).collect();
        assert_eq!(block(&format!("CYCL_DEF {keys}")), wanted.join("\n"), "{keys}");
    }
    for (keys, text) in [
        (
            "18 ENT -30 ENT 1.5 ENT",
            "18.0 THREAD CUTTING|18.1 DEPTH -30|18.2 PITCH +1.5",
        ),
        ("19 ENT C 30 ENT", "19.0 WORKING PLANE|19.1 C+30"),
        ("19 ENT NO_ENT", "19.0 WORKING PLANE|19.1"),
        (
            "26 ENT X 1.4 Y .6 ENT X 15 Y 20 ENT",
            "26.0 AXIS-SPEC. SCALING|26.1 X1.4 Y0.6 CCX+15 CCY+20",
        ),
    ] {
        let wanted: Vec<String> = text.split('|').map(|line| format!("CYCL DEF {line}")).collect();
        let keys = format!("CYCL_DEF {keys}");
        assert_eq!(
            block_on(ControlModel::Tnc415b, &keys),
            wanted.join("\n"),
            "{keys}"
        );
    }
}

#[test]
fn probe_functions() {
    for (keys, text) in [
        (
            "0 ENT 5 ENT X SIGN ENT X 5 Y 0 Z -5 ENT",
            "0.0 REF. PLANE Q5 X-|0.1 X+5 Y+0 Z-5",
        ),
        (
            "5 ENT 5007 ENT Z ENT X 0 Y 0 Z 0 ENT X 10 Y 10 Z 20 ENT 100 ENT",
            "5.0 RANGE|5.1 PGM NAME: 5007|5.2 Z X+0 Y+0 Z+0|5.3 X+10 Y+10 Z+20|5.4 HEIGHT: +100",
        ),
        // X, Y and Z of both corners in sequence, without their keys [003:6609-6624].
        (
            "5 ENT 5007 ENT Z ENT 0 ENT 0 ENT 0 ENT 10 ENT 10 ENT 20 ENT 100 ENT",
            "5.0 RANGE|5.1 PGM NAME: 5007|5.2 Z X+0 Y+0 Z+0|5.3 X+10 Y+10 Z+20|5.4 HEIGHT: +100",
        ),
        (
            "6 ENT X ENT .5 ENT .2 ENT .8 ENT",
            "6.0 MEANDER|6.1 DIRECTN: X|6.2 TRAVEL: 0.5 L.SPAC: 0.2 P.P. INT: 0.8",
        ),
        (
            "7 ENT 200 ENT X 50 Y 0 ENT Y SIGN ENT X ENT .5 ENT -1 ENT .2 ENT",
            "7.0 CONTOUR LINES|7.1 TIME: 200 X+50 Y+0|7.2 ORDER Y-/X+|7.3 TRAVEL: 0.5 L.SPAC: -1 P.P. INT: 0.2",
        ),
    ] {
        let wanted: Vec<String> = text.split('|').map(|line| format!("TCH PROBE {line}")).collect();
        assert_eq!(block(&format!("TOUCH_PROBE {keys}")), wanted.join("\n"), "{keys}");
    }
}

/// The corners of a blank are asked like those of a range; a key of an axis goes before the sequence.
#[test]
fn corners_of_a_blank_are_entered_in_sequence() {
    let wanted = "BLK FORM 0.1 Z X+0 Y+5 Z-40\nBLK FORM 0.2 X+100 Y+100 IZ+40";
    for corners in [
        "0 ENT 5 ENT -40 ENT 100 ENT 100 ENT I 40 ENT",
        "X 0 Y 5 Z -40 ENT X 100 Y 100 I Z 40 ENT",
    ] {
        assert_eq!(block(&format!("BLK_FORM Z ENT {corners}")), wanted, "{corners}");
    }
}

#[test]
fn prompts_come_in_the_order_of_the_manual() {
    let (coordinates, side) = ("COORDINATES?", "TOOL RADIUS COMP.: RL/RR/NO COMP.?");
    let (feed, m) = ("FEED RATE F = ? / F MAX = ENT", "MISCELLANEOUS FUNCTION M?");
    let turn = "ROTATION CLOCKWISE: DR-?";
    assert_eq!(prompts("L X 1 ENT ENT ENT"), [coordinates, side, feed, m]);
    assert_eq!(
        prompts("CR X 1 Y 1 ENT 5 ENT ENT ENT ENT"),
        [coordinates, "CIRCLE RADIUS (SIGN)?", turn, side, feed, m]
    );
    let polar = ["POLAR COORDINATES RADIUS PR?", "POLAR COORDINATES ANGLE PA?"];
    assert_eq!(prompts("L P 5 ENT 5 ENT")[1..], [polar[0], polar[1], side]);
    assert_eq!(prompts("PGM_CALL"), ["PROGRAM NUMBER?"]);
    assert_eq!(
        prompts("CYCL_DEF 17 ENT -2 ENT -30 ENT").last(),
        Some(&"THREAD PITCH?".to_owned())
    );
    let digitizing = prompts("TOUCH_PROBE 7 ENT 1 ENT X 1 ENT X ENT Y ENT 1 ENT 1 ENT");
    assert_eq!(
        digitizing[digitizing.len() - 5..],
        [
            "AXIS AND DIRECTION OF APPROACH?",
            "STARTING PROBE AXIS AND DIRECTN?",
            "LIMIT IN NORMAL LINES DIRECTION?",
            "LINE SPACING AND DIRECTION?",
            "MAX. PROBE POINT INTERVAL?"
        ]
    );
}

#[test]
fn a_line_of_text_is_a_block() {
    let mut desk = Desk::new();
    desk.enter("SK8");
    desk.editor.type_text("l x5 y-3,5 r0 fmax m3");
    desk.enter("ENT");
    desk.enter("B L K");
    desk.editor.type_text(" form 0.1 z x+0 y+0 z-5");
    desk.enter("END");
    assert_eq!(
        desk.blocks(),
        ["L X+5 Y-3.5 R0 FMAX M3", "BLK FORM 0.1 Z X+0 Y+0 Z-5"]
    );
}

/// What cannot be meant is refused when it is entered: tool 0 has no length and radius [003:1816], the sides of a pocket lie on
/// two axes and are positive [003:5242-5250], the allowance is positive [003:5510], a time limit is 0 or more [003:6723].
#[test]
fn what_a_cycle_cannot_mean_is_refused_when_it_is_entered() {
    let incorrect = MessageId::EntryValueIncorrect;
    let pocket = "CYCL_DEF 4 ENT -2 ENT -10 ENT -4 ENT 80 ENT";
    for (keys, wrong, message, right) in [
        ("TOOL_DEF 0 ENT 0 ENT".to_owned(), "5", incorrect, "CE 0"),
        (pocket.to_owned(), "X SIGN 80", incorrect, "X 80"),
        (
            format!("{pocket} X 80 ENT"),
            "X 40",
            MessageId::WrongAxisProgrammed,
            "CE CE Y 40",
        ),
    ] {
        let mut desk = Desk::new();
        desk.enter(&keys);
        for key in wrong.split(' ') {
            desk.enter(key);
        }
        assert_eq!(
            desk.editor.key(Key::Ent),
            Reaction::Refused(message),
            "{keys} {wrong}"
        );
        desk.enter(right);
        let reaction = desk.editor.key(Key::Ent);
        assert!(!matches!(reaction, Reaction::Refused(_)), "{keys} {right}");
    }
    // What has no sign takes none: the time limit, as a radius.
    for keys in ["TOUCH_PROBE 7 ENT", "CYCL_DEF 5 ENT -2 ENT -10 ENT -4 ENT 80 ENT"] {
        let mut desk = Desk::new();
        desk.enter(keys);
        let refused = Reaction::Refused(MessageId::KeyNonFunctional);
        assert_eq!(desk.editor.key(Key::Sign), refused, "{keys}");
    }
}
