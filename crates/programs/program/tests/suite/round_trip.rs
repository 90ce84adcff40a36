//! Laws of listings: reading one gives the same blocks, writing it again the same text, for every kind of
//! block and for any bytes.

use crate::laws::check_listings;
use bahn_parameters::ControlModel;
use bahn_program::{FormatOptions, Program, format_block};
use proptest::prelude::*;

const POINT: FormatOptions = FormatOptions {
    decimal_comma: false,
    iso_step: 0,
};
const COMMA: FormatOptions = FormatOptions {
    decimal_comma: true,
    iso_step: 10,
};

fn read(bytes: impl Into<Vec<u8>>) -> Program {
    Program::from_bytes("TEST.H", bytes.into())
}

fn check_laws(bytes: &[u8]) {
    let program = check_listings("TEST.H", bytes, [POINT, COMMA], ControlModel::Tnc360);
    let last = program.block_count() - 1;
    assert!(program.line_of(last) >= 1 && program.text_of(last).len() <= bytes.len() * 2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn every_block_reads_back(block in crate::generate::block()) {
        for options in [POINT, COMMA] {
            let text = format_block(&block, options);
            let program = read(format!("BEGIN PGM 1 MM\n{text}\nEND PGM 1 MM"));
            let found = program.decode(0).blocks.swap_remove(1);
            prop_assert_eq!(&found, &block, "{}", text);
        }
    }

    #[test]
    fn every_program_keeps_the_laws(all in prop::collection::vec(crate::generate::block(), 0..40)) {
        let text: String = all.iter().map(|block| format_block(block, POINT) + "\n").collect();
        check_laws(text.as_bytes());
    }

    #[test]
    fn any_bytes_keep_the_laws(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        check_laws(&bytes);
    }

    #[test]
    fn any_words_keep_the_laws(words in prop::collection::vec(crate::generate::fragment(), 0..80)) {
        check_laws(words.concat().as_bytes());
    }

    /// Cycle blocks, whose texts may look like numbers and addresses.
    #[test]
    fn any_cycle_words_keep_the_laws(head in "CYCL DEF (14\\.1|7\\.1|8\\.1|1\\.2|3\\.4|12\\.1|68\\.1|200) ", words in "[NaLbXIF0-9+./,:= Q~;-]{0,24}") {
        check_laws(format!("{head}{words}").as_bytes());
    }

    #[test]
    fn damaged_programs_keep_the_laws(
        all in prop::collection::vec(crate::generate::block(), 1..12),
        damages in prop::collection::vec((any::<prop::sample::Index>(), crate::generate::damage()), 1..8),
    ) {
        let text: String = all.iter().map(|block| format_block(block, POINT) + "\n").collect();
        let mut bytes = text.into_bytes();
        for (place, damage) in damages {
            if !bytes.is_empty() {
                let place = place.index(bytes.len());
                damage.apply(&mut bytes, place);
            }
        }
        check_laws(&bytes);
    }
}

#[test]
fn nasty_texts_keep_the_laws() {
    for text in [
        "",
        "~",
        "~\n~\n~",
        "CALL PGM A~ ;",
        "CALL PGM A~...b\nL X+1",
        "12 ~\n* - heading ; c",
        "L X+5 ~\n\n\nY+6",
        "/5 / / L X+5",
        "5 7 L X+5",
        "CYCL DEF 200.0 .X",
        "CYCL DEF 1.1 X: 5",
        "CYCL DEF 1.1 IX: 5 AB-: 5",
        "CYCL DEF 1.1 SET F UP",
        "TCH PROBE 6.2 -: Q5",
        "TCH PROBE 7.2 ORDER X-/5 Y+/Z-",
        "CYCL DEF 12.1 PGM PGM",
        "BEGIN PGM A~ MM ~\nP",
        "1 BEGIN PGM A\n2 begin pgm B ~\r\n ~ \n~",
        "; a ~~~\nL X+1",
        "\u{c}L X+5\u{c}END PGM\u{c}BEGIN",
        "x\n~\nBEGIN PGM 1 MM\nEND PGM 1 MM\n tail ~\n  more \x00",
        "x ~\n\r BEGIN PGM 1",
        "...L  ~\nBEGIN PGM ",
        "...L  ~\nBEGIN PGM ",
        "Q1; ~\n~",
        "a\n ~\n\0\u{c}BEGIN PGM 1",
        "CYCL DEF 5...~\u{c}L L ",
        "a\u{c}\u{c} ~\u{c}\0\u{c}\0\u{c}BEGIN PGM 1\u{c}END PGM 1\u{c}~\u{c}\0\u{c}a",
        "\n\u{feff}\nBEGIN PGM ",
        "\n\u{feff}\r\n \n\u{feff}x\nBEGIN PGM ",
        "CYCL DEF 1.1 X~ +5 Y~",
        "CYCL DEF 14.1 L~ 5 / 6~;",
        "CYCL DEF 14.1 CONTOUR LABEL NaN-/2",
        "CYCL DEF 14.1 A- 1/2",
        "N5 ; a ~\n b ~\nL X+1",
        "; a ~\n b ; c ~ \n\nL X+1",
        "BEGIN PGM A B IN P\nEND PGM A B CM",
        "L X+1\rY+2\nL X+3\nL X+4\r\n",
        "%1000 G71\nN10 G00 X+5 *",
        "L X\u{e4} \u{85}",
        "Q1 = -(2) ^ -Q3 - (4 - -5)",
        "FN15: PRINT 0,5/-Q1",
        "X+5 R- F M M118 X1 Y2 M103",
        "TOOL CALL ZS1DR-Q1",
    ] {
        check_laws(text.as_bytes());
    }
    check_laws(b"L X\xff+5 ; \xe4\xf6 \x80\nCALL PGM \xc3\xa4\xff ~\n\xb5");
    check_laws(b"\xff\xfeL\0 \0X\0+\x005\0");
    check_laws(b"\xef\xbb\xbf0 BEGIN PGM 1 MM");
}
