//! Editing a program that stands there [003:1744-1790].

use crate::desk::Desk;
use bahn_dialogue::{Key, Reaction, Wanted};
use bahn_parameters::ControlModel::{Tnc155, Tnc360, Tnc415b};
use bahn_parameters::MessageId::{
    EntryValueIncorrect, FurtherProgramEntryImpossible, JumpToLabelZeroNotPermitted, KeyNonFunctional,
    LabelNumberAllocated, ProtectedPgm, WrongSignProgrammed,
};
use bahn_path::Axis;

const POCKET: &str = "CYCL DEF 4.0 POCKET MILLING
CYCL DEF 4.1 SET UP -2
CYCL DEF 4.2 DEPTH -10
CYCL DEF 4.3 PECKG -4 F80
CYCL DEF 4.4 X+80
CYCL DEF 4.5 Y+40
CYCL DEF 4.6 F100 DR+ RADIUS 0";

fn desk(blocks: &str) -> Desk {
    Desk::with(blocks, Tnc360)
}

/// The highlighted word.
fn word(desk: &Desk) -> String {
    let words = desk.editor.view(0, 0).words;
    let highlighted = words.iter().find(|word| word.highlighted);
    highlighted.map_or_else(String::new, |word| word.text.trim().to_owned())
}

#[test]
fn blocks_are_inserted_after_the_cursor() {
    let mut desk = desk("L X+1\nL X+2");
    desk.enter("DOWN STOP END LBL_SET 3 END");
    assert_eq!(desk.blocks(), ["L X+1", "STOP", "LBL 3", "L X+2"]);
    assert_eq!(desk.editor.cursor(), 3);
    desk.enter("DOWN DOWN");
    desk.refuses("L", KeyNonFunctional);
    desk.refuses("DEL", KeyNonFunctional);
    desk.refuses("RIGHT", KeyNonFunctional);
    desk.enter("GOTO 0 ENT");
    desk.refuses("DEL", KeyNonFunctional);
    desk.refuses("RIGHT", KeyNonFunctional);
    desk.enter("CE");
    assert_eq!(desk.editor.message(), None);
}

#[test]
fn a_value_is_overwritten_and_confirmed() {
    let mut desk = desk("L X+10 IY+20 RL F200 M3");
    desk.enter("DOWN RIGHT");
    assert_eq!(word(&desk), "L");
    desk.enter("RIGHT");
    assert_eq!(word(&desk), "X+10");
    desk.enter("12.50");
    assert_eq!(
        (word(&desk), desk.blocks()[0].as_str()),
        ("X+12.50".into(), "L X+10 IY+20 RL F200 M3")
    );
    desk.enter("RIGHT");
    assert_eq!(
        (word(&desk), desk.blocks()[0].as_str()),
        ("IY+20".into(), "L X+12.5 IY+20 RL F200 M3")
    );
    desk.enter("I SIGN RIGHT RR RIGHT Q 7 END");
    assert_eq!(desk.blocks(), ["L X+12.5 Y-20 RR FQ7 M3"]);
    assert_eq!(word(&desk), "");
    // A wrong value stays highlighted until it is put right; DEL gives the old one back.
    desk.enter("RIGHT RIGHT");
    desk.refuses("30001 RIGHT", EntryValueIncorrect);
    desk.refuses("END", EntryValueIncorrect);
    assert_eq!(word(&desk), "X+30001");
    desk.enter("DEL");
    assert_eq!(word(&desk), "X+12.5");
    desk.enter("CE END");
    assert_eq!(desk.blocks(), ["L X+0 Y-20 RR FQ7 M3"]);
}

