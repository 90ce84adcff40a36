//! Editing: a version after any edits is the program that its whole text gives.

#[allow(dead_code, reason = "damage is for files, not for blocks")]
use bahn_parameters::{ControlModel, MessageId};
use bahn_program::{Block, Edit, EditError, FormatOptions, Operation, Program, format_block};
use proptest::prelude::*;
use proptest::sample::Index;

fn read(text: impl Into<Vec<u8>>) -> Program {
    Program::from_bytes("TEST.H", text.into())
}

fn blocks(program: &Program) -> Vec<Block> {
    program.blocks().map(|numbered| numbered.block).collect()
}

/// Everything that can be asked of a program is as if its text had just been read.
fn is_as_read(edited: &Program) {
    let read = read(edited.to_bytes());
    let text = String::from_utf8_lossy(&edited.to_bytes()).into_owned();
    let all: Vec<_> = read.blocks().collect();
    assert_eq!(edited.blocks().collect::<Vec<_>>(), all, "{text:?}");
    assert_eq!((edited.begin(), edited.end()), (read.begin(), read.end()));
    assert_eq!(edited.block_count(), read.block_count());
    assert_eq!(edited.refused(), read.refused(), "{text:?}");
    assert!(edited.labels().eq(read.labels()), "{text:?}");
    assert_eq!(edited.repeated_labels(), read.repeated_labels());
    let limits = ControlModel::Tnc360.limits();
    let reading = Some(limits.into());
    assert_eq!(edited.diagnostics(reading), read.diagnostics(reading), "{text:?}");
    assert_eq!(edited.chunk_count(), read.chunk_count());
    for chunk in 0..read.chunk_count() {
        assert_eq!(edited.decode(chunk), read.decode(chunk), "{text:?}");
    }
    for found in all.iter().step_by(1 + all.len() / 8) {
        assert_eq!(edited.line_of(found.number), read.line_of(found.number));
        assert_eq!(
            edited.text_of(found.number),
            read.text_of(found.number),
            "{text:?}"
        );
        assert_eq!(
            edited.text_of_line(found.line),
            read.text_of_line(found.line),
            "{text:?}"
        );
    }
}

/// An edit whose places are parts of the program, so that it suits a program of any length.
#[derive(Clone, Debug)]
enum Random {
    Insert(Index, String),
    Replace(Index, String),
    Delete(Index, u32),
    Renumber,
}

fn text() -> impl Strategy<Value = String> {
    let block = crate::generate::block().prop_map(|block| format_block(&block, FormatOptions::default()));
    prop_oneof![
        6 => block,
        1 => prop::collection::vec(crate::generate::fragment(), 0..12).prop_map(|words| words.concat()),
        1 => prop::sample::select(vec![
            "; a ~", "L X+1 ~", "12 ; b ~\n 13 L X+2", "~", "L X+1 ~\n Y+2", "; ~~~", "LBL 1", "LBL 2", "CALL LBL 2",
            "END PGM 1 MM", "BEGIN PGM 1 MM", "\n\nL Y+1\n\n", "", "%5 G71",
        ])
        .prop_map(str::to_owned),
    ]
}

fn random() -> impl Strategy<Value = Random> {
    prop_oneof![
        4 => (any::<Index>(), text()).prop_map(|(at, text)| Random::Insert(at, text)),
        2 => (any::<Index>(), text()).prop_map(|(at, text)| Random::Replace(at, text)),
        3 => (any::<Index>(), 1..5_u32).prop_map(|(at, count)| Random::Delete(at, count)),
        1 => Just(Random::Renumber),
    ]
}

