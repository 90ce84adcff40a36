//! Programs as files: block numbers, labels, missing BEGIN and END, and the many spellings of real files.

use bahn_program::{Block, Operation, Program, Unit};

fn program(text: impl AsRef<[u8]>) -> Program {
    Program::from_bytes("TEST.H", text.as_ref().to_vec())
}

fn blocks(text: impl AsRef<[u8]>) -> Vec<Block> {
    program(text).blocks().map(|numbered| numbered.block).collect()
}

const PLAIN: &str = "BEGIN PGM 7 MM
BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+100 Y+100 Z+0
TOOL DEF 1 L+0 R+2.5
TOOL CALL 1 Z S1000
CYCL DEF 1.0 PECKING
CYCL DEF 1.1 SET UP -2
CYCL DEF 1.2 DEPTH -15
CYCL DEF 1.3 PECKG -10
CYCL DEF 1.4 DWELL 0
CYCL DEF 1.5 F80
FN0: Q1 = +30
LBL 2
L X+Q1 Y-10.5 R0 FMAX M99
FN1: Q1 = +Q1 + +5
CALL LBL 2 REP 3/3
L Z+100 R0 FMAX M2
END PGM 7 MM
";

#[test]
fn block_numbers_are_those_of_the_listing() {
    let p = program(PLAIN);
    assert_eq!(p.block_count(), 18);
    assert_eq!(p.label(2), Some(12));
    assert_eq!(p.label(0), None);
    assert_eq!(p.label(60_000), None);
    assert_eq!(p.line_of(12), 13);
    assert_eq!(p.text_of(12), "LBL 2");
    assert_eq!(p.unit(), Unit::Mm);
    assert_eq!(p.name(), "TEST.H");
    let numbers: Vec<u32> = p.blocks().map(|block| block.number).collect();
    assert_eq!(numbers, (0..18).collect::<Vec<_>>());
}

/// After block 65535 of a digitized program the numbers begin again with 0 [003:6853]: all of its blocks are read, and what
/// is counted goes on.
#[test]
fn numbers_that_begin_again() {
    let mut text = String::from("0 BEGIN PGM DATA MM\n");
    for block in 1..70_000_u32 {
        text += &format!("{} L X+{block}\n", block % 65_536);
    }
    text += &format!("{} END PGM DATA MM\n", 70_000 % 65_536);
    let p = program(&text);
    assert_eq!(p.block_count(), 70_001);
    assert_eq!(
        p.blocks()
            .filter(|block| matches!(block.block.operation, Operation::Motion(_)))
            .count(),
        69_999
    );
    // As it is written: 65537 is block 1 again.
    assert_eq!(p.text_of(65_537), "1 L X+65537");
}

#[test]
fn nine_spellings_of_one_program_are_the_same_blocks() {
    let expected = blocks(PLAIN);
    let numbered: String = PLAIN
        .lines()
        .enumerate()
        .map(|(number, line)| format!("{number} {line}\n"))
        .collect();
    let spellings: [(&str, Vec<u8>); 9] = [
        ("block numbers", numbered.clone().into_bytes()),
        ("CR LF", PLAIN.replace('\n', "\r\n").into_bytes()),
        ("CR", PLAIN.replace('\n', "\r").into_bytes()),
        (
            "small letters",
            PLAIN.to_lowercase().replace("set up", "SET UP").into_bytes(),
        ),
        (
            "decimal comma",
            PLAIN.replace("2.5", "2,5").replace("10.5", "10,5").into_bytes(),
        ),
        (
            "no plus signs",
            PLAIN.replace('+', "").replace("Q1  5", "Q1 + 5").into_bytes(),
        ),
        (
            "byte-order mark, blank lines, tabs, Ctrl-Z",
            format!(
                "\u{feff}{}\n\x1a\0\0",
                numbered.replace('\n', "\n\n\t ").replace(' ', "\t ")
            )
            .into_bytes(),
        ),
        (
            "blanks inside and no blanks between words",
            PLAIN
                .replace("R0 FMAX M99", "R0F MAXM99")
                .replace("L X+Q1 Y-10.5 ", "LX + Q1Y -10.5")
                .replace("LBL 2 REP 3/3", "LBL2REP3 / 3")
                .replace("CYCL DEF 1.", "CYCLE DEF1 .")
                .replace("FN0:", "FN 0 :")
                .into_bytes(),
        ),
        (
            "continuation lines and annotation",
            PLAIN
                .replace("TOOL DEF 1 ", "TOOL DEF 1 ~\n    ")
                .replace("S1000", "S1000.....Tool call")
                .into_bytes(),
        ),
    ];
    for (spelling, text) in spellings {
        let mut found = blocks(&text);
        for (block, expected) in found.iter_mut().zip(&expected) {
            name_as_in(block, expected);
        }
        assert_eq!(found, expected, "{spelling}");
    }
}

/// Names of cycles are decoration.
fn name_as_in(block: &mut Block, expected: &Block) {
    if let (Operation::Cycle(found), Operation::Cycle(expected)) = (&mut block.operation, &expected.operation)
    {
        use bahn_program::CycleWord::Text;
        for (word, expected) in found.words.iter_mut().zip(&expected.words) {
            if let (Text(text), Text(name)) = (&mut *word, expected) {
                assert!(text.eq_ignore_ascii_case(name), "{text} {name}");
                *word = Text(name.clone());
            }
        }
    }
}

