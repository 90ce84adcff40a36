//! Blocks that the manuals know and that are not read here yet, by their first word.

use super::cursor::Cursor;

/// How a block of another kind begins.
struct Foreign {
    /// The first word, or its beginning where a digit must follow.
    word: &'static str,
    /// Whether digits touch the word.
    number: bool,
    /// What it belongs to.
    what: &'static str,
}

const FREE_CONTOUR: &str = "free contour programming (FK)";
const APPROACH: &str = "approach and departure (APPR, DEP)";
const DIN_ISO: &str = "DIN/ISO programming";

/// The table. FK and APPR/DEP are keys of the TE 400 [000:1079]; DIN/ISO [000:17976-17984].
const TABLE: &[Foreign] = &[
    foreign("FL", FREE_CONTOUR),
    foreign("FLT", FREE_CONTOUR),
    foreign("FC", FREE_CONTOUR),
    foreign("FCT", FREE_CONTOUR),
    foreign("FPOL", FREE_CONTOUR),
    foreign("FSELECT", FREE_CONTOUR),
    foreign("APPR", APPROACH),
    foreign("DEP", APPROACH),
    foreign("WINDOW", "the magnified detail of the graphics (WINDOW BLK FORM)"),
    numbered("G", DIN_ISO),
    numbered("D", DIN_ISO),
    numbered("T", DIN_ISO),
    foreign("%", DIN_ISO),
];

const fn foreign(word: &'static str, what: &'static str) -> Foreign {
    Foreign {
        word,
        number: false,
        what,
    }
}

const fn numbered(word: &'static str, what: &'static str) -> Foreign {
    Foreign {
        word,
        number: true,
        what,
    }
}

/// What the block at the position belongs to, if that is in the table.
#[cold]
pub(super) fn belongs_to(c: &Cursor) -> Option<&'static str> {
    TABLE.iter().find(|row| opens(c, row)).map(|row| row.what)
}

fn opens(c: &Cursor, row: &Foreign) -> bool {
    let mut after = c.clone();
    if !after.keyword(row.word) {
        return false;
    }
    let next = after.peek();
    match row.number {
        true => next.is_ascii_digit(),
        false => row.word == "%" || !next.is_ascii_alphabetic() || is_axis_word(&after),
    }
}

/// Whether words of coordinates touch the first word: `FLX+5`.
fn is_axis_word(c: &Cursor) -> bool {
    bahn_path::Axis::from_letter(c.peek()).is_some() && matches!(c.peek_at(1), b'+' | b'-' | b'0'..=b'9')
}

/// Whether a program is DIN/ISO by its first block: `%1000 G71 *`, `N10 G00 G40`.
pub(crate) fn is_din_iso(first_block: &[u8]) -> bool {
    let mut c = Cursor::new(first_block);
    super::prefix(&mut c);
    belongs_to(&c) == Some(DIN_ISO)
}

/// What is said of it.
pub(crate) fn not_supported(what: &str) -> String {
    match what {
        DIN_ISO => whole_program(),
        what => format!("{what} is not yet supported here"),
    }
}

/// What is said of a whole DIN/ISO program.
pub(crate) fn whole_program() -> String {
    "DIN/ISO programming is read from files whose names end with .I".to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::test::{block, fault};
    use super::*;
    use crate::Operation;
    use bahn_parameters::MessageId::{BlockNotKnown, BlockNotSupported};

    #[test]
    fn what_the_manuals_know_is_not_yet_supported() {
        for text in [
            "%1000 G71 *",
            "% 1000 G71 *",
            "N10 G00 G40 G90 X+5 *",
            "G98 L1 *",
            "N20 T1 G17 S1000 *",
            "D00 Q1 P01 +5 *",
            "FL X+5",
            "FLX+5 F100",
            "FLT AN+30",
            "FC DR+ R20",
            "FCT DR- R5",
            "FPOL X+0 Y+0",
            "FSELECT 2",
            "APPR LT X+5 Y+5 LEN 5 RL",
            "DEP LCT X+5 R5",
            "WINDOW BLK FORM 0.1 Z X+0",
        ] {
            assert_eq!(fault(text).0, BlockNotSupported, "{text}");
        }
        for text in [
            "FLOWER",
            "GO HOME",
            "DEPTH 5",
            "TRAVEL",
            "FN16: F-PRINT A",
            "SEL PGM 1",
        ] {
            assert_eq!(fault(text).0, BlockNotKnown, "{text}");
        }
        assert!(!matches!(block("LBL 1").operation, Operation::Invalid(_)));
    }

    #[test]
    fn programs_are_known_by_their_first_block() {
        assert!(is_din_iso(b"%1000 G71 *") && is_din_iso(b"N10 G30 G17 X+0 *") && is_din_iso(b"G01 X5"));
        assert!(!is_din_iso(b"N10 L X+5") && !is_din_iso(b"FL X+5") && !is_din_iso(b"garbage"));
    }
}