/// Applies an edit; what the list of blocks then is follows from the list before. The `~` of a comment goes when
/// it would join what now follows it.
fn apply(program: &Program, random: &Random) -> Option<Program> {
    let place = |at: &Index| at.index(program.block_count() as usize + 1) as u32;
    let (edit, range, text) = match random {
        Random::Insert(at, text) => {
            let before = place(at);
            (Edit::Insert { before, text }, before..before, text.as_str())
        }
        Random::Replace(at, text) => {
            let block = place(at);
            (Edit::Replace { block, text }, block..block + 1, text.as_str())
        }
        Random::Delete(at, count) => {
            let blocks = place(at)..place(at) + count;
            (
                Edit::Delete {
                    blocks: blocks.clone(),
                },
                blocks,
                "",
            )
        }
        Random::Renumber => {
            let renumbered = program.edit(&Edit::Renumber { step: 10 }).ok()?;
            let without_places = |program| blocks(program).into_iter().map(without_place).collect::<Vec<_>>();
            assert_eq!(without_places(&renumbered), without_places(program));
            let in_file = |number: &u32| !renumbered.text_of(*number).is_empty();
            for number in (0..program.block_count()).filter(in_file) {
                let text = renumbered.text_of(number);
                assert!(format!("{text} ").starts_with(&format!("{number} ")), "{text}");
            }
            return Some(renumbered);
        }
    };
    let edited = program.edit(&edit).ok()?;
    let mut expected = blocks(program);
    let text = &text
        .replace("\r\n", "\n")
        .replace(['\r'], "\n")
        .replace('\u{feff}', "");
    let own = read(format!(
        "BEGIN PGM 1 MM\n{}",
        text.trim_end_matches(['~', ' ', '\n', '\t'])
    ));
    let own: Vec<Block> = blocks(&own)[1..own.block_count() as usize - 1].to_vec();
    if text.is_empty() || !text.contains('~') {
        expected.splice(range.start as usize..range.end as usize, own);
        let same = |block: Block| without_join(without_place(block));
        let found: Vec<Block> = blocks(&edited).into_iter().map(same).collect();
        let expected: Vec<Block> = expected.into_iter().map(same).collect();
        assert_eq!(
            found,
            expected,
            "{random:?} in {:?}",
            String::from_utf8_lossy(&program.to_bytes())
        );
    }
    Some(edited)
}

fn without_place(mut block: Block) -> Block {
    if let Operation::Invalid(invalid) = &mut block.operation {
        (invalid.error.line, invalid.error.column, invalid.error.length) = (0, 0, 0);
    }
    block
}

fn without_join(mut block: Block) -> Block {
    let trimmed = |text: &str| text.trim_end_matches(['~', ' ', '\t']).into();
    if let Operation::Comment(text) = &mut block.operation {
        *text = trimmed(text);
    }
    block
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn random_edits_give_what_the_whole_text_gives(
        texts in prop::collection::vec(text(), 0..30),
        framed in any::<bool>(),
        line_end in prop::sample::select(vec!["\n", "\r\n", "\r"]),
        edits in prop::collection::vec(random(), 1..12),
    ) {
        let mut text = texts.join("\n").replace('\n', line_end);
        if framed {
            text = format!("front{line_end}BEGIN PGM 1 MM{line_end}{text}{line_end}END PGM 1 MM{line_end}tail");
        }
        let mut program = read(text);
        for edit in &edits {
            if let Some(edited) = apply(&program, edit) {
                is_as_read(&edited);
                program = edited;
            }
        }
    }

}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Programs of several pieces, with labels and calls far apart.
    #[test]
    fn edits_of_long_programs(
        count in 500..1500_u32,
        edits in prop::collection::vec(random(), 1..40),
    ) {
        let lines: Vec<String> = (1..=count)
            .map(|at| match at % 50 {
                0 => format!("LBL {}", at / 50),
                1 => format!("{at} CALL LBL {} REP 2/2", at / 50 + 1),
                _ => format!("{at} L X+{at} R0 FMAX"),
            })
            .collect();
        let mut program = read(format!("BEGIN PGM 1 MM\n{}\nEND PGM 1 MM\n", lines.join("\n")));
        for edit in &edits {
            if let Some(edited) = apply(&program, edit) {
                program = edited;
            }
        }
        is_as_read(&program);
    }
}

#[test]
fn who_runs_a_version_keeps_it() {
    let old = read("BEGIN PGM 1 MM\n1 L X+1 R0 FMAX\n2 LBL 5\n3 LBL 0\nEND PGM 1 MM\n");
    let new = old.edit(&Edit::Delete { blocks: 1..2 }).unwrap();
    assert_eq!((old.label(5), new.label(5)), (Some(2), Some(1)));
    assert_eq!(old.block_count(), 5);
    let renumbered = new.edit(&Edit::Renumber { step: 10 }).unwrap();
    let expected = "0 BEGIN PGM 1 MM\n1 LBL 5\n2 LBL 0\n3 END PGM 1 MM\n";
    assert_eq!(String::from_utf8(renumbered.to_bytes()).unwrap(), expected);
}

