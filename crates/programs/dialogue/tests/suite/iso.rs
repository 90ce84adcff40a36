//! DIN/ISO: blocks are text, entered word by word, with numbers, checks and messages of the control.

use std::sync::Arc;

use crate::desk::{Desk, setting};
use bahn_dialogue::{Draft, Editor, Key, Reaction, Wanted};
use bahn_parameters::ControlModel::{self, Tnc360, Tnc415b};
use bahn_parameters::MessageId::{self, *};
use bahn_path::Axis;
use bahn_program::Program;

/// Blocks that are complete, as they are written.
fn complete() -> String {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../program/tests/data/complete-iso.txt"
    );
    std::fs::read_to_string(path).unwrap()
}

/// A desk at a program of DIN/ISO, whose numbers go up by a step.
fn at(blocks: &str, model: ControlModel, step: u32) -> Desk {
    let text = format!("%7 G71 *\n{blocks}N99999 %7 G71 *\n");
    let program = Program::from_bytes("7.I", text.into_bytes());
    let mut setting = setting(model);
    setting.iso_step = step;
    Desk {
        editor: Editor::new(Arc::new(program), setting),
    }
}

fn typed(desk: &mut Desk, text: &str) {
    for character in text.chars() {
        let reaction = desk.editor.type_text(&character.to_string());
        assert!(
            !matches!(reaction, Reaction::Refused(_)),
            "{character} of {text}: {reaction:?} {:?}",
            desk.editor.view(0, 0).words
        );
    }
}

/// The current block as it is shown, and the highlighted word.
fn shown(desk: &Desk) -> (String, String) {
    let view = desk.editor.view(0, 0);
    let current = view.rows.iter().find(|row| row.current).unwrap();
    let word = view.words.iter().find(|word| word.highlighted);
    (
        format!("{} {}", current.label, current.text).trim().to_owned(),
        word.map_or_else(String::new, |word| word.text.trim().to_owned()),
    )
}

#[test]
fn every_block_can_be_typed() {
    let known = |block: &&str| !block.starts_with("G200");
    for block in complete().lines().filter(known) {
        let mut desk = at("", Tnc415b, 10);
        typed(&mut desk, block);
        assert_eq!(
            desk.press("END"),
            Reaction::Edited,
            "{block}: {:?}",
            desk.editor.message()
        );
        assert_eq!(desk.blocks(), [format!("N10 {block} *")]);
    }
}

/// Keys alone: the axis keys, digits and letters, without a blank between words.
#[test]
fn words_part_by_themselves() {
    for (keys, block) in [
        (
            "G 0 0 G 4 0 G 9 0 X 1 0 Y SIGN 5 POINT 5 M 3",
            "G00 G40 G90 X+10 Y-5.5 M3",
        ),
        ("G 2 8 X Y", "G28 X Y"),
        ("T 1 G 1 7 S 1 0 0 0", "T1 G17 S1000"),
        ("G 8 6 P 0 1 2 0 SIGN P 0 2 Q 1", "G86 P01 -20 P02 +Q1"),
        ("G 0 1 X 1 F Q 5", "G01 X+1 FQ5"),
        // Keys that have no letter write the function that does the same.
        ("RL X 5", "G41 X+5"),
        ("LBL_SET 5", "G98 L5"),
        ("TOOL_DEF 1 L 0 R 5", "G99 T1 L+0 R+5"),
        ("CYCL_CALL M 3", "G79 M3"),
        ("PGM_CALL 1 2", "%12"),
    ] {
        let mut desk = at("", Tnc415b, 10);
        desk.enter(keys);
        assert_eq!(desk.press("ENT"), Reaction::Edited, "{block}");
        assert_eq!(desk.blocks(), [format!("N10 {block} *")]);
    }
}

#[test]
fn a_star_closes_a_block_and_several_can_be_pasted() {
    let mut desk = at("", Tnc415b, 5);
    desk.editor.type_text("G00 X10 *\nN12 Y5 *\n; a note\nM3 *");
    assert_eq!(
        desk.blocks(),
        ["N5 G00 X+10 *", "N12 Y+5 *", "N17 ; a note *", "N22 M3 *"]
    );
}

#[test]
fn numbers_are_the_controls() {
    // After the last in steps; between two in the middle.
    let mut desk = at("N10 M3 *\nN20 M5 *\n", Tnc415b, 10);
    desk.enter("GOTO 2 0 ENT M 8 END");
    desk.enter("GOTO 1 0 ENT X 1 END X 2 END X 3 END X 4 END");
    assert_eq!(
        desk.blocks(),
        [
            "N10 M3 *",
            "N15 X+1 *",
            "N17 X+2 *",
            "N18 X+3 *",
            "N19 X+4 *",
            "N20 M5 *",
            "N30 M8 *"
        ]
    );
    // Without room all are written anew, in one step of the history.
    desk.enter("GOTO 1 9 ENT X 5 END");
    let numbered: Vec<_> = (1..).map(|number| format!("N{} ", number * 10)).take(8).collect();
    let blocks = desk.blocks();
    for (block, number) in blocks.iter().zip(&numbered) {
        assert!(block.starts_with(number), "{blocks:?}");
    }
    assert_eq!((blocks.len(), blocks[5].as_str()), (8, "N60 X+5 *"));
    assert_eq!(shown(&desk), ("N60 X+5 *".into(), String::new()));
    desk.enter("SK6");
    assert_eq!(desk.blocks()[5], "N20 M5 *");
    // Step 0: none.
    let mut desk = at("", Tnc415b, 0);
    desk.enter("M 3 END M 5 END");
    assert_eq!(desk.blocks(), ["M3 *", "M5 *"]);
}

