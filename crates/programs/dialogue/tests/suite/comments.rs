//! The word that is highlighted is asked for; after the last one stands the comment of the block.

use crate::desk::Desk;
use bahn_parameters::ControlModel::{Tnc360, Tnc415b};
use bahn_parameters::MessageId::{KeyNonFunctional, ProtectedPgm};

/// The highlighted word.
fn word(desk: &Desk) -> String {
    let words = desk.editor.view(0, 0).words;
    let highlighted = words.iter().find(|word| word.highlighted);
    highlighted.map_or_else(String::new, |word| word.text.trim().to_owned())
}

/// After the last word of a block RIGHT asks for its comment on controls with an alpha keyboard; `;` does while the
/// block is entered, and makes a block of its own while nothing is open.
#[test]
fn comments_are_entered_changed_and_deleted_by_keys() {
    let mut desk = Desk::with("L X+10 R0 FMAX\nSTOP", Tnc415b);
    desk.enter("DOWN RIGHT RIGHT RIGHT RIGHT");
    assert_eq!(word(&desk), "FMAX");
    desk.enter("RIGHT");
    assert_eq!(desk.prompt(), "COMMENT?");
    // Left alone it is none, and the last word is highlighted again.
    desk.enter("LEFT");
    assert_eq!(word(&desk), "FMAX");
    desk.enter("RIGHT S T A R T ENT");
    assert_eq!(desk.blocks(), ["L X+10 R0 FMAX ; START", "STOP"]);
    // It is a word like others: what is keyed goes on with it, CE takes the last character.
    desk.enter("RIGHT RIGHT RIGHT RIGHT RIGHT");
    assert_eq!(word(&desk), "; START");
    desk.enter("CE CE 1 END");
    assert_eq!(desk.blocks()[0], "L X+10 R0 FMAX ; STA1");
    // DEL gives back what was there, NO ENT deletes it; UP and DOWN find the next one.
    desk.enter("RIGHT RIGHT RIGHT RIGHT RIGHT 2 DEL");
    assert_eq!(word(&desk), "; STA1");
    desk.enter("END DOWN RIGHT RIGHT E N D UP");
    assert_eq!(desk.editor.cursor(), 1);
    assert_eq!(word(&desk), "; STA1");
    desk.enter("NO_ENT END");
    assert_eq!(desk.blocks(), ["L X+10 R0 FMAX", "STOP ; END"]);
    // While the block is entered.
    desk.enter("L X 5");
    desk.editor.type_text(";to the edge");
    assert_eq!(desk.prompt(), "COMMENT?");
    desk.enter("END");
    desk.editor.type_text("; after it");
    desk.enter("END");
    assert_eq!(
        desk.blocks()[1..],
        ["L X+5 ; to the edge", "; after it", "STOP ; END"]
    );
    // A comment has none of its own.
    desk.enter("RIGHT RIGHT");
    assert_eq!(word(&desk), "; after it");
    desk.enter("END UP");
    // In a cycle each block may have one.
    desk.enter("CYCL_DEF 9 ENT");
    desk.editor.type_text("2;wait");
    desk.enter("END");
    assert_eq!(
        desk.blocks()[2..4],
        ["CYCL DEF 9.0 DWELL TIME", "CYCL DEF 9.1 DWELL 2 ; wait"]
    );
    // What is open survives, with its comment.
    desk.enter("DEL L X 7");
    desk.editor.type_text(";half");
    let draft = desk.editor.draft().unwrap().to_string();
    let mut again = Desk {
        editor: bahn_dialogue::Editor::new(desk.editor.program().clone(), desk.editor.setting().clone()),
    };
    assert!(again.editor.restore(&draft.parse().unwrap()));
    again.enter("END");
    assert_eq!(again.blocks()[2], "L X+7 ; half");
}

/// Without an alpha keyboard RIGHT ends at the last word; a protected program has nothing to be entered.
#[test]
fn a_comment_has_a_soft_key() {
    let mut desk = Desk::with("L X+10", Tnc360);
    desk.enter("DOWN RIGHT RIGHT RIGHT RIGHT");
    assert_eq!(word(&desk), "X+10");
    desk.enter("END SK_RIGHT SK2 N 1 END");
    assert_eq!(desk.blocks(), ["L X+10 ; N1"]);
    desk.enter("GOTO 0 ENT SK_RIGHT");
    desk.refuses("SK2", KeyNonFunctional);
    let text = "BEGIN PGM 7 MM P\nL X+10\nEND PGM 7 MM\n";
    let program = bahn_program::Program::from_bytes("7.H", text.into());
    assert!(program.is_protected());
    let mut desk = Desk::with("", Tnc415b);
    desk.editor = bahn_dialogue::Editor::new(std::sync::Arc::new(program), desk.editor.setting().clone());
    desk.enter("DOWN RIGHT RIGHT RIGHT RIGHT");
    assert_eq!(word(&desk), "X+10");
    desk.refuses("END SK_RIGHT SK2", ProtectedPgm);
}

/// The word that is highlighted is asked for as in the dialogue [003:1744-1758].
#[test]
fn a_highlighted_word_has_the_question_of_the_dialogue() {
    let mut desk = Desk::with(
        "L X+10 IY+20 RL F200 M3\nCYCL DEF 4.0 POCKET MILLING\nCYCL DEF 4.1 SET UP -2",
        Tnc360,
    );
    desk.enter("DOWN RIGHT");
    assert_eq!(desk.prompt(), "", "nothing is asked of the head of a block");
    let mut asked = Vec::new();
    for _ in 0..5 {
        desk.enter("RIGHT");
        let question = desk.editor.question().unwrap();
        assert_eq!(question.entered, word(&desk));
        asked.push(question.prompt);
    }
    assert_eq!(
        asked,
        [
            "COORDINATES?",
            "COORDINATES?",
            "TOOL RADIUS COMP.: RL/RR/NO COMP.?",
            "FEED RATE F = ? / F MAX = ENT",
            "MISCELLANEOUS FUNCTION M?"
        ]
    );
    // What is entered stands beside the question.
    desk.enter("8");
    assert_eq!(desk.editor.question().unwrap().entered, "M8");
    desk.enter("END DOWN DOWN RIGHT RIGHT");
    let question = desk.editor.question().unwrap();
    assert_eq!((question.id, question.entered.as_str()), ("cycle SET UP", "-2"));
    assert_eq!(question.prompt, "SETUP CLEARANCE?");
    desk.enter("END");
    assert_eq!(desk.prompt(), "");
}
