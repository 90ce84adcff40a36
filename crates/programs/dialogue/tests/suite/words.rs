//! Words that are added to blocks, words that only some models have, and the cycles of the machine builder.

use std::sync::Arc;

use crate::desk::Desk;
use bahn_dialogue::{BuilderCycle, Draft, Editor, Reaction};
use bahn_parameters::ControlModel::{self, Tnc360, Tnc415b, Tnc425};
use bahn_parameters::MessageId::KeyNonFunctional;
use bahn_program::Program;

fn at_first(blocks: &str, model: ControlModel) -> Desk {
    let mut desk = Desk::with(blocks, model);
    desk.enter("GOTO 1 ENT");
    desk
}

/// After a highlighted word the key of an address adds its word where it belongs [003:1779-1780].
#[test]
fn keys_of_addresses_add_words_at_their_place() {
    for (block, keys, made) in [
        ("L X+10", "RIGHT Y 5 END", "L X+10 Y+5"),
        ("L X+10", "RIGHT RIGHT IV 5 END", "L X+10 C+5"),
        ("L X+10", "RIGHT F 2 0 0 END", "L X+10 F200"),
        ("L X+10", "RIGHT RL END", "L X+10 RL"),
        ("L X+10 RL", "RIGHT R END", "L X+10 R0"),
        ("L X+10", "RIGHT M 3 LEFT", "L X+10 M3"),
        ("L X+10", "RIGHT F SK1 END", "L X+10 FMAX"),
        // One after the other; what stands already is overwritten, a word without a value goes.
        ("L X+10", "RIGHT M 3 F 2 0 0 Y 5 RR END", "L X+10 Y+5 RR F200 M3"),
        ("L X+10 F100", "RIGHT RIGHT F 5 0 END", "L X+10 F50"),
        ("L X+10 Y+1", "RIGHT F Y 7 END", "L X+10 Y+7"),
        ("L X+10", "RIGHT F LEFT", "L X+10"),
        ("TOOL CALL 1 Z", "RIGHT S 5 0 0 END", "TOOL CALL 1 Z S500"),
        ("CALL LBL 3", "RIGHT R 4 END", "CALL LBL 3 REP 4/4"),
        ("CP IPA+90 DR+", "RIGHT Z 5 END", "CP IPA+90 Z+5 DR+"),
        ("RND R5", "RIGHT F 2 0 END", "RND R5 F20"),
        ("STOP", "RIGHT M 8 END", "STOP M8"),
        ("CYCL CALL", "RIGHT M 3 END", "CYCL CALL M3"),
        ("CC", "RIGHT X 1 Y 2 END", "CC X+1 Y+2"),
    ] {
        let mut desk = at_first(block, Tnc425);
        desk.enter(keys);
        assert_eq!(desk.blocks()[0], made, "{block}: {keys}");
    }
}

#[test]
fn what_a_block_does_not_take_is_refused() {
    for (block, keys) in [
        ("L X+10", "RIGHT S"),
        ("LBL 3", "RIGHT X"),
        ("RND R5", "RIGHT RL"),
        ("L X+1 Y+1 Z+1", "RIGHT IV"),
    ] {
        let mut desk = at_first(block, Tnc360);
        desk.refuses(keys, KeyNonFunctional);
        desk.press("END");
        assert_eq!(desk.blocks(), [block], "{keys}");
    }
    // DEL forgets a word that was begun, and a draft keeps it.
    let mut desk = at_first("L X+10", Tnc360);
    desk.enter("RIGHT Y 5");
    let kept: Draft = desk.editor.draft().unwrap().to_string().parse().unwrap();
    let mut again = Editor::new(Arc::clone(desk.editor.program()), desk.editor.setting().clone());
    assert!(again.restore(&kept));
    assert_eq!(again.key(bahn_dialogue::Key::End), Reaction::Edited);
    assert_eq!(again.program().text_of(1), "L X+10 Y+5");
    desk.enter("DEL END");
    assert_eq!(desk.blocks(), ["L X+10"]);
}

/// DL and DR are asked where the model has them [000:9177], LN opens where it has surface normals [000:175].
#[test]
fn words_of_some_models() {
    let mut desk = Desk::with("", Tnc415b);
    desk.enter("TOOL_CALL 1 ENT Z ENT 500 ENT");
    assert_eq!(desk.prompt(), "OVERSIZE FOR TOOL LENGTH DL?");
    desk.enter("0.1 ENT");
    assert_eq!(desk.prompt(), "OVERSIZE FOR TOOL RADIUS DR?");
    desk.enter("-0.2 ENT");
    desk.enter("L N X 1 Y 2 ENT 0 ENT 0.6 ENT 0.8 ENT ENT ENT NO_ENT");
    assert_eq!(
        desk.blocks(),
        [
            "TOOL CALL 1 Z S500 DL+0.1 DR-0.2",
            "LN X+1 Y+2 NX+0 NY+0.6 NZ+0.8 R0 FMAX"
        ]
    );
    let mut desk = Desk::with("", Tnc360);
    assert_eq!(desk.press("TOOL_CALL 1 ENT Z ENT 500 ENT"), Reaction::Edited);
    assert_eq!(desk.blocks(), ["TOOL CALL 1 Z S500"]);
    desk.refuses("L N", KeyNonFunctional);
}

