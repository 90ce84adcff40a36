//! A whole program, key by key, with wrong entries on the way.

use crate::desk::Desk;
use bahn_parameters::ControlModel;
use bahn_parameters::MessageId::{
    EntryValueIncorrect, KeyNonFunctional, LabelNumberAllocated, WrongSignProgrammed,
};
use bahn_program::Program;

/// Keys, and the blocks that they give.
const PROGRAM: &[(&str, &str)] = &[
    (
        "BLK_FORM Z ENT X 0 Y 0 Z -20 ENT X 100 Y 100 Z 0 ENT",
        "BLK FORM 0.1 Z X+0 Y+0 Z-20|BLK FORM 0.2 X+100 Y+100 Z+0",
    ),
    ("TOOL_DEF 1 ENT 0 ENT 5 ENT", "TOOL DEF 1 L+0 R+5"),
    ("TOOL_DEF 2 ENT 12.5 ENT 2.5 ENT", "TOOL DEF 2 L+12.5 R+2.5"),
    ("TOOL_DEF 3 ENT 8 ENT 3 ENT", "TOOL DEF 3 L+8 R+3"),
    ("TOOL_CALL 1 ENT Z ENT 1000 ENT", "TOOL CALL 1 Z S1000"),
    ("L Z 100 ENT ENT ENT 6 ENT", "L Z+100 R0 FMAX M6"),
    ("L X -15 Y -15 ENT ENT ENT 3 ENT", "L X-15 Y-15 R0 FMAX M3"),
    ("L Z -5 ENT NO_ENT ENT NO_ENT", "L Z-5 FMAX"),
    // Outside contour with a rounding and a chamfer.
    ("L X 0 Y 0 ENT RL ENT 250 ENT NO_ENT", "L X+0 Y+0 RL F250"),
    ("L Y 100 END", "L Y+100"),
    ("RND 10 END", "RND R10"),
    ("L X 100 END", "L X+100"),
    ("L 10 END", "L10"),
    ("L Y 0 END", "L Y+0"),
    ("L X 0 END", "L X+0"),
    ("L X -15 Y -15 ENT ENT ENT NO_ENT", "L X-15 Y-15 R0 FMAX"),
    // A pocket.
    (
        "CYCL_DEF GOTO 4 ENT -2 ENT -10 ENT -4 ENT 80 ENT X 40 ENT Y 30 ENT 100 ENT SK1 ENT 0 ENT",
        "CYCL DEF 4.0 POCKET MILLING|CYCL DEF 4.1 SET UP -2|CYCL DEF 4.2 DEPTH -10|CYCL DEF 4.3 PECKG -4 F80|\
         CYCL DEF 4.4 X+40|CYCL DEF 4.5 Y+30|CYCL DEF 4.6 F100 DR+ RADIUS 0",
    ),
    ("L Z 2 ENT NO_ENT ENT NO_ENT", "L Z+2 FMAX"),
    ("L X 50 Y 50 ENT NO_ENT ENT 99 ENT", "L X+50 Y+50 FMAX M99"),
    // A bolt circle, by Q parameters and labels.
    ("TOOL_CALL 2 ENT Z ENT 1500 ENT", "TOOL CALL 2 Z S1500"),
    (
        "CYCL_DEF ENT -2 ENT -15 ENT -5 ENT 0 ENT 80 ENT",
        "CYCL DEF 1.0 PECKING|CYCL DEF 1.1 SET UP -2|CYCL DEF 1.2 DEPTH -15|CYCL DEF 1.3 PECKG -5|\
         CYCL DEF 1.4 DWELL 0|CYCL DEF 1.5 F80",
    ),
    ("Q 0 ENT 1 ENT 0 ENT", "FN0: Q1 = +0"),
    ("CC X 50 Y 50 ENT", "CC X+50 Y+50"),
    ("LBL_SET 1 ENT", "LBL 1"),
    ("L P 35 ENT Q 1 ENT ENT ENT 99 ENT", "LP PR+35 PA+Q1 R0 FMAX M99"),
    ("Q 1 ENT 1 ENT Q 1 ENT 60 ENT", "FN1: Q1 = +Q1 + +60"),
    (
        "Q 12 ENT Q 1 ENT 360 ENT 1 ENT",
        "FN12: IF +Q1 LT +360 GOTO LBL 1",
    ),
    // Tapping the same holes, by a rotation that is repeated.
    ("TOOL_CALL 3 ENT Z ENT 100 ENT", "TOOL CALL 3 Z S100"),
    (
        "CYCL_DEF DOWN ENT -3 ENT -12 ENT .5 ENT 100 ENT",
        "CYCL DEF 2.0 TAPPING|CYCL DEF 2.1 SET UP -3|CYCL DEF 2.2 DEPTH -12|CYCL DEF 2.3 DWELL 0.5|CYCL DEF 2.4 F100",
    ),
    (
        "CYCL_DEF 7 ENT X 50 ENT Y 50 ENT NO_ENT",
        "CYCL DEF 7.0 DATUM SHIFT|CYCL DEF 7.1 X+50|CYCL DEF 7.2 Y+50",
    ),
    ("LBL_SET 2 ENT", "LBL 2"),
    ("L X 35 Y 0 ENT ENT ENT 3 ENT", "L X+35 Y+0 R0 FMAX M3"),
    ("CYCL_CALL NO_ENT", "CYCL CALL"),
    (
        "CYCL_DEF 10 ENT I 60 ENT",
        "CYCL DEF 10.0 ROTATION|CYCL DEF 10.1 IROT+60",
    ),
    ("LBL_CALL 2 ENT 5 ENT", "CALL LBL 2 REP 5/5"),
    (
        "CYCL_DEF 10 ENT 0 ENT",
        "CYCL DEF 10.0 ROTATION|CYCL DEF 10.1 ROT+0",
    ),
    (
        "CYCL_DEF 7 ENT X 0 ENT Y 0 ENT NO_ENT",
        "CYCL DEF 7.0 DATUM SHIFT|CYCL DEF 7.1 X+0|CYCL DEF 7.2 Y+0",
    ),
    ("L Z 100 ENT NO_ENT ENT 2 ENT", "L Z+100 FMAX M2"),
];

