//! Laws of DIN/ISO: the listing of a program is the program again, and what is wrong is said where it stands.

use crate::laws::check_listings;
use bahn_parameters::ControlModel;
use bahn_parameters::MessageId::{self, *};
use bahn_path::Axis;
use bahn_program::*;
use proptest::prelude::*;
use proptest::sample::select;

const POINT: FormatOptions = FormatOptions {
    decimal_comma: false,
    iso_step: 10,
};
const WITHOUT_NUMBERS: FormatOptions = FormatOptions {
    decimal_comma: true,
    iso_step: 0,
};

fn read(text: impl Into<Vec<u8>>) -> Program {
    Program::from_bytes("TEST.I", text.into())
}

fn check_laws(bytes: &[u8]) {
    let written = [POINT, WITHOUT_NUMBERS];
    let program = check_listings("TEST.I", bytes, written, ControlModel::Tnc151);
    for block in 0..program.block_count() {
        let text = program.text_of(block);
        for word in program.language().parse_block(&text).words {
            assert!(
                text.get(word.span.clone()).is_some() && text.get(word.value).is_some(),
                "{text:?}"
            );
        }
    }
}

/// Words that are functions, and what is written beside them.
const FUNCTIONS: &[&str] = &[
    "G00",
    "G01",
    "G02",
    "G03",
    "G05",
    "G06",
    "G07",
    "G10",
    "G11",
    "G12",
    "G13",
    "G15",
    "G16",
    "G17",
    "G18",
    "G19",
    "G40",
    "G41",
    "G42",
    "G43",
    "G44",
    "G90",
    "G91",
    "M3",
    "M13",
    "M103 F25",
    "G24",
    "G25",
    "G26",
    "G27",
    "G28",
    "G29",
    "G30",
    "G31",
    "G36",
    "G37",
    "G38",
    "G39",
    "G53",
    "G54",
    "G55",
    "G58",
    "G72",
    "G73",
    "G75",
    "G79",
    "G83",
    "G98 L5",
    "G99",
    "G51",
    "L1,0",
    "L2,5",
    "D00 Q5 P01 +1",
    "D9 P1+1 P2+2 P3 1",
    "D15 P01 3",
    "%NAME",
    "%7 G71",
    "Q1 = 2 + 3",
    "; note",
    "*",
    "/",
    "X",
    "FMAX",
];

/// Words in any order.
fn good() -> impl Strategy<Value = String> {
    let number = (-100_000_i32..100_000, 0..4).prop_map(|(n, d)| f64::from(n) / 10_f64.powi(d));
    let value = prop_oneof![
        4 => number.prop_map(|n| format!("{n:+}")),
        1 => (0..114).prop_map(|q| format!("+Q{q}")),
        1 => (0..114).prop_map(|q| format!("-Q{q}")),
    ];
    let word = (
        select(vec![
            "X", "Y", "Z", "A", "B", "C", "U", "V", "W", "I", "J", "K", "R", "H", "F", "S", "T", "G", "M",
            "P01 ", "P02 ", "P05 X", "Q1=", "L",
        ]),
        value,
    )
        .prop_map(|(address, value)| format!("{address}{value}"));
    let function = select(FUNCTIONS).prop_map(str::to_owned);
    prop::collection::vec(prop_oneof![word, function], 0..8).prop_map(|words| words.join(" "))
}

/// Blocks that are complete, each with what it is written like.
const COMPLETE: &str = include_str!("../data/complete-iso.txt");

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn programs_keep_the_laws(lines in prop::collection::vec((0..3_u8, good()), 0..20)) {
        let mut text = String::from("%7 G71 *\n");
        for (number, (kind, line)) in (1..).zip(lines) {
            match kind {
                0 => text += &format!("{line}\n"),
                1 => text += &format!("N{number}0 {line}*\n"),
                _ => text += &format!("N{number} {line} * ; c *\n"),
            }
        }
        check_laws(text.as_bytes());
    }

    #[test]
    fn complete_blocks_read_back(picks in prop::collection::vec(select(COMPLETE.lines().collect::<Vec<_>>()), 1..30)) {
        let text = format!("%7 G71 *\n{} *\nN99999 %7 G71 *\n", picks.join(" *\n"));
        let program = read(text.clone());
        prop_assert!(program.blocks().all(|b| !matches!(b.block.operation, Operation::Invalid(_))), "{}", text);
        check_laws(text.as_bytes());
    }

    #[test]
    fn any_bytes_keep_the_laws(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        check_laws(&bytes);
    }

    #[test]
    fn any_letters_keep_the_laws(text in "[GNXYRHFPDQTSLM0-9+.,;*%/ =\n-]{0,120}") {
        check_laws(text.as_bytes());
    }
}