/// A rule of `~` joins nothing, and stays.
#[test]
fn comments_around_an_edit_stay() {
    let program = read("; ~~~\n; a ~\n3 L X+1\n");
    let text = "\n\nL Y+1";
    let edited = program.edit(&Edit::Insert { before: 2, text }).unwrap();
    assert_eq!(
        (edited.text_of(1), edited.text_of(2)),
        ("; ~~~".into(), "L Y+1".into())
    );
    // What would join the new text joins nothing.
    let edited = program.edit(&Edit::Insert { before: 3, text }).unwrap();
    assert_eq!(
        (edited.text_of(2), edited.text_of(3)),
        ("; a".into(), "L Y+1".into())
    );
    is_as_read(&edited);
}

/// At the front of a file it would be no text any more.
#[test]
fn byte_order_marks_are_no_text() {
    let program = read("L X+1\n\u{feff}L X+2\n");
    let before = 1;
    let text = "\u{feff}L X+3";
    let edited = program.edit(&Edit::Insert { before, text }).unwrap();
    assert_eq!(edited.text_of(1), "L X+3");
    is_as_read(&edited);
    is_as_read(&program.edit(&Edit::Delete { blocks: 1..2 }).unwrap());
}

/// P after the first and the last block [003:1019]; other words of them stay.
#[test]
fn protection() {
    let open = read("0 BEGIN PGM 1 INCH ; first\r\n1 L X+1\r\n/ 2 END PGM 1 INCH\r\n");
    let closed = open.edit(&Edit::Protect).unwrap();
    let text = "0 BEGIN PGM 1 INCH P ; first\r\n1 L X+1\r\n2 / END PGM 1 INCH P\r\n";
    assert_eq!(String::from_utf8(closed.to_bytes()).unwrap(), text);
    assert!(closed.is_protected() && !open.is_protected());
    is_as_read(&closed);
    let refused = [
        Edit::Delete { blocks: 1..2 },
        Edit::Insert {
            before: 1,
            text: "L Y+1",
        },
        Edit::Replace {
            block: 1,
            text: "L Y+1",
        },
        Edit::Renumber { step: 10 },
        Edit::Protect,
    ];
    for edit in refused {
        let error = closed.edit(&edit).unwrap_err();
        assert_eq!(
            (error, error.message()),
            (EditError::Protected, MessageId::ProtectedPgm)
        );
    }
    let again = closed.edit(&Edit::Unprotect).unwrap();
    assert_eq!(blocks(&again), blocks(&open));
    // Without a unit the P would be a part of the name.
    let nameless = read("BEGIN PGM 7\nEND PGM 7").edit(&Edit::Protect).unwrap();
    assert_eq!(nameless.to_bytes(), b"BEGIN PGM 7 MM P\nEND PGM 7 MM P\n");
    assert_eq!(read("L X+1").edit(&Edit::Protect).err(), Some(EditError::Frame));
}

#[test]
fn refused_edits() {
    let program = read("BEGIN PGM 1 MM\nL X+1\nEND PGM 1 MM\n");
    let insert = |before, text| program.edit(&Edit::Insert { before, text }).err();
    assert_eq!(insert(0, "L X+1"), Some(EditError::Frame));
    assert_eq!(insert(1, "END PGM 1 MM"), Some(EditError::Frame));
    assert_eq!(insert(1, "L X+1\nbegin 1"), Some(EditError::Frame));
    assert_eq!(insert(3, "L X+1"), Some(EditError::Frame));
    assert_eq!(insert(4, "L X+1"), Some(EditError::NoBlock));
    assert_eq!(insert(1, " \n\n"), Some(EditError::Empty));
    let delete = |blocks| program.edit(&Edit::Delete { blocks }).err();
    assert_eq!(delete(2..3), Some(EditError::Frame));
    assert_eq!(delete(0..1), Some(EditError::Frame));
    assert_eq!(delete(5..6), Some(EditError::NoBlock));
    assert_eq!(delete(1..1), None);
}