#[test]
fn words_are_deleted_and_added() {
    let mut desk = desk("L X+10 Y+20 R0 FMAX M3");
    desk.enter("DOWN RIGHT RIGHT RIGHT NO_ENT");
    assert_eq!(
        (word(&desk), desk.blocks()[0].as_str()),
        ("R0".into(), "L X+10 R0 FMAX M3")
    );
    desk.enter("LEFT Z 5 RIGHT");
    assert_eq!(
        (word(&desk), desk.blocks()[0].as_str()),
        ("R0".into(), "L X+10 Z+5 R0 FMAX M3")
    );
    desk.enter("NO_ENT NO_ENT LEFT NO_ENT LEFT NO_ENT");
    assert_eq!((word(&desk), desk.blocks()[0].as_str()), ("M3".into(), "L M3"));
    desk.enter("LEFT");
    desk.refuses("NO_ENT", KeyNonFunctional);
    // ENT opens the dialogue: what is there stays unless it is entered anew.
    desk.enter("LEFT RIGHT ENT");
    assert_eq!(desk.prompt(), "COORDINATES?");
    desk.enter("Y 7 ENT NO_ENT 100 ENT");
    assert_eq!(desk.prompt(), "MISCELLANEOUS FUNCTION M?");
    assert_eq!(desk.press("ENT"), Reaction::Edited);
    assert_eq!(desk.blocks(), ["L Y+7 F100 M3"]);
    // What the block needs cannot be deleted.
    let mut desk = Desk::with("CR X+1 Y+2 R+5 DR-", Tnc360);
    desk.enter("DOWN RIGHT RIGHT RIGHT RIGHT");
    assert_eq!(word(&desk), "R+5");
    desk.refuses("NO_ENT", KeyNonFunctional);
}

#[test]
fn the_same_word_is_found_in_other_blocks() {
    let mut desk = desk("L X+10 F200\nL Y+5\n; X\nL IX+3 M3\nCYCL DEF 1.3 PECKG -5\nCYCL DEF 1.3 PECKG: -6");
    desk.enter("DOWN RIGHT RIGHT DOWN");
    assert_eq!((desk.editor.cursor(), word(&desk)), (4, "IX+3".into()));
    desk.enter("DOWN");
    assert_eq!(desk.editor.cursor(), 4);
    desk.enter("7 UP");
    assert_eq!((desk.editor.cursor(), word(&desk)), (1, "X+10".into()));
    assert_eq!(desk.blocks()[3], "L IX+7 M3");
    desk.enter("END GOTO 5 ENT RIGHT RIGHT DOWN");
    assert_eq!((desk.editor.cursor(), word(&desk)), (6, "PECKG -6".into()));
}

#[test]
fn cycles_are_deleted_from_their_last_block() {
    let mut desk = desk(&format!("LBL 1\n{POCKET}\nL X+1"));
    desk.enter("GOTO 4 ENT");
    desk.refuses("DEL", KeyNonFunctional);
    desk.enter("GOTO 8 ENT DEL");
    assert_eq!(desk.blocks(), ["LBL 1", "L X+1"]);
    assert_eq!(desk.editor.cursor(), 1);
    desk.enter("DEL");
    assert_eq!(desk.blocks(), ["L X+1"]);
    // Blocks of an incomplete cycle are deleted as far as they belong together.
    let mut desk = Desk::with(
        "CYCL DEF 1.3 PECKG -5\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -5",
        Tnc360,
    );
    desk.enter("DOWN DEL");
    assert_eq!(desk.blocks(), ["CYCL DEF 1.1 SET UP -2", "CYCL DEF 1.2 DEPTH -5"]);
    desk.enter("GOTO 2 ENT DEL");
    assert_eq!(desk.blocks(), [""; 0]);
}

#[test]
fn an_open_dialogue_ends_or_is_dropped() {
    let mut desk = desk("");
    desk.enter("L X 5 ENT DEL");
    assert_eq!((desk.blocks().len(), desk.editor.is_open()), (0, false));
    desk.enter("CYCL_DEF 1 ENT -2 ENT -15 ENT DEL");
    assert_eq!(desk.blocks().len(), 0);
    // END keeps what is there; of a cycle the blocks so far.
    desk.enter("CYCL_DEF 1 ENT -2 ENT -15 ENT END");
    assert_eq!(
        desk.blocks(),
        [
            "CYCL DEF 1.0 PECKING",
            "CYCL DEF 1.1 SET UP -2",
            "CYCL DEF 1.2 DEPTH -15"
        ]
    );
    desk.refuses("CYCL_DEF 3 ENT -2 ENT -15 ENT -5 END", EntryValueIncorrect);
    desk.enter("DEL");
    // What the block needs is asked for.
    desk.refuses("RND ENT", EntryValueIncorrect);
    desk.refuses("NO_ENT", KeyNonFunctional);
    desk.refuses("END", EntryValueIncorrect);
    desk.enter("DEL");
    desk.refuses("L END", EntryValueIncorrect);
    desk.refuses("X END", EntryValueIncorrect);
    desk.refuses("SIGN ENT", EntryValueIncorrect);
    desk.refuses("TOOL_DEF", KeyNonFunctional);
    desk.enter("5 SIGN END");
    assert_eq!(desk.blocks().last().unwrap(), "L X+5");
    // Back to an earlier question, and on.
    desk.enter("L X 1 ENT RL ENT LEFT LEFT Y 2 RIGHT RIGHT 100 END");
    assert_eq!(desk.blocks().last().unwrap(), "L X+1 Y+2 RL F100");
}

