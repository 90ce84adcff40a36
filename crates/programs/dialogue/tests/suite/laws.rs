//! Laws: whatever keys are pressed, the program can be read, undo goes back, and nothing that is open is lost.

use std::sync::Arc;

use crate::desk::setting;
use bahn_dialogue::{Draft, Editor, Key, KeyGroup, Reaction};
use bahn_parameters::ControlModel;
use bahn_program::{Operation, Program};
use proptest::prelude::*;
use proptest::sample::select;

const PROGRAM: &str = "BEGIN PGM 7 MM
BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+100 Y+100 Z+0
TOOL DEF 1 L+0 R+5
TOOL CALL 1 Z S1000
CYCL DEF 4.0 POCKET MILLING
CYCL DEF 4.1 SET UP -2
CYCL DEF 4.2 DEPTH -10
CYCL DEF 4.3 PECKG -4 F80
CYCL DEF 4.4 X+80
CYCL DEF 4.5 Y+40
CYCL DEF 4.6 F100 DR+ RADIUS 0
L X+10 IY-5.5 RL F200 M3
CYCL CALL
LBL 1
CR X+1 Y+2 R-5 DR- R0 FMAX
CP IPA+720 IZ-5 DR+ RL F100
; a comment
/ L Z+50 FMAX ; optional
FN1: Q1 = +Q2 + -5
CALL LBL 1 REP 5/5
CYCL DEF 7.0 NULLPUNKT
CYCL DEF 7.1 X+40
CYCL DEF 7.2 IY+60
STOP
L X+1 FOO
END PGM 7 MM
";

const ISO: &str = "%7 G71 *
N10 G30 G17 X+0 Y+0 Z-20 *
N20 T1 G17 S1000 *
N30 G00 G40 G90 Z+50 M3 *
N40 G83 P01 -2 P02 -20 P03 -5 P04 0.5 P05 80 *
N50 / G01 X+10 G91 Y-5.5 F200 ; optional *
N60 ; a comment *
X+Q5 *
N61 X+1 FOO *
N62 G98 L1 *
N99999 %7 G71 *
";

/// Keys as they may come, those of numbers and ENT more often.
fn key() -> impl Strategy<Value = Key> {
    prop_oneof![
        3 => select(Key::ALL.to_vec()),
        4 => select(vec![Key::Ent, Key::NoEnt, Key::End, Key::Right, Key::Left, Key::Up, Key::Down]),
        3 => select(vec![Key::Digit1, Key::Digit2, Key::Digit5, Key::Digit0, Key::Point, Key::Sign, Key::Q, Key::I]),
        2 => select(vec![Key::X, Key::Y, Key::Z, Key::L, Key::CyclDef, Key::ToolCall, Key::Del, Key::Ce]),
    ]
}

fn model() -> impl Strategy<Value = ControlModel> {
    select(ControlModel::ALL.to_vec())
}

fn editor(model: ControlModel) -> Editor {
    editor_of("7.H", model)
}

fn editor_of(name: &str, model: ControlModel) -> Editor {
    let text = if name.ends_with('I') { ISO } else { PROGRAM };
    let program = Program::from_bytes(name, text.as_bytes().to_vec());
    let mut setting = setting(model);
    setting.iso_step = 5;
    Editor::new(Arc::new(program), setting)
}

fn name() -> impl Strategy<Value = &'static str> {
    select(vec!["7.H", "7.I"])
}

/// Blocks that cannot be read.
fn unreadable(program: &Program) -> usize {
    let invalid = |operation: &Operation| matches!(operation, Operation::Invalid(_));
    program
        .blocks()
        .filter(|block| invalid(&block.block.operation))
        .count()
}

fn texts(program: &Program) -> Vec<u8> {
    program.to_bytes()
}