/// What a complete block is written like is what it was; the step of its number is that of MP7220.
#[test]
fn listings_are_normal() {
    let text: String = COMPLETE.lines().map(|block| format!("{block} *\n")).collect();
    let program = read(format!("%7 G71 *\n{text}N99999 %7 G71 *\n"));
    let listing = format_program(&program, POINT).to_string();
    for (number, (block, line)) in (1..).zip(COMPLETE.lines().zip(listing.lines().skip(1))) {
        assert_eq!(line, format!("N{} {block} *", number * 10));
    }
    let bare = FormatOptions { iso_step: 0, ..POINT };
    let bare = format_program(&program, bare).to_string();
    assert_eq!(bare.lines().nth(1), Some("G10 G40 R+5 H+30 F250 M3 M8 *"));
    assert_eq!(bare.lines().last(), Some("%7 G71 *"));
}

#[test]
fn the_ends_of_programs() {
    for (begin, end) in [
        ("%1000 G71 *", "N99999 %1000 G71 *"),
        ("% 1000 G71 *", "N9999 % 1000 G71"),
        ("%1000 G71", "N99999999 %1000 G71*"),
        ("%1000 G71*", "%1000 G71*"),
    ] {
        let program = read(format!("{begin}\nN10 G00 X+5 *\n{end}\n"));
        let name = |header: Option<&Header>| header.map(|header| (header.name.to_string(), header.unit));
        let expected = Some(("1000".to_owned(), Some(Unit::Mm)));
        assert_eq!(
            (name(program.begin()), name(program.end())),
            (expected.clone(), expected)
        );
        assert_eq!(program.block_count(), 3, "{begin}");
        assert_eq!(program.diagnostics(None), [], "{begin}");
    }
    let inches = read("%A G70 G50 *\nN99999 %A G70 *\n");
    assert_eq!(
        (inches.unit(), inches.begin().unwrap().protected),
        (Unit::Inch, true)
    );
    assert!(read("N10 G00 X+5 *\n").begin().is_none());
}

/// N number is the block of reports, and the line that of the file.
#[test]
fn blocks_have_the_numbers_that_are_programmed() {
    let program = read("%7 G71 *\n\nN10 G00 X+5 *\nX+6\n/N30 X+7\nN99999 %7 G71 *\n");
    let numbers: Vec<u32> = (0..program.block_count())
        .map(|block| program.number_of(block))
        .collect();
    assert_eq!(numbers, [0, 10, 2, 30, 99_999]);
    assert_eq!(program.line_of(1), 3);
}