#[test]
fn sections_are_copied_cut_and_put_elsewhere() {
    let mut desk = desk("LBL 1\nL X+1\nL X+2\nLBL 0");
    desk.refuses("SK4", KeyNonFunctional);
    desk.enter("GOTO 2 ENT SK1 DOWN");
    let marked: Vec<_> = desk
        .editor
        .view(9, 9)
        .rows
        .iter()
        .filter(|row| row.marked)
        .map(|row| row.number)
        .collect();
    assert_eq!(marked, [Some(2), Some(3)]);
    desk.enter("SK2 DOWN SK4");
    assert_eq!(
        desk.blocks(),
        ["LBL 1", "L X+1", "L X+2", "LBL 0", "L X+1", "L X+2"]
    );
    desk.enter("GOTO 1 ENT SK1 GOTO 4 ENT SK3");
    assert_eq!(desk.blocks(), ["L X+1", "L X+2"]);
    desk.enter("GOTO 2 ENT SK4");
    assert_eq!(
        desk.blocks(),
        ["L X+1", "L X+2", "LBL 1", "L X+1", "L X+2", "LBL 0"]
    );
    desk.enter("SK1 UP UP SK1 DOWN UP");
    assert!(desk.editor.view(9, 9).rows.iter().all(|row| !row.marked));
    // BEGIN and END are never in a section.
    desk.enter("GOTO 0 ENT SK1 GOTO 7 ENT DEL");
    assert_eq!(desk.blocks(), [""; 0]);
    for blocks in [6, 2, 6, 4] {
        assert_eq!(desk.press("SK6"), Reaction::Edited);
        assert_eq!(desk.blocks().len(), blocks);
    }
    desk.refuses("SK6", KeyNonFunctional);
    assert_eq!(desk.press("SK7"), Reaction::Edited);
    assert_eq!(desk.blocks().len(), 6);
}

#[test]
fn a_file_with_numbers_keeps_them_in_order() {
    let text = "0 BEGIN PGM 7 MM\n1 L X+1\n2 / L Y+2 ; up\n3 END PGM 7 MM\n";
    let program = bahn_program::Program::from_bytes("7.H", text.into());
    let editor = bahn_dialogue::Editor::new(program.into(), crate::desk::setting(Tnc360));
    let mut desk = Desk { editor };
    desk.enter("DOWN STOP END DOWN SK2 SK4 UP UP UP RIGHT RIGHT 5 END");
    let wanted = "0 BEGIN PGM 7 MM\n1 L X+5\n2 STOP\n3 / L Y+2 ; up\n4 / L Y+2 ; up\n5 END PGM 7 MM\n";
    assert_eq!(
        String::from_utf8_lossy(&desk.editor.numbered().to_bytes()),
        wanted
    );
    let mut desk = Desk::with("L X+1", Tnc360);
    desk.enter("STOP END");
    assert_eq!(
        desk.editor.numbered().to_bytes(),
        desk.editor.program().to_bytes()
    );
}

#[test]
fn texts_and_blocks_are_found() {
    let mut desk = desk("L X+1\nTOOL CALL 1 Z S500\nL X+2\nTOOL CALL 2 Z S700");
    desk.enter("SK5 T O O L SK1 C A L L ENT");
    assert_eq!(desk.editor.cursor(), 2);
    desk.enter("SK5 ENT");
    assert_eq!(desk.editor.cursor(), 4);
    desk.enter("SK5 ENT");
    assert_eq!(desk.editor.cursor(), 2);
    desk.refuses("SK5 F F ENT", EntryValueIncorrect);
    desk.refuses("GOTO 9 ENT", EntryValueIncorrect);
    desk.enter("CE 4 ENT");
    assert_eq!(desk.editor.cursor(), 4);
}

