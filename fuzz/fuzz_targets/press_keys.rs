//! Any keys make a program: the editor never panics, what it makes can be read, and what is open is never lost.
//!
//! ```text
//! cargo +nightly fuzz run press_keys
//! ```

#![no_main]

use std::sync::Arc;

use bahn_dialogue::{BuilderCycle, Draft, Editor, Key, Reaction, Setting};
use bahn_fuzz as _;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_program::{Operation, Program};
use libfuzzer_sys::fuzz_target;

const PROGRAM: &str = "BEGIN PGM 7 MM
LBL 1
L X+10 IY-5.5 RL F200 M3
CYCL DEF 7.0 DATUM SHIFT
CYCL DEF 7.1 X+40
; a comment
/ L Z+50 FMAX ; optional
TOOL CALL 1 Z S500
CYCL DEF 21.0 PILOT DRILLING
CYCL DEF 21.1 Q10=+5 Q11=+100 Q13=+1
FN1: Q1 = +Q2 + -5
CALL LBL 1 REP 5/5
END PGM 7 MM
";

const ISO: &str = "%7 G71 *
N10 T1 G17 S1000 *
N20 G00 G40 G90 Z+50 M3 *
N30 / G01 X+10 G91 Y-5.5 F200 ; optional *
N31 G83 P01 -2 P02 -20 P03 -5 P04 0.5 P05 80 *
X+Q5 *
N40 ; a comment *
N99999 %7 G71 *
";

fuzz_target!(|bytes: &[u8]| {
    let Some((first, keys)) = bytes.split_first() else {
        return;
    };
    let models = ControlModel::ALL;
    let model = models[usize::from(*first) % models.len()];
    let (name, text) = match usize::from(*first) / models.len() % 2 {
        0 => ("7.H", PROGRAM),
        _ => ("7.I", ISO),
    };
    let program = Program::from_bytes(name, text.as_bytes().to_vec());
    let mut setting = Setting::of(&ParameterList::reference(model));
    setting.builder_cycles = vec![BuilderCycle {
        number: 68,
        name: "Bolt hole circle".to_owned(),
        parameters: (1..=7)
            .map(|number| (number, format!("PARAMETER {number}?")))
            .collect(),
    }];
    setting.iso_step = u32::from(*first) % 11;
    let mut editor = Editor::new(Arc::new(program), setting);
    for key in keys.iter().filter_map(|byte| Key::ALL.get(usize::from(*byte))) {
        let before = Arc::clone(editor.program());
        let reaction = editor.key(*key);
        let after = editor.program();
        assert_eq!(
            reaction == Reaction::Edited,
            !Arc::ptr_eq(&before, after),
            "{key}"
        );
        let view = editor.view(3, 3);
        assert_eq!(view.rows.iter().filter(|row| row.current).count(), 1);
        if reaction == Reaction::Edited {
            let invalid = |operation: &Operation| matches!(operation, Operation::Invalid(_));
            assert!(
                !after.blocks().any(|block| invalid(&block.block.operation)),
                "{key}"
            );
        }
        if let Some(draft) = editor.draft() {
            let kept = draft.to_string().parse::<Draft>();
            let mut again = Editor::new(Arc::clone(after), editor.setting().clone());
            assert!(kept.is_ok_and(|kept| again.restore(&kept)), "{draft}");
            assert_eq!(again.draft(), Some(draft));
        }
    }
});