#[test]
fn begin_and_end_are_implied() {
    let p = program("L X+1\nLBL 3\n");
    assert_eq!(p.block_count(), 4);
    assert!(p.begin().is_none() && p.end().is_none());
    let all: Vec<_> = p.blocks().collect();
    assert!(matches!(all[0].block.operation, Operation::Begin(_)));
    assert!(matches!(all[3].block.operation, Operation::End(_)));
    assert_eq!(p.label(3), Some(2));
    assert_eq!((p.line_of(1), p.text_of(1).as_str()), (1, "L X+1"));
    assert_eq!((p.line_of(0), p.line_of(2), p.line_of(3)), (1, 2, 2));
    let empty = program("");
    assert_eq!(empty.block_count(), 2);
    assert_eq!(empty.blocks().count(), 2);
}

#[test]
fn text_around_the_program_is_no_part_of_it() {
    let p = program("; header\nLBL 1\n0 BEGIN PGM A INCH\n1 LBL 2\n2 END PGM A INCH\n3 LBL 4\n");
    assert_eq!(p.block_count(), 3);
    assert_eq!((p.label(1), p.label(2), p.label(4)), (None, Some(1), None));
    assert_eq!((p.unit(), p.line_of(0)), (Unit::Inch, 3));
    assert_eq!(p.blocks().count(), 3);
}

#[test]
fn a_second_begin_is_invalid() {
    let all = blocks("BEGIN PGM A MM\n1 BEGIN PGM B MM\nEND PGM A MM");
    let Operation::Invalid(invalid) = &all[1].operation else {
        panic!("{:?}", all[1])
    };
    assert_eq!((&*invalid.text, invalid.error.column), ("BEGIN PGM B MM", 3));
}

#[test]
fn labels_set_twice_are_recorded() {
    let p = program("LBL 5\nLBL 0\nLBL 5\nLBL 0\nLBL 6\n12 / lbl5");
    assert_eq!(p.repeated_labels(), [(5, 3), (5, 6)]);
    assert_eq!(p.labels().collect::<Vec<_>>(), [(5, 1), (6, 5)]);
}

#[test]
fn chunks_join_to_the_whole_program() {
    for (begin, end) in [
        ("", ""),
        ("BEGIN PGM 1 MM\n", ""),
        ("", "END PGM 1 MM"),
        ("BEGIN PGM 1 MM\n", "END PGM 1 MM"),
    ] {
        for count in [0, 1, 254, 255, 256, 257, 510, 511, 512, 513] {
            let lines: String = (0..count).map(|i| format!("L X+{i} ; {i}\n\n")).collect();
            let p = program(format!("{begin}{lines}{end}"));
            assert_eq!(p.block_count(), count + 2);
            let mut joined = Vec::new();
            for index in 0..p.chunk_count() {
                let chunk = p.decode(index);
                assert_eq!(chunk.first_block as usize, joined.len());
                joined.extend(chunk.blocks);
            }
            let all: Vec<_> = p.blocks().collect();
            assert_eq!(joined.len(), p.block_count() as usize, "{begin}{count}{end}");
            for (numbered, block) in all.iter().zip(&joined) {
                assert_eq!(&numbered.block, block);
                assert_eq!(
                    p.line_of(numbered.number),
                    numbered.line,
                    "{begin}{count}{end} {}",
                    numbered.number
                );
            }
            assert!(p.decode(p.chunk_count()).blocks.is_empty());
        }
    }
}

#[test]
fn programs_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>(_: &T) {}
    shared(&program(PLAIN));
}

#[test]
fn the_index_is_small() {
    let text = "L X+12.345 Y-6.789\n".repeat(100_000);
    let p = program(&text);
    // 8 bytes for every 256 blocks: a million blocks take 32 kB.
    assert_eq!(p.chunk_count(), 100_002_u32.div_ceil(256));
    assert_eq!(p.block_count(), 100_002);
}

/// A program that comes in pieces of any size is the whole program: blocks, lines and labels.
#[test]
fn growing_programs() {
    let body =
        "front\n\n0 BEGIN PGM 1 MM\n1 ; a ~\n b\n2 LBL 5\nL X+5 ~\n Y+6\n\nL X+7\nLBL 0\nEND PGM 1 MM\n";
    for line_end in ["\n", "\r\n", "\r"] {
        let text = body.replace('\n', line_end);
        let whole = Program::from_bytes("1.H", text.clone().into_bytes());
        for size in [1, 2, 7, 100] {
            let mut program = Program::growing("1.H");
            for bytes in text.as_bytes().chunks(size) {
                let before = program.known().end;
                program = program.more(bytes);
                assert!(program.known().end >= before);
            }
            assert!(!program.is_growing(), "END ends it");
            assert!(program.blocks().eq(whole.blocks()), "{line_end:?} {size}");
            assert_eq!((program.begin(), program.end()), (whole.begin(), whole.end()));
            assert!(program.labels().eq(whole.labels()));
        }
    }
    // Without BEGIN and END.
    let open = Program::growing("1.H").more(b"L X+1\nL X+2");
    assert_eq!((open.known(), open.completed().known()), (0..0, 0..4));
    let begun = Program::growing("1.H").more(b"BEGIN PGM 1 MM\nL X+1\nL X+2");
    assert_eq!((begun.known(), begun.completed().known()), (0..2, 0..4));
}

/// A long program that is forgotten after the block being executed stays small, and its numbers and lines stay.
#[test]
fn forgotten_blocks() {
    let mut program = Program::growing("1.H").more(b"BEGIN PGM 1 MM\n");
    for at in 1..=20_000 {
        program = program.more(format!("L X+{at}\n").as_bytes());
        program = program.forget(program.known().end.saturating_sub(10));
        assert!(program.known().len() < 600, "{:?}", program.known());
    }
    program = program.more(b"END PGM 1 MM\n");
    assert_eq!(
        (program.text_of(20_000), program.line_of(20_000)),
        ("L X+20000".to_owned(), 20_001)
    );
    assert_eq!(program.text_of(3), "");
    assert!(program.to_bytes().len() < 20_000);
}