#[test]
fn entries_keep_to_the_limits_of_the_model() {
    let mut desk = desk("LBL 5\nLBL 0");
    for (keys, message) in [
        ("L X 30000.1 ENT", EntryValueIncorrect),
        ("L X 1.0001 ENT", EntryValueIncorrect),
        ("L X 1 ENT ENT 30000 ENT", EntryValueIncorrect),
        ("LBL_SET 255 ENT", EntryValueIncorrect),
        ("LBL_SET 5 ENT", LabelNumberAllocated),
        ("LBL_CALL 0 ENT", JumpToLabelZeroNotPermitted),
        ("Q 9 ENT 1 ENT 1 ENT 0 ENT", JumpToLabelZeroNotPermitted),
        ("CYCL_DEF 14 ENT 1 ENT 0 ENT", JumpToLabelZeroNotPermitted),
        ("LBL_CALL 5 ENT 65535 ENT", EntryValueIncorrect),
        ("TOOL_DEF 255 ENT", EntryValueIncorrect),
        ("TOOL_CALL 1 ENT Z ENT 100000 ENT", EntryValueIncorrect),
        ("L P 5 ENT 361 ENT", EntryValueIncorrect),
        ("Q 0 ENT 124 ENT", EntryValueIncorrect),
        ("L X Q 124 ENT", EntryValueIncorrect),
        ("CYCL_DEF 1 ENT -2 ENT 15 ENT", WrongSignProgrammed),
        ("CYCL_DEF 11 ENT 100 ENT", EntryValueIncorrect),
        ("CYCL_DEF 9 ENT 30001 ENT", EntryValueIncorrect),
        ("CYCL_DEF 27 ENT", EntryValueIncorrect),
        ("M 1000", EntryValueIncorrect),
        ("L X 1 Y 1 Z 1 IV", KeyNonFunctional),
        ("L U", KeyNonFunctional),
        ("L X 1 . 2 .", KeyNonFunctional),
        ("LBL_SET Q", KeyNonFunctional),
        ("RND SIGN", KeyNonFunctional),
        // Lines of MEANDER lie in the positive direction [003:6667]; those of contour lines in both [003:6758-6761].
        ("TOUCH_PROBE 6 ENT X ENT .5 ENT SIGN", KeyNonFunctional),
        ("PGM_CALL A B C D E F G H J", EntryValueIncorrect),
        ("5", KeyNonFunctional),
        ("RL", KeyNonFunctional),
        ("ENT", KeyNonFunctional),
        ("SK4", KeyNonFunctional),
    ] {
        desk.refuses(keys, message);
        while desk.editor.is_open() {
            desk.press("DEL");
        }
        assert_eq!(desk.blocks(), ["LBL 5", "LBL 0"], "{keys}");
    }
    desk.enter("LBL_SET 0 ENT LBL_CALL 5 ENT NO_ENT");
    // The signs of a cycle that stands there are kept to as well.
    let mut desk = Desk::with(POCKET, Tnc360);
    desk.enter("GOTO 3 ENT RIGHT RIGHT");
    desk.refuses("12 RIGHT", WrongSignProgrammed);
    desk.enter("SIGN RIGHT");
    assert_eq!(desk.blocks()[2], "CYCL DEF 4.2 DEPTH -12");
    // A label may keep its own number.
    let mut desk = Desk::with("LBL 5\nLBL 6", Tnc360);
    desk.enter("DOWN RIGHT RIGHT");
    desk.refuses("6 END", LabelNumberAllocated);
    desk.enter("CE 5 END RIGHT RIGHT 7 END");
    assert_eq!(desk.blocks(), ["LBL 7", "LBL 6"]);
}

#[test]
fn a_protected_program_is_only_looked_at() {
    let text = "BEGIN PGM 7 MM P\nL X+5\nEND PGM 7 MM P\n";
    let program = bahn_program::Program::from_bytes("7.H", text.into());
    let editor = bahn_dialogue::Editor::new(program.into(), crate::desk::setting(Tnc360));
    let mut desk = Desk { editor };
    for keys in [
        "L",
        "CYCL_DEF",
        "TOUCH_PROBE",
        "Q",
        "X",
        "CAPTURE",
        "B",
        "SK8",
        "SK3",
        "SK4",
    ] {
        let message = if keys == "SK4" {
            KeyNonFunctional
        } else {
            ProtectedPgm
        };
        desk.refuses(keys, message);
    }
    desk.enter("DOWN");
    desk.refuses("DEL", ProtectedPgm);
    desk.enter("RIGHT RIGHT");
    desk.refuses("6", ProtectedPgm);
    desk.refuses("NO_ENT", ProtectedPgm);
    desk.refuses("ENT", ProtectedPgm);
    assert_eq!(
        (word(&desk), desk.blocks()),
        ("X+5".into(), vec!["L X+5".to_owned()])
    );
}