fn fault(text: &str) -> (MessageId, u32, u32) {
    let read = IsoLanguage.parse_block(text);
    match (read.block.operation, read.faults.first()) {
        (Operation::Invalid(invalid), Some(fault)) => {
            assert_eq!(*fault, invalid.error, "{text}");
            (fault.message, fault.column, fault.length)
        }
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn faults_have_their_places() {
    for (text, found) in [
        ("N10 G00 X+5 X+6 *", (AxisDoubleProgrammed, 13, 3)),
        ("N10 G01 X+1..5 *", (EntryValueIncorrect, 10, 5)),
        ("N10 G01 X *", (EntryValueIncorrect, 9, 1)),
        ("N10 G49 X+5", (BlockNotKnown, 5, 3)),
        ("N10 G00 G01 X+5", (UnexpectedText, 9, 3)),
        ("N10 G01 X+5 H+30", (UnexpectedText, 13, 4)),
        ("N10 G01 R+5", (UnexpectedText, 9, 3)),
        ("N10 G00 X+5 FOO", (EntryValueIncorrect, 13, 3)),
        ("N10 G00 X+5 E4", (BlockNotKnown, 13, 2)),
        ("N10 G20 T1", (WrongAxisProgrammed, 5, 3)),
        ("N10 G98 LX", (EntryValueIncorrect, 9, 2)),
    ] {
        assert_eq!(fault(text), found, "{text}");
    }
    for (text, message) in [
        ("G83 P01 -2 P02 -20", CyclIncomplete),
        ("G83 P01 -2 P02 -20 P03 -5 P04 0 P05 80 P06 1", UnexpectedText),
        ("G37", CyclIncomplete),
        ("D00 P01 +5", EntryValueIncorrect),
        ("D20 Q1", BlockNotKnown),
        ("G25", EntryValueIncorrect),
        ("G71", UnexpectedText),
        ("G07 X+5 Y+6", UnexpectedText),
        ("G01 X+5 G43", UnexpectedText),
        ("%", EntryValueIncorrect),
    ] {
        match text {
            "%" => assert!(matches!(
                IsoLanguage.parse_block(text).block.operation,
                Operation::Begin(_)
            )),
            text => assert_eq!(fault(text).0, message, "{text}"),
        }
    }
    let all = IsoLanguage.parse_block("N10 G01 X+1..5 E2 Y+2 Y+3").faults;
    let messages: Vec<_> = all.iter().map(|fault| fault.message).collect();
    assert_eq!(
        messages,
        [EntryValueIncorrect, BlockNotKnown, AxisDoubleProgrammed]
    );
}

/// 150 characters, 64 on the TNC 151.
#[test]
fn blocks_have_a_length() {
    for (model, max) in [(ControlModel::Tnc151, 64), (ControlModel::Tnc415b, 150)] {
        for (length, faults) in [(max, 0), (max + 1, 1)] {
            let block = format!("N10 G00 X+5 ;{}", "x".repeat(length - 13));
            let program = read(format!("%7 G71 *\n{block}\nN99999 %7 G71 *\n"));
            let all = program.diagnostics(Some(model.limits().into()));
            assert_eq!(all.len(), faults, "{all:?}");
            if let Some(fault) = all.first() {
                assert_eq!(
                    (fault.span.line, fault.span.column, fault.span.length),
                    (2, max as u32 + 1, 1)
                );
            }
        }
    }
}

#[test]
fn words_know_their_places() {
    let text = "/ N10 G01 X+5 YQ3 P01 -2 M3 * ; up";
    let words = IsoLanguage.parse_block(text).words;
    let shown: Vec<_> = words
        .iter()
        .map(|word| (&text[word.span.clone()], &text[word.value.clone()]))
        .collect();
    assert_eq!(
        shown,
        [
            ("/", ""),
            ("N10", "10"),
            ("G01", "01"),
            ("X+5", "+5"),
            ("YQ3", "Q3"),
            ("P01 -2", " -2"),
            ("M3", "3"),
            ("; up", "; up"),
        ]
    );
}

/// G91 of an earlier block makes incremental what stands before any G90 and G91.
#[test]
fn open_words_take_what_is_in_force() {
    let read = |text: &str| match IsoLanguage.parse_block(text).block.operation {
        Operation::Modal(block) => *block,
        other => panic!("{other:?}"),
    };
    let block = read("G54 X+5 G90 Y+6");
    let incremental = |distance| -> Vec<bool> {
        let all = block.resolved(distance).flat_map(|part| match part {
            Operation::Cycle(block) => block.words,
            other => panic!("{other:?}"),
        });
        all.map(|word| matches!(word, CycleWord::Coordinate(Axis::X | Axis::Y, word) if word.incremental))
            .collect()
    };
    assert_eq!(incremental(Distance::Absolute), [false, false]);
    assert_eq!(incremental(Distance::Incremental), [true, false]);
}

#[test]
fn numbers_are_written_anew_by_the_step_of_mp7220() {
    let program = read("%7 G71 *\nN3 T1 G17 S500 *\nX+5 *\n/ N9 M3 *\nN99 %7 G71 *\n");
    let numbered = |step| {
        let new = program.edit(&Edit::Renumber { step }).unwrap();
        String::from_utf8(new.to_bytes()).unwrap()
    };
    assert_eq!(
        numbered(5),
        "%7 G71 *\nN5 T1 G17 S500 *\nN10 X+5 *\nN15 / M3 *\nN99999 %7 G71 *\n"
    );
    assert_eq!(
        numbered(0),
        "%7 G71 *\nT1 G17 S500 *\nX+5 *\n/ M3 *\nN99999 %7 G71 *\n"
    );
    // Four blocks after the first in steps of 30,000 reach what the last is called else.
    assert!(numbered(30_000).ends_with("N99999999 %7 G71 *\n"));
}

#[test]
fn blocks_are_found_by_their_numbers() {
    let program = read("%7 G71 *\nN3 M3 *\nX+5 *\nN9 M5 *\nN9 M8 *\nN99999 %7 G71 *\n");
    let shown: Vec<_> = (0..program.block_count())
        .map(|block| program.shown_number(block))
        .collect();
    assert_eq!(shown, ["", "N3", "", "N9", "N9", "N99999"]);
    assert_eq!(program.block_of(9), Some(3));
    // A block without a number is called by its place; 4 is the place of a block that has one.
    assert_eq!((program.block_of(2), program.block_of(4)), (Some(2), None));
    let long: String = (1..=1000)
        .map(|block| format!("N{} X+{block} *\n", block * 7))
        .collect();
    let long = read(format!("%7 G71 *\n{long}N99999 %7 G71 *\n"));
    for block in [1, 255, 256, 257, 999, 1000] {
        assert_eq!(long.block_of(block * 7), Some(block));
    }
}

/// A `~`, which joins nothing here, hides no `*` before it.
#[test]
fn a_name_ends_before_star_and_tilde() {
    for text in [
        &b"% *\x07\0\x08~"[..],
        b"%7 G71\nN10 %8 * ~ *~\nN99 %7 G71",
        b"%~*",
    ] {
        check_laws(text);
    }
    let program = read("%7 G71 *\nN10 %8 * ~\nN99 %7 G71 *\n");
    let called = program.decode(0).blocks[1].operation.clone();
    assert_eq!(called, Operation::CallProgram("8".into()));
}

/// A byte-order mark begins a file; anywhere else it is text, also in the listing, where it might come to the front.
#[test]
fn a_mark_of_byte_order_is_one_at_the_front_only() {
    for text in [
        &b"\x1c\x1c\x1c\xef\xbb\xbf%\n%\x02\x08\n\n%"[..],
        b"\n\xef\xbb\xbf\xff f%\n%\x02",
        b"\n\xef\xbb\xbf%\n%7 G71 *\nN99999 %7 G71 *\n",
        b"\xef\xbb\xbf\xef\xbb\xbf%\n%7 G71 *\nN99999 %7 G71 *\n",
        b"\xef\xbb\xbf; note\n%7 G71 *\nN99999 %7 G71 *\n\xef\xbb\xbf%",
    ] {
        check_laws(text);
    }
    let blocks = |text: &[u8]| read(text).block_count();
    assert_eq!(blocks(b"\xef\xbb\xbf%\n%\n%"), 2);
    assert_eq!(blocks(b" \xef\xbb\xbf%\n%\nM3\n%"), 3);
}

/// A path function that is not a straight line needs its end point in the block that says it: nothing is accepted and then
/// not done. `CP DR+` and `LP` of plain language are ANGLE REFERENCE MISSING, too.
#[test]
fn a_path_function_needs_its_end_point() {
    let message = |block: &str| {
        let program = read(format!("%7 G71 *\nN10 {block} *\nN99999 %7 G71 *\n"));
        match program.decode(0).blocks[1].operation.clone() {
            Operation::Invalid(block) => Some((
                block.error.message,
                block.error.column,
                block.error.detail.to_string(),
            )),
            _ => None,
        }
    };
    for number in ["02", "03", "05", "06", "2", "3"] {
        let arc = "the end point of the arc is missing".to_owned();
        assert_eq!(
            message(&format!("G{number}")),
            Some((MessageId::AngleReferenceMissing, 5, arc)),
            "G{number}"
        );
    }
    for number in [10, 11, 12, 13, 15, 16] {
        for (block, column) in [(format!("G{number}"), 5), (format!("G40 G{number} F100 M3"), 9)] {
            let polar = "H is missing".to_owned();
            assert_eq!(
                message(&block),
                Some((MessageId::AngleReferenceMissing, column, polar)),
                "{block}"
            );
        }
        assert_eq!(message(&format!("G{number} H+90")), None);
        assert_eq!(
            message(&format!("G{number} Z+5")),
            None,
            "the tool axis of a helix"
        );
    }
    let single = "G07 moves one axis".to_owned();
    assert_eq!(message("G07 F100"), Some((MessageId::UnexpectedText, 5, single)));
    let centre = message("I+10 J+10 G02");
    assert_eq!(
        centre.map(|(message, column, _)| (message, column)),
        Some((MessageId::AngleReferenceMissing, 15))
    );
    for fine in [
        "G00 G40 G90",
        "G01 F100",
        "G02 X+5 Y+5",
        "G03 R10 X+5",
        "I+10 J+10",
    ] {
        assert_eq!(message(fine), None, "{fine}");
    }
}