#[test]
fn a_number_may_be_entered_where_it_fits() {
    let mut desk = at("N10 M3 *\nN20 M5 *\n", Tnc415b, 10);
    desk.enter("GOTO 1 0 ENT N 1 4 M 8 END");
    assert_eq!(desk.blocks(), ["N10 M3 *", "N14 M8 *", "N20 M5 *"]);
    desk.press("N 2 0 M 9");
    desk.refuses("END", EntryValueIncorrect);
}

#[test]
fn goto_goes_to_the_number_of_a_block() {
    let mut desk = at("N10 M3 *\nN20 M5 *\n", Tnc415b, 10);
    desk.enter("GOTO 2 0 ENT");
    assert_eq!((desk.editor.cursor(), shown(&desk).0), (2, "N20 M5 *".into()));
    desk.refuses("GOTO 1 5 ENT", EntryValueIncorrect);
}

#[test]
fn words_are_changed_added_and_taken_out() {
    for (keys, made) in [
        ("RIGHT RIGHT 2 5 END", "G00 X+25 Y+5 *"),
        ("RIGHT RIGHT SIGN END", "G00 X-10 Y+5 *"),
        ("RIGHT RIGHT SIGN 7 END", "G00 X-7 Y+5 *"),
        ("RIGHT RIGHT Q 7 END", "G00 X+Q7 Y+5 *"),
        ("RIGHT 1 END", "G01 X+10 Y+5 *"),
        ("RIGHT RIGHT NO_ENT END", "G00 Y+5 *"),
        ("RIGHT G 4 0 END", "G00 G40 X+10 Y+5 *"),
        ("RIGHT RIGHT RIGHT RIGHT M 8 END", "G00 X+10 Y+5 M8 *"),
        ("RIGHT RIGHT CE 3 END", "G00 X+3 Y+5 *"),
        ("RIGHT RIGHT 2 5 CE CE 8 END", "G00 X+8 Y+5 *"),
        ("RIGHT RIGHT 2 5 DEL", "G00 X+10 Y+5 *"),
        ("SK_RIGHT SK1", "/ G00 X+10 Y+5 *"),
    ] {
        let mut desk = at("N10 G00 X+10 Y+5 *\n", Tnc415b, 10);
        desk.enter("DOWN");
        desk.enter(keys);
        assert_eq!(desk.blocks(), [format!("N10 {made}")], "{keys}");
    }
}

#[test]
fn up_and_down_find_the_same_word() {
    let mut desk = at("N10 X+1 *\nN20 M3 *\nN30 G01 X+5 *\n", Tnc415b, 10);
    desk.enter("DOWN RIGHT DOWN");
    assert_eq!(shown(&desk), ("N30 G01 X+5".into(), "X+5".into()));
    desk.enter("7 UP");
    assert_eq!(shown(&desk), ("N10 X+1".into(), "X+1".into()));
    assert_eq!(desk.blocks()[2], "N30 G01 X+7 *");
}

#[test]
fn blocks_and_sections_are_deleted_and_copied() {
    let blocks = "N10 M3 *\nN20 G83 P01 -2 P02 -20 P03 -5 P04 0.5 P05 80 *\nN30 M5 *\n";
    let mut desk = at(blocks, Tnc415b, 10);
    desk.enter("GOTO 2 0 ENT SK1 DOWN SK2 GOTO 1 0 ENT SK4");
    let texts: Vec<_> = desk
        .blocks()
        .iter()
        .map(|block| block.split_once(' ').unwrap().1.to_owned())
        .collect();
    let cycle = "G83 P01 -2 P02 -20 P03 -5 P04 0.5 P05 80 *";
    assert_eq!(texts, ["M3 *", cycle, "M5 *", cycle, "M5 *"]);
    desk.enter("GOTO 1 0 ENT DEL");
    assert_eq!(desk.blocks().len(), 4);
    // The frame is the control's.
    desk.refuses("GOTO 0 ENT DEL", KeyNonFunctional);
    desk.refuses("GOTO 0 ENT RIGHT", KeyNonFunctional);
}

#[test]
fn comments_are_taken_as_they_are_typed() {
    let mut desk = at("N10 M3 *\n", Tnc415b, 10);
    typed(&mut desk, "G00 X5; Up, at 5*: over");
    desk.enter("END");
    assert_eq!(desk.blocks()[0], "N5 G00 X+5 ; Up, at 5*: over *");
    desk.enter("SK_RIGHT SK2");
    typed(&mut desk, "done");
    desk.enter("END");
    assert_eq!(desk.blocks()[0], "N5 G00 X+5 ; done *");
}