#[test]
fn a_full_memory_takes_no_more_blocks() {
    let mut desk = desk("L X+1");
    let bytes = desk.editor.program().to_bytes().len() as u64;
    let mut setting = desk.editor.setting().clone();
    setting.bytes_max = bytes + 5;
    desk.editor = bahn_dialogue::Editor::new(desk.editor.program().clone(), setting);
    desk.enter("STOP END");
    desk.refuses("STOP END", FurtherProgramEntryImpossible);
    // What was entered is not lost: room is made elsewhere, or the entry is dropped.
    assert!(desk.editor.is_open());
    desk.enter("DEL DEL");
    assert_eq!(desk.blocks(), ["L X+1"]);
}

#[test]
fn actual_positions_are_captured() {
    let mut desk = desk("");
    assert_eq!(
        desk.press("L X CAPTURE"),
        Reaction::Position(Wanted::Axis(Axis::X))
    );
    // In input steps of 0.001 mm [003:7825].
    assert_eq!(desk.editor.capture(Axis::X, -12.345_26), Reaction::Shown);
    desk.refuses("ENT CAPTURE", KeyNonFunctional);
    desk.enter("END TOOL_DEF 3 ENT");
    assert_eq!(desk.press("CAPTURE"), Reaction::Position(Wanted::ToolAxis));
    assert_eq!(desk.editor.capture(Axis::Z, 100.0), Reaction::Shown);
    desk.enter("ENT 5 END");
    assert_eq!(desk.press("CAPTURE"), Reaction::Position(Wanted::Block));
    let position = [(Axis::X, 1.5), (Axis::Y, -0.0), (Axis::Z, 100.0)];
    assert_eq!(desk.editor.capture_block(&position), Reaction::Edited);
    assert_eq!(
        desk.blocks(),
        ["L X-12.345", "TOOL DEF 3 L+100 R+5", "L X+1.5 Y+0 Z+100"]
    );
    let four = [(Axis::X, 1.0), (Axis::Y, 1.0), (Axis::Z, 1.0), (Axis::C, 1.0)];
    assert_eq!(
        desk.editor.capture_block(&four),
        Reaction::Refused(EntryValueIncorrect)
    );
    assert_eq!(
        desk.editor.capture_block(&[]),
        Reaction::Refused(EntryValueIncorrect)
    );
}

#[test]
fn lists_offer_what_the_model_has() {
    let numbers = |model, keys: &str| -> Vec<String> {
        let mut desk = Desk::with("", model);
        desk.enter(keys);
        let lines = desk.editor.view(0, 0).list.unwrap().lines;
        lines
            .iter()
            .map(|line| line.split([' ', ':']).next().unwrap().to_owned())
            .collect()
    };
    let standard: Vec<String> = (1..=17).map(|number: u16| number.to_string()).collect();
    assert_eq!(numbers(Tnc360, "CYCL_DEF"), standard);
    assert_eq!(numbers(Tnc155, "CYCL_DEF"), standard[..16]);
    assert!(numbers(Tnc415b, "CYCL_DEF").contains(&"26".to_owned()));
    assert_eq!(numbers(Tnc360, "TOUCH_PROBE"), ["0", "5", "6", "7"]);
    assert_eq!(
        (numbers(Tnc360, "Q").len(), numbers(Tnc415b, "Q").len()),
        (17, 18)
    );
    let mut desk = desk("");
    let mut setting = desk.editor.setting().clone();
    setting.inhibited_cycles = vec![4];
    setting.paraxial_inhibited = true;
    desk.editor = bahn_dialogue::Editor::new(desk.editor.program().clone(), setting);
    desk.refuses("CYCL_DEF 4 ENT", EntryValueIncorrect);
    desk.enter("CE DEL");
    desk.refuses("X", KeyNonFunctional);
}