fn expected() -> Vec<String> {
    let blocks = PROGRAM.iter().flat_map(|(_, blocks)| blocks.split('|'));
    blocks.map(str::to_owned).collect()
}

#[test]
fn a_program_is_written_key_by_key() {
    let mut desk = Desk::new();
    for (keys, _) in PROGRAM {
        desk.enter(keys);
        assert!(!desk.editor.is_open(), "{keys}");
    }
    assert!(expected().len() >= 40);
    assert_eq!(desk.blocks(), expected());
    let text = format!("BEGIN PGM 7 MM\n{}\nEND PGM 7 MM\n", expected().join("\n"));
    let program = Program::from_bytes("7.H", text.into_bytes());
    let pairs = desk.editor.program().blocks().zip(program.blocks());
    for (made, meant) in pairs {
        assert_eq!(made.block, meant.block);
    }
    let limits = ControlModel::Tnc360.limits();
    assert_eq!(desk.editor.program().diagnostics(Some(limits.into())), []);
}

#[test]
fn wrong_entries_on_the_way_leave_no_trace() {
    let mut desk = Desk::new();
    for (index, (keys, _)) in PROGRAM.iter().enumerate() {
        match index % 6 {
            // A dialogue begun and dropped.
            0 => desk.enter("CR X 1 Y 2 ENT DEL"),
            // A value too large, erased and entered anew.
            1 => {
                desk.refuses("L X 30001 ENT", EntryValueIncorrect);
                desk.enter("CE 7 DEL");
            }
            // A block that is undone.
            2 => desk.enter("STOP 6 ENT SK6"),
            // A key that does not belong, one sign that differs.
            3 => {
                desk.refuses("RND 5 RL", KeyNonFunctional);
                desk.enter("DEL");
                desk.refuses("CYCL_DEF 2 ENT -2 ENT 3 ENT", WrongSignProgrammed);
                desk.enter("CE DEL");
            }
            // A block that is deleted.
            4 => desk.enter("L X 5 END DEL"),
            // A value that is put right afterwards.
            _ => desk.enter("L X 5 END RIGHT RIGHT 6 LEFT LEFT DEL"),
        }
        if *keys == "LBL_SET 2 ENT" {
            desk.refuses("LBL_SET 1 ENT", LabelNumberAllocated);
            desk.enter("CE 2 ENT");
        } else {
            desk.enter(keys);
        }
    }
    assert_eq!(desk.blocks(), expected());
}