/// What is said at which word, and that nothing of it comes into the program.
#[test]
fn faults_are_said_where_they_stand() {
    let cases: &[(&str, &str, MessageId, &str)] = &[
        // At once when the next word begins.
        ("X1 X2 ", "Y", AxisDoubleProgrammed, "X2"),
        ("G555 ", "X", BlockNotKnown, "G555"),
        ("W9 E4 ", "X", BlockNotKnown, "E4"),
        ("X123456789 ", "Y", EntryValueIncorrect, "X123456789"),
        // At the end of the block what may still have come.
        ("G98", "END", EntryValueIncorrect, "G98"),
        ("G83 P01 -2", "END", CyclIncomplete, ""),
        ("X", "END", EntryValueIncorrect, "X"),
        ("X1.23456", "END", EntryValueIncorrect, "X1.23456"),
        ("G98 L3", "END", LabelNumberAllocated, "L3"),
        ("L0,0", "END", JumpToLabelZeroNotPermitted, "L0,0"),
    ];
    for (text, last, message, word) in cases {
        let mut desk = at("N10 G98 L3 *\n", Tnc415b, 10);
        typed(&mut desk, text);
        let before = desk.blocks();
        desk.refuses(last, *message);
        if !word.is_empty() {
            assert_eq!(shown(&desk).1, *word, "{text}");
        }
        assert_eq!(desk.blocks(), before);
        assert_eq!(desk.press("DEL"), Reaction::Shown);
        assert!(!desk.editor.is_open());
    }
}

#[test]
fn a_block_has_no_more_characters_than_the_control_takes() {
    // 150 [000:615].
    let mut desk = at("", Tnc415b, 10);
    typed(&mut desk, &format!(";{}", "x".repeat(148)));
    desk.editor.type_text("y");
    assert_eq!(desk.editor.message(), Some(EntryValueIncorrect));
}

#[test]
fn a_protected_program_is_left_alone() {
    let text = "%7 G71 G50 *\nN10 X+1 *\nN99999 %7 G71 G50 *\n";
    let program = Program::from_bytes("7.I", text.into());
    let mut desk = Desk {
        editor: Editor::new(Arc::new(program), setting(Tnc415b)),
    };
    desk.refuses("X", ProtectedPgm);
    desk.enter("DOWN RIGHT");
    desk.refuses("5", ProtectedPgm);
    desk.refuses("LEFT DEL", ProtectedPgm);
}

#[test]
fn positions_are_captured() {
    let mut desk = at("", Tnc415b, 10);
    assert_eq!(desk.press("CAPTURE"), Reaction::Position(Wanted::Block));
    desk.editor.capture_block(&[(Axis::X, 1.5), (Axis::Y, -2.0)]);
    assert_eq!(desk.blocks(), ["N10 G01 G90 X+1.5 Y-2 *"]);
    assert_eq!(
        desk.press("G 0 0 Z CAPTURE"),
        Reaction::Position(Wanted::Axis(Axis::Z))
    );
    desk.editor.capture(Axis::Z, 12.25);
    desk.enter("END");
    assert_eq!(desk.blocks()[1], "N20 G00 Z+12.25 *");
}

#[test]
fn what_is_open_is_kept() {
    let mut desk = at("N10 M3 *\n", Tnc360, 10);
    desk.enter("DOWN G 0 0 X SIGN 5");
    let draft = desk.editor.draft().unwrap();
    let kept: Draft = draft.to_string().parse().unwrap();
    let mut again = Desk {
        editor: Editor::new(Arc::clone(desk.editor.program()), desk.editor.setting().clone()),
    };
    assert!(again.editor.restore(&kept));
    assert_eq!(again.editor.view(3, 3), desk.editor.view(3, 3));
    again.enter("0 END");
    assert_eq!(again.blocks(), ["N10 M3 *", "N20 G00 X-50 *"]);
    // A draft of the other language is not taken.
    let mut plain = Desk::new();
    assert!(!plain.editor.restore(&kept));
}

/// A keyboard without letters has them on soft keys, and each prompt tells what the word is.
#[test]
fn a_small_keyboard_has_the_letters_on_soft_keys() {
    let mut desk = at("", Tnc360, 10);
    let reaction = desk.press("X 5 SK1");
    assert_eq!(reaction, Reaction::Shown);
    desk.enter("0 1");
    assert_eq!(desk.prompt(), "WORD? END OF BLOCK = END");
    desk.enter("SK3");
    assert_eq!(desk.prompt(), "FEED RATE F = ?");
    desk.enter("2 0 0 SK2");
    assert_eq!(desk.prompt(), "MISCELLANEOUS FUNCTION M?");
    desk.enter("3 END");
    assert_eq!(desk.blocks(), ["N10 G01 X+5 F200 M3 *"]);
    assert!(desk.editor.key(Key::Graphics) == Reaction::Passed);
}