#[test]
fn german_and_a_decimal_comma() {
    let mut desk = desk("");
    let mut setting = desk.editor.setting().clone();
    setting.tongue = bahn_dialogue::Tongue::German;
    setting.decimal_comma = true;
    desk.editor = bahn_dialogue::Editor::new(desk.editor.program().clone(), setting);
    desk.enter("L X 1.5");
    assert_eq!(desk.prompt(), "KOORDINATEN?");
    let view = desk.editor.view(1, 1);
    assert_eq!(
        (
            view.question.unwrap().entered.as_str(),
            view.rows[1].text.as_str()
        ),
        ("X+1,5", "L X+1,5")
    );
    desk.enter("ENT");
    assert_eq!(desk.prompt(), "WERKZEUG-RADIUS-KORR.: RL/RR/KEINE KORR.?");
    desk.enter("END CYCL_DEF 9 ENT 2.5 ENT");
    let rows = desk.editor.view(9, 9).rows;
    assert_eq!(rows[3].text, "CYCL DEF 9.1 DWELL 2,5");
    // The file keeps the point.
    assert_eq!(
        desk.blocks(),
        ["L X+1.5", "CYCL DEF 9.0 DWELL TIME", "CYCL DEF 9.1 DWELL 2.5"]
    );
}

#[test]
fn comments_and_optional_blocks_stay_what_they_are() {
    let mut desk = desk("/ L X+5 ; first\n; only text\nCYCL DEF 2.1 ABST -2");
    desk.enter("DOWN RIGHT RIGHT 6 END");
    desk.enter("DOWN RIGHT");
    desk.editor.type_text(" more");
    desk.enter("END DOWN RIGHT RIGHT -3 END");
    assert_eq!(
        desk.blocks(),
        ["/ L X+6 ; first", "; only text more", "CYCL DEF 2.1 ABST -3"]
    );
}

#[test]
fn f_max_is_offered_where_it_is_a_word() {
    let mut desk = Desk::with("", Tnc155);
    desk.enter("L X 1 ENT ENT");
    assert_eq!(desk.prompt(), "FEED RATE F = ?");
    desk.enter("ENT NO_ENT L X 2 ENT ENT SK1 ENT NO_ENT");
    assert_eq!(desk.blocks(), ["L X+1 R0", "L X+2 R0 F15999"]);
}

#[test]
fn keys_of_the_panel_pass() {
    let mut desk = desk("");
    desk.enter("L X 5");
    for key in [
        Key::Manual,
        Key::PgmNr,
        Key::Mod,
        Key::Help,
        Key::Graphics,
        Key::Start,
        Key::Screen,
    ] {
        assert_eq!(desk.editor.key(key), Reaction::Passed);
    }
    desk.enter("END");
    assert_eq!(desk.blocks(), ["L X+5"]);
}

#[test]
fn soft_keys_belong_to_the_question() {
    let mut desk = desk("");
    let keys = |desk: &Desk| -> String {
        let view = desk.editor.view(0, 0);
        view.soft_keys.join(" ").trim().to_owned()
    };
    assert_eq!(keys(&desk), "MARK COPY CUT INSERT FIND UNDO REDO TEXT");
    desk.enter("C X 1 Y 1 ENT");
    assert_eq!(keys(&desk), "DR+ DR-");
    desk.enter("ENT");
    assert_eq!(keys(&desk), "RL RR R0");
    desk.enter("ENT");
    assert_eq!(keys(&desk), "F MAX");
    desk.enter("SK1 ENT");
    assert_eq!(keys(&desk), "M0 M2 M3 M4 M5 M6 M8 M9");
    desk.enter("SK_RIGHT");
    assert_eq!(
        (keys(&desk).as_str(), desk.editor.view(0, 0).soft_row),
        ("M13 M14 M30 M89 M90 M91 M92 M99", (1, 3))
    );
    desk.enter("SK_LEFT SK_LEFT SK_LEFT");
    assert_eq!(desk.editor.view(0, 0).soft_row, (1, 3));
    desk.enter("SK8 ENT");
    assert_eq!(desk.blocks(), ["C X+1 Y+1 DR- R0 FMAX M99"]);
    assert_eq!(keys(&desk), "MARK COPY CUT INSERT FIND UNDO REDO TEXT");
}