/// Contour data are asked by the words of their table, three in a block.
#[test]
fn contour_data_are_asked_one_by_one() {
    let mut desk = Desk::with("", Tnc425);
    desk.enter("CYCL_DEF 21 ENT");
    assert_eq!(desk.prompt(), "PLUNGING DEPTH?");
    desk.enter("5 ENT");
    assert_eq!(desk.prompt(), "FEED RATE FOR PLUNGING?");
    desk.enter("Q 3 ENT");
    assert_eq!(desk.prompt(), "ROUGH-OUT TOOL NUMBER?");
    desk.enter("1 ENT");
    assert_eq!(
        desk.blocks(),
        [
            "CYCL DEF 21.0 PILOT DRILLING",
            "CYCL DEF 21.1 Q10=+5 Q11=+Q3 Q13=+1"
        ]
    );
    // Each is a word of its own when the block is edited, in whatever blocks they stand.
    let mut desk = at_first(
        "CYCL DEF 23.0 X\nCYCL DEF 23.1 Q11=+100\nCYCL DEF 23.2 Q12=+200",
        Tnc425,
    );
    desk.enter("DOWN RIGHT RIGHT 1 5 0 DOWN END");
    assert_eq!(desk.blocks()[1], "CYCL DEF 23.1 Q11=+150");
}

/// The texts of the dialogue block are the questions of the machine builder's cycle [000:17732-17866].
#[test]
fn a_cycle_of_the_machine_builder_asks_with_its_own_texts() {
    let texts = ["NUMBER OF HOLES?", "RADIUS?", "CENTRE X?", "CENTRE Y?"];
    let mut desk = Desk::with("", Tnc425);
    let mut setting = desk.editor.setting().clone();
    let parameters = (1..).zip(texts.iter().map(|text| text.to_string()));
    setting.builder_cycles = vec![BuilderCycle {
        number: 68,
        name: "Bolt hole circle".to_owned(),
        parameters: parameters.collect(),
    }];
    desk.editor.set_setting(setting);
    desk.enter("CYCL_DEF");
    let list = desk.editor.view(0, 0).list.unwrap();
    assert!(list.lines.contains(&"68 Bolt hole circle".to_owned()), "{list:?}");
    desk.enter("68 ENT");
    for (value, text) in ["8", "40", "60", "50"].iter().zip(texts) {
        assert_eq!(desk.prompt(), text);
        desk.enter(&format!("{value} ENT"));
    }
    assert_eq!(
        desk.blocks(),
        [
            "CYCL DEF 68.0 Bolt hole circle",
            "CYCL DEF 68.1 Q1=+8 Q2=+40 Q3=+60",
            "CYCL DEF 68.2 Q4=+50"
        ]
    );
    // From a word on the dialogue asks again with them.
    desk.enter("UP RIGHT RIGHT RIGHT ENT");
    assert_eq!(desk.prompt(), "RADIUS?");
    // A machine without the cycle takes its words as text.
    let mut desk = Desk::with("", Tnc425);
    desk.enter("CYCL_DEF 69 ENT");
    assert_eq!(desk.prompt(), "PARAMETERS Q = ?");
}

/// LBL SET and NO ENT, then ENT or NO ENT, then the numbers [000:17732-17744].
#[test]
fn the_dialogue_block_of_a_cycle() {
    let open = |name: &str| {
        let text = format!("BEGIN PGM {name} MM\nEND PGM {name} MM\n");
        let program = Program::from_bytes(format!("{name}.H"), text.into_bytes());
        let mut desk = Desk::with("", Tnc425);
        desk.editor = Editor::new(Arc::new(program), desk.editor.setting().clone());
        desk
    };
    let mut desk = open("99999968");
    desk.enter("LBL_SET NO_ENT ENT 0 ENT 2 ENT 8 ENT END");
    assert_eq!(desk.blocks(), ["DLG-DEF 0/2/8"]);
    desk.enter("LBL_SET NO_ENT NO_ENT 0 ENT 127 END");
    assert_eq!(desk.blocks()[1], "DLG-CALL 0/127");
    open("99999967").refuses("LBL_SET NO_ENT", KeyNonFunctional);
    open("12").refuses("LBL_SET NO_ENT", KeyNonFunctional);
}

#[test]
fn words_after_m_functions_lines_of_datum_tables_and_optional_blocks() {
    let mut desk = Desk::with("", Tnc425);
    desk.enter("L X 1 ENT ENT ENT 118 X 1 . 5 Y 2 ENT");
    assert_eq!(desk.blocks(), ["L X+1 R0 FMAX M118 X1.5 Y2"]);
    desk.refuses("L X 1 ENT ENT ENT 8 X", KeyNonFunctional);
    desk.enter("DEL CYCL_DEF 7 ENT SK1 5 ENT");
    assert_eq!(desk.blocks()[2], "CYCL DEF 7.1 #5");
    desk.enter("UP UP SK_RIGHT SK1");
    assert_eq!(desk.blocks()[0], "/ L X+1 R0 FMAX M118 X1.5 Y2");
    desk.enter("SK1");
    assert_eq!(desk.blocks()[0], "L X+1 R0 FMAX M118 X1.5 Y2");
}

/// What was answered of a cycle with as many blocks as are wanted is kept while the next is asked for.
#[test]
fn the_question_of_one_more_block_is_kept() {
    for keys in ["CYCL_DEF 7 ENT X 5 ENT", "CYCL_DEF 70 ENT Q 1 ENT"] {
        let mut desk = Desk::with("", Tnc425);
        desk.enter(keys);
        let draft = desk.editor.draft().unwrap();
        let mut again = Editor::new(Arc::clone(desk.editor.program()), desk.editor.setting().clone());
        assert!(again.restore(&draft), "{draft}");
        assert_eq!(
            (again.draft(), again.view(3, 3)),
            (Some(draft), desk.editor.view(3, 3))
        );
    }
}