/// One key, and what must hold after it.
fn press(editor: &mut Editor, key: Key) -> Reaction {
    let before = Arc::clone(editor.program());
    let reaction = editor.key(key);
    let after = editor.program();
    assert_eq!(
        reaction == Reaction::Edited,
        !Arc::ptr_eq(&before, after),
        "{key}: {reaction:?}"
    );
    let view = editor.view(5, 5);
    assert!(editor.cursor() < after.block_count());
    assert_eq!(view.message, editor.message());
    assert!(
        view.rows.iter().filter(|row| row.current).count() == 1,
        "{view:?}"
    );
    assert!(
        view.words.iter().filter(|word| word.highlighted).count() <= 1,
        "{view:?}"
    );
    if let Some(question) = view.question {
        assert!(!question.prompt.is_empty());
    }
    if let Reaction::Refused(message) = reaction {
        assert_eq!(view.message, Some(message));
    }
    reaction
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_keys_leave_a_program(keys in prop::collection::vec(key(), 0..400), model in model(), name in name()) {
        let mut editor = editor_of(name, model);
        let begins = |program: &Program| program.text_of(0);
        let ends = |program: &Program| program.text_of(program.block_count() - 1);
        let framed = (begins(editor.program()), ends(editor.program()));
        for key in keys {
            let before = Arc::clone(editor.program());
            let edited = press(&mut editor, key) == Reaction::Edited;
            let after = editor.program();
            prop_assert!(unreadable(after) <= unreadable(&before).max(1), "{}", key);
            prop_assert_eq!((begins(after), ends(after)), framed.clone());
            if edited {
                prop_assert!(texts(after) != texts(&before), "{} changed nothing", key);
            }
        }
    }

    #[test]
    fn undo_goes_back_to_the_beginning_and_redo_to_the_end(keys in prop::collection::vec(key(), 0..200), name in name()) {
        let mut editor = editor_of(name, ControlModel::Tnc360);
        let mut versions = vec![texts(editor.program())];
        for key in keys {
            // Undo and redo themselves are tried below; they stand in the first row.
            let soft = key.group() == KeyGroup::Soft;
            if !soft && press(&mut editor, key) == Reaction::Edited {
                versions.push(texts(editor.program()));
            }
        }
        close(&mut editor);
        for version in versions.iter().rev().skip(1) {
            prop_assert_eq!(editor.key(Key::Sk6), Reaction::Edited);
            prop_assert_eq!(&texts(editor.program()), version);
        }
        prop_assert!(editor.key(Key::Sk6) != Reaction::Edited);
        for version in versions.iter().skip(1) {
            prop_assert_eq!(editor.key(Key::Sk7), Reaction::Edited);
            prop_assert_eq!(&texts(editor.program()), version);
        }
    }

    #[test]
    fn del_drops_what_is_open(keys in prop::collection::vec(key(), 0..60), name in name()) {
        let mut editor = editor_of(name, ControlModel::Tnc360);
        for key in keys {
            let open = editor.draft();
            if open.is_some() {
                let mut dropped = editor.clone();
                prop_assert_eq!(dropped.key(Key::Del), Reaction::Shown);
                prop_assert_eq!(dropped.draft(), None);
                prop_assert_eq!(texts(dropped.program()), texts(editor.program()));
            }
            press(&mut editor, key);
        }
    }

    #[test]
    fn what_is_open_is_taken_up_again(keys in prop::collection::vec(key(), 0..80), more in prop::collection::vec(key(), 0..20), name in name()) {
        let mut first = editor_of(name, ControlModel::Tnc415b);
        for key in keys {
            press(&mut first, key);
        }
        if let Some(draft) = first.draft() {
            let kept: Draft = draft.to_string().parse().unwrap();
            prop_assert_eq!(&kept, &draft);
            let mut second = Editor::new(Arc::clone(first.program()), first.setting().clone());
            prop_assert!(second.restore(&kept), "{draft}");
            prop_assert_eq!(second.draft(), Some(draft));
            first.key(Key::Ce);
            second.key(Key::Ce);
            for key in more.into_iter().filter(|key| key.soft_key().is_none()) {
                let (one, other) = (first.key(key), second.key(key));
                prop_assert_eq!(one, other, "{}", key);
                prop_assert_eq!(texts(first.program()), texts(second.program()));
            }
        }
    }

    /// A draft of anything is refused or taken up, and then any keys go on.
    #[test]
    fn any_draft_is_harmless(
        text in "(block [0-9]{1,2}\n)(source (L|C|CYCL DEF 7|CYCL DEF 68|TCH PROBE 0|FN 15|TEXT|)\n)?(highlighted 1\n)?(question [0-9] [0-3] [0-9]\n)?(typing [0-2] [01]\n)?(word [0-9] [0-3] [01]\t(X|PR|)\t[-Q0-9.]{0,5}\n){0,4}",
        keys in prop::collection::vec(key(), 0..30),
    ) {
        let mut editor = editor(ControlModel::Tnc360);
        if editor.restore(&text.parse::<Draft>().unwrap()) {
            for key in keys {
                press(&mut editor, key);
            }
        }
    }
}

/// Ends whatever is open.
fn close(editor: &mut Editor) {
    while editor.is_open() {
        editor.key(Key::Del);
    }
    for _ in 0..9 {
        editor.key(Key::Left);
    }
    editor.key(Key::Ce);
    assert!(!editor.view(0, 0).words.iter().any(|word| word.highlighted));
}
